/// Stored curves: every ready scenario is run in all its forms and held against the curve that was kept.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace monograin {

/// One scenario run by one integrator, against its stored curve.
struct RegressionResult {
  std::string scenario;
  std::string integrator;
  double difference = 0.0;  ///< largest of any column over its largest magnitude; of contact radii, of their squares
  std::string column;       ///< where that is
  double event_time = 0.0;  ///< largest difference of an event's time, over the run's length
  double tolerance = 0.0;   ///< that both were held against
  std::string fault;        ///< why they cannot be compared; empty: they can

  [[nodiscard]] bool passes() const noexcept {
    return fault.empty() && difference <= tolerance && event_time <= tolerance;
  }
};

/// Runs every scenario of a folder with every integrator that it can be run with, and compares with NAME.csv and
/// NAME.events.csv of another folder.
[[nodiscard]] std::vector<RegressionResult> regress(const std::filesystem::path& scenarios,
                                                    const std::filesystem::path& curves);

/// Stores the curve of every scenario anew, computed by the direct form, or where there is none, by an integrator at a
/// hundredth of the scenario's tolerances. Returns how far each new curve is from the old one.
std::vector<RegressionResult> accept_curves(const std::filesystem::path& scenarios,
                                            const std::filesystem::path& curves);

}  // namespace monograin
