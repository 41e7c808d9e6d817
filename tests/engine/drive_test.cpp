// Programs, conditions, output points and rows of whole runs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "elastic/hertz.hpp"
#include "engine/integrator.hpp"
#include "support/test_run.hpp"
#include "support/toy_system.hpp"

namespace monograin::drive_test {
namespace {

using enum Quantity;

CheckedScenario hertz_pair(std::vector<Step> steps, int points = 4) {
  return with_points(hertz_scenario(Configuration::simple, std::move(steps)), points);
}

CheckedScenario die(std::vector<Step> steps) { return mdr_scenario(Configuration::die, 20.0, 0.3, std::move(steps)); }

double hertz(double displacement) { return hertz_force(composite_modulus(1.0, 0.3), 1.0, displacement); }

/// Time, rounded to a nanosecond, and side of every row.
std::vector<std::pair<double, int>> rows(const TestRun& result) {
  std::vector<std::pair<double, int>> list;
  const auto time = result.column("time");
  const auto side = result.column("row");
  for (std::size_t i = 0; i < time.size(); ++i)
    list.emplace_back(std::round(1e9 * time[i]) / 1e9, static_cast<int>(side[i]));
  return list;
}

using Rows = std::vector<std::pair<double, int>>;

/// Tolerance of comparisons; larger for forward Euler, whose rtol is its step.
double accuracy(std::string_view integrator) { return integrator == "forward-euler" ? 1e-4 : 1e-7; }

TestRun run_with(const CheckedScenario& scenario, std::string_view integrator) {
  return run(scenario, integrator, relative(integrator == "forward-euler" ? 1e-5 : 1e-8));
}

/// Warnings about steps of the program.
std::vector<std::string> notes(const TestRun& result) {
  std::vector<std::string> list;
  for (const std::string& warning : result.record.warnings) {
    if (warning.starts_with("step")) list.push_back(warning);
  }
  return list;
}

/// End times of the program's steps.
std::vector<double> step_ends(const TestRun& result) {
  std::vector<double> ends;
  const Table& events = result.record.events;
  for (std::size_t i = 0; i < events.row_count(); ++i) {
    if (events.word(i, *events.find("event")) == "step-end") ends.push_back(events.at(i, *events.find("time")));
  }
  return ends;
}

// --- rows

TEST(Rows, StandAtOutputPointsAndOnBothSidesOfACorner) {
  const TestRun result = run(hertz_pair(path({0.1, 0.2}), 2));
  EXPECT_EQ(rows(result), (Rows{{0, 0}, {0.5, 0}, {1, -1}, {1, 0}, {1, 1}, {1.5, 0}, {2, -1}, {2, 0}, {2, 1}}));
}

TEST(Rows, StandOnBothSidesOfAnEvent) {
  const CheckedScenario scenario = between(hertz_pair({}, 1), {wall("a", {0, 0, 1}, path({0.3}), 0.1)});
  EXPECT_EQ(rows(run(scenario)), (Rows{{0, 0}, {0.25, -1}, {0.25, 1}, {1, -1}, {1, 0}, {1, 1}}));
}

TEST(Rows, OfAnOutputPointOnAnEventStandBetweenItsSides) {
  const CheckedScenario scenario = between(hertz_pair({}, 4), {wall("a", {0, 0, 1}, path({0.3}), 0.1)});
  const TestRun result = run(scenario);
  EXPECT_EQ(rows(result),
            (Rows{{0, 0}, {0.25, -1}, {0.25, 0}, {0.25, 1}, {0.5, 0}, {0.75, 0}, {1, -1}, {1, 0}, {1, 1}}));
  const auto regime = result.column("a.regime");
  EXPECT_EQ(regime[1], regime[2]);  // the row of the output point is the state before
  EXPECT_NE(regime[2], regime[3]);
}

TEST(Rows, StandAtAskedInstants) {
  CheckedScenario scenario = hertz_pair(path({0.1, 0.2}));
  scenario.output.times = {0.1, 0.25, 1.0, 1.75};
  EXPECT_EQ(rows(run(scenario)),
            (Rows{{0, 0}, {0.1, 0}, {0.25, 0}, {1, -1}, {1, 0}, {1, 1}, {1.75, 0}, {2, -1}, {2, 1}}));
}

TEST(Rows, CarryTheNumberOfTheirStep) {
  const TestRun result = run(hertz_pair(path({0.1, 0.2}), 2));
  EXPECT_EQ(result.column("step"), (std::vector<double>{1, 1, 1, 1, 2, 2, 2, 2, 2}));
}

TEST(Rows, AreTheIntegratorsOwnStepsWithoutOutputPoints) {
  for (const char* integrator : k_integrators) {
    const TestRun result = run(with_points(die(path({0.3})), 0), integrator);
    const auto time = result.column("time");
    EXPECT_TRUE(std::ranges::is_sorted(time)) << integrator;
    // One row for each step, except the step that ends at the corner and those that end at an event; and the start.
    const auto own = static_cast<long>(result.outputs("time").size());
    EXPECT_EQ(own, result.record.statistics.steps - result.record.statistics.events) << integrator;
    // The direct form divides a step into pieces, which are long.
    EXPECT_GT(own, std::string_view(integrator) == "direct" ? 5 : 20) << integrator;
  }
}

TEST(Rows, LieOnTheSameCurveWhereverTheyAre) {
  for (const char* integrator : k_integrators) {
    // An odd spacing, so that points lie anywhere in the integrator's steps.
    const TestRun coarse = run(with_points(die(path({0.3, 0.25})), 7), integrator);
    const TestRun fine = run(with_points(die(path({0.3, 0.25})), 7 * 13), integrator);
    const auto few = coarse.outputs("axial.force");
    const auto many = fine.outputs("axial.force");
    for (std::size_t k = 0; k < few.size(); ++k)
      EXPECT_NEAR(few[k], many[13 * k], 1e-15) << integrator << ", point " << k;
  }
}

TEST(Rows, DoNotChangeWhereARunEnds) {
  for (const char* integrator : k_integrators) {
    const TestRun two = run(with_points(die(path({0.3, 0.2, 0.35})), 2), integrator);
    for (const int points : {20, 2000}) {
      const TestRun more = run(with_points(die(path({0.3, 0.2, 0.35})), points), integrator);
      for (const char* column : {"apparent_radius", "work", "axial.force", "lateral.force"}) {
        // Output is interpolated: the integrator's steps agree bit for bit.
        EXPECT_EQ(more.last(column), two.last(column)) << integrator << ", " << column << ", " << points << " points";
      }
      EXPECT_EQ(more.record.statistics.steps, two.record.statistics.steps) << integrator;
    }
  }
}

TEST(Rows, DivideIntoEqualIntervalsWhatAStepReallyCovers) {
  constexpr int k_points = 10;
  const std::vector<Step> programs[] = {{ramp(0.3), detach(0.5)},
                                        {ramp(0.3), until(ramp(0.0), force, 0.0)},
                                        {ramp(0.3), until(ramp(0.4), displacement, 0.33)},
                                        {ramp(0.3), until_event(ramp(0.0), "contact-lost")}};
  for (const std::vector<Step>& program : programs) {
    for (const std::string_view integrator : integrator_names()) {
      SCOPED_TRACE(integrator);
      const TestRun result = run_with(with_points(die(program), k_points), integrator);
      ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
      const auto time = result.outputs("time");
      ASSERT_EQ(time.size(), 1U + 2U * k_points);
      const double end = step_ends(result).back();
      EXPECT_EQ(time.back(), end);
      for (int j = 1; j <= k_points; ++j) EXPECT_NEAR(time[k_points + j], 1.0 + (end - 1.0) * j / k_points, 1e-14);
    }
  }
}

TEST(Rows, OfAStepThatCouldHaveEndedEarlyButDidNotStandWhereTheyWould) {
  for (const std::string_view integrator : integrator_names()) {
    const TestRun plain = run_with(with_points(die({ramp(0.3), ramp(0.25)}), 7), integrator);
    const TestRun watched = run_with(with_points(die({ramp(0.3), until(ramp(0.25), force, 1e3)}), 7), integrator);
    EXPECT_EQ(rows(watched), rows(plain)) << integrator;
    EXPECT_LE(difference(watched.outputs("axial.force"), plain.outputs("axial.force")), accuracy(integrator));
  }
}

TEST(Rows, OfAStepThatALimitEndsBeforeItsConditionDivideWhatItCovers) {
  constexpr int k_points = 5;
  for (const char* integrator : k_integrators) {
    auto toy = std::make_unique<ToySystem>();
    toy->watched.push_back(
        {.name = "limit", .value = [](double, ToySystem::View y) { return y[0] - 0.4; }, .ends_domain = true});
    Scene scene = toy_scene(std::move(toy));
    scene.channels[0].program[0].until.push_back({.quantity = force, .value = 2.0, .event = {}});
    const RunRecord record = record_run(scene, integrator, {}, {.points = k_points, .times = {}});
    EXPECT_EQ(record.status, RunStatus::stopped) << integrator;
    const auto time = record.history.column("time");
    const auto side = record.history.column("row");
    std::vector<double> outputs;
    for (std::size_t i = 0; i < time.size(); ++i) {
      if (side[i] == 0.0) outputs.push_back(time[i]);
    }
    ASSERT_EQ(outputs.size(), 1U + k_points) << integrator;
    for (std::size_t j = 0; j <= k_points; ++j) EXPECT_NEAR(outputs[j], 0.4 * static_cast<double>(j) / k_points, 1e-7);
  }
}

TEST(Rows, OfAnEarlyEndLeaveTheRunAsItIsWithoutThem) {
  const CheckedScenario scenario = die({ramp(0.3), until(ramp(0.0), force, 0.01), detach(0.5), ramp(0.4)});
  for (const std::string_view integrator : integrator_names()) {
    const TestRun few = run_with(with_points(scenario, 1), integrator);
    const TestRun many = run_with(with_points(scenario, 50), integrator);
    EXPECT_EQ(many.events(), few.events()) << integrator;
    EXPECT_EQ(many.record.statistics.events, few.record.statistics.events) << integrator;
    EXPECT_EQ(step_ends(many), step_ends(few)) << integrator;
    // This integrator's step control remembers steps from before the segment.
    const double apart = integrator == "odeint-rosenbrock4" ? 1e-14 : 0.0;
    for (const char* column : {"apparent_radius", "work", "axial.force", "lateral.force"})
      EXPECT_NEAR(many.last(column), few.last(column), apart) << integrator << ", " << column;
  }
}

TEST(OutputTimes, BeyondTheEndOfTheProgramAreNoted) {
  CheckedScenario scenario = hertz_pair({ramp(0.2), until(ramp(0.0), force, hertz(0.1))});
  scenario.output.times = {0.5, 1.25, 1.75, 3.0};
  const TestRun result = run(scenario);
  ASSERT_EQ(result.record.warnings.size(), 1U);
  EXPECT_EQ(result.record.warnings[0],
            "2 of 4 output times lie beyond the end of the program, t = 1.5 s: no rows there");
  scenario.output.times = {0.5, result.last("time")};
  EXPECT_TRUE(run(scenario).record.warnings.empty());
}

TEST(Events, CarryTheStateJustAfter) {
  const TestRun result = run(die(path({0.3})));
  const double yield = result.time_of("yield");
  const auto time = result.column("time");
  const auto after = std::ranges::find(time.rbegin(), time.rend(), yield).base() - time.begin() - 1;
  EXPECT_EQ(result.column("row")[static_cast<std::size_t>(after)], 1.0);
  EXPECT_EQ(result.at_event("yield", "axial.force"), result.column("axial.force")[static_cast<std::size_t>(after)]);
  EXPECT_EQ(result.at_event("yield", "step"), 1.0);
}

// --- steps

TEST(Steps, RampFromWhereTheLastOneEnded) {
  const TestRun result = run(hertz_pair({ramp(0.1), ramp_at(0.3, 0.4), ramp_at(0.2, 0.2)}, 1));
  EXPECT_EQ(result.outputs("axial.displacement"), (std::vector<double>{0.0, 0.1, 0.3, 0.2}));
  const auto time = result.outputs("time");
  EXPECT_NEAR(time[2], 1.5, 1e-15);
  EXPECT_NEAR(time[3], 2.0, 1e-15);
}

TEST(Steps, OfAHoldChangeNothing) {
  const TestRun result = run(die({ramp(0.3), hold(2.0), ramp(0.35)}));
  const TestRun without = run(die(path({0.3, 0.35})));
  const auto force = result.outputs("axial.force");
  for (std::size_t k = 50; k <= 100; ++k) EXPECT_EQ(force[k], force[50]) << "row " << k;
  EXPECT_NEAR(result.last("axial.force"), without.last("axial.force"), 1e-15);
  EXPECT_EQ(result.last("time"), 4.0);
}

TEST(Steps, ThatLastNoTimeLeaveTheirCornerOnly) {
  for (const char* integrator : k_integrators) {
    const TestRun result = run(hertz_pair({ramp(0.1), ramp_at(0.1, 1.0), ramp(0.2)}, 1), integrator);
    EXPECT_EQ(result.record.status, RunStatus::complete) << result.record.message;
    EXPECT_EQ(result.last("time"), 2.0) << integrator;
    EXPECT_NEAR(result.last("axial.force"), hertz(0.2), 1e-16) << integrator;
  }
}

TEST(Steps, WithdrawUntilContactIsLost) {
  for (const char* integrator : k_integrators) {
    const TestRun result = run(die({ramp(0.3), detach(0.5)}), integrator);
    EXPECT_EQ(result.record.status, RunStatus::complete) << result.record.message;
    EXPECT_EQ(result.events().back(), "axial:contact-lost") << integrator;
    EXPECT_EQ(result.last("axial.force"), 0.0) << integrator;
    EXPECT_EQ(result.last("time"), result.time_of("contact-lost")) << integrator;
    // The wall retreats at the step's rate.
    EXPECT_NEAR(result.last("axial.displacement"), 0.3 - 0.5 * (result.last("time") - 1.0), 1e-15) << integrator;
  }
}

TEST(Steps, ThatWithdrawAnOpenWallEndAtOnce) {
  const TestRun result = run(hertz_pair({ramp(-0.1), detach(), ramp(0.1)}, 1));
  EXPECT_EQ(result.outputs("time").size(), 3u);
  EXPECT_EQ(result.last("time"), 2.0);
}

TEST(Steps, OfWallsThatNeedDifferentTimesStopTheRun) {
  const CheckedScenario scenario =
      between(hertz_pair({}), {wall("a", {0, 0, 1}, {ramp(0.1, 1.0)}), wall("b", {1, 0, 0}, {ramp(0.1, 2.0)})});
  const TestRun result = run(scenario);
  EXPECT_EQ(result.record.status, RunStatus::stopped);
  EXPECT_NE(result.record.message.find("give equal durations"), std::string::npos) << result.record.message;
}

// --- conditions

struct ConditionRow {
  const char* name;
  Quantity quantity;
  const char* column;
  double value;
};

class EveryQuantity : public ::testing::TestWithParam<ConditionRow> {};

TEST_P(EveryQuantity, EndsAStepWhereItReachesItsValue) {
  const ConditionRow& row = GetParam();
  for (const char* integrator : k_integrators) {
    const TestRun result = run(die({until(ramp(0.4), row.quantity, row.value), hold()}), integrator);
    ASSERT_TRUE(result.has_event("until-met")) << integrator;
    const double tolerance = std::string_view(integrator) == "direct" ? 1e-14 : 1e-7;  // last bits; ten rtol
    EXPECT_NEAR(result.last(row.column) / row.value, 1.0, tolerance) << integrator;
    EXPECT_LT(result.last("axial.displacement"), 0.4) << integrator;
    // The next step begins where this one ended.
    EXPECT_NEAR(result.last("time"), result.time_of("until-met") + 1.0, 1e-15) << integrator;
  }
}

INSTANTIATE_TEST_SUITE_P(Conditions, EveryQuantity,
                         ::testing::Values(ConditionRow{"force", force, "axial.force", 0.1},
                                           ConditionRow{"displacement", displacement, "axial.displacement", 0.2},
                                           ConditionRow{"pressure", pressure, "axial.pressure", 0.08},
                                           ConditionRow{"contact_radius", contact_radius, "axial.contact_radius", 0.5},
                                           ConditionRow{"apparent_radius", apparent_radius, "apparent_radius", 1.05}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Conditions, OfNoForceEndUnloadingWhereContactIsLost) {
  for (const char* integrator : k_integrators) {
    const TestRun result = run(die({ramp(0.3), until(ramp(0.0), force, 0.0), hold()}), integrator);
    EXPECT_EQ(result.events().back(), "until-met") << integrator;
    EXPECT_EQ(result.time_of("until-met"), result.time_of("contact-lost")) << integrator;
    EXPECT_GT(result.last("axial.displacement"), 0.2) << integrator;
  }
}

TEST(Conditions, OfAnEventEndTheStepThere) {
  for (const char* integrator : k_integrators) {
    const TestRun result = run(die({until_event(ramp(0.3), "growth-on")}), integrator);
    EXPECT_EQ(result.last("time"), result.time_of("growth-on")) << integrator;
    EXPECT_EQ(result.events(), (std::vector<std::string>{"growth-on", "lateral:contact-made", "until-met"}))
        << integrator;
  }
}

TEST(Conditions, ExceededWhereTheirStepBeginsAreMetWhenTheyAreCrossed) {
  for (const std::string_view integrator : integrator_names()) {
    const double target = hertz(0.1);
    const TestRun result =
        run_with(hertz_pair({ramp(0.2), until(ramp(0.3), force, target), until(ramp(0.0), force, target)}), integrator);
    EXPECT_NEAR(result.last("axial.displacement"), 0.1, accuracy(integrator)) << integrator;
    EXPECT_NEAR(result.last("time"), 2.0 + 2.0 / 3.0, 4.0 * accuracy(integrator)) << integrator;
    const auto list = notes(result);
    ASSERT_EQ(list.size(), 1U) << integrator;
    EXPECT_EQ(list[0].find("step 2: until axial.force = 0.0463"), 0U) << list[0];
    EXPECT_NE(list[0].find("was never met: it lay behind where the step began"), std::string::npos) << list[0];
  }
}

TEST(Conditions, HoldingWhereTheirStepBeginsEndItThere) {
  const std::vector<Step> programs[] = {
      // The condition is met at the end of the step before: by a crossing, by the loss of the contact, by the end of a
      // ramp.
      {until(ramp(0.3), force, hertz(0.1)), until(ramp(0.0), force, hertz(0.1)), hold()},
      {ramp(0.2), until(ramp(-0.1), force, 0.0), until(ramp(0.1), force, 0.0), hold()},
      {ramp(0.2), until(ramp(0.3), displacement, 0.2), hold()},
      {until(ramp(0.2), displacement, 0.2), until(ramp(0.1), displacement, 0.2), hold()},
      // The condition is not met before, and there is no contact yet.
      {until(ramp(0.2), force, 0.0), hold()}};
  for (const std::vector<Step>& program : programs) {
    const std::size_t held = program.size() - 1;  // the step before the last one
    for (const std::string_view integrator : integrator_names()) {
      const TestRun result = run_with(hertz_pair(program), integrator);
      SCOPED_TRACE(integrator);
      ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
      const auto ends = step_ends(result);
      ASSERT_EQ(ends.size(), program.size());
      EXPECT_EQ(ends[held - 1], held > 1 ? ends[held - 2] : 0.0);
      EXPECT_EQ(result.events().back(), "until-met");
      const auto list = notes(result);
      ASSERT_EQ(list.size(), 1U);
      const std::string& note = list[0];
      EXPECT_EQ(note.find(fmt::format("step {}: until axial.", held)), 0U) << note;
      EXPECT_NE(note.find("holds where the step begins, and ends it there"), std::string::npos) << note;
    }
  }
}

TEST(Conditions, OfNoForceAreMetInMidAirWhereAContactAdheres) {
  CheckedScenario scenario = mdr_scenario(Configuration::simple, 20.0, 0.3, {ramp(0.05), until(ramp(0.0), force, 0.0)});
  scenario.material["surface_energy"] = 1e-4;
  for (const std::string_view integrator : integrator_names()) {
    const TestRun result = run_with(scenario, integrator);
    EXPECT_EQ(result.events().back(), "until-met") << integrator;
    EXPECT_NEAR(result.last("axial.force"), 0.0, accuracy(integrator)) << integrator;
    EXPECT_GT(result.last("axial.contact_radius"), 0.01) << integrator;
  }
}

TEST(Conditions, NeverMetAreNotedOnceForAllSteps) {
  const TestRun result = run(hertz_pair({ramp(0.1), until(ramp(0.2), force, 7.0), ramp(0.1),
                                         until(until_event(ramp(0.2), "yield"), force, 7.0), ramp(0.1),
                                         until(ramp(0.2), force, 7.0), ramp(0.1), until(ramp(0.2), force, 7.0)}));
  ASSERT_EQ(result.record.warnings.size(), 2U);
  EXPECT_EQ(result.record.warnings[0].find("steps 2, 4, 6, ... (4 times): until axial.force = 7 N was never met ("), 0U)
      << result.record.warnings[0];
  EXPECT_EQ(result.record.warnings[1], "step 4: until event = \"yield\" was never met: no such event happened");
}

TEST(Conditions, MetAtTheVeryEndOfARampAreMet) {
  for (const std::string_view integrator : integrator_names()) {
    const TestRun result = run_with(hertz_pair({until(ramp(0.1 + 0.2), displacement, 0.3)}), integrator);
    EXPECT_EQ(result.events().back(), "until-met") << integrator;
    EXPECT_TRUE(notes(result).empty()) << integrator;
  }
}

TEST(Conditions, EndTheStepOfAllWalls) {
  const CheckedScenario scenario = between(
      hertz_pair({}), {wall("a", {0, 0, 1}, {until(ramp(0.4), displacement, 0.1)}), wall("b", {1, 0, 0}, {ramp(0.2)})});
  const TestRun result = run(scenario);
  EXPECT_NEAR(result.last("time"), 0.25, 1e-15);
  EXPECT_NEAR(result.last("b.displacement"), 0.05, 1e-15);
}

TEST(Conditions, AreMetByWhicheverComesFirst) {
  for (const double target : {0.15, 0.25}) {
    Step step = until(until(ramp(0.4), displacement, 0.2), force, hertz(target));
    EXPECT_NEAR(run(hertz_pair({step})).last("axial.displacement"), std::min(target, 0.2), 1e-15) << target;
  }
}

TEST(RunStatus, HasAWord) {
  EXPECT_EQ(to_string(RunStatus::complete), "complete");
  EXPECT_EQ(to_string(RunStatus::stopped), "stopped");
  EXPECT_EQ(to_string(RunStatus::failed), "failed");
}

// --- channels

TEST(Channels, WithoutATimeOfTheirOwnTakeAsLongAsTheOthers) {
  auto toy = std::make_unique<ToySystem>();
  Scene scene = toy_scene(std::move(toy));
  scene.channels[0].program[0].duration = 2.0;
  Step follower;
  follower.kind = Step::Kind::displacement;
  follower.target = 1.0;
  scene.channels.push_back({"follower", {}, {follower}});
  const RunRecord record = record_run(scene, "direct", {}, {.points = 2, .times = {}});
  EXPECT_EQ(record.status, RunStatus::complete) << record.message;
  EXPECT_EQ(record.history.column("time").back(), 2.0);
}

TEST(Rows, DoNotTellOfASilentGuard) {
  for (const bool is_silent : {false, true}) {
    for (const char* integrator : k_integrators) {
      auto toy = std::make_unique<ToySystem>();
      toy->watched.push_back({.name = is_silent ? "" : "seen",
                              .value = [](double, ToySystem::View y) { return y[0] - 0.4; },
                              .transition = [](std::span<double>) {},
                              .is_silent = is_silent});
      Scene scene = toy_scene(std::move(toy));
      const RunRecord record = record_run(scene, integrator, {}, {.points = 2, .times = {}});
      EXPECT_EQ(toy_in(scene).fired_together.size(), 1U) << integrator;
      // Start, middle, and before, at and after the end; two more around the event.
      EXPECT_EQ(record.history.row_count(), is_silent ? 5U : 7U) << integrator;
    }
  }
}

TEST(Events, ThatOnlyMarkAnInstantBringNoConditionWithThem) {
  for (const std::string_view integrator : integrator_names()) {
    auto toy = std::make_unique<ToySystem>();
    toy->watched.push_back({.name = "mark",
                            .value = [](double, ToySystem::View y) { return y[0] - 0.4; },
                            .transition = {},
                            .is_mark = true});
    Scene scene = toy_scene(std::move(toy));
    // Within the tolerance of an integrator, but not met.
    constexpr double k_beyond = 1e-10;
    scene.channels[0].program[0].until.push_back({.quantity = force, .value = 0.4 + k_beyond, .event = {}});
    const TestRun result{{},
                         record_run(scene, integrator, relative(integrator == "forward-euler" ? 1e-5 : 1e-8),
                                    {.points = 1, .times = {}})};
    EXPECT_EQ(result.events(), (std::vector<std::string>{"mark", "until-met"})) << integrator;
    if (integrator == "forward-euler") continue;
    EXPECT_NEAR(result.time_of("until-met") - result.time_of("mark"), k_beyond, 1e-3 * k_beyond) << integrator;
  }
}

// --- failures

TEST(Failures, OfAnExplicitMethodNameThoseForStiffEquations) {
  for (const char* integrator : {"cvode-adams", "odeint-dopri5", "cvode-bdf"}) {
    auto toy = std::make_unique<ToySystem>();
    toy->rates_function = [](double xi, ToySystem::View y, std::span<double> dy) { dy[0] = 1e9 * (xi - y[0]); };
    Scene scene = toy_scene(std::move(toy));
    const RunRecord record = record_run(scene, integrator, {}, {.points = 2, .times = {}});
    if (std::string_view(integrator) == "cvode-bdf") {
      EXPECT_EQ(record.status, RunStatus::complete) << record.message;
      continue;
    }
    EXPECT_EQ(record.status, RunStatus::failed) << integrator;
    EXPECT_NE(record.message.find("expected cvode-bdf or ida"), std::string::npos) << record.message;
  }
}

}  // namespace
}  // namespace monograin::drive_test
