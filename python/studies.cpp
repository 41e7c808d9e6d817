// Sweeps, calibrations, plans of experiments and comparisons.

#include <pybind11/stl.h>

#include <cmath>
#include <optional>

#include "bindings.hpp"
#include "history/compare.hpp"
#include "interruptible.hpp"
#include "scenario/text_file.hpp"
#include "study/calibrate/calibration.hpp"
#include "study/identify/identify_files.hpp"
#include "study/sweep/bands.hpp"
#include "study/sweep/sensitivity.hpp"
#include "study/sweep/sweep.hpp"

namespace monograin::python {
namespace {

namespace fs = std::filesystem;

/// @param text  text of the study; none: that of the file is read
NamedText source_of(const std::string& file, std::optional<std::string> text, std::string_view expected) {
  return text ? NamedText{.text = std::move(*text), .file = file} : read_named_text(file, expected);
}

Sweep sweep_of(const std::string& file, const std::optional<std::string>& text) {
  const Unlocked unlocked;
  return parse_sweep(source_of(file, text, "a sweep file"));
}

/// Runs one shard of a sweep, and writes its bands once all runs are there.
/// @return the folder of the results, and the number of runs that it still lacks
std::pair<fs::path, std::size_t> run_shard(const Sweep& plan, const std::string& output, int threads,
                                           SweepShard shard) {
  if (threads < 0) throw std::invalid_argument("threads: expected 0 for one for each core, or more");
  fs::path folder = output.empty() ? fs::path("runs") / plan.name : fs::path(output);
  const SweepOutcome outcome = run_interruptibly([&](const std::atomic<bool>& stop) {
    return run_sweep(
        plan, {.folder = folder, .threads = threads, .shard = shard, .progress = [&stop](std::size_t, std::size_t) {
                 if (stop) throw Stopped();
               }});
  });
  if (outcome.runs_missing == 0 && plan.bands) {
    const Unlocked unlocked;
    static_cast<void>(write_bands(plan, bands_of(plan, folder), folder));
  }
  return {std::move(folder), outcome.runs_missing};
}

py::tuple sweep(const std::string& file, const std::optional<std::string>& text, const std::string& output, int threads,
                int shard, int shard_count) {
  if (shard < 1 || shard > shard_count) throw std::invalid_argument("shard: expected (i, n) with i from 1 to n");
  const SweepShard part{static_cast<std::size_t>(shard), static_cast<std::size_t>(shard_count)};
  const auto [folder, missing] = run_shard(sweep_of(file, text), output, threads, part);
  return py::make_tuple(folder.string(), missing);
}

/// Runs the missing runs of a sweep and writes its sensitivities.
/// @return the folder of the results, and warnings
py::tuple sensitivity(const std::string& file, const std::optional<std::string>& text, const std::string& output,
                      int threads, double confidence) {
  const Sweep plan = sweep_of(file, text);
  const fs::path folder = run_shard(plan, output, threads, {1, 1}).first;
  std::vector<std::string> warnings;
  {
    const Unlocked unlocked;
    const std::vector<ResultSensitivity> found = sensitivities_of(plan, folder, confidence);
    static_cast<void>(write_sensitivities(plan, found, folder));
    for (const ResultSensitivity& result : found) {
      warnings.insert(warnings.end(), result.warnings.begin(), result.warnings.end());
    }
  }
  return py::make_tuple(folder.string(), warnings);
}

/// Result of a calibration, in memory.
struct Fitted {
  std::string name;
  std::string json;
  std::string text;
  std::string scenario_text;
  FileTexts scenario_files;  ///< texts of the files that the scenario names
  std::vector<std::string> notes;
  std::vector<std::string> warnings;
  std::string no_figure;
  History fit;
};

/// Runs a calibration.
/// @param data        texts of files of data by their names
/// @param output      folder for the files that the program writes; empty: none are written
/// @param confidence  confidence level in (0, 1); NaN: the level of the calibration file
Fitted calibrate_source(const std::string& file, const std::optional<std::string>& text, const FileTexts& data,
                        const std::string& output, double confidence) {
  Calibration calibration = [&] {
    const Unlocked unlocked;
    return parse_calibration(source_of(file, text, "a calibration file"), data);
  }();
  if (!std::isnan(confidence)) {
    if (!(confidence > 0.0 && confidence < 1.0)) throw std::invalid_argument("confidence: expected a number in (0, 1)");
    calibration.confidence = confidence;
  }
  return run_interruptibly([&](const std::atomic<bool>& stop) {
    const CalibrationResult result = calibrate(calibration, [&stop](double) {
      if (stop) throw Stopped();
    });
    Fitted fitted{.name = calibration.name,
                  .json = calibration_json(calibration, result),
                  .text = calibration_text(calibration, result),
                  .scenario_text = fitted_scenario_text(calibration, result),
                  .scenario_files = fitted_scenario_files(calibration),
                  .notes = result.notes,
                  .warnings = result.warnings,
                  .no_figure = {},
                  .fit = history_of(fit_table(calibration, result))};
    if (!output.empty()) {
      StagedFolder staged(output, k_calibration_marker);
      fitted.no_figure = write_calibration(calibration, result, staged);
    }
    return fitted;
  });
}

/// Result of a plan of an experiment, in memory.
struct Designed {
  std::string name;
  std::vector<std::string> programs;    ///< names of all programs
  std::vector<std::string> candidates;  ///< names of the programs that are not planned
  bool has_planned = false;             ///< true if the table begins with the rows of the planned programs
  std::optional<std::string> best_by_volume;
  std::optional<std::string> best_by_variances;
  std::vector<std::vector<std::string>> notes;  ///< notes of each program, in the order of `programs`
  std::string text;
  std::string no_figure;
  History table;
};

/// Evaluates a plan of an experiment.
/// @param output  folder for the files that the program writes; empty: none are written
Designed design_source(const std::string& file, const std::optional<std::string>& text, const std::string& output) {
  const ExperimentPlan plan = [&] {
    const Unlocked unlocked;
    return parse_experiment_plan(source_of(file, text, "a plan of an experiment"));
  }();
  return run_interruptibly([&](const std::atomic<bool>& stop) {
    const IdentifyResult result = identify(plan, [&stop] {
      if (stop) throw Stopped();
    });
    Designed designed{.name = plan.name,
                      .programs = {},
                      .candidates = {},
                      .has_planned = result.planned.has_value(),
                      .best_by_volume = {},
                      .best_by_variances = {},
                      .notes = {},
                      .text = identify_text(plan, result),
                      .no_figure = {},
                      .table = history_of(identify_table(plan, result))};
    for (std::size_t k = 0; k < plan.programs.size(); ++k) {
      designed.programs.push_back(plan.programs[k].name);
      designed.notes.push_back(result.programs[k].notes);
    }
    for (const CandidateErrors& candidate : result.candidates) {
      designed.candidates.push_back(plan.programs[candidate.program].name);
    }
    if (result.best_by_volume) designed.best_by_volume = designed.candidates[*result.best_by_volume];
    if (result.best_by_variances) designed.best_by_variances = designed.candidates[*result.best_by_variances];
    if (!output.empty()) {
      StagedFolder staged(output, k_identify_marker);
      designed.no_figure = write_identify(plan, result, staged);
    }
    return designed;
  });
}

py::tuple as_python(const Comparison& comparison) {
  py::list curves;
  for (const CurveDifference& d : comparison.curves) {
    curves.append(py::make_tuple(d.y, d.linf, d.linf_at, d.l2, d.area_error, d.peak_error, d.coverage));
  }
  py::list gaps;
  for (const Gap& gap : comparison.gaps) gaps.append(py::make_tuple(gap.column, gap.problem));
  return py::make_tuple(curves, gaps);
}

}  // namespace

void add_studies(py::module_& module) {
  module.def("sweep", &sweep);
  module.def("sensitivity", &sensitivity);
  py::class_<Fitted>(module, "Fitted")
      .def_readonly("name", &Fitted::name)
      .def_readonly("json", &Fitted::json)
      .def_readonly("text", &Fitted::text)
      .def_readonly("scenario_text", &Fitted::scenario_text)
      .def_readonly("scenario_files", &Fitted::scenario_files)
      .def_readonly("notes", &Fitted::notes)
      .def_readonly("warnings", &Fitted::warnings)
      .def_readonly("no_figure", &Fitted::no_figure)
      .def_readonly("fit", &Fitted::fit);
  module.def("calibrate", &calibrate_source);
  py::class_<Designed>(module, "Designed")
      .def_readonly("name", &Designed::name)
      .def_readonly("programs", &Designed::programs)
      .def_readonly("candidates", &Designed::candidates)
      .def_readonly("has_planned", &Designed::has_planned)
      .def_readonly("best_by_volume", &Designed::best_by_volume)
      .def_readonly("best_by_variances", &Designed::best_by_variances)
      .def_readonly("notes", &Designed::notes)
      .def_readonly("text", &Designed::text)
      .def_readonly("no_figure", &Designed::no_figure)
      .def_readonly("table", &Designed::table);
  module.def("design", &design_source);
  module.def("compare_tables", [](const History& a, const History& b, const std::string& x, const std::string& y) {
    return as_python(compare(a, b, x, y));
  });
  module.def("compare_events",
             [](const History& a, const History& b) { return as_python(compare_events(a.table(), b.table())); });
}

}  // namespace monograin::python
