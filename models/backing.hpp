/// What walls that only press can balance.
#pragma once

#include <Eigen/Core>
#include <span>

namespace monograin {

/// Whether non-negative multiples of the directions, none beyond a million times a push, add up to its opposite but for
/// nothing: non-negative least squares by active sets (Lawson and Hanson), which end with nothing left over if they
/// can.
/// @param push        not zero
/// @param directions  unit vectors
/// @param nothing     what may be left over, of the push
[[nodiscard]] bool can_back(const Eigen::Vector3d& push, std::span<const Eigen::Vector3d> directions,
                            double nothing = 1e-6);

}  // namespace monograin
