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
    steps.back().leg = {k / count, (k + 1.0) / count, has_corners || k == 0.0, k / count, (k + 1.0) / count};
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

TEST(Legs, HaveTimesWithoutSums) {
  std::vector<Step> sine;
  for (int k = 0; k < 704; ++k) {
    sine.push_back(ramp(0.1 + 1e-4 * k, (k + 1) / 640.0 - k / 640.0));
    sine.back().leg = {k / 704.0, (k + 1) / 704.0, k == 0, k / 640.0, (k + 1) / 640.0};
  }
  EXPECT_EQ(run(hertz_pair(sine, 2)).last("time"), 1.1);
}

TEST(Legs, HaveARowAtEachOutputTimeHoweverLateTheyBegin) {
  constexpr int k_rows = 1000;
  for (const double before : {1.0, 1000.0}) {
    std::vector<Step> steps{ramp(0.1, before)};
    std::vector<double> times;
    for (int k = 0; k < k_rows; ++k) {
      const double begin = k / 1000.0;
      const double end = (k + 1) / 1000.0;
      steps.push_back(ramp(0.1 + 0.1 * end, end - begin));
      steps.back().leg = {begin, end, true, begin, end};
      times.push_back((1000.0 * before + k + 1) / 1000.0);
    }
    CheckedScenario scenario = hertz_scenario(Configuration::simple, steps);
    scenario.output.times = times;
    const TestRun result = run(scenario);
    const std::vector<double> found = result.outputs("time");
    ASSERT_EQ(found.size(), times.size() + 1) << before;
    for (std::size_t k = 0; k < times.size(); ++k) {
      EXPECT_NEAR(found[k + 1], times[k], 1e-12 * times[k]);
      EXPECT_NEAR(result.outputs("axial.displacement")[k + 1], steps[k + 1].target, 1e-12) << times[k];
    }
  }
}

// --- forces of tables, from row to row

/// A step of 3 s through forces at 1, 2, 2.25 and 3 s; the third one is zero.
std::vector<Step> forces_below_zero() {
  const std::vector<std::pair<double, double>> rows{{1.0, 0.010}, {2.0, -0.004}, {2.25, 0.0}, {3.0, 0.012}};
  std::vector<Step> steps;
  double begin = 0.0;
  for (const auto& [time, force] : rows) {
    steps.push_back(force_ramp(force, time - begin));
    steps.back().leg = {begin / 3.0, time / 3.0, begin != 2.25, begin, time};
    begin = time;
  }
  return steps;
}

TEST(ForcesOfTables, AreFollowedAfterALostContact) {
  const std::vector<double> times{1.5, 1.9, 2.1, 2.5, 2.9};
  const std::vector<double> forces{0.003, 0.0, 0.0, 0.004, 0.0104};
  for (CheckedScenario scenario : {hertz_scenario(Configuration::simple, forces_below_zero()),
                                   mdr_scenario(Configuration::simple, 50.0, 0.3, forces_below_zero())}) {
    scenario.output.times = times;
    for (const char* integrator : k_integrators) {
      const TestRun result = run(scenario, integrator);
      ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
      const std::vector<double> found = result.outputs("axial.force");
      ASSERT_EQ(found.size(), times.size() + 1);
      for (std::size_t k = 0; k < times.size(); ++k) {
        EXPECT_NEAR(found[k + 1], forces[k], 1e-9) << scenario.model << ", " << integrator << ", t = " << times[k];
      }
      EXPECT_NEAR(result.time_of("contact-lost"), 1.0 + 10.0 / 14.0, 1e-9);
      EXPECT_NEAR(result.time_of(scenario.model == "mdr" ? "dent-touched" : "contact-made"), 2.25, 1e-9);
    }
  }
}

TEST(ForcesOfTables, AreNotBorneBelowZeroAsAWarningSays) {
  const TestRun result = run(hertz_scenario(Configuration::simple, forces_below_zero()));
  ASSERT_EQ(result.record.warnings.size(), 1U);
  EXPECT_EQ(result.record.warnings[0],
            "step 1: no contact bears the force that is prescribed to 'axial' (-0.004 N at t = 2 s; open since t = "
            "1.71428571 s)");
}

TEST(ForcesOfTables, NameTheOpeningThatBelongsToTheLeastForce) {
  const std::vector<std::pair<double, double>> rows{{1.0, 0.010}, {2.0, -0.002}, {3.0, -0.001}, {4.0, 0.0},
                                                    {5.0, 0.012}, {7.0, -0.004}, {8.0, -0.005}, {9.0, -0.003}};
  std::vector<Step> steps;
  double begin = 0.0;
  for (const auto& [time, force] : rows) {
    steps.push_back(force_ramp(force, time - begin));
    steps.back().leg = {begin / 9.0, time / 9.0, begin != 4.0, begin, time};
    begin = time;
  }
  const TestRun result = run(hertz_scenario(Configuration::simple, steps));
  ASSERT_EQ(result.record.warnings.size(), 1U);
  EXPECT_EQ(result.record.warnings[0],
            "step 1: no contact bears the force that is prescribed to 'axial' (-0.005 N at t = 8 s; open since t = 6.5 "
            "s)");
}

TEST(ForcesOfTables, EndWithTheStepThatAConditionEnds) {
  std::vector<Step> steps = forces_below_zero();
  for (Step& step : steps) step.until = {{.event = "contact-lost"}};
  // A plain ramp starts from the present force, zero.
  const TestRun result = run(hertz_pair(followed_by(steps, force_ramp(0.01)), 4));
  EXPECT_NEAR(result.last("time"), 2.0 + 10.0 / 14.0, 1e-9);
  EXPECT_NEAR(result.outputs("axial.force")[5], 0.0025, 1e-12);
}

// --- walls with times of their own

TEST(Legs, OfARampBesideATableGiveTheHistoryOfTheRamp) {
  const auto beside = [](std::vector<Step> other) {
    return run(between(hertz_pair({}, 6), {wall("a", {0.0, 0.0, 1.0}, course({0.1, 0.2, 0.05})),
                                           wall("b", {0.0, 0.0, -1.0}, std::move(other))}));
  };
  std::vector<Step> divided = course({0.3, 0.3, 0.3});
  for (std::size_t k = 0; k < 3; ++k) divided[k].share = 1.0 / (3.0 - static_cast<double>(k));
  const std::vector<double> found = beside(divided).outputs("b.displacement");
  ASSERT_EQ(found.size(), 7U);
  for (std::size_t k = 0; k < 7; ++k) EXPECT_NEAR(found[k], 0.05 * static_cast<double>(k), 1e-15);
}

// --- beginnings

TEST(Tables, ThatDoNotBeginWhereTheWallIsGiveAWarning) {
  std::vector<Step> table = course({0.1, 0.2});
  table.front().start = 0.0;
  std::vector<Step> steps{force_ramp(0.001)};
  steps.insert(steps.end(), table.begin(), table.end());
  const auto warnings = run(hertz_pair(steps, 2)).record.warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(
      warnings[0].starts_with("step 2: the table or sine of 'axial' does not begin where the wall is: a ramp "
                              "leads from there to its next point (it begins at 0 m, the wall is at "))
      << warnings[0];
  steps[1].start = run(hertz_pair({force_ramp(0.001)}, 1)).last("axial.displacement") * (1.0 + 1e-9);
  EXPECT_TRUE(run(hertz_pair(steps, 2)).record.warnings.empty());
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
