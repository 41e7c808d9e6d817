// Least squares: the global minimum, bounds, losses, and what is known of the parameters.

#include "numerics/least_squares.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "numerics/derivatives.hpp"
#include "numerics/uncertainty.hpp"

namespace monograin::least_squares_test {
namespace {

/// Fits y over x by a function of some parameters.
template <class Model>
LeastSquaresProblem problem_of(const std::vector<double>& x, const std::vector<double>& y,
                               std::vector<BoundedParameter> parameters, Model model) {
  LeastSquaresProblem problem;
  problem.parameters = std::move(parameters);
  problem.residual_count = x.size();
  problem.residuals = [x, y, model](std::span<const double> p, std::span<double> residuals) {
    for (std::size_t i = 0; i < x.size(); ++i) residuals[i] = y[i] - model(x[i], p);
    return true;
  };
  return problem;
}

template <class Model>
std::vector<double> values_of(const std::vector<double>& x, const std::vector<double>& p, Model model) {
  std::vector<double> y;
  for (const double at : x) y.push_back(model(at, std::span<const double>(p)));
  return y;
}

Uncertainty uncertainty_at(const LeastSquaresProblem& problem, const LeastSquaresSolution& solution, double level) {
  return uncertainty_of(problem, solution, residual_jacobian(problem, solution.parameters), problem.residual_count,
                        level);
}

const auto k_line = [](double x, std::span<const double> p) { return p[0] + p[1] * x; };
const auto k_decay = [](double x, std::span<const double> p) { return p[0] * std::exp(-p[1] * x); };
const std::vector<double> k_six{0.0, 0.2, 0.4, 0.6, 0.8, 1.0};

TEST(LeastSquares, FindsTheParametersOfExactData) {
  const std::vector<double> truth{0.37, 2.9};
  const auto problem =
      problem_of(k_six, values_of(k_six, truth, k_decay), {{0.01, 100.0, true, {}}, {0.0, 10.0, false, {}}}, k_decay);
  const auto solution = minimise(problem);
  ASSERT_TRUE(solution);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(solution->parameters[k] / truth[k], 1.0, 1e-12);
  EXPECT_TRUE(solution->has_converged);
  EXPECT_EQ(solution->failures, 0);
}

/// The term without a derivative at the bound 0 gives the cost a second minimum: near 0.05 for exponents below 0.005,
/// and near 0.003 for one of 0.05.
TEST(LeastSquares, FindsTheGlobalMinimumFromAnyStart) {
  const auto model = [](double x, std::span<const double> p) {
    return p[0] * (1.0 - 2.0 * std::pow(p[1], 0.4616) * x * std::sqrt(x) + 6.0 * p[1] * x);
  };
  std::vector<double> x;
  for (int i = 1; i <= 30; ++i) x.push_back(i / 60.0);
  for (const double exponent : {0.001, 0.003, 0.03, 0.05, 0.3}) {
    const auto y = values_of(x, {2.0, exponent}, model);
    for (const double start : {0.0, 0.002, 0.04, 0.5, 1.0}) {
      const auto solution = minimise(problem_of(x, y, {{0.1, 100.0, true, {}}, {0.0, 1.0, false, start}}, model));
      ASSERT_TRUE(solution);
      EXPECT_NEAR(solution->parameters[1], exponent, 1e-9) << "from " << start;
      EXPECT_NEAR(solution->parameters[0], 2.0, 1e-9) << "from " << start;
    }
  }
}

TEST(LeastSquares, ConvergesAlongAValleyOfCorrelatedParameters) {
  const std::vector<double> truth{3.0, 0.65};
  const auto power = [](double x, std::span<const double> p) { return p[0] * std::pow(x, p[1]); };
  std::vector<double> x;
  for (int i = 1; i <= 20; ++i) x.push_back(1e-3 * (1.0 + 0.01 * i));
  auto problem = problem_of(x, values_of(x, truth, power), {{0.1, 100.0, true, {}}, {0.0, 1.0, false, {}}}, power);
  const double scale = 1.0 / (truth[0] * std::pow(x.back(), truth[1]));
  const auto raw = problem.residuals;
  problem.residuals = [raw, scale](std::span<const double> p, std::span<double> r) {
    raw(p, r);
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = scale * r[i] + 1e-4 * (static_cast<double>((i * 7) % 5) - 2.0);
    return true;
  };
  const auto solution = minimise(problem);
  ASSERT_TRUE(solution);
  EXPECT_TRUE(solution->has_converged);
  EXPECT_GT(uncertainty_at(problem, *solution, 0.95).correlation(0, 1), 0.999);
  const Eigen::MatrixXd jacobian = residual_jacobian(problem, solution->parameters);
  const Eigen::Map<const Eigen::VectorXd> residuals(solution->residuals.data(), jacobian.rows());
  for (Eigen::Index k = 0; k < 2; ++k) {
    EXPECT_LT(std::abs(jacobian.col(k).dot(residuals)), 1e-7 * jacobian.col(k).norm() * residuals.norm()) << k;
  }
}

TEST(LeastSquares, AParameterDrivenIntoItsBoundIsSetToIt) {
  const auto problem =
      problem_of(k_six, values_of(k_six, {1.0, 5.0}, k_line), {{-3.0, 3.0, false, {}}, {0.0, 4.0, false, {}}}, k_line);
  const auto solution = minimise(problem);
  ASSERT_TRUE(solution);
  using Bound = LeastSquaresSolution::Bound;
  EXPECT_EQ(solution->bounds, (std::vector{Bound::none, Bound::upper}));
  EXPECT_EQ(solution->parameters[1], 4.0);
  EXPECT_NEAR(solution->parameters[0], 1.5, 1e-9);  // the mean of 1 + 5 x - 4 x
  const Uncertainty uncertainty = uncertainty_at(problem, *solution, 0.95);
  EXPECT_TRUE(std::isnan(uncertainty.standard_error(1)));
  EXPECT_GT(uncertainty.standard_error(0), 0.0);
}

TEST(LeastSquares, PlacesWithoutResidualsArePassedOver) {
  auto problem =
      problem_of(k_six, values_of(k_six, {1.0, 2.0}, k_line), {{-9.0, 9.0, false, {}}, {-9.0, 9.0, false, {}}}, k_line);
  const auto raw = problem.residuals;
  problem.residuals = [raw](std::span<const double> p, std::span<double> r) { return p[1] > 1.9 && raw(p, r); };
  const auto solution = minimise(problem);
  ASSERT_TRUE(solution);
  EXPECT_NEAR(solution->parameters[1], 2.0, 1e-9);
  EXPECT_GT(solution->failures, 100);
  problem.residuals = [](std::span<const double>, std::span<double>) { return false; };
  EXPECT_FALSE(minimise(problem));
}

TEST(LeastSquares, RobustLossesForgetAnOutlier) {
  std::vector<double> y = values_of(k_six, {1.0, 2.0}, k_line);
  y[2] += 3.0;
  auto problem = problem_of(k_six, y, {{-9.0, 9.0, false, {}}, {-9.0, 9.0, false, {}}}, k_line);
  EXPECT_GT(std::abs(minimise(problem)->parameters[0] - 1.0), 0.5);
  for (const Loss loss : {Loss::huber, Loss::soft_l1, Loss::cauchy}) {
    problem.loss = {loss, 0.01};
    const auto solution = minimise(problem);
    EXPECT_NEAR(solution->parameters[0], 1.0, 0.02) << static_cast<int>(loss);
    EXPECT_NEAR(solution->parameters[1], 2.0, 0.02) << static_cast<int>(loss);
  }
}

TEST(LossFunctions, InfluenceAndCurvatureAreDerivativesOfRho) {
  for (const Loss kind : {Loss::linear, Loss::huber, Loss::soft_l1, Loss::cauchy}) {
    const LossFunction loss{kind, 0.7};
    for (const double r : {-3.0, -0.5, 0.2, 1.1}) {
      const double h = 1e-5;
      EXPECT_NEAR((loss.rho(r + h) - loss.rho(r - h)) / (4.0 * h), loss.influence(r), 1e-9);
      EXPECT_NEAR((loss.influence(r + h) - loss.influence(r - h)) / (2.0 * h), loss.curvature(r), 1e-9);
    }
    EXPECT_NEAR(loss.rho(1e-3), 1e-6, 1e-11) << "the square, where residuals are small";
  }
}

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
}  // namespace monograin::least_squares_test
