// What a run records of the scenario that it was made from.

#include "history/run_files.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "scenario/scenario.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_run.hpp"

namespace monograin::run_files_test {
namespace {

const std::string k_table = "x,p\n0,2.75\n0.1,2.1\n0.2,1.7\n0.5,1.2\n";

CheckedScenario with_table(const std::string& text) {
  CheckedScenario scenario = mdr_scenario(Configuration::simple, 50.0, 0.3, path({0.05}));
  scenario.options["pressure_table"] = std::string("p.csv");
  scenario.curves["pressure_table"] = {text, {0.0, 0.1, 0.2, 0.5}, {2.75, 2.1, 1.7, 1.2}};
  return scenario;
}

TEST(ScenarioDigest, ChangesWithTheTablesThatTheScenarioNames) {
  const std::string digest = scenario_digest(with_table(k_table));
  EXPECT_EQ(digest, scenario_digest(with_table(k_table)));
  EXPECT_NE(digest, scenario_digest(with_table(k_table + "0.6,1.1\n")));
  EXPECT_NE(digest, scenario_digest(mdr_scenario(Configuration::simple, 50.0, 0.3, path({0.05}))));
}

TEST(RunFiles, HoldTheTablesThatTheScenarioNames) {
  const TemporaryFolder folder;
  // A byte that is not UTF-8 in a comment must not cost the run.
  const std::string table = k_table + "# \xE9t\xE9\n";
  monograin::Run recorded = run_scenario(with_table(table));
  StagedFolder staged(folder.path() / "run");
  write_run(recorded, staged);
  std::ifstream in(folder.path() / "run" / "run.json");
  const auto file = nlohmann::json::parse(in).at("scenario").at("files").at("mdr.pressure_table");
  EXPECT_EQ(file.at("name"), "p.csv");
  EXPECT_TRUE(file.at("text").get<std::string>().starts_with(k_table));
}

}  // namespace
}  // namespace monograin::run_files_test
