// Scenes that the stress test has found faulty, as small as it made them: each failed before what its first line names
// was cured.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "support/test_run.hpp"
#include "support/text_file.hpp"
#include "verify/stress/check/checks.hpp"

namespace monograin::stress_findings_test {
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

/// Rules that a scene is known to break still: in its line "# open: rule, rule".
std::set<std::string> open_rules(const std::string& text) {
  std::set<std::string> rules;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("# open: ")) continue;
    std::istringstream words(line.substr(8));
    for (std::string word; std::getline(words >> std::ws, word, ',');) rules.insert(word);
  }
  return rules;
}

TEST_P(StressFinding, IsCured) {
  const Scenario scenario =
      read_scenario(fs::path(MONOGRAIN_SOURCE_DIR "/tests/study/findings") / (GetParam() + ".toml"));
  StressVerdict verdict;
  if (k_is_sanitized) {
    // What the runs of a scene have to do with each other is no question of memory, and ten times as slow here.
    const monograin::Run run = run_scenario(scenario);
    verdict = {.end = stated_end(run), .violations = check_run(run)};
  } else {
    // Others may share the machine; and one kind of copy is enough for what has been cured.
    verdict = check_scene(scenario, {.seconds = 4.0 * most_seconds_of(scenario), .copies = 0});
  }
  const std::set<std::string> open = open_rules(scenario.text);
  for (const Violation& violation : verdict.violations) {
    if (!open.contains(violation.check)) ADD_FAILURE() << violation.check << ": " << violation.detail;
  }
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
  // Where forces end, states answer to their rounding without bound. Whether one of them gets through is a matter of
  // that.
  int failures = 0;
  for (const char* name : {"force-that-ends-where-it-turned", "place-a-force-has-led-to", "held-by-what-has-just-begun",
                           "forces-that-end-in-balance"}) {
    Scenario scenario = read_scenario(MONOGRAIN_SOURCE_DIR "/tests/study/findings/" + std::string(name) + ".toml");
    scenario.numerics.integrator = "ida";
    scenario.numerics.rtol = 1e-13;
    scenario.numerics.atol = 1e-17;
    const monograin::Run fine = run_scenario(scenario);
    if (fine.record.status == RunStatus::failed) {
      ++failures;
      EXPECT_NE(fine.record.message.find("errors of the size of rounding"), std::string::npos) << fine.record.message;
      EXPECT_EQ(stated_end(fine), "tolerance of round-off");
    }
    scenario.numerics.rtol = 1e-8;
    scenario.numerics.atol = 1e-12;
    EXPECT_NE(run_scenario(scenario).record.status, RunStatus::failed) << name;
  }
  EXPECT_GT(failures, 0);
}

}  // namespace
}  // namespace monograin::stress_findings_test
