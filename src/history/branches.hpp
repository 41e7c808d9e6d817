/// Load-unload curves taken apart: first loading and unloadings, and how two such curves differ.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "history/compare.hpp"

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

/// Mean slope of the first part of an unloading, in which y falls by a twentieth; of all of it where y does not fall so
/// far.
[[nodiscard]] double unloading_slope(const XyCurve& unloading);

/// x where y vanishes on an unloading; nan where it does not. Between the last row with y > 0 and the first without, y
/// is taken to vanish as that of an elastic contact does, with the power 3/2 of the distance.
[[nodiscard]] double residual_displacement(const XyCurve& unloading);

/// One line of a comparison: first loading up to a reversal, and the unloading from there.
struct BranchComparison {
  double reversal = 0.0;    ///< x at which the reference turns back, or at which its loading ends
  double area_error = 0.0;  ///< of the loading up to there, see CurveDifference
  double peak_error = 0.0;
  double coverage = 1.0;
  double slope = 0.0;  ///< of the unloading, or nan
  double reference_slope = 0.0;
  double residual = 0.0;  ///< x where the force vanishes, or nan
  double reference_residual = 0.0;
};

/// Compares a curve with a reference: at each reversal of the reference, and at the end of its loading if it goes on
/// beyond the last one. An unloading of the curve is taken for the reference's if it turns back within 1 % of the same
/// place; without one slope and residual are nan.
/// @throws std::runtime_error when the curves have no common range
[[nodiscard]] std::vector<BranchComparison> compare_branches(const XyCurve& reference, const XyCurve& curve);

}  // namespace monograin
