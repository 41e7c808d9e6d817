/// Scenarios and runs as Python holds them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "history/run.hpp"
#include "table.hpp"

namespace monograin::python {

/// A checked scenario and the name it was read under.
struct NamedScenario {
  Scenario scenario;
  std::string origin;       ///< file name in messages; files that the scenario names are sought beside it
  double parse_time = 0.0;  ///< [s]

  /// @throws ScenarioError with every fault
  [[nodiscard]] static NamedScenario parse(const std::string& text, const std::string& origin,
                                           const std::vector<std::string>& overrides);
  /// @throws ScenarioError with every fault
  [[nodiscard]] static NamedScenario read(const std::string& file, const std::vector<std::string>& overrides);
};

/// A run whose tables may outlive it.
struct SharedRun {
  std::shared_ptr<Run> run;
  std::shared_ptr<TableView> history;
  std::shared_ptr<TableView> events;

  explicit SharedRun(Run result);
};

}  // namespace monograin::python
