/// Numbers that a calibration has found, as inputs of a sweep: normal, and correlated by its covariance.
#pragma once

#include <Eigen/Core>
#include <cstddef>
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

  /// Gives independent shares, one for each key, the correlation: each keeps its uniform distribution (Gaussian
  /// copula).
  /// @param shares  between 0 and 1
  void correlate(std::span<double> shares) const;
};

/// Text of the result of a calibration. @param path  of its calibration.json, or of the folder with that
/// @throws std::runtime_error with what is wrong
[[nodiscard]] std::string text_of_calibration(std::filesystem::path path);

/// Reads what `monograin calibrate` writes. Numbers of the machine are left out.
/// @param text  of a calibration.json
/// @throws std::runtime_error with what is wrong: another file, a number that the data do not determine, numbers that
/// depend on each other
[[nodiscard]] JointNormal read_joint_normal(std::string_view text);

}  // namespace monograin
