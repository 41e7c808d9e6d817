#include "nonlocal/equations.hpp"

#include <cmath>
#include <stdexcept>

namespace monograin::nonlocal {

Target target_of(const Contacts& contacts, bool is_force, double value) {
  if (!std::isfinite(value)) throw std::domain_error("a wall is prescribed a value that is not finite");
  return {is_force, value, is_force ? contacts.law().signed_square_under(value / contacts.composite_modulus()) : 0.0};
}

void set_targets(const Contacts& contacts, std::span<const Ramp> ramps, double xi, std::span<Target> targets) {
  for (std::size_t j = 0; j < targets.size(); ++j) {
    targets[j] = target_of(contacts, ramps[j].is_force_controlled(), ramps[j].value(xi));
  }
}

void set_targets_of(Contacts& contacts, std::span<const double> y, std::span<const Target> ends,
                    std::span<Target> targets) {
  const Evaluation& at = contacts.evaluate(y);
  for (std::size_t j = 0; j < targets.size(); ++j) {
    const bool is_force = ends[j].is_force;
    targets[j] = {is_force, is_force ? at.forces[j] : at.local[j].approach - contacts.lift(j, at.forces, y), y[j]};
  }
}

void set_targets_between(const Contacts& contacts, std::span<const Target> starts, std::span<const Target> ends,
                         double share, std::span<Target> targets) {
  for (std::size_t j = 0; j < targets.size(); ++j) {
    targets[j] = share == 1.0 ? ends[j]
                              : target_of(contacts, ends[j].is_force, std::lerp(starts[j].value, ends[j].value, share));
  }
}

void residual(Contacts& contacts, std::span<const Ramp> ramps, double xi, std::span<const double> y,
              std::span<double> residual) {
  const std::size_t n = contacts.class_count();
  const Evaluation& at = contacts.evaluate(y);
  for (std::size_t j = 0; j < n; ++j) {
    const Target goal = target_of(contacts, ramps[j].is_force_controlled(), ramps[j].value(xi));
    residual[j] =
        goal.is_force ? y[j] - goal.signed_square : at.local[j].approach - goal.value - contacts.lift(j, at.forces, y);
  }
  if (contacts.free_count() > 0) contacts.set_centre(contacts.net_force(at.forces), residual);
}

void jacobian(Contacts& contacts, std::span<const Ramp> ramps, std::span<const double> y, Eigen::MatrixXd& jacobian) {
  const std::size_t n = contacts.class_count();
  const Evaluation& at = contacts.evaluate(y);
  jacobian.setZero(as_index(contacts.unknown_count()), as_index(contacts.unknown_count()));
  for (std::size_t j = 0; j < n; ++j) {
    const double force_slope = at.stiffness[j] * at.local[j].approach_slope;
    const Eigen::Vector3d& mean_normal = contacts.mean_normal(j);
    for (std::size_t k = 0; k < contacts.free_count(); ++k)
      jacobian(as_index(n + k), as_index(j)) = contacts.weight(j) * mean_normal[as_index(k)] * force_slope;
    for (std::size_t i = 0; i < n; ++i) {
      if (ramps[i].is_force_controlled()) continue;
      jacobian(as_index(i), as_index(j)) = -contacts.coupling()(as_index(i), as_index(j)) * force_slope;
    }
    if (ramps[j].is_force_controlled()) {
      jacobian(as_index(j), as_index(j)) = 1.0;
    } else {
      jacobian(as_index(j), as_index(j)) += at.local[j].approach_slope;
      for (std::size_t k = 0; k < contacts.free_count(); ++k)
        jacobian(as_index(j), as_index(n + k)) = -mean_normal[as_index(k)];
    }
  }
}

}  // namespace monograin::nonlocal
