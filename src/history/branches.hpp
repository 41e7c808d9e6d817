/// Decomposition of load-unload curves into first loading, unloadings and reloadings, and their comparison.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "history/compare.hpp"
#include "system/resolution.hpp"

namespace monograin {

/// A curve by its points: x and y have the same length. Usually displacement and force.
struct XyCurve {
  std::vector<double> x;
  std::vector<double> y;
};

/// First loading: the rows in which x exceeds all earlier x. Unloading, reloading and undefined rows are left out.
[[nodiscard]] XyCurve first_loading(const XyCurve& curve);

/// Unloadings: the paths along which x falls from its largest value so far, each with the row of the reversal. A path
/// that falls from a smaller x, during an incomplete reload, is not an unloading.
[[nodiscard]] std::vector<XyCurve> unloadings(const XyCurve& curve);

/// An unloading from the largest x so far, and the reloading that follows it.
struct Excursion {
  XyCurve back;     ///< unloading, from the row of the reversal; x falls
  XyCurve forth{};  ///< reloading, from the last row of `back` until x reaches its largest value again, or falls again
};
/// Unloadings from the largest x so far, each with its reloading.
[[nodiscard]] std::vector<Excursion> excursions(const XyCurve& curve);

/// Rows at which x turns, with the first and the last row. Between them x is monotone apart from noise.
///
/// Paths of at most two rows between turns are noise if there are at least three of them. A turn counts then if x comes
/// back by more than nine times noise_in(), and by more than 0.2 % of its range. Without noise every turn counts, but
/// for paths of at most two rows and at most 0.2 % of the range.
[[nodiscard]] std::vector<std::size_t> turning_points(std::span<const double> x);

/// Standard deviation of the noise of x: from the median of its second differences, which a ramp does not have, but not
/// more than the longest path of at most two rows between turns, because uneven steps have second differences, too. If
/// most rows are equal to the one before, as those of a display with few digits are, the median of these paths takes
/// the place of that of the differences. 0 if there are less than three such paths.
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

/// The turns of a curve whose rows are few, or have noise. x turns where straight lines through the rows of both sides
/// meet, because the extreme row has the largest noise, and because x of rows at equal times is farthest between two of
/// them. If x is held there, it turns at the mean of the hold: at least five rows at constant x between the two lines,
/// if that fits the rows better than the lines alone by more than noise would, if their slope is not significant, and
/// if their mean is as near to the extreme x as that of noise. Where the rows are far from such lines, half or a
/// quarter of the path beside the turn shows where it is. Without noise the lines need at least three rows in equal
/// steps on each side; otherwise x turns in the extreme row, and equal rows are a hold. The first and the last row have
/// their own x.
/// @param points  turning_points() of x
[[nodiscard]] std::vector<Turn> turns_of(std::span<const double> x, std::span<const std::size_t> points);

/// Mean slope dy/dx of the first part of an unloading, over which y falls by 5 %; of the whole unloading if y falls by
/// less.
[[nodiscard]] double unloading_slope(const XyCurve& unloading);

/// x at which y vanishes on an unloading; NaN if it does not vanish. Between the last row with y > 0 and the next one,
/// y is assumed to fall with the power 3/2 of the distance from its zero, as the force of an elastic contact does.
[[nodiscard]] double residual_displacement(const XyCurve& unloading);

/// One line of a comparison. compare_branches() makes a line for the first loading up to a reversal and the unloading
/// from it, compare_bands() for a band of x. A measure that does not belong to the line is NaN.
struct BranchComparison {
  double reversal = 0.0;  ///< x of the reversal of the reference, of the end of its loading, or of the end of the band
  double area_error = 0.0;  ///< CurveDifference::area_error of the loading up to there
  double peak_error = 0.0;  ///< CurveDifference::peak_error of the loading up to there
  double coverage = 1.0;    ///< share of the reference's loading on which the curve could be compared
  double slope = 0.0;       ///< slope of the curve's unloading
  double reference_slope = 0.0;
  double residual = 0.0;  ///< x at which the force of the curve's unloading vanishes
  double reference_residual = 0.0;
  double largest = k_nan;  ///< largest |curve - reference|/|reference| on the first loading in the band
  double rms = k_nan;      ///< root mean square of (curve - reference)/reference over these rows of the reference
  double unloading =
      k_nan;  ///< largest |curve - reference| of unloading and reloading, over the largest |reference| before
};

/// Compares a curve with a reference at each reversal of the reference, and at the end of its loading if that exceeds
/// the last reversal. The unloading of the curve whose reversal lies within 1 % of the reference's is compared; if
/// there is none, slope and residual are NaN.
/// @throws std::runtime_error if the curves have no common range
[[nodiscard]] std::vector<BranchComparison> compare_branches(const XyCurve& reference, const XyCurve& curve);

/// Compares a curve with a reference in bands of x, at the rows of the reference. Loading means the first loading of
/// both curves. An unloading belongs to the band of its reversal, and is compared with the unloading of the curve whose
/// reversal lies within 1 % of it. The coverage is the share of the loading rows that the curve reaches.
/// @param bands  ends of the bands in units of x, ascending, at least two
/// @param least  loading rows with |reference| <= least are left out
[[nodiscard]] std::vector<BranchComparison> compare_bands(const XyCurve& reference, const XyCurve& curve,
                                                          std::span<const double> bands, double least);

}  // namespace monograin
