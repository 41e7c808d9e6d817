#include "study/calibrate/calibration_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <utility>
#include <vector>

#include "catalogue.hpp"
#include "figure/markdown.hpp"
#include "monograin/version.hpp"
#include "study/calibrate/calibration_language.hpp"
#include "study/calibrate/text_table.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;
using Bound = LeastSquaresSolution::Bound;

constexpr std::size_t k_line_length = 82;  // of a report's page

/// A number to the place of the second digit of its error; to six digits without one.
std::string rounded(double value, double error) {
  if (!(error > 0.0) || !std::isfinite(error)) return shown_number(value);
  const int decimals = 1 - static_cast<int>(std::floor(std::log10(error)));
  const bool is_readable = decimals >= 0 && decimals <= 6 && std::abs(value) < 1e6;
  return is_readable ? fmt::format("{:.{}f}", value, decimals) : shown_number(value);
}

std::vector<TextRow> parameter_rows(const Calibration& calibration, const CalibrationResult& result) {
  const std::string level = fmt::format("{:g} % interval", 100.0 * result.uncertainty.level);
  std::vector<TextRow> rows{{"parameter", "value", "std. error", level}};
  for (std::size_t k = 0; k < calibration.free.size(); ++k) {
    const FreeParameter& parameter = calibration.free[k];
    const double error = result.uncertainty.standard_error(k) / parameter.unit_factor;
    const std::string unit = parameter.unit.empty() ? "" : ' ' + parameter.unit;
    const auto own = [&](double si) { return rounded(si / parameter.unit_factor, error); };
    const auto [lower, upper, is_cut_below, is_cut_above] = result.intervals[k];
    const bool has_error = std::isfinite(error);
    rows.push_back({parameter.key.path, own(result.solution.parameters[k]) + unit,
                    has_error ? rounded(error, error) + unit : "-",
                    std::isfinite(lower) ? fmt::format("{} ... {}{}", own(lower), own(upper), unit) : "-"});
    if (const Bound bound = result.solution.bounds[k]; !result.uncertainty.is_determined[k])
      rows.back().emplace_back("not determined");
    else if (bound != Bound::none)
      rows.back().push_back(fmt::format("at its {} bound", word_of(bound)));
  }
  const auto has_remark = [&](const TextRow& row) { return row.size() > rows.front().size(); };
  if (std::ranges::any_of(rows, has_remark)) rows.front().emplace_back();
  return rows;
}

/// Rows of the priors, with the distance of the fit from each.
std::vector<TextRow> prior_rows(const Calibration& calibration, const CalibrationResult& result) {
  std::vector<TextRow> rows;
  for (std::size_t k = 0; k < calibration.free.size(); ++k) {
    const FreeParameter& parameter = calibration.free[k];
    if (!parameter.prior) continue;
    if (rows.empty()) rows.push_back({"prior", "", "std. deviations off"});
    rows.push_back({parameter.key.path, describe(*parameter.prior, parameter.unit, parameter.unit_factor),
                    parameter.prior->is_residual()
                        ? fmt::format("{:.2f}", parameter.prior->deviation(result.solution.parameters[k]))
                        : "-"});
  }
  return rows;
}

/// Rows of the model's own procedures, and of this fit by their measures.
std::vector<TextRow> procedure_rows(const ModelFits& procedures) {
  std::vector<TextRow> rows{{"procedure"}};
  rows.front().insert(rows.front().end(), procedures.keys.begin(), procedures.keys.end());
  rows.front().insert(rows.front().end(), {"area error", "peak error"});
  for (const ProcedureFit& fit : procedures.fits) {
    rows.push_back({fit.procedure});
    for (const double value : fit.parameters) rows.back().push_back(fmt::format("{:.10g}", value));
    rows.back().push_back(fmt::format("{:.8f}", fit.area_error));
    rows.back().push_back(fmt::format("{:.8f}", fit.peak_error));
  }
  return rows;
}

std::vector<TextRow> residual_rows(const Calibration& calibration, const CalibrationResult& result) {
  const MeasuredQuantity& y = calibration.y;
  const auto in_y = [&y](double value) { return with_unit(value / y.unit_factor, y.unit == "-" ? "" : y.unit); };
  const fs::path worst = calibration.curve_of(result.goodness.largest_at).file;
  const std::string of_file = calibration.curves.size() > 1 ? worst.filename().string() + ", " : "";
  std::vector<TextRow> rows{
      {"points", fmt::format("{}", result.points)},
      {"degrees of freedom", fmt::format("{}", result.uncertainty.degrees_of_freedom)},
      {calibration.knows_noise() ? "chi^2 (noise known)" : "sum of squares (weighted)",
       shown_number(result.goodness.sum_of_squares)},
      {"rms residual", in_y(result.goodness.rms)},
      {"largest residual", fmt::format("{} ({}line {})", in_y(result.goodness.largest), of_file,
                                       calibration.lines[result.goodness.largest_at])},
      {"R^2", std::isfinite(result.goodness.r_squared) ? fmt::format("{:.8f}", result.goodness.r_squared) : "-"}};
  if (calibration.loss.kind != Loss::linear) rows.push_back({"cost (with loss)", shown_number(result.solution.cost)});
  if (result.residual_tests) {
    const ResidualTests& tests = *result.residual_tests;
    rows.push_back(
        {"runs of one sign", fmt::format("{} of {:.0f}, p = {:.2g}", tests.runs, tests.expected_runs, tests.runs_p)});
    rows.push_back(
        {"correlation of neighbours", fmt::format("{:.2f}, p = {:.2g}", tests.correlation, tests.correlation_p)});
  }
  return rows;
}

bool has_errors(const CalibrationResult& result) {
  for (std::size_t k = 0; k < result.solution.parameters.size(); ++k) {
    if (std::isfinite(result.uncertainty.standard_error(k))) return true;
  }
  return false;
}

struct TitledTable {
  std::string title;
  std::vector<TextRow> rows;
  bool has_headings = true;
};

/// All results as tables, in the order in which they are read.
std::vector<TitledTable> tables_of(const Calibration& calibration, const CalibrationResult& result) {
  std::vector<TitledTable> tables{{"Parameters", parameter_rows(calibration, result)}};
  if (calibration.free.size() > 1 && has_errors(result)) {
    tables.push_back({"Correlations", correlation_rows(calibration.free, result.uncertainty)});
  }
  if (auto priors = prior_rows(calibration, result); !priors.empty()) tables.push_back({"Priors", std::move(priors)});
  if (!result.procedures.fits.empty()) {
    tables.push_back({"The procedures of the model's source, and this fit", procedure_rows(result.procedures)});
  }
  tables.push_back({"Residuals", residual_rows(calibration, result), false});
  return tables;
}

std::string tables_text(const Calibration& calibration, const CalibrationResult& result) {
  std::string text;
  for (const TitledTable& table : tables_of(calibration, result)) text += aligned(table.rows) + '\n';
  return text;
}

std::string intervals_line(const CalibrationResult& result) {
  if (!result.has_intervals()) return {};
  return fmt::format("intervals: {} ({})\n", calibration::k_intervals[static_cast<std::size_t>(result.method)],
                     result.method_reason);
}

std::string list_of(const std::string& title, const std::vector<std::string>& entries) {
  if (entries.empty()) return {};
  std::string text = fmt::format("\n## {}\n\n", title);
  for (const std::string& entry : entries) text += fmt::format("- {}\n", entry);
  return text;
}

/// Origin of the numbers: files, rows, and the machine between sensor and particle.
std::vector<std::string> data_lines(const Calibration& calibration) {
  std::vector<std::string> lines;
  for (const MeasuredCurve& curve : calibration.curves) {
    std::string line = fmt::format("`{}`: {} rows, {}", fs::path(curve.file).filename().string(),
                                   curve.end - curve.begin, describe(curve.layout));
    if (!curve.left_out.empty()) line += fmt::format("; {} rows left out", curve.left_out.size());
    if (curve.machine.offset != 0.0) line += fmt::format("; offset {:g} m", curve.machine.offset);
    if (curve.machine.force_offset != 0.0) line += fmt::format("; force offset {:g} N", curve.machine.force_offset);
    if (curve.machine.compliance != 0.0) line += fmt::format("; compliance {:g} m/N", curve.machine.compliance);
    if (!curve.machine.forces.empty()) line += "; deflection of the machine by a table";
    lines.push_back(std::move(line));
  }
  lines.push_back(fmt::format("`{}` drives the particle, `{}` is fitted; weights: {}; loss: {}",
                              calibration.x.observable, calibration.y.observable, calibration.weighting,
                              calibration::k_losses[static_cast<std::size_t>(calibration.loss.kind)]));
  return lines;
}

void append_wrapped(std::vector<std::string>& lines, std::string_view text) {
  std::ranges::move(lines_of(text, k_line_length), std::back_inserter(lines));
}

void append_list(std::vector<std::string>& lines, const std::string& title, const std::vector<std::string>& entries) {
  if (entries.empty()) return;
  lines.insert(lines.end(), {"", title});
  for (const std::string& entry : entries) {
    const char* mark = "- ";
    for (const std::string& line : lines_of(entry, k_line_length - 2))
      lines.push_back(std::exchange(mark, "  ") + line);
  }
}

void append_lines(std::vector<std::string>& lines, std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace

std::vector<TextRow> correlation_rows(const std::vector<FreeParameter>& free, const Uncertainty& uncertainty) {
  // Headings of a wide table leave out the tables of the keys.
  const std::size_t width = std::accumulate(free.begin(), free.end(), std::size_t{25},
                                            [](auto sum, const auto& one) { return sum + one.key.path.size() + 2; });
  std::vector<TextRow> rows{{"correlation"}};
  for (const FreeParameter& parameter : free) {
    const std::string& path = parameter.key.path;
    rows.front().push_back(width > k_line_length ? path.substr(path.rfind('.') + 1) : path);
  }
  for (std::size_t i = 0; i < free.size(); ++i) {
    rows.push_back({free[i].key.path});
    for (std::size_t j = 0; j < free.size(); ++j) {
      const double value = uncertainty.correlation(i, j);
      const bool is_known = std::isfinite(value) && uncertainty.is_determined[i] && uncertainty.is_determined[j];
      rows.back().push_back(is_known ? fmt::format("{:.4f}", value) : "-");
    }
  }
  return rows;
}

std::string_view word_of(Bound bound) {
  constexpr std::array<std::string_view, 3> k_words{"", "lower", "upper"};
  return k_words[static_cast<std::size_t>(bound)];
}

/// A number to six digits; a dash if it is undefined.
std::string shown_number(double value) { return number_or_dash(value, 6); }

std::string with_unit(double value, const std::string& unit, int digits) {
  const std::string number = number_or_dash(value, digits);
  return unit.empty() || !std::isfinite(value) ? number : number + ' ' + unit;
}

std::string calibration_text(const Calibration& calibration, const CalibrationResult& result) {
  return tables_text(calibration, result) + intervals_line(result);
}

ReportLines report_lines(const Calibration& calibration, const CalibrationResult& result) {
  ReportLines lines;
  append_wrapped(lines.head, calibration.title.empty() ? calibration.name : calibration.title);
  append_wrapped(lines.head, fmt::format("Model {}, scenario {}, monograin {}.", calibration.scenario.model,
                                         calibration.scenario.name, version()));
  std::vector<std::string> data = data_lines(calibration);
  for (std::string& line : data) std::erase(line, '`');
  append_list(lines.head, "Data", data);
  append_lines(lines.foot, tables_text(calibration, result));
  append_wrapped(lines.foot, intervals_line(result));
  append_list(lines.foot, "Warnings", result.warnings);
  append_list(lines.foot, "Notes", result.notes);
  append_list(lines.foot, "Sources of the model", reference_texts(*find_model(calibration.scenario.model)));
  return lines;
}

std::string calibration_report(const Calibration& calibration, const CalibrationResult& result,
                               const std::string& figure) {
  std::string text = fmt::format("# {}\n\nModel `{}`, scenario `{}`, monograin {}.\n",
                                 calibration.title.empty() ? calibration.name : calibration.title,
                                 calibration.scenario.model, calibration.scenario.name, version());
  text += list_of("Data", data_lines(calibration));
  if (!figure.empty()) text += fmt::format("\n![data, fit and residuals]({})\n", figure);
  for (TitledTable& table : tables_of(calibration, result)) {
    text += fmt::format("\n## {}\n\n", table.title);
    if (!table.has_headings) table.rows.insert(table.rows.begin(), {"quantity", "value"});
    append_markdown(text, table.rows);
    if (table.title == "Parameters") text += '\n' + intervals_line(result);
  }
  text += list_of("Warnings", result.warnings) + list_of("Notes", result.notes);
  text +=
      "\n## Files\n\n`fit.csv` has the rows of data and fit, `calibration.json` all numbers, `fitted.toml` the "
      "scenario with the fitted numbers.\n";
  return text + list_of("Sources of the model", reference_texts(*find_model(calibration.scenario.model)));
}

}  // namespace monograin
