/// Turns of a measured curve, whose x may have noise: the rows at which x turns, and where it turns between them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace monograin {

/// Rows at which x turns, with the first and the last row. Between them x is monotone apart from noise.
///
/// Paths of at most two rows between turns are noise if there are at least three of them. A turn counts then if x comes
/// back by more than nine times noise_in(), and by more than 0.2 % of its range. Without noise every turn counts, but
/// for paths of at most two rows and at most 0.2 % of the range.
[[nodiscard]] std::vector<std::size_t> turning_points(std::span<const double> x);

/// Standard deviation of the noise of x: from the median of its second differences, which a ramp does not have, but not
/// more than the longest path of at most two rows between turns, because uneven steps have second differences, too. If
/// most rows are equal to the one before, as those of a display with few digits are, the median of these paths takes
/// the place of that of the differences. 0 if there are fewer than three such paths.
[[nodiscard]] double noise_in(std::span<const double> x);

/// Point at which x turns, or begins or ends.
struct Turn {
  std::size_t last_row = 0;  ///< of the branch that ends there
  double x = 0.0;
  bool is_known = true;        ///< false: x may turn farther on, between the extreme row and the one beside it
  std::size_t held_begin = 0;  ///< rows in which x is held at the turn: the first one, and the one after the last
  std::size_t held_end = 0;

  [[nodiscard]] std::size_t held_rows() const noexcept { return held_end - held_begin; }
};

/// Row and x of each turn. The extreme row alone shows neither: with noise, it is the row with the largest error;
/// without, rows at equal times miss the extreme, which lies between two of them. The first and the last row have their
/// own x.
///
/// In noise, a segmented regression of x over the row finds the turn: the two straight lines with the least sum of
/// squared distances from all rows near the turn, which meet there. Three lines, the middle one level, replace them if
/// x is held at the turn, which then lies at the mean of the hold. A hold has at least five rows; the F test must
/// accept it, its slope must not be significant, and its mean must be as near to the extreme x as noise alone would put
/// it. Where the rows are far from such lines, half or a quarter of the path beside the turn shows where it is.
///
/// Without noise, the turn is the intersection of the lines through three rows in equal steps on each side. If steps
/// are not equal, x turns in the extreme row, and equal rows are a hold.
/// @param points  turning_points() of x
[[nodiscard]] std::vector<Turn> turns_of(std::span<const double> x, std::span<const std::size_t> points);

}  // namespace monograin
