/// Fits of several models, or of one with other free parameters, to common data: which one the data speak for.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "history/staged_folder.hpp"
#include "study/calibrate/calibration.hpp"

namespace monograin {

/// Criteria and predictions of one of the fits.
struct RankedFit {
  std::size_t parameters = 0;
  double aic = 0.0;         ///< Akaike (1974), of n ln(S/n), or of chi^2 where the noise is known; less is better
  double bic = 0.0;         ///< Schwarz (1978), of the same
  double prediction = 0.0;  ///< rms of what each part of the data differs from a fit to the others [SI of y]; or nan
};

struct ModelComparison {
  std::vector<RankedFit> fits;  ///< as the calibrations are
  std::size_t parts = 0;        ///< that were left out in turn; 0: the data cannot be taken apart
  bool are_cycles = false;      ///< parts are cycles of loading and unloading, otherwise stretches between two turns
};

/// @throws std::runtime_error with the reason why fits cannot be compared: other rows, other weights, a robust loss
void check_comparable(std::span<const Calibration> calibrations);

/// Leaves the cycles of the data out in turn, fits to the others, and predicts them; stretches between two turns where
/// there is one cycle. A part without which a model cannot be fitted makes its prediction nan.
/// @param results    of calibrate(), as the calibrations are
/// @param progress  takes the share that is done
/// @throws std::runtime_error as check_comparable()
[[nodiscard]] ModelComparison compare_models(std::span<const Calibration> calibrations,
                                             std::span<const CalibrationResult> results,
                                             const std::function<void(double)>& progress = {});

/// For the reader: a line for each fit, the best by the BIC first, and what to make of it.
[[nodiscard]] std::string comparison_text(std::span<const Calibration> calibrations,
                                          std::span<const CalibrationResult> results,
                                          const ModelComparison& comparison);

/// The file that tells the folder of a comparison.
inline constexpr const char* k_comparison_marker = "comparison.csv";

/// Writes comparison.csv and comparison.svg with its script and data.
/// @return why there is no figure; empty: there is
[[nodiscard]] std::string write_comparison(std::span<const Calibration> calibrations,
                                           std::span<const CalibrationResult> results,
                                           const ModelComparison& comparison, StagedFolder& folder);

}  // namespace monograin
