/// Studies of many runs from their files: sweeps, sensitivities, calibrations, and plans of experiments. The library
/// `monograin::studies` has them; monograin/monograin.hpp does not include this header.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "monograin/history.hpp"
#include "monograin/scenario.hpp"

namespace monograin::study {

/// A sweep file, a calibration file, or a plan of an experiment.
struct Source {
  /// Messages show it; file names in the text are relative to its folder. A text without it is that of `study.toml`.
  std::filesystem::path file{};
  std::optional<std::string> text{};  ///< its text in TOML; none: the file is read
  /// Texts of a calibration's files of data, by the names in its text; others are read. Only calibrations have data.
  std::map<std::string, std::string> data{};
};

/// Options of calibrate() and design().
struct Options {
  /// For the files that the program writes; empty: none are written. Files of the same result there are replaced, and
  /// files of other names stay.
  std::filesystem::path folder{};
  /// Asked now and then. Returning true ends the study by RunInterrupted; all files are written then, or none. An empty
  /// function never ends it.
  std::function<bool()> stop{};
};

/// Options of sweep() and sensitivity().
struct SweepOptions {
  /// For the results, which are always written; empty: runs/NAME of the current folder. Results of another sweep there
  /// are replaced, and files of other names stay.
  std::filesystem::path folder{};
  int threads = 0;      ///< number of threads; 0: one for each core
  int shard = 1;        ///< from 1 to shard_count: only every shard_count-th run from this one on is done
  int shard_count = 1;  ///< number of processes that share the folder
  /// Format of the results, `csv` or `hdf5`; empty: that of results that are there, else `csv`. Results of the same
  /// sweep in another format are converted.
  std::string format{};
  /// Asked after each run, by one thread at a time. Returning true ends the sweep by RunInterrupted; complete runs stay
  /// in the folder, and the next call does the others. An empty function never ends it.
  std::function<bool()> stop{};
};

/// Result of sweep().
struct SweepResult {
  std::filesystem::path folder;
  std::size_t missing = 0;   ///< number of runs that other shards have yet to do
  std::size_t left_out = 0;  ///< number of points of the design that do not meet its constraints
  /// Content of results.csv or results.h5, once no run is missing: a row for each run with its keys, `status` and
  /// `reason`, and the final (`end.axial.force`) and largest (`max.axial.force`) value of every column, in SI units.
  History results;
  /// A sentence each: values that may not be meant as they are read; how many runs of this call warn, and of what; how
  /// many of all finished runs were refused, stopped or failed.
  std::vector<std::string> warnings;
  std::string no_figure;  ///< why the folder has no figure of the bands; empty: it has one, or none was requested
};

/// Runs a sweep, as `monograin sweep` does. Runs that are in the folder already are not repeated.
/// @throws ScenarioError with all faults of the sweep and its scenario
/// @throws std::invalid_argument for a source without file and text or with data, negative threads, another format, or
///         a shard that is not from 1 to the number of shards
/// @throws std::runtime_error before any run if the folder holds a run, a calibration or a plan, or a file of the user
///         with the name of one to write, or cannot be written, or if this machine has no HDF5; after the runs
///         for bands of columns that the histories do not have
/// @throws RunInterrupted if the options end the sweep
[[nodiscard]] SweepResult sweep(const Source& source, const SweepOptions& options = {});

/// Result of sensitivity().
struct SensitivityResult {
  std::filesystem::path folder;
  /// Content of sensitivity.csv: a row for each result and key, with the shares of the variance (design `saltelli`) or
  /// the elementary effects (design `morris`), and their intervals.
  History table;
  std::vector<std::string> warnings;  ///< why the values are not to be trusted, a sentence each
  std::string no_figure;              ///< why the folder has no figure; empty: it has one
};

/// Runs a sweep and computes how much each key contributes to the spread of its results, as `monograin sensitivity`
/// does.
/// @param confidence  level of the two-sided intervals, in (0, 1)
/// @throws ScenarioError with all faults of the sweep and its scenario
/// @throws std::invalid_argument before any run for another design than `saltelli` and `morris`, another confidence, or
///         shards; otherwise as sweep()
/// @throws std::runtime_error for a formula that cannot be evaluated with the columns of the results; otherwise as
///         sweep()
/// @throws RunInterrupted if the options end the sweep
[[nodiscard]] SensitivityResult sensitivity(const Source& source, const SweepOptions& options = {},
                                            double confidence = 0.95);

/// A fitted number of a scenario, in SI units.
struct FittedParameter {
  std::string key;              ///< as Scenario::set() takes it
  std::string unit;             ///< SI unit of the numbers below; - for a pure number
  double value = 0.0;           ///< of the best fit
  double standard_error = 0.0;  ///< of the linearised fit; NaN if the data do not determine the value
  double lower = 0.0;           ///< ends of the two-sided confidence interval; NaN if there is none
  double upper = 0.0;
  bool is_determined = false;  ///< true if the data determine the value
};

/// Result of calibrate().
struct CalibrationResult {
  std::string name;
  std::vector<FittedParameter> parameters;
  History fit;                        ///< data, fit, residual, confidence band and weight, row by row
  Scenario scenario;                  ///< with the fitted parameters, and the files that it names in memory
  std::vector<std::string> notes;     ///< remarks on the fit, a sentence each
  std::vector<std::string> warnings;  ///< reasons not to trust the fit; empty for a good one
  std::string text;                   ///< as `monograin calibrate` prints it
  std::string json;                   ///< content of calibration.json, with covariance, statistics and minima
  std::string no_figure;              ///< why the folder has no figure; empty: it has one, or none was asked for
};

/// Fits parameters of a scenario to measured data, as `monograin calibrate` does.
/// @param confidence  level of the intervals, in (0, 1); none: that of the file, or 0.95
/// @throws ScenarioError with all faults of calibration, scenario and data, such as data in the source that the text
///         does not name, or if the scenario cannot follow the data
/// @throws std::invalid_argument for another confidence, or a source without file and text
/// @throws std::runtime_error before the fit if the folder holds a run or a plan, or a file of the user with the name
///         of one to write, or cannot be written
/// @throws RunInterrupted if the options end the calibration
[[nodiscard]] CalibrationResult calibrate(const Source& source, const Options& options = {},
                                          std::optional<double> confidence = {});

/// A file of measured data, as a calibration reads it.
struct DataResult {
  History table;                     ///< x and y in the units of the file: the rows that have both
  std::vector<std::size_t> lines;    ///< line of each of these rows in the file, from 1
  std::vector<std::string> remarks;  ///< why a calibration would refuse the file, a sentence each
  std::string text;                  ///< separator, columns, and branches of loading, as `monograin data` prints them
};

/// Reads a file of measured data, as `monograin data` does. Separator, decimal point, headings and units are found in
/// the file.
/// @param x  column: heading, or number from 1; empty: the first length, else the first column of numbers
/// @param y  column; empty: the first force, else the next column of numbers
/// @throws ScenarioError if the file cannot be read, is no table, or has no such column
/// @throws std::invalid_argument if x and y are one column, or have the same heading
[[nodiscard]] DataResult read_data(const std::filesystem::path& file, const std::string& x = {},
                                   const std::string& y = {});

/// Result of design().
struct DesignResult {
  std::string name;
  std::vector<std::string> programs;            ///< names of all programs
  std::vector<std::vector<std::string>> notes;  ///< remarks on the run of each program
  std::vector<std::string> candidates;          ///< names of the programs that are not planned
  std::optional<std::string> best_by_volume;    ///< D-optimal candidate; none if no candidate determines all parameters
  std::optional<std::string> best_by_variances;  ///< A-optimal candidate; none as well
  bool has_planned = false;  ///< true if the first rows of the table are those of the planned programs alone
  /// Content of errors.csv: a row for each parameter of the planned programs and of each candidate, in SI units.
  History table;
  std::string text;       ///< as `monograin design` prints it
  std::string no_figure;  ///< why the folder has no figure; empty: it has one, or none was asked for
};

/// Computes the expected errors of a fit to a planned experiment, as `monograin design` does.
/// @throws ScenarioError with all faults of plan and scenario, or if the noise of a measured row is zero
/// @throws std::invalid_argument for a source without file and text, or with data
/// @throws std::runtime_error before the computation if the folder holds a run or a calibration, or a file of the user
///         with the name of one to write, or cannot be written
/// @throws RunInterrupted if the options end the computation
[[nodiscard]] DesignResult design(const Source& source, const Options& options = {});

}  // namespace monograin::study
