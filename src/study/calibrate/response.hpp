/// Responses of measured curves to the parameters of a fit, the machine between them and the particle.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/calibrate/calibration.hpp"
#include "study/calibrate/machine.hpp"
#include "study/calibrate/replay.hpp"

namespace monograin {

/// Relative error of the responses.
[[nodiscard]] double noise_of(const Calibration& calibration);

/// Measured values of one of the curves.
[[nodiscard]] std::vector<double> x_of(const Calibration& calibration, const MeasuredCurve& curve);
[[nodiscard]] std::vector<double> y_of(const Calibration& calibration, const MeasuredCurve& curve);

/// The response of one curve's scenario as the residuals of a problem, with the parameters of a fit.
class Response {
 public:
  /// @param x, y  what was measured
  Response(const Calibration& calibration, const MeasuredCurve& curve, std::vector<double> x, std::vector<double> y);

  /// @return whether there is a response
  bool operator()(std::span<const double> parameters, std::span<double> response);

  /// Displacements at the particle in the last run, where x or y is a displacement.
  [[nodiscard]] const std::vector<double>& particle() const noexcept { return particle_; }
  [[nodiscard]] const Replay& replay() const noexcept { return replay_; }
  /// Why there was no response.
  [[nodiscard]] const std::string& problem() const noexcept { return problem_.empty() ? replay_.problem() : problem_; }

 private:
  bool run_in_series(const Machine& machine, std::span<double> response);

  const Calibration& calibration_;
  const MeasuredCurve& curve_;
  Replay replay_;
  std::vector<double> x_;
  std::vector<double> y_;
  double noise_;  ///< relative error of a response
  std::vector<double> particle_;
  bool is_moved_ = false;  ///< the replay follows other values than x
  std::string problem_;
};

}  // namespace monograin
