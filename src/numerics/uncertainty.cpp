#include "numerics/uncertainty.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "numerics/derivatives.hpp"

namespace monograin {
namespace {

constexpr double k_share_of_null_vector = 1e-2;  // component of a null vector above which its parameter is undetermined

/// Quantile for the half-width of a two-sided interval: of Student's t; normal for infinite degrees of freedom.
double quantile_of(double level, double degrees_of_freedom) {
  const double below = 0.5 * (1.0 + level);
  return std::isfinite(degrees_of_freedom) ? boost::math::quantile(boost::math::students_t(degrees_of_freedom), below)
                                           : boost::math::quantile(boost::math::normal(), below);
}

/// Mean curvature of the loss over the data.
double mean_curvature(const LeastSquaresProblem& problem, std::span<const double> residuals, std::size_t n) {
  double curvature = 0.0;
  for (const double r : residuals.first(n)) curvature += problem.loss.curvature(r);
  return curvature / static_cast<double>(n);
}

/// Norms of the columns of a Jacobian, the columns with norm one, and the inverse of their normal matrix. Directions in
/// which the residuals do not change are left out.
struct NormalInverse {
  Eigen::VectorXd norms;
  Eigen::MatrixXd scaled;
  Eigen::MatrixXd inverse;
  double condition = 0.0;
  std::vector<bool> is_determined;

  /// @param noise  relative error of the residuals
  NormalInverse(const Eigen::MatrixXd& columns, double noise)
      : norms(columns.colwise().norm()),
        scaled(columns * norms.cwiseInverse().asDiagonal()),
        inverse(Eigen::MatrixXd::Zero(columns.cols(), columns.cols())),
        is_determined(static_cast<std::size_t>(columns.cols()), true) {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinU | Eigen::ComputeThinV);
    const Eigen::VectorXd& singular = svd.singularValues();
    // Smaller singular values are errors of the differences.
    const double least_singular = 10.0 * std::cbrt(noise) * std::cbrt(noise) * singular[0];
    for (Eigen::Index s = 0; s < singular.size(); ++s) {
      const auto direction = svd.matrixV().col(s);
      if (singular[s] > least_singular) {
        condition = singular[0] / singular[s];
        inverse += direction * direction.transpose() / (singular[s] * singular[s]);
      } else {
        leave_out(direction);
      }
    }
  }

 private:
  void leave_out(const Eigen::Ref<const Eigen::VectorXd>& direction) {
    for (Eigen::Index j = 0; j < direction.size(); ++j) {
      if (std::abs(direction[j]) > k_share_of_null_vector) is_determined[static_cast<std::size_t>(j)] = false;
    }
  }
};

/// J^T D^2 J. Rows beyond the deviations have d = 1.
Eigen::MatrixXd noise_of_normal(const Eigen::Ref<const Eigen::MatrixXd>& jacobian, std::span<const double> deviations) {
  Eigen::VectorXd squares = Eigen::VectorXd::Ones(jacobian.rows());
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    squares[static_cast<Eigen::Index>(i)] = deviations[i] * deviations[i];
  }
  return jacobian.transpose() * squares.asDiagonal() * jacobian;
}

/// Number of the first n residuals that are zero and depend on no parameter, as those before first touch: they tell
/// nothing of the noise.
std::size_t silent_rows(std::span<const double> residuals, const Eigen::MatrixXd& jacobian, std::size_t n) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (residuals[i] == 0.0 && jacobian.row(static_cast<Eigen::Index>(i)).isZero(0.0)) ++count;
  }
  return count;
}

/// True if residuals depend on a parameter by more than the error of their differences.
bool has_influence(const LeastSquaresProblem& problem, const LeastSquaresSolution& solution,
                   const Eigen::MatrixXd& jacobian, std::size_t parameter) {
  constexpr double k_margin = 10.0;
  const double error = k_margin * problem.noise * std::sqrt(static_cast<double>(jacobian.rows())) /
                       difference_step(problem, solution.parameters, parameter);
  return jacobian.col(static_cast<Eigen::Index>(parameter)).norm() > error;
}

/// Fills in the covariances of the parameters between their bounds.
/// @param interior  their indices
/// @param inverse   (J^T J)^-1 J^T D^2 J (J^T J)^-1 of scaled columns
/// @param of_data   the same with J^T D^2 J of the data alone; empty: all rows are data
void fill_in(Uncertainty& result, const std::vector<Eigen::Index>& interior, const NormalInverse& normal,
             const Eigen::MatrixXd& inverse, const Eigen::MatrixXd& of_data) {
  const double variance = result.standard_deviation * result.standard_deviation;
  for (std::size_t i = 0; i < interior.size(); ++i) {
    for (std::size_t j = 0; j < interior.size(); ++j) {
      if (!normal.is_determined[i] || !normal.is_determined[j]) continue;
      const auto row = static_cast<Eigen::Index>(i);
      const auto column = static_cast<Eigen::Index>(j);
      const double unit = variance / (normal.norms[row] * normal.norms[column]);
      result.covariance(interior[i], interior[j]) = unit * inverse(row, column);
      result.cost_covariance(interior[i], interior[j]) = unit * normal.inverse(row, column);
      if (of_data.size() > 0) result.data_covariance(interior[i], interior[j]) = unit * of_data(row, column);
    }
  }
}

}  // namespace

double Uncertainty::standard_error(std::size_t parameter) const {
  const auto k = static_cast<Eigen::Index>(parameter);
  return std::sqrt(covariance(k, k));
}

double Uncertainty::excess_over_cost(std::size_t parameter) const {
  const auto k = static_cast<Eigen::Index>(parameter);
  const double ratio = std::sqrt(covariance(k, k) / cost_covariance(k, k));
  return std::isfinite(ratio) ? ratio : 1.0;
}

double Uncertainty::correlation(std::size_t first, std::size_t second) const {
  if (first == second) return 1.0;
  const double both = covariance(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(second));
  return both / (standard_error(first) * standard_error(second));
}

double Uncertainty::t_quantile_for(double share) const {
  if (!(share < 1.0)) return t_quantile;
  return quantile_of(level, static_cast<double>(degrees_of_freedom) / (share * share));
}

double Uncertainty::t_quantile_of(std::size_t parameter) const {
  const auto k = static_cast<Eigen::Index>(parameter);
  return t_quantile_for(data_covariance.size() > 0 ? data_covariance(k, k) / covariance(k, k) : 1.0);
}

double Uncertainty::half_width(const Eigen::Ref<const Eigen::VectorXd>& gradient) const {
  // Parameters without an error of their own are taken as exact.
  const auto variance_in = [&gradient](const Eigen::MatrixXd& matrix) {
    double variance = 0.0;
    for (Eigen::Index i = 0; i < gradient.size(); ++i) {
      for (Eigen::Index j = 0; j < gradient.size(); ++j) {
        if (std::isfinite(matrix(i, j))) variance += gradient[i] * matrix(i, j) * gradient[j];
      }
    }
    return std::max(variance, 0.0);
  };
  const double variance = variance_in(covariance);
  const double share = data_covariance.size() > 0 && variance > 0.0 ? variance_in(data_covariance) / variance : 1.0;
  return t_quantile_for(share) * std::sqrt(variance);
}

double deviation_of(const LeastSquaresProblem& problem, std::span<const double> residuals, std::size_t n) {
  const std::size_t p = problem.parameters.size();
  if (n <= p) return std::numeric_limits<double>::quiet_NaN();
  double influence = 0.0;
  for (const double r : residuals.first(n)) influence += problem.loss.influence(r) * problem.loss.influence(r);
  return std::sqrt(influence / static_cast<double>(n - p)) / mean_curvature(problem, residuals, n);
}

Uncertainty uncertainty_of(const LeastSquaresProblem& problem, const LeastSquaresSolution& solution,
                           const Eigen::MatrixXd& jacobian, std::size_t n, double level, std::optional<double> known,
                           std::vector<double> deviations) {
  using Bound = LeastSquaresSolution::Bound;
  const std::size_t p = problem.parameters.size();
  Uncertainty result;
  result.degrees_of_freedom = n > p ? n - p : 0;
  result.level = level;
  result.t_quantile = result.standard_deviation = result.rise = std::numeric_limits<double>::quiet_NaN();
  result.is_determined.assign(p, true);
  result.silent_rows = silent_rows(solution.residuals, jacobian, n);
  result.covariance.setConstant(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(p),
                                std::numeric_limits<double>::quiet_NaN());
  result.cost_covariance = result.covariance;
  result.deviations = std::move(deviations);

  const bool has_size = known || result.degrees_of_freedom > 0;
  if (has_size) {
    result.t_quantile = quantile_of(
        level, known ? std::numeric_limits<double>::infinity() : static_cast<double>(result.degrees_of_freedom));
    result.standard_deviation = known ? *known : deviation_of(problem, solution.residuals, n);
    result.rise = std::pow(result.standard_deviation, 2) * mean_curvature(problem, solution.residuals, n);
  }

  std::vector<Eigen::Index> interior;
  for (std::size_t k = 0; k < p; ++k) {
    result.has_derivative.push_back(!jacobian.col(static_cast<Eigen::Index>(k)).hasNaN());
    result.is_determined[k] = has_influence(problem, solution, jacobian, k);
    if (result.is_determined[k] && solution.bounds[k] == Bound::none) interior.push_back(static_cast<Eigen::Index>(k));
  }
  if (interior.empty()) return result;

  const NormalInverse normal(jacobian(Eigen::all, interior), problem.noise);
  result.condition = normal.condition;
  for (std::size_t j = 0; j < interior.size(); ++j) {
    if (!normal.is_determined[j]) result.is_determined[static_cast<std::size_t>(interior[j])] = false;
  }
  if (!has_size) return result;

  Eigen::MatrixXd inverse = normal.inverse;
  if (!result.deviations.empty()) {
    const Eigen::MatrixXd middle = noise_of_normal(normal.scaled, result.deviations);
    inverse = normal.inverse * middle * normal.inverse;
    if (!known) {
      // The mean square of the deviations is one: they replace n by n, and the number of parameters by the trace.
      const auto fixed = static_cast<double>(p - interior.size());
      const double left = static_cast<double>(n) - fixed - (normal.inverse * middle).trace();
      const double squared = static_cast<double>(result.degrees_of_freedom) / left;
      if (squared > 0.0) {
        result.standard_deviation *= std::sqrt(squared);
        result.rise *= squared;
      }
    }
  }
  // A known s is no estimate, and all of a variance is known.
  Eigen::MatrixXd of_data;
  if (const auto rows = static_cast<Eigen::Index>(n); !known && rows < jacobian.rows()) {
    of_data = normal.inverse * noise_of_normal(normal.scaled.topRows(rows), result.deviations) * normal.inverse;
    result.data_covariance = result.covariance;
  }
  fill_in(result, interior, normal, inverse, of_data);
  return result;
}

}  // namespace monograin
