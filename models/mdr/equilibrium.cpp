#include "mdr/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "mdr/centre_search.hpp"
#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {
namespace {

// Step of the growing radius after which Newton's next one is round-off, if the equations are smooth.
constexpr double k_smooth_last_step = 1e-10;
// Longest step of the growing radius (over R0).
constexpr double k_longest_step = 0.1;

bool peels_anywhere(const Particle& p) noexcept {
  return std::ranges::any_of(p.branches(), [](const ContactBranch& branch) { return branch.edge.peels(); });
}

/// Bounds of the growth while Newton's method solves for it. The balance rises with the radius, but has a kink where a
/// wall under force pulls off: Newton's method may step across it and back without end. The radii seen on either side
/// bound the next one, and bisection breaks the cycle.
struct GrowthBracket {
  double below = -k_infinity;
  double above = k_infinity;

  /// Takes note of the defect of the balance at a growth.
  /// @return the step from there, or one to the middle of the bracket if that step leads out of it
  double step_within(double growth, double step, double defect, double last_step) {
    (defect < 0.0 ? below : above) = growth;
    const double next = growth + step;
    const bool is_bounded = std::isfinite(above - below);
    const bool leads_out = is_bounded && (next <= below || next >= above);
    return leads_out && std::abs(step) >= std::max(last_step, k_resolution) ? std::midpoint(below, above) - growth
                                                                            : step;
  }
};

/// A step of the growing radius by Newton's method. The centre takes to_balance + radius * by_radius with it.
struct GrowthStep {
  double radius = 0.0;
  double defect = 0.0;  ///< of the volume balance, once the centre is in balance
  CentreVector to_balance = CentreVector::Zero();
  CentreVector by_radius = CentreVector::Zero();
};

/// Step from the state that was evaluated last.
/// @throws std::domain_error where the free surface is used up
GrowthStep newton_step(const Particle& p) {
  const VolumeBalance& volume = p.at().volume;
  GrowthStep step{.defect = volume.value - p.mode.frozen_balance};
  double slope = volume.by_radius;
  if (p.centre().is_free()) {
    step.to_balance = p.centre().step();
    step.by_radius = p.centre().by_radius();
    slope += p.at().volume_by_centre.dot(step.by_radius);
    step.defect += p.at().volume_by_centre.dot(step.to_balance);
  }
  if (!(slope > 0.0)) throw DomainError(Limit::free_surface_used_up);
  step.radius = std::clamp(-step.defect / slope, -k_longest_step, k_longest_step);
  return step;
}

}  // namespace

void move_walls(const Particle& p, double xi, std::span<double> y) {
  if (!p.setup().takes_forces) return;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.is_force_controlled(i)) continue;
    double& wall = y[p.setup().wall_index[i]];
    wall = p.branch(i).approach_under(p.law(), y[k_growth], p.drive(i).value(xi), wall);
  }
}

void record_walls(const Particle& p, double xi, std::span<double> y) noexcept {
  if (!p.setup().takes_forces) return;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.setup().classes[i].takes_force && !p.is_force_controlled(i))
      y[p.setup().wall_index[i]] =
          p.prescribed_displacement(i, xi) + p.centre().approach_by_centre(i, y.subspan(k_centre));
  }
}

void move_centre_and_walls(Particle& p, double xi, std::span<double> y) {
  move_walls(p, xi, y);
  if (p.centre().is_free()) move_centre(p, xi, y);
  record_walls(p, xi, y);
}

void complete(Particle& p, double xi, std::span<double> y) {
  if (!p.mode.is_growing) y[k_growth] = p.mode.held_growth;
  bool is_balanced = true;
  try {
    move_centre_and_walls(p, xi, y);
  } catch (const std::domain_error&) {
    // From a guess beyond pull-off the search gets stuck at a minimum of the net force.
    is_balanced = false;
    if (!may_peel_off(p) || !leave_saddle(p, xi, y, is_balanced)) throw;
  }
  if (!may_peel_off(p)) return;
  // If no equilibrium holds the centre, y stays at the saddle, where centre_stiffness_guard() fires.
  if (is_balanced) leave_saddle(p, xi, y, is_balanced);
  record_walls(p, xi, y);
}

void grow(Particle& p, double xi, std::span<double> y) {
  const int count = p.centre().free_directions();
  GrowthBracket bracket;
  double step_size = k_infinity;
  // Quadratic convergence makes the next step round-off below this. Convergence is slower where forces go with a square
  // root: for an idle contact of a free centre, or an edge next to pull-off.
  const double last_step = !p.centre().is_free() && !peels_anywhere(p) ? k_smooth_last_step : 2.0 * k_epsilon;
  for (int iteration = 0; iteration < k_most_newton_steps; ++iteration) {
    move_walls(p, xi, y);
    p.evaluate(xi, y);
    GrowthStep step = newton_step(p);
    if (!p.centre().is_free()) step.radius = bracket.step_within(y[k_growth], step.radius, step.defect, last_step);
    y[k_growth] += step.radius;
    const CentreVector centre_step = step.to_balance + step.radius * step.by_radius;
    if (count > 0) set_centre(y, count, centre_of(y, count) + centre_step);
    const double size = std::max(std::abs(step.radius), centre_step.norm());
    if (size < last_step) return;
    // A step that is not much shorter than the last one, and below the resolution, is round-off. A centre that soft
    // contacts hold moves by more than that even where forces balance.
    const bool is_balanced = std::abs(step.radius) < k_resolution && p.centre().force().norm() <= p.force_round_off();
    if (size >= 0.5 * step_size && (size < k_resolution || is_balanced)) return;
    step_size = size;
  }
  throw DomainError(Limit::no_solution, "the balance of volumes was not found");
}

}  // namespace monograin::mdr
