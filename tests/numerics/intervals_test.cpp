// Intervals of fitted parameters: the profile, the bootstrap, and what shows that the covariance does not tell them.

#include "numerics/intervals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "numerics/curve_fit.hpp"
#include "numerics/derivatives.hpp"

namespace monograin::intervals_test {
namespace {

using curve_fit::k_line;

constexpr std::size_t k_rows = 200;

double x_of(std::size_t row) { return static_cast<double>(row) / (k_rows - 1); }

/// A fit to data of a function of x and two parameters, 1 and 2, with noise of 0.1.
template <class Model>
LeastSquaresProblem problem_of(Model model, double from = -20.0, double to = 20.0, std::uint64_t seed = 5) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> noise(0.0, 0.1);
  const std::vector<double> truth{1.0, 2.0};
  std::vector<double> y;
  for (std::size_t i = 0; i < k_rows; ++i) y.push_back(model(x_of(i), std::span(truth)) + noise(generator));
  LeastSquaresProblem problem;
  problem.parameters = {{from, to, false, {}}, {-20.0, 20.0, false, {}}};
  problem.residual_count = k_rows;
  problem.residuals = [y, model](std::span<const double> p, std::span<double> residuals) {
    for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i] = y[i] - model(x_of(i), p);
    return true;
  };
  return problem;
}

struct Fitted {
  LeastSquaresSolution solution;
  Uncertainty uncertainty;
};

Fitted fitted(const LeastSquaresProblem& problem, std::vector<double> deviations = {}) {
  const auto solution = minimise(problem);
  EXPECT_TRUE(solution);
  const Eigen::MatrixXd jacobian = residual_jacobian(problem, solution->parameters);
  return {*solution, uncertainty_of(problem, *solution, jacobian, k_rows, 0.95, {}, std::move(deviations))};
}

TEST(Intervals, ProfilesOfALinearProblemAreThoseOfTheCovariance) {
  const auto problem = problem_of(k_line);
  const auto [solution, uncertainty] = fitted(problem);
  const CostCheck check = check_cost(problem, solution, uncertainty);
  EXPECT_EQ(check.shape, CostShape::quadratic);
  EXPECT_FALSE(check.better);
  const ProfileIntervals found = profile_intervals(problem, solution, uncertainty);
  ASSERT_EQ(found.intervals.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const double half = uncertainty.half_width(k);
    EXPECT_NEAR(found.intervals[k].lower, solution.parameters[k] - half, 3e-3 * half);
    EXPECT_NEAR(found.intervals[k].upper, solution.parameters[k] + half, 3e-3 * half);
    EXPECT_FALSE(found.intervals[k].is_cut_below || found.intervals[k].is_cut_above);
  }
}

TEST(Intervals, ARobustLossChangesNeitherTheShapeNorTheProfileOfALine) {
  auto problem = problem_of(k_line);
  problem.loss = {.kind = Loss::soft_l1, .scale = 0.1};
  const auto [solution, uncertainty] = fitted(problem);
  EXPECT_EQ(check_cost(problem, solution, uncertainty).shape, CostShape::quadratic);
  const ProfileIntervals found = profile_intervals(problem, solution, uncertainty);
  for (std::size_t k = 0; k < 2; ++k) {
    const double width = found.intervals[k].upper - found.intervals[k].lower;
    EXPECT_NEAR(width, 2.0 * uncertainty.half_width(k), 0.1 * width);
  }
}

TEST(Intervals, AKinkOfTheCostIsSeen) {
  // Beyond a kink near the minimum the data say a tenth as much of the slope.
  const double turn = fitted(problem_of(k_line)).solution.parameters[1];
  const auto bent = [turn](double x, std::span<const double> p) {
    const double slope = p[1] - turn;
    return p[0] +
           (turn + (std::abs(slope) < 1e-4 ? slope : std::copysign(1e-4 + 0.1 * (std::abs(slope) - 1e-4), slope))) * x;
  };
  auto problem = problem_of(k_line);
  const auto data = problem.residuals;
  problem.residuals = [data, bent](std::span<const double> p, std::span<double> residuals) {
    const std::vector<double> none{0.0, 0.0};
    if (!data(none, residuals)) return false;
    for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i] -= bent(x_of(i), p);
    return true;
  };
  const auto [solution, uncertainty] = fitted(problem);
  const CostCheck check = check_cost(problem, solution, uncertainty);
  EXPECT_EQ(check.shape, CostShape::kinked);
  EXPECT_EQ(check.parameter, 1U);
  EXPECT_LT(check.ratio, 0.1);
  const ProfileIntervals found = profile_intervals(problem, solution, uncertainty);
  ASSERT_EQ(found.intervals.size(), 2U);
  const double half = 0.5 * (found.intervals[1].upper - found.intervals[1].lower);
  EXPECT_NEAR(half / uncertainty.half_width(1), 10.0, 0.3);
}

TEST(Intervals, EndAtTheBoundOfTheSearch) {
  const auto [wide, errors] = fitted(problem_of(k_line));
  const double upper = wide.parameters[0] + errors.standard_error(0);
  const auto problem = problem_of(k_line, -20.0, upper);
  const auto [solution, uncertainty] = fitted(problem);
  const ProfileIntervals found = profile_intervals(problem, solution, uncertainty);
  ASSERT_EQ(found.intervals.size(), 2U);
  EXPECT_EQ(found.intervals[0].upper, upper);
  EXPECT_TRUE(found.intervals[0].is_cut_above);
  EXPECT_FALSE(found.intervals[0].is_cut_below);
}

TEST(Intervals, OfABootstrapOfALinearProblemAreThoseOfTheCovariance) {
  const auto problem = problem_of(k_line);
  const auto [solution, uncertainty] = fitted(problem);
  const Bootstrap drawn = bootstrap(problem, solution, uncertainty, k_rows, 1, 1000, 3);
  ASSERT_EQ(drawn.samples.size(), 1000U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(drawn.standard_error(k) / uncertainty.standard_error(k), 1.0, 0.1);
    const Interval interval = drawn.interval(k, 0.95);
    EXPECT_NEAR((interval.upper - interval.lower) / (2.0 * uncertainty.half_width(k)), 1.0, 0.1);
  }
}

TEST(Intervals, OfABootstrapHaveTheFitInTheirMiddleBesideAPrior) {
  // Data that say 0 and a prior that says 1, each with a deviation of 0.1.
  LeastSquaresProblem problem;
  problem.parameters = {{-10.0, 10.0, false, {}}};
  problem.residual_count = 2;
  problem.plain_count = 1;
  problem.residuals = [](std::span<const double> p, std::span<double> r) {
    r[0] = -p[0] / 0.1;
    r[1] = (p[0] - 1.0) / 0.1;
    return true;
  };
  const auto solution = minimise(problem);
  ASSERT_TRUE(solution);
  ASSERT_NEAR(solution->parameters[0], 0.5, 1e-8);
  Uncertainty uncertainty;
  uncertainty.standard_deviation = 1.0;
  const Bootstrap drawn = bootstrap(problem, *solution, uncertainty, 1, 0, 1000, 3);
  const Interval interval = drawn.interval(0, 0.95);
  const double error = 0.1 / std::numbers::sqrt2;
  EXPECT_NEAR(std::midpoint(interval.lower, interval.upper), 0.5, 0.1 * error);
  EXPECT_NEAR(drawn.standard_error(0) / error, 1.0, 0.1);
}

TEST(Intervals, OfABootstrapAreThoseOfTheNoiseThatIsKnown) {
  const auto problem = problem_of(k_line);
  const auto solution = minimise(problem);
  ASSERT_TRUE(solution);
  // Four times the noise of the data.
  const Uncertainty uncertainty =
      uncertainty_of(problem, *solution, residual_jacobian(problem, solution->parameters), k_rows, 0.95, 0.4);
  const Bootstrap drawn = bootstrap(problem, *solution, uncertainty, k_rows, 0, 1000, 3);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(drawn.standard_error(k) / uncertainty.standard_error(k), 1.0, 0.1);
  }
}

TEST(Intervals, OfAProfileHoldEveryMinimumThatIsLowEnough) {
  // Residuals fall apart into noise of one and a function of the parameter with the minima -1 and 1.
  for (const double tilt : {0.5, 3.0}) {
    LeastSquaresProblem problem;
    problem.parameters = {{-3.0, 3.0, false, {}}};
    problem.residual_count = k_rows;
    problem.residuals = [tilt](std::span<const double> p, std::span<double> residuals) {
      for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i] = i % 2 == 0 ? 1.0 : -1.0;
      residuals[0] = 20.0 * (p[0] * p[0] - 1.0);
      residuals[1] = tilt * (p[0] - 1.0);
      return true;
    };
    const auto [solution, uncertainty] = fitted(problem);
    ASSERT_NEAR(solution.parameters[0], 1.0, 1e-6);
    const auto other = value_beside(solution, uncertainty);
    const ProfileIntervals found = profile_intervals(problem, solution, uncertainty);
    // At -1 the sum of squares has risen by 4 tilt^2: 1 and 36 times that at one standard error.
    EXPECT_EQ(other.has_value(), tilt == 0.5);
    EXPECT_EQ(found.intervals[0].lower < -0.99, tilt == 0.5) << found.intervals[0].lower;
    EXPECT_NEAR(found.intervals[0].upper, 1.0, 0.1);
    EXPECT_FALSE(found.better);
  }
}

TEST(Intervals, CountRowsThatAreZeroBeforeFirstTouch) {
  const auto touching = problem_of(k_line);
  LeastSquaresProblem problem = touching;
  problem.residual_count = 2 * k_rows;
  problem.residuals = [&touching](std::span<const double> p, std::span<double> residuals) {
    std::ranges::fill(residuals.first(k_rows), 0.0);
    return touching.residuals(p, residuals.subspan(k_rows));
  };
  const auto [solution, uncertainty] = fitted(touching);
  const auto with_zeros = minimise(problem);
  ASSERT_TRUE(with_zeros);
  const Uncertainty found =
      uncertainty_of(problem, *with_zeros, residual_jacobian(problem, with_zeros->parameters), 2 * k_rows, 0.95);
  EXPECT_EQ(found.silent_rows, k_rows);
  EXPECT_EQ(uncertainty.silent_rows, 0U);
  EXPECT_EQ(test_residuals(with_zeros->residuals)->runs, test_residuals(solution.residuals)->runs);
}

/// The line's problem with every tenth residual counted five times; the noise of the data stays the same.
struct WeightedLine {
  LeastSquaresProblem problem;
  std::vector<double> deviations;
};

WeightedLine weighted_line(std::uint64_t seed) {
  WeightedLine made{problem_of(k_line, -20.0, 20.0, seed), {}};
  for (std::size_t i = 0; i < k_rows; ++i) made.deviations.push_back(i % 10 == 0 ? 5.0 : 1.0);
  const double mean_square = (25.0 + 9.0) / 10.0;
  for (double& deviation : made.deviations) deviation /= std::sqrt(mean_square);
  made.problem.residuals = [plain = made.problem.residuals, d = made.deviations](std::span<const double> p,
                                                                                 std::span<double> residuals) {
    if (!plain(p, residuals)) return false;
    for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i] *= d[i];
    return true;
  };
  return made;
}

TEST(Intervals, HoldTheTruthWhereWeightsAreNotThoseOfTheNoise) {
  constexpr int k_fits = 1000;
  int held = 0;
  int held_without = 0;
  for (int fit = 0; fit < k_fits; ++fit) {
    const WeightedLine line = weighted_line(static_cast<std::uint64_t>(fit));
    const auto [solution, uncertainty] = fitted(line.problem, line.deviations);
    const auto holds = [&](double half_width) { return std::abs(solution.parameters[1] - 2.0) < half_width; };
    if (holds(uncertainty.half_width(1))) ++held;
    if (holds(fitted(line.problem).uncertainty.half_width(1))) ++held_without;
  }
  // 95 % of 1000, give or take three standard deviations of 6.9
  EXPECT_NEAR(held, 950, 21);
  EXPECT_LT(held_without, 850);
}

TEST(Intervals, OfEveryMethodAgreeWhereWeightsAreNotThoseOfTheNoise) {
  const WeightedLine line = weighted_line(5);
  const auto [solution, uncertainty] = fitted(line.problem, line.deviations);
  EXPECT_EQ(check_cost(line.problem, solution, uncertainty).shape, CostShape::quadratic);
  const ProfileIntervals profile = profile_intervals(line.problem, solution, uncertainty);
  const Bootstrap drawn = bootstrap(line.problem, solution, uncertainty, k_rows, 1, 1000, 3);
  for (std::size_t k = 0; k < 2; ++k) {
    const double half = uncertainty.half_width(k);
    EXPECT_NEAR(profile.intervals[k].upper - profile.intervals[k].lower, 2.0 * half, 6e-3 * half);
    EXPECT_NEAR(drawn.standard_error(k) / uncertainty.standard_error(k), 1.0, 0.1);
  }
}

TEST(ResidualTests, FindResidualsThatAlternateOrFollowOneAnother) {
  std::mt19937_64 generator(11);
  std::normal_distribution<double> normal;
  std::vector<double> independent;
  std::vector<double> alternating;
  std::vector<double> correlated{normal(generator)};
  for (int i = 0; i < 100; ++i) {
    independent.push_back(normal(generator));
    alternating.push_back(i % 2 == 0 ? 1.0 : -1.0);
    correlated.push_back(0.8 * correlated.back() + normal(generator));
  }
  EXPECT_TRUE(test_residuals(independent)->are_independent());
  const auto many = test_residuals(alternating);
  EXPECT_EQ(many->runs, 100U);
  EXPECT_NEAR(many->correlation, -0.99, 1e-12);
  EXPECT_FALSE(many->are_independent());
  const auto few = test_residuals(correlated);
  EXPECT_NEAR(few->correlation, 0.8, 0.15);
  EXPECT_LT(static_cast<double>(few->runs), few->expected_runs);
  EXPECT_FALSE(few->are_independent());
  EXPECT_FALSE(test_residuals(std::span(correlated).first(19)));
}

}  // namespace
}  // namespace monograin::intervals_test
