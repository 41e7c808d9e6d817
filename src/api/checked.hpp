/// From what users have to what the rooms work with.
#pragma once

#include "monograin/scenario.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// @throws ScenarioError with all faults
[[nodiscard]] CheckedScenario checked(const Scenario& scenario);

}  // namespace monograin
