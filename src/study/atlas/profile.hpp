/// Figures of pressure and surface under contacts.
#pragma once

#include <filesystem>

#include "history/table.hpp"

namespace monograin {

/// Draws profiles (history/profile.hpp): pressure, over the yield stress if there is one, and the surface, loaded and
/// relaxed. Writes the script, the data, and the table as CSV beside the figure.
/// @param output  the figure; its extension determines the format
/// @return the CSV file
std::filesystem::path draw_profiles(const Table& profiles, const std::filesystem::path& output);

}  // namespace monograin
