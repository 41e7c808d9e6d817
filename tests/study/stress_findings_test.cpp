// Scenes that the stress test has found faulty, as small as it made them: each failed before what its first line names
// was cured.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "study/stress_checks.hpp"
#include "support/test_run.hpp"
#include "support/text_file.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

class StressFinding : public ::testing::TestWithParam<std::string> {};

std::vector<std::string> findings() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(MONOGRAIN_SOURCE_DIR "/tests/study/findings")) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool k_is_sanitized = true;
#else
constexpr bool k_is_sanitized = false;
#endif

TEST_P(StressFinding, IsCured) {
  const Scenario scenario =
      read_scenario(fs::path(MONOGRAIN_SOURCE_DIR "/tests/study/findings") / (GetParam() + ".toml"));
  StressVerdict verdict;
  if (k_is_sanitized) {
    // What the runs of a scene have to do with each other is no question of memory, and ten times as slow here.
    const monograin::Run run = run_scenario(scenario);
    verdict = {.end = stated_end(run), .violations = check_run(run)};
  } else {
    // Others may share the machine.
    verdict = check_scene(scenario, 4.0 * k_most_seconds_of_scene);
  }
  for (const Violation& violation : verdict.violations) ADD_FAILURE() << violation.check << ": " << violation.detail;
  EXPECT_FALSE(verdict.end.empty());
}

INSTANTIATE_TEST_SUITE_P(Each, StressFinding, ::testing::ValuesIn(findings()), [](const auto& tested) {
  std::string name(tested.param);
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST(StressFindings, AreListed) {
  const std::string list = read_text(MONOGRAIN_SOURCE_DIR "/tests/study/findings/README.md");
  for (const std::string& name : findings()) EXPECT_NE(list.find("| `" + name + "` |"), std::string::npos) << name;
}

TEST(StressLimits, AToleranceOfTheSizeOfRoundingIsNamed) {
  // The particle's free surface is nearly used up: the radius follows from a volume balance that hardly depends on it.
  Scenario scenario = parse_scenario(R"(model = "mdr"
particle = { radius = 1 }
material = { yield_stress = 0.1, youngs_modulus = 1, poisson_ratio = 0.2 }
mdr = { radius_rule = "yielded" }
loading = { configuration = "simple", steps = [{ displacement = 0.999, duration = 1 }] }
output = { points = 12 }
numerics = { integrator = "ida", rtol = 1e-13, atol = 1e-17 }
)",
                                     "fine.toml");
  // Whether one of them gets through is a matter of rounding.
  int failures = 0;
  for (const double yield_stress : {0.07, 0.08, 0.1, 0.12, 0.15}) {
    scenario.material["yield_stress"] = yield_stress;
    const monograin::Run fine = run_scenario(scenario);
    if (fine.record.status == RunStatus::failed) {
      ++failures;
      EXPECT_NE(fine.record.message.find("errors of the size of rounding"), std::string::npos) << fine.record.message;
      EXPECT_EQ(stated_end(fine), "tolerance of the size of rounding");
    } else {
      EXPECT_EQ(fine.record.status, RunStatus::stopped);
    }
    Scenario coarse = scenario;
    coarse.numerics.rtol = 1e-8;
    coarse.numerics.atol = 1e-12;
    EXPECT_EQ(run_scenario(coarse).record.status, RunStatus::stopped);
  }
  EXPECT_GT(failures, 0);
}

}  // namespace
}  // namespace monograin
