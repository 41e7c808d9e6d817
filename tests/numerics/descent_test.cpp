#include "numerics/descent.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "numerics/curve_fit.hpp"

namespace monograin::descent_test {
namespace {

using namespace curve_fit;

/// Exact data of a decay with the factor 1 and the rate 2.
LeastSquaresProblem decay() {
  return problem_of(k_six, values_of(k_six, {1.0, 2.0}, k_decay), {{0.1, 10.0, true, {}}, {0.0, 10.0, false, {}}},
                    k_decay);
}

Place place_at(SearchBox& box, double factor, double rate) {
  Place place{.z = {box.z_of(0, factor), box.z_of(1, rate)}};
  place.cost = box.cost_at(place);
  return place;
}

TEST(Descent, NeverEndsHigherThanItsStart) {
  const LeastSquaresProblem problem = decay();
  SearchBox box(problem);
  const Place start = place_at(box, 3.0, 7.0);
  double before = start.cost;
  for (const std::size_t iterations : {1U, 2U, 4U, 8U}) {
    const Place end = descend(box, start, {.iterations = iterations, .step = 0.0});
    EXPECT_LE(end.cost, before) << iterations;
    before = end.cost;
  }
}

TEST(Descent, GoesToTheRoundOffOfTheParameters) {
  const LeastSquaresProblem problem = decay();
  SearchBox box(problem);
  const Place near = descend(box, place_at(box, 3.0, 7.0), k_long_descent);
  const Place end = descend_to_round_off(box, near);
  EXPECT_TRUE(end.has_converged);
  EXPECT_NEAR(box.parameters_at(end)[0], 1.0, 1e-13);
  EXPECT_NEAR(box.parameters_at(end)[1], 2.0, 1e-13);
}

TEST(Descent, StopsNearAKnownPlace) {
  const LeastSquaresProblem problem = decay();
  SearchBox box(problem);
  const Place start = place_at(box, 3.0, 7.0);
  const Place end = descend(box, start, k_long_descent);
  const long alone = box.evaluations();
  SearchBox other(problem);
  const Place stopped = descend(other, place_at(other, 3.0, 7.0), k_long_descent, std::vector{end});
  EXPECT_LT(other.evaluations(), alone);
  EXPECT_GT(stopped.cost, end.cost);
}

TEST(Descent, StaysWhereFewerResidualsThanParametersAreGiven) {
  const LeastSquaresProblem problem =
      problem_of({0.5}, {1.0}, {{0.1, 10.0, true, {}}, {0.0, 10.0, false, {}}}, k_decay);
  SearchBox box(problem);
  const Place start = place_at(box, 3.0, 7.0);
  EXPECT_EQ(descend(box, start, k_long_descent).z, start.z);
}

// The residuals |p - 2| + 1 and p / 10: no side of the kink at p = 2 has a derivative of zero.
TEST(Descent, FindsTheBottomOfAKink) {
  LeastSquaresProblem problem;
  problem.parameters = {{0.0, 10.0, false, {}}};
  problem.residual_count = 2;
  problem.residuals = [](std::span<const double> p, std::span<double> residuals) {
    residuals[0] = std::abs(p[0] - 2.0) + 1.0;
    residuals[1] = 0.1 * p[0];
    return true;
  };
  SearchBox box(problem);
  Place place{.z = {box.z_of(0, 2.02)}};
  place.cost = box.cost_at(place);
  const Place end = descend_over_kinks(box, place);
  EXPECT_LT(end.cost, place.cost);
  EXPECT_NEAR(box.parameters_at(end)[0], 2.0, 2e-3);
}

TEST(Descent, LeavesASmoothMinimumWhereItIs) {
  LeastSquaresProblem problem =
      problem_of(k_six, {1.1, 1.3, 1.9, 2.1, 2.8, 2.9}, {{-9.0, 9.0, false, {}}, {-9.0, 9.0, false, {}}}, k_line);
  SearchBox box(problem);
  const Place minimum = descend_to_round_off(box, descend(box, place_at(box, 0.0, 0.0), k_long_descent));
  EXPECT_EQ(descend_over_kinks(box, minimum).z, minimum.z);
}

}  // namespace
}  // namespace monograin::descent_test
