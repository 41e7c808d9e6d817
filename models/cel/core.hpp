/// The core of a particle: the shapes that it can take among given walls, its load, its flow, and the yield of
/// contacts.
///
/// The core yields under stresses that depend on the walls and its own shape only. The shape therefore stays among the
/// symmetric tensors that arise from the walls' normals by sums and by products a b + b a: two independent tensors for
/// two walls or a die, three for walls along three axes, six in general.
///
/// Lam is the rate of flow of the core: the sum of F (1 - b) h'/X over the contacts that drive it. Equations are those
/// of docs/theory/cel.md.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "cel/contact_law.hpp"

namespace monograin::cel {

/// sum of a_ij b_ij.
[[nodiscard]] inline double contraction(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) noexcept {
  return a.cwiseProduct(b).sum();
}

/// An orthonormal basis of the tensors among which the shape of the core stays. The first is the unit tensor over
/// sqrt(3), so that all others are deviators. Empty if the unit tensor is the only one: walls that load the core by
/// pressures only leave its shape as it is.
/// @param spreads  sum of n n over the walls of each class
[[nodiscard]] std::vector<Eigen::Matrix3d> core_shapes(std::span<const Eigen::Matrix3d> spreads);

/// Shape of the core and its accumulated equivalent strain, or the rates of both.
struct Core {
  /// Metric, of determinant 1; the support distance along n is sqrt(n.C n).
  Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
  double e = 0.0;
};

/// Load of a core, and its flow under that load.
struct CoreLoad {
  Core core{};
  Eigen::Matrix3d pushes = Eigen::Matrix3d::Zero();  ///< sum of F phi n n over all walls

  // By evaluate().
  double Y = 1.0;                               ///< yield stress
  Eigen::Matrix3d T = Eigen::Matrix3d::Zero();  ///< deviator of the load
  double s = 0.0, per_s = 0.0;                  ///< size of the load; 0: too small to have a direction
  double per_S = 1.0, use = 0.0, Q = 0.0;       ///< strength S, and used shares s/S, (s/S)^n2
  Core flow{};                                  ///< C' and e' over Lam

  void evaluate(double yield_stress) noexcept;
};

/// Yield of a contact beside a core under load. An open contact has f = -1.
struct Yield {
  double tau = 0.0;   ///< share of the wall in the load of the core
  double b = 0.0;     ///< 1: carried by the flow of the core; 0: drives it
  double weak = 1.0;  ///< factor by which a core that flows weakens a carried contact
  double X = 0.0;     ///< used share of the strength of the dent
  double f = -1.0;    ///< yield function
};
/// @param wall  n n
[[nodiscard]] Yield yield_of(const Contact& contact, const CoreLoad& load, const Eigen::Matrix3d& wall) noexcept;

/// Derivatives of a yield function by quantities of its contact, by the pushes on the core, and by Lam at given forces.
struct YieldSlopes {
  double by_F = 0.0, by_H = 0.0, by_alpha = 0.0;
  Eigen::Matrix3d by_pushes = Eigen::Matrix3d::Zero();
  double by_flow = 0.0;
};
/// @param pushes_by_flow  derivative of the pushes by Lam, at given forces
[[nodiscard]] YieldSlopes slopes_of(const Yield& at, const Contact& contact, const CoreLoad& load,
                                    const Eigen::Matrix3d& wall, const Eigen::Matrix3d& pushes_by_flow) noexcept;

}  // namespace monograin::cel
