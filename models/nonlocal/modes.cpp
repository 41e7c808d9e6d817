#include "nonlocal/modes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

constexpr int k_most_quotients = 6;  // Rayleigh quotients; each cubes the error of the mode, two are usual

std::size_t in(Eigen::Index index) noexcept { return static_cast<std::size_t>(index); }
Eigen::Index at(std::size_t index) noexcept { return static_cast<Eigen::Index>(index); }

/// L D L^T factorization in place of a matrix given by its lower half: pivots on the diagonal, below it the columns of
/// L times their pivots.
/// @return the least pivot; without `to_the_end` the first that is not positive, with the rest left undone
double eliminate(Eigen::MatrixXd& matrix, bool to_the_end) noexcept {
  const Eigen::Index count = matrix.rows();
  double least = k_infinity;
  for (Eigen::Index p = 0; p < count; ++p) {
    double* const pivot = &matrix(p, p);
    least = std::min(least, *pivot);
    if (!(least > 0.0)) {
      if (!to_the_end) break;
      if (std::abs(*pivot) < k_epsilon) *pivot = k_epsilon;
    }
    const double inverse = 1.0 / *pivot;
    const Eigen::Index rest = count - p;
    for (Eigen::Index c = 1; c < rest; ++c) {
      const double factor = pivot[c] * inverse;
      if (factor == 0.0) continue;  // open contacts
      double* const column = pivot + c * count;
      for (Eigen::Index i = c; i < rest; ++i) column[i] -= factor * pivot[i];
    }
  }
  return least;
}

/// Solves with a matrix factorized by eliminate(), in place.
void solve(const Eigen::MatrixXd& matrix, Eigen::VectorXd& x) noexcept {
  const Eigen::Index count = matrix.rows();
  for (Eigen::Index p = 0; p < count; ++p) {
    x[p] /= matrix(p, p);
    for (Eigen::Index i = p + 1; i < count; ++i) x[i] -= matrix(i, p) * x[p];
  }
  for (Eigen::Index p = count - 1; p >= 0; --p) {
    double sum = 0.0;
    for (Eigen::Index i = p + 1; i < count; ++i) sum += matrix(i, p) * x[i];
    x[p] -= sum / matrix(p, p);
  }
}

/// Rayleigh quotient of a matrix given by its lower half.
double quotient(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& mode) noexcept {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
    double below = 0.0;
    for (Eigen::Index i = k + 1; i < matrix.rows(); ++i) below += matrix(i, k) * mode[i];
    sum += mode[k] * (matrix(k, k) * mode[k] + 2.0 * below);
  }
  return sum;
}

/// For each row of a matrix, the first row that it couples with, directly or through other rows.
std::vector<std::size_t> coupled(const Eigen::MatrixXd& matrix) {
  const double least = k_same_value * matrix.cwiseAbs().maxCoeff();
  std::vector<std::size_t> first(in(matrix.rows()));
  std::iota(first.begin(), first.end(), std::size_t{0});
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (first[i] == first[k] || std::abs(matrix(at(i), at(k))) <= least) continue;
      const auto [low, high] = std::minmax({first[i], first[k]});
      std::ranges::replace(first, high, low);
    }
  }
  return first;
}

}  // namespace

Modes::Modes(const Eigen::MatrixXd& influence, std::span<const std::size_t> class_of, bool of_classes) {
  // Each vector of the basis belongs to one class: the sum of its walls, then each wall less the mean of those before.
  const std::size_t walls = class_of.size();
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(at(walls), at(walls));
  std::vector<std::size_t> classes;
  const std::size_t count = walls == 0 ? 0 : 1 + *std::ranges::max_element(class_of);
  for (std::size_t c = 0; c < count; ++c) {
    std::vector<Eigen::Index> members;
    for (std::size_t w = 0; w < walls; ++w) {
      if (class_of[w] == c) members.push_back(at(w));
    }
    for (std::size_t m = 0; m < (of_classes ? 1 : members.size()); ++m) {
      auto vector = basis.col(at(classes.size()));
      for (std::size_t k = 0; k < (m == 0 ? members.size() : m); ++k) vector[members[k]] = 1.0;
      if (m > 0) vector[members[m]] = -static_cast<double>(m);
      vector.normalize();
      classes.push_back(c);
    }
  }
  const auto used = basis.leftCols(at(classes.size()));
  const Eigen::MatrixXd raw = used.transpose() * influence * used;
  const Eigen::MatrixXd coupling = 0.5 * (raw + raw.transpose());

  const std::vector<std::size_t> first = coupled(coupling);
  for (std::size_t b = 0; b < first.size(); ++b) {
    std::vector<Eigen::Index> rows;
    Block block;
    for (std::size_t i = b; i < first.size(); ++i) {
      if (first[i] != b) continue;
      rows.push_back(at(i));
      block.class_of.push_back(classes[i]);
    }
    if (rows.empty()) continue;
    block.coupling = coupling(rows, rows);
    block.matrix = block.coupling;
    block.eigenvalues.compute(block.matrix);
    block.critical_mode = block.eigenvalues.eigenvectors().col(0);
    blocks_.push_back(std::move(block));
  }
  roots_.resize(count);
}

void Modes::set_roots(std::span<const double> stiffness) noexcept {
  for (std::size_t j = 0; j < roots_.size(); ++j) roots_[j] = std::sqrt(stiffness[j]);
}

void Modes::set_matrix(Block& block, double shift) const noexcept {
  for (Eigen::Index k = 0; k < block.matrix.cols(); ++k) {
    const double root = roots_[block.class_of[in(k)]];
    for (Eigen::Index i = k; i < block.matrix.rows(); ++i) {
      block.matrix(i, k) = -block.coupling(i, k) * root * roots_[block.class_of[in(i)]];
    }
    block.matrix(k, k) += 1.0 - shift;
  }
}

/// Least pivot of a block minus the shift.
double Modes::eliminated(Block& block, double shift) const noexcept {
  set_matrix(block, shift);
  return eliminate(block.matrix, false);
}

/// Least eigenvalue of a block. Starts from the mode of the previous state, which changes little. A Rayleigh quotient
/// is never below the least eigenvalue, and positive pivots show that no eigenvalue is below the quotient.
double Modes::least_eigenvalue(Block& block) const {
  for (int step = 0; step < k_most_quotients; ++step) {
    set_matrix(block, 0.0);
    const double found = quotient(block.matrix, block.critical_mode);
    if (block.matrix.rows() == 1) return found;
    // The pivots of the elimination have ten times the round-off of a few operations.
    block.matrix.diagonal().array() -= found - 10.0 * k_round_off;
    if (eliminate(block.matrix, true) > 0.0) return found;
    solve(block.matrix, block.critical_mode);
    block.critical_mode /= block.critical_mode.norm();
  }
  set_matrix(block, 0.0);
  block.eigenvalues.compute(block.matrix);
  block.critical_mode = block.eigenvalues.eigenvectors().col(0);
  return block.eigenvalues.eigenvalues()[0];
}

double Modes::margin(std::span<const double> stiffness) {
  set_roots(stiffness);
  double least = least_eigenvalue(blocks_[critical_]);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (b == critical_ || eliminated(blocks_[b], least) > 0.0) continue;
    if (const double other = least_eigenvalue(blocks_[b]); other < least) {
      least = other;
      critical_ = b;
    }
  }
  return least;
}

double Modes::least_pivot(std::span<const double> stiffness, double shift) {
  set_roots(stiffness);
  double least = k_infinity;
  for (Block& block : blocks_) {
    least = std::min(least, eliminated(block, shift));
    if (!(least > 0.0)) break;
  }
  return least;
}

}  // namespace monograin::nonlocal
