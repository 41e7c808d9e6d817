// Runs, their curves and files, and models, as others use them.

#include "monograin/monograin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "api/ready.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(RunResult, HasTheCurvesOfTheStoredDie) {
  const RunResult result = run(ready_scenario("die.toml"));
  EXPECT_EQ(result.status, RunStatus::complete);
  EXPECT_EQ(result.message, "");
  EXPECT_EQ(result.limit, "");
  EXPECT_EQ(result.integrator, "direct");
  EXPECT_EQ(result.history["axial.force"].size(), result.history.row_count());
  EXPECT_EQ(result.history.column("axial.force[N]").unit, "N");
  EXPECT_EQ(result.history.words("axial.regime").front(), "elastic");
  EXPECT_EQ(result.events.words("event").back(), "step-end");
}

TEST(RunResult, NamesTheLimitThatStoppedIt) {
  Scenario scenario = ready_scenario("hertz.toml");
  scenario.set("loading.steps[0].displacement", "1.5 R0");
  const RunResult result = run(scenario);
  EXPECT_EQ(result.status, RunStatus::stopped);
  EXPECT_NE(result.limit, "");
  EXPECT_NE(result.message, "");
  EXPECT_GT(result.history.row_count(), 0U) << "curves up to there are kept";
}

TEST(Run, EndsWhenItIsAskedToAndIsTheSameOtherwise) {
  for (const char* const name : {"die.toml", "cel.toml", "nonlocal.toml"}) {
    Scenario scenario = ready_scenario(name);
    scenario.set("output.points", 20);
    for (const char* const integrator : {"auto", "cvode-bdf", "ida", "odeint-dopri5"}) {
      scenario.set("numerics.integrator", integrator);
      int asked = 0;
      const RunResult plain = run(scenario);
      const RunResult watched = run(scenario, {.stop = [&asked] { return ++asked < 0; }});
      EXPECT_GT(asked, 0) << name;
      EXPECT_EQ(watched.integrator, plain.integrator) << name;
      EXPECT_EQ(watched.events.words("event"), plain.events.words("event")) << name;
      for (const std::string_view column : plain.history.names()) {
        const auto one = plain.history[column];
        const auto other = watched.history[column];
        EXPECT_TRUE(std::ranges::equal(one, other, [](double a, double b) { return a == b || (a != a && b != b); }))
            << name << ", " << integrator << ", " << column;
      }
      EXPECT_THROW(static_cast<void>(run(scenario, {.stop = [] { return true; }})), RunInterrupted) << name;
    }
  }
}

TEST(RunResult, HasTheProfilesUnderItsContactsAtAnInstant) {
  const RunResult result = run(ready_scenario("die.toml"));
  const History profile = result.profile(0.5);
  const std::vector<std::string> columns{"class", "radius", "pressure", "displacement", "relaxed_height"};
  EXPECT_TRUE(std::ranges::equal(profile.names(), columns));
  EXPECT_EQ(profile.column("pressure").unit, "Pa");
  const std::vector<std::string_view> classes = profile.words("class");
  double force = 0.0;
  for (std::size_t k = 0; k + 1 < classes.size() && classes[k + 1] == "axial"; ++k) {
    const double inner = profile["radius"][k];
    const double outer = profile["radius"][k + 1];
    const double mean = 0.5 * (profile["pressure"][k] + profile["pressure"][k + 1]);
    force += std::numbers::pi * (outer * outer - inner * inner) * mean;
  }
  const auto time = result.history["time"];
  const auto row = std::ranges::min_element(time, {}, [](double t) { return std::abs(t - 0.5); }) - time.begin();
  EXPECT_NEAR(force / result.history["axial.force"][static_cast<std::size_t>(row)], 1.0, 1e-2);
}

TEST(RunResult, RunsTheScenarioUpToTheInstantOfAProfileOnly) {
  const RunResult result = run(ready_scenario("cycles.toml"));
  const auto asked_until = [&](double time) {
    int asked = 0;
    static_cast<void>(result.profile(time, {.stop = [&asked] { return ++asked < 0; }}));
    return asked;
  };
  EXPECT_LT(10 * asked_until(0.05), asked_until(1.3));
}

TEST(RunResult, SaysWhyThereIsNoProfileAndEndsWhenItIsAskedTo) {
  const auto problem = [](const std::string& scenario, double time) -> std::string {
    try {
      static_cast<void>(run(ready_scenario(scenario)).profile(time));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(problem("die.toml", 99.0), "there is no profile at t = 99 s: the run does not come to that instant");
  EXPECT_NE(problem("packing.toml", 0.5).find("model 'packing' has no profile"), std::string::npos);
  const RunResult result = run(ready_scenario("die.toml"));
  EXPECT_THROW(static_cast<void>(result.profile(0.5, {.stop = [] { return true; }})), RunInterrupted);
}

TEST(History, ThatWasMovedFromStaysAsItWas) {
  History from = run(ready_scenario("hertz.toml")).history;
  const std::size_t rows = from.row_count();
  const History to = std::move(from);
  EXPECT_EQ(to.row_count(), rows);
  EXPECT_EQ(from.row_count(), rows);  // NOLINT(bugprone-use-after-move)
}

TEST(History, TellsColumnsOfOneNameApartByTheirUnits) {
  const History history({{"a", "m", {}, {1.0}}, {"a", "mm", {}, {2.0}}});
  EXPECT_EQ(history["a[m]"].front(), 1.0);
  EXPECT_EQ(history["a[mm]"].front(), 2.0);
}

TEST(RunResult, OutlivesItsScenarioAndSharesItsColumns) {
  std::span<const double> force;
  History history;
  {
    const RunResult result = run(ready_scenario("hertz.toml"));
    history = result.history;
    force = result.history["axial.force"];
  }
  EXPECT_EQ(force.data(), history["axial.force"].data());
  EXPECT_GT(*std::ranges::max_element(force), 0.0);
}

TEST(RunResult, SavesWhatTheProgramLeaves) {
  const fs::path folder = fs::temp_directory_path() / "monograin_api_run";
  fs::remove_all(folder);
  const RunResult result = run(ready_scenario("hertz.toml"));
  result.save(folder);
  for (const char* name : {"history.csv", "events.csv", "run.json"}) EXPECT_TRUE(fs::exists(folder / name)) << name;
  EXPECT_NE(result.json().find("\"status\": \"complete\""), std::string::npos);
  EXPECT_NE(text_of(folder / "history.csv").find("axial.force[N]"), std::string::npos);
  fs::remove_all(folder);
}

TEST(RunResult, WritesItsParticleForParaView) {
  const fs::path folder = fs::temp_directory_path() / "monograin_api_particle";
  fs::remove_all(folder);
  Scenario scenario = ready_scenario("die.toml");
  run(scenario.set("output.points", 5)).write_vtk(folder);
  EXPECT_NE(text_of(folder / "run.pvd").find("file=\"particle-0000.vtp\""), std::string::npos);
  EXPECT_TRUE(fs::exists(folder / "walls-0000.vtp"));
  fs::remove_all(folder);
  EXPECT_THROW(run(ready_scenario("packing.toml")).write_vtk(folder), std::invalid_argument);
  EXPECT_FALSE(fs::exists(folder));
}

TEST(RunResult, IsATestForLammpsWhereLammpsHasTheLaw) {
  EXPECT_NE(run(ready_scenario("hertz.toml")).lammps_input().find("pair_coeff * * hertz/material"), std::string::npos);
  EXPECT_THROW(static_cast<void>(run(ready_scenario("cel.toml")).lammps_input()), std::invalid_argument);
}

TEST(RunResult, HasTheForceOfAWallOverItsDisplacement) {
  const RunResult result = run(ready_scenario("die.toml"));
  const History axial = result.force_table();
  EXPECT_TRUE(std::ranges::equal(axial.names(), std::vector{"branch", "axial.displacement", "axial.force"}));
  EXPECT_EQ(axial["branch"].front(), 1.0);
  EXPECT_GT(axial["branch"].back(), 1.0);
  const auto largest = std::ranges::max(result.history["axial.force"]);
  EXPECT_EQ(std::ranges::max(axial["axial.force"]), largest);
  EXPECT_EQ(result.force_table("axial").row_count(), axial.row_count());
  EXPECT_THROW(static_cast<void>(result.force_table("lateral")), std::invalid_argument) << "these walls do not move";
  EXPECT_THROW(static_cast<void>(result.force_table("top")), std::invalid_argument);
}

TEST(History, SuggestsTheColumnThatWasMeant) {
  const RunResult result = run(ready_scenario("hertz.toml"));
  try {
    static_cast<void>(result.history["axial.forse"]);
    FAIL() << "nothing was thrown";
  } catch (const std::out_of_range& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'axial.force'?"), std::string::npos) << error.what();
  }
  EXPECT_THROW(static_cast<void>(result.history.words("axial.force")), std::out_of_range);
}

TEST(History, OfMeasuredCurvesComparesWithARun) {
  const RunResult result = run(ready_scenario("hertz.toml"));
  const auto displacement = result.history["axial.displacement"];
  std::vector<double> force(result.history["axial.force"].begin(), result.history["axial.force"].end());
  for (double& value : force) value *= 1.01;
  const History measured(
      {{"axial.displacement", "m", {}, {displacement.begin(), displacement.end()}}, {"axial.force", "N", {}, force}});
  const Comparison comparison = compare(measured, result.history, "axial.displacement", "axial.force");
  ASSERT_EQ(comparison.curves.size(), 1U);
  EXPECT_NEAR(comparison.curves.front().linf, 0.01 / 1.01, 1e-12);
}

TEST(History, RefusesColumnsOfDifferentLengths) {
  EXPECT_THROW(History({{"a", "m", {}, {1.0, 2.0}}, {"b", "m", {}, {1.0}}}), std::invalid_argument);
}

TEST(History, RefusesTwoColumnsOfOneNameAndUnit) {
  EXPECT_THROW(History({{"a", "m", {}, {1.0}}, {"a", "m", {}, {2.0}}}), std::invalid_argument);
}

TEST(History, HasAWordForEveryLabelAndAnEmptyOneForNone) {
  const History history({{"regime", "", {"open", "elastic"}, {1.0, std::numeric_limits<double>::quiet_NaN(), 0.0}}});
  EXPECT_EQ(history.words("regime"), (std::vector<std::string_view>{"elastic", "", "open"}));
  for (const double value : {2.0, -1.0, 0.5}) {
    EXPECT_THROW(History({{"regime", "", {"open", "elastic"}, {value}}}), std::invalid_argument) << value;
  }
}

TEST(Models, HaveKeysWithUnitsAndMeaning) {
  std::set<std::string> names;
  for (const ModelInfo& model : models()) {
    names.insert(model.name);
    EXPECT_FALSE(model.references.empty()) << model.name;
    EXPECT_FALSE(model.material.empty()) << model.name;
    for (const KeyInfo& key : model.material) {
      EXPECT_FALSE(key.meaning.empty()) << model.name << ' ' << key.name;
      EXPECT_TRUE(!key.unit.empty() || !key.choices.empty()) << model.name << ' ' << key.name;
    }
  }
  EXPECT_TRUE(names.contains("mdr"));
  EXPECT_TRUE(names.contains("packing"));
}

TEST(Version, IsThatOfTheProject) { EXPECT_EQ(version(), MONOGRAIN_PROJECT_VERSION); }

}  // namespace
}  // namespace monograin
