// Steps of several walls that have times of their own within a step.

#include "scenario/shared_times.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenario/scenario.hpp"
#include "scenario/support.hpp"

namespace monograin::shared_times_test {
namespace {

constexpr std::string_view k_first = R"({ displacement = { table = "a.csv", time = "t", value = "x" } })";
constexpr std::string_view k_second = R"({ displacement = { table = "b.csv", time = "t", value = "x" } })";

/// Programs of two walls, a table of four rows beside another program of 3 s.
std::array<std::vector<Step>, 2> programs(std::string_view first, std::string_view second) {
  const auto wall = [](std::string_view name, int z, std::string_view steps) {
    return "[[loading.wall]]\nname = \"" + std::string(name) + "\"\nnormal = [0, 0, " + std::to_string(z) +
           "]\nsteps = [" + std::string(steps) + "]\n";
  };
  const CheckedScenario scenario = parse_recorded_scenario(
      with_loading("[loading]\nconfiguration = \"walls\"\n" + wall("a", 1, first) + wall("b", -1, second)), "die.toml",
      {}, {{"a.csv", "t,x\n0,0\n1,1e-3\n2,0.9e-3\n3,1.5e-3\n"}, {"b.csv", "t,x\n0.5,2e-4\n2,5e-4\n3,2e-4\n"}});
  return {scenario.loading.walls[0].steps, scenario.loading.walls[1].steps};
}

/// Values at the ends of the ramps of a program that begins at zero.
std::vector<double> ends(const std::vector<Step>& program) {
  std::vector<double> values;
  double present = 0.0;
  for (const Step& step : program) {
    if (step.kind != Step::Kind::hold) present = std::lerp(present, step.target, step.share);
    values.push_back(present);
  }
  return values;
}

void expect_near(const std::vector<double>& actual, const std::vector<double>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t k = 0; k < actual.size(); ++k) EXPECT_NEAR(actual[k], expected[k], 1e-18) << k;
}

TEST(SharedTimes, OfTwoTablesAreThoseOfBoth) {
  const auto [a, b] = programs(k_first, k_second);
  expect_near(ends(a), {0.5e-3, 1e-3, 0.9e-3, 1.5e-3});
  expect_near(ends(b), {2e-4, 3e-4, 5e-4, 2e-4});
  const std::vector<double> times{0.5, 1.0, 2.0, 3.0};
  for (std::size_t k = 0; k < times.size(); ++k) {
    for (const Step& step : {a[k], b[k]}) {
      EXPECT_EQ(step.leg.end_time, times[k]);
      EXPECT_EQ(step.duration, times[k] - (k > 0 ? times[k - 1] : 0.0));
    }
  }
  EXPECT_EQ(count_steps(b), 1U);
}

TEST(SharedTimes, OfATableAndARampLeaveTheRampStraight) {
  const auto [a, b] = programs(k_first, R"({ displacement = "3e-4 m", duration = "3 s" })");
  expect_near(ends(b), {1e-4, 2e-4, 3e-4});
  expect_near(ends(a), {1e-3, 0.9e-3, 1.5e-3});
}

TEST(SharedTimes, OfATableAndARampWithARateKeepTheRate) {
  const auto [a, b] = programs(k_first, R"({ displacement = "3e-4 m", rate = "1e-4 m/s" })");
  expect_near(ends(b), {1e-4, 2e-4, 3e-4});
  EXPECT_EQ(b[1].rate, 1e-4);
  EXPECT_FALSE(b[1].duration);
}

TEST(SharedTimes, OfATableAndAHoldLeaveTheHold) {
  const auto [a, b] = programs(k_first, R"({ hold = true, duration = "3 s" })");
  ASSERT_EQ(b.size(), 3U);
  for (const Step& step : b) EXPECT_EQ(step.kind, Step::Kind::hold);
  EXPECT_TRUE(a[1].leg.is_corner);
  EXPECT_FALSE(b[1].leg.is_corner);
}

TEST(SharedTimes, OfATableAndASineAreThoseOfBoth) {
  const auto [a, b] =
      programs(k_first, "{ displacement = { sine = { mean = 0, amplitude = 1e-4, frequency = 1, cycles = 3 } } }");
  ASSERT_EQ(a.size(), 3U * 64U);
  EXPECT_NEAR(ends(a)[63], 1e-3, 1e-17);
  EXPECT_NEAR(ends(a)[95], 0.95e-3, 1e-17);
}

TEST(SharedTimes, LeaveStepsWithoutTablesAsTheyAre) {
  const auto [a, b] = programs(R"({ displacement = 1e-4, duration = 1 })", R"({ hold = true, duration = 1 })");
  ASSERT_EQ(b.size(), 1U);
  EXPECT_EQ(a[0].leg, Leg{});
  EXPECT_EQ(b[0].share, 1.0);
}

TEST(SharedTimes, AreAtMostAsManyAsRampsOfPrograms) {
  std::vector<Step> table(3);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto begin = static_cast<double>(k);
    table[k].duration = 1.0;
    table[k].leg = {begin / 3.0, (begin + 1.0) / 3.0, true, begin, begin + 1.0};
  }
  std::vector<Step> late = table;
  // Round-off does not make another time.
  late[0].leg.end_time *= 1.0 + 1e-12;
  std::vector<Step> hold(1);
  hold[0].duration = 3.0;
  std::vector<std::vector<Step>*> programs{&table, &late, &hold};
  share_times(programs);
  EXPECT_EQ(table.size(), 3U);
  EXPECT_EQ(late.size(), 3U);
  EXPECT_EQ(hold.size(), 3U);
  EXPECT_EQ(late[0].leg, table[0].leg);
}

/// A step through values at given times.
std::vector<Step> through(const std::vector<std::pair<double, double>>& rows) {
  std::vector<Step> steps;
  double begin = 0.0;
  const double total = rows.back().first;
  for (const auto& [time, value] : rows) {
    Step& step = steps.emplace_back();
    step.kind = Step::Kind::displacement;
    step.target = value;
    step.duration = time - begin;
    step.leg = {begin / total, time / total, true, begin, time};
    begin = time;
  }
  return steps;
}

TEST(SharedTimes, OfOneProgramAreNeverOne) {
  const double late = 2.000000001;
  std::vector<Step> table = through({{2.0, 0.01}, {late, 0.02}, {4.0, 0.03}});
  std::vector<Step> other = through({{0.5, 0.1}, {2.0 + 0.5e-9, 0.2}, {4.0, 0.4}});
  std::vector<Step> hold(1);
  hold[0].duration = 4.0;
  std::vector<std::vector<Step>*> programs{&table, &hold};
  EXPECT_EQ(share_times(programs), 6U);
  EXPECT_EQ(ends(table), (std::vector<double>{0.01, 0.02, 0.03}));
  for (const Step& step : table) EXPECT_EQ(step.share, 1.0);
  EXPECT_EQ(table[1].leg.end_time, late);

  std::vector<std::vector<Step>*> of_three{&other, &table, &hold};
  EXPECT_EQ(share_times(of_three), 12U);
  expect_near(ends(table), {0.0025, 0.01, 0.02, 0.03});
  EXPECT_EQ(ends(other)[1], 0.2);
  EXPECT_EQ(ends(other)[3], 0.4);
  for (const std::vector<Step>* program : of_three) {
    for (const Step& step : *program) EXPECT_TRUE(step.share > 0.0 && step.share <= 1.0) << step.share;
    EXPECT_TRUE(program->back().leg.is_last());
  }
}

TEST(SharedTimes, AreCountedBeforeProgramsAreDivided) {
  std::vector<Step> table = through({{1.0, 0.01}, {2.0, 0.02}, {4.0, 0.03}});
  std::vector<Step> hold(1);
  hold[0].duration = 4.0;
  std::vector<std::vector<Step>*> programs{&table, &hold};
  EXPECT_EQ(share_times(programs, 5), 6U);
  EXPECT_EQ(hold.size(), 1U);
  EXPECT_EQ(share_times(programs, 6), 6U);
  EXPECT_EQ(hold.size(), 3U);
}

}  // namespace
}  // namespace monograin::shared_times_test
