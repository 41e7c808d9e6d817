/// Sweep files: one scenario, the keys that are varied, and the runs this makes.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "history/table.hpp"
#include "scenario/scenario.hpp"
#include "study/sweep/design.hpp"

namespace monograin {

/// A key that is varied.
struct SweepFactor {
  std::string key;         ///< path as of `--set`
  std::string unit;        ///< SI, "-" of a pure number; empty: its values are words
  bool is_toggle = false;  ///< its words are true and false

  /// As in the results: "material.yield_stress[Pa]".
  [[nodiscard]] std::string heading() const { return Column{key, unit, {}}.heading(); }
};

/// What one run sets a key to: a number in SI, or a word.
using SweepValue = std::variant<double, std::string>;

/// Runs in the order of the design, each with a value for every factor. Of a million of them only numbers are kept:
/// words stand in a list.
class SweepRuns {
 public:
  void add(const std::vector<SweepValue>& values);

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::vector<SweepValue> operator[](std::size_t run) const;

  bool operator==(const SweepRuns&) const = default;

 private:
  std::size_t size_ = 0;
  std::vector<double> cells_;                    ///< run by run: numbers, and places in the factor's words
  std::vector<std::vector<std::string>> words_;  ///< of each factor; empty: it has numbers
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
  std::string digest;                ///< of all that decides on the results: sweep, scenario, tables, program version
};

/// Reads and checks a sweep file with its scenario and table, which are sought from its folder, and makes its runs.
///
/// A run that the language refuses, such as one with a Poisson's ratio of 0.6, is no fault of the file.
/// @throws ScenarioError with every fault found
[[nodiscard]] Sweep read_sweep(const std::filesystem::path& file);

/// What a run sets, as `key=value`.
[[nodiscard]] std::vector<std::string> overrides_of(const Sweep& sweep, std::size_t run);

/// The scenario of a run.
/// @throws ScenarioError with every fault of the scenario with these values
[[nodiscard]] CheckedScenario scenario_of(const Sweep& sweep, std::size_t run);

/// A value as a cell of a CSV file.
[[nodiscard]] std::string cell_of(const SweepValue& value);

/// The runs as a CSV table that `design = "table"` reads back, bit by bit.
[[nodiscard]] std::string design_text(const Sweep& sweep);

}  // namespace monograin
