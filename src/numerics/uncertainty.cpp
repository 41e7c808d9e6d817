#include "numerics/uncertainty.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "numerics/derivatives.hpp"

namespace monograin {
namespace {

constexpr double k_share_of_null_vector = 1e-2;  // with which a parameter belongs to what is not determined

/// Mean curvature of the loss over the data.
double mean_curvature(const LeastSquaresProblem& problem, std::span<const double> residuals, std::size_t n) {
  double curvature = 0.0;
  for (const double r : residuals.first(n)) curvature += problem.loss.curvature(r);
  return curvature / static_cast<double>(n);
}

}  // namespace

double Uncertainty::standard_error(std::size_t parameter) const {
  const auto k = static_cast<Eigen::Index>(parameter);
  return std::sqrt(covariance(k, k));
}

double Uncertainty::correlation(std::size_t first, std::size_t second) const {
  if (first == second) return 1.0;
  const double both = covariance(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(second));
  return both / (standard_error(first) * standard_error(second));
}

double Uncertainty::half_width(const Eigen::Ref<const Eigen::VectorXd>& gradient) const {
  double variance = 0.0;
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    for (Eigen::Index j = 0; j < gradient.size(); ++j) {
      // What has no error of its own is taken as given.
      if (std::isfinite(covariance(i, j))) variance += gradient[i] * covariance(i, j) * gradient[j];
    }
  }
  return t_quantile * std::sqrt(std::max(variance, 0.0));
}

double deviation_of(const LeastSquaresProblem& problem, std::span<const double> residuals, std::size_t n) {
  const std::size_t p = problem.parameters.size();
  if (n <= p) return std::numeric_limits<double>::quiet_NaN();
  double influence = 0.0;
  for (const double r : residuals.first(n)) influence += problem.loss.influence(r) * problem.loss.influence(r);
  return std::sqrt(influence / static_cast<double>(n - p)) / mean_curvature(problem, residuals, n);
}

Uncertainty uncertainty_of(const LeastSquaresProblem& problem, const LeastSquaresSolution& solution,
                           const Eigen::MatrixXd& jacobian, std::size_t n, double level, std::optional<double> known) {
  using Bound = LeastSquaresSolution::Bound;
  const std::size_t p = problem.parameters.size();
  Uncertainty result;
  result.degrees_of_freedom = n > p ? n - p : 0;
  result.level = level;
  result.t_quantile = result.standard_deviation = result.rise = std::numeric_limits<double>::quiet_NaN();
  result.is_determined.assign(p, true);
  result.covariance.setConstant(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(p),
                                std::numeric_limits<double>::quiet_NaN());

  const bool has_size = known || result.degrees_of_freedom > 0;
  if (has_size) {
    const double share = 0.5 * (1.0 + level);
    const auto degrees = static_cast<double>(result.degrees_of_freedom);
    result.t_quantile = known ? boost::math::quantile(boost::math::normal(), share)
                              : boost::math::quantile(boost::math::students_t(degrees), share);
    result.standard_deviation = known ? *known : deviation_of(problem, solution.residuals, n);
    result.rise = std::pow(result.standard_deviation, 2) * mean_curvature(problem, solution.residuals, n);
  }

  std::vector<std::size_t> interior;
  for (std::size_t k = 0; k < p; ++k) {
    // An influence that is no more than the error of its difference is none.
    constexpr double k_margin = 10.0;
    const double error = k_margin * problem.noise * std::sqrt(static_cast<double>(jacobian.rows())) /
                         difference_step(problem, solution.parameters, k);
    if (jacobian.col(static_cast<Eigen::Index>(k)).norm() <= error) {
      result.is_determined[k] = false;
    } else if (solution.bounds[k] == Bound::none) {
      interior.push_back(k);
    }
  }
  const auto size = static_cast<Eigen::Index>(interior.size());
  if (size == 0) return result;

  Eigen::MatrixXd scaled(jacobian.rows(), size);
  Eigen::VectorXd norms(size);
  for (Eigen::Index j = 0; j < size; ++j) {
    const auto column = jacobian.col(static_cast<Eigen::Index>(interior[static_cast<std::size_t>(j)]));
    norms[j] = column.norm();
    scaled.col(j) = column / norms[j];
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinU | Eigen::ComputeThinV);
  // Below this a singular value is the error of the differences.
  const double least_singular = 10.0 * std::cbrt(problem.noise) * std::cbrt(problem.noise) * svd.singularValues()[0];
  for (const double value : svd.singularValues()) {
    if (value > least_singular) result.condition = svd.singularValues()[0] / value;
  }
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index s = 0; s < svd.singularValues().size(); ++s) {
    const double value = svd.singularValues()[s];
    const auto direction = svd.matrixV().col(s);
    if (value > least_singular) {
      inverse += direction * direction.transpose() / (value * value);
      continue;
    }
    for (Eigen::Index j = 0; j < size; ++j) {
      if (std::abs(direction[j]) > k_share_of_null_vector) {
        result.is_determined[interior[static_cast<std::size_t>(j)]] = false;
      }
    }
  }
  if (!has_size) return result;

  const double variance = result.standard_deviation * result.standard_deviation;
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      const std::size_t first = interior[static_cast<std::size_t>(i)];
      const std::size_t second = interior[static_cast<std::size_t>(j)];
      if (!result.is_determined[first] || !result.is_determined[second]) continue;
      result.covariance(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(second)) =
          variance * inverse(i, j) / (norms[i] * norms[j]);
    }
  }
  return result;
}

}  // namespace monograin
