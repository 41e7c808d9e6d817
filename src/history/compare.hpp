/// How far two curves are apart.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "history/table.hpp"

namespace monograin {

/// Error measures of curve b against curve a (the reference).
///
/// Integrals are trapezoidal sums over the points of a, taken along the path: a piece in which x decreases counts as
/// one in which it increases. Where the reference vanishes, so that there is nothing to divide by, the measure is the
/// absolute one.
struct CurveDifference {
  std::string y;         ///< heading of the compared column; empty where curves were compared
  double linf = 0.0;     ///< max |b - a| / max |a|
  double linf_at = 0.0;  ///< x where the largest difference is
  double l2 = 0.0;       ///< sqrt( int (b - a)^2 dx / int a^2 dx )

  /// sqrt( int (b - a)^2 dx ) / int |a| dx: Edmans and Sinka (n.d.), eq. 7, |a| added for curves that change sign.
  /// Without dimension only where x is (the source's is displacement over radius); a uniform relative error r of a
  /// straight line from 0 to x_max gives 2 r/sqrt(3 x_max).
  double area_error = 0.0;
  /// max |b - a| / |a(x_max)|, a where it first reaches its largest x (max |a| if it is zero there):
  /// Edmans and Sinka (n.d.), eq. 8, which lacks the absolute value.
  double peak_error = 0.0;
  /// Share of the path of a, measured along x, on which b could be compared; below 1 where b ends early, or where only
  /// one of the two is defined.
  double coverage = 1.0;
};

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

/// A column of the reference that the other table lacks, does not cover, or has with other words.
struct Gap {
  std::string column;
  std::string problem;  ///< follows the column's name in a sentence: "is missing"
};

struct Comparison {
  std::vector<CurveDifference> curves;  ///< of the columns of numbers that both tables have
  std::vector<Gap> gaps;
};

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
