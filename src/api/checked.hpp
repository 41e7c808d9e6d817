/// Conversion of a user's Scenario to the CheckedScenario of the rooms.
#pragma once

#include <string>
#include <vector>

#include "monograin/scenario.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// Parses and checks a scenario, except walls and their programs, which make_scene() checks.
/// @throws ScenarioError with all faults that it finds
[[nodiscard]] CheckedScenario checked(const Scenario& scenario);

/// Appends a `key=value` text to overrides, in place of an earlier one of the same key where no other one lies between
/// whose effect depends on it.
void append_override(std::vector<std::string>& overrides, std::string text);

}  // namespace monograin
