/// Results of calibrations for readers: on a terminal, and as a report.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "study/calibrate/calibration.hpp"
#include "study/calibrate/text_table.hpp"

namespace monograin {

/// Name of a bound: "lower", "upper", or empty.
[[nodiscard]] std::string_view word_of(LeastSquaresSolution::Bound bound);

/// A number to six digits, for comparison with others; a dash if it is undefined.
[[nodiscard]] std::string shown_number(double value);
[[nodiscard]] std::string with_unit(double value, const std::string& unit, int digits = 6);

/// Correlations of parameters as a table; a dash for those that the data do not determine.
[[nodiscard]] std::vector<TextRow> correlation_rows(const std::vector<FreeParameter>& free,
                                                    const Uncertainty& uncertainty);

/// A report in Markdown: data, figure, parameters with intervals, residuals, warnings, sources.
/// @param figure  name of the file beside the report; empty: there is none
[[nodiscard]] std::string calibration_report(const Calibration& calibration, const CalibrationResult& result,
                                             const std::string& figure);

/// Lines of the report, above a figure of the fit and below it.
struct ReportLines {
  std::vector<std::string> head;
  std::vector<std::string> foot;
};
[[nodiscard]] ReportLines report_lines(const Calibration& calibration, const CalibrationResult& result);

}  // namespace monograin
