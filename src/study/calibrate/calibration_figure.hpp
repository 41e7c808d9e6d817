/// Figures of calibrations: data, fits and residuals.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "study/calibrate/calibration.hpp"

namespace monograin {

/// Draws data, fit and residuals. @return why there is no figure; empty: there is one
[[nodiscard]] std::string draw_calibration(const Calibration& calibration, const CalibrationResult& result,
                                           const std::filesystem::path& figure);

/// Draws the fits of several models over their common data. @return why there is no figure; empty: there is one
[[nodiscard]] std::string draw_comparison(std::span<const Calibration> calibrations,
                                          std::span<const CalibrationResult> results,
                                          const std::filesystem::path& figure);

/// Draws report.pdf, a page with the figure and the lines of the report; script and data lie beside it.
/// @return why there is no report; empty: there is one
[[nodiscard]] std::string draw_report(const Calibration& calibration, const CalibrationResult& result,
                                      const std::filesystem::path& folder);

}  // namespace monograin
