/// Conversion of a user's Scenario to the CheckedScenario of the rooms.
#pragma once

#include "monograin/scenario.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// Parses and checks a scenario, except walls and their programs, which make_scene() checks.
/// @throws ScenarioError with all faults that it finds
[[nodiscard]] CheckedScenario checked(const Scenario& scenario);

}  // namespace monograin
