// Conditions on a wall that `until` names.

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "scenario/json.hpp"
#include "scenario/scenario.hpp"
#include "scenario/support.hpp"

namespace monograin::named_walls_test {
namespace {

using Lines = std::vector<std::string>;

std::string with_until(std::string_view configuration, std::string_view until) {
  return with_loading("[loading]\nconfiguration = \"" + std::string(configuration) +
                      "\"\nsteps = [\n{ displacement = 1e-3, duration = 1, until = " + std::string(until) + " }]\n");
}

TEST(NamedWalls, GoWithEveryQuantityBesideThem) {
  const CheckedScenario scenario = parse_scenario(
      with_until("die", R"({ wall = "lateral", force = "10 N", pressure = 1, event = "yield" })"), "die.toml");
  const std::vector<Until>& conditions = scenario.loading.steps.front().until;
  ASSERT_EQ(conditions.size(), 3U);
  for (const Until& until : conditions) EXPECT_EQ(until.wall, until.is_event() ? "" : "lateral");
}

TEST(NamedWalls, AreClassesOfTheConfiguration) {
  EXPECT_EQ(
      faults_of(with_until("die", R"({ wall = "latral", force = 1 })")),
      Lines{"die.toml:12:55: wall = \"latral\": there is no such wall; expected one of axial, lateral; did you mean "
            "'lateral'?"});
  EXPECT_EQ(faults_of(with_until("oblique-die", R"({ wall = "lateral-y", force = 1 })")), Lines{});
  EXPECT_EQ(
      faults_of(with_until("oblique-die", R"({ wall = "lateral", force = 1 })")),
      Lines{"die.toml:12:55: wall = \"lateral\": there is no such wall; expected one of axial, lateral-x, lateral-y, "
            "oblique; did you mean 'lateral-x'?"});
  EXPECT_EQ(faults_of(with_until("simple", R"({ wall = "lateral", force = 1 })")),
            Lines{"die.toml:12:55: wall = \"lateral\": there is no such wall; expected one of axial"});
}

TEST(NamedWalls, MayBeAnyWallOfAFreeSet) {
  const std::string walls =
      "[[loading.wall]]\nname = \"top\"\nnormal = [0, 0, 1]\n[[loading.wall]]\nname = \"bottom\"\nnormal = [0, 0, -1]\n"
      "fixed = true\n";
  EXPECT_EQ(faults_of(with_until("walls", R"({ wall = "bottom", force = 1 })") + walls), Lines{});
  EXPECT_EQ(faults_of(with_until("walls", R"({ wall = "axial", force = 1 })") + walls),
            Lines{"die.toml:12:55: wall = \"axial\": there is no such wall; expected one of top, bottom"});
}

TEST(NamedWalls, NeedAQuantityBesideThem) {
  const std::string alone = with_until("die", R"({ wall = "lateral", event = "yield" })");
  EXPECT_EQ(faults_of(alone),
            Lines{"die.toml:12:48: key 'wall' says at which wall a quantity counts; expected one beside "
                  "it, for example force = \"10 N\""});
  EXPECT_FALSE(schema_accepts(*toml_as_json(alone)));
  EXPECT_TRUE(schema_accepts(*toml_as_json(with_until("die", R"({ wall = "lateral", force = 1 })"))));
}

TEST(NamedWalls, DoNotGoWithModelsWithoutWalls) {
  EXPECT_EQ(
      faults_of("model = \"packing\"\n[[loading.steps]]\nstrain = 0.1\nduration = 1\nuntil = { wall = \"axial\" }\n"),
      Lines{"die.toml:5:11: key 'wall' is not used by model 'packing'; expected event"});
}

}  // namespace
}  // namespace monograin::named_walls_test
