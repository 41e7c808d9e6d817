/// Intervals of fitted parameters where the covariance may not tell them: a check of the sum of squares, profile
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
  curved,  ///< more, the farther from the minimum: smooth, but the problem is not linear there
  kinked   ///< from the minimum on: derivatives jump near it
};

struct CostCheck {
  CostShape shape = CostShape::quadratic;
  std::size_t parameter = 0;           ///< along which it differs most
  double ratio = 1.0;                  ///< there: rise of the cost over the predicted rise
  double at = 0.0;                     ///< there: distance from the minimum in standard errors
  std::optional<LocalMinimum> better;  ///< a place of less cost that was found
  long evaluations = 0;
};

/// Compares the cost with its parabola two standard errors to both sides along each parameter, the others refitted, and
/// where they differ, also one standard error away.
[[nodiscard]] CostCheck check_cost(const LeastSquaresProblem& problem, const LeastSquaresSolution& solution,
                                   const Uncertainty& uncertainty);

struct Interval {
  double lower = 0.0;
  double upper = 0.0;
  bool is_cut_below = false;  ///< the bound of the search is its end
  bool is_cut_above = false;
};

struct ProfileIntervals {
  std::vector<Interval> intervals;     ///< nan where s is
  std::optional<LocalMinimum> better;  ///< a place of less cost that was found; the intervals are not finished then
  long evaluations = 0;
};

/// Where the cost, minimised over the other parameters, has risen t^2 times as far as the covariance says of one
/// standard error (Venzon and Moolgavkar (1988)), to 0.3 % of the width.
[[nodiscard]] ProfileIntervals profile_intervals(const LeastSquaresProblem& problem,
                                                 const LeastSquaresSolution& solution, const Uncertainty& uncertainty);

struct Bootstrap {
  std::vector<std::vector<double>> samples;  ///< parameters of each
  long evaluations = 0;

  /// Percentile interval of a parameter.
  [[nodiscard]] Interval interval(std::size_t parameter, double level) const;
  [[nodiscard]] double standard_error(std::size_t parameter) const;
};

/// Fits again to residuals drawn with replacement in blocks that follow one another (Kuensch (1989)), larger by
/// sqrt(n/(n - p)); residuals of priors are drawn from their distribution.
/// @param n      residuals of data, the first ones; more than parameters
/// @param block  rows that stay together: 1 where residuals are independent
[[nodiscard]] Bootstrap bootstrap(const LeastSquaresProblem& problem, const LeastSquaresSolution& solution,
                                  const Uncertainty& uncertainty, std::size_t n, std::size_t block, std::size_t count,
                                  std::uint64_t seed);

/// Whether residuals, in their order, are independent.
struct ResidualTests {
  std::size_t runs = 0;        ///< stretches of one sign
  double expected_runs = 0.0;  ///< of independent residuals
  double runs_p = 1.0;         ///< two-sided probability of as many or as few (Wald and Wolfowitz (1940))
  double correlation = 0.0;    ///< of neighbours
  double correlation_p = 1.0;  ///< two-sided, of a correlation as large

  [[nodiscard]] bool are_independent() const noexcept { return runs_p >= 0.01 && correlation_p >= 0.01; }
};

/// @return nothing for fewer than 20 residuals, or where all have one sign
[[nodiscard]] std::optional<ResidualTests> test_residuals(std::span<const double> residuals);

}  // namespace monograin
