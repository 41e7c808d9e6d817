/// Parameters found by a calibration as inputs of a sweep: normal, and correlated by their covariance.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace monograin {

struct JointNormal {
  std::vector<std::string> keys;
  std::vector<double> means;            ///< [SI]
  std::vector<double> standard_errors;  ///< [SI], > 0
  Eigen::MatrixXd factor;               ///< lower triangle L, L L^T the correlation

  /// Correlates independent shares, one for each key; each share keeps its uniform distribution (Gaussian copula).
  /// @param shares  between 0 and 1
  void correlate(std::span<double> shares) const;
};

/// Text of the result of a calibration. @param path  of its calibration.json, or of the folder that contains it
/// @throws std::runtime_error with what is wrong
[[nodiscard]] std::string text_of_calibration(std::filesystem::path path);

/// Reads the result that `monograin calibrate` writes, without the numbers of the machine.
/// @param text  of a calibration.json
/// @throws std::runtime_error with the problem: another file, a number that the data do not determine, or numbers that
/// depend on each other
[[nodiscard]] JointNormal read_joint_normal(std::string_view text);

}  // namespace monograin
