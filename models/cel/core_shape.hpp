/// Shapes that the core of a particle can take among given walls.
///
/// The core yields under stresses that depend on the walls and its own shape only. The shape therefore stays among the
/// symmetric tensors that arise from the walls' normals by sums and by products a b + b a: two independent tensors for
/// two walls or a die, three for walls along three axes, six in general.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace monograin::cel {

/// sum of a_ij b_ij.
[[nodiscard]] inline double contraction(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) noexcept {
  return a.cwiseProduct(b).sum();
}
[[nodiscard]] inline Eigen::Matrix3d symmetric(const Eigen::Matrix3d& a) noexcept { return 0.5 * (a + a.transpose()); }
[[nodiscard]] inline Eigen::Matrix3d deviator(const Eigen::Matrix3d& a) noexcept {
  return a - a.trace() / 3.0 * Eigen::Matrix3d::Identity();
}

/// An orthonormal basis of the tensors among which the shape of the core stays. The first is the unit tensor over
/// sqrt(3), so that all others are deviators. Empty if there are no others: walls that load the core by pressures only
/// leave its shape as it is.
/// @param spreads  sum of n n over the walls of each class
[[nodiscard]] std::vector<Eigen::Matrix3d> core_shapes(std::span<const Eigen::Matrix3d> spreads);

}  // namespace monograin::cel
