#include "monograin/study.hpp"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>
#include <utility>

#include "api/checked.hpp"
#include "api/untrapped.hpp"
#include "history/staged_folder.hpp"
#include "history/table_file.hpp"
#include "monograin/status.hpp"
#include "scenario/text_file.hpp"
#include "scenario/units.hpp"
#include "study/calibrate/calibration.hpp"
#include "study/calibrate/data_report.hpp"
#include "study/identify/identify_files.hpp"
#include "study/sweep/bands.hpp"
#include "study/sweep/sensitivity.hpp"
#include "study/sweep/sweep.hpp"

namespace monograin::study {
namespace {

namespace fs = std::filesystem;

/// @param expected  what the file should be: "a sweep file"
NamedText text_of(const Source& source, std::string_view expected) {
  if (!source.text && source.file.empty()) {
    throw std::invalid_argument(fmt::format("the source has no file and no text; expected {}", expected));
  }
  if (!source.text) return read_named_text(source.file, expected);
  return {.text = *source.text, .file = source.file.empty() ? fs::path("study.toml") : source.file};
}

void end_if_asked(const std::function<bool()>& stop) {
  if (stop && stop()) throw RunInterrupted();
}

void check_confidence(double confidence) {
  if (!(confidence > 0.0 && confidence < 1.0)) {
    throw std::invalid_argument(fmt::format("confidence = {}: expected a number in (0, 1)", confidence));
  }
}

/// Text of a study that has no data. @throws std::invalid_argument if the source has data
NamedText text_without_data(const Source& source, std::string_view expected) {
  if (!source.data.empty()) {
    throw std::invalid_argument(
        fmt::format("the source has data, '{}': expected none, because only calibrations have data in memory",
                    source.data.begin()->first));
  }
  return text_of(source, expected);
}

Sweep plan_of(const Source& source) { return parse_sweep(text_without_data(source, "a sweep file")); }

/// A result without a table, and the file of the table; the name is empty while runs are missing.
struct PlanResult {
  SweepResult result;
  fs::path table;
};

/// Does the runs of a sweep, or of its shard.
PlanResult run_plan(const Sweep& plan, const SweepOptions& options) {
  check_threads(options.threads);
  if (options.shard < 1 || options.shard > options.shard_count) {
    throw std::invalid_argument(
        fmt::format("shard = {}: expected 1 to the number of shards, {}", options.shard, options.shard_count));
  }
  SweepResult result{.folder = folder_of(plan, options.folder),
                     .left_out = plan.left_out,
                     .results = {},
                     .warnings = plan.doubts,
                     .no_figure = {}};
  SweepOutcome outcome = run_sweep(
      plan, {.folder = result.folder,
             .threads = options.threads,
             .shard = {static_cast<std::size_t>(options.shard), static_cast<std::size_t>(options.shard_count)},
             .progress = [&](std::size_t, std::size_t) { end_if_asked(options.stop); },
             .format = results_format(options.format)});
  result.missing = outcome.runs_missing;
  result.warnings.insert(result.warnings.end(), outcome.warnings.begin(), outcome.warnings.end());
  if (outcome.runs_ended_early > 0) result.warnings.push_back(early_ends_text(plan, outcome));
  return {.result = std::move(result), .table = std::move(outcome.results)};
}

}  // namespace

SweepResult sweep(const Source& source, const SweepOptions& options) {
  const Untrapped untrapped;
  const Sweep plan = plan_of(source);
  PlanResult done = run_plan(plan, options);
  SweepResult& result = done.result;
  if (result.missing > 0) return std::move(result);
  if (plan.bands) result.no_figure = write_bands(plan, bands_of(plan, result.folder), result.folder);
  result.results = history_of(read_table_file(done.table));
  return std::move(result);
}

SensitivityResult sensitivity(const Source& source, const SweepOptions& options, double confidence) {
  const Untrapped untrapped;
  check_confidence(confidence);
  if (options.shard_count != 1) throw std::invalid_argument("shard: sensitivities take all runs of a sweep");
  const Sweep plan = plan_of(source);
  if (const std::string why_not = why_no_sensitivities(plan); !why_not.empty()) throw std::invalid_argument(why_not);
  const auto [swept, table] = run_plan(plan, options);
  const fs::path& folder = swept.folder;
  const std::vector<ResultSensitivity> found = sensitivities_of(plan, table, confidence);
  const std::string no_figure = write_sensitivities(plan, found, folder);
  SensitivityResult result{.folder = folder,
                           .table = history_of(read_csv(folder / k_sensitivities_file)),
                           .warnings = swept.warnings,
                           .no_figure = no_figure};
  for (const ResultSensitivity& one : found) {
    result.warnings.insert(result.warnings.end(), one.warnings.begin(), one.warnings.end());
  }
  return result;
}

CalibrationResult calibrate(const Source& source, const Options& options, std::optional<double> confidence) {
  const Untrapped untrapped;
  if (confidence) check_confidence(*confidence);
  Calibration calibration = parse_calibration(text_of(source, "a calibration file"), source.data);
  calibration.confidence = confidence.value_or(calibration.confidence);
  std::optional<StagedFolder> staged;
  if (!options.folder.empty()) staged.emplace(options.folder, k_calibration_marker, k_calibration_tables);
  const monograin::CalibrationResult found =
      monograin::calibrate(calibration, [&](double) { end_if_asked(options.stop); });
  FileTexts files = fitted_scenario_files(calibration);
  const auto in_memory = files.empty() ? std::nullopt : std::optional(std::move(files));
  CalibrationResult result{
      .name = calibration.name,
      .parameters = {},
      .fit = history_of(fit_table(calibration, found)),
      .scenario = Scenario::parse(fitted_scenario_text(calibration, found), "fitted.toml", {}, in_memory),
      .notes = found.notes,
      .warnings = found.warnings,
      .text = calibration_text(calibration, found),
      .json = calibration_json(calibration, found),
      .no_figure = {}};
  for (std::size_t k = 0; k < calibration.free.size(); ++k) {
    const NumberKey& key = calibration.free[k].key;
    result.parameters.push_back({.key = key.path,
                                 .unit = si_unit(key.dimension),
                                 .value = found.solution.parameters[k],
                                 .standard_error = found.uncertainty.standard_error(k),
                                 .lower = found.intervals[k].lower,
                                 .upper = found.intervals[k].upper,
                                 .is_determined = found.uncertainty.is_determined[k]});
  }
  if (staged) result.no_figure = write_calibration(calibration, found, *staged);
  return result;
}

DataResult read_data(const fs::path& file, const std::string& x, const std::string& y) {
  const Untrapped untrapped;
  DataChoice choice{.x = x, .y = y};
  choice.x_named = "x =";
  choice.y_named = "y =";
  DataReport report = report_of_file(file, choice);
  if (report.x.number == report.y.number) {
    throw std::invalid_argument(fmt::format("x and y are both '{}': expected two columns", report.x.name));
  }
  std::string text = data_text(report);
  return {.table = History({{report.x.name, report.x.unit, {}, std::move(report.x.values)},
                            {report.y.name, report.y.unit, {}, std::move(report.y.values)}}),
          .lines = std::move(report.lines),
          .remarks = std::move(report.remarks),
          .text = std::move(text)};
}

DesignResult design(const Source& source, const Options& options) {
  const Untrapped untrapped;
  const ExperimentPlan plan = parse_experiment_plan(text_without_data(source, "a plan of an experiment"));
  std::optional<StagedFolder> staged;
  if (!options.folder.empty()) staged.emplace(options.folder, k_identify_marker);
  const IdentifyResult found = identify(plan, [&] { end_if_asked(options.stop); });
  DesignResult result{.name = plan.name,
                      .programs = {},
                      .notes = {},
                      .candidates = {},
                      .best_by_volume = {},
                      .best_by_variances = {},
                      .has_planned = found.planned.has_value(),
                      .table = history_of(identify_table(plan, found)),
                      .text = identify_text(plan, found),
                      .no_figure = {}};
  for (std::size_t k = 0; k < plan.programs.size(); ++k) {
    result.programs.push_back(plan.programs[k].name);
    result.notes.push_back(found.programs[k].notes);
  }
  for (const CandidateErrors& candidate : found.candidates) {
    result.candidates.push_back(plan.programs[candidate.program].name);
  }
  if (found.best_by_volume) result.best_by_volume = result.candidates[*found.best_by_volume];
  if (found.best_by_variances) result.best_by_variances = result.candidates[*found.best_by_variances];
  if (staged) result.no_figure = write_identify(plan, found, *staged);
  return result;
}

}  // namespace monograin::study
