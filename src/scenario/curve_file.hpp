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
inline constexpr double k_least_sample = 1e-9;  ///< of y, and of the distance between two consecutive x

/// Checks the text of a table: two columns of numbers below one row of headings, x ascending from 0, y positive. Lines
/// that begin with '#' and blank lines do not count.
///
/// The result is only meaningful if nothing was added to `faults`.
/// @param origin  the file's name in faults; their positions are those in the table
[[nodiscard]] SampledCurve parse_curve(std::string_view text, const std::string& origin, FaultList& faults);

/// Checks the text of a table whose columns are selected by their headings. Every number has to lie in its column's
/// range, and no two rows may have equal x and y, the first two columns.
/// @param named_at, naming  see take_curve
[[nodiscard]] SampledCurve parse_columns(std::string_view text, const std::string& origin,
                                         std::span<const QuantityKey> columns, const SourceLocation& named_at,
                                         std::string_view naming, FaultList& faults);

/// Reads a curve, or the columns of a table, from a file's text. If the file could not be read, reports that at the
/// position that names the file.
/// @param file      result of read_text_file with `largest` = k_largest_table
/// @param columns   empty: a curve
/// @param named_at  position of the file's name in the scenario
/// @param naming    the key and the name as they are written: `pressure_table = "file.csv"`
[[nodiscard]] SampledCurve take_curve(const FileText& file, const std::string& name,
                                      std::span<const QuantityKey> columns, const SourceLocation& named_at,
                                      std::string_view naming, FaultList& faults);

}  // namespace monograin
