// What a fit knows of its parameters.

#include "numerics/uncertainty.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "numerics/curve_fit.hpp"

namespace monograin::uncertainty_test {
namespace {

using namespace curve_fit;

TEST(Uncertainty, IsThatOfTheStraightLineInClosedForm) {
  const std::vector<double> y{1.1, 1.3, 1.9, 2.1, 2.8, 2.9};
  const auto problem = problem_of(k_six, y, {{-9.0, 9.0, false, {}}, {-9.0, 9.0, false, {}}}, k_line);
  const auto solution = minimise(problem);
  const Uncertainty uncertainty = uncertainty_at(problem, *solution, 0.9);
  // x has the mean 1/2 and the sum of squares about it 0.7.
  const double s = std::sqrt(solution->cost / 4.0);
  EXPECT_NEAR(uncertainty.standard_error(1), s / std::sqrt(0.7), 1e-9);
  EXPECT_NEAR(uncertainty.standard_error(0), s * std::sqrt(1.0 / 6.0 + 0.25 / 0.7), 1e-9);
  EXPECT_NEAR(uncertainty.correlation(0, 1), -0.5 / std::sqrt(0.7 / 6.0 + 0.25), 1e-8);
  EXPECT_EQ(uncertainty.degrees_of_freedom, 4U);
  EXPECT_NEAR(uncertainty.t_quantile, 2.131846786326649, 1e-12);  // tables of Student's t: 0.95, 4 degrees of freedom
  Eigen::Vector2d at_mean(1.0, 0.5);
  EXPECT_NEAR(uncertainty.half_width(at_mean), uncertainty.t_quantile * s / std::sqrt(6.0), 1e-9);
}

/// Uncertainty of the mean of three data, with a prior of a deviation [s]. The noise s is estimated from the data.
Uncertainty uncertainty_of_mean(double deviation_of_prior) {
  const std::vector<double> y{1.0, 1.2, 0.9};
  const auto problem =
      problem_of(y, y, {{-9.0, 9.0, false, {}}}, [](double, std::span<const double> p) { return p[0]; });
  LeastSquaresSolution solution;
  solution.parameters = {31.0 / 30.0};
  solution.bounds = {LeastSquaresSolution::Bound::none};
  for (const double value : y) solution.residuals.push_back(value - 31.0 / 30.0);
  solution.residuals.push_back(0.0);
  Eigen::MatrixXd jacobian(4, 1);
  jacobian << -1.0, -1.0, -1.0, 1.0 / deviation_of_prior;
  return uncertainty_of(problem, solution, jacobian, 3, 0.95);
}

TEST(Uncertainty, OfAPriorThatKnowsMoreThanTheDataIsThatOfThePrior) {
  const double s = std::sqrt(0.07 / 3.0);  // of the three
  for (const double d : {1e-3, 0.1, 1e3}) {
    const Uncertainty uncertainty = uncertainty_of_mean(d / s);
    const double variance = 1.0 / (3.0 / (s * s) + 1.0 / (d * d));
    EXPECT_NEAR(uncertainty.standard_error(0), std::sqrt(variance), 1e-9 * std::sqrt(variance));
    const double t = uncertainty.t_quantile_of(0);
    const double two_degrees = 4.30265273;  // Student's t
    const double normal = 1.95996398;
    EXPECT_LE(t, two_degrees + 1e-6);
    EXPECT_GE(t, d == 1e3 ? two_degrees - 1e-6 : normal - 1e-6);
    EXPECT_TRUE(d != 1e-3 || t < normal + 1e-3) << t;
    EXPECT_NEAR(uncertainty.half_width(Eigen::VectorXd::Ones(1)), uncertainty.half_width(0), 1e-12);
  }
}

// The mean of three data has the variance s^2/3. A prior of this variance leaves the data half of what remains.
TEST(Uncertainty, OfAPriorThatKnowsHalfOfAVarianceHasFourTimesTheDegreesOfFreedom) {
  const double eight_degrees = 2.30600413520417;  // tables of Student's t: 0.975
  EXPECT_NEAR(uncertainty_of_mean(1.0 / std::sqrt(3.0)).t_quantile_of(0), eight_degrees, 1e-12);
}

TEST(Uncertainty, OfEqualDeviationsIsThatWithoutDeviationsAlsoAtABound) {
  const std::vector<double> y{1.1, 1.3, 1.9, 2.1, 2.8, 2.9};
  const auto problem = problem_of(k_six, y, {{-9.0, 9.0, false, {}}, {-9.0, 1.0, false, {}}}, k_line);
  const auto solution = minimise(problem);
  ASSERT_EQ(solution->bounds[1], LeastSquaresSolution::Bound::upper);
  const Eigen::MatrixXd jacobian = residual_jacobian(problem, solution->parameters);
  const Uncertainty without = uncertainty_of(problem, *solution, jacobian, 6, 0.95);
  const Uncertainty with = uncertainty_of(problem, *solution, jacobian, 6, 0.95, {}, std::vector(6, 1.0));
  EXPECT_NEAR(without.standard_deviation, std::sqrt(solution->cost / 4.0), 1e-12);
  EXPECT_NEAR(with.standard_deviation, without.standard_deviation, 1e-12);
  EXPECT_NEAR(with.standard_error(0), without.standard_error(0), 1e-12);
}

// Before first touch a row is zero and depends on nothing; one that is off shows noise.
TEST(Uncertainty, RowsAreSilentOnlyIfTheyAreZeroAndDependOnNothing) {
  const auto touching = [](double x, std::span<const double> p) { return p[0] * std::max(0.0, x - 0.5); };
  std::vector<double> y = values_of(k_six, {2.0}, touching);
  y[1] += 0.01;
  y[4] += 0.01;
  const auto problem = problem_of(k_six, y, {{-9.0, 9.0, false, {}}}, touching);
  EXPECT_EQ(uncertainty_at(problem, *minimise(problem), 0.95).silent_rows, 2U);
}

TEST(Uncertainty, IntervalsCoverTheTruthAsOftenAsTheySay) {
  // Four points and two parameters: the quantile of the normal distribution would cover 81 % here, not 95 %.
  const std::vector<double> x{0.0, 0.3, 0.7, 1.0};
  const std::vector<double> truth{1.0, 2.0};
  std::mt19937 generator(20240501);
  std::normal_distribution<double> noise(0.0, 0.05);
  constexpr int k_trials = 400;
  std::array<int, 2> covered{};
  for (int trial = 0; trial < k_trials; ++trial) {
    std::vector<double> y = values_of(x, truth, k_line);
    for (double& value : y) value += noise(generator);
    const auto problem = problem_of(x, y, {{-3.0, 5.0, false, {}}, {-3.0, 7.0, false, {}}}, k_line);
    const auto solution = minimise(problem);
    const Uncertainty uncertainty = uncertainty_at(problem, *solution, 0.95);
    for (std::size_t k = 0; k < 2; ++k) {
      covered[k] += std::abs(solution->parameters[k] - truth[k]) <= uncertainty.half_width(k) ? 1 : 0;
    }
  }
  // Three standard deviations of the binomial distribution.
  const double margin = 3.0 * std::sqrt(0.95 * 0.05 / k_trials);
  for (const int count : covered) EXPECT_NEAR(static_cast<double>(count) / k_trials, 0.95, margin);
}

TEST(Uncertainty, TellsWhatIsNotDetermined) {
  const auto sum = [](double x, std::span<const double> p) { return (p[0] + p[1]) * x + 0.0 * p[2] + p[3]; };
  std::vector<double> y = values_of(k_six, {1.0, 2.0, 0.0, 0.5}, sum);
  y[1] += 0.01;
  const std::vector<BoundedParameter> bounds(4, {-9.0, 9.0, false, {}});
  const auto problem = problem_of(k_six, y, bounds, sum);
  const auto solution = minimise(problem);
  const Uncertainty uncertainty = uncertainty_at(problem, *solution, 0.95);
  EXPECT_EQ(uncertainty.is_determined, (std::vector{false, false, false, true}));
  EXPECT_TRUE(std::isnan(uncertainty.standard_error(0)));
  EXPECT_GT(uncertainty.standard_error(3), 0.0);
}

TEST(Uncertainty, AsManyPointsAsParametersLeaveNothingToEstimateErrorsFrom) {
  const std::vector<double> x{0.0, 1.0};
  const auto problem = problem_of(x, {1.0, 3.0}, {{-9.0, 9.0, false, {}}, {-9.0, 9.0, false, {}}}, k_line);
  const auto solution = minimise(problem);
  EXPECT_NEAR(solution->parameters[0], 1.0, 1e-11);
  EXPECT_NEAR(solution->parameters[1], 2.0, 1e-11);
  const Uncertainty uncertainty = uncertainty_at(problem, *solution, 0.95);
  EXPECT_EQ(uncertainty.degrees_of_freedom, 0U);
  EXPECT_TRUE(std::isnan(uncertainty.standard_error(0)));
}

}  // namespace
}  // namespace monograin::uncertainty_test
