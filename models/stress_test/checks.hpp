/// Tools with which a model checks the histories of its own scenes in the stress test.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "system/model_input.hpp"
#include "system/number_text.hpp"

namespace monograin {

/// A rule that is broken, with the numbers that show it.
struct Violation {
  std::string check;
  std::string detail;
};

/// Rows of a history, columns by their names without units.
class HistoryRows {
 public:
  virtual ~HistoryRows() = default;
  [[nodiscard]] virtual std::size_t row_count() const noexcept = 0;
  [[nodiscard]] virtual std::optional<std::size_t> find(std::string_view column) const noexcept = 0;
  [[nodiscard]] virtual double at(std::size_t row, std::size_t column) const = 0;
  /// The word in a cell of a column that holds words.
  [[nodiscard]] virtual std::string_view word(std::size_t row, std::size_t column) const = 0;

  /// Index of a column that the history has.
  [[nodiscard]] std::size_t column(std::string_view name) const { return find(name).value(); }
  [[nodiscard]] virtual double largest_magnitude(std::size_t column) const = 0;
};

/// A run that its model checks.
struct CheckedRun {
  const ModelInput& input;
  const HistoryRows& rows;
  std::span<const ContactClass> classes;
  double tolerance = 0.0;  ///< error that the integrator is allowed, over the largest values
  double round_off = 0.0;  ///< round-off of strains and other numbers of order one
};

/// Adds a violation for the first row of a history, if any, that breaks a rule.
/// @param check   name of the rule
/// @param what    begins the violation's text
/// @param excess  row -> by how much the row breaks the rule; <= 0 if it does not
template <class Excess>
void check_rows(const CheckedRun& run, std::string_view check, std::string_view what, std::vector<Violation>& found,
                Excess&& excess) {
  const std::size_t time = run.rows.column("time");
  for (std::size_t row = 0; row < run.rows.row_count(); ++row) {
    const double value = excess(row);
    if (value <= 0.0) continue;
    found.push_back({std::string(check), std::string(what) + ", by " + number_text(value, 3) +
                                             " at t = " + number_text(run.rows.at(row, time), 9) + " s"});
    return;
  }
}

/// Checks that the values of a column never fall below the largest value so far by more than a tolerance.
inline void check_growth(const CheckedRun& run, std::string_view name, double tolerance,
                         std::vector<Violation>& found) {
  double largest = 0.0;
  check_rows(run, "shrinking", name, found, [&, column = run.rows.column(name)](std::size_t row) {
    largest = std::max(largest, run.rows.at(row, column));
    return largest - run.rows.at(row, column) - tolerance;
  });
}

}  // namespace monograin
