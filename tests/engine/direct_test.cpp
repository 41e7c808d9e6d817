// The direct integrator between the instants that it evaluates.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "engine/integrator.hpp"
#include "support/test_run.hpp"
#include "support/toy_system.hpp"

namespace monograin::direct_test {
namespace {

using View = ToySystem::View;

// Guards are evaluated at the six nodes of each quarter of a step: these instants lie between those at 0.508 and 0.542.
constexpr double k_first = 0.515;
constexpr double k_second = 0.520;
constexpr double k_third = 0.530;

/// A guard that is above zero between two instants only.
double window(double y, double from, double to) { return 1e3 * (y - from) * (to - y); }

TestRun run_directly(std::unique_ptr<ToySystem> toy, int points = 4) {
  TestRun result{toy_scene(std::move(toy)), {}};
  result.record = record_run(result.scene, "direct", {}, {.points = points, .times = {}});
  return result;
}

TEST(Direct, FindsAnEarlierRootOnceALaterOneHasShortenedThePiece) {
  auto toy = std::make_unique<ToySystem>();
  toy->watched = {
      {"second", 1, [](double, View y) { return y[0] - k_second; }, [](std::span<double> y) { y[0] += 1e-9; }},
      {"first", 1, [](double, View y) { return window(y[0], k_first, k_third); },
       [](std::span<double> y) { y[0] += 1e-9; }}};
  const TestRun result = run_directly(std::move(toy));
  EXPECT_EQ(result.events(), (std::vector<std::string>{"first", "second"}));
  EXPECT_NEAR(result.time_of("first"), k_first, 1e-15);
  EXPECT_NEAR(result.time_of("second"), k_second - 1e-9, 1e-15);
}

TEST(Direct, FindsAGuardThatReturnsBetweenTwoEvaluations) {
  for (const int direction : {1, -1}) {
    auto toy = std::make_unique<ToySystem>();
    toy->watched = {{"out", direction,
                     [direction](double, View y) { return direction * window(y[0], k_first, k_second); },
                     [](std::span<double> y) { y[0] += 1e-9; }}};
    const TestRun result = run_directly(std::move(toy));
    EXPECT_EQ(result.events(), std::vector<std::string>{"out"}) << "direction " << direction;
    EXPECT_NEAR(result.time_of("out"), k_first, 1e-15) << "direction " << direction;
  }
}

TEST(Direct, AppliesRootsOfOnePieceInTheOrderOfTheirTimes) {
  auto toy = std::make_unique<ToySystem>();
  toy->watched = {
      {"third", 1, [](double, View y) { return y[0] - k_third; }, [](std::span<double> y) { y[0] += 1e-9; }},
      {"second", 1, [](double, View y) { return y[0] - k_second; }, [](std::span<double> y) { y[0] += 1e-9; }},
      {"first", 1, [](double, View y) { return std::cbrt(y[0] - k_first); },
       [](std::span<double> y) { y[0] += 1e-9; }}};
  const TestRun result = run_directly(std::move(toy));
  EXPECT_EQ(result.events(), (std::vector<std::string>{"first", "second", "third"}));
}

TEST(Direct, SeesAGuardThatBeginsAtZeroAndReturnsWithinTheFirstPiece) {
  for (const double root : {0.005, 0.01}) {  // before and after the first evaluation inside the piece, at 0.0084
    for (const int direction : {1, -1}) {
      SCOPED_TRACE(testing::Message() << root << ", direction " << direction);
      auto toy = std::make_unique<ToySystem>();
      toy->watched = {{"return", direction, [=](double, View y) { return direction * y[0] * (y[0] - root); },
                       [](std::span<double> y) { y[0] += 1e-9; }}};
      const TestRun result = run_directly(std::move(toy));
      EXPECT_EQ(result.events(), std::vector<std::string>{"return"});
      EXPECT_NEAR(result.time_of("return"), root, 1e-15);
    }
  }
}

TEST(Direct, DoesNotSearchForARootWithinRounding) {
  // A small difference of large numbers has equal values at a hundred neighbouring instants, and is zero at none of
  // them.
  constexpr double k_root = 0.0123;
  const auto difference = [](double y) { return (1.0 + 0.01 * y) - (1.0 + 0.01 * k_root) - 1e-18; };
  auto toy = std::make_unique<ToySystem>();
  int samples = 0;
  toy->watched = {{"rounded", 1, [&](double, View y) {
                     ++samples;
                     return difference(y[0]);
                   }}};
  const TestRun result = run_directly(std::move(toy));
  EXPECT_EQ(result.events(), std::vector<std::string>{"rounded"});
  EXPECT_NEAR(result.time_of("rounded"), k_root, 1e-13);
  EXPECT_GE(difference(result.at_event("rounded", "y0")), 0.0) << "on or past the root";
  EXPECT_LT(samples, 64);
}

TEST(Direct, DoesNotRefineRoundingOfTheRates) {
  for (const double noise : {1e-11, 1e-8, 1e-7}) {
    auto toy = std::make_unique<ToySystem>();
    toy->is_quadrature = true;
    toy->rates_function = [noise](double xi, View, std::span<double> dy) {
      dy[0] = std::exp(xi) * (1.0 + noise * std::sin(1e9 * xi));
    };
    const TestRun result = run_directly(std::move(toy));
    EXPECT_NEAR(result.last("y0"), std::exp(1.0) - 1.0, noise) << noise;
    EXPECT_LT(toy_in(result.scene).rates_count, 2000) << noise;
  }
}

TEST(Direct, RefinesARootAndAKinkHoweverSmall) {
  constexpr double k_small = 1e-6;
  for (const double power : {0.5, 1.0}) {
    auto toy = std::make_unique<ToySystem>();
    toy->is_quadrature = true;
    toy->rates_function = [power](double xi, View, std::span<double> dy) {
      dy[0] = 1.0 + k_small * std::pow(std::abs(xi - 0.3), power);
    };
    const TestRun result = run_directly(std::move(toy));
    const double integral = 1.0 + k_small * (std::pow(0.3, power + 1.0) + std::pow(0.7, power + 1.0)) / (power + 1.0);
    EXPECT_NEAR(result.last("y0"), integral, 1e-11) << power;
  }
}

TEST(Direct, EndsPiecesAtKinksThatTheSystemKnows) {
  const std::vector<double> kinks{0.1234, 0.4321, 0.5555, 0.8};
  std::vector<int> evaluations;
  for (const bool are_known : {false, true}) {
    auto toy = std::make_unique<ToySystem>();
    toy->is_quadrature = true;
    toy->rates_function = [&](double xi, View, std::span<double> dy) {
      dy[0] = std::exp(xi);
      for (const double kink : kinks) dy[0] += xi > kink ? (xi - kink) * (xi - kink) : 0.0;
    };
    if (are_known) toy->kinks = kinks;
    const TestRun result = run_directly(std::move(toy));
    double integral = std::exp(1.0) - 1.0;
    for (const double kink : kinks) integral += std::pow(1.0 - kink, 3) / 3.0;
    EXPECT_NEAR(result.last("y0"), integral, 1e-11) << are_known;
    evaluations.push_back(toy_in(result.scene).rates_count);
  }
  EXPECT_LT(evaluations[1], 150);
  EXPECT_LT(4 * evaluations[1], evaluations[0]);
}

TEST(Direct, IgnoresWeakKinksThatLieCloseTogether) {
  std::vector<int> evaluations;
  for (const bool are_known : {false, true}) {
    auto toy = std::make_unique<ToySystem>();
    toy->is_quadrature = true;
    toy->rates_function = [](double xi, View, std::span<double> dy) { dy[0] = std::exp(xi); };
    for (int k = 1; are_known && k < 1000; ++k) toy->kinks.push_back(1e-3 * k);
    evaluations.push_back(toy_in(run_directly(std::move(toy)).scene).rates_count);
  }
  EXPECT_EQ(evaluations[1], evaluations[0]);
}

TEST(Direct, SparesManyRowsACostlyPrimitiveButNextToASingularity) {
  for (const int points : {10, 1000}) {
    auto toy = std::make_unique<ToySystem>();
    toy->is_quadrature = true;
    toy->rates_function = [](double xi, View, std::span<double> dy) { dy[0] = 1.2 * std::pow(xi, 0.2) + 1.0; };
    toy->costly_primitive = [](double xi) { return std::pow(xi, 1.2) + xi; };
    const TestRun result = run_directly(std::move(toy), points);
    const Table& history = result.record.history;
    for (std::size_t row = 0; row < history.row_count(); ++row) {
      const double xi = result.column("time")[row];
      EXPECT_NEAR(result.column("y0")[row], std::pow(xi, 1.2) + xi, 1e-14) << xi;
    }
    const ToySystem& seen = toy_in(result.scene);
    if (points == 10) {
      EXPECT_EQ(seen.rates_count, 0) << "few rows cost less than a series";
    }
    EXPECT_LT(seen.primitive_count, points == 10 ? 20 : 100);
    EXPECT_LT(seen.rates_count, 300);
  }
}

TEST(Direct, StateDoesNotDependOnWhatWasAskedBefore) {
  auto toy = decaying_toy();
  toy->finish();
  GuardSet watch(*toy);
  std::vector<double> y{1.0};
  std::vector<Event> log;
  toy->begin_step({}, y, log);
  watch.begin_leg({}, 0.0, y);
  const auto direct = make_integrator("direct", *toy, watch, {});
  direct->begin(0.0, y);
  const double end = direct->advance().xi;
  double before = 0.0;
  double after = 0.0;
  direct->dense_output(0.5 * end, {&before, 1});
  direct->dense_output(0.9 * end, {&after, 1});
  direct->dense_output(0.5 * end, {&after, 1});
  EXPECT_EQ(before, after);
  EXPECT_EQ(before, std::exp(-0.5 * end));
}

TEST(Direct, ReachesTheEndOfTheStepExactly) {
  const TestRun result = run_directly(decaying_toy());
  EXPECT_EQ(result.last("time"), 1.0);
  EXPECT_EQ(result.last("y0"), std::exp(-1.0));
}

}  // namespace
}  // namespace monograin::direct_test
