#include "cel/newton.hpp"

#include <algorithm>
#include <cmath>

#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::cel {
namespace {

constexpr int k_most_polishings = 4;
constexpr double k_most_growth = 0.03;  ///< largest growth of a dent in one correction
/// Smallest dent of a trial, over a_Y: a dent that begins to flow is a_Y to within round-off.
constexpr double k_least_dent = 0.9;

}  // namespace

/// Largest residual of the state that was evaluated, as a displacement. A yield function counts times the elastic
/// displacement, because it has the relative accuracy of that; a net force times the displacement over the
/// force of a contact that bears the largest force F, which by Hertz goes with F^(-1/3).
double Newton::error(const Particle& p, double xi) {
  const Layout& layout = p.layout();
  p.residual(xi, {residual_.data(), layout.core()});
  double largest = 0.0;
  double force = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Contact& contact = p.classes[i].contact;
    force = std::max(force, contact.F);
    largest = std::max(
        {largest, std::abs(residual_(i, 0)), std::min(1.0, contact.u) * std::abs(residual_(layout.dent(i), 0))});
  }
  if (layout.directions == 0) return largest;
  const double softness = force > 0.0 ? std::max(1.0, 1.0 / std::cbrt(force)) : 1.0;
  return std::max(largest,
                  softness * residual_.col(0).segment(layout.centre(0), layout.directions).cwiseAbs().maxCoeff());
}

/// Corrects a state by a Newton step, halved until the error is less than a bound.
/// @return the error of the corrected state
double Newton::correct(Particle& p, double xi, std::span<double> y, double bound) {
  const Layout& layout = p.layout();
  tangent_.set(p, false);
  tangent_.solve(residual_, correction_);
  before_.assign(y.begin(), y.end());
  double growth = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) growth = std::max(growth, std::abs(correction_(layout.dent(i), 0)));
  double share = std::min(1.0, k_most_growth / growth);
  double now = 0.0;
  for (int halvings = 0; halvings < k_most_halvings; ++halvings, share *= 0.5) {
    for (std::size_t j = 0; j < layout.core(); ++j) {
      y[j] = before_[j] - share * correction_(j, 0);
      if (layout.is_dent(j)) y[j] = std::max(y[j], k_least_dent * p.material().a_Y);
    }
    p.evaluate(y, p.any_flows());
    now = error(p, xi);
    if (now < bound) break;
  }
  return now;
}

void Newton::solve(Particle& p, double xi, std::span<double> y) {
  residual_.setZero(p.layout().core(), 2);
  p.prescribe(xi, y);
  double largest = p.any_flows() ? p.material().Y : 0.0;
  for (const ClassState& c : p.classes) largest = std::max(largest, std::abs(c.drive.value(xi)));
  p.evaluate(y, p.any_flows());
  p.choose_balance();
  double now = error(p, xi);
  // A free centre is corrected further: where only the weak spring holds it, a tiny net force still moves it far.
  const bool is_free = p.layout().directions > 0;
  int polished = 0;
  for (int i = 0; i < k_most_newton_steps && (is_free || now > k_round_off * largest); ++i) {
    // Below this residual, corrections only polish: round-off may make it larger.
    const bool is_polishing = now <= k_same_value * largest;
    const double next = correct(p, xi, y, is_polishing ? k_infinity : now);
    if (!(next < now) && (!is_polishing || !is_free)) {
      std::ranges::copy(before_, y.begin());
      break;
    }
    now = next;
    double correction = 0.0;
    for (std::size_t j = 0; j < p.layout().core(); ++j) {
      if (!p.layout().is_dent(j)) correction = std::max(correction, std::abs(correction_(j, 0)));
    }
    if (is_polishing && (correction <= k_round_off * largest || ++polished == k_most_polishings)) break;
  }
  p.evaluate(y);
  const bool has_force_control = std::ranges::any_of(p.classes, &ClassState::is_force_controlled);
  if (has_force_control && p.centre.room(xi, p.position()) < 0.0) throw DomainError(Limit::centre_driven_away);
  if (!(now <= k_solved * std::max(largest, p.material().Y))) throw DomainError(Limit::applicability);
}

}  // namespace monograin::cel
