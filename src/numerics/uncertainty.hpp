/// How well a fit determines its parameters: covariance, t-intervals and confidence bands from the fit's Jacobian.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "numerics/least_squares.hpp"

namespace monograin {

/// Uncertainty of fitted parameters by the linearised fit, with s^2 = cost / (n - p):
///
///   covariance = s^2 (J^T J)^-1
///
/// Where residuals are weighted otherwise than by their noise, residual i has the standard deviation d_i s, and
///
///   covariance = s^2 (J^T J)^-1 J^T D^2 J (J^T J)^-1,   s^2 = cost / (sum d^2 - trace of J (J^T J)^-1 J^T D^2)
///
/// (Huber (1967); D is the diagonal of the d_i). Other losses than the linear one have influence psi and curvature psi'
/// in place of the residuals, and s^2 = sum psi^2 / (n - p) / mean(psi')^2: the asymptotic covariance of an M-estimator
/// (Huber (1981), section 7.6). Residuals of priors are rows of J with d = 1, but do not contribute to s. Where they
/// know a part of a variance, its t-interval has more degrees of freedom: (n - p) / share^2, with the share of the
/// variance that is in proportion to s^2 (Welch (1947), Satterthwaite (1946)).
struct Uncertainty {
  std::size_t degrees_of_freedom = 0;  ///< n - p; if 0 and s is unknown, there are no errors and no intervals
  std::size_t silent_rows = 0;         ///< residuals of data that are zero and depend on no parameter
  double level = 0.95;                 ///< probability of the two-sided intervals
  double t_quantile = 0.0;             ///< quantile of Student's t for n - p degrees of freedom; normal if s is known;
                                       ///< nan if there are no errors
  double standard_deviation = 0.0;     ///< s, in units of the residuals; nan if there are no errors
  double rise = 0.0;                   ///< rise of the cost at one standard error: s^2 times the loss's mean curvature
  std::vector<bool> is_determined;     ///< the residuals determine this parameter; also for parameters at a bound
  std::vector<bool> has_derivative;  ///< false: no residuals on either side of the fit; is_determined is false as well
  double condition = 1.0;            ///< of the Jacobian of determined parameters, with columns of length one
  Eigen::MatrixXd covariance;        ///< nan in rows and columns of parameters at a bound or not determined
  Eigen::MatrixXd cost_covariance;   ///< s^2 (J^T J)^-1, which the shape of the cost shows
  Eigen::MatrixXd data_covariance;   ///< part of the covariance that is due to the noise of the data; empty: all of it
  std::vector<double> deviations;    ///< d of the residuals of data; empty: all are one

  [[nodiscard]] double standard_error(std::size_t parameter) const;
  /// A parameter's standard error over the one that the cost shows; 1 where residuals are weighted by their noise.
  [[nodiscard]] double excess_over_cost(std::size_t parameter) const;
  [[nodiscard]] double correlation(std::size_t first, std::size_t second) const;
  /// Half of the width of a parameter's t-interval.
  [[nodiscard]] double half_width(std::size_t parameter) const {
    return t_quantile_of(parameter) * standard_error(parameter);
  }
  /// Quantile for the interval of a parameter: t_quantile, or less where a prior knows a part of its variance.
  [[nodiscard]] double t_quantile_of(std::size_t parameter) const;
  /// Half of the width of the t-interval of a function of the parameters. @param gradient  of that function
  [[nodiscard]] double half_width(const Eigen::Ref<const Eigen::VectorXd>& gradient) const;

 private:
  [[nodiscard]] double t_quantile_for(double share) const;
};

/// Standard deviation s of the first n residuals, as if they were weighted by their noise. @return nan without degrees
/// of freedom
[[nodiscard]] double deviation_of(const LeastSquaresProblem& problem, std::span<const double> residuals, std::size_t n);

/// Uncertainty of the parameters of a solution.
/// @param jacobian  of the residuals at the solution, see residual_jacobian()
/// @param n         number of residuals of data, which come first
/// @param level     probability of the intervals, in (0, 1)
/// @param known       s, if the noise is known
/// @param deviations  d of the residuals of data, with a mean square of one; empty: all are one
[[nodiscard]] Uncertainty uncertainty_of(const LeastSquaresProblem& problem, const LeastSquaresSolution& solution,
                                         const Eigen::MatrixXd& jacobian, std::size_t n, double level,
                                         std::optional<double> known = {}, std::vector<double> deviations = {});

}  // namespace monograin
