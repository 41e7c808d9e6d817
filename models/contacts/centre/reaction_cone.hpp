/// Reaction cone: the pushes that walls can balance which press and do not pull.
#pragma once

#include <Eigen/Core>
#include <span>

#include "system/resolution.hpp"

namespace monograin {

/// True if non-negative multiples of the directions, none above a million times the push, add up to its opposite to
/// within a tolerance: the push lies in the negative cone of the directions. Found by non-negative least squares with
/// active sets (Lawson and Hanson, 1974), which Eigen 3.4 lacks.
/// @param push        not zero
/// @param directions  unit vectors
/// @param nothing     tolerance: unbalanced remainder over the push
[[nodiscard]] bool in_reaction_cone(const Eigen::Vector3d& push, std::span<const Eigen::Vector3d> directions,
                                    double nothing = k_no_direction);

}  // namespace monograin
