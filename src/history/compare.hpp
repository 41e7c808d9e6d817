/// How far two curves are apart.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "history/table.hpp"
#include "monograin/comparison.hpp"

namespace monograin {

/// Compares y over x. Curves that share their x values row by row are compared there; otherwise b is interpolated
/// linearly at the x of a, piece by piece where x turns back (loading, unloading, ...).
///
/// Rows that share one x are a jump: the first is its left limit, the last its right one, rows between take no part.
/// A jump of b within 1e-6 of the range of x is taken for the same jump, and left is compared with left, right with
/// right. Beyond the ends of b (by more than that share) nothing is compared.
///
/// An undefined value (nan) matches an undefined one. A value that is undefined in one curve only is an infinite
/// difference where both have a row, and is not covered where b is interpolated.
/// @throws std::runtime_error when the curves cannot be brought together (no common range, different number of pieces)
/// @throws std::invalid_argument when a curve has fewer or more y than x
[[nodiscard]] CurveDifference compare_curves(std::span<const double> x_a, std::span<const double> y_a,
                                             std::span<const double> x_b, std::span<const double> y_b);

/// Share of the reference below which a curve does not cover it: events at its ends may be a rounding error apart.
inline constexpr double k_least_coverage = 0.999;

/// Compares every column of table a (the reference) but x and the counting columns step and row, or the one named.
/// Words are compared row by row where the tables share their x, otherwise by the order in which they follow each
/// other.
///
/// @param x  name or heading of a column of a; empty: the first column
/// @param y  name or heading of a column of a; empty: every column
/// @throws std::runtime_error when a does not have these columns
[[nodiscard]] Comparison compare_tables(const Table& a, const Table& b, const std::string& x, const std::string& y);

/// Compares the events of two runs: their names and classes in their order, and their times as one curve over their
/// number, called "event time[s]".
/// @throws std::runtime_error when a has no columns time, class and event
[[nodiscard]] Comparison compare_events(const Table& a, const Table& b);

}  // namespace monograin
