/// Comparison of curves and tables: error measures, missing columns, events.
#pragma once

#include <span>
#include <string>

#include "history/table.hpp"
#include "monograin/comparison.hpp"

namespace monograin {

/// Compares curve b with the reference a, as y over x. If both have the same x in every row, rows are compared with
/// rows. Otherwise b is interpolated linearly at the x of a, piece by piece between reversals of x.
///
/// Consecutive rows with one x are a jump: the first row is its left limit, the last row its right limit, and rows
/// between are ignored. A jump of b within 1e-6 of the range of x counts as the jump of a, and limits are compared with
/// limits of the same side. Rows of a farther than that beyond the ends of b are not compared.
///
/// Two undefined values (NaN) agree. A value that is undefined in one curve only is an infinite difference if both
/// curves have a row there, and lowers the coverage if b is interpolated there.
/// @throws std::runtime_error if the curves cannot be matched (no common range, different number of pieces)
/// @throws std::invalid_argument if x and y of a curve differ in length
[[nodiscard]] CurveDifference compare_curves(std::span<const double> x_a, std::span<const double> y_a,
                                             std::span<const double> x_b, std::span<const double> y_b);

/// Least coverage of a complete curve. It is below 1 because events that end two curves may differ by round-off.
inline constexpr double k_least_coverage = 0.999;

/// Compares columns of table b with those of the reference a. Columns of words are compared row by row if the tables
/// have the same x in every row, otherwise by the order of their words. A column that cannot be compared becomes a gap.
///
/// The area error of compare_curves() depends on the unit of x. Here a length x counts in units of R0, if the header of
/// a has it, and any other x with a unit in units of its range.
///
/// @param x  name or heading of a column of a, the abscissa; empty: the first column
/// @param y  name or heading of a column of a; empty: every column except x, step and row
/// @throws std::runtime_error if a lacks these columns, or x holds words
[[nodiscard]] Comparison compare_tables(const Table& a, const Table& b, const std::string& x, const std::string& y);

/// Compares the events of two runs, b with the reference a: their names and contact classes in order, and their times
/// as a curve "event time[s]" over the number of the event.
/// @throws std::runtime_error if a lacks the columns time, class and event
[[nodiscard]] Comparison compare_events(const Table& a, const Table& b);

}  // namespace monograin
