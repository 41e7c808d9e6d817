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

namespace monograin {
namespace {

namespace fs = std::filesystem;

class StressFinding : public ::testing::TestWithParam<std::string> {};

std::vector<std::string> findings() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(MONOGRAIN_SOURCE_DIR "/tests/study/findings")) {
    names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

TEST_P(StressFinding, IsCured) {
  const StressVerdict verdict =
      check_scene(read_scenario(fs::path(MONOGRAIN_SOURCE_DIR "/tests/study/findings") / (GetParam() + ".toml")));
  for (const Violation& violation : verdict.violations) ADD_FAILURE() << violation.check << ": " << violation.detail;
  EXPECT_FALSE(verdict.end.empty());
}

INSTANTIATE_TEST_SUITE_P(Each, StressFinding, ::testing::ValuesIn(findings()), [](const auto& tested) {
  std::string name(tested.param);
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST(StressLimits, AToleranceOfTheSizeOfRoundingIsNamed) {
  // Unloading takes place over a millionth of the displacement, and has six digits less.
  Scenario scenario = parse_scenario(R"(model = "similarity"
particle = { radius = 0.021005013872410445 }
material = { hardening_exponent = 0.5103939103980668, strength = 521149.601977224, youngs_modulus = 6717846656.881448, poisson_ratio = 0.402447275724713 }
similarity = { unloading = "mdr" }
loading = { configuration = "hydrostatic", steps = [
  { force = 6.385432627177419, duration = 0.3682729719015727 },
  { detach = true, rate = 0.15916100910715425 },
  { displacement = 0.005385541670261937, duration = 0.40101219633813107 },
  { force = 119.39290809193429, duration = 6.989828846318298 },
] }
output = { points = 12 }
numerics = { integrator = "ida", rtol = 9.285146352217831e-13, atol = 9.285146352217832e-17 }
)",
                                     "fine.toml");
  const monograin::Run fine = run_scenario(scenario);
  EXPECT_EQ(fine.record.status, RunStatus::failed);
  EXPECT_NE(fine.record.message.find("too much work"), std::string::npos) << fine.record.message;
  EXPECT_NE(fine.record.message.find("errors of the size of rounding"), std::string::npos) << fine.record.message;
  EXPECT_EQ(stated_end(fine), "tolerance of the size of rounding");
  scenario.numerics.rtol = 1e-8;
  scenario.numerics.atol = 1e-12;
  EXPECT_EQ(run_scenario(scenario).record.status, RunStatus::complete);
}

}  // namespace
}  // namespace monograin
