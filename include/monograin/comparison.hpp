/// Comparison of histories: error measures between curves.
#pragma once

#include <string>
#include <vector>

namespace monograin {

class History;

/// Error measures of curve b against curve a (the reference).
///
/// Integrals are trapezoidal sums over the points of a along its path: a piece in which x decreases counts as much as a
/// piece in which x increases. A measure whose denominator is zero is not divided: linf and peak_error are then in
/// units of y, l2 and area_error in units of the root of the integral.
struct CurveDifference {
  std::string y;         ///< heading of the compared column; empty where curves were compared
  double linf = 0.0;     ///< max |b - a| / max |a|
  double linf_at = 0.0;  ///< x of the largest difference
  double l2 = 0.0;       ///< sqrt( int (b - a)^2 dx / int a^2 dx )

  /// sqrt( int (b - a)^2 dx ) / int |a| dx: Edmans and Sinka (n.d.), eq. 7, |a| added for curves that change sign.
  /// Dimensionless only if x is; compare() takes a length over R0, as the source does, if the file of a has R0 in its
  /// header, and any other x with a unit over its range. A uniform relative error r of a straight line from 0 to x_max
  /// gives 2 r/sqrt(3 x_max).
  double area_error = 0.0;
  /// max |b - a| / |a(x_max)|, where x_max is the largest x and a its value when x_max is first reached (max |a| if
  /// that value is zero): Edmans and Sinka (n.d.), eq. 8, which lacks the absolute value.
  double peak_error = 0.0;
  /// Share of the path of a, measured along x, on which b could be compared. Below 1 if b ends early, or if only one of
  /// the curves is defined on a part.
  double coverage = 1.0;
};

/// A column of the reference that could not be compared, or whose words differ in the other table.
struct Gap {
  std::string column;
  std::string problem;  ///< follows the column's name in a sentence: "is missing"
};

/// Result of compare(): error measures of each column, and the columns that differ in kind.
struct Comparison {
  std::vector<CurveDifference> curves;  ///< one for each column of numbers that both tables have
  std::vector<Gap> gaps;                ///< empty: every column could be compared, and all words agree
};

/// Compares the columns of two histories, as `monograin compare` does.
///
/// Curves without a common range of x, or that turn back a different number of times, become a gap of their column.
///
/// @param reference  history of the curves a; its columns step and row are not compared
/// @param other  history of the curves b
/// @param x  name or heading of a column of the reference, the abscissa; empty: the first column
/// @param y  name or heading of a column of the reference; empty: every column
/// @throws std::runtime_error if the reference lacks column x or y, or has no other column than x, or if x holds words
[[nodiscard]] Comparison compare(const History& reference, const History& other, const std::string& x = {},
                                 const std::string& y = {});

}  // namespace monograin
