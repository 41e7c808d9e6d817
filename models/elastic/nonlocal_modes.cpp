// Modes in which the path of a nonlocal equilibrium may turn back: their pivots, and the least eigenvalue.

#include <algorithm>
#include <cmath>
#include <limits>

#include "elastic/nonlocal_contacts.hpp"

namespace monograin::nonlocal {
namespace {

constexpr double k_margin_tolerance = 1e-14;
constexpr double k_rounding = std::numeric_limits<double>::epsilon();  // of modes, which are of order one
constexpr int k_most_quotients = 6;  // each cubes the error of the mode; two are usual

std::size_t in(Eigen::Index index) noexcept { return static_cast<std::size_t>(index); }

}  // namespace

/// I less shift, less the coupling between square roots of stiffnesses: its lower half. Its eigenvalues and pivots are
/// those of the problem's own, unsymmetric matrix.
void Contacts::set_modes(double shift) {
  for (std::size_t j = 0; j < class_count(); ++j) stiffness_roots_[j] = std::sqrt(stiffness_[j]);
  for (Eigen::Index k = 0; k < modes_.cols(); ++k) {
    const double root = stiffness_roots_[mode_class_[in(k)]];
    for (Eigen::Index i = k; i < modes_.rows(); ++i) {
      modes_(i, k) = -mode_coupling_(i, k) * root * stiffness_roots_[mode_class_[in(i)]];
    }
    modes_(k, k) += 1.0 - shift;
  }
}

/// L D L^T of the modes in place: pivots on the diagonal, below it the columns of L times their pivots.
/// @return the least pivot; the first that is not positive, with the rest left undone, unless asked to go to the end
double Contacts::eliminate_modes(bool to_the_end) noexcept {
  const Eigen::Index count = modes_.rows();
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index p = 0; p < count; ++p) {
    double* const pivot = &modes_(p, p);
    least = std::min(least, *pivot);
    if (!(least > 0.0)) {
      if (!to_the_end) break;
      if (std::abs(*pivot) < k_rounding) *pivot = k_rounding;
    }
    const double inverse = 1.0 / *pivot;
    const Eigen::Index rest = count - p;
    for (Eigen::Index c = 1; c < rest; ++c) {
      const double factor = pivot[c] * inverse;
      double* const column = pivot + c * count;
      for (Eigen::Index i = c; i < rest; ++i) column[i] -= factor * pivot[i];
    }
  }
  return least;
}

/// Solves with eliminated modes, in place.
void Contacts::solve_modes(Eigen::VectorXd& x) const noexcept {
  const Eigen::Index count = modes_.rows();
  for (Eigen::Index p = 0; p < count; ++p) {
    x[p] /= modes_(p, p);
    for (Eigen::Index i = p + 1; i < count; ++i) x[i] -= modes_(i, p) * x[p];
  }
  for (Eigen::Index p = count - 1; p >= 0; --p) {
    double sum = 0.0;
    for (Eigen::Index i = p + 1; i < count; ++i) sum += modes_(i, p) * x[i];
    x[p] -= sum / modes_(p, p);
  }
}

/// Rayleigh quotient of the modes in the direction of the critical one.
double Contacts::quotient_of_modes() const noexcept {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < modes_.cols(); ++k) {
    double below = 0.0;
    for (Eigen::Index i = k + 1; i < modes_.rows(); ++i) below += modes_(i, k) * critical_mode_[i];
    sum += critical_mode_[k] * (modes_(k, k) * critical_mode_[k] + 2.0 * below);
  }
  return sum;
}

double Contacts::margin(std::span<const double> y) {
  look(y);
  // The mode changes little from one state to the next. No eigenvalue is above a quotient of Rayleigh's without another
  // below it, and with positive pivots none is below the shift.
  for (int step = 0; step < k_most_quotients; ++step) {
    set_modes(0.0);
    const double quotient = quotient_of_modes();
    modes_.diagonal().array() -= quotient - k_margin_tolerance;
    if (eliminate_modes(true) > 0.0) return quotient;
    solve_modes(critical_mode_);
    critical_mode_ /= critical_mode_.norm();
  }
  set_modes(0.0);
  eigenvalues_.compute(modes_);
  critical_mode_ = eigenvalues_.eigenvectors().col(0);
  return eigenvalues_.eigenvalues()[0];
}

double Contacts::least_pivot(std::span<const double> y, double shift) {
  look(y);
  set_modes(shift);
  return eliminate_modes(false);
}

}  // namespace monograin::nonlocal
