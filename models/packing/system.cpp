#include "packing/system.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "packing/model.hpp"
#include "system/resolution.hpp"

namespace monograin::packing {
namespace {

// Indices of the unknowns.
enum UnknownIndex : std::size_t { k_particles, k_fraction };

IntegratedState state_of(std::span<const double> y) { return {y[k_particles], y[k_fraction]}; }

void store(const IntegratedState& state, std::span<double> y) {
  y[k_particles] = state.particle_strain;
  y[k_fraction] = state.packing_fraction;
}

/// Scale of the particles' strain: its value half way through the compaction; 1 if the states end at jamming.
double typical_particle_strain(const Law& law) {
  return law.end > law.jamming ? state(law, std::midpoint(law.jamming, law.end)).particle_strain : 1.0;
}

}  // namespace

System::System(const Law& law, double initial_packing_fraction)
    : initial_(initial_packing_fraction),
      unknowns_{Unknown{"particle_strain", Unknown::Kind::differential, typical_particle_strain(law), false, false},
                Unknown{"packing_fraction", Unknown::Kind::differential, 1.0, true, false}},
      observables_{{"packing_fraction", "-", {}},
                   {"strain", "-", {}},
                   {"stress", "Pa", {}},
                   {"stress_elastic", "Pa", {}},
                   {"coordination_number", "-", {}},
                   {"plastic_fraction", "-", {}},
                   {"regime", "", regime_words()}},
      branch_(law, Control::packing_fraction),
      yielding_(law) {}

void System::start(std::span<double> y) {
  const Law& law = branch_.law();
  ramp_ = {initial_, initial_, branch_.control()};
  at_rest_ = initial_;
  mode_ = initial_ > law.jamming ? Mode::jammed : Mode::unjammed;
  yielding_.is_softer = is_jammed() && initial_ >= yielding_.softening;
  yielding_.is_full = std::max(initial_, law.jamming) >= yielding_.full_plasticity;
  store({is_jammed() ? state(law, initial_).particle_strain : 0.0, initial_}, y);
}

void System::begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) {
  ramp_ = ramps[0];
  if (ramp_.control != branch_.control()) branch_ = ControlledBranch(branch_.law(), ramp_.control);
  if (branch_.law().given.plasticity && ramp_.direction() < 0) {
    // A target may be the present value but for its round-off.
    if (ramp_.start - ramp_.end > k_same_value * ramp_.start) throw DomainError(Limit::no_unloading_law);
    ramp_.end = ramp_.start;
  }
  // After a change of control, the packing may stand where the new controlled quantity falls during compaction.
  if (is_jammed() && y[k_fraction] > branch_.range().end * (1.0 + k_same_value)) throw DomainError(branch_.limit());
  if (!is_jammed()) at_rest_ = y[k_fraction];
  const Mode before = mode_;
  resolve_mode(log);
  // An integrated state is kept. In all other cases the law gives the state: beyond the closed start of a jammed
  // branch, and where the controlled quantity falls at first.
  const bool goes_on = mode_ == before && !(mode_ == Mode::jammed && y[k_fraction] < branch_.range().begin);
  if (!goes_on) {
    solve(0.0, y);
    if (is_jammed()) yielding_.pass(branch_, ramp_.value(0.0), log);
  }
  require_pores(y);
  if (is_at_limit(0.0)) throw CannotBegin(branch_.domain_end());
  guards_.arm(branch_, ramp_, mode_, yielding_, ramp_.value(0.0));
  resting_ = y[k_fraction];
}

/// Throws if the program presses on a packing without pores.
void System::require_pores(std::span<const double> y) const {
  const bool is_pressed_on =
      ramp_.direction() > 0 || ramp_.value(0.0) > branch_.range().greatest * (1.0 + k_same_value);
  if (is_jammed() && is_pressed_on && y[k_fraction] >= 1.0) throw DomainError(Limit::pores_closed);
}

/// True if a jammed packing has reached the end of its branch and the program goes on.
bool System::is_at_limit(double xi) const noexcept {
  return is_jammed() && branch_.is_limited() && ramp_.direction() > 0 && ramp_.value(xi) >= branch_.last_value();
}

/// Sets the mode at the start of a step; logs an event where the packing jams or comes loose.
void System::resolve_mode(std::vector<Event>& log) {
  const double value = ramp_.value(0.0);
  const int direction = ramp_.direction();
  const bool was_jammed = is_jammed();
  const bool jammed = is_jammed_at(branch_, value, direction, was_jammed);
  if (jammed != was_jammed) log.push_back({"jamming"});
  mode_ = jammed ? mode_of_jammed(branch_, value, direction) : Mode::unjammed;
}

// --- the state

PackingState System::by_law(double xi) const { return closed_form(branch_, mode_, ramp_.value(xi), at_rest_); }

IntegratedEquations System::equations(double xi) const {
  return {branch_, piece(), unknowns_[k_particles].scale, ramp_.value(xi)};
}

PackingState System::seen(double xi, std::span<const double> y) const {
  if (mode_ != Mode::jammed) return by_law(xi);
  // Where the stress hardly grows, Phi may exceed full plasticity by round-off before that event: observe it there.
  const double phi = yielding_.is_full ? y[k_fraction] : std::min(y[k_fraction], yielding_.full_plasticity);
  const double strain = equations(xi).strain({y[k_particles], phi});
  const double stress_elastic = strain * effective_modulus(branch_.law(), phi);
  return {phi, stress_elastic, strain, total_stress(branch_.law(), phi, stress_elastic, piece())};
}

void System::complete(double xi, std::span<double> y) {
  if (mode_ != Mode::jammed) return solve(xi, y);
  store(equations(xi).completed(state_of(y)), y);
}

/// Sets the unknowns by the closed form.
void System::solve(double xi, std::span<double> y) {
  const PackingState now = by_law(xi);
  store({is_jammed() ? particle_strain(branch_, now) : 0.0, now.packing_fraction}, y);
}

void System::rates(double xi, std::span<const double> y, std::span<double> dy) {
  dy[k_particles] = dy[k_fraction] = 0.0;
  if (mode_ != Mode::jammed || ramp_.direction() == 0) return;
  const IntegratedEquations now = equations(xi);
  store(now.rates(now.within_branch(state_of(y)), ramp_.rate()), dy);
}

void System::residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) {
  if (mode_ != Mode::jammed) {
    res[k_particles] = dy[k_particles];
    res[k_fraction] = y[k_fraction] - resting_;
    return;
  }
  const IntegratedEquations now = equations(xi);
  const IntegratedState inside = now.within_branch(state_of(y));
  std::array<double, 2> all{};
  rates(xi, std::array{inside.particle_strain, inside.packing_fraction}, all);
  // Rates are compared along the line on which the prescribed value is met, whichever unknown that line leaves free.
  const std::array<double, 2> slope = now.excess_slopes(inside);
  const double scale = unknowns_[k_particles].scale;
  res[k_particles] = (slope[k_fraction] * (dy[k_particles] - all[k_particles]) -
                      slope[k_particles] * scale * (dy[k_fraction] - all[k_fraction])) /
                     std::hypot(slope[0], slope[1]);
  res[k_fraction] = now.excess(inside);
  const double outside = y[k_fraction] - inside.packing_fraction;
  if (outside < 0.0) res[k_fraction] += outside * slope[k_fraction];
}

// --- events

void System::set_mode(Mode mode, double xi, std::span<double> y) {
  mode_ = mode;
  if (mode == Mode::jammed) solve(xi, y);
}

std::optional<DomainEnd> System::fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                      std::vector<Event>& log) {
  std::optional<DomainEnd> end;
  const int direction = ramp_.direction();
  const bool is_up = direction > 0;
  const double value = ramp_.value(xi);
  for (const std::size_t g : fired) {
    const Guard& guard = guards_.list()[g];
    const Event event{guard.name};
    if (!event.name.empty()) log.push_back(event);
    switch (static_cast<GuardKind>(guard.kind)) {
      case jams:
        if (is_up && value > branch_.range().greatest) branch_.end_at_jamming();
        set_mode(is_up ? mode_of_jammed(branch_, value, direction) : Mode::unjammed, xi, y);
        break;
      case grips:
        set_mode(is_up ? Mode::starting : Mode::held, xi, y);
        break;
      case starts:
        set_mode(is_up ? Mode::jammed : Mode::starting, xi, y);
        break;
      case softens:
        yielding_.is_softer = true;
        break;
      case yields_fully:
        yielding_.is_full = true;
        break;
      case is_full:
        if (ramp_.end > guards_.value(g)) end = DomainEnd{event, {Limit::pores_closed, -1, "packing fraction", 1.0}};
        break;
      case ends:
        end = branch_.domain_end();
        break;
    }
  }
  // Other guards may lie at the position of the one that fired.
  if (is_up && is_jammed()) {
    if (const Mode onward = mode_of_jammed(branch_, value, direction); onward > mode_) set_mode(onward, xi, y);
    yielding_.pass(branch_, value, log);
  }
  if (!end && is_at_limit(xi)) {  // the packing jams there
    end = branch_.domain_end();
    log.push_back(end->event);
  }
  if (!end) guards_.arm(branch_, ramp_, mode_, yielding_, value);
  resting_ = y[k_fraction];
  return end;
}

// --- observation

Regime System::regime() const noexcept {
  if (!is_jammed()) return Regime::unjammed;
  if (!branch_.law().given.plasticity) return Regime::elastic;
  return yielding_.is_full ? Regime::fully_plastic : Regime::elastic_plastic;
}

void System::observe(double xi, std::span<const double> y, std::span<double> values) {
  const Law& law = branch_.law();
  const PackingState now = seen(xi, y);
  values[0] = now.packing_fraction;
  values[1] = now.strain;
  values[2] = now.stress;
  values[3] = now.stress_elastic;
  values[4] = is_jammed() ? coordination_number(law, now.packing_fraction) : k_nan;
  values[5] = is_jammed() ? plastic_fraction(law, now.packing_fraction) : 0.0;
  values[6] = static_cast<double>(regime());
}

double System::quantity(Quantity /*quantity*/, int /*channel*/, double /*xi*/, std::span<const double> /*y*/) {
  throw std::logic_error("a packing has no such quantity");
}

double System::controlled(Control control, int /*channel*/, double xi, std::span<const double> y) {
  const PackingState now = seen(xi, y);
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
