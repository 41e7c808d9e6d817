/// Results of calibrations for readers: on a terminal, and as a report.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "study/calibrate/calibration.hpp"

namespace monograin {

/// "lower", "upper", or nothing.
[[nodiscard]] std::string_view word_of(LeastSquaresSolution::Bound bound);

/// A number that a reader may compare with others; a dash where there is none.
[[nodiscard]] std::string shown_number(double value);
[[nodiscard]] std::string with_unit(double value, const std::string& unit);

/// A report in Markdown: data, figure, parameters with intervals, residuals, warnings, sources.
/// @param has_figure  whether figure.svg lies beside it
[[nodiscard]] std::string calibration_report(const Calibration& calibration, const CalibrationResult& result,
                                             bool has_figure);

/// The report as lines of text, above a figure of the fit and below it.
struct ReportLines {
  std::vector<std::string> head;
  std::vector<std::string> foot;
};
[[nodiscard]] ReportLines report_lines(const Calibration& calibration, const CalibrationResult& result);

}  // namespace monograin
