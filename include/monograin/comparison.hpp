/// How far two curves are apart.
#pragma once

#include <string>
#include <vector>

namespace monograin {

class History;

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

/// A column of the reference that the other table lacks, does not cover, or has with other words.
struct Gap {
  std::string column;
  std::string problem;  ///< follows the column's name in a sentence: "is missing"
};

struct Comparison {
  std::vector<CurveDifference> curves;  ///< of the columns of numbers that both tables have
  std::vector<Gap> gaps;
};

/// Compares the columns of two histories; `monograin compare` prints the same.
///
/// @param reference  a; columns step and row are not compared
/// @param x  name or heading of a column of a; empty: the first column
/// @param y  name or heading of a column of a; empty: every column
/// @throws std::runtime_error where a does not have these columns, or the curves cannot be brought together
[[nodiscard]] Comparison compare(const History& reference, const History& other, const std::string& x = {},
                                 const std::string& y = {});

}  // namespace monograin
