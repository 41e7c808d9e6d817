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

/// Adds a `key=value` text to overrides. It replaces the one of the same key, unless a later one sets a table with this
/// key or a key in its value: the new text is then the last one.
void set_override(std::vector<std::string>& overrides, std::string text);

}  // namespace monograin
