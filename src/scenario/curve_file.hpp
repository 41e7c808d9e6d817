/// Curves that a scenario takes from a table file.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "catalogue.hpp"
#include "scenario/faults.hpp"
#include "scenario/scenario.hpp"
#include "scenario/text_file.hpp"

namespace monograin {

inline constexpr std::size_t k_largest_table = 1024U * 1024U;  ///< [byte]
inline constexpr std::size_t k_least_samples = 4;
inline constexpr double k_greatest_sample = 1e9;
inline constexpr double k_least_sample = 1e-9;  ///< of y, and of the distance between two x

/// Checks the text of a table: two columns of numbers below one row of headings, x ascending from 0, y positive. Lines
/// that begin with '#' and blank lines do not count.
///
/// What comes back is only meaningful if nothing was added to `faults`.
/// @param origin  the file's name in faults, which bear the places in the table
[[nodiscard]] SampledCurve parse_curve(std::string_view text, const std::string& origin, FaultList& faults);

/// Checks the text of a table from which columns are taken by their headings, each number in its column's range and no
/// two rows with the same x and y, which are the first two columns.
/// @param named_at, naming  as of take_curve
[[nodiscard]] SampledCurve parse_columns(std::string_view text, const std::string& origin,
                                         std::span<const QuantityKey> columns, const SourceLocation& named_at,
                                         std::string_view naming, FaultList& faults);

/// A curve, or the columns of a table, from a file's text. Where it could not be read, the fault is at the place that
/// names it.
/// @param file      what read_text_file gave, with `largest` = k_largest_table
/// @param columns   empty: a curve
/// @param named_at  place of the file's name in the scenario
/// @param naming    that place as it is written: `pressure_table = "file.csv"`
[[nodiscard]] SampledCurve take_curve(const FileText& file, const std::string& name,
                                      std::span<const QuantityKey> columns, const SourceLocation& named_at,
                                      std::string_view naming, FaultList& faults);

}  // namespace monograin
