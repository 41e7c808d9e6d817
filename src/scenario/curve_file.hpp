/// Curves that a scenario takes from a table file.
#pragma once

#include <filesystem>
#include <string_view>

#include "scenario/faults.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

inline constexpr std::size_t k_least_samples = 4;
inline constexpr double k_greatest_sample = 1e9;
inline constexpr double k_least_sample = 1e-9;  ///< of y, and of the distance between two x

/// Checks the text of a table: two columns of numbers below one row of headings, x ascending from 0, y positive. Lines
/// that begin with '#' and blank lines do not count.
///
/// What comes back is only meaningful if nothing was added to `faults`.
/// @param origin  the file's name in faults, which bear the places in the table
[[nodiscard]] SampledCurve parse_curve(std::string_view text, const std::string& origin, FaultList& faults);

/// The same from a file. Where it cannot be read, the fault is at the place that names it.
/// @param named_at  place of the file's name in the scenario
/// @param naming    that place as it is written: `pressure_table = "file.csv"`
[[nodiscard]] SampledCurve read_curve(const std::filesystem::path& file, const SourceLocation& named_at,
                                      std::string_view naming, FaultList& faults);

}  // namespace monograin
