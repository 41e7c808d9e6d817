#include "nonlocal/tangent.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

// From this number of classes on, Eigen's blocked method over the loaded ones is faster than elimination in order: at
// 64 by 1.3 to 2, at 200 by 3 to 4 if all are loaded.
constexpr std::size_t k_many_classes = 48;

}  // namespace

bool carries_no_load(std::span<const double> stiffness) noexcept {
  return std::ranges::all_of(stiffness, [](double one) { return one == 0.0; });
}

bool Tangent::eliminate(const Contacts& contacts, std::span<const double> stiffness) {
  return contacts.class_count() < k_many_classes ? eliminate_in_order(contacts, stiffness)
                                                 : eliminate_loaded(contacts, stiffness);
}

bool Tangent::eliminate_in_order(const Contacts& contacts, std::span<const double> stiffness) noexcept {
  const std::size_t n = contacts.class_count();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t h = 0; h < n; ++h) row(i)[h] = -contacts.coupling()(as_index(i), as_index(h)) * stiffness[h];
    row(i)[i] += 1.0;
    for (std::size_t k = 0; k < contacts.free_count(); ++k) row(i)[n + k] = contacts.mean_normal(i)[as_index(k)];
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

/// Solves M z = S b for the loaded classes by Cholesky's method, where S holds the roots of their stiffnesses,
/// M = 1 - S G' S, and G' is the influence G over the weight of the class that acts, which is symmetric. Then
/// x = b + G' S z.
bool Tangent::eliminate_loaded(const Contacts& contacts, std::span<const double> stiffness) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::MatrixXd& coupling = contacts.coupling();
  const Eigen::Index n = as_index(contacts.class_count());
  const Eigen::Index columns = as_index(1 + contacts.free_count());
  const auto weight = [&](Eigen::Index j) { return contacts.weight(static_cast<std::size_t>(j)); };
  Eigen::Map<Rows> rows(matrix_.data(), n, as_index(stride_));
  auto right = rows.rightCols(columns);
  loaded_.clear();
  roots_.resize(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const std::size_t i = static_cast<std::size_t>(j);
    right.row(j).head(columns - 1) = contacts.mean_normal(i).head(columns - 1).transpose();
    roots_[j] = std::sqrt(contacts.weight(i) * stiffness[i]);
    if (stiffness[i] != 0.0) loaded_.push_back(j);
  }
  if (loaded_.empty()) return true;
  const Eigen::Index count = as_index(loaded_.size());
  symmetric_.resize(count, count);
  solutions_.resize(count, columns);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index h = loaded_[static_cast<std::size_t>(k)];
    const double* const influence = &coupling(0, h);
    const double scale = -roots_[h] / weight(h);
    for (Eigen::Index m = k; m < count; ++m) {
      const Eigen::Index i = loaded_[static_cast<std::size_t>(m)];
      symmetric_(m, k) = scale * influence[i] * roots_[i];
    }
    symmetric_(k, k) += 1.0;
    solutions_.row(k) = roots_[h] * right.row(h);
  }
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factors(symmetric_);
  // A pivot that is not a number passes the method's own test.
  if (factors.info() != Eigen::Success || !(symmetric_.diagonal().array() > 0.0).all()) return false;
  factors.solveInPlace(solutions_);
  forces_.setZero(n, columns);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index h = loaded_[static_cast<std::size_t>(k)];
    forces_.row(h) = roots_[h] / weight(h) * solutions_.row(k);
  }
  right.noalias() += coupling * forces_;
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
            contacts.weight(j) * contacts.mean_normal(j)[as_index(k)] * stiffness[j] * row(j)[n + l];
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
