/// Load-unload curves taken apart: first loading and unloadings, and how two such curves differ.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "history/compare.hpp"
#include "system/undefined.hpp"

namespace monograin {

struct XyCurve {
  std::vector<double> x;
  std::vector<double> y;
};

/// The rows in which x is larger than in all rows before: first loading, without what was unloaded and reloaded.
/// Undefined rows are left out.
[[nodiscard]] XyCurve first_loading(const XyCurve& curve);

/// The ways back from a largest x so far, each with the row in which it turns. Going back below an old largest x (in a
/// reload that is broken off) is none.
[[nodiscard]] std::vector<XyCurve> unloadings(const XyCurve& curve);

/// A way back from a largest x so far, and the way forth from its end.
struct Excursion {
  XyCurve back;   ///< from the row that turns; x falls
  XyCurve forth;  ///< from the last row of `back` to the row that reaches the largest x again, or to where x falls anew
};
[[nodiscard]] std::vector<Excursion> excursions(const XyCurve& curve);

/// Rows at which x turns, with the first and the last one: between them it goes one way, but for its noise.
///
/// Ways of at most two steps are noise where there are three or more of them. A turn counts where x comes back by more
/// than six times the median of their lengths, and by more than 0.2 % of its range.
[[nodiscard]] std::vector<std::size_t> turning_points(std::span<const double> x);

/// Mean slope of the first part of an unloading, in which y falls by a twentieth; of all of it where y does not fall so
/// far.
[[nodiscard]] double unloading_slope(const XyCurve& unloading);

/// x where y vanishes on an unloading; nan where it does not. Between the last row with y > 0 and the first without, y
/// is taken to vanish as that of an elastic contact does, with the power 3/2 of the distance.
[[nodiscard]] double residual_displacement(const XyCurve& unloading);

/// One line of a comparison: first loading up to a reversal and the unloading from there; or what happens in a band of
/// x. A measure that does not belong to the line is nan.
struct BranchComparison {
  double reversal = 0.0;    ///< x at which the reference turns back, or at which its loading ends; end of a band
  double area_error = 0.0;  ///< of the loading up to there, see CurveDifference
  double peak_error = 0.0;
  double coverage = 1.0;
  double slope = 0.0;  ///< of the unloading, or nan
  double reference_slope = 0.0;
  double residual = 0.0;  ///< x where the force vanishes, or nan
  double reference_residual = 0.0;
  double largest = k_nan;  ///< of |curve - reference|/|reference| on the first loading in the band
  double rms = k_nan;      ///< root mean square of the same over the rows of the reference
  double unloading =
      k_nan;  ///< largest |curve - reference| of ways back and forth, over the largest |reference| before
};

/// Compares a curve with a reference: at each reversal of the reference, and at the end of its loading if it goes on
/// beyond the last one. An unloading of the curve is taken for the reference's if it turns back within 1 % of the same
/// place; without one slope and residual are nan.
/// @throws std::runtime_error when the curves have no common range
[[nodiscard]] std::vector<BranchComparison> compare_branches(const XyCurve& reference, const XyCurve& curve);

/// Compares a curve with a reference in bands of x, at the rows of the reference. The loading is the first one of both
/// curves. A way back belongs to the band in which it starts; it is compared with that of the curve that turns back
/// within 1 % of the same place. The coverage is the share of the loading rows that the curve reaches.
/// @param bands  ends of the bands, ascending: two at least
/// @param least  loading rows with |reference| up to this are left out
[[nodiscard]] std::vector<BranchComparison> compare_bands(const XyCurve& reference, const XyCurve& curve,
                                                          std::span<const double> bands, double least);

}  // namespace monograin
