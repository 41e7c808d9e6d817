#include "mdr/system.hpp"

#include <algorithm>
#include <cmath>

#include "mdr/centre_search.hpp"
#include "mdr/equilibrium.hpp"
#include "mdr/support.hpp"
#include "system/difficulty.hpp"
#include "system/limit.hpp"

namespace monograin::mdr {
namespace {

// Stiffness of a free centre below which a fold is so near that errors are magnified.
constexpr double k_soft_centre = 0.1;

}  // namespace

void System::start(std::span<double> y) {
  std::ranges::fill(y, 0.0);
  particle_ = Particle(setup_);
  search_ = ModeSearch(particle_);
  caps_ = ContactCaps(*setup_);
  has_begun_ = false;
  std::vector<Ramp> ramps;
  for (std::size_t i = 0; i < particle_.size(); ++i) {
    const ContactClass& c = setup_->classes[i];
    const double gap = c.gap / setup_->length_unit();
    ramps.push_back({-c.gap, -c.gap, Control::displacement});
    ContactBranch branch;
    branch.resting = -gap;
    // A free centre is held by whatever it touches; otherwise resting walls stay open until the particle grows against
    // them.
    if (gap == 0.0 && particle_.centre().acts(i)) branch = branch.made();
    particle_.set_branch(i, branch);
    if (c.takes_force) y[setup_->wall_index[i]] = -gap;
  }
  particle_.set_drives(ramps);
}

/// Runs a search on a copy of the particle, and takes the mode over that it finds. Where it finds none, the last row of
/// the history shows the one that it tried last.
template <class Search>
void System::decide_mode(Search&& search) {
  search_.begin(particle_);
  try {
    search();
  } catch (const std::domain_error&) {
    std::swap(particle_, search_.particle());
    throw;
  }
  std::swap(particle_, search_.particle());
}

void System::begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) {
  if (has_begun_) y[k_work] += particle_.force_work(y);
  particle_.set_drives(ramps);
  for (std::size_t i = 0; i < particle_.size(); ++i) {
    ContactBranch branch = particle_.branch(i);
    const bool is_loaded = particle_.is_loaded(i);
    if (is_loaded) branch.resting = y[setup_->wall_index[i]];
    // A driven wall that touches the fresh particle and approaches is in contact from the start, without an event.
    const bool touches_at_once = is_loaded ? setup_->classes[i].gap == 0.0 : particle_.drive(i).start() == 0.0;
    if (!has_begun_ && touches_at_once && particle_.drive(i).end() > 0.0) branch.regime = Regime::elastic;
    particle_.set_branch(i, branch);
  }
  has_begun_ = true;
  y[k_work] -= particle_.force_work(y);
  if (particle_.centre().is_free()) particle_.evaluate(0.0, y);
  decide_mode([&] {
    for (std::size_t i = 0; i < particle_.size(); ++i) {
      // The nearest walls close with it, as no guard is met by one that touches already.
      const contacts::WallDrive& drive = particle_.drive(i);
      const bool begins_to_press = particle_.is_loaded(i) && drive.start() == 0.0 && drive.end() > 0.0;
      if (begins_to_press && search_.particle().branch(i).touches()) search_.close_with(i, log);
    }
    search_.resolve(0.0, y, log);
  });
  guards_.arm(particle_, caps_, 0.0, y);
  if (const auto end = caps_.meet_at_once(particle_, log)) throw CannotBegin(*end);
  if (const auto end = reach_centre_at_once(0.0, y)) throw CannotBegin(*end);
}

std::optional<DomainEnd> System::fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                      std::vector<Event>& log) {
  std::vector<Guard> guards;
  for (const std::size_t g : fired) guards.push_back(guards_.list()[g]);
  const bool are_marks = std::ranges::all_of(guards, &Guard::is_mark);
  std::optional<DomainEnd> end;
  decide_mode([&] {
    end = search_.apply(guards, xi, y, caps_, log);
    if (!end && !are_marks) search_.resolve(xi, y, log);
  });
  if (end) return end;
  guards_.arm(particle_, caps_, xi, y);
  return are_marks ? std::nullopt : caps_.meet_at_once(particle_, log);
}

/// Asks for a wall that stands at the limit already, and goes on from there, which no guard meets.
std::optional<DomainEnd> System::reach_centre_at_once(double xi, std::span<const double> y) {
  const Evaluation& at = particle_.evaluated(xi, y);
  for (std::size_t i = 0; i < particle_.size(); ++i) {
    if (1.0 - at.contacts[i].displacement > k_least_distance) continue;
    const Motion now = particle_.motion(particle_.mode.is_growing);
    if (wall_rate(particle_, i, now) > k_at_rest) return centre_reached(static_cast<int>(i));
  }
  return std::nullopt;
}

std::optional<Difficulty> System::difficulty(double xi, std::span<const double> y) {
  // Of the whole program: every contact is as shallow when it is made.
  if (!(setup_->largest_overlap_expected() > k_resolution)) return Difficulty::below_resolution;
  if (!weakest_contact(particle_)) return std::nullopt;
  particle_.evaluate(xi, y);
  if (centre_stiffness(particle_).value >= k_soft_centre) return std::nullopt;
  return Difficulty::soft_centre;
}

void System::complete(double xi, std::span<double> y) { mdr::complete(particle_, xi, y); }

void System::rates(double xi, std::span<const double> y, std::span<double> dy) {
  const Evaluation& at = particle_.evaluated(xi, y);
  dy[k_radius] = particle_.mode.is_growing ? particle_.growing_motion().growth : 0.0;
  dy[k_work] = at.power;
}

void System::all_rates(double xi, std::span<const double> y, std::span<double> dy) {
  const Evaluation& at = particle_.evaluate(xi, y);
  const Motion now = particle_.mode.is_growing ? particle_.growing_motion() : particle_.motion(false);
  dy[k_radius] = now.growth;
  dy[k_work] = at.power;
  set_centre(dy, particle_.centre().count(), now.centre);
  for (std::size_t i = 0; i < particle_.size(); ++i) {
    if (setup_->classes[i].takes_force) dy[setup_->wall_index[i]] = inward_rate(particle_, i, now);
  }
}

void System::residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) {
  // Centre and walls under force stand where the radius puts them, so that their singular rows do not couple to the
  // others. In directions in which nothing constrains it, the centre stays where it was.
  const Mode& mode = particle_.mode;
  const int count = particle_.centre().count();
  std::ranges::copy(y, trial_.begin());
  for (int k = 0; k < count; ++k) {
    for (int j = 0; j < count; ++j) {
      trial_[centre_index(k)] -= mode.unconstrained(k, j) * (y[centre_index(j)] - mode.held_centre[j]);
    }
  }
  place(particle_, xi, trial_);
  const Evaluation& at = particle_.evaluate(xi, trial_);
  // Beyond where growth would run away there is no balance to be found; the rates end there, too.
  if (mode.is_growing) static_cast<void>(particle_.growing_motion());
  res[k_radius] = mode.is_growing ? at.volume.value - mode.frozen_balance : y[k_radius] - mode.held_radius;
  res[k_work] = dy[k_work] - at.power;
  for (std::size_t k = k_centre; k < unknowns_.size(); ++k) res[k] = y[k] - trial_[k];
}

void System::solve(double xi, std::span<double> y) {
  if (!particle_.mode.is_growing) return complete(xi, y);
  grow(particle_, xi, y);
  check_softening(particle_);
  particle_.move_walls(xi, y);  // to the radius of the last iteration
  particle_.record_walls(xi, y);
}

std::optional<double> System::closed_quadrature(double xi, std::span<const double> y) {
  if (particle_.mode.is_growing) return std::nullopt;
  const double force_work = particle_.evaluated(xi, y).force_work;
  return particle_.energy(PlasticPart::work_done) - force_work;
}

double System::balance_residual(double xi, std::span<const double> y) {
  const Evaluation& at = particle_.evaluate(xi, y);
  return particle_.mode.is_growing ? at.volume.value - particle_.mode.frozen_balance : 0.0;
}

}  // namespace monograin::mdr
