// Legendre series through the nodes of a Gauss rule, against polynomials and functions with known integrals.
#include "numerics/legendre_series.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace monograin::legendre_series_test {
namespace {

constexpr double k_epsilon = std::numeric_limits<double>::epsilon();

template <class Function>
LegendreSeries series_of(Function&& function, const LegendreNodes& nodes = LegendreNodes::many()) {
  LegendreSamples samples{};
  for (std::size_t j = 0; j < nodes.count; ++j) samples[j] = function(nodes.places[j]);
  LegendreSeries series;
  series.fit(nodes, samples);
  return series;
}

/// The monomial, and its integral from -1.
double power(double t, int degree) { return std::pow(t, degree); }
double integrated_power(double t, int degree) {
  return (std::pow(t, degree + 1) - std::pow(-1.0, degree + 1)) / (degree + 1);
}

class LegendreRule : public testing::TestWithParam<bool> {
 protected:
  const LegendreNodes& nodes = GetParam() ? LegendreNodes::many() : LegendreNodes::few();
};
INSTANTIATE_TEST_SUITE_P(FewAndMany, LegendreRule, testing::Bool());

TEST_P(LegendreRule, AscendsAndLiesSymmetrically) {
  for (std::size_t j = 0; j < nodes.count; ++j) {
    EXPECT_LT(std::abs(nodes.places[j]), 1.0);
    EXPECT_EQ(nodes.places[j], -nodes.places[nodes.count - 1 - j]);
    if (j > 0) {
      EXPECT_LT(nodes.places[j - 1], nodes.places[j]);
    }
  }
}

TEST_P(LegendreRule, ExtendsPolynomialsOfValuesAndSlopes) {
  // Three values and three slopes: exact up to the fifth degree; two each at the first node but one, one each at the
  // first.
  const auto before = [&](std::size_t j, std::size_t back) { return j > back ? nodes.places[j - 1 - back] : -1.0; };
  for (std::size_t j = 0; j < nodes.count; ++j) {
    const std::size_t known = std::min(j + 1, LegendreNodes::k_known);
    for (int degree = 0; degree < 2 * static_cast<int>(known); ++degree) {
      double sum = 0.0;
      double scale = 1.0;
      for (std::size_t i = 0; i < known; ++i) {
        const double x = before(j, i);
        const double value = nodes.ahead[j].values[i] * power(x, degree);
        const double slope = degree == 0 ? 0.0 : nodes.ahead[j].slopes[i] * degree * power(x, degree - 1);
        sum += value + slope;
        scale += std::abs(value) + std::abs(slope);
      }
      EXPECT_NEAR(sum, power(nodes.places[j], degree), 20.0 * k_epsilon * scale)
          << "node " << j << ", degree " << degree;
    }
    if (j == 0) continue;
    // And a straight line through two values.
    const double gone = before(j, 0) - before(j, 1);
    EXPECT_NEAR(before(j, 0) + nodes.ahead[j].onward * gone, nodes.places[j], 4.0 * k_epsilon);
  }
}

TEST_P(LegendreRule, ReproducesPolynomialsUpToItsDegree) {
  const int count = static_cast<int>(nodes.count);
  for (int degree = 0; degree < count; ++degree) {
    const LegendreSeries series = series_of([&](double t) { return power(t, degree); }, nodes);
    for (const double t : {-1.0, -0.7, -0.123, 0.0, 0.4, 0.95, 1.0}) {
      EXPECT_NEAR(series.value(t), power(t, degree), 40.0 * k_epsilon) << "t^" << degree << " at " << t;
    }
  }
  // Not one degree more: the rule's nodes are the zeros of what is missing.
  const LegendreSeries beyond = series_of([&](double t) { return power(t, count); }, nodes);
  EXPECT_GT(std::abs(beyond.value(1.0) - 1.0), 1e-5);
}

TEST(LegendreSeries, PassesThroughItsSamples) {
  const auto function = [](double t) { return 1.0 / (1.2 + t); };
  const LegendreSeries series = series_of(function);
  for (const double t : LegendreNodes::many().places) {
    EXPECT_NEAR(series.value(t), function(t), 40.0 * k_epsilon * function(-1.0)) << t;
  }
}

TEST_P(LegendreRule, IntegratesPolynomialsInClosedForm) {
  for (int degree = 0; degree < static_cast<int>(nodes.count); ++degree) {
    const LegendreSeries series = series_of([&](double t) { return power(t, degree); }, nodes);
    EXPECT_EQ(series.integral(-1.0), 0.0);
    for (const double t : {-0.8, -0.3, 0.0, 0.6, 1.0}) {
      EXPECT_NEAR(series.integral(t), integrated_power(t, degree), 20.0 * k_epsilon) << "t^" << degree << " to " << t;
    }
  }
}

TEST_P(LegendreRule, IntegratesTwiceItsDegreeOverTheWhole) {
  // As the Gauss rule does, and no more.
  const int most = 2 * static_cast<int>(nodes.count) - 1;
  for (int degree = static_cast<int>(nodes.count); degree <= most; ++degree) {
    const LegendreSeries series = series_of([&](double t) { return power(t, degree); }, nodes);
    EXPECT_NEAR(series.integral(1.0), integrated_power(1.0, degree), 20.0 * k_epsilon) << "t^" << degree;
  }
  const LegendreSeries beyond = series_of([&](double t) { return power(t, most + 1); }, nodes);
  EXPECT_GT(std::abs(beyond.integral(1.0) - integrated_power(1.0, most + 1)), 1e-9);
}

TEST(LegendreSeries, IntegratesSmoothFunctions) {
  const LegendreSeries series = series_of([](double t) { return std::exp(t); });
  for (const double t : {-0.5, 0.0, 0.5, 1.0}) {
    EXPECT_NEAR(series.integral(t), std::exp(t) - std::exp(-1.0), 1e-13) << t;
  }
}

// --- reach

/// exp over intervals of this length, each as a function on [-1, 1].
LegendreSeries exponential_over(double length) {
  return series_of([=](double t) { return std::exp(0.5 * length * t); });
}

/// 1 + t^11, and the coefficient of its last Legendre polynomial: 11!/21!!.
double with_last_term(double t) { return 1.0 + power(t, k_most_nodes - 1); }
constexpr double k_last_term = 39916800.0 / 13749310575.0;

TEST(LegendreReach, IsWhereTheLastTermIsNegligible) {
  const double reach = series_of(with_last_term).reach(0.0);
  EXPECT_LT(reach, 1.0);
  // Over that much of the interval the last term is just so small, and over half as much it is far from it.
  EXPECT_NEAR(series_of([=](double t) { return with_last_term(reach * t); }).reach(0.0), 1.0, 1e-5);
  EXPECT_NEAR(series_of([=](double t) { return with_last_term(2.0 * reach * t); }).reach(0.0), 0.5, 1e-8);
  // The interval is 2 long: of an error of the whole integral half counts.
  EXPECT_NEAR(series_of(with_last_term).reach(2.0 * k_last_term), 1.0, 1e-12);
}

TEST(LegendreReach, TellsWhereASeriesHasConverged) {
  EXPECT_GT(exponential_over(1.0).reach(0.0), 1.0);
  EXPECT_LT(exponential_over(20.0).reach(0.0), 1.0);
  // Where it says so the integral has.
  for (const double length : {1.0, 2.0, 3.0, 4.0, 6.0}) {
    const LegendreSeries series = exponential_over(length);
    if (series.reach(0.0) < 1.0) continue;
    const double exact = 4.0 / length * std::sinh(0.5 * length);
    EXPECT_NEAR(series.integral(1.0), exact, 1e-15 * exact) << length;
  }
}

TEST(LegendreReach, FallsWithTheLengthOfTheInterval) {
  double last = std::numeric_limits<double>::infinity();
  for (const double length : {4.0, 6.0, 9.0, 13.0, 20.0}) {
    const double reach = exponential_over(length).reach(0.0);
    EXPECT_LT(reach, last) << length;
    last = reach;
  }
}

TEST(LegendreReach, GrowsWithWhatIsNegligible) {
  const LegendreSeries series = exponential_over(20.0);
  double last = series.reach(0.0);
  for (const double negligible : {1e-6, 1e-3, 1.0, 1e3}) {
    const double reach = series.reach(negligible);
    EXPECT_GT(reach, last) << negligible;
    last = reach;
  }
  EXPECT_GT(last, 1.0);
}

TEST(LegendreReach, IsFarOfWhatIsExactOrRounding) {
  EXPECT_GE(series_of([](double) { return 0.0; }).reach(0.0), 2.0);
  EXPECT_GE(series_of([](double) { return 3.0; }).reach(0.0), 2.0);
  EXPECT_GE(series_of([](double t) { return 1.0 + 0.5 * t * t; }).reach(0.0), 1.5);
  // Rounding of what the function is the difference of: coefficients that no shorter interval makes fall.
  EXPECT_GE(series_of([](double t) { return (1e6 + 0.3 * t) - 1e6; }).reach(0.0), 2.0);
}

TEST(LegendreReach, KnowsRoundingByWhatItIsToldOnly) {
  // A kink: the second half of its coefficients falls slowly, and leaves out more than the last ones show.
  const LegendreSeries series = series_of([](double t) { return std::max(t - 0.3, 0.0); });
  const double last = series.tail();
  EXPECT_LT(series.reach(0.2 * last), 1.0);
  EXPECT_LT(series.reach(0.2 * last, 0.9 * last), 1.0);
  EXPECT_GE(series.reach(0.2 * last, 1.1 * last), 2.0);
}

TEST(LegendreRest, TellsJumpsAndRootsFromSmoothFunctions) {
  const LegendreNodes& nodes = LegendreNodes::few();
  EXPECT_EQ(series_of([](double) { return 0.0; }, nodes).rest(0.0), 0.0);
  EXPECT_LT(series_of([](double t) { return std::exp(0.5 * t); }, nodes).rest(0.0), 1e-3);
  EXPECT_LT(series_of([](double t) { return std::pow(1.0 + t, 1.5); }, nodes).rest(0.0), 1e-2);
  EXPECT_EQ(series_of([](double t) { return t > 0.0 ? 1e-9 : 0.0; }, nodes).rest(1e-8), 0.0);
  for (const double place : {-0.6, 0.0, 0.6}) {
    EXPECT_GT(series_of([=](double t) { return t > place ? 1.0 : 0.0; }, nodes).rest(0.0), 0.1) << place;
    EXPECT_GT(series_of([=](double t) { return std::sqrt(std::max(place - t, 0.0)); }, nodes).rest(0.0), 0.03) << place;
  }
}

TEST(LegendreReach, DoesNotDependOnTheFunctionsSize) {
  const double reach = exponential_over(15.0).reach(0.0);
  for (const double size : {1e-12, 1e12}) {
    const LegendreSeries scaled = series_of([=](double t) { return size * std::exp(7.5 * t); });
    EXPECT_NEAR(scaled.reach(0.0), reach, 1e-9 * reach) << size;
  }
}

}  // namespace
}  // namespace monograin::legendre_series_test
