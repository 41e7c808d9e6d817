// The global minimum of a sum of squares, its bounds and losses.

#include "numerics/least_squares.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "numerics/curve_fit.hpp"

namespace monograin::least_squares_test {
namespace {

using namespace curve_fit;

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

}  // namespace
}  // namespace monograin::least_squares_test
