/// The scenario that a file of a study names or contains. For readers of TOML files: includes the library.
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
  CheckedScenario checked;
  std::string text;      ///< its own
  std::string file;      ///< where it stands
  std::string document;  ///< of which it is the table `scenario`; empty: it has a file of its own

  /// @throws ScenarioError with every fault of the text and the overrides
  [[nodiscard]] CheckedScenario with(const std::vector<std::string>& overrides) const;

  /// With the overrides, for other numbers.
  [[nodiscard]] std::shared_ptr<const ScenarioTemplate> variants(const std::vector<std::string>& overrides) const;
};

/// The scenario of a study; none, and faults, where there is none or it is at fault.
/// @param text, file  of the study
[[nodiscard]] std::optional<NamedScenario> scenario_in(Reading& reading, const Section& root, bool is_table,
                                                       const std::string& text, const std::string& file);

}  // namespace monograin::calibration
