#include "packing/system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "packing/model.hpp"
#include "system/resolution.hpp"

namespace monograin::packing {
namespace {

constexpr int k_iterations = 60;
constexpr double k_resolution = 1e-14;  // step of Newton's method after which the next one is below round-off
constexpr double k_noise = 1e-11;       // smaller steps may be round-off
// Extent of the closed start, over Phi, and over the first half of the controlled quantity's range. It is larger for a
// branch that begins at a minimum of that quantity, where Phi goes like the root of an error.
constexpr double k_start = 1e-6;
constexpr double k_start_of_fold = 1e-3;
constexpr double k_margin = 1e-6;  // share of a branch's range by which a run ends before the branch does
// Distance of Phi from a pole at which every branch ends: nearer to the pole, strains and rates are round-off.
constexpr double k_margin_of_pole = 1e-7;
// Relative difference of the controlled quantity that is round-off.
constexpr double k_same = 1e-12;

// Indices of the unknowns.
constexpr std::size_t k_particles = 0;
constexpr std::size_t k_fraction = 1;

// Kinds of guards.
constexpr int k_jams = 0;    // the packing jams, or comes loose
constexpr int k_grips = 1;   // the stress reaches the value with which its branch begins
constexpr int k_starts = 2;  // the end of the closed start
constexpr int k_softens = 3;
constexpr int k_plastic = 4;
constexpr int k_full = 5;
constexpr int k_limit = 6;

/// The limit at which a branch ends before the packing is full.
Limit end_of_branch(Control control) {
  if (control == Control::strain) return Limit::greatest_strain;
  return control == Control::stress ? Limit::greatest_stress : Limit::infinite_stress;
}

/// Strain of the particles by the closed form.
double particle_strain(const Law& law, double packing_fraction) { return state(law, packing_fraction).particle_strain; }

/// Scale of the particles' strain: its value half way through the compaction; 1 if the states end at jamming.
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

// --- the controlled quantity

double System::prescribed(double xi) const noexcept { return std::lerp(ramp_.start, ramp_.end, xi); }

int System::direction() const noexcept { return (ramp_.end > ramp_.start) - (ramp_.end < ramp_.start); }

/// Controlled quantity of a jammed packing at a packing fraction.
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
  // After a change of control, the packing may stand where the new controlled quantity falls during compaction.
  if (is_jammed_ && y[k_fraction] > branch_.end * (1.0 + k_margin)) {
    throw DomainError(end_of_branch(ramp_.control));
  }
  if (!is_jammed_) at_rest_ = y[k_fraction];
  const Mode before = mode_;
  resolve_mode(0.0, log);
  // An integrated state goes on. Elsewhere the law gives the state, also for a packing that jams beyond its closed
  // start, and for one that stands where the controlled quantity falls at first and moves on to where it grows.
  const bool goes_on = mode_ == before && !(mode_ == Mode::jammed && y[k_fraction] < branch_.begin);
  if (!goes_on) {
    if (is_jammed_) require_state(0.0);
    solve(0.0, y);
  }
  if (!goes_on) pass_places(0.0, log);
  take_piece(0.0);
  require_pores();  // the packing may have moved on until it is full
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
    // Otherwise the branch ends at a pole, next to which an integrator's tolerated error gives the growth any value.
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

/// True if the controlled quantity grows less with an integrated state than the law admits anywhere on the branch.
/// Errors have then led past the branch's end, where unbounded rates would lead further on.
bool System::has_passed_end(double packing_fraction, double growth) const {
  constexpr double k_doubt = 0.5;
  return growth < k_doubt * growth_at_end_ &&
         (packing_fraction >= branch_.end || growth < k_doubt * growth_by_law(packing_fraction));
}

/// True if a jammed packing has reached the end of its branch and the program goes on.
bool System::is_at_limit(double xi) const noexcept {
  return is_jammed_ && branch_.end < 1.0 && direction() > 0 && prescribed(xi) >= last_place();
}

DomainEnd System::limit() const {
  return {{"limit"}, {end_of_branch(ramp_.control), -1, "greatest value", branch_.greatest}};
}

/// Throws beyond a greatest strain or stress, where no state exists, although neighbouring states have finite rates.
void System::require_state(double xi) const {
  if (branch_.end < 1.0 && prescribed(xi) > branch_.greatest) throw DomainError(end_of_branch(ramp_.control));
}

/// Sets the mode at the start of a step; logs an event where the packing jams or comes loose.
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

/// Mode of a jammed packing at a value of the controlled quantity. If the strain falls at first, a packing jams beyond
/// its closed start.
System::Mode System::mode_of_jammed(double value) const {
  const int d = direction();
  if (ramp_.control == Control::stress && (value < branch_.least || (value == branch_.least && d <= 0))) {
    return Mode::held;
  }
  const double end_of_start = prescribed_at(start_end_);
  return value < end_of_start || (value == end_of_start && d < 0) ? Mode::starting : Mode::jammed;
}

// --- the state

/// State by the closed form, for the prescribed value.
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
  // A trial may go beyond the range of this mode, at whose end a guard fires: the state at that end is used instead.
  const double last = mode_ == Mode::starting ? prescribed_at(start_end_) : branch_.greatest;
  const double inside = std::clamp(value, branch_.least, last);
  const double phi = ramp_.control == Control::packing_fraction ? inside : packing_fraction_at(law_, branch_, inside);
  const State s = state(law_, phi);
  // Next to jamming, strain and stress may pass through a whole program within the round-off of Phi.
  if (ramp_.control == Control::stress) return {phi, stress_elastic_at(law_, phi, inside), s.strain, inside};
  return {phi, s.stress_elastic, ramp_.control == Control::strain ? inside : s.strain, s.stress};
}

/// Strain of the packing: the total strain without the particles' share.
double System::strain_of(std::span<const double> y) const noexcept {
  return total_strain(law_, y[k_fraction]) - law_.sign * y[k_particles];
}

System::Seen System::seen(double xi, std::span<const double> y) const {
  if (mode_ != Mode::jammed) return by_law(xi);
  // Where the stress hardly grows, Phi may exceed full plasticity by round-off before that event: observe it there.
  const double phi = is_fully_plastic_ ? y[k_fraction] : std::min(y[k_fraction], full_plasticity(law_));
  const double strain = strain_of(std::array{y[k_particles], phi});
  const double stress_elastic = strain * effective_modulus(law_, phi);
  return {phi, stress_elastic, strain, total_stress(law_, phi, stress_elastic, piece_)};
}

/// Distance of a jammed packing from the prescribed value; over E for a stress. A trial may go beyond the stress of a
/// full packing, where a guard fires.
double System::excess(double xi, std::span<const double> y) const {
  const double phi = y[k_fraction];
  if (ramp_.control == Control::packing_fraction) return phi - prescribed(xi);
  if (ramp_.control == Control::strain) return strain_of(y) - prescribed(xi);
  const double stress = total_stress(law_, phi, strain_of(y) * effective_modulus(law_, phi), piece_);
  return (stress - std::min(prescribed(xi), branch_.greatest)) / law_.given.youngs_modulus;
}

/// Derivatives of excess() with respect to the unknowns over their scales.
std::array<double, 2> System::excess_slopes(std::span<const double> y) const {
  const double phi = y[k_fraction];
  const double scale = law_.sign * unknowns_[k_particles].scale;
  if (ramp_.control == Control::packing_fraction) return {0.0, 1.0};
  if (ramp_.control == Control::strain) return {-scale, 1.0 / phi};
  const double by_strain = total_stress_slope(law_, phi, piece_) * effective_modulus(law_, phi);
  const double by_fraction = slopes(law_, phi, strain_of(y), piece_).at_given_particles;
  return {-scale * by_strain / law_.given.youngs_modulus, by_fraction / law_.given.youngs_modulus};
}

/// Least Phi of an integrated state, in the middle of the closed start.
double System::least_fraction() const noexcept { return law_.jamming * (1.0 + 0.5 * k_start); }

/// State with a Phi that is inside the branch. Within an integrator's tolerance a state may reach down into the closed
/// start, below jamming, or beyond the minimum of the controlled quantity. From inside the closed start downwards the
/// equations go on along their tangent.
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
    // The first guess of an implicit stage keeps the particles' strain, which would take the packing below jamming or
    // beyond a pole.
    const double with_particles = law_.zero_stress * std::exp(prescribed(xi) + law_.sign * y[k_particles]);
    y[k_fraction] = std::max(std::min(with_particles, branch_.end), least_fraction());
    return;
  }
  // Takes the shortest path in both unknowns. With the consistent coupling, the stress at a given strain of the
  // particles has a maximum before the packing's own. If the modulus begins within a tolerated error of Phi, that path
  // does not arrive; Phi then follows from the strain of the particles.
  const std::array<double, 2> guess{y[k_particles], y[k_fraction]};
  if (is_brought_back(xi, y)) return;
  std::ranges::copy(guess, y.begin());  // the next trial begins there
  const double stress = std::min(prescribed(xi), branch_.greatest);
  const auto found = packing_fraction_under(law_, stress, y[k_particles], least_fraction(), branch_.end, piece_);
  if (!found) throw std::domain_error("no packing fraction bears the stress");
  y[k_fraction] = *found;
}

/// Newton's method along the gradient of excess(). False if it does not converge.
bool System::is_brought_back(double xi, std::span<double> y) const {
  const double scale = unknowns_[k_particles].scale;
  double last = 1.0;
  for (int k = 0; k < k_iterations; ++k) {
    // Next to jamming, and to a full packing of nearly incompressible particles, a tolerated state may lie outside.
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
    // Corrections that no longer shrink are round-off.
    const bool is_rounding = step < k_noise && step > 0.5 * last;
    last = step;
    if (step <= k_resolution || is_rounding) return true;
  }
  return false;
}

/// Sets the piece of eq. 11 by the law: the errors of an integrated state may lead past where the pieces meet.
void System::take_piece(double xi) {
  const bool is_full = is_fully_plastic_ || (is_jammed_ && by_law(xi).packing_fraction > full_plasticity(law_));
  piece_ = is_full ? Piece::full : Piece::growing;
}

/// Sets the unknowns by the closed form. Next to a pole, the round-off of Phi shows in the strain; the particles'
/// strain is then the total strain minus that of the packing.
void System::solve(double xi, std::span<double> y) {
  const Seen now = by_law(xi);
  y[k_fraction] = now.packing_fraction;
  y[k_particles] = mode_ == Mode::unjammed ? 0.0 : particle_strain(law_, now.packing_fraction);
  if (ramp_.control == Control::packing_fraction || mode_ == Mode::unjammed) return;
  // Elsewhere the difference would lose digits: beside a greater strain, or in a stress that is mostly plastic.
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
  // Rates are compared along the line on which the prescribed value is met, whichever unknown that line leaves free.
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

/// Adds a guard at a value of the controlled quantity, if the ramp leads there.
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
    // A loose packing reaches strains that a jammed one has, but not its states.
    if (is_jammed_) arm_compaction(xi);
  } else if (d < 0) {
    arm_loosening();
  }
}

/// Arms the guards before integration: the packing jams, its branch begins, and its closed start ends.
void System::arm_jamming() {
  switch (mode_) {
    case Mode::unjammed:
      // Under stress the packing jams at once, at the start of the step.
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

/// Arms the guards of a decreasing ramp: integration ends, the stress falls below its branch, the packing comes loose.
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
      // If the strain falls at first, a decreasing ramp may pass its value at jamming before the closed start.
      const double start = prescribed_at(start_end_);
      const bool comes_loose = ramp_.control == Control::strain && start <= jamming;
      arm_place(comes_loose ? k_jams : k_starts, comes_loose ? "jamming" : "", start);
      break;
    }
  }
}

/// Arms the guards of a jammed packing: it softens, yields as a whole, and is full or reaches the end of its branch.
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

/// Logs the events that a packing passes when it jams or moves on beyond its closed start.
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

/// Ends the branch at jamming. The strain falls at first and never grows back to its value at jamming, or the branch
/// ends there up to round-off: the packing has no state to move on to.
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
  // Other guards may lie at the position of the one that fired.
  if (is_up && is_jammed_) {
    if (const Mode onward = mode_of_jammed(prescribed(xi)); onward > mode_) set_mode(onward, xi, y);
    pass_places(xi, log);
  }
  if (!end && is_at_limit(xi)) {  // the packing jams there
    end = limit();
    log.push_back(end->event);
  }
  take_piece(xi);
  if (!end) arm_guards(xi);
  resting_ = y[k_fraction];
  return end;
}

// --- observation

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
