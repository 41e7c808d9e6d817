// Scenarios that are set key by key.

#include "monograin/scenario.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "api/ready.hpp"
#include "monograin/prepared.hpp"
#include "monograin/run.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

Scenario pressed_sphere() {
  Scenario scenario;
  scenario.set("model", "hertz")
      .set("particle.radius", 0.01)
      .set("material.youngs_modulus", "1 GPa")
      .set("material.poisson_ratio", 0.25)
      .set("loading.configuration", "simple")
      .set("loading.steps[0].displacement", "0.05 R0")
      .set("loading.steps[0].duration", 1);
  return scenario;
}

std::string faults_of(const Scenario& scenario) {
  std::string text;
  for (const Fault& fault : scenario.validate()) text += fault.message + '\n';
  return text;
}

TEST(Scenario, HoldsOneValueOfAKeyThatIsSetAgainAndAgain) {
  Scenario scenario = pressed_sphere();
  const std::size_t count = scenario.overrides().size();
  for (int k = 1; k <= 100; ++k) scenario.set("particle.radius", 0.01 * k).set("material.poisson_ratio", 0.3);
  EXPECT_EQ(scenario.overrides().size(), count);
  EXPECT_EQ(run(scenario).history["axial.displacement"].back(), 0.05);
  // A table takes the place of the keys in it, so that their order counts.
  for (int k = 1; k <= 100; ++k)
    scenario.set("loading.steps[0].duration", k).set("loading.steps[0].displacement", 1e-4);
  EXPECT_EQ(scenario.overrides().size(), count);
  scenario.set("loading.steps[0]", "x").set("loading.steps[0].duration", 3);
  EXPECT_EQ(scenario.overrides().size(), count + 2);
  scenario.set("loading.steps[0].durations", 1);
  EXPECT_EQ(scenario.overrides().size(), count + 3) << "the name of another key begins alike";
}

TEST(Scenario, ThatIsSetKeyByKeyRuns) {
  const Scenario scenario = pressed_sphere();
  EXPECT_EQ(faults_of(scenario), "");
  const RunResult result = run(scenario);
  EXPECT_EQ(result.status, RunStatus::complete);
  // Hertz: F = 4/3 E/(1 - nu^2) sqrt(R) d^(3/2)
  const double expected = 4.0 / 3.0 * 1e9 / (1.0 - 0.0625) * std::sqrt(0.01) * std::pow(0.0005, 1.5);
  EXPECT_NEAR(result.history["axial.force"].back(), expected, 1e-12 * expected);
}

TEST(Scenario, WithoutKeysHasFaultsAndThrowsNothingElse) {
  const Scenario scenario;
  EXPECT_NE(faults_of(scenario).find("key 'model' is missing"), std::string::npos) << faults_of(scenario);
  EXPECT_THROW(static_cast<void>(run(scenario)), ScenarioError);
  EXPECT_THROW(static_cast<void>(scenario.parameters()), ScenarioError);
}

TEST(Scenario, GivesEveryFaultAtOnce) {
  Scenario scenario = pressed_sphere();
  scenario.set("material.poisson_ratio", 0.7).set("particle.radius", "10 MPa").set("material.colour", "red");
  const std::string faults = faults_of(scenario);
  for (const char* word : {"poisson_ratio", "radius", "colour"}) {
    EXPECT_NE(faults.find(word), std::string::npos) << word << " is not in\n" << faults;
  }
}

TEST(Scenario, TakesDefaultsForWhatIsNotSet) {
  Scenario scenario = pressed_sphere();
  const auto parameters = scenario.parameters();
  const auto composite = std::ranges::find(parameters, "composite_modulus", &Parameter::name);
  ASSERT_NE(composite, parameters.end());
  EXPECT_DOUBLE_EQ(composite->value, 1e9 / (1.0 - 0.0625));
  EXPECT_EQ(composite->unit, "Pa");
  EXPECT_GT(run(scenario).history.row_count(), 200U) << "two hundred points a step";
}

TEST(Scenario, KeepsTheLastValueOfAKey) {
  Scenario scenario = pressed_sphere();
  const double stiff = run(scenario).history["axial.force"].back();
  scenario.set("material.youngs_modulus", 3e9).set("material.youngs_modulus", 5e8);
  EXPECT_NEAR(run(scenario).history["axial.force"].back(), 0.5 * stiff, 1e-9 * stiff);
}

TEST(Scenario, TakesListsSwitchesAndWords) {
  Scenario scenario = pressed_sphere();
  scenario.set("loading.configuration", "walls")
      .set("loading.wall[0].name", "left")
      .set("loading.wall[0].normal", {-1.0, 0.0, 0.0})
      .set("loading.wall[1].name", "right")
      .set("loading.wall[1].normal", std::array{1.0, 0.0, 0.0})
      .set("loading.wall[1].fixed", true)
      .set("output.times", std::vector{0.25, 0.5});
  EXPECT_EQ(faults_of(scenario), "");
  const RunResult result = run(scenario);
  EXPECT_TRUE(result.history.contains("left.force"));
}

TEST(Scenario, TakesListsOfTextsAndAnyInteger) {
  Scenario scenario = pressed_sphere();
  const std::string word = "particle.radius";
  scenario.set("sensitivities.keys", {"material.youngs_modulus", "particle.radius"});
  EXPECT_EQ(scenario.overrides().back(), R"(sensitivities.keys=["material.youngs_modulus", "particle.radius"])");
  scenario.set("sensitivities.keys", {"particle.radius"});
  EXPECT_EQ(scenario.overrides().back(), R"(sensitivities.keys=["particle.radius"])");
  scenario.set("sensitivities.keys", {std::string_view(word), std::string_view("material.youngs_modulus")});
  EXPECT_EQ(scenario.overrides().back(), R"(sensitivities.keys=["particle.radius", "material.youngs_modulus"])");
  scenario.set("output.points", std::size_t{5}).set("output.points", 7L).set("output.points", 9U);
  EXPECT_EQ(scenario.overrides().back(), "output.points=9");
  EXPECT_EQ(faults_of(scenario), "");
}

// A loop over a span into a history that ends with its expression would read what is gone.
TEST(Scenario, RunInTheHeadOfALoopGivesColumnsThatOutliveIt) {
  double largest = 0.0;
  for (const double force : run(pressed_sphere()).history["axial.force"]) largest = std::max(largest, force);
  const RunResult kept = run(pressed_sphere());
  EXPECT_EQ(largest, std::ranges::max(kept.history["axial.force"]));
  std::string words;
  for (const auto& word : run(pressed_sphere()).history.words("axial.regime")) words += word;
  std::string expected;
  for (const std::string_view word : kept.history.words("axial.regime")) expected += word;
  EXPECT_EQ(words, expected);
  static_assert(std::is_same_v<decltype(std::declval<History>()["time"]), std::vector<double>>);
  static_assert(std::is_same_v<decltype(std::declval<const History&>()["time"]), std::span<const double>>);
}

TEST(Scenario, OfATextTakesWhatWasSetInAnother) {
  const Scenario set = pressed_sphere();
  const Scenario again = Scenario::parse(set.text(), set.origin(), set.overrides());
  EXPECT_EQ(again.overrides(), set.overrides());
  EXPECT_EQ(faults_of(again), "");
  EXPECT_NE(faults_of(Scenario::parse(set.text(), set.origin(), {"model=hertz", "model"})), "");
}

TEST(Scenario, CannotSkipAnEntryOfAnArray) {
  Scenario scenario = pressed_sphere();
  scenario.set("loading.steps[2].displacement", 0.0);
  EXPECT_NE(faults_of(scenario).find("index [2] is out of range"), std::string::npos) << faults_of(scenario);
}

TEST(Scenario, EscapesTexts) {
  Scenario scenario = pressed_sphere();
  scenario.set("title", "a \"quoted\" title\nof two lines \\ and more");
  EXPECT_EQ(faults_of(scenario), "");
}

TEST(Scenario, RefusesNumbersThatAreNone) {
  for (const double number : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Scenario scenario = pressed_sphere();
    scenario.set("material.youngs_modulus", number);
    EXPECT_NE(faults_of(scenario), "");
  }
}

TEST(Scenario, OfAFileKnowsItsPlaces) {
  const fs::path file = fs::temp_directory_path() / "monograin_api_scenario.toml";
  std::ofstream(file) << "model = \"hertz\"\n[particle]\nradius = -1\n";
  const auto faults = read_scenario(file).validate();
  const auto radius = std::ranges::find_if(faults, [](const Fault& f) { return f.where.line == 3; });
  ASSERT_NE(radius, faults.end());
  EXPECT_EQ(radius->where.file, file.string());
  fs::remove(file);
}

TEST(Scenario, WithItsFilesInMemoryReadsNone) {
  const Scenario read = ready_scenario("hollomon.toml");
  const Scenario held =
      Scenario::parse(read.text(), "nowhere/hollomon.toml", {},
                      std::map<std::string, std::string>{
                          {"hollomon-pressure.csv", "delta_max_over_R,p_over_Y\n0,3.6\n0.1,5\n0.3,6\n0.6,6\n"}});
  EXPECT_GT(std::ranges::max(run(read).history["axial.force"]),
            2.0 * std::ranges::max(run(held).history["axial.force"]));
  const PreparedScenario prepared(held, {"material.yield_stress"});
  EXPECT_EQ(prepared.run(std::vector{30e6}).status, RunStatus::complete);
  EXPECT_THROW(static_cast<void>(run(Scenario::parse(read.text(), "nowhere/hollomon.toml"))), ScenarioError);
}

TEST(Scenario, OfAFileThatIsNotThereIsRefusedWithItsName) {
  try {
    static_cast<void>(read_scenario("no/such/file.toml"));
    FAIL() << "nothing was thrown";
  } catch (const ScenarioError& error) {
    EXPECT_NE(std::string(error.what()).find("no/such/file.toml"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace monograin
