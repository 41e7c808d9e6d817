/// Runs of a sweep: what each sets the varied keys to.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "history/table.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// A key that is varied.
struct SweepFactor {
  std::string key;         ///< path as of `--set`
  std::string unit;        ///< SI, "-" of a pure number; empty: its values are words
  bool is_toggle = false;  ///< its words are true and false

  /// As in the results: "material.yield_stress[Pa]".
  [[nodiscard]] std::string heading() const { return Column{key, unit, {}}.heading(); }
};

/// The value of a key in one run: a number in SI, or a word.
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

/// A value as a cell of a CSV file.
[[nodiscard]] std::string cell_of(const SweepValue& value);

/// The scenario with these values, one for each factor.
/// @throws ScenarioError with every fault of the scenario with them
[[nodiscard]] CheckedScenario scenario_with(const ScenarioTemplate& scenario, std::span<const SweepFactor> factors,
                                            std::span<const SweepValue> values);

}  // namespace monograin
