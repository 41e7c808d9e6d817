/// Sweep files: one scenario, the keys that are varied, and the runs this makes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenario/file_keys.hpp"
#include "scenario/scenario.hpp"
#include "scenario/text_file.hpp"
#include "study/sweep/design.hpp"
#include "study/sweep/sweep_runs.hpp"

namespace monograin {

/// Percentiles of the histories that a sweep file requests.
struct BandRequest {
  std::string x;                                     ///< column of the histories
  std::vector<std::string> y;                        ///< columns
  std::vector<double> percentiles{5.0, 50.0, 95.0};  ///< ascending, between 0 and 100
  int points = 51;                                   ///< abscissae in each step
};

struct Sweep {
  std::string name;  ///< of the file, without folder and extension
  std::string title{};
  std::string design;                 ///< grid, table, maxpro, sobol, halton, lhs, random, saltelli, morris
  std::vector<std::string> models{};  ///< of the scenario, or those that are varied
  std::vector<SweepFactor> factors;
  SweepRuns runs;
  std::size_t left_out = 0;  ///< points of a grid that the constraints exclude
  Design points;             ///< the runs as points of a cube
  ScenarioTemplate scenario;
  std::string scenario_name;
  bool keeps_histories = false;
  std::vector<std::string> columns;  ///< of the results, e.g. max.axial.force; empty: all final and largest values
  std::vector<std::string> results;  ///< formulas for which indices are estimated
  std::optional<BandRequest> bands{};
  std::vector<std::string> doubts{};  ///< values that may not be meant as they are read, a sentence each
  std::string text{};                 ///< of the sweep file
  /// Files that sweep and scenario name, by the keys that name them: scenario (unless it is a table of the sweep file),
  /// table, calibration, and the scenario's own as in named_files().
  std::vector<FileKey> files{};
  std::optional<std::uint64_t> seed{};  ///< of a design that is drawn
  std::string digest;  ///< of everything that determines the results: sweep, scenario, tables, program version
};

/// Reads and checks a sweep file with its scenario and table, and makes its runs. Paths are relative to the file's
/// folder.
///
/// A run that the language refuses, for example with a Poisson's ratio of 0.6, is no fault of the file.
/// @throws ScenarioError with every fault found
[[nodiscard]] Sweep read_sweep(const std::filesystem::path& file);
[[nodiscard]] Sweep parse_sweep(NamedText source);

/// Scenario of a run.
/// @throws ScenarioError with every fault of the scenario with these values
[[nodiscard]] CheckedScenario scenario_of(const Sweep& sweep, std::size_t run);

}  // namespace monograin
