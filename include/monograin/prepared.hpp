/// Many runs of one scenario with different values of some keys.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "monograin/run.hpp"
#include "monograin/scenario.hpp"

namespace monograin {

/// Options of PreparedScenario::map().
struct MapOptions {
  int threads = 0;  ///< number of threads; 0: one for each core
  /// Called between runs, always on the calling thread. Returning true ends map() early: no further sample is begun,
  /// and the status of samples not run stays empty; nothing is thrown. An empty function never ends it.
  std::function<bool()> stop{};
};

/// Results of PreparedScenario::map(): one row per sample.
struct MapResult {
  std::vector<double> values;        ///< shape (samples, formulas), row by row; NaN where a formula has no value
  std::vector<std::string> status;   ///< per sample: complete, stopped, failed or refused; empty: not run
  std::vector<std::string> message;  ///< per sample: why it did not complete; empty if it did
};

/// A scenario that is read once and run with different values of some keys.
///
/// Results of run() are bitwise equal to those of a file with these values in it. Copies share the scenario that was
/// read. All functions may be called from many threads.
class PreparedScenario {
 public:
  /// Reads and checks a scenario.
  /// @param keys  keys whose values are numbers, spelled as for Scenario::set()
  /// @throws ScenarioError with all faults of the scenario, or with the keys that do not hold a number or stand twice
  /// @throws std::invalid_argument without keys
  PreparedScenario(const Scenario& scenario, std::vector<std::string> keys);
  /// A prepared scenario that was moved from stays as it was.
  PreparedScenario(const PreparedScenario&) = default;
  PreparedScenario& operator=(const PreparedScenario&) = default;

  /// The keys that vary, in the order in which run() and map() take their values.
  [[nodiscard]] const std::vector<std::string>& keys() const noexcept;

  /// Runs the scenario with these values.
  /// @param values  in SI units, one for each key
  /// @throws ScenarioError if a value is not admissible
  /// @throws std::invalid_argument if the number of values is not that of the keys
  /// @throws RunInterrupted if the options end the run
  [[nodiscard]] RunResult run(std::span<const double> values, const RunOptions& options = {}) const;

  /// Runs many samples on many threads and returns a few numbers of each. A refused sample does not end the others.
  ///
  /// Values agree with those of run() to round-off. Parts of a history that no formula reads are not computed: the
  /// energies and, if every name stands alone in end(), all rows before the last. Such a run takes about a fifth of the
  /// time of a whole one.
  ///
  /// @param samples   shape (samples, keys), row by row, in SI units
  /// @param formulas  formulas over the columns of the history with one value each, such as `max(axial.force)` or
  ///                  `end(apparent_radius) / 1e-3`; functions are those of figures: max, min, end, sqrt, ...
  /// @throws std::invalid_argument for a formula that cannot be read, names an unknown column or one of words, or has a
  ///         value for each row, if the number of values is not a multiple of the number of keys, and for fewer threads
  ///         than 0
  [[nodiscard]] MapResult map(std::span<const double> samples, std::span<const std::string> formulas,
                              const MapOptions& options = {}) const;

 private:
  struct Content;
  std::shared_ptr<const Content> content_;
};

}  // namespace monograin
