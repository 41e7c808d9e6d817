#include "packing/system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "packing/model.hpp"
#include "system/undefined.hpp"

namespace monograin::packing {
namespace {

constexpr int k_iterations = 60;
constexpr double k_resolution = 1e-14;  // of the last step but one of an iteration that doubles its digits
constexpr double k_noise = 1e-11;       // steps below it may be rounding
// The start is closed over this share of Phi, and of the first half of what is prescribed: of more, where that has its
// least value there, about which Phi goes like the root of an error.
constexpr double k_start = 1e-6;
constexpr double k_start_of_fold = 1e-3;
constexpr double k_margin = 1e-6;  // share of what is prescribed by which a run ends before the branch does
// Distance of Phi from a pole at which every branch ends: nearer to it strains and rates are made of rounding.
constexpr double k_margin_of_pole = 1e-7;
// Share of what is prescribed that is rounding.
constexpr double k_same = 1e-12;

// Places of the unknowns.
constexpr std::size_t k_particles = 0;
constexpr std::size_t k_fraction = 1;

// Kinds of guards.
constexpr int k_jams = 0;    // the packing jams, or comes loose
constexpr int k_grips = 1;   // the stress with which its branch begins
constexpr int k_starts = 2;  // the end of the closed start
constexpr int k_softens = 3;
constexpr int k_plastic = 4;
constexpr int k_full = 5;
constexpr int k_limit = 6;

/// Why a branch ends before the packing is full.
Limit end_of_branch(Control control) {
  if (control == Control::strain) return Limit::greatest_strain;
  return control == Control::stress ? Limit::greatest_stress : Limit::infinite_stress;
}

/// Of the closed form.
double particle_strain(const Law& law, double packing_fraction) { return state(law, packing_fraction).particle_strain; }

/// Half way through the compaction; anything where a packing that jams has come to its end.
double typical_particle_strain(const Law& law) {
  return law.end > law.jamming ? particle_strain(law, std::midpoint(law.jamming, law.end)) : 1.0;
}

Branch branch_of(const Law& law, Control control) {
  const double last = law.end < 1.0 ? std::max(law.jamming, law.end - k_margin_of_pole) : 1.0;
  if (control == Control::packing_fraction) {
    return {.measure = Measure::strain, .begin = law.jamming, .end = last, .least = law.jamming, .greatest = last};
  }
  Branch branch = growing_branch(law, control == Control::strain ? Measure::strain : Measure::stress);
  if (branch.end > last) {
    branch.end = std::max(branch.begin, last);
    branch.greatest = measured(law, branch.measure, branch.end);
  }
  return branch;
}

}  // namespace

System::System(const Law& law, double initial_packing_fraction)
    : law_(law),
      initial_(initial_packing_fraction),
      at_jamming_(state(law, law.jamming)),
      softening_(softening(law)),
      unknowns_{Unknown{"particle_strain", Unknown::Kind::differential, typical_particle_strain(law), false, false},
                Unknown{"packing_fraction", Unknown::Kind::differential, 1.0, true, false}},
      observables_{{"packing_fraction", "-", {}},
                   {"strain", "-", {}},
                   {"stress", "Pa", {}},
                   {"stress_elastic", "Pa", {}},
                   {"coordination_number", "-", {}},
                   {"plastic_fraction", "-", {}},
                   {"regime", "", regime_words()}} {}

void System::start(std::span<double> y) {
  at_rest_ = initial_;
  is_jammed_ = initial_ > law_.jamming;
  mode_ = is_jammed_ ? Mode::jammed : Mode::unjammed;
  is_softer_ = is_jammed_ && initial_ >= softening_;
  is_fully_plastic_ = std::max(initial_, law_.jamming) >= full_plasticity(law_);
  y[k_fraction] = initial_;
  y[k_particles] = is_jammed_ ? particle_strain(law_, initial_) : 0.0;
}

// --- what is prescribed

double System::prescribed(double xi) const noexcept { return std::lerp(ramp_.start, ramp_.end, xi); }

int System::direction() const noexcept { return (ramp_.end > ramp_.start) - (ramp_.end < ramp_.start); }

/// What is prescribed where a jammed packing has this packing fraction.
double System::prescribed_at(double packing_fraction) const {
  if (ramp_.control == Control::packing_fraction) return packing_fraction;
  return measured(law_, branch_.measure, packing_fraction);
}

/// Controlled quantity at jamming, a packing fraction or a strain.
double System::prescribed_at_jamming() const noexcept {
  return ramp_.control == Control::strain ? at_jamming_.strain : law_.jamming;
}

void System::begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) {
  const bool is_other = ramps[0].control != ramp_.control || branch_.begin == 0.0;
  ramp_ = ramps[0];
  if (is_other) take_branch();
  if (law_.given.plasticity && direction() < 0) {
    if (ramp_.start - ramp_.end > k_same * ramp_.start) {
      throw DomainError(Limit::no_unloading_law);
    }
    ramp_.end = ramp_.start;
  }
  const auto require_pores = [&] {
    const bool is_pressed_on = direction() > 0 || prescribed(0.0) > branch_.greatest * (1.0 + k_same);
    if (is_jammed_ && is_pressed_on && y[k_fraction] >= 1.0) throw DomainError(Limit::pores_closed);
  };
  require_pores();
  // Another control may find the packing where what it prescribes falls as the packing is compacted.
  if (is_jammed_ && y[k_fraction] > branch_.end * (1.0 + k_margin)) {
    throw DomainError(end_of_branch(ramp_.control));
  }
  if (!is_jammed_) at_rest_ = y[k_fraction];
  const Mode before = mode_;
  resolve_mode(0.0, log);
  // An integrated state goes on; elsewhere the law says what it is: a packing that jams beyond its closed start, too,
  // and one that stands where what is prescribed falls at first, which gives way to where it grows.
  const bool goes_on = mode_ == before && !(mode_ == Mode::jammed && y[k_fraction] < branch_.begin);
  if (!goes_on) {
    if (is_jammed_) require_state(0.0);
    solve(0.0, y);
  }
  if (!goes_on) pass_places(0.0, log);
  take_piece(0.0);
  require_pores();  // it may have given way until it is full
  if (is_at_limit(0.0)) throw CannotBegin(limit());
  if (goes_on) complete(0.0, y);
  arm_guards(0.0);
  resting_ = y[k_fraction];
}

void System::take_branch() {
  branch_ = branch_of(law_, ramp_.control);
  start_end_ = std::min(std::max(law_.jamming, branch_.begin) * (1.0 + k_start), branch_.end);
  growth_at_end_ = 0.0;
  if (branch_.end < 1.0 && ramp_.control != Control::packing_fraction) {
    const double at_end = growth_by_law(packing_fraction_at(law_, branch_, last_place()));
    // Otherwise it ends at a pole, next to which what an integrator tolerates makes growth any number.
    const bool is_fold = at_end < growth_by_law(std::midpoint(branch_.begin, branch_.end));
    if (is_fold) growth_at_end_ = at_end;
  }
  if (ramp_.control == Control::packing_fraction) return;
  const double share = branch_.begin > law_.jamming ? k_start_of_fold : k_start;
  const double half = prescribed_at(std::midpoint(branch_.begin, branch_.end));
  const double end = std::clamp(std::lerp(branch_.least, half, share), branch_.least, branch_.greatest);
  start_end_ = std::max(start_end_, packing_fraction_at(law_, branch_, end));
}

/// Controlled quantity at which a run stops short of the end of a branch, where the rates are infinite.
double System::last_place() const noexcept { return branch_.greatest - k_margin * (branch_.greatest - branch_.least); }

/// Derivative of the controlled quantity with respect to the packing fraction.
double System::growth_of(const Slopes& slopes) const noexcept {
  if (ramp_.control == Control::packing_fraction) return 1.0;
  return ramp_.control == Control::strain ? slopes.strain : slopes.stress;
}

double System::growth_by_law(double packing_fraction) const {
  return growth_of(slopes(law_, packing_fraction, state(law_, packing_fraction).strain));
}

/// Whether what is prescribed grows less with an integrated state than the law lets it anywhere, up to its last place:
/// errors have led past it, and rates without bound would lead on.
bool System::has_passed_end(double packing_fraction, double growth) const {
  constexpr double k_doubt = 0.5;
  return growth < k_doubt * growth_at_end_ &&
         (packing_fraction >= branch_.end || growth < k_doubt * growth_by_law(packing_fraction));
}

/// Whether a program that goes on is there already.
bool System::is_at_limit(double xi) const noexcept {
  return is_jammed_ && branch_.end < 1.0 && direction() > 0 && prescribed(xi) >= last_place();
}

DomainEnd System::limit() const {
  return {{"limit"}, {end_of_branch(ramp_.control), -1, "greatest value", branch_.greatest}};
}

/// Beyond a greatest strain or stress there is no state, but rates of neighbouring ones that look as if there were.
void System::require_state(double xi) const {
  if (branch_.end < 1.0 && prescribed(xi) > branch_.greatest) throw DomainError(end_of_branch(ramp_.control));
}

/// Mode at the start of a step.
void System::resolve_mode(double xi, std::vector<Event>& log) {
  const double value = prescribed(xi);
  const int d = direction();
  const bool was_jammed = is_jammed_;
  if (ramp_.control == Control::stress) {
    is_jammed_ = was_jammed || value > 0.0 || d > 0;
  } else {
    const double jamming = prescribed_at_jamming();
    is_jammed_ = value > jamming || (value == jamming && (d > 0 || (d == 0 && was_jammed)));
    // Where the strain falls at first, a packing that is not unloaded stays jammed below the strain at jamming.
    is_jammed_ |= was_jammed && d >= 0 && value >= branch_.least;
  }
  if (is_jammed_ != was_jammed) log.push_back({"jamming"});
  mode_ = is_jammed_ ? mode_of_jammed(value) : Mode::unjammed;
}

/// Where the strain falls at first, a packing jams beyond its closed start.
System::Mode System::mode_of_jammed(double value) const {
  const int d = direction();
  if (ramp_.control == Control::stress && (value < branch_.least || (value == branch_.least && d <= 0))) {
    return Mode::held;
  }
  const double end_of_start = prescribed_at(start_end_);
  return value < end_of_start || (value == end_of_start && d < 0) ? Mode::starting : Mode::jammed;
}

// --- the state

/// State by the closed form, for what is prescribed.
System::Seen System::by_law(double xi) const {
  const double value = prescribed(xi);
  if (mode_ == Mode::unjammed) {
    double phi = at_rest_;
    if (ramp_.control == Control::packing_fraction) phi = value;
    if (ramp_.control == Control::strain) phi = law_.jamming * std::exp(value - at_jamming_.strain);
    return {.packing_fraction = phi, .strain = at_jamming_.strain + std::log(phi / law_.jamming)};
  }
  if (mode_ == Mode::held) {
    const State s = state(law_, branch_.begin);
    return {branch_.begin, s.stress_elastic, s.strain, value};
  }
  // A trial may go beyond the stretch that this mode has, where a guard ends it: the end is seen instead.
  const double last = mode_ == Mode::starting ? prescribed_at(start_end_) : branch_.greatest;
  const double inside = std::clamp(value, branch_.least, last);
  const double phi = ramp_.control == Control::packing_fraction ? inside : packing_fraction_at(law_, branch_, inside);
  const State s = state(law_, phi);
  // Next to jamming strain and stress may grow by all of a program before the packing fraction does by its rounding.
  if (ramp_.control == Control::stress) return {phi, stress_elastic_at(law_, phi, inside), s.strain, inside};
  return {phi, s.stress_elastic, ramp_.control == Control::strain ? inside : s.strain, s.stress};
}

/// Strain of the packing: what the particles leave of the whole.
double System::strain_of(std::span<const double> y) const noexcept {
  return total_strain(law_, y[k_fraction]) - law_.sign * y[k_particles];
}

System::Seen System::seen(double xi, std::span<const double> y) const {
  if (mode_ != Mode::jammed) return by_law(xi);
  // Past where all of its particles yield by the rounding of a stress that hardly grows there, it is seen there.
  const double phi = is_fully_plastic_ ? y[k_fraction] : std::min(y[k_fraction], full_plasticity(law_));
  const double strain = strain_of(std::array{y[k_particles], phi});
  const double stress_elastic = strain * effective_modulus(law_, phi);
  return {phi, stress_elastic, strain, total_stress(law_, phi, stress_elastic, piece_)};
}

/// How far a jammed packing is from what is prescribed. A trial may go beyond the stress of a full packing, where a
/// guard ends it.
double System::excess(double xi, std::span<const double> y) const {
  const double phi = y[k_fraction];
  if (ramp_.control == Control::packing_fraction) return phi - prescribed(xi);
  if (ramp_.control == Control::strain) return strain_of(y) - prescribed(xi);
  const double stress = total_stress(law_, phi, strain_of(y) * effective_modulus(law_, phi), piece_);
  return (stress - std::min(prescribed(xi), branch_.greatest)) / law_.given.youngs_modulus;
}

/// Its derivatives by the unknowns over their scales.
std::array<double, 2> System::excess_slopes(std::span<const double> y) const {
  const double phi = y[k_fraction];
  const double scale = law_.sign * unknowns_[k_particles].scale;
  if (ramp_.control == Control::packing_fraction) return {0.0, 1.0};
  if (ramp_.control == Control::strain) return {-scale, 1.0 / phi};
  const double by_strain = total_stress_slope(law_, phi, piece_) * effective_modulus(law_, phi);
  const double by_fraction = slopes(law_, phi, strain_of(y), piece_).at_given_particles;
  return {-scale * by_strain / law_.given.youngs_modulus, by_fraction / law_.given.youngs_modulus};
}

/// Of an integrated state: the closed start lies below.
double System::least_fraction() const noexcept { return law_.jamming * (1.0 + 0.5 * k_start); }

/// What an integrator tolerates may reach down to the closed start, and below jamming, or beyond where what is
/// prescribed has its least value: from within the closed start on everything goes on along its tangent.
std::array<double, 2> System::within_branch(std::span<const double> y) const noexcept {
  const double least = std::max(least_fraction(), std::midpoint(branch_.begin, start_end_));
  return {y[k_particles], std::max(y[k_fraction], least)};
}

void System::complete(double xi, std::span<double> y) {
  if (mode_ != Mode::jammed) return solve(xi, y);
  require_state(xi);
  if (ramp_.control == Control::packing_fraction) {
    y[k_fraction] = prescribed(xi);
    return;
  }
  if (ramp_.control == Control::strain) {
    // A first guess of an implicit stage leaves the particles as they were, and so takes the packing below jamming or
    // beyond a pole.
    const double with_particles = law_.zero_stress * std::exp(prescribed(xi) + law_.sign * y[k_particles]);
    y[k_fraction] = std::max(std::min(with_particles, branch_.end), least_fraction());
    return;
  }
  // By the shortest way: where the particles give way with the packing (consistent coupling), the packing fraction at a
  // given strain of theirs has a greatest stress before the packing has. Where the modulus begins within less of Phi
  // than is tolerated, no direction leads there; the particles say where.
  const std::array<double, 2> guess{y[k_particles], y[k_fraction]};
  if (is_brought_back(xi, y)) return;
  std::ranges::copy(guess, y.begin());  // the next trial begins there
  const double stress = std::min(prescribed(xi), branch_.greatest);
  const auto found = packing_fraction_under(law_, stress, y[k_particles], least_fraction(), branch_.end, piece_);
  if (!found) throw std::domain_error("no packing fraction bears the stress");
  y[k_fraction] = *found;
}

/// Newton's method along the gradient.
bool System::is_brought_back(double xi, std::span<double> y) const {
  const double scale = unknowns_[k_particles].scale;
  double last = 1.0;
  for (int k = 0; k < k_iterations; ++k) {
    // Next to jamming and to a full packing of nearly incompressible particles what is tolerated may be beyond.
    const double inside = std::max(std::min(y[k_fraction], branch_.end), least_fraction());
    const bool is_inside = y[k_fraction] == inside;
    y[k_fraction] = inside;
    std::array<double, 2> slope = excess_slopes(y);
    if (!is_inside) slope[k_fraction] = 0.0;
    const double steepness = std::hypot(slope[0], slope[1]);
    const double share = -excess(xi, y) / (steepness * steepness);
    y[k_fraction] += share * slope[k_fraction];
    y[k_particles] += share * slope[k_particles] * scale;
    const double step = std::abs(share) * steepness;
    // Corrections that no longer shrink are rounding.
    const bool is_rounding = step < k_noise && step > 0.5 * last;
    last = step;
    if (step <= k_resolution || is_rounding) return true;
  }
  return false;
}

/// By the law: an integrated state may have errors that lead past where the pieces meet.
void System::take_piece(double xi) {
  const bool is_full = is_fully_plastic_ || (is_jammed_ && by_law(xi).packing_fraction > full_plasticity(law_));
  piece_ = is_full ? Piece::full : Piece::growing;
}

/// Next to a pole the rounding of Phi shows in the strain: there the particles have what the strain leaves of the
/// whole.
void System::solve(double xi, std::span<double> y) {
  const Seen now = by_law(xi);
  y[k_fraction] = now.packing_fraction;
  y[k_particles] = mode_ == Mode::unjammed ? 0.0 : particle_strain(law_, now.packing_fraction);
  if (ramp_.control == Control::packing_fraction || mode_ == Mode::unjammed) return;
  // Elsewhere digits would cancel: beside a greater strain, or in a stress that is plastic for the most part.
  const bool is_prescribed = ramp_.control == Control::strain;
  const bool gives_way_as_much = y[k_particles] > 0.5 * now.strain;
  const double elastic_part = now.stress_elastic * total_stress_slope(law_, now.packing_fraction);
  if (!gives_way_as_much || (!is_prescribed && elastic_part < 0.5 * now.stress)) return;
  const double strain = is_prescribed ? now.strain : now.stress_elastic / effective_modulus(law_, now.packing_fraction);
  y[k_particles] = law_.sign * (total_strain(law_, now.packing_fraction) - strain);
}

void System::rates(double xi, std::span<const double> y, std::span<double> dy) {
  dy[k_particles] = dy[k_fraction] = 0.0;
  if (mode_ != Mode::jammed || direction() == 0) return;
  require_state(xi);
  const std::array<double, 2> near = within_branch(y);
  const double phi = near[k_fraction];
  const Slopes s = slopes(law_, phi, strain_of(near), piece_);
  const double growth = growth_of(s);
  if (!(growth > 0.0) || has_passed_end(phi, growth)) throw DomainError(end_of_branch(ramp_.control));
  dy[k_fraction] = (ramp_.end - ramp_.start) / growth;
  dy[k_particles] = s.particle_strain * dy[k_fraction];
}

void System::residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) {
  if (mode_ != Mode::jammed) {
    res[k_particles] = dy[k_particles];
    res[k_fraction] = y[k_fraction] - resting_;
    return;
  }
  const std::array<double, 2> inside = within_branch(y);
  std::array<double, 2> all{};
  rates(xi, inside, all);
  // Rates count along what is prescribed, whichever of the unknowns that leaves free.
  const std::array<double, 2> slope = excess_slopes(inside);
  const double scale = unknowns_[k_particles].scale;
  res[k_particles] = (slope[k_fraction] * (dy[k_particles] - all[k_particles]) -
                      slope[k_particles] * scale * (dy[k_fraction] - all[k_fraction])) /
                     std::hypot(slope[0], slope[1]);
  res[k_fraction] = excess(xi, inside);
  const double outside = y[k_fraction] - inside[k_fraction];
  if (outside < 0.0) res[k_fraction] += outside * slope[k_fraction];
}

// --- events

/// Lists a place, if it is ahead on the path to the ramp's end.
void System::arm_place(int kind, std::string_view name, double place) {
  const int d = direction();
  if (!(d > 0 ? place <= ramp_.end : place >= ramp_.end)) return;
  guards_.push_back({kind, 0, d, name, name.empty()});
  places_.push_back(place);
}

void System::arm_guards(double xi) {
  guards_.clear();
  places_.clear();
  const int d = direction();
  if (d > 0) {
    arm_jamming();
    // A loose packing comes to strains that a jammed one has, but not to its states.
    if (is_jammed_) arm_compaction(xi);
  } else if (d < 0) {
    arm_loosening();
  }
}

/// Places up to which a packing is not integrated: it jams, its branch begins, and its closed start ends.
void System::arm_jamming() {
  switch (mode_) {
    case Mode::unjammed:
      // Under stress it jams at once, where a step begins.
      if (ramp_.control != Control::stress) arm_place(k_jams, "jamming", prescribed_at_jamming());
      break;
    case Mode::held:
      arm_place(k_grips, "", branch_.least);
      break;
    case Mode::starting:
      arm_place(k_starts, "", prescribed_at(start_end_));
      break;
    case Mode::jammed:
      break;
  }
}

/// Those places on the path back.
void System::arm_loosening() {
  const double jamming = prescribed_at_jamming();
  switch (mode_) {
    case Mode::unjammed:
    case Mode::held:
      break;
    case Mode::starting:
      if (ramp_.control == Control::stress)
        arm_place(k_grips, "", branch_.least);
      else
        arm_place(k_jams, "jamming", jamming);
      break;
    case Mode::jammed: {
      // Where the strain falls at first, it passes that at jamming before.
      const double start = prescribed_at(start_end_);
      const bool comes_loose = ramp_.control == Control::strain && start <= jamming;
      arm_place(comes_loose ? k_jams : k_starts, comes_loose ? "jamming" : "", start);
      break;
    }
  }
}

/// A jammed packing softens, yields as a whole, and is full or comes to the end of its branch.
void System::arm_compaction(double xi) {
  const double end = branch_.end;
  if (!is_softer_ && softening_ <= end) arm_place(k_softens, "plastic-softening", prescribed_at(softening_));
  const double plastic = full_plasticity(law_);
  if (!is_fully_plastic_ && plastic <= std::min(1.0, end)) {
    arm_place(k_plastic, "fully-plastic", prescribed_at(plastic));
  }
  if (end == 1.0) {
    if (prescribed(xi) < branch_.greatest) arm_place(k_full, "full", branch_.greatest);
  } else {
    arm_place(k_limit, "limit", last_place());
  }
}

/// A packing that jams or gives way beyond its closed start passes these with it.
void System::pass_places(double xi, std::vector<Event>& log) {
  const auto is_passed = [&](double place) {
    if (!is_jammed_ || place > branch_.end) return false;
    return place <= branch_.begin || prescribed_at(place) <= prescribed(xi);
  };
  if (!is_softer_ && is_passed(softening_)) {
    is_softer_ = true;
    log.push_back({"plastic-softening"});
  }
  if (!is_fully_plastic_ && is_passed(full_plasticity(law_))) {
    is_fully_plastic_ = true;
    log.push_back({"fully-plastic"});
  }
}

/// Where the strain falls at first and never grows to what it is at jamming, or the branch ends there but for rounding,
/// there is nothing to give way to.
void System::end_branch_at_jamming() noexcept {
  branch_.begin = branch_.end = law_.jamming;
  branch_.least = branch_.greatest = prescribed_at_jamming();
}

void System::guard_values(double xi, std::span<const double> /*y*/, std::span<double> values) {
  const double length = std::abs(ramp_.end - ramp_.start);
  for (std::size_t g = 0; g < guards_.size(); ++g) values[g] = (prescribed(xi) - places_[g]) / length;
}

void System::set_mode(Mode mode, double xi, std::span<double> y) {
  mode_ = mode;
  if (mode != Mode::jammed) return;
  solve(xi, y);
}

std::optional<DomainEnd> System::fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                      std::vector<Event>& log) {
  std::optional<DomainEnd> end;
  const bool is_up = direction() > 0;
  for (const std::size_t g : fired) {
    const Event event{guards_[g].name};
    if (!event.name.empty()) log.push_back(event);
    switch (guards_[g].kind) {
      case k_jams:
        is_jammed_ = is_up;
        if (is_up && prescribed(xi) > branch_.greatest) end_branch_at_jamming();
        set_mode(is_up ? mode_of_jammed(prescribed(xi)) : Mode::unjammed, xi, y);
        break;
      case k_grips:
        set_mode(is_up ? Mode::starting : Mode::held, xi, y);
        break;
      case k_starts:
        set_mode(is_up ? Mode::jammed : Mode::starting, xi, y);
        break;
      case k_softens:
        is_softer_ = true;
        break;
      case k_plastic:
        is_fully_plastic_ = true;
        break;
      case k_full:
        if (ramp_.end > places_[g]) end = DomainEnd{event, {Limit::pores_closed, -1, "packing fraction", 1.0}};
        break;
      default:
        end = limit();
        break;
    }
  }
  // Other places may lie where the one that has been met does.
  if (is_up && is_jammed_) {
    if (const Mode onward = mode_of_jammed(prescribed(xi)); onward > mode_) set_mode(onward, xi, y);
    pass_places(xi, log);
  }
  if (!end && is_at_limit(xi)) {  // it jams there
    end = limit();
    log.push_back(end->event);
  }
  take_piece(xi);
  if (!end) arm_guards(xi);
  resting_ = y[k_fraction];
  return end;
}

// --- what is seen

Regime System::regime() const noexcept {
  if (!is_jammed_) return Regime::unjammed;
  if (!law_.given.plasticity) return Regime::elastic;
  return is_fully_plastic_ ? Regime::fully_plastic : Regime::elastic_plastic;
}

void System::observe(double xi, std::span<const double> y, std::span<double> values) {
  const Seen now = seen(xi, y);
  values[0] = now.packing_fraction;
  values[1] = now.strain;
  values[2] = now.stress;
  values[3] = now.stress_elastic;
  values[4] = is_jammed_ ? coordination_number(law_, now.packing_fraction) : k_nan;
  values[5] = is_jammed_ ? plastic_fraction(law_, now.packing_fraction) : 0.0;
  values[6] = static_cast<double>(regime());
}

double System::quantity(Quantity /*quantity*/, int /*channel*/, double /*xi*/, std::span<const double> /*y*/) {
  throw std::logic_error("a packing has no such quantity");
}

double System::controlled(Control control, int /*channel*/, double xi, std::span<const double> y) {
  const Seen now = seen(xi, y);
  switch (control) {
    case Control::packing_fraction:
      return now.packing_fraction;
    case Control::strain:
      return now.strain;
    case Control::stress:
      return now.stress;
    default:
      throw std::logic_error("a packing does not know what is prescribed");
  }
}

}  // namespace monograin::packing
