// Files of a calibration: tables, a figure, a report and a scenario.

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "catalogue.hpp"
#include "figure/page.hpp"
#include "history/run.hpp"
#include "history/run_files.hpp"
#include "scenario/edit.hpp"
#include "scenario/file_keys.hpp"
#include "scenario/text_file.hpp"
#include "scenario/words.hpp"
#include "study/calibrate/calibration.hpp"
#include "study/calibrate/calibration_figure.hpp"
#include "study/calibrate/calibration_language.hpp"
#include "study/calibrate/calibration_text.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Bound = LeastSquaresSolution::Bound;

Json prior_json(const FreeParameter& parameter, double value) {
  if (!parameter.prior) return {};
  const Prior& prior = *parameter.prior;
  return {{"distribution", word_of(prior.kind)},
          {"values", {prior.first, prior.second}},
          {"deviation", prior.is_residual() ? Json(prior.deviation(value)) : Json()}};
}

Json parameters_json(const Calibration& calibration, const CalibrationResult& result) {
  Json parameters = Json::array();
  for (std::size_t k = 0; k < calibration.free.size(); ++k) {
    const FreeParameter& parameter = calibration.free[k];
    const Interval& interval = result.intervals[k];
    const Bound bound = result.solution.bounds[k];
    parameters.push_back({{"key", parameter.key.path},
                          {"value", result.solution.parameters[k]},
                          {"standard_error", result.uncertainty.standard_error(k)},
                          {"interval", {interval.lower, interval.upper}},
                          {"interval_is_cut", {interval.is_cut_below, interval.is_cut_above}},
                          {"bounds", {parameter.lower, parameter.upper}},
                          {"at_bound", bound == Bound::none ? Json() : Json(word_of(bound))},
                          {"is_determined", static_cast<bool>(result.uncertainty.is_determined[k])},
                          {"prior", prior_json(parameter, result.solution.parameters[k])},
                          {"unit", parameter.unit},
                          {"value_in_unit", result.solution.parameters[k] / parameter.unit_factor}});
  }
  return parameters;
}

Json matrix_json(std::size_t size, const std::function<double(std::size_t, std::size_t)>& entry) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < size; ++i) {
    Json row = Json::array();
    for (std::size_t j = 0; j < size; ++j) row.push_back(entry(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json minima_json(const CalibrationResult& result) {
  Json minima = Json::array();
  for (const LocalMinimum& minimum : result.solution.minima) {
    minima.push_back({{"parameters", minimum.parameters}, {"cost", minimum.cost}});
  }
  return minima;
}

Json procedures_json(const ModelFits& procedures) {
  Json fits = Json::array();
  for (const ProcedureFit& fit : procedures.fits) {
    Json parameters = Json::object();
    for (std::size_t k = 0; k < procedures.keys.size(); ++k) parameters[procedures.keys[k]] = fit.parameters[k];
    fits.push_back({{"procedure", fit.procedure},
                    {"parameters", std::move(parameters)},
                    {"area_error", fit.area_error},
                    {"peak_error", fit.peak_error}});
  }
  return fits;
}

/// The measured curves: one object, or a list of them, as in the calibration file.
Json data_json(const Calibration& calibration) {
  Json list = Json::array();
  for (const MeasuredCurve& curve : calibration.curves) {
    const TableLayout& layout = curve.layout;
    const auto column = [&](std::size_t k) {
      const std::size_t number = curve.columns[k];
      return Json({{"number", number},
                   {"heading", layout.headings[number - 1]},
                   {"unit", layout.units[number - 1]},
                   {"scale", curve.scales[k]}});
    };
    list.push_back({{"file", curve.file},
                    {"encoding", layout.encoding},
                    {"separator", separator_word(layout.separator)},
                    {"decimal", std::string(1, layout.decimal)},
                    {"heading_line", layout.heading_line},
                    {"unit_line", layout.unit_line},
                    {"x", column(0)},
                    {"y", column(1)},
                    {"rows", curve.end - curve.begin},
                    {"rows_left_out", curve.left_out.size()},
                    {"text", curve.text}});
    if (!curve.overrides.empty()) list.back()["set"] = curve.overrides;
    if (!curve.machine.forces.empty()) {
      list.back()["deflections"] = {{"force_N", curve.machine.forces}, {"deflection_m", curve.machine.deflections}};
    }
  }
  return list.size() == 1 ? list.front() : list;
}

Json residual_tests_json(const CalibrationResult& result) {
  if (!result.residual_tests) return {};
  const ResidualTests& tests = *result.residual_tests;
  return {{"runs", tests.runs},
          {"expected_runs", tests.expected_runs},
          {"runs_p", tests.runs_p},
          {"correlation", tests.correlation},
          {"correlation_p", tests.correlation_p},
          {"are_independent", tests.are_independent()}};
}

Json statistics_json(const Calibration& calibration, const CalibrationResult& result) {
  const LeastSquaresSolution& solution = result.solution;
  const Uncertainty& uncertainty = result.uncertainty;
  return {{"points", result.points},
          {"degrees_of_freedom", uncertainty.degrees_of_freedom},
          {"level", uncertainty.level},
          {"t_quantile", uncertainty.t_quantile},
          {"standard_deviation", uncertainty.standard_deviation},
          {"cost", solution.cost},
          {"sum_of_squares", result.goodness.sum_of_squares},
          {"rms", result.goodness.rms},
          {"largest", result.goodness.largest},
          {"largest_in_line", calibration.lines[result.goodness.largest_at]},
          {"r_squared", result.goodness.r_squared},
          {"explained", result.goodness.explained}};
}

/// How the fit was made.
Json fit_json(const Calibration& calibration, const CalibrationResult& result) {
  const LeastSquaresSolution& solution = result.solution;
  return {{"x", {{"quantity", calibration.x.observable}, {"unit", calibration.x.si}}},
          {"y", {{"quantity", calibration.y.observable}, {"unit", calibration.y.si}}},
          {"weights", calibration.weighting},
          {"noise", calibration.knows_noise() ? "known" : "estimated"},
          {"loss", calibration::k_losses[static_cast<std::size_t>(calibration.loss.kind)]},
          {"loss_scale", calibration.loss.kind == Loss::linear ? Json() : Json(calibration.loss.scale)},
          {"has_converged", solution.has_converged},
          {"evaluations", solution.evaluations},
          {"failed_evaluations", solution.failures},
          {"program_steps", result.program_steps},
          {"minima", minima_json(result)},
          {"procedures", procedures_json(result.procedures)}};
}

/// The content of calibration.json. Undefined numbers become null.
Json to_json(const Calibration& calibration, const CalibrationResult& result) {
  const Uncertainty& uncertainty = result.uncertainty;
  const std::size_t p = calibration.free.size();
  Json scenario = scenario_json(calibration.scenario);
  scenario["text"] = calibration.scenario_text;  // the table alone, where it is one of the calibration file
  return {{"program", "monograin"},
          {"calibration", calibration.name},
          {"title", calibration.title},
          {"parameters", parameters_json(calibration, result)},
          {"covariance", matrix_json(p,
                                     [&](std::size_t i, std::size_t j) {
                                       return uncertainty.covariance(static_cast<Eigen::Index>(i),
                                                                     static_cast<Eigen::Index>(j));
                                     })},
          {"correlation", matrix_json(p,
                                      [&](std::size_t i, std::size_t j) {
                                        const bool has_both = std::isfinite(uncertainty.standard_error(i) +
                                                                            uncertainty.standard_error(j));
                                        return has_both ? uncertainty.correlation(i, j) : k_nan;
                                      })},
          {"statistics", statistics_json(calibration, result)},
          {"intervals",
           {{"method", calibration::k_intervals[static_cast<std::size_t>(result.method)]},
            {"reason", result.method_reason},
            {"level", uncertainty.level}}},
          {"residual_tests", residual_tests_json(result)},
          {"fit", fit_json(calibration, result)},
          {"notes", result.notes},
          {"warnings", result.warnings},
          {"citation", reference_texts(*find_model(calibration.scenario.model))},
          {"versions", versions_json()},
          {"scenario", std::move(scenario)},
          {"data", data_json(calibration)},
          {"text", calibration.text}};
}

/// A file that the scenario names. It lies beside the fitted scenario.
struct FittedFile {
  FileKey key;
  std::string name;  ///< beside the fitted scenario: that of the option, or of the program
};

std::vector<FittedFile> fitted_files(const Calibration& calibration) {
  std::vector<FittedFile> files;
  for (FileKey& key : file_keys(calibration.scenario)) {
    const std::string option = key.path.substr(key.path.rfind('.') + 1);
    const bool is_of_program = key.path.starts_with("loading");
    std::string name = is_of_program ? fmt::format("program-{}.csv", files.size() + 1) : option + ".csv";
    files.push_back({std::move(key), std::move(name)});
  }
  return files;
}

/// True if every curve has an override.
bool is_shared(const Calibration& calibration, const std::string& key_and_value) {
  return std::ranges::all_of(calibration.curves, [&](const MeasuredCurve& curve) {
    return std::ranges::find(curve.overrides, key_and_value) != curve.overrides.end();
  });
}

/// The scenario with the overrides that all curves share. Those for which its text has no place are listed in `head`.
std::string shared_scenario_text(const Calibration& calibration, std::string& head) {
  std::string text = calibration.scenario_text;
  for (const std::string& key_and_value : calibration.curves.front().overrides) {
    if (!is_shared(calibration, key_and_value)) continue;
    try {
      text = with_override(text, key_and_value);
    } catch (const std::runtime_error&) {
      head += fmt::format("# The fit holds with --set '{}'\n", on_one_line(key_and_value));
    }
  }
  return text;
}

}  // namespace

std::string fitted_scenario_text(const Calibration& calibration, const CalibrationResult& result) {
  std::vector<TextEdit> edits;
  std::string head =
      fmt::format("# Numbers fitted by monograin calibrate ({}, {} points of {}), with half of each {:g} % interval:\n",
                  calibration.name, result.points, data_names(calibration), 100.0 * result.uncertainty.level);
  for (std::size_t k = 0; k < calibration.free.size(); ++k) {
    const FreeParameter& parameter = calibration.free[k];
    const double value = result.solution.parameters[k];
    std::string digits = fmt::format("{:.17g}", value);
    if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
    if (!parameter.is_of_machine()) edits.push_back({parameter.key.path, digits});
    const double half = result.uncertainty.half_width(k) / parameter.unit_factor;
    const std::string accuracy = std::isfinite(half) ? fmt::format(" +- {}", with_unit(half, parameter.unit))
                                 : result.uncertainty.is_determined[k] ? ""
                                                                       : ", not determined by the data";
    head += fmt::format("#   {} = {}{}\n", parameter.key.path, with_unit(value / parameter.unit_factor, parameter.unit),
                        accuracy);
  }
  if (calibration.has_machine()) head += fmt::format("# {}\n", k_without_machine);
  for (const FittedFile& file : fitted_files(calibration)) edits.push_back({file.key.path, '"' + file.name + '"'});
  const std::string text = shared_scenario_text(calibration, head);
  return head + with_values(text, edits);
}

FileTexts fitted_scenario_files(const Calibration& calibration) {
  FileTexts files;
  for (FittedFile& file : fitted_files(calibration)) files.emplace(std::move(file.name), std::move(file.key.text));
  return files;
}

Table fit_table(const Calibration& calibration, const CalibrationResult& result) {
  const MeasuredQuantity& x = calibration.x;
  const MeasuredQuantity& y = calibration.y;
  const std::string inverse = "1/" + y.si;
  std::vector<Column> columns{{x.observable, x.si, {}}, {y.observable, y.si, {}}, {"fit", y.si, {}},
                              {"residual", y.si, {}},   {"band_lower", y.si, {}}, {"band_upper", y.si, {}},
                              {"weight", inverse, {}}};
  const bool has_displacement = !result.particle.empty();
  const bool moves_x = calibration.machine_moves_x();
  const MeasuredQuantity& moving = y.observable.ends_with(".force") ? y : x;  // the force, if there is one
  const bool has_force = calibration.has_machine() && moving.observable.ends_with(".force");
  if (has_displacement) columns.push_back({k_particle_displacement, "m", {}});
  if (has_force) columns.push_back({k_particle_force, "N", {}});
  const bool has_several = calibration.curves.size() > 1;
  if (has_several) columns.push_back({"curve", "", {}});
  Table table(std::move(columns));
  table.header = {{"program", fmt::format("monograin {}", version())},
                  {"calibration", calibration.name},
                  {"scenario", calibration.scenario.name},
                  {"scenario_digest", scenario_digest(calibration.scenario)},
                  {"model", calibration.scenario.model},
                  {"data", calibration.curves.front().file},
                  {"band", fmt::format("confidence band of the fit at level {:g}", result.uncertainty.level)}};
  for (std::size_t c = 1; c < calibration.curves.size(); ++c) {
    table.header.emplace_back(fmt::format("data_{}", c + 1), calibration.curves[c].file);
  }
  for (std::size_t k = 0; k < calibration.free.size(); ++k) {
    table.header.emplace_back(calibration.free[k].key.path, fmt::format("{:.17g}", result.solution.parameters[k]));
  }
  std::vector<double> force_offsets;  // of the curves
  for (const MeasuredCurve& curve : calibration.curves) {
    force_offsets.push_back(calibration.machine_of(curve, result.solution.parameters).force_offset);
  }
  for (std::size_t row = 0; row < x.values.size(); ++row) {
    const auto curve = static_cast<std::size_t>(&calibration.curve_of(row) - calibration.curves.data());
    const double fit = result.fit.y[row];
    const double band = result.fit.band[row];
    std::vector<double> cells{x.values[row], y.values[row],      fit, y.values[row] - fit, fit - band,
                              fit + band,    result.weights[row]};
    if (has_displacement) cells.push_back(result.particle[row] + (moves_x ? 0.0 : y.values[row] - fit));
    if (has_force) cells.push_back(moving.values[row] - force_offsets[curve]);
    if (has_several) cells.push_back(static_cast<double>(curve + 1));
    table.append(cells);
  }
  return table;
}

std::string calibration_json(const Calibration& calibration, const CalibrationResult& result) {
  return record_text(to_json(calibration, result));
}

std::string write_calibration(const Calibration& calibration, const CalibrationResult& result, StagedFolder& folder,
                              bool has_report, std::string_view format) {
  write_text_file(folder.path() / k_calibration_tables[0], csv_text(fit_table(calibration, result)));
  write_text_file(folder.path() / k_calibration_tables[1], fitted_scenario_text(calibration, result));
  for (const auto& [name, text] : fitted_scenario_files(calibration)) {
    write_text_file(folder.path() / name, text);
  }
  write_text_file(folder.path() / k_calibration_marker, calibration_json(calibration, result));
  const std::string figure = fmt::format("figure.{}", format);
  std::string problem = draw_calibration(calibration, result, folder.path() / figure);
  if (has_report) {
    write_text_file(folder.path() / "report.md",
                    calibration_report(calibration, result, problem.empty() ? figure : ""));
    if (problem.empty()) problem = draw_report(calibration, result, folder.path());
  }
  folder.publish(folder.age());
  return problem;
}

}  // namespace monograin
