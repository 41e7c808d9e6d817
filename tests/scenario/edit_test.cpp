// Numbers of a scenario that are set in place, in its data and in its text.

#include "scenario/edit.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "scenario/numbers.hpp"
#include "scenario/scenario.hpp"
#include "support/refusal.hpp"
#include "support/scenario_texts.hpp"

namespace monograin::edit_test {
namespace {

constexpr const char* k_scenario = R"(# Größe: two bytes, one column
model = "mdr"
[particle]
radius = "1 mm"
[material]  # of the grain
youngs_modulus = "1 GPa"   # stiff
poisson_ratio = 0.3
yield_stress = '50 MPa'
[loading]
configuration = "oblique-die"
steps = [{ displacement = "0.1 R0", duration = "1 s" }]
)";

TEST(Edit, PutsAValueInThePlaceOfTheOldOneAndNothingElse) {
  std::string expected = k_scenario;
  expected.replace(expected.find("\"1 GPa\""), 7, "1.5e9");
  expected.replace(expected.find("'50 MPa'"), 8, "4e7");
  const std::string text =
      with_values(k_scenario, {{"material.yield_stress", "4e7"}, {"material.youngs_modulus", "1.5e9"}});
  EXPECT_EQ(text, expected);
}

TEST(Edit, PutsAnAbsentKeyBelowTheHeaderOfItsTable) {
  const std::string text = with_values(k_scenario, {{"material.surface_energy", "0.25"}, {"loading.angle", "0.5"}});
  const CheckedScenario scenario = parse_scenario(text, "edited.toml");
  EXPECT_EQ(scenario.material.at("surface_energy"), 0.25);
  EXPECT_EQ(scenario.loading.oblique_angle, 0.5);
  EXPECT_NE(text.find("# of the grain\nsurface_energy = 0.25\n"), std::string::npos) << text;
}

TEST(Edit, CountsCharactersAsTheParserDoes) {
  const std::string text = with_values("title = \"µµµ\"\na = { b = \"µ\", c = \"µ\", d = 1 }  # µ\n", {{"a.c", "2"}});
  EXPECT_EQ(text, "title = \"µµµ\"\na = { b = \"µ\", c = 2, d = 1 }  # µ\n");
}

TEST(Edit, RefusesATableWithoutAHeader) {
  EXPECT_THROW(static_cast<void>(with_values("material = { nu = 1 }\n", {{"material.E", "2"}})), std::runtime_error);
  EXPECT_THROW(static_cast<void>(with_values("x = 1\n", {{"material.E", "2"}})), std::runtime_error);
  EXPECT_EQ(with_values("material = { nu = 1 }\n", {{"material.nu", "2"}}), "material = { nu = 2 }\n");
}

TEST(Edit, WritesAnOverrideAsTheFileWouldHaveIt) {
  for (const auto& [key_and_value, expected] :
       {std::pair{"material.yield_stress = 40 MPa", "yield_stress = \"40 MPa\""},
        std::pair{"material.yield_stress=4e7", "yield_stress = 4e7"},
        std::pair{"loading.configuration='die'", "configuration = 'die'"}}) {
    EXPECT_TRUE(contains(with_override(k_scenario, key_and_value), expected)) << key_and_value;
  }
  EXPECT_EQ(with_override("title = 'x'\n", "title=new"), "title = \"new\"\n");
}

TEST(Edit, RefusesAnOverrideThatHasNoPlace) {
  for (const char* key_and_value : {"title=new", "loading.steps[0]={}", "loading", "loading.angle='"}) {
    EXPECT_THROW(static_cast<void>(with_override(k_scenario, key_and_value)), std::runtime_error) << key_and_value;
  }
}

TEST(Edit, ATableOfALargerDocumentIsAScenarioOfItsOwn) {
  const std::string document = R"([scenario]
model = "hertz"
particle.radius = "1 mm"
material = { youngs_modulus = 12345678901.234567, poisson_ratio = 0.3 }
[scenario.loading]
configuration = "simple"
steps = [{ displacement = "0.1 R0", duration = "1 s" }]
)";
  const CheckedScenario scenario = parse_scenario(text_of_table(document, "scenario", "d.toml"), "d.toml");
  EXPECT_EQ(scenario.material.at("youngs_modulus"), 12345678901.234567);
}

TEST(Numbers, AreThoseThatStandOnTheirOwn) {
  const CheckedScenario scenario = parse_scenario(k_scenario, "s.toml");
  std::vector<std::string> paths;
  for (const NumberKey& number : number_keys(scenario)) paths.push_back(number.path);
  EXPECT_EQ(paths,
            (std::vector<std::string>{"material.youngs_modulus", "material.poisson_ratio", "material.yield_stress",
                                      "material.surface_energy", "loading.angle", "particle.radius"}));
}

TEST(Numbers, HaveTheGapOfEachWall) {
  CheckedScenario scenario = parse_scenario(k_late_wall_text, "s.toml");
  set_number(scenario, "loading.wall[1].gap", 3e-6);
  EXPECT_EQ(scenario.loading.walls[0].gap, 0.0);
  EXPECT_EQ(scenario.loading.walls[1].gap, 3e-6);
  EXPECT_THROW(set_number(scenario, "loading.wall[2].gap", 3e-6), std::logic_error);
}

TEST(Numbers, OfARangeAreSetTogether) {
  CheckedScenario scenario = parse_scenario(k_late_wall_text, "s.toml");
  set_number(scenario, "loading.wall[0-1].gap", 3e-6);
  EXPECT_EQ(scenario.loading.walls[0].gap, 3e-6);
  EXPECT_EQ(scenario.loading.walls[1].gap, 3e-6);
  const std::vector<NumberKey> numbers = number_keys(scenario);
  const auto gap = number_of_range(numbers, "loading.wall[0-1].gap");
  ASSERT_TRUE(gap);
  EXPECT_EQ(gap->path, "loading.wall[0-1].gap");
  EXPECT_EQ(gap->dimension, Dimension::length);
  EXPECT_FALSE(number_of_range(numbers, "loading.wall[0-2].gap")) << "there are two walls";
  EXPECT_FALSE(number_of_range(numbers, "loading.wall[0].gap")) << "that is no range";
}

TEST(Edit, PutsOneValueToAllKeysOfARange) {
  const std::string text = with_values(k_late_wall_text, {{"loading.wall[0-1].gap", "1e-6"}});
  const CheckedScenario scenario = parse_scenario(text, "edited.toml");
  EXPECT_EQ(scenario.loading.walls[0].gap, 1e-6);
  EXPECT_EQ(scenario.loading.walls[1].gap, 1e-6);
}

TEST(Edit, PutsAGapIntoTheTableOfItsWall) {
  const std::string commented = replaced(replaced(k_late_wall_text, "[[loading.wall]]", "[[loading.wall]]  # on top"),
                                         "gap = \"0.002 R0\"", "gap = \"0.002 R0\"  # late");
  const std::string text = with_values(commented, {{"loading.wall[1].gap", "1e-6"}, {"loading.wall[0].gap", "2e-6"}});
  const CheckedScenario scenario = parse_scenario(text, "edited.toml");
  EXPECT_EQ(scenario.loading.walls[0].gap, 2e-6);
  EXPECT_EQ(scenario.loading.walls[1].gap, 1e-6);
  EXPECT_NE(text.find("# on top\ngap = 2e-6\n"), std::string::npos) << text;
  EXPECT_NE(text.find("gap = 1e-6  # late\n"), std::string::npos) << text;
}

TEST(Numbers, SettingOneIsLikeWritingItIntoTheFile) {
  CheckedScenario scenario = parse_scenario(k_scenario, "s.toml");
  for (const NumberKey& number : number_keys(scenario)) {
    if (number.path == k_radius_key) continue;
    set_number(scenario, number.path, 0.125);
    const CheckedScenario written = parse_scenario(k_scenario, "s.toml", {number.path + "=0.125"});
    const std::string key = number.path.substr(number.path.find('.') + 1);
    if (key == "angle") {
      EXPECT_EQ(scenario.loading.oblique_angle, written.loading.oblique_angle);
    } else {
      EXPECT_EQ(scenario.material.at(key), written.material.at(key)) << key;
    }
  }
  EXPECT_THROW(set_number(scenario, "particle.radius", 1.0), std::logic_error);
}

}  // namespace
}  // namespace monograin::edit_test
