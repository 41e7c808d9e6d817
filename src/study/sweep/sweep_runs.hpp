/// Runs of a sweep: the values to which each run sets the varied keys.
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

  /// Heading of the column in the results: "material.yield_stress[Pa]".
  [[nodiscard]] std::string heading() const { return Column{key, unit, {}}.heading(); }
};

/// The value of a key in one run: a number in SI, or a word.
using SweepValue = std::variant<double, std::string>;

/// Runs in the order of the design, each with a value for every factor. Only numbers are stored for each run, which may
/// be one of a million; words are stored in a list.
class SweepRuns {
 public:
  void add(const std::vector<SweepValue>& values);

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::vector<SweepValue> operator[](std::size_t run) const;

  bool operator==(const SweepRuns&) const = default;

 private:
  std::size_t size_ = 0;
  std::vector<double> cells_;                    ///< run by run: numbers, or indices of the factor's words
  std::vector<std::vector<std::string>> words_;  ///< words of each factor; empty: it has numbers
};

/// A value as a cell of a CSV file.
[[nodiscard]] std::string cell_of(const SweepValue& value);

/// The scenario with given values, one for each factor.
/// @throws ScenarioError with every fault of the scenario with these values
[[nodiscard]] CheckedScenario scenario_with(const ScenarioTemplate& scenario, std::span<const SweepFactor> factors,
                                            std::span<const SweepValue> values);

}  // namespace monograin
