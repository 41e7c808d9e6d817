/// Sweep files: one scenario, the keys that are varied, and the runs this makes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "study/sweep/design.hpp"
#include "study/sweep/sweep_runs.hpp"

namespace monograin {

/// Which percentiles of the histories are asked for.
struct BandRequest {
  std::string x;                                     ///< column of the histories
  std::vector<std::string> y;                        ///< columns
  std::vector<double> percentiles{5.0, 50.0, 95.0};  ///< ascending, between 0 and 100
  int points = 51;                                   ///< abscissae in each step
};

struct Sweep {
  std::string name;    ///< of the file, without folder and extension
  std::string design;  ///< grid, table, maxpro, sobol, halton, lhs, random, saltelli, morris
  std::vector<SweepFactor> factors;
  SweepRuns runs;
  std::size_t left_out = 0;  ///< points of a grid that the constraints exclude
  Design points;             ///< the runs as points of a cube
  ScenarioTemplate scenario;
  std::string scenario_name;
  bool keeps_histories = false;
  std::vector<std::string> results;  ///< formulas for which indices are estimated
  std::optional<BandRequest> bands{};
  std::string digest;  ///< of all that decides on the results: sweep, scenario, tables, program version
};

/// Reads and checks a sweep file with its scenario and table, which are sought from its folder, and makes its runs.
///
/// A run that the language refuses, such as one with a Poisson's ratio of 0.6, is no fault of the file.
/// @throws ScenarioError with every fault found
[[nodiscard]] Sweep read_sweep(const std::filesystem::path& file);

/// The scenario of a run.
/// @throws ScenarioError with every fault of the scenario with these values
[[nodiscard]] CheckedScenario scenario_of(const Sweep& sweep, std::size_t run);

/// The runs as a CSV table that `design = "table"` reads back, bit by bit.
[[nodiscard]] std::string design_text(const Sweep& sweep);

}  // namespace monograin
