/// Conversions between the public interface and the rooms, and checks that its parts share.
#pragma once

#include <string>
#include <vector>

#include "history/table.hpp"
#include "monograin/history.hpp"
#include "monograin/scenario.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// Parses and checks a scenario, except walls and their programs, which make_scene() checks.
/// @throws ScenarioError with all faults that it finds
[[nodiscard]] CheckedScenario checked(const Scenario& scenario);

/// A table that nobody changes any more, as columns.
[[nodiscard]] History history_of(Table table);

/// @throws std::invalid_argument for a negative number of threads
void check_threads(int threads);

/// Adds a `key=value` text to overrides. It replaces the one of the same key, unless a later one sets a table with this
/// key or a key in its value: the new text is then the last one.
void set_override(std::vector<std::string>& overrides, std::string text);

}  // namespace monograin
