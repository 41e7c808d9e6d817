#include "monograin/study.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "history/staged_folder.hpp"
#include "monograin/status.hpp"
#include "scenario/text_file.hpp"
#include "study/calibrate/calibration.hpp"
#include "study/identify/identify_files.hpp"
#include "study/sweep/bands.hpp"
#include "study/sweep/sensitivity.hpp"
#include "study/sweep/sweep.hpp"

namespace monograin::study {
namespace {

namespace fs = std::filesystem;

/// @param expected  what the file should be: "a sweep file"
NamedText text_of(const Source& source, std::string_view expected) {
  return source.text ? NamedText{.text = *source.text, .file = source.file} : read_named_text(source.file, expected);
}

History history_of(Table table) { return History(std::make_shared<const Table>(std::move(table))); }

void end_if_asked(const std::function<bool()>& stop) {
  if (stop && stop()) throw RunInterrupted();
}

void check_confidence(double confidence) {
  if (!(confidence > 0.0 && confidence < 1.0)) {
    throw std::invalid_argument(fmt::format("confidence = {}: expected a number in (0, 1)", confidence));
  }
}

Sweep plan_of(const Source& source) { return parse_sweep(text_of(source, "a sweep file")); }

/// Does the runs of a sweep, or of its shard.
SweepResult run_plan(const Sweep& plan, const SweepOptions& options) {
  if (options.threads < 0) {
    throw std::invalid_argument(
        fmt::format("threads = {}: expected 0 for one for each core, or more", options.threads));
  }
  if (options.shard < 1 || options.shard > options.shard_count) {
    throw std::invalid_argument(
        fmt::format("shard = {}: expected 1 to the number of shards, {}", options.shard, options.shard_count));
  }
  SweepResult result{.folder = options.folder.empty() ? fs::path("runs") / plan.name : options.folder, .results = {}};
  const SweepOutcome outcome =
      run_sweep(plan, {.folder = result.folder,
                       .threads = options.threads,
                       .shard = {options.shard, options.shard_count},
                       .progress = [&](std::size_t, std::size_t) { end_if_asked(options.stop); }});
  result.missing = outcome.runs_missing;
  return result;
}

/// Writes the bands that a sweep file requests.
void add_bands(const Sweep& plan, const fs::path& folder) {
  if (plan.bands) static_cast<void>(write_bands(plan, bands_of(plan, folder), folder));
}

}  // namespace

SweepResult sweep(const Source& source, const SweepOptions& options) {
  const Sweep plan = plan_of(source);
  SweepResult result = run_plan(plan, options);
  if (result.missing > 0) return result;
  add_bands(plan, result.folder);
  result.results = history_of(read_csv(result.folder / "results.csv"));
  return result;
}

SensitivityResult sensitivity(const Source& source, const SweepOptions& options, double confidence) {
  check_confidence(confidence);
  if (options.shard_count != 1) throw std::invalid_argument("shard: sensitivities take all runs of a sweep");
  const Sweep plan = plan_of(source);
  const fs::path folder = run_plan(plan, options).folder;
  add_bands(plan, folder);
  const std::vector<ResultSensitivity> found = sensitivities_of(plan, folder, confidence);
  static_cast<void>(write_sensitivities(plan, found, folder));
  SensitivityResult result{
      .folder = folder, .table = history_of(read_csv(folder / k_sensitivities_file)), .warnings = {}};
  for (const ResultSensitivity& one : found) {
    result.warnings.insert(result.warnings.end(), one.warnings.begin(), one.warnings.end());
  }
  return result;
}

CalibrationResult calibrate(const Source& source, const Options& options, std::optional<double> confidence) {
  if (confidence) check_confidence(*confidence);
  Calibration calibration = parse_calibration(text_of(source, "a calibration file"), source.data);
  calibration.confidence = confidence.value_or(calibration.confidence);
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
    result.parameters.push_back({.key = calibration.free[k].key.path,
                                 .value = found.solution.parameters[k],
                                 .standard_error = found.uncertainty.standard_error(k),
                                 .lower = found.intervals[k].lower,
                                 .upper = found.intervals[k].upper,
                                 .is_determined = found.uncertainty.is_determined[k]});
  }
  if (!options.folder.empty()) {
    StagedFolder staged(options.folder, k_calibration_marker);
    result.no_figure = write_calibration(calibration, found, staged);
  }
  return result;
}

DesignResult design(const Source& source, const Options& options) {
  const ExperimentPlan plan = parse_experiment_plan(text_of(source, "a plan of an experiment"));
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
  if (!options.folder.empty()) {
    StagedFolder staged(options.folder, k_identify_marker);
    result.no_figure = write_identify(plan, found, staged);
  }
  return result;
}

}  // namespace monograin::study
