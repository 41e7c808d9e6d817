/// Pressure and surface under the contacts of a run at one instant.
#pragma once

#include <filesystem>
#include <string>

#include "history/table.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// Runs a scenario up to an instant.
/// @param time  [s], within the run
/// @return columns class, radius[m], pressure[Pa], displacement[m], relaxed_height[m]: one row per class and point,
///         none of contacts that are open then
/// @throws std::runtime_error where the model has no profile, the run does not come to that instant, or no contact is
/// closed then
[[nodiscard]] Table contact_profiles(const CheckedScenario& scenario, double time);

/// Draws them: pressure over the yield stress where there is one, and the surface, loaded and relaxed. Beside the
/// figure stand its script and data, and the table as CSV.
/// @param output  the figure; its extension picks the format
/// @return the CSV file
std::filesystem::path draw_profiles(const Table& profiles, const std::filesystem::path& output);

}  // namespace monograin
