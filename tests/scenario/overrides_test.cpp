#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "scenario/support.hpp"

namespace monograin::overrides_test {
namespace {

CheckedScenario with(const std::vector<std::string>& overrides) {
  return parse_scenario(k_good_scenario, "die.toml", overrides);
}

TEST(Overrides, TakeTomlValues) {
  EXPECT_EQ(with({"particle.radius=0.5"}).radius, 0.5);
  EXPECT_EQ(with({"particle.radius=\"5 mm\""}).radius, 0.005);
  EXPECT_EQ(with({"output.times=[0.5, 1]"}).output.times, (std::vector<double>{0.5, 1.0}));
}

TEST(Overrides, TakeBareTextsAsStrings) {
  EXPECT_EQ(with({"particle.radius=5 mm"}).radius, 0.005);
  EXPECT_EQ(with({"loading.configuration=die"}).loading.configuration, Loading::Configuration::die);
  EXPECT_EQ(with({"title=say \"it\" \\ loud"}).title, "say \"it\" \\ loud");
  EXPECT_EQ(with({"title="}).title, "");
}

TEST(Overrides, MayHaveSpacesAroundTheKey) { EXPECT_EQ(with({" particle.radius = 0.5"}).radius, 0.5); }

TEST(Overrides, SetAllEntriesOfARange) {
  const auto gaps = [](const std::vector<std::string>& overrides) {
    const CheckedScenario scenario = parse_scenario(k_late_wall_text, "s.toml", overrides);
    return std::vector{scenario.loading.walls[0].gap, scenario.loading.walls[1].gap};
  };
  EXPECT_EQ(gaps({"loading.wall[0-1].gap=3 um"}), gaps({"loading.wall[0].gap=3 um", "loading.wall[1].gap=3 um"}));
}

TEST(Overrides, MakeTablesOnTheWay) {
  EXPECT_TRUE(std::get<bool>(with({"mdr.strict=true"}).options.at("strict")));
  EXPECT_EQ(with({"loading.steps[0].until.event=yield"}).loading.steps[0].until[0].event, "yield");
}

TEST(Overrides, PickFromArraysByIndex) {
  EXPECT_EQ(with({"loading.steps[0].displacement=0.003"}).loading.steps[0].target, 0.003);
  EXPECT_EQ(with({"loading.steps[0]={ hold = true, duration = 3 }"}).loading.steps[0].duration, 3.0);
}

TEST(Overrides, ApplyInTheirOrder) { EXPECT_EQ(with({"particle.radius=1", "particle.radius=2"}).radius, 2.0); }

TEST(Overrides, CanMendAFile) {
  EXPECT_NO_THROW(parse_scenario(with_line(4, "radius = -1"), "die.toml", {"particle.radius=1"}));
}

struct OverrideRow {
  const char* name;
  const char* text;
  std::string message;
};

class OverrideFaults : public ::testing::TestWithParam<OverrideRow> {};

TEST_P(OverrideFaults, NameTheOverride) {
  const OverrideRow& row = GetParam();
  const std::vector<std::string> faults = faults_of(k_good_scenario, {row.text});
  ASSERT_EQ(faults.size(), 1U) << row.text;
  EXPECT_EQ(faults[0], std::string("override '") + row.text + "':" + row.message);
}

INSTANTIATE_TEST_SUITE_P(
    CheckedScenario, OverrideFaults,
    ::testing::Values(
        OverrideRow{"NoValue", "foo", "1:1: expected key=value"},
        OverrideRow{"NoKey", "=3", "1:1: '' is not the path of a key; expected for example loading.steps[0].rate"},
        OverrideRow{"EmptyPart", "a..b=3",
                    "1:1: 'a..b' is not the path of a key; expected for example loading.steps[0].rate"},
        OverrideRow{"OpenIndex", "a[1=3",
                    "1:1: 'a[1' is not the path of a key; expected for example loading.steps[0].rate"},
        OverrideRow{"NegativeIndex", "a[-1]=3",
                    "1:1: 'a[-1]' is not the path of a key; expected for example loading.steps[0].rate"},
        OverrideRow{"IndexOutOfRange", "loading.steps[2].duration=3",
                    "1:1: index [2] is out of range; the array has 1 entries, counted from 0"},
        OverrideRow{"IndexIntoTable", "loading[0]=1", "1:1: index [0] cannot be used on a table; expected an array"},
        OverrideRow{
            "IndexPastTheEnd", "loading.steps[1].duration=3",
            "1:3: the step has nothing to do; expected exactly one of displacement, force, hold, detach, cycle"},
        OverrideRow{"IndexIntoNothing", "mdr[0]=1", "1:3: mdr = an array: expected a table, written [mdr]"},
        OverrideRow{"ThroughAValue", "particle.radius.x=3", "1:1: 'x' cannot be set inside \"10 mm\""},
        OverrideRow{"UnknownUnit", "particle.radius=5 mn",
                    "1:17: radius = \"5 mn\": unknown unit 'mn'; expected a length, for example \"10 mm\""},
        OverrideRow{"NotANumber", "numerics.rtol=nan",
                    "1:15: rtol = nan: out of range; expected a number from 1e-14 to 0.1"},
        OverrideRow{"MisspeltKey", "particle.raduis=3",
                    "1:1: unknown key 'raduis' in [particle]; did you mean 'radius'?"},
        OverrideRow{"BrokenArray", "output.times=[1,", "1:17: not valid TOML: the array is not closed; expected ']'"},
        OverrideRow{"BrokenString", "title=\"x",
                    "1:9: not valid TOML: the text is not closed; expected a quote at its end"},
        OverrideRow{"NumberForATable", "material=1", "1:10: material = 1: expected a table, written [material]"},
        OverrideRow{"ValueOfTheWrongKind", "loading.steps=3",
                    "1:15: steps = 3: expected an array of tables, written [[loading.steps]]"}),
    [](const auto& row) { return std::string(row.param.name); });

TEST(Overrides, AreReportedAfterTheFile) {
  const std::vector<std::string> faults = faults_of(with_line(13, "duration = 0"), {"particle.radius=0"});
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_TRUE(faults[0].starts_with("die.toml:13:12")) << faults[0];
  EXPECT_TRUE(faults[1].starts_with("override 'particle.radius=0':1:17")) << faults[1];
}

TEST(Overrides, StayOnOneLineInMessages) {
  const std::vector<std::string> faults = faults_of(k_good_scenario, {"title=3\nx=4", "particle.radius=1\n2"});
  EXPECT_FALSE(faults.empty());
  for (const std::string& fault : faults) {
    EXPECT_TRUE(fault.starts_with("override 'particle.radius=1?2':1:17: ")) << fault;
  }
}

}  // namespace
}  // namespace monograin::overrides_test
