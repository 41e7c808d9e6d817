#include "numerics/search_box.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace monograin::search_box_test {
namespace {

/// The residuals p and q^2 of 2 <= p <= 6 and 0.01 <= q <= 100; there are none for q < 0.1.
LeastSquaresProblem two_parameters() {
  LeastSquaresProblem problem;
  problem.parameters = {{2.0, 6.0, false, {}}, {0.01, 100.0, true, {}}};
  problem.residual_count = 2;
  problem.residuals = [](std::span<const double> p, std::span<double> residuals) {
    residuals[0] = p[0];
    residuals[1] = p[1] * p[1];
    return p[1] >= 0.1;
  };
  return problem;
}

Place place_of(const SearchBox& box, double p, double q) { return {.z = {box.z_of(0, p), box.z_of(1, q)}}; }

TEST(SearchBox, GivesParametersBackAndKeepsTheirBounds) {
  const LeastSquaresProblem problem = two_parameters();
  const SearchBox box(problem);
  const auto back = box.parameters_at(place_of(box, 3.0, 0.5));
  EXPECT_NEAR(back[0], 3.0, 1e-14);
  EXPECT_NEAR(back[1], 0.5, 1e-14);
  for (const double z : {-7.0, -0.3, 0.0, 1.0, 2.0, 40.0}) {
    const auto parameters = box.parameters_at({.z = {z, z}});
    EXPECT_GE(parameters[0], 2.0);
    EXPECT_LE(parameters[0], 6.0);
    EXPECT_GE(parameters[1], 0.01);
    EXPECT_LE(parameters[1], 100.0);
    const double inside = folded(z);
    EXPECT_GE(inside, 0.0);
    EXPECT_LE(inside, k_end_of_z);
    EXPECT_NEAR(box.parameters_at({.z = {inside, inside}})[0], parameters[0], 1e-12) << z;
  }
}

// The logarithm of q is half-way between those of its bounds at q = 1.
TEST(SearchBox, SharesALogarithmicRangeByItsLogarithm) {
  const LeastSquaresProblem problem = two_parameters();
  const SearchBox box(problem);
  EXPECT_NEAR(box.share(place_of(box, 4.0, 1.0), 0), 0.5, 1e-15);
  EXPECT_NEAR(box.share(place_of(box, 4.0, 1.0), 1), 0.5, 1e-15);
}

TEST(SearchBox, PlacesNoValueOnItsBoundWhereDerivativesVanish) {
  const LeastSquaresProblem problem = two_parameters();
  const SearchBox box(problem);
  const Place at_bounds = place_of(box, 2.0, 100.0);
  EXPECT_GT(box.parameters_at(at_bounds)[0], 2.0);
  EXPECT_LT(box.parameters_at(at_bounds)[1], 100.0);
  EXPECT_TRUE(box.is_near_bound(at_bounds, 0));
  EXPECT_TRUE(box.is_near_bound(at_bounds, 1));
  EXPECT_FALSE(box.is_near_bound(place_of(box, 2.1, 90.0), 0));
}

TEST(SearchBox, CostIsTheSumOfTheLossButForPriors) {
  LeastSquaresProblem problem = two_parameters();
  problem.loss = {Loss::soft_l1, 0.7};
  problem.plain_count = 1;
  SearchBox box(problem);
  const double cost = box.cost_at(place_of(box, 3.0, 2.0));
  EXPECT_NEAR(cost, problem.loss.rho(3.0) + 16.0, 1e-13);
  EXPECT_NEAR(cost, cost_of(problem, std::vector{3.0, 4.0}), 1e-13);
}

TEST(SearchBox, PlacesWithoutResidualsHaveNoCost) {
  const LeastSquaresProblem problem = two_parameters();
  SearchBox box(problem);
  EXPECT_EQ(box.cost_at(place_of(box, 3.0, 0.05)), k_no_cost);
  EXPECT_EQ(box.failures(), 1);
  const double cost = box.cost_at(place_of(box, 3.0, 2.0));
  EXPECT_GT(box.beyond_all_costs(), cost);
}

TEST(SearchBox, KeepsTheResidualsOfTheLastPlace) {
  const LeastSquaresProblem problem = two_parameters();
  SearchBox box(problem);
  static_cast<void>(box.cost_at(place_of(box, 3.0, 2.0)));
  const double again = box.cost_at(place_of(box, 3.0, 2.0));
  EXPECT_NEAR(again, 25.0, 1e-12);
  EXPECT_EQ(box.evaluations(), 1);
}

// dp/dz = 4 sin 2z, and d(q^2)/dz = 2 q^2 ln(1e4) sin 2z.
TEST(SearchBox, DerivativesAreThoseOfTheResidualsByZ) {
  const LeastSquaresProblem problem = two_parameters();
  SearchBox box(problem);
  const Place place = place_of(box, 3.0, 2.0);
  std::vector<double> values(2);
  ASSERT_TRUE(box.evaluate(place, values));
  for (const bool is_central : {true, false}) {
    const Eigen::MatrixXd jacobian = box.derivatives(place, values, is_central);
    const double accuracy = is_central ? 1e-6 : 1e-4;
    EXPECT_NEAR(jacobian(0, 0), 4.0 * std::sin(2.0 * place.z[0]), accuracy);
    EXPECT_NEAR(jacobian(1, 1), 8.0 * std::log(1e4) * std::sin(2.0 * place.z[1]), 100.0 * accuracy);
    EXPECT_EQ(jacobian(0, 1), 0.0);
    EXPECT_EQ(jacobian(1, 0), 0.0);
  }
}

TEST(SearchBox, DerivativesLookToTheSideThatHasResiduals) {
  const LeastSquaresProblem problem = two_parameters();
  SearchBox box(problem);
  const Place place = place_of(box, 3.0, 0.1 * (1.0 + 1e-12));
  std::vector<double> values(2);
  ASSERT_TRUE(box.evaluate(place, values));
  const double expected = 0.02 * std::log(1e4) * std::sin(2.0 * place.z[1]);
  EXPECT_NEAR(box.derivatives(place, values, true)(1, 1), expected, 1e-3 * expected);
}

}  // namespace
}  // namespace monograin::search_box_test
