/// Intervals of fitted parameters if the covariance may not describe them: a check of the sum of squares, profile
/// likelihood, bootstrap.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "numerics/least_squares.hpp"
#include "numerics/uncertainty.hpp"

namespace monograin {

/// How the cost near a minimum differs from the parabola that the covariance predicts.
enum class CostShape {
  quadratic,
  curved,  ///< the difference grows with the distance: the cost is smooth, but the problem is not linear there
  kinked   ///< the difference begins at the minimum: derivatives jump near it
};

/// Result of check_cost().
struct CostCheck {
  CostShape shape = CostShape::quadratic;
  std::size_t parameter = 0;           ///< parameter along which the cost differs most from the parabola
  double ratio = 1.0;                  ///< rise of the cost over the predicted rise, at that largest difference
  double at = 0.0;                     ///< distance of that difference from the minimum, in standard errors
  std::optional<LocalMinimum> better;  ///< a point of lower cost, if one was found
  long evaluations = 0;
};

/// Compares the cost, minimised over the other parameters, with its parabola: two standard errors to both sides along
/// each parameter and, where cost and parabola differ, also at one standard error.
[[nodiscard]] CostCheck check_cost(const LeastSquaresProblem& problem, const LeastSquaresSolution& solution,
                                   const Uncertainty& uncertainty);

/// Value of a parameter at another minimum.
struct ValueBeside {
  std::size_t parameter = 0;
  double value = 0.0;
};

/// The value farthest outside of its interval by the covariance, at a minimum whose cost is so low that it belongs
/// there; none if there is none.
[[nodiscard]] std::optional<ValueBeside> value_beside(const LeastSquaresSolution& solution,
                                                      const Uncertainty& uncertainty);

struct Interval {
  double lower = 0.0;
  double upper = 0.0;
  bool is_cut_below = false;  ///< the lower end is the bound of the search, not a rise of the cost
  bool is_cut_above = false;
};

struct ProfileIntervals {
  std::vector<Interval> intervals;     ///< nan if the standard deviation s is nan or the parameter is not determined
  std::optional<LocalMinimum> better;  ///< a point of lower cost, if one was found; the intervals are then unfinished
  long evaluations = 0;
};

/// Profile-likelihood intervals (Venzon and Moolgavkar (1988)). At their ends the cost, minimised over the other
/// parameters, has risen by t^2 times the rise that the covariance predicts for one standard error. Accurate to 0.3 %
/// of the half-width. An interval contains those around other minima of the solution that have not risen as far, and
/// what lies between.
[[nodiscard]] ProfileIntervals profile_intervals(const LeastSquaresProblem& problem,
                                                 const LeastSquaresSolution& solution, const Uncertainty& uncertainty);

struct Bootstrap {
  std::vector<std::vector<double>> samples;  ///< fitted parameters, for each sample
  long evaluations = 0;

  /// Percentile interval of a parameter.
  [[nodiscard]] Interval interval(std::size_t parameter, double level) const;
  [[nodiscard]] double standard_error(std::size_t parameter) const;
};

/// Repeats a fit with resampled data: residuals, made alike by their deviations, are drawn with replacement in blocks
/// of consecutive ones (Kuensch (1989)), enlarged by sqrt(n/(n - p)). If the noise is known, normal residuals of its
/// size are drawn instead. Residuals of priors are drawn from their distribution.
/// @param n      number of residuals of data, which come first; larger than the number of parameters
/// @param block  length of the blocks; 1 if residuals are independent; 0 if the noise is known
/// @param count  number of samples
[[nodiscard]] Bootstrap bootstrap(const LeastSquaresProblem& problem, const LeastSquaresSolution& solution,
                                  const Uncertainty& uncertainty, std::size_t n, std::size_t block, std::size_t count,
                                  std::uint64_t seed);

/// Tests whether residuals, in their order, are independent.
struct ResidualTests {
  std::size_t runs = 0;        ///< stretches of one sign
  double expected_runs = 0.0;  ///< expected number of runs of independent residuals
  double runs_p = 1.0;         ///< two-sided probability of as many or as few runs (Wald and Wolfowitz (1940))
  double correlation = 0.0;    ///< correlation of neighbouring residuals
  double correlation_p = 1.0;  ///< two-sided probability of a correlation as large

  [[nodiscard]] bool are_independent() const noexcept { return runs_p >= 0.01 && correlation_p >= 0.01; }
};

/// Tests residuals for independence. Those that are zero, as before first touch, are no noise and do not count.
/// @return nothing for fewer than 20 residuals, or if all have one sign
[[nodiscard]] std::optional<ResidualTests> test_residuals(std::span<const double> all);

}  // namespace monograin
