// Runs the findings: small scenes that the stress test has found faulty (tests/findings/README.md).
// Quick/StressFinding belongs to the ordinary suite; Full/StressFinding runs on request, as it takes minutes.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.hpp"
#include "support/test_run.hpp"
#include "support/text_file.hpp"
#include "verify/stress/check/checks.hpp"

namespace monograin::findings_test {
namespace {

namespace fs = std::filesystem;

const fs::path k_folder = MONOGRAIN_SOURCE_DIR "/tests/findings";
constexpr std::array<std::string_view, 9> k_groups = {"alternating-regimes", "false-alarm", "false-end",
                                                      "missed-event",        "no-progress", "not-invariant",
                                                      "passed-limit",        "wrong-state", "wrong-work"};

/// Lines of the comment that begins a file, without "# ".
std::vector<std::string> header_lines(const std::string& text) {
  std::vector<std::string> header;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line) && line.starts_with("# ");) header.push_back(line.substr(2));
  return header;
}

/// The rest of the header line that begins with `key` and a colon; empty without such a line.
std::string header_value(const std::vector<std::string>& header, const std::string& key) {
  const std::string begin = key + ": ";
  const auto line = std::ranges::find_if(header, [&](const std::string& l) { return l.starts_with(begin); });
  return line == header.end() ? std::string() : line->substr(begin.size());
}

/// All findings as model/group/name, sorted.
std::vector<std::string> findings() {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(k_folder)) {
    if (entry.path().extension() != ".toml") continue;
    names.push_back(entry.path().lexically_relative(k_folder).replace_extension().generic_string());
  }
  std::ranges::sort(names);
  return names;
}

std::string text_of(const std::string& finding) { return read_text(k_folder / (finding + ".toml")); }

/// Findings of the ordinary suite, or all others: one with an unknown suite word runs in the full suite.
std::vector<std::string> findings_of_suite(bool is_quick) {
  std::vector<std::string> names = findings();
  std::erase_if(names, [&](const std::string& name) {
    return (header_value(header_lines(text_of(name)), "suite") == "quick") != is_quick;
  });
  return names;
}

class StressFinding : public ::testing::TestWithParam<std::string> {};

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool k_is_sanitized = true;
#else
constexpr bool k_is_sanitized = false;
#endif

/// Rules that a scene is known to break still: in its line "# open: rule, rule".
std::set<std::string> open_rules(const std::string& text) {
  std::set<std::string> rules;
  std::istringstream words(header_value(header_lines(text), "open"));
  for (std::string word; std::getline(words >> std::ws, word, ',');) rules.insert(word);
  return rules;
}

TEST_P(StressFinding, IsCured) {
  const CheckedScenario scenario = read_scenario(k_folder / (GetParam() + ".toml"));
  StressVerdict verdict;
  if (k_is_sanitized) {
    // How the runs of a scene compare is no question of memory, and takes ten times as long here.
    const monograin::Run run = run_scenario(scenario);
    verdict = {.end = stated_end(run), .violations = check_run(run)};
  } else {
    // Others may share the machine. The ordinary suite compares all copies where a copy has differed, else one of them.
    const bool is_quick = header_value(header_lines(scenario.text), "suite") == "quick";
    const bool has_differed = GetParam().find("/not-invariant/") != std::string::npos;
    verdict = check_scene(scenario, {.seconds = 4.0 * most_seconds_of(scenario),
                                     .copies = is_quick && !has_differed ? 0 : StressEffort::k_all_copies});
  }
  const std::set<std::string> open = open_rules(scenario.text);
  for (const Violation& violation : verdict.violations) {
    if (!open.contains(violation.check)) ADD_FAILURE() << violation.check << ": " << violation.detail;
  }
  EXPECT_FALSE(verdict.is_cut_short);
  // A scene that breaks a rule may end otherwise, too.
  const std::string end = header_value(header_lines(scenario.text), "end");
  if (open.empty()) {
    EXPECT_EQ(verdict.end, end.empty() ? "complete" : end);
  }
}

std::string test_name(const ::testing::TestParamInfo<std::string>& tested) {
  std::string name(tested.param);
  std::ranges::replace_if(
      name, [](char c) { return c == '-' || c == '/'; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Quick, StressFinding, ::testing::ValuesIn(findings_of_suite(true)), test_name);
INSTANTIATE_TEST_SUITE_P(Full, StressFinding, ::testing::ValuesIn(findings_of_suite(false)), test_name);

TEST(StressFindings, BeginWithAHeader) {
  for (const std::string& name : findings()) {
    SCOPED_TRACE(name);
    const std::vector<std::string> header = header_lines(text_of(name));
    const std::string suite = header_value(header, "suite");
    EXPECT_TRUE(suite == "quick" || suite == "full") << "unknown suite: '" << suite << "'";
    for (const char* key : {"Symptom", "Cause", "Mend"}) {
      EXPECT_FALSE(header_value(header, key).empty()) << "no line '# " << key << ": ...'";
    }
  }
}

TEST(StressFindings, StandInTheFolderOfTheirModelAndSymptom) {
  for (const std::string& name : findings()) {
    SCOPED_TRACE(name);
    const fs::path path(name);
    const std::vector<std::string> parts(path.begin(), path.end());
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_NE(text_of(name).find("\nmodel = \"" + parts[0] + "\"\n"), std::string::npos);
    EXPECT_NE(std::ranges::find(k_groups, parts[1]), k_groups.end()) << "unknown symptom group";
  }
}

TEST(StressFindings, HaveAQuickOneInEveryFolder) {
  std::map<fs::path, bool> has_quick;
  for (const std::string& name : findings()) {
    has_quick[fs::path(name).parent_path()] |= header_value(header_lines(text_of(name)), "suite") == "quick";
  }
  for (const auto& [folder, quick] : has_quick) EXPECT_TRUE(quick) << folder;
}

TEST(StressLimits, AToleranceOfTheSizeOfRoundOffIsNamed) {
  // Where forces end, the error of a state from its round-off is unbounded: round-off decides which of these fail.
  int failures = 0;
  for (const char* name :
       {"semimech/missed-event/force-that-ends-where-it-turned", "semimech/not-invariant/position-after-a-force",
        "nonlocal/false-end/support-by-a-contact-that-has-just-begun",
        "nonlocal/false-end/forces-that-end-in-balance"}) {
    CheckedScenario scenario = read_scenario(k_folder / (std::string(name) + ".toml"));
    scenario.numerics.integrator = "ida";
    scenario.numerics.rtol = 1e-13;
    scenario.numerics.atol = 1e-17;
    const monograin::Run fine = run_scenario(scenario);
    if (fine.record.status == RunStatus::failed) {
      ++failures;
      EXPECT_NE(fine.record.message.find("errors of the size of round-off"), std::string::npos) << fine.record.message;
      EXPECT_EQ(stated_end(fine), "tolerance of round-off");
    }
    scenario.numerics.rtol = 1e-8;
    scenario.numerics.atol = 1e-12;
    EXPECT_NE(run_scenario(scenario).record.status, RunStatus::failed) << name;
  }
  EXPECT_GT(failures, 0);
}

}  // namespace
}  // namespace monograin::findings_test
