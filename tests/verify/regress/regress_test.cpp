#include "verify/regress/regress.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "history/table.hpp"
#include "scenario/faults.hpp"
#include "support/scenario_texts.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin::regress_test {
namespace {

TEST(StoredCurves, AreMetByEveryReadyScenarioWithEveryIntegrator) {
  const std::vector<RegressionResult> results =
      regress(MONOGRAIN_SOURCE_DIR "/scenarios", MONOGRAIN_SOURCE_DIR "/tests/curves");
  std::set<std::string> integrators;
  for (const RegressionResult& result : results) {
    integrators.insert(result.integrator);
    EXPECT_TRUE(result.passes()) << result.scenario << " with " << result.integrator << ": curve " << result.difference
                                 << " in " << result.column << ", event time " << result.event_time << ", tolerance "
                                 << result.tolerance << ". " << result.fault;
  }
  EXPECT_GE(results.size(), 36U);
  EXPECT_EQ(integrators, (std::set<std::string>{"direct", "cvode-adams", "cvode-bdf", "ida"}));
}

TEST(StoredCurves, AreAskedForWhereTheyAreMissing) {
  const std::vector<RegressionResult> results = regress(MONOGRAIN_SOURCE_DIR "/scenarios", "no such folder");
  EXPECT_GE(results.size(), 36U);
  for (const RegressionResult& result : results) {
    EXPECT_FALSE(result.passes());
    EXPECT_NE(result.fault.find("--accept"), std::string::npos) << result.fault;
  }
}

TEST(StoredCurves, AreAllReplacedOrNone) {
  const TemporaryFolder folder;
  const auto scenarios = folder.path() / "scenarios";
  std::filesystem::create_directory(scenarios);
  write_text(scenarios / "a.toml", k_hertz_text);
  EXPECT_EQ(accept_curves(scenarios, folder.path() / "curves").size(), 1U);
  const std::string before = read_text(folder.path() / "curves" / "a.csv");
  write_text(scenarios / "a.toml", replaced(k_hertz_text, "0.22", "0.23"));
  write_text(scenarios / "b.toml", "no scenario");
  EXPECT_THROW(static_cast<void>(accept_curves(scenarios, folder.path() / "curves")), ScenarioError);
  EXPECT_EQ(read_text(folder.path() / "curves" / "a.csv"), before);
}

TEST(StoredCurves, AreNotMetWhereAValueDiffersAtAnEvent) {
  const TemporaryFolder folder;
  const auto scenarios = folder.path() / "scenarios";
  std::filesystem::create_directory(scenarios);
  write_text(scenarios / "a.toml", k_hertz_text);
  accept_curves(scenarios, folder.path());
  for (const RegressionResult& result : regress(scenarios, folder.path())) EXPECT_TRUE(result.passes()) << result.fault;

  const auto file = folder.path() / "a.events.csv";
  const Table events = read_csv(file);
  std::string text = read_text(file);
  const std::size_t last_line = text.rfind('\n', text.size() - 2) + 1;
  const std::string stored = fmt::format("{}", events.at(events.row_count() - 1, *events.find("axial.force")));
  const std::size_t force = text.find("," + stored + ",", last_line);
  ASSERT_NE(force, std::string::npos) << text.substr(last_line);
  write_text(file, text.replace(force + 1, stored.size(), fmt::format("{}", 1.001 * std::stod(stored))));
  for (const RegressionResult& result : regress(scenarios, folder.path())) {
    EXPECT_FALSE(result.passes());
    EXPECT_EQ(result.column, "axial.force at an event");
  }
}

TEST(StoredCurves, NeedAFolderOfScenarios) {
  EXPECT_THROW(static_cast<void>(regress("no such folder", "no such folder")), std::runtime_error);
}

}  // namespace
}  // namespace monograin::regress_test
