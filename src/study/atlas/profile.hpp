/// Pressure and surface under the contacts of a run at one instant.
#pragma once

#include <filesystem>

#include "history/table.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// Runs a scenario up to an instant.
/// @param time  [s], within the run
/// @return columns class, radius[m], pressure[Pa], displacement[m], relaxed_height[m]: one row per class and point,
/// without contacts that are open at that instant
/// @throws std::runtime_error if the model has no profile, the run does not reach the instant, or no contact is closed
/// then
[[nodiscard]] Table contact_profiles(const CheckedScenario& scenario, double time);

/// Draws profiles: pressure, over the yield stress if there is one, and the surface, loaded and relaxed. Writes the
/// script, the data, and the table as CSV beside the figure.
/// @param output  the figure; its extension determines the format
/// @return the CSV file
std::filesystem::path draw_profiles(const Table& profiles, const std::filesystem::path& output);

}  // namespace monograin
