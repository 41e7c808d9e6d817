/// The coupled equations of the contacts (nonlocal/contacts.hpp) under what the program prescribes to the
/// walls.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "nonlocal/contacts.hpp"
#include "system/walls.hpp"

namespace monograin::nonlocal {

/// Value that is prescribed to the walls of a class.
struct Target {
  bool is_force = false;
  double value = 0.0;          ///< displacement or force
  double signed_square = 0.0;  ///< s under the prescribed force
};

/// @throws std::domain_error for a value that is not finite, or a force that no contact bears
[[nodiscard]] Target target_of(const Contacts& contacts, bool is_force, double value);
/// Targets at an instant of a step of the program.
void set_targets(const Contacts& contacts, std::span<const Ramp> ramps, double xi, std::span<Target> targets);
/// Targets of which a state is the solution, with the controls of `ends`.
void set_targets_of(Contacts& contacts, std::span<const double> y, std::span<const Target> ends,
                    std::span<Target> targets);
/// Targets on the straight line from starts to ends.
void set_targets_between(const Contacts& contacts, std::span<const Target> starts, std::span<const Target> ends,
                         double share, std::span<Target> targets);

/// Residual of the equations, one per unknown: the approach under displacement control, s_j - s(F_j) under force
/// control, the net force for each free direction.
void residual(Contacts& contacts, std::span<const Ramp> ramps, double xi, std::span<const double> y,
              std::span<double> residual);
/// d(residual)/dy.
void jacobian(Contacts& contacts, std::span<const Ramp> ramps, std::span<const double> y, Eigen::MatrixXd& jacobian);

}  // namespace monograin::nonlocal
