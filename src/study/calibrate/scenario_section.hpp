/// The scenario that a study's file names or contains. For readers of TOML files: includes the library.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "scenario/section.hpp"

namespace monograin::calibration {

/// A scenario that can be read again with overrides.
struct NamedScenario {
  CheckedScenario checked{};
  std::string text{};    ///< text of the scenario
  std::string file;      ///< file that contains the text
  std::string document;  ///< text whose table `scenario` it is; empty: the scenario has a file of its own

  /// @throws ScenarioError with every fault of the text and the overrides
  [[nodiscard]] CheckedScenario with(const std::vector<std::string>& overrides) const;

  /// Template of the scenario with overrides, for runs with other numbers.
  [[nodiscard]] std::shared_ptr<const ScenarioTemplate> variants(const std::vector<std::string>& overrides) const;
};

/// The scenario of a study; none, with faults, if there is none or it has faults.
/// @param text, file  of the study
[[nodiscard]] std::optional<NamedScenario> scenario_in(Reading& reading, const Section& root, bool is_table,
                                                       const std::string& text, const std::string& file);

}  // namespace monograin::calibration
