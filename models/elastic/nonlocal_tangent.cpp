#include "elastic/nonlocal_tangent.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "system/resolution.hpp"

namespace monograin::nonlocal {

bool carries_no_load(std::span<const double> stiffness) noexcept {
  return std::ranges::all_of(stiffness, [](double one) { return one == 0.0; });
}

bool Tangent::eliminate(const Contacts& contacts, std::span<const double> stiffness) noexcept {
  const std::size_t n = contacts.class_count();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t h = 0; h < n; ++h) row(i)[h] = -contacts.coupling()(as_index(i), as_index(h)) * stiffness[h];
    row(i)[i] += 1.0;
    for (std::size_t k = 0; k < contacts.free_count(); ++k) row(i)[n + k] = contacts.arm(i)[as_index(k)];
  }
  for (std::size_t p = 0; p < n; ++p) {
    double* const pivot_row = row(p);
    if (!(pivot_row[p] > 0.0)) return false;
    const double inverse = 1.0 / pivot_row[p];
    for (std::size_t c = p + 1; c < stride_; ++c) pivot_row[c] *= inverse;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == p) continue;
      double* const other = row(i);
      const double factor = other[p];
      for (std::size_t c = p + 1; c < stride_; ++c) other[c] -= factor * pivot_row[c];
    }
  }
  return true;
}

Eigen::Vector3d Tangent::step_to_balance(const Contacts& contacts, std::span<const double> stiffness,
                                         const Eigen::Vector3d& net_force) const {
  const std::size_t n = contacts.class_count();
  Eigen::Matrix3d hold = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < contacts.free_count(); ++k) {
    for (std::size_t l = 0; l < contacts.free_count(); ++l) {
      for (std::size_t j = 0; j < n; ++j) {
        hold(as_index(k), as_index(l)) +=
            contacts.weight(j) * contacts.arm(j)[as_index(k)] * stiffness[j] * row(j)[n + l];
      }
    }
  }
  // The matrix is symmetric unless stiffnesses have been lent. Its unsupported directions are the same from both sides.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(0.5 * (hold + hold.transpose()));
  const double least = k_no_stiffness * solver.eigenvalues().cwiseAbs().maxCoeff();
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d direction = solver.eigenvectors().col(k);
    if (std::abs(solver.eigenvalues()[k]) > least)
      step -= direction * (direction.dot(net_force) / solver.eigenvalues()[k]);
  }
  return step;
}

void Tangent::move_centre(const Contacts& contacts, std::span<const double> stiffness, const Eigen::Vector3d& net_force,
                          std::span<double> centre) {
  const std::size_t n = contacts.class_count();
  const Eigen::Vector3d step = step_to_balance(contacts, stiffness, net_force);
  for (std::size_t k = 0; k < contacts.free_count(); ++k) {
    centre[k] += step[as_index(k)];
    for (std::size_t j = 0; j < n; ++j) approach(j) += row(j)[n + k] * step[as_index(k)];
  }
}

}  // namespace monograin::nonlocal
