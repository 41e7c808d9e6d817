/// How well a fit determines its parameters: covariance, t-intervals and confidence bands from the fit's Jacobian.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "numerics/least_squares.hpp"

namespace monograin {

/// Of the linearised fit, with s^2 = cost / (n - p):
///
///   covariance = s^2 (J^T J)^-1
///
/// A loss other than the linear one has influence psi and curvature psi' in the place of residuals, and
/// s^2 = sum psi^2 / (n - p) / mean(psi')^2: the asymptotic covariance of an M-estimator (Huber (1981), section 7.6).
/// Residuals of priors are rows of J, and tell nothing of s.
struct Uncertainty {
  std::size_t degrees_of_freedom = 0;  ///< n - p; none: there are no errors and no intervals
  double level = 0.95;                 ///< of the two-sided intervals
  double t_quantile = 0.0;             ///< Student's t for them, normal where s is known; nan where there is none
  double standard_deviation = 0.0;     ///< s, in units of the residuals; nan where there is none
  double rise = 0.0;                   ///< of the cost, one standard error away: s^2 times the loss's mean curvature
  std::vector<bool> is_determined;     ///< whether the residuals tell this parameter, at a bound or not
  double condition = 1.0;              ///< of the Jacobian with columns of length one, of what is determined
  Eigen::MatrixXd covariance;          ///< nan in rows and columns of parameters at a bound or not determined

  [[nodiscard]] double standard_error(std::size_t parameter) const;
  [[nodiscard]] double correlation(std::size_t first, std::size_t second) const;
  /// Half of the width of a parameter's t-interval.
  [[nodiscard]] double half_width(std::size_t parameter) const { return t_quantile * standard_error(parameter); }
  /// The same for a function of the parameters. @param gradient  with respect to them
  [[nodiscard]] double half_width(const Eigen::Ref<const Eigen::VectorXd>& gradient) const;
};

/// s above, of the first n residuals. @return nan without degrees of freedom
[[nodiscard]] double deviation_of(const LeastSquaresProblem& problem, std::span<const double> residuals, std::size_t n);

/// @param jacobian  of the residuals at the solution, see residual_jacobian
/// @param n         how many residuals, the first ones, are those of data
/// @param level     in (0, 1)
/// @param known     s, where the noise is known
[[nodiscard]] Uncertainty uncertainty_of(const LeastSquaresProblem& problem, const LeastSquaresSolution& solution,
                                         const Eigen::MatrixXd& jacobian, std::size_t n, double level,
                                         std::optional<double> known = {});

}  // namespace monograin
