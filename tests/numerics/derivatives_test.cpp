#include "numerics/derivatives.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <vector>

namespace monograin::derivatives_test {
namespace {

/// One residual of one parameter between 0 and 10.
template <class Function>
LeastSquaresProblem problem_of(Function function) {
  LeastSquaresProblem problem;
  problem.parameters = {{0.0, 10.0, false, {}}};
  problem.residual_count = 1;
  problem.residuals = [function](std::span<const double> p, std::span<double> residuals) {
    residuals[0] = function(p[0]);
    return std::isfinite(residuals[0]);
  };
  return problem;
}

template <class Function>
double derivative_at(Function function, double x) {
  return residual_jacobian(problem_of(function), std::vector{x})(0, 0);
}

TEST(ResidualJacobian, OfASmoothResidualIsItsDerivative) {
  EXPECT_NEAR(derivative_at([](double x) { return std::sin(x); }, 2.0), std::cos(2.0), 1e-8);
}

TEST(ResidualJacobian, LooksToOneSideAtABoundAndWhereTheOtherHasNoResiduals) {
  const auto square = [](double x) { return x * x; };
  EXPECT_NEAR(derivative_at(square, 10.0), 20.0, 1e-2);
  const auto root_beyond_two = [](double x) { return std::sqrt(x - 2.0) * 0.0 + x * x; };
  EXPECT_NEAR(derivative_at(root_beyond_two, 2.0), 4.0, 1e-2);
}

TEST(ResidualJacobian, KnowsNothingOfAJumpBesideTheParameters) {
  for (const double side : {1e-9, -1e-9}) {
    const auto jumps = [side](double x) { return 3.0 * x + (x > 5.0 + side ? 100.0 : 0.0); };
    EXPECT_NEAR(derivative_at(jumps, 5.0), 3.0, 1e-6) << side;
  }
}

TEST(ResidualJacobian, IsZeroWhereThereAreNoResiduals) {
  EXPECT_EQ(derivative_at([](double) { return std::nan(""); }, 5.0), 0.0);
}

TEST(ResidualJacobian, IsUnknownWhereNeitherSideHasResiduals) {
  EXPECT_TRUE(std::isnan(derivative_at([](double x) { return x == 5.0 ? 1.0 : std::nan(""); }, 5.0)));
}

}  // namespace
}  // namespace monograin::derivatives_test
