/// Many runs of one scenario that differ in numbers.
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

struct MapOptions {
  int threads = 0;  ///< 0: one for each core
  /// Asked between runs, from the calling thread; true ends the call before its rows are done. May be empty.
  std::function<bool()> stop{};
};

/// Results of many runs.
struct MapResult {
  std::vector<double> values;        ///< row by row, a value for each formula; NaN where a run has none
  std::vector<std::string> status;   ///< of each row: complete, stopped, failed, refused; empty: it was not done
  std::vector<std::string> message;  ///< of each row: why it did not complete
};

/// A scenario that is read once, and run with other values of some keys: the same results, bit by bit, as of a file
/// with these values in it, in a fraction of the time.
///
/// Copies share what was read. All functions may be called from many threads.
class PreparedScenario {
 public:
  /// @param keys  of numbers, as Scenario::set() takes them
  /// @throws ScenarioError with all faults of the scenario, and a key that holds no number
  PreparedScenario(const Scenario& scenario, std::vector<std::string> keys);

  [[nodiscard]] const std::vector<std::string>& keys() const noexcept;

  /// @param values  in SI units, one for each key
  /// @throws ScenarioError where the values are not admissible
  /// @throws std::invalid_argument for another number of values
  [[nodiscard]] RunResult run(std::span<const double> values) const;

  /// Runs many samples on many threads and keeps a few results of each. A sample that is refused costs its row only.
  ///
  /// Values agree with those of run() to round-off. What the formulas do not read is not computed: the energies, and,
  /// where every name stands alone in end(), all rows before the last. That takes a fifth of the time of a whole run.
  ///
  /// @param samples   row by row, a value for each key
  /// @param formulas  over the columns of the history, each with one value: `max(axial.force)`,
  ///                  `end(apparent_radius) / 1e-3`, with the functions max, min, end, sqrt, ... of figures
  /// @throws std::invalid_argument for a formula that cannot be read, or samples that are no whole rows
  [[nodiscard]] MapResult map(std::span<const double> samples, std::span<const std::string> formulas,
                              const MapOptions& options = {}) const;

 private:
  struct Content;
  std::shared_ptr<const Content> content_;
};

}  // namespace monograin
