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
  double coverage = 1.0;    ///< share of the reference's loading on which the curve was compared
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
/// reversal lies within 1 % of it. The coverage is the share of the loading rows that are compared.
/// @param bands  ends of the bands in units of x, ascending, at least two
/// @param least  loading rows with |reference| <= least are not compared
[[nodiscard]] std::vector<BranchComparison> compare_bands(const XyCurve& reference, const XyCurve& curve,
                                                          std::span<const double> bands, double least);

}  // namespace monograin
