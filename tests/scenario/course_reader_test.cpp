// Steps that follow a table or a sine.

#include "scenario/course_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/json.hpp"
#include "scenario/support.hpp"

namespace monograin::course_reader_test {
namespace {

using Lines = std::vector<std::string>;

constexpr std::string_view k_table = R"({ table = "path.csv", time = "t[s]", value = "x[mm]" })";
constexpr std::string_view k_sine =
    R"({ sine = { mean = 1e-4, amplitude = "0.1 mm", frequency = "2 Hz", cycles = 3 } })";

std::string with_displacement(std::string_view target, std::string_view before = "", std::string_view beside = "") {
  return with_loading("[loading]\nconfiguration = \"simple\"\nsteps = [\n" + std::string(before) +
                      "{ displacement = " + std::string(target) + std::string(beside) + " },\n]\n");
}

CheckedScenario parse(const std::string& text, const std::string& table = "") {
  return parse_recorded_scenario(text, "die.toml", {}, {{"path.csv", table}});
}

std::vector<Step> steps_of(const std::string& text, const std::string& table = "") {
  return parse(text, table).loading.steps;
}

Lines faults(const std::string& text, const std::string& table) {
  Lines lines;
  try {
    static_cast<void>(parse(text, table));
  } catch (const ScenarioError& error) {
    std::istringstream messages(error.what());
    for (std::string line; std::getline(messages, line);) lines.push_back(line);
  }
  return lines;
}

TEST(Table, IsWrittenOutAsRampsFromRowToRow) {
  const std::vector<Step> steps = steps_of(with_displacement(k_table), "t[s],x[mm]\n0,0\n1,1\n3,0.5\n4,0.5\n");
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_EQ(steps[0].kind, Step::Kind::displacement);
  EXPECT_DOUBLE_EQ(steps[0].target, 1e-3);
  EXPECT_DOUBLE_EQ(steps[1].target, 0.5e-3);
  EXPECT_DOUBLE_EQ(steps[2].target, 0.5e-3);
  EXPECT_EQ(steps[0].duration, 1.0);
  EXPECT_EQ(steps[1].duration, 2.0);
  EXPECT_EQ(steps[1].leg, (Leg{0.25, 0.75, true, 1.0, 3.0}));
  EXPECT_TRUE(steps[0].leg.is_first());
  EXPECT_TRUE(steps[2].leg.is_last());
  EXPECT_EQ(count_steps(steps), 1U);
}

TEST(Table, BeginsWithARampWhereItsFirstRowIsLater) {
  const std::vector<Step> steps = steps_of(with_displacement(k_table), "t[s],x[mm]\n2,1\n3,0.5\n");
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0].duration, 2.0);
  EXPECT_FALSE(steps[0].start);
}

TEST(Table, HasItsUnitsInHeadingsOrInARowOrIsInSiUnits) {
  const auto first = [](const std::string& table, std::string_view value) {
    const std::string target = "{ table = \"path.csv\", time = \"t\", value = \"" + std::string(value) + "\" }";
    const Step step = steps_of(with_displacement(target), table).front();
    return std::pair(*step.duration, step.target);
  };
  EXPECT_EQ(first("t [min],x [R0]\n2,0.1\n", "x"), std::pair(120.0, 1e-3));
  EXPECT_EQ(first("t;x\ns;um\n2;0,5\n3;1,5\n", "x"), std::pair(2.0, 0.5e-6));
  EXPECT_EQ(first("t,x\n2,1e-3\n", "x"), std::pair(2.0, 1e-3));
}

TEST(Table, IsDoubtedWhereItHasNoUnitAndGoesFar) {
  const std::string target = with_displacement("{ table = \"path.csv\", time = \"t\", value = \"x\" }");
  EXPECT_EQ(
      parse(target, "t,x\n0,0\n1,-0.4\n2,0.1\n").doubts,
      Lines{"x = -0.4 (path.csv, line 3) has no unit and is taken as -0.4 m, -40 times the radius; if another unit "
            "is meant, write it: x[R0]"});
  EXPECT_EQ(parse(target, "t,x\n0,0\n1,4e-3\n").doubts, Lines());
  EXPECT_EQ(parse(with_displacement(k_table), "t[s],x[mm]\n0,0\n1,400\n").doubts, Lines()) << "it has a unit";
}

TEST(Table, OfForcesIsReadAlike) {
  const std::vector<Step> steps =
      steps_of(with_loading("[loading]\nconfiguration = \"simple\"\nsteps = [{ force = { table = \"path.csv\", time = "
                            "\"t\", value = \"F\" }, until = { displacement = \"0.1 R0\" } }]\n"),
               "t[ms],F[kN]\n0,0\n500,0.2\n900,0.1\n");
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[1].kind, Step::Kind::force);
  EXPECT_DOUBLE_EQ(steps[1].target, 100.0);
  EXPECT_DOUBLE_EQ(*steps[1].duration, 0.4);
  EXPECT_EQ(steps[0].until.size(), 1U);
  EXPECT_EQ(steps[1].until.size(), 1U);
}

TEST(Table, OfForcesEndsARampWhereItComesBackToZero) {
  const std::vector<Step> steps =
      steps_of(with_loading("[loading]\nconfiguration = \"simple\"\nsteps = [{ force = { table = \"path.csv\", time = "
                            "\"t\", value = \"F\" } }]\n"),
               "t[s],F[N]\n0,0\n1,10\n2,-4\n3,12\n");
  ASSERT_EQ(steps.size(), 4U);
  EXPECT_EQ(steps[2].target, 0.0);
  EXPECT_EQ(steps[2].leg.end_time, 2.25);
  EXPECT_FALSE(steps[3].leg.is_corner);
  EXPECT_EQ(steps[3].leg, (Leg{0.75, 1.0, false, 2.25, 3.0}));
}

TEST(Table, OfForcesBelowZeroAtItsBeginningHasOneRampToItsSecondRow) {
  const std::vector<Step> steps = steps_of(
      with_loading("[loading]\nconfiguration = \"simple\"\nsteps = [{ displacement = 1e-4, duration = 1 }, { force = { "
                   "table = \"path.csv\", time = \"t\", value = \"F\" } }]\n"),
      "t[s],F[N]\n0,-10\n1,100\n2,50\n");
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_EQ(steps[1].target, 100.0);
  EXPECT_EQ(steps[1].duration, 1.0);
  EXPECT_EQ(steps[1].start, -10.0);
}

TEST(Table, HasColumnsWithNumbersToo) {
  const std::string numbers = R"({ table = "path.csv", time = 1, value = 2 })";
  const std::vector<Step> steps = steps_of(with_displacement(numbers), "0,0\n2,1e-3\n");
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_EQ(steps[0].target, 1e-3);
  EXPECT_EQ(steps[0].duration, 2.0);
  EXPECT_EQ(steps_of(with_displacement(numbers), "t[s],x[mm]\n0,0\n2,1\n")[0].target, 1e-3);
  EXPECT_EQ(faults(with_displacement(R"({ table = "path.csv", time = 1, value = 3 })"), "0,0\n2,1e-3\n"),
            Lines{"die.toml:12:58: value = 3: path.csv has 2 columns"});
  EXPECT_EQ(faults(with_displacement(R"({ table = "path.csv", time = 0, value = 2 })"), "0,0\n2,1e-3\n"),
            Lines{"die.toml:12:47: time = 0: expected the heading of a column in quotes, for example \"t[s]\", or its "
                  "number from 1"});
}

TEST(Table, IsRecordedWithTheScenario) {
  const std::string table = "t[s],x[mm]\n0,0\n1,1\n";
  EXPECT_EQ(parse(with_displacement(k_table), table).loading.files, (FileTexts{{"path.csv", table}}));
}

TEST(Table, SaysInWhichRowAndColumnAFaultIs) {
  EXPECT_EQ(faults(with_displacement(k_table), "t[s],x[mm]\n0,0\n1,one\n"),
            Lines{"path.csv:3:3: x[mm] = one: expected a finite number"});
  EXPECT_EQ(faults(with_displacement(k_table), "t[s],x[mm]\n0,0\n2,1\n2,0\n1,1\n"),
            (Lines{"path.csv:4:1: 2 s: not later than the row before; expected ascending times",
                   "path.csv:5:1: 1 s: not later than the row before; expected ascending times"}));
  EXPECT_EQ(faults(with_displacement(k_table), "t[s],x[mm]\n-1,0\n1,1e12\n"),
            (Lines{"path.csv:2:1: t[s]: -1 s is out of range; expected a time from 0 s to 1e+18 s",
                   "path.csv:3:3: x[mm]: 1e+09 m is out of range; expected a length from -1e+06 m to 1e+06 m"}));
  EXPECT_EQ(faults(with_displacement(k_table), "t[s],x[mm]\n0,0\n"),
            Lines{"path.csv:2:1: the table ends where it begins; expected a later row"});
}

TEST(Table, HasNoTextsBelowIt) {
  EXPECT_EQ(faults(with_displacement(k_table), "t[s],x[mm]\n0,0\n1,1\nEND\n"),
            Lines{"path.csv:4:1: 1 cell where there are 2 headings; expected a cell for each, and nothing below the "
                  "table"});
}

TEST(Table, SaysWhichColumnsItHas) {
  EXPECT_EQ(faults(with_displacement(k_table), "t[s],x [N]\n0,0\n1,1\n"),
            Lines{"die.toml:12:63: value = \"x[mm]\": path.csv has no such column; expected one of t[s], x [N]"});
  EXPECT_EQ(faults(with_displacement("{ table = \"path.csv\", time = \"t\", value = \"x\" }"), "t[s],x[N]\n0,0\n1,1\n"),
            Lines{"path.csv:1:6: column 'x[N]': 'N' is a unit of force; expected a length, for example \"10 mm\""});
}

TEST(Table, SaysWhereAMissingFileIsNamed) {
  const Lines lines = faults_of(with_displacement(R"({ table = "none.csv", time = "t", value = "x" })"));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines[0].starts_with("die.toml:12:28: table = \"none.csv\": there is no such file (none.csv); expected"))
      << lines[0];
}

TEST(Table, NeedsItsKeysAndTakesNoTimeOfAStep) {
  EXPECT_EQ(faults(with_displacement(R"({ table = "path.csv", tiem = "t" })"), ""),
            (Lines{"die.toml:12:18: key 'value' is missing in displacement; expected for example value = \"x[mm]\"",
                   "die.toml:12:40: unknown key 'tiem' in displacement; did you mean 'time'?"}));
  EXPECT_EQ(faults(with_displacement(k_table, "", ", duration = 1"), "t[s],x[mm]\n0,0\n1,1\n"),
            Lines{"die.toml:12:74: key 'duration' does not go with a table or a sine, which has times of its own"});
}

TEST(Table, BeginsWhereTheWallIs) {
  const std::string table = "t[s],x[mm]\n0,0.5\n1,1\n";
  EXPECT_EQ(
      faults(with_displacement(k_table), table),
      Lines{"die.toml:12:1: the table or sine begins at 0.0005 m, where the wall is at 0 m; expected a step before "
            "it that leads there, or a first row of the table at a later time"});
  const std::string ramp = "{ displacement = \"0.5 mm\", duration = 1 },\n";
  EXPECT_EQ(faults(with_displacement(k_table, ramp), table), Lines{});
  // What a condition leaves is known in a run only.
  const std::string stopped = "{ displacement = \"0.7 mm\", duration = 1, until = { force = 1 } },\n";
  EXPECT_EQ(faults(with_displacement(k_table, stopped), table), Lines{});
}

TEST(Sine, HasItsExtremaAndMeansExactly) {
  const std::vector<Step> steps = steps_of(with_displacement(k_sine, "{ displacement = 1e-4, duration = 1 },\n"));
  ASSERT_EQ(steps.size(), 1U + 3U * 64U);
  EXPECT_EQ(count_steps(steps), 2U);
  const double amplitude = 0.1 * 1e-3;
  for (std::size_t cycle = 0; cycle < 3; ++cycle) {
    const std::size_t first = 64 * cycle;
    EXPECT_EQ(steps[first + 16].target, 1e-4 + amplitude);
    EXPECT_EQ(steps[first + 32].target, 1e-4);
    EXPECT_EQ(steps[first + 48].target, 1e-4 - amplitude);
    EXPECT_EQ(steps[first + 64].target, 1e-4);
  }
  EXPECT_DOUBLE_EQ(steps.back().leg.end, 1.0);
}

TEST(Sine, IsWithinAnEighthOfAPercentBetweenItsRamps) {
  const std::vector<Step> steps = steps_of(with_displacement(k_sine, "{ displacement = 1e-4, duration = 1 },\n"));
  double time = 0.0;
  double before = 1e-4;
  double largest = 0.0;
  for (std::size_t k = 1; k < steps.size(); ++k) {
    const double middle = time + 0.5 * *steps[k].duration;
    const double exact = 1e-4 + 1e-4 * std::sin(2.0 * std::numbers::pi * 2.0 * middle);
    largest = std::max(largest, std::abs(0.5 * (before + steps[k].target) - exact) / 1e-4);
    time += *steps[k].duration;
    before = steps[k].target;
  }
  EXPECT_NEAR(time, 1.5, 1e-12);
  EXPECT_LT(largest, 0.00125);
  EXPECT_GT(largest, 0.001);
}

TEST(Sine, HasCornersWhereItTurns) {
  const std::vector<Step> steps = steps_of(with_displacement(k_sine, "{ displacement = 1e-4, duration = 1 },\n"));
  const auto is_corner = [](const Step& step) { return step.leg.is_corner; };
  EXPECT_EQ(std::ranges::count_if(steps, is_corner), 2 + 2 * 3);
  EXPECT_TRUE(steps[1 + 16].leg.is_corner);
  EXPECT_FALSE(steps[1 + 32].leg.is_corner);
}

TEST(Sine, HasTimesWithoutSums) {
  const std::vector<Step> steps =
      steps_of(with_displacement("{ sine = { mean = 0, amplitude = 1e-4, frequency = 10, cycles = 11 } }"));
  EXPECT_EQ(steps.back().leg.end_time, 1.1);
  EXPECT_EQ(steps[64 * 7 - 1].leg.end_time, 0.7);
}

TEST(Sine, BeginsAtItsMean) {
  const Lines lines = faults(with_displacement(k_sine), "");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines[0].starts_with("die.toml:12:1: the table or sine begins at 0.0001 m, where the wall is at 0 m"));
}

TEST(Sine, SaysWhatIsWrongWithItsKeys) {
  EXPECT_EQ(
      faults(with_displacement("{ sine = { mean = 0, amplitude = 0, frequency = \"2 s\", cycles = 0.5 } }"), ""),
      (Lines{"die.toml:12:51: amplitude = 0: out of range; expected a length from 1e-12 m to 1e+06 m",
             "die.toml:12:66: frequency = \"2 s\": 's' is a unit of time; expected a frequency, for example \"2 Hz\"",
             "die.toml:12:82: cycles = 0.5: expected a whole number from 1 to 100000"}));
  EXPECT_EQ(faults(with_displacement("{ sine = { mean = 0, amplitude = 1, frequency = 1, cycles = 2000 } }"), ""),
            Lines{"die.toml:12:78: cycles = 2000: expected at most 1562, 64 ramps each"});
  EXPECT_EQ(
      faults(with_displacement("{ sine = { mean = 0, amplitude = 1, frequency = 1, cycles = 1 }, time = 1 }"), ""),
      Lines{"die.toml:12:83: key 'time' does not go with 'sine'"});
}

TEST(Sine, StandsInATarget) {
  const Lines lines =
      faults(with_loading("[loading]\nconfiguration = \"simple\"\nsteps = [{ sine = { mean = 0 } }]\n"), "");
  EXPECT_EQ(lines, Lines{"die.toml:11:12: key 'sine' stands in a target: displacement = { sine = { ... } }"});
}

TEST(Sine, HasNumbersThatMayBeOverridden) {
  const std::string ramp = "{ displacement = 1e-4, duration = 1 },\n";
  const CheckedScenario scenario = parse_scenario(with_displacement(k_sine, ramp), "die.toml",
                                                  {"loading.steps[1].displacement.sine.amplitude=\"0.2 mm\""});
  EXPECT_EQ(scenario.loading.steps[1 + 15].target, 1e-4 + 2e-4);
  const ScenarioTemplate numbers({.text = with_displacement(k_sine, ramp), .origin = "die.toml"});
  EXPECT_EQ(numbers.problem_of_number("loading.steps[1].displacement.sine.amplitude"), "");
  EXPECT_NE(numbers.problem_of_number("loading.steps[1].displacement.sine.amplitud"), "");
}

TEST(Course, IsAcceptedByTheSchemaAsByTheReader) {
  const auto accepts = [](const std::string& text) { return schema_accepts(*toml_as_json(text)); };
  EXPECT_TRUE(accepts(with_displacement(k_table)));
  EXPECT_TRUE(accepts(with_displacement(k_sine)));
  EXPECT_TRUE(accepts(with_displacement(R"({ table = "path.csv", time = 1, value = 2 })")));
  EXPECT_FALSE(accepts(with_displacement(R"({ table = "path.csv", time = 0, value = 2 })")));
  EXPECT_FALSE(accepts(with_displacement(k_table, "", ", duration = 1")));
  EXPECT_FALSE(accepts(with_displacement("{ table = \"path.csv\" }")));
  EXPECT_FALSE(accepts(with_displacement("0.1")));
}

}  // namespace
}  // namespace monograin::course_reader_test
