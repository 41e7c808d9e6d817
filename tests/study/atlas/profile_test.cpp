#include "study/atlas/profile.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "history/profile.hpp"
#include "history/run_files.hpp"
#include "support/temporary_folder.hpp"

namespace monograin {
namespace {

TEST(ContactProfiles, AreDrawnFromARunThatBringsItsScenarioAlong) {
  const TemporaryFolder folder;
  CheckedScenario scenario = parse_scenario(default_scenario_text(), "die.toml", {"output.points=3"});
  monograin::Run recorded = run_scenario(scenario);
  StagedFolder staged(folder.path() / "die");
  write_run(recorded, staged);
  const CheckedScenario again = scenario_of_run(folder.path() / "die");
  EXPECT_EQ(again.text, scenario.text);
  EXPECT_EQ(scenario_digest(again), scenario_digest(scenario));
  const auto csv = draw_profiles(contact_profiles(again, 0.8), folder.path() / "profile.svg");
  EXPECT_EQ(csv, folder.path() / "profile.csv");
  EXPECT_GT(read_csv(csv).row_count(), 400u);  // axial and lateral
  for (const char* name : {"profile.svg", "profile.gp", "profile.dat"}) {
    EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
  }
}

}  // namespace
}  // namespace monograin
