/// Pressure and surface under the contacts of a run at one instant.
#pragma once

#include "history/run.hpp"
#include "history/table.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// Runs a scenario up to an instant.
/// @param time     [s], within the run; at an event, the state just before it counts
/// @param wrapped  if given, wraps the system of the scene before the run
/// @return columns class, radius[m], pressure[Pa], displacement[m], relaxed_height[m]: one row per class and point,
/// without contacts that are open at that instant
/// @throws std::runtime_error if the model has no profile, the instant is not finite or negative, the run does not
/// reach it, or no contact is closed then
[[nodiscard]] Table contact_profiles(const CheckedScenario& scenario, double time, const SystemWrapper& wrapped = {});

}  // namespace monograin
