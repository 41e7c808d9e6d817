/// Weights of the data of a fit, and the noise of y and x from which they follow.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "study/calibrate/calibration.hpp"
#include "study/calibrate/errors_in_x.hpp"
#include "study/calibrate/response.hpp"

namespace monograin {

/// Noise of the data, and the weights of their residuals: one over the standard deviation if the noise is known. Noise
/// of x and noise in proportion to y depend on the fit. Noise of x then adds three things to the residuals of a row: a
/// larger standard deviation, a bias of y by the curvature, and errors of the turns, which all rows after a turn share.
///
/// Slopes and biases follow every response that a search tries (trial_weights()). Noise in proportion to y, and the
/// effects of turns, are those at the last fit: the number and the meaning of residuals stay during a search.
class NoiseModel {
 public:
  /// @param calibration  must outlive the model
  /// @param responses    one for each curve
  NoiseModel(const Calibration& calibration, std::span<const Response> responses);

  /// Indices of the rows that count.
  [[nodiscard]] const std::vector<std::size_t>& rows() const noexcept { return rows_; }
  [[nodiscard]] bool depends_on_fit() const;

  /// Sets biases and trial weights of curves with noise of x by the last responses. Weights that stayed as they were
  /// would make slopes too small (Lybanon (1984), Am. J. Phys. 52, 22).
  void follow_slopes(std::span<const Response> responses);
  /// Sets noise in proportion to y, weights and the effects of turns by a fit. A fit that is far below the datum, as
  /// before first touch, does not make its noise small.
  /// @param responses  that have run with the fit's parameters
  /// @param response   in every row
  /// @return true if weights have changed
  bool follow_fit(std::span<const double> parameters, std::span<const Response> responses,
                  std::span<const double> response);

  /// Weights of all rows at the last fit.
  [[nodiscard]] const std::vector<double>& weights() const noexcept { return weights_; }
  /// Weights of all rows at the last response.
  [[nodiscard]] const std::vector<double>& trial_weights() const noexcept { return trial_weights_; }
  /// Mean of y over the noise of x less y, in every row at the last response.
  [[nodiscard]] const std::vector<double>& curvature_biases() const noexcept { return curvature_biases_; }
  /// Errors of turns, by their effects on weighted residuals of the rows that count.
  [[nodiscard]] const SharedErrors& shared_errors() const noexcept { return shared_; }
  /// Effects of errors of turns on the response in every row, by one standard deviation each.
  [[nodiscard]] Eigen::MatrixXd effects_of_turns() const;

 private:
  struct ErrorsOfCurve {
    std::size_t curve = 0;  ///< one with noise of x
    ErrorsInX errors;
  };
  void set_shared_errors();

  const Calibration& calibration_;
  std::vector<std::size_t> rows_;
  std::vector<double> noise_of_y_;  ///< standard deviation of y in every row
  std::vector<double> curvature_biases_;
  std::vector<double> weights_;
  std::vector<double> trial_weights_;
  std::vector<ErrorsOfCurve> errors_in_x_;
  SharedErrors shared_;
};

}  // namespace monograin
