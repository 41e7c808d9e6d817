// Sweeps, sensitivities, calibrations and plans of experiments, as others use them.

#include "monograin/study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "api/ready.hpp"
#include "monograin/run.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin::study {
namespace {

namespace fs = std::filesystem;

const fs::path k_scenarios = fs::path(MONOGRAIN_SOURCE_DIR) / "scenarios";

/// A sweep of the ready die over yield stresses [MPa], in memory.
Source yield_stresses(const std::string& values) {
  return {.file = k_scenarios / "stresses.toml",
          .text = "scenario = \"die.toml\"\ndesign = \"grid\"\n[vary]\n\"material.yield_stress\" = { values = " +
                  values + " }\n"};
}

TEST(StudySweep, HasARowForEachRunWithTheNumbersOfThatRun) {
  const TemporaryFolder folder;
  const SweepResult found = sweep(yield_stresses("[\"30 MPa\", \"50 MPa\"]"), {.folder = folder.path() / "s"});
  EXPECT_EQ(found.missing, 0U);
  EXPECT_TRUE(fs::exists(found.folder / "results.csv"));
  ASSERT_EQ(found.results.row_count(), 2U);
  EXPECT_EQ(found.results.words("status")[1], "complete");
  Scenario soft = ready_scenario("die.toml");
  const RunResult run = monograin::run(soft.set("material.yield_stress", 30e6));
  EXPECT_EQ(found.results["end.axial.force"][0], run.history["axial.force"].back());
}

TEST(StudySweep, HasTheSameResultsInWhateverFormatTheyAreWritten) {
  const TemporaryFolder folder;
  const Source source = yield_stresses("[\"30 MPa\", \"50 MPa\"]");
  EXPECT_THROW(static_cast<void>(sweep(source, {.folder = folder.path() / "s", .format = "xml"})),
               std::invalid_argument);
  EXPECT_FALSE(fs::exists(folder.path() / "s"));
  const History expected = sweep(source, {.folder = folder.path() / "s", .format = "csv"}).results;
  const SweepResult found = sweep(source, {.folder = folder.path() / "h", .format = "hdf5"});
  EXPECT_TRUE(fs::exists(found.folder / "results.h5"));
  EXPECT_EQ(found.results.words("status"), expected.words("status"));
  for (const char* name : {"material.yield_stress", "end.axial.force"}) {
    EXPECT_TRUE(std::ranges::equal(found.results[name], expected[name])) << name;
  }
}

TEST(StudySweep, IsReadFromItsOwnResultsBesideAFileOfTheUser) {
  const TemporaryFolder folder;
  write_text(folder.path() / "results.csv", "mine[N]\n1\n");
  const SweepResult found =
      sweep(yield_stresses("[\"30 MPa\", \"50 MPa\"]"), {.folder = folder.path(), .format = "hdf5"});
  EXPECT_EQ(found.results.words("status").size(), 2U);
  EXPECT_EQ(read_text(folder.path() / "results.csv"), "mine[N]\n1\n");
}

TEST(StudySweep, IsDoneInShardsAndGoesOnWhereItWasEnded) {
  const TemporaryFolder folder;
  const Source source = yield_stresses("[30e6, 35e6, 40e6, 45e6]");
  const fs::path parts = folder.path() / "parts";
  const SweepResult half = sweep(source, {.folder = parts, .shard = 1, .shard_count = 2});
  EXPECT_EQ(half.missing, 2U);
  EXPECT_EQ(half.results.row_count(), 0U);
  EXPECT_EQ(sweep(source, {.folder = parts, .shard = 2, .shard_count = 2}).results.row_count(), 4U);

  const fs::path ended = folder.path() / "ended";
  int asked = 0;
  EXPECT_THROW(static_cast<void>(sweep(source, {.folder = ended, .threads = 1, .stop = [&] { return ++asked == 3; }})),
               RunInterrupted);
  asked = 0;
  const SweepResult rest = sweep(source, {.folder = ended, .threads = 1, .stop = [&] { return ++asked < 0; }});
  EXPECT_EQ(rest.results.row_count(), 4U);
  EXPECT_EQ(asked, 1) << "the runs before the end were kept";
}

/// A folder with a file of the user.
fs::path with_foreign(const fs::path& folder, const std::string& name) {
  fs::create_directories(folder);
  std::ofstream(folder / name) << "mine\n";
  return folder;
}

/// Expects a study to refuse a folder before it computes anything, and to keep the file of the user there.
/// @param study  called with a folder and a function `stop`
template <class Study>
void expect_refused_at_once(const fs::path& folder, const std::string& name, Study&& study) {
  int asked = 0;
  try {
    study(with_foreign(folder, name), [&asked] { return ++asked < 0; });
    ADD_FAILURE() << "nothing was thrown for " << name;
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string_view(error.what()).find(name), std::string_view::npos) << error.what();
  }
  EXPECT_EQ(asked, 0) << name << " was refused after computations";
  std::string kept;
  std::getline(std::ifstream(folder / name) >> std::ws, kept);
  EXPECT_EQ(kept, "mine");
}

TEST(Study, RefusesAFolderWithAFileOfTheUserBeforeItComputesAnything) {
  const TemporaryFolder folder;
  using Stop = std::function<bool()>;
  expect_refused_at_once(folder.path() / "s", "results.csv", [](const fs::path& taken, const Stop& stop) {
    static_cast<void>(sweep(yield_stresses("[30e6, 40e6]"), {.folder = taken, .stop = stop}));
  });
  for (const char* name : {"fit.csv", "fitted.toml"}) {
    expect_refused_at_once(folder.path() / name, name, [](const fs::path& taken, const Stop& stop) {
      const Source source{.file = k_scenarios / "calibrate" / "uniaxial.toml"};
      static_cast<void>(calibrate(source, {.folder = taken, .stop = stop}));
    });
  }
  expect_refused_at_once(folder.path() / "d", "errors.csv", [](const fs::path& taken, const Stop& stop) {
    const Source source{.file = k_scenarios / "design" / "uniaxial.toml"};
    static_cast<void>(design(source, {.folder = taken, .stop = stop}));
  });
}

TEST(Study, RefusesASourceThatIsEmptyOrHasDataThatItDoesNotUse) {
  EXPECT_THROW(static_cast<void>(sweep({})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(calibrate({})), std::invalid_argument);
  Source source = yield_stresses("[30e6, 40e6]");
  source.data = {{"die.toml", "not read"}};
  EXPECT_THROW(static_cast<void>(sweep(source)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(sensitivity(source)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(design({.file = k_scenarios / "design" / "uniaxial.toml", .data = source.data})),
               std::invalid_argument);
  try {
    static_cast<void>(sweep({.text = "scenario = \"none.toml\"\n"}));
    FAIL() << "nothing was thrown";
  } catch (const ScenarioError& error) {
    EXPECT_TRUE(std::string_view(error.what()).starts_with("study.toml:1:")) << error.what();
  }
  try {
    static_cast<void>(calibrate({.file = k_scenarios / "calibrate" / "uniaxial.toml", .data = {{"other.csv", "1,2"}}}));
    FAIL() << "nothing was thrown";
  } catch (const ScenarioError& error) {
    for (const char* part : {"'other.csv'", "'uniaxial.csv'"}) {
      EXPECT_NE(std::string_view(error.what()).find(part), std::string_view::npos) << error.what();
    }
  }
}

TEST(StudySweep, CountsThePointsOutsideOfItsConstraintsAndWarnsOfNumbersWithoutUnits) {
  const TemporaryFolder folder;
  const SweepResult doubtful = sweep(yield_stresses("[\"40 MPa\", 50]"), {.folder = folder.path() / "doubtful"});
  ASSERT_EQ(doubtful.warnings.size(), 2U);
  EXPECT_NE(doubtful.warnings[0].find("yield_stress"), std::string::npos) << doubtful.warnings[0];
  EXPECT_TRUE(doubtful.warnings[1].starts_with("1 of 2 runs warn; run 2: ")) << doubtful.warnings[1];
  Source source = yield_stresses("[30e6, 40e6, 50e6]");
  *source.text += "\"material.youngs_modulus\" = { values = [1e9, 45e6] }\n";
  source.text->insert(0, "constraints = [\"material.youngs_modulus > material.yield_stress\"]\n");
  const SweepResult found = sweep(source, {.folder = folder.path() / "s"});
  EXPECT_EQ(found.left_out, 1U);
  EXPECT_EQ(found.results.row_count(), 5U);
  ASSERT_EQ(found.warnings.size(), 1U) << "E/Y of 1.5 and less, but no number without a unit";
  EXPECT_TRUE(found.warnings[0].starts_with("2 of 5 runs warn; run 2: ")) << found.warnings[0];
  EXPECT_EQ(found.no_figure, "");
}

TEST(StudySweep, RefusesShardsThreadsAndFaults) {
  const Source source = yield_stresses("[30e6, 40e6]");
  EXPECT_THROW(static_cast<void>(sweep(source, {.shard = 3, .shard_count = 2})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(sweep(source, {.shard = 0})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(sweep(source, {.threads = -1})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(sensitivity(source, {.shard_count = 2})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(sensitivity(source, {}, 1.0)), std::invalid_argument);
  try {
    static_cast<void>(sweep({.file = "there/is/none.toml"}));
    FAIL() << "nothing was thrown";
  } catch (const ScenarioError& error) {
    EXPECT_NE(std::string_view(error.what()).find("none.toml"), std::string_view::npos) << error.what();
  }
}

TEST(StudySensitivity, GivesTheSharesOfEachKey) {
  const TemporaryFolder folder;
  const Source source{
      .file = k_scenarios / "few.toml",
      .text =
          "scenario = \"die.toml\"\ndesign = \"saltelli\"\nsamples = 256\nresults = [\"max.axial.force\"]\n"
          "[vary]\n\"material.yield_stress\" = { from = \"30 MPa\", to = \"60 MPa\" }\n"
          "\"material.youngs_modulus\" = { from = \"1 GPa\", to = \"1.1 GPa\" }\n"};
  const SensitivityResult found = sensitivity(source, {.folder = folder.path() / "s"}, 0.9);
  ASSERT_EQ(found.table.row_count(), 2U);
  EXPECT_GT(found.table["total"][0], 0.9) << "the yield stress";
  EXPECT_LT(found.table["total"][1], 0.1) << "Young's modulus";
}

TEST(StudySensitivity, RefusesADesignWithoutSensitivitiesBeforeAnyRun) {
  const TemporaryFolder folder;
  int asked = 0;
  try {
    static_cast<void>(sensitivity(yield_stresses("[30e6, 40e6]"),
                                  {.folder = folder.path() / "s", .stop = [&asked] { return ++asked < 0; }}));
    FAIL() << "nothing was thrown";
  } catch (const std::invalid_argument& error) {
    EXPECT_TRUE(std::string_view(error.what()).starts_with("design = \"grid\" says nothing")) << error.what();
  }
  EXPECT_EQ(asked, 0);
  EXPECT_FALSE(fs::exists(folder.path() / "s"));
}

TEST(StudyCalibration, FindsTheParametersOfItsDataAndTheirScenario) {
  const CalibrationResult fit = calibrate({.file = k_scenarios / "calibrate" / "uniaxial.toml"});
  ASSERT_EQ(fit.parameters.size(), 2U);
  EXPECT_EQ(fit.parameters[1].key, "material.yield_stress");
  EXPECT_EQ(fit.parameters[1].unit, "Pa");
  for (const FittedParameter& parameter : fit.parameters) {
    EXPECT_TRUE(parameter.is_determined) << parameter.key;
    EXPECT_LT(parameter.lower, parameter.value);
    EXPECT_GT(parameter.upper, parameter.value);
    EXPECT_LT(parameter.standard_error, 0.02 * parameter.value);
  }
  EXPECT_TRUE(fit.warnings.empty());
  EXPECT_NE(fit.json.find("\"material.yield_stress\""), std::string::npos);
  const std::vector<Parameter> fitted = fit.scenario.parameters();
  const auto found = std::ranges::find(fitted, "yield_stress", &Parameter::name);
  ASSERT_NE(found, fitted.end());
  EXPECT_EQ(found->value, fit.parameters[1].value);
  EXPECT_EQ(monograin::run(fit.scenario).status, RunStatus::complete);
}

TEST(StudyCalibration, TakesDataInMemoryAndALevelAndWritesItsFiles) {
  const TemporaryFolder folder;
  std::string data = "displacement[mm],force[kN]\n";
  Scenario truth = ready_scenario("uniaxial.toml");
  const History history = monograin::run(truth.set("output.points", 20)).history;
  for (std::size_t k = 0; k < history.row_count(); ++k) {
    data += std::to_string(1e3 * history["axial.displacement"][k]) + "," +
            std::to_string(1e-3 * history["axial.force"][k]) + "\n";
  }
  const Source source{.file = k_scenarios / "calibrate" / "mine.toml",
                      .text =
                          "scenario = \"../uniaxial.toml\"\n"
                          "[data]\nfile = \"mine.csv\"\nx = \"displacement[mm]\"\ny = \"force[kN]\"\n"
                          "[free]\n\"material.yield_stress\" = { from = \"1 MPa\", to = \"200 MPa\" }\n",
                      .data = {{"mine.csv", data}}};
  const CalibrationResult wide = calibrate(source, {.folder = folder.path() / "fit"}, 0.99);
  const CalibrationResult narrow = calibrate(source, {}, 0.5);
  EXPECT_GT(wide.parameters[0].upper - wide.parameters[0].lower,
            2.0 * (narrow.parameters[0].upper - narrow.parameters[0].lower));
  const std::vector<Parameter> parameters = truth.parameters();
  const auto true_stress = std::ranges::find(parameters, "yield_stress", &Parameter::name);
  EXPECT_NEAR(wide.parameters[0].value / true_stress->value, 1.0, 1e-3);
  for (const char* name : {"fit.csv", "fitted.toml", "calibration.json"}) {
    EXPECT_TRUE(fs::exists(folder.path() / "fit" / name)) << name;
  }
  EXPECT_THROW(static_cast<void>(calibrate(source, {}, 0.0)), std::invalid_argument);
  const fs::path none = folder.path() / "none";
  EXPECT_THROW(static_cast<void>(calibrate(source, {.folder = none, .stop = [] { return true; }})), RunInterrupted);
  EXPECT_FALSE(fs::exists(none / "fit.csv"));
}

TEST(StudyDesign, NamesTheBestCandidateAndTheErrorsOfAll) {
  const DesignResult plan = design({.file = k_scenarios / "design" / "uniaxial.toml"});
  EXPECT_EQ(plan.programs.size(), 3U);
  EXPECT_EQ(plan.notes.size(), 3U);
  ASSERT_EQ(plan.candidates.size(), 2U);
  EXPECT_TRUE(plan.has_planned);
  EXPECT_EQ(plan.table.row_count(), 6U) << "two parameters of the planned program and of each candidate";
  EXPECT_EQ(plan.best_by_volume, "unloading");
  EXPECT_LT(plan.table["volume"][3], plan.table["volume"][5]) << "the best one has the least volume";
  EXPECT_THROW(
      static_cast<void>(design({.file = k_scenarios / "design" / "uniaxial.toml"}, {.stop = [] { return true; }})),
      RunInterrupted);
}

TEST(StudyReadData, HasTheRowsThatACalibrationTakes) {
  const TemporaryFolder folder;
  write_text(folder.path() / "machine.txt",
             "made by a machine\n\ns [mm];t [s];F [kN]\n0,0;1;0,5\n1,5;2;\n2,5;3;0,75\nEND\n");
  const DataResult found = read_data(folder.path() / "machine.txt");
  EXPECT_TRUE(std::ranges::equal(found.table.names(), std::vector{"s", "F"}));
  EXPECT_EQ(found.table.column("s").unit, "mm");
  EXPECT_TRUE(std::ranges::equal(found.table["F"], std::vector{0.5, 0.75}));
  EXPECT_EQ(found.lines, (std::vector<std::size_t>{4, 6}));
  EXPECT_NE(found.text.find("separator  semicolon"), std::string::npos) << found.text;
  EXPECT_TRUE(
      std::ranges::equal(read_data(folder.path() / "machine.txt", "2", "s").table.names(), std::vector{"t", "s"}));
}

TEST(StudyReadData, RefusesWhatIsNoTableOfTwoColumns) {
  const TemporaryFolder folder;
  write_text(folder.path() / "d.csv", "s[mm],F[N]\n0,0\n1,2\n");
  const auto read = [&](const std::string& name, const std::string& x) {
    return [=, path = folder.path()] { static_cast<void>(read_data(path / name, x)); };
  };
  EXPECT_THROW(read("none.csv", "")(), ScenarioError);
  EXPECT_THROW(read("d.csv", "F")(), std::invalid_argument);
  try {
    read("d.csv", "way")();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const ScenarioError& error) {
    EXPECT_NE(std::string_view(error.what()).find("x = way"), std::string_view::npos) << error.what();
  }
}

}  // namespace
}  // namespace monograin::study
