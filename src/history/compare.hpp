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

  /// sqrt( int (b - a)^2 dx ) / int |a| dx: 001_3cd85d3b0dc520cf.txt, eq. 7, |a| added for curves that change sign.
  /// Without dimension only where x is (the source's is displacement over radius); a uniform relative error r of a
  /// straight line from 0 to x_max gives 2 r/sqrt(3 x_max).
  double area_error = 0.0;
  /// max |b - a| / |a(x_max)|, a where it first reaches its largest x (max |a| if it is zero there):
  /// 001_3cd85d3b0dc520cf.txt, eq. 8, which lacks the absolute value.
  double peak_error = 0.0;
  /// Share of the path of a, measured along x, on which b could be compared; below 1 where b ends early or is
  /// undefined.
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
/// difference where the curves share their x, and is left out (see coverage) where b is interpolated.
/// @throws std::runtime_error when the curves cannot be brought together (no common range, different number of pieces)
/// @throws std::invalid_argument when a curve has fewer or more y than x
[[nodiscard]] CurveDifference compare_curves(std::span<const double> x_a, std::span<const double> y_a,
                                             std::span<const double> x_b, std::span<const double> y_b);

/// Compares every numeric column the tables share (but x, and but the counting columns step and row), or the one named.
///
/// @param x  name or heading of a column of both; empty: the first column of a
/// @param y  name or heading of a column of both; empty: every numeric column with the same heading in both
/// @throws std::runtime_error when a column is missing, holds words or has another unit in b, when there is nothing to
/// compare, or when the curves cannot be brought together (naming the column)
[[nodiscard]] std::vector<CurveDifference> compare_tables(const Table& a, const Table& b, const std::string& x,
                                                          const std::string& y);

}  // namespace monograin
