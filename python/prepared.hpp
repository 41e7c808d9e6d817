/// A scenario that is run many times with other numbers.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "history/run.hpp"
#include "scenario/scenario.hpp"
#include "study/formula/expression.hpp"

namespace monograin::python {

/// How one of many runs has ended. Numbers are those in the arrays of the package.
enum class RowStatus : signed char { pending = 0, complete = 1, stopped = 2, failed = 3, refused = 4 };

/// A scenario whose text is parsed once, with the keys of numbers that change from run to run. Every run gives the
/// numbers of a file in which these were edited.
class Prepared {
 public:
  /// @param keys  paths as of overrides: "material.yield_stress"
  /// @throws ScenarioError where the scenario has no such key, or the key takes no number
  Prepared(const Scenario& scenario, const std::string& origin, std::vector<std::string> keys);

  [[nodiscard]] const std::vector<std::string>& keys() const noexcept { return keys_; }

  /// The checked scenario with these values [SI]. May be called from many threads.
  /// @throws ScenarioError  where the scenario refuses one of them
  /// @throws std::invalid_argument  for another number of values than of keys
  [[nodiscard]] Scenario with(std::span<const double> values) const;

  /// Rows of samples, one run for each, and where their results go.
  struct Batch {
    std::span<const double> samples;   ///< row by row, a value for each key
    std::span<double> results;         ///< row by row, a value for each formula
    std::span<RowStatus> statuses;     ///< one for each row
    std::vector<Expression> formulas;  ///< of the columns of a history; each gives one number
    int threads = 0;                   ///< 0: one for each core
  };

  /// Runs all rows that are pending. Rows of runs that are refused or fail hold nan.
  /// @param stop  once true, no further run begins; rows that were not run stay pending
  /// @throws ExpressionError for an unknown column, and for a formula that gives more numbers than one
  void map(const Batch& batch, const std::atomic<bool>& stop) const;

 private:
  [[nodiscard]] RowStatus run_row(std::span<const double> values, const std::vector<Expression>& formulas,
                                  std::span<double> results) const;

  ScenarioTemplate template_;
  std::vector<std::string> overrides_;  ///< that the scenario has already
  std::vector<std::string> keys_;
};

}  // namespace monograin::python
