/// Stored curves: every ready scenario is run in all its forms and held against the curve that was kept.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "system/undefined.hpp"

namespace monograin {

/// One scenario run by one integrator, against its stored curve; measures are NaN where nothing could be compared.
struct RegressionResult {
  std::string scenario;
  std::string integrator;     ///< empty: a stored curve that has no scenario
  double difference = k_nan;  ///< largest of any column over its largest magnitude; of contact radii, of their squares
  std::string column;         ///< where that is
  double event_time = k_nan;  ///< largest difference of an event's time, over the run's length
  double tolerance = 0.0;     ///< that both were held against
  std::string fault;          ///< what differs beside numbers, or keeps them from being compared; empty: nothing

  [[nodiscard]] bool passes() const noexcept {
    return fault.empty() && difference <= tolerance && event_time <= tolerance;
  }
};

/// Runs every scenario of a folder with every integrator that it can be run with, and compares with NAME.csv and
/// NAME.events.csv of another folder: columns, words and events must be the same, and each curve must cover the other.
/// A stored curve without a scenario is a result with a fault.
/// @throws std::runtime_error where there is no scenario
[[nodiscard]] std::vector<RegressionResult> regress(const std::filesystem::path& scenarios,
                                                    const std::filesystem::path& curves);

/// Stores the curve of every scenario anew, computed by the direct form, or where there is none, by an integrator at a
/// hundredth of the scenario's tolerances. Returns how far each new curve is from the old one.
std::vector<RegressionResult> accept_curves(const std::filesystem::path& scenarios,
                                            const std::filesystem::path& curves);

}  // namespace monograin
