// Requirements on modes and guards that every integrator has to meet, on systems with known solutions.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "history/run.hpp"
#include "support/test_run.hpp"
#include "support/toy_system.hpp"

namespace monograin::integrator_test {
namespace {

using View = ToySystem::View;

TestRun run_toy(std::unique_ptr<ToySystem> toy, std::string_view integrator, double rtol = 1e-8,
                std::size_t steps = 1) {
  TestRun result{toy_scene(std::move(toy), steps), {}};
  Output output;
  output.points = 20;
  result.record = record_run(result.scene, integrator, relative(rtol), output);
  return result;
}

class EveryIntegrator : public ::testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] bool is_direct() const { return std::string_view(GetParam()) == "direct"; }
};

TEST_P(EveryIntegrator, FollowsASmoothSolution) {
  // 2.6 rtol measured (IDA).
  for (const double rtol : {1e-6, 1e-8, 1e-10}) {
    const TestRun result = run_toy(decaying_toy(), GetParam(), rtol);
    ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
    EXPECT_NEAR(result.last("y0"), std::exp(-1.0), is_direct() ? 1e-16 : 8.0 * rtol) << "rtol = " << rtol;
  }
}

TEST_P(EveryIntegrator, LocatesAnEventAsWellAsItIntegrates) {
  for (const double rtol : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    auto toy = decaying_toy();
    toy->watched = {{"half", -1, [](double, View y) { return y[0] - 0.5; }, [](std::span<double> y) { y[0] = -1.0; }}};
    const TestRun result = run_toy(std::move(toy), GetParam(), rtol);
    // Error of the solution over the guard's slope 1/2; the root's own bracket is 1e-14.
    EXPECT_NEAR(result.time_of("half"), std::numbers::ln2, is_direct() ? 1e-14 : 10.0 * rtol + 1e-13)
        << "rtol = " << rtol;
  }
}

TEST_P(EveryIntegrator, BouncesABallAtTheRightTimes) {
  constexpr double k_gravity = 32.0;
  auto toy = std::make_unique<ToySystem>();
  toy->initial = {1.0, 0.0};  // height, speed
  toy->rates_function = [](double, View y, std::span<double> dy) {
    dy[0] = y[1];
    dy[1] = -k_gravity;
  };
  toy->flow = [](double start, View from, double xi, std::span<double> y) {
    const double t = xi - start;
    y[0] = from[0] + t * (from[1] - 0.5 * k_gravity * t);
    y[1] = from[1] - k_gravity * t;
  };
  toy->watched = {{"bounce", -1, [](double, View y) { return y[0]; },
                   [](std::span<double> y) {
                     y[0] = 0.0;
                     y[1] *= -0.5;
                   }}};
  const TestRun result = run_toy(std::move(toy), GetParam());
  ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
  // Falls for 1/4 s; the first flight takes 1/4 s, each further one half as long as the one before.
  const auto times = result.record.events.column("time");
  ASSERT_GE(times.size(), 4u);
  double expected = 0.25;
  // Shorter flights lie between two of the instants at which `direct` evaluates guards.
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(times[k], expected, is_direct() ? 1e-13 : 1e-7)
        << "bounce " << k;  // some rtol, doubled at every bounce
    expected += 0.25 * std::pow(0.5, static_cast<double>(k));
  }
}

TEST_P(EveryIntegrator, AppliesSimultaneousGuardsOnceInTheirDeclaredOrder) {
  auto toy = std::make_unique<ToySystem>();
  const auto nothing = [](std::span<double>) {};
  // Three forms of y = 0.3 that differ by round-off and slope; the first guard is not the first that round-off moves
  // past zero.
  toy->watched = {{"square", 1, [](double, View y) { return y[0] * y[0] - 0.09; }, nothing},
                  {"steep", 1, [](double, View y) { return 3.0 * y[0] - 0.9; }, nothing},
                  {"plain", 1, [](double, View y) { return y[0] - 0.3; }, nothing},
                  {"later", 1, [](double, View y) { return y[0] - 0.6; }, nothing}};
  for (ToySystem::ToyGuard& guard : toy->watched) {
    // A guard stays beyond its root: the transition moves the state a little further, as a model does.
    guard.transition = [](std::span<double> y) { y[0] += 1e-9; };
  }
  const TestRun result = run_toy(std::move(toy), GetParam());
  EXPECT_EQ(result.events(), (std::vector<std::string>{"square", "steep", "plain", "later"}));
  EXPECT_EQ(toy_in(result.scene).fired_together, (std::vector<std::vector<std::size_t>>{{0, 1, 2}, {3}}));
}

TEST_P(EveryIntegrator, DoesNotFireAGuardThatIsZeroAtTheStart) {
  for (const int direction : {1, -1}) {
    auto toy = std::make_unique<ToySystem>();
    toy->watched = {{"start", direction, [](double, View y) { return y[0]; }}};
    const TestRun result = run_toy(std::move(toy), GetParam());
    EXPECT_TRUE(result.events().empty()) << "direction " << direction;
  }
}

TEST_P(EveryIntegrator, FiresAGuardThatWasZeroAtTheStartWhenItReturns) {
  auto toy = std::make_unique<ToySystem>();
  toy->watched = {
      {"return", -1, [](double, View y) { return y[0] * (0.4 - y[0]); }, [](std::span<double> y) { y[0] += 1e-9; }}};
  const TestRun result = run_toy(std::move(toy), GetParam());
  EXPECT_EQ(result.events(), std::vector<std::string>{"return"});
  EXPECT_NEAR(result.time_of("return"), 0.4, 1e-9);  // y = xi is integrated exactly up to tolerance
}

/// Each mode drives the state into the other one; a transition leaves it just short of going back.
std::unique_ptr<ToySystem> chattering_toy() {
  auto toy = std::make_unique<ToySystem>();
  ToySystem* self = toy.get();
  toy->initial = {-0.5};
  toy->rates_function = [self](double, View, std::span<double> dy) { dy[0] = self->mode == 0 ? 1.0 : -1.0; };
  toy->flow = [self](double start, View from, double xi, std::span<double> y) {
    y[0] = from[0] + (self->mode == 0 ? xi - start : start - xi);
  };
  toy->watched = {{"up", 1, [](double, View y) { return y[0]; },
                   [self](std::span<double> y) {
                     self->mode = 1;
                     y[0] = 1e-15;
                   }},
                  {"down", -1, [](double, View y) { return y[0]; },
                   [self](std::span<double> y) {
                     self->mode = 0;
                     y[0] = -1e-15;
                   }}};
  return toy;
}

TEST_P(EveryIntegrator, GivesUpOnChatteringModesAndNamesThem) {
  const TestRun result = run_toy(chattering_toy(), GetParam());
  EXPECT_EQ(result.record.status, RunStatus::failed);
  EXPECT_NE(result.record.message.find("without progress"), std::string::npos) << result.record.message;
  EXPECT_NE(result.record.message.find("down of toy, up of toy"), std::string::npos) << result.record.message;
  EXPECT_GE(result.outputs("time").size(), 10u);  // the history up to there
}

TEST_P(EveryIntegrator, AsksWhetherItsToleranceIsTooFineIfItHasOne) {
  for (const double rtol : {1e-8, 1e-12}) {
    const TestRun result = run_toy(chattering_toy(), GetParam(), rtol);
    ASSERT_EQ(result.record.status, RunStatus::failed);
    const bool does = result.record.message.find("asks for errors of the size of round-off") != std::string::npos;
    EXPECT_EQ(does, rtol < 1e-11 && !is_direct()) << result.record.message;
  }
}

TEST_P(EveryIntegrator, StopsWhereTheEquationsEndAndKeepsTheHistory) {
  constexpr double k_end = 0.72;
  auto toy = decaying_toy();
  toy->rates_function = [](double xi, View y, std::span<double> dy) {
    if (xi > k_end) throw std::domain_error("the toy is not defined beyond 0.72");
    dy[0] = -y[0];
  };
  toy->flow = [](double start, View from, double xi, std::span<double> y) {
    if (xi > k_end) throw std::domain_error("the toy is not defined beyond 0.72");
    y[0] = from[0] * std::exp(start - xi);
  };
  const TestRun result = run_toy(std::move(toy), GetParam());
  EXPECT_EQ(result.record.status, RunStatus::stopped);
  EXPECT_EQ(result.events(), std::vector<std::string>{"limit"});
  EXPECT_NE(result.record.message.find("not defined beyond 0.72"), std::string::npos) << result.record.message;
  EXPECT_NEAR(result.last("time"), k_end, 1e-6);  // steps shrink towards it; the last ones are 1e-6 apart at most
  EXPECT_EQ(result.outputs("time").size(), 15u);  // 0, 0.05, ... 0.7
}

TEST_P(EveryIntegrator, StopsWhereASystemSaysItEnds) {
  auto toy = std::make_unique<ToySystem>();
  toy->watched = {{"edge", 1, [](double, View y) { return y[0] - 0.5; }, {}, true}};
  const TestRun result = run_toy(std::move(toy), GetParam());
  EXPECT_EQ(result.record.status, RunStatus::stopped);
  EXPECT_EQ(result.events(), std::vector<std::string>{"edge"});
  EXPECT_NE(result.record.message.find("the walls meet (xi = 0.5)"), std::string::npos) << result.record.message;
}

TEST_P(EveryIntegrator, NeverLooksBeyondACorner) {
  auto toy = decaying_toy();
  toy->watched = {{"never", 1, [](double, View y) { return y[0] - 2.0; }}};
  const TestRun result = run_toy(std::move(toy), GetParam(), 1e-8, 3);
  EXPECT_EQ(toy_in(result.scene).latest_xi, 1.0);
  EXPECT_EQ(toy_in(result.scene).earliest_xi, 0.0);
  EXPECT_NEAR(result.last("y0"), std::exp(-3.0), 1e-7);
}

TEST_P(EveryIntegrator, LetsOtherExceptionsThrough) {
  auto toy = decaying_toy();
  toy->rates_function = [](double, View, std::span<double>) { throw std::logic_error("a bug"); };
  toy->flow = [](double, View, double, std::span<double>) { throw std::logic_error("a bug"); };
  EXPECT_THROW(run_toy(std::move(toy), GetParam()), std::logic_error);
}

TEST_P(EveryIntegrator, CountsItsWork) {
  auto toy = decaying_toy();
  toy->watched = {{"half", -1, [](double, View y) { return y[0] - 0.5; }, [](std::span<double> y) { y[0] = 1.0; }}};
  const TestRun result = run_toy(std::move(toy), GetParam());
  const Statistics& statistics = result.record.statistics;
  EXPECT_EQ(statistics.events, 1);
  EXPECT_EQ(statistics.segments, 2);
  EXPECT_GE(statistics.steps, 4);
  EXPECT_GE(statistics.rhs_evaluations, statistics.steps);
  EXPECT_GE(statistics.guard_evaluations, statistics.steps);
  EXPECT_GT(statistics.last_step, 0.0);
  EXPECT_LE(statistics.last_step, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Engine, EveryIntegrator, ::testing::ValuesIn(k_integrators), [](const auto& test) {
  std::string name = test.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST(MakeIntegrator, RefusesUnknownNames) {
  auto toy = decaying_toy();
  toy->finish();
  GuardSet watch(*toy);
  EXPECT_THROW(static_cast<void>(make_integrator("euler", *toy, watch, {})), std::logic_error);
}

// --- the integrator that "auto" uses

/// y0 approaches cos(xi) at a given rate.
std::unique_ptr<ToySystem> following_toy(double rate) {
  auto toy = std::make_unique<ToySystem>();
  toy->initial = {1.0};
  toy->rates_function = [rate](double xi, View y, std::span<double> dy) {
    dy[0] = -rate * (y[0] - std::cos(xi)) - std::sin(xi);
  };
  return toy;
}

TEST(Automatic, GoesOverToTheStiffMethodWhereThatPays) {
  const auto steps = [](double rate, std::string_view integrator) {
    const TestRun result = run_toy(following_toy(rate), integrator);
    EXPECT_EQ(result.record.status, RunStatus::complete) << result.record.message;
    EXPECT_NEAR(result.last("y0"), std::cos(1.0), 1e-7) << integrator << ", rate " << rate;
    return result.record.statistics.steps;
  };
  constexpr std::string_view k_automatic = "odeint-dopri5, cvode-bdf where stiff";
  EXPECT_EQ(steps(1.0, k_automatic), steps(1.0, "odeint-dopri5")) << "nothing is stiff";
  EXPECT_GT(steps(1e5, "odeint-dopri5"), 10'000) << "stiff";
  EXPECT_LT(steps(1e5, k_automatic), 2'000);
}

TEST(Automatic, StaysWithTheStiffMethod) {
  auto toy = following_toy(1e5);
  toy->watched = {{"down", -1, [](double, View y) { return y[0] - 0.8; }, [](std::span<double>) {}}};
  const TestRun result = run_toy(std::move(toy), "odeint-dopri5, cvode-bdf where stiff", 1e-8, 3);
  ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
  EXPECT_GE(result.record.statistics.events, 1);
  EXPECT_LT(result.record.statistics.steps, 3'000);
}

}  // namespace
}  // namespace monograin::integrator_test
