/// The contacts' equations, linearized at given stiffnesses: response of the approaches, and of a free centre.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "nonlocal/contacts.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {

/// True where all stiffnesses vanish together, as at first touch. Callers of Tangent::move_centre() then substitute
/// equal ones, under which the centre moves as between equal contacts.
[[nodiscard]] bool carries_no_load(std::span<const double> stiffness) noexcept;

/// Projector on the directions in which no contact supports the centre. Removes the direction of the stiffest contact
/// first: beside it, the eigenvalues of the full matrix do not distinguish a contact that has just begun from none.
/// @param stiffness  class -> dF/dg
template <class Stiffness>
[[nodiscard]] Eigen::Matrix3d directions_of_nothing(const Contacts& contacts, Stiffness&& stiffness) {
  Eigen::Matrix3d projector = Eigen::Matrix3d::Identity();
  double stiffest = 0.0;
  for (std::size_t count = 0; count < contacts.free_count(); ++count) {
    double hold = 0.0;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    for (std::size_t j = 0; j < contacts.class_count(); ++j) {
      const Eigen::Vector3d along = projector * contacts.mean_normal(j);
      const double own = contacts.weight(j) * stiffness(j) * along.squaredNorm();
      if (!(own > hold)) continue;
      hold = own;
      direction = along.normalized();
    }
    stiffest = std::max(stiffest, hold);
    if (!(hold > k_no_stiffness * stiffest)) break;
    projector -= direction * direction.transpose();
  }
  return projector;
}

/// The equations (1 - G dF/dg) x = b for the approaches x, with the right-hand side b that the caller sets and one for
/// each free direction, the approaches by a displacement of the centre.
class Tangent {
 public:
  explicit Tangent(const Contacts& contacts)
      : stride_(contacts.class_count() + 1 + contacts.free_count()), matrix_(contacts.class_count() * stride_) {}

  /// Right-hand side of a class; its solution after eliminate().
  [[nodiscard]] double& approach(std::size_t j) noexcept { return row(j)[stride_ - 1]; }

  /// Solves for all right-hand sides. The pivots are those of M, because scaling by the roots of dF/dg makes the two
  /// matrices one. No pivot has to be searched for, and one that is not positive is beyond the limit.
  /// @return false beyond the limit
  [[nodiscard]] bool eliminate(const Contacts& contacts, std::span<const double> stiffness);
  /// Displacement of the centre that cancels a net force to first order. Directions that no contact supports stay.
  /// @param stiffness  of contacts that have met the centre; may be larger than in eliminate()
  [[nodiscard]] Eigen::Vector3d step_to_balance(const Contacts& contacts, std::span<const double> stiffness,
                                                const Eigen::Vector3d& net_force) const;
  /// Displaces the centre so that a net force vanishes to first order, and updates the approaches.
  void move_centre(const Contacts& contacts, std::span<const double> stiffness, const Eigen::Vector3d& net_force,
                   std::span<double> centre);

 private:
  [[nodiscard]] bool eliminate_in_order(const Contacts& contacts, std::span<const double> stiffness) noexcept;
  [[nodiscard]] bool eliminate_loaded(const Contacts& contacts, std::span<const double> stiffness);
  [[nodiscard]] double* row(std::size_t j) noexcept { return matrix_.data() + j * stride_; }
  [[nodiscard]] const double* row(std::size_t j) const noexcept { return matrix_.data() + j * stride_; }

  std::size_t stride_;
  std::vector<double> matrix_;  ///< a row per class: 1 - G dF/dg, approaches by the centre, right-hand side
  // Work space of eliminate_loaded().
  std::vector<Eigen::Index> loaded_;
  Eigen::MatrixXd symmetric_, solutions_, forces_;
  Eigen::VectorXd roots_;
};

}  // namespace monograin::nonlocal
