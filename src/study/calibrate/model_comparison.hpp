/// Comparison of fits of several models, or of one with different free parameters, to common data.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "figure/figure.hpp"
#include "history/staged_folder.hpp"
#include "study/calibrate/calibration.hpp"

namespace monograin {

/// Criteria and predictions of one of the fits.
struct RankedFit {
  std::size_t parameters = 0;
  double aic = 0.0;  ///< Akaike (1974), of n ln(S/n), or of chi^2 + ln det C if the noise is known; less is better
  double bic = 0.0;  ///< Schwarz (1978), of the same
  double prediction = 0.0;  ///< rms difference of each part of the data from a fit to the others [SI of y]; or nan
};

struct ModelComparison {
  std::vector<RankedFit> fits{};  ///< in the order of the calibrations
  std::size_t parts = 0;          ///< parts that were left out in turn; 0: the data cannot be divided
  bool are_cycles = false;        ///< parts are cycles of loading and unloading; else stretches between turns
};

/// @throws std::runtime_error if fits cannot be compared: different rows, different weights, a robust loss
void check_comparable(std::span<const Calibration> calibrations);

/// Leaves each cycle of the data out in turn, fits the models to the others, and predicts the one left out. If there is
/// only one cycle, uses stretches between two turning points. If a model cannot be fitted without a part, its
/// prediction is nan.
/// @param results    of calibrate(), in the order of the calibrations
/// @param progress  receives the finished share
/// @throws std::runtime_error as check_comparable()
[[nodiscard]] ModelComparison compare_models(std::span<const Calibration> calibrations,
                                             std::span<const CalibrationResult> results,
                                             const std::function<void(double)>& progress = {});

/// The comparison as text: a line for each fit, the best by the BIC first, and a conclusion.
[[nodiscard]] std::string comparison_text(std::span<const Calibration> calibrations,
                                          std::span<const CalibrationResult> results,
                                          const ModelComparison& comparison);

/// File that marks a folder as one of a comparison.
inline constexpr const char* k_comparison_marker = "comparison.csv";

/// The comparison in Markdown, with the figure and links to the reports of the fits in folders of their names.
/// @param figure  name of the file beside the report; empty: there is none
[[nodiscard]] std::string comparison_report(std::span<const Calibration> calibrations,
                                            std::span<const CalibrationResult> results,
                                            const ModelComparison& comparison, const std::string& figure);

/// Writes comparison.csv and the figure `comparison` with its script and data.
/// @param has_report  true: writes report.md, too
/// @param format      of the figure, one of figure::k_formats
/// @return why there is no figure; empty: there is one
[[nodiscard]] std::string write_comparison(std::span<const Calibration> calibrations,
                                           std::span<const CalibrationResult> results,
                                           const ModelComparison& comparison, StagedFolder& folder,
                                           bool has_report = false, std::string_view format = figure::k_usual_format);

}  // namespace monograin
