/// Stored curves: every ready scenario is run in all its forms and compared with its stored curve.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "system/resolution.hpp"

namespace monograin {

/// Difference of one scenario, run by one integrator, from its stored curve; nan where nothing could be compared.
struct RegressionResult {
  std::string scenario;
  std::string integrator{};   ///< empty: a stored curve that has no scenario
  double difference = k_nan;  ///< largest of any column, over the column's largest magnitude; contact radii are squared
  std::string column{};       ///< column of that difference
  double event_time = k_nan;  ///< largest difference of an event's time, over the run's length
  double tolerance = 0.0;     ///< largest admissible value of both differences
  std::string fault{};        ///< differences that are no numbers, or why nothing was compared; empty: none

  [[nodiscard]] bool passes() const noexcept {
    return fault.empty() && difference <= tolerance && event_time <= tolerance;
  }
};

/// Runs every scenario of a folder with `direct` (if its model has that form), `cvode-adams`, `cvode-bdf` and `ida`,
/// and compares each run with NAME.csv and NAME.events.csv of another folder: columns, words and events must be the
/// same, each curve must cover the other, and the values at events count like those of the curves. A stored curve
/// without a scenario is a result with a fault.
/// @throws std::runtime_error if there is no scenario
[[nodiscard]] std::vector<RegressionResult> regress(const std::filesystem::path& scenarios,
                                                    const std::filesystem::path& curves);

/// Stores the curve of every scenario anew, computed by the direct form; if there is none, by an integrator at a
/// hundredth of the scenario's tolerances.
/// @return the difference of each new curve from the old one
/// @throws std::runtime_error if a scenario does not run to its end
std::vector<RegressionResult> accept_curves(const std::filesystem::path& scenarios,
                                            const std::filesystem::path& curves);

}  // namespace monograin
