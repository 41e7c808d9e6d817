#include "mdr/system.hpp"

#include <algorithm>
#include <cmath>

#include "mdr/centre_search.hpp"
#include "mdr/equilibrium.hpp"
#include "mdr/rates.hpp"
#include "mdr/support.hpp"
#include "system/difficulty.hpp"
#include "system/limit.hpp"

namespace monograin::mdr {
namespace {

// Stiffness of a free centre (CentreStiffness::value) below which a nearby fold magnifies errors.
constexpr double k_soft_centre = 0.1;

}  // namespace

void System::start(std::span<double> y) {
  std::ranges::fill(y, 0.0);
  now_.particle.start();
  now_.caps.start();
  now_.validity.reset();
  now_.has_begun = false;
  std::vector<Ramp> ramps;
  for (std::size_t i = 0; i < now_.particle.size(); ++i) {
    const ContactClass& c = setup_->classes[i];
    ramps.push_back({-c.gap, -c.gap, Control::displacement});
    // Walls that touch a particle with a free centre hold it from the start. Walls at rest around a fixed centre stay
    // open until the particle grows against them.
    const ContactBranch& branch = now_.particle.branch(i);
    if (c.gap == 0.0 && now_.particle.centre().acts(i)) now_.particle.set_branch(i, branch.made());
    if (c.takes_force) y[setup_->wall_index[i]] = branch.resting;
  }
  now_.particle.set_drives(ramps);
}

/// Runs a search on a copy of the particle, and adopts the mode that the search finds. If it finds none, particle and y
/// stay as they were: the mode tried last is no state of the particle.
template <class Search>
void System::decide_mode(std::span<double> y, Search&& search) {
  before_search_.assign(y.begin(), y.end());
  search_.begin(now_.particle);
  try {
    search();
  } catch (const std::domain_error&) {
    std::ranges::copy(before_search_, y.begin());
    if (!now_.validity) now_.validity = search_.validity();
    throw;
  }
  std::swap(now_.particle, search_.particle());
  if (!now_.validity) now_.validity = search_.validity();
}

void System::begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) {
  if (now_.has_begun) y[k_work] += now_.particle.force_work(y);
  now_.particle.set_drives(ramps);
  for (std::size_t i = 0; i < now_.particle.size(); ++i) {
    ContactBranch branch = now_.particle.branch(i);
    const bool is_by_force = now_.particle.is_force_controlled(i);
    if (is_by_force) branch.resting = y[setup_->wall_index[i]];
    // A driven wall that touches the fresh particle and approaches is in contact from the start, without an event.
    const bool touches_at_once = is_by_force ? setup_->classes[i].gap == 0.0 : now_.particle.drive(i).start() == 0.0;
    if (!now_.has_begun && touches_at_once && now_.particle.drive(i).end() > 0.0) branch.regime = Regime::elastic;
    now_.particle.set_branch(i, branch);
  }
  now_.has_begun = true;
  stick_under_force(y, log);
  y[k_work] -= now_.particle.force_work(y);
  if (now_.particle.centre().is_free()) now_.particle.evaluate(0.0, y);
  decide_mode(y, [&] {
    for (std::size_t i = 0; i < now_.particle.size(); ++i) {
      // A contact that touches already fires no guard when a force begins to press it: the nearest walls close here.
      const contacts::WallDrive& drive = now_.particle.drive(i);
      const bool begins_to_press = now_.particle.is_force_controlled(i) && drive.start() == 0.0 && drive.end() > 0.0;
      if (begins_to_press && search_.particle().branch(i).touches()) search_.touch_under_force(i, 0.0, y, log);
    }
    search_.resolve(0.0, y, log);
  });
  now_.guards.arm(now_.particle, now_.caps, 0.0, y);
  if (const auto end = now_.caps.meet_at_once(now_.particle, log)) throw CannotBegin(*end);
  if (const auto end = reach_centre_at_once(0.0, y)) throw CannotBegin(*end);
}

/// Lets peeling edges stick whose walls are under a force that rises, or stand on the branch of small contact radii,
/// which only displacement control can follow: a falling force then pulls that edge off. The displacement stays.
void System::stick_under_force(std::span<const double> y, std::vector<Event>& log) {
  Particle& p = now_.particle;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.is_force_controlled(i) || !p.branch(i).edge.peels()) continue;
    const Instant& now = p.evaluate(0.0, y).contacts[i];
    const Indenter indenter = p.branch(i).image(p.law(), y[k_growth], now.overlap).indenter;
    const double critical = p.branch(i).pull_off(p.law(), indenter).by_force.contact_radius;
    const double rate = p.drive(i).rate();
    const double at_rest = k_same_value * p.drive(i).size();
    if (!(rate > at_rest) && now.contact.contact_radius > critical) continue;
    p.set_branch(i, p.branch(i).with_edge({Edge::sticking, now.contact.contact_radius}));
    if (rate >= -at_rest) log.push_back({"stick", static_cast<int>(i)});
  }
}

std::optional<DomainEnd> System::fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                      std::vector<Event>& log) {
  fired_.clear();
  for (const std::size_t g : fired) fired_.push_back(now_.guards.list()[g]);
  const bool are_marks = std::ranges::all_of(fired_, &Guard::is_mark);
  std::optional<DomainEnd> end;
  const std::size_t logged = log.size();
  const std::optional<Diagnostic> validity = now_.validity;
  try {
    decide_mode(y, [&] {
      end = search_.apply(fired_, xi, y, now_.caps, log);
      if (!end && !are_marks) search_.resolve(xi, y, log);
    });
  } catch (const std::domain_error&) {
    // There is no equilibrium with the walls that pull, so they let go, as from a fixed centre. A particle that leaves
    // with a wall is not part of the model.
    if (std::erase_if(fired_, [](const Guard& guard) { return guard.kind == k_unstable; }) == 0) throw;
    log.resize(logged);
    now_.validity = validity;
    decide_mode(y, [&] {
      end = search_.apply(fired_, xi, y, now_.caps, log);
      if (!search_.separate_pulling_walls(xi, y, log)) throw;
      if (!end) search_.resolve(xi, y, log);
    });
  }
  if (end) return end;
  now_.guards.arm(now_.particle, now_.caps, xi, y);
  return are_marks ? std::nullopt : now_.caps.meet_at_once(now_.particle, log);
}

/// Reason to stop if a wall already stands at the centre and goes on from there, which fires no guard.
std::optional<DomainEnd> System::reach_centre_at_once(double xi, std::span<const double> y) {
  const Evaluation& at = now_.particle.at_state(xi, y);
  for (std::size_t i = 0; i < now_.particle.size(); ++i) {
    if (1.0 - at.contacts[i].approach > contacts::k_least_distance) continue;
    const Motion now = now_.particle.motion(now_.particle.mode.is_growing);
    if (wall_rate(now_.particle, i, now) > k_just_turned) return centre_reached(static_cast<int>(i));
  }
  return std::nullopt;
}

std::optional<Difficulty> System::difficulty(double xi, std::span<const double> y) {
  // Judges the deepest contact of the whole program: every contact is below the resolution when it is made.
  if (!(setup_->largest_displacement_expected() > k_resolution)) return Difficulty::below_resolution;
  if (!may_peel_off(now_.particle)) return std::nullopt;
  now_.particle.evaluate(xi, y);
  if (centre_stiffness(now_.particle).value >= k_soft_centre) return std::nullopt;
  return Difficulty::soft_centre;
}

void System::complete(double xi, std::span<double> y) { mdr::complete(now_.particle, xi, y); }

void System::rates(double xi, std::span<const double> y, std::span<double> dy) {
  const Evaluation& at = now_.particle.at_state(xi, y);
  dy[k_growth] = now_.particle.mode.is_growing ? now_.particle.growing_motion().growth_rate : 0.0;
  dy[k_work] = at.power;
}

void System::all_rates(double xi, std::span<const double> y, std::span<double> dy) {
  const Evaluation& at = now_.particle.evaluate(xi, y);
  const Motion now = now_.particle.mode.is_growing ? now_.particle.growing_motion() : now_.particle.motion(false);
  dy[k_growth] = now.growth_rate;
  dy[k_work] = at.power;
  set_centre(dy, now_.particle.centre().free_directions(), now.centre);
  for (std::size_t i = 0; i < now_.particle.size(); ++i) {
    if (setup_->classes[i].takes_force) dy[setup_->wall_index[i]] = inward_rate(now_.particle, i, now);
  }
}

void System::residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) {
  // Centre and walls under force are evaluated in equilibrium for the radius in y, so that their singular rows do not
  // couple to the others. Along unconstrained directions the centre stays where it was when the mode began.
  const Mode& mode = now_.particle.mode;
  const int count = now_.particle.centre().free_directions();
  std::ranges::copy(y, trial_.begin());
  for (int k = 0; k < count; ++k) {
    for (int j = 0; j < count; ++j) {
      trial_[centre_index(k)] -= mode.unconstrained(k, j) * (y[centre_index(j)] - mode.held_centre[j]);
    }
  }
  move_centre_and_walls(now_.particle, xi, trial_);
  const Evaluation& at = now_.particle.evaluate(xi, trial_);
  // Throws where growth would run away, as rates() does: no balance exists beyond.
  if (mode.is_growing) static_cast<void>(now_.particle.growing_motion());
  res[k_growth] = mode.is_growing ? at.volume.value - mode.frozen_balance : y[k_growth] - mode.held_growth;
  res[k_work] = dy[k_work] - at.power;
  for (std::size_t k = k_centre; k < unknowns_.size(); ++k) res[k] = y[k] - trial_[k];
}

void System::solve(double xi, std::span<double> y) {
  if (!now_.particle.mode.is_growing) return complete(xi, y);
  grow(now_.particle, xi, y);
  check_softening(now_.particle);
  move_walls(now_.particle, xi, y);  // to the radius of the last iteration
  record_walls(now_.particle, xi, y);
}

/// Kinks are the samples of the pressure table that fully plastic contacts at their largest overlap pass.
double System::next_kink(double after, double xi, std::span<const double> y) {
  const PressureCurve* curve = setup_->law.material.pressure_curve.get();
  if (curve == nullptr) return k_infinity;
  Particle& p = now_.particle;
  const Evaluation& at = p.at_state(xi, y);
  const Motion now = p.motion(p.mode.is_growing);
  double first = k_infinity;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.branch(i).regime != Regime::fully_plastic || !p.branch(i).is_on_primary_branch) continue;
    const double ratio = at.contacts[i].overlap / (1.0 + at.growth);
    const double rate = (inward_rate(p, i, now) + (1.0 - ratio) * now.growth_rate) / (1.0 + at.growth);
    if (rate == 0.0) continue;
    first = std::min(first, xi + (curve->knot_beyond(ratio + rate * (after - xi), rate) - ratio) / rate);
  }
  return first;
}

std::optional<double> System::closed_quadrature(double xi, std::span<const double> y) {
  if (now_.particle.mode.is_growing) return std::nullopt;
  const double force_work = now_.particle.at_state(xi, y).force_work;
  return now_.particle.energy(PlasticPart::work_done) - force_work;
}

}  // namespace monograin::mdr
