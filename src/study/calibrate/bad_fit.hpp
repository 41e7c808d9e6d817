/// Bad fits, and what may be wrong with their data.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "study/calibrate/calibration.hpp"

namespace monograin {

/// True if several rows count and all of them have one y, to round-off.
[[nodiscard]] bool is_constant(const Calibration& calibration);

/// 1 - cost / (cost of the constant that fits best, with the same weights and loss); nan where y is constant.
/// @param weights  of all rows
/// @param cost     sum of rho of the weighted residuals
[[nodiscard]] double explained_share(const Calibration& calibration, std::span<const double> weights, double cost);

/// How much a fit explains, and with which parameters.
struct TrialFit {
  double explained = 0.0;  ///< see explained_share; nan where there is no fit
  std::vector<double> parameters;
  bool is_noise = false;  ///< the residuals pass the tests of independence, or are too few for them
};
using FitTrial = std::function<TrialFit(const Calibration&)>;

/// Finds a change of the data that makes the fit good: units of x or y a thousand times larger or smaller, other signs,
/// a first touch elsewhere, half or twice the displacement. Tries each change alone.
/// @return a clause without capital and full stop; empty if no change makes the fit explain k_least_explained
[[nodiscard]] std::string likely_cause(const Calibration& calibration, const FitTrial& fit);

/// Finds that half or twice the displacement fits clearly better than a good fit whose residuals are not noise: they
/// are noise then, and the difference of the BIC is very strong, or they are less than half as large.
/// @return a clause; empty if there is no reason to doubt the displacement
[[nodiscard]] std::string doubt_displacement(const Calibration& calibration, const CalibrationResult& result,
                                             const FitTrial& fit);

/// Warnings that a fit is bad, with the likely cause; empty if it is good.
[[nodiscard]] std::vector<std::string> warnings_of(const Calibration& calibration, const CalibrationResult& result,
                                                   const FitTrial& fit);

}  // namespace monograin
