// Steps that are written out as several ramps, and conditions on another wall.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/test_run.hpp"

namespace monograin::legs_test {
namespace {

/// A step of unit duration through displacements at equal times.
std::vector<Step> course(const std::vector<double>& displacements, bool has_corners = true) {
  std::vector<Step> steps;
  const auto count = static_cast<double>(displacements.size());
  for (const double displacement : displacements) {
    const auto k = static_cast<double>(steps.size());
    steps.push_back(ramp(displacement, 1.0 / count));
    steps.back().leg = {k / count, (k + 1.0) / count, has_corners || k == 0.0};
  }
  return steps;
}

std::vector<Step> with_end(std::vector<Step> steps, const Until& condition) {
  for (Step& step : steps) step.until = {condition};
  return steps;
}

std::vector<Step> followed_by(std::vector<Step> steps, Step last) {
  steps.push_back(std::move(last));
  return steps;
}

CheckedScenario hertz_pair(std::vector<Step> steps, int points) {
  return with_points(hertz_scenario(Configuration::simple, std::move(steps)), points);
}

using Rows = std::vector<std::pair<double, int>>;

Rows rows(const TestRun& result) {
  Rows list;
  const auto time = result.column("time");
  const auto side = result.column("row");
  for (std::size_t i = 0; i < time.size(); ++i)
    list.emplace_back(std::round(1e6 * time[i]) / 1e6, static_cast<int>(side[i]));
  return list;
}

std::size_t ends_of_steps(const TestRun& result) {
  const Table& events = result.record.events;
  std::size_t count = 0;
  for (std::size_t i = 0; i < events.row_count(); ++i) count += events.word(i, *events.find("event")) == "step-end";
  return count;
}

TEST(Legs, ShareTheOutputPointsOfTheirStep) {
  const TestRun result = run(hertz_pair(course({0.1, 0.2, 0.3}, false), 5));
  EXPECT_EQ(rows(result), (Rows{{0, 0}, {0.2, 0}, {0.4, 0}, {0.6, 0}, {0.8, 0}, {1, -1}, {1, 0}, {1, 1}}));
  EXPECT_EQ(ends_of_steps(result), 1U);
}

TEST(Legs, HaveRowsAtTheEventsBetweenThem) {
  const TestRun result = run(hertz_pair(course({0.1, 0.2, 0.1}, false), 2));
  EXPECT_EQ(rows(result), (Rows{{0, 0}, {0.5, 0}, {0.666667, -1}, {0.666667, 1}, {1, -1}, {1, 0}, {1, 1}}));
  EXPECT_NEAR(result.time_of("load-reversal"), 2.0 / 3.0, 1e-15);
}

TEST(Legs, HaveRowsAtTheCornersBetweenThem) {
  const TestRun result = run(hertz_pair(course({0.1, 0.2}), 2));
  EXPECT_EQ(rows(result), (Rows{{0, 0}, {0.5, -1}, {0.5, 0}, {0.5, 1}, {1, -1}, {1, 0}, {1, 1}}));
  EXPECT_EQ(ends_of_steps(result), 1U);
}

TEST(Legs, WithoutACornerStillHaveTheRowOfAnOutputPointThere) {
  const TestRun result = run(hertz_pair(course({0.1, 0.2}, false), 2));
  EXPECT_EQ(rows(result), (Rows{{0, 0}, {0.5, 0}, {1, -1}, {1, 0}, {1, 1}}));
  EXPECT_NEAR(result.outputs("axial.displacement")[1], 0.1, 1e-15);
}

TEST(Legs, AreOneStepInTheHistory) {
  const TestRun result = run(hertz_pair(followed_by(course({0.1, 0.2, 0.3}), ramp(0.2)), 4));
  EXPECT_EQ(result.column("step").front(), 1.0);
  EXPECT_EQ(result.last("step"), 2.0);
  EXPECT_EQ(result.last("time"), 2.0);
  EXPECT_EQ(ends_of_steps(result), 2U);
}

TEST(Legs, EndTogetherWhereAConditionIsMet) {
  const Until condition{.quantity = Quantity::displacement, .value = 0.15};
  for (const char* integrator : k_integrators) {
    const TestRun result =
        run(hertz_pair(followed_by(with_end(course({0.1, 0.2, 0.3}), condition), ramp(0.0, 0.5)), 4), integrator);
    EXPECT_NEAR(result.time_of("until-met"), 0.5, 1e-9) << integrator;
    EXPECT_NEAR(result.last("time"), 1.0, 1e-9) << integrator;
    EXPECT_NEAR(result.last("axial.displacement"), 0.0, 1e-12) << integrator;
    EXPECT_EQ(ends_of_steps(result), 2U) << integrator;
  }
}

TEST(Legs, AreDividedUpToWhereAConditionEndsThem) {
  const Until condition{.quantity = Quantity::displacement, .value = 0.15};
  const TestRun result = run(hertz_pair(with_end(course({0.1, 0.2}, false), condition), 3));
  EXPECT_EQ(rows(result), (Rows{{0, 0}, {0.25, 0}, {0.5, 0}, {0.75, -1}, {0.75, 0}, {0.75, 1}}));
}

TEST(Legs, WarnOnceOfAConditionThatNoneOfThemMeets) {
  const Until condition{.quantity = Quantity::displacement, .value = 0.5};
  const TestRun result = run(hertz_pair(with_end(course({0.1, 0.2, 0.3}), condition), 2));
  ASSERT_EQ(result.record.warnings.size(), 1U);
  EXPECT_EQ(result.record.warnings[0],
            "step 1: until axial.displacement = 0.5 m was never met (0 m at its beginning, 0.3 m at its end)");
}

TEST(Legs, HaveCornersWhereAnyWallHasOneWhicheverIsNamedFirst) {
  const std::vector<Step> with_corners = course({0.1, 0.2, 0.3});
  const std::vector<Step> without = course({0.1, 0.15, 0.2}, false);
  const auto rows_of = [](const std::vector<Step>& first, const std::vector<Step>& second) {
    return rows(
        run(between(hertz_pair({}, 5), {wall("a", {0.0, 0.0, 1.0}, first), wall("b", {0.0, 0.0, -1.0}, second)})));
  };
  EXPECT_EQ(rows_of(with_corners, without), rows_of(without, with_corners));
  EXPECT_GT(rows_of(without, with_corners).size(), rows_of(without, without).size());
}

TEST(Conditions, AskTheWallThatTheyName) {
  const auto die = [](const Until& condition) {
    Step step = ramp(0.3);
    step.until = {condition};
    return mdr_scenario(Configuration::die, 20.0, 0.3, {step});
  };
  const TestRun plain = run(die({.quantity = Quantity::force, .value = 0.01}));
  const TestRun lateral = run(die({.quantity = Quantity::force, .value = 0.01, .wall = "lateral"}));
  EXPECT_NEAR(plain.last("axial.force"), 0.01, 1e-9);
  EXPECT_NEAR(lateral.last("lateral.force"), 0.01, 1e-9);
  EXPECT_GT(lateral.last("axial.force"), 0.05);
}

TEST(Conditions, AskTheClassOfTheWallThatTheyName) {
  Step step = ramp(0.2);
  step.until = {{.quantity = Quantity::force, .value = 0.01, .wall = "anvil"}};
  CheckedScenario scenario =
      between(hertz_scenario(Configuration::simple, {}), {wall("punch", {0, 0, 1}, {step}), wall("anvil", {0, 0, -1})});
  scenario.loading.centre_is_free = true;
  const TestRun result = run(scenario);
  EXPECT_TRUE(result.has_event("until-met"));
  EXPECT_NEAR(result.last("anvil.force"), 0.01, 1e-9);
}

TEST(Conditions, AskTheirWallsWhereWallsAreNotMerged) {
  Step step = ramp(0.3);
  step.until = {{.quantity = Quantity::force, .value = 0.01, .wall = "lateral"}};
  const TestRun result = run(mdr_scenario(Configuration::die, 20.0, 0.3, {step}), "direct", {}, false);
  EXPECT_NEAR(result.last("lateral-x+.force"), 0.01, 1e-9);
}

}  // namespace
}  // namespace monograin::legs_test
