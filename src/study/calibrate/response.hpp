/// Responses of measured curves to the parameters of a fit, including the machine between sensor and particle.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/calibrate/calibration.hpp"
#include "study/calibrate/machine.hpp"
#include "study/calibrate/replay.hpp"

namespace monograin {

/// Relative error of runs whose states are solved for.
inline constexpr double k_direct_noise = 1e-13;

/// Relative error of the responses.
[[nodiscard]] double noise_of(const Calibration& calibration);

/// Response of one curve's scenario to the parameters of a fit, for the residuals of a least-squares problem.
class Response {
 public:
  /// @param path  of x
  /// @param y     means of the measured rows at each point of the path: where the search for the particle's
  ///              displacements in series with a machine starts
  Response(const Calibration& calibration, const MeasuredCurve& curve, DataPath path, std::vector<double> y);

  /// @return true if there is a response
  bool operator()(std::span<const double> parameters, std::span<double> response);

  /// Displacements at the particle in the last run, if x or y is a displacement.
  [[nodiscard]] std::vector<double> particle() const {
    return particle_.empty() ? std::vector<double>() : path().at_rows(particle_);
  }
  /// The last response at the points of the path.
  [[nodiscard]] std::span<const double> at_points() const noexcept { return response_; }
  [[nodiscard]] const Replay& replay() const noexcept { return replay_; }
  /// Reason why there was no response.
  [[nodiscard]] const std::string& problem() const noexcept { return problem_.empty() ? replay_.problem() : problem_; }

 private:
  [[nodiscard]] const DataPath& path() const noexcept { return replay_.path(); }
  bool run(const Machine& machine);
  bool run_in_series(const Machine& machine);

  const Calibration& calibration_;
  const MeasuredCurve& curve_;
  Replay replay_;
  std::vector<double> measured_;  ///< means of the rows at each point of the path
  double noise_;                  ///< relative error of a response
  std::vector<double> particle_;  ///< displacements at the points; empty if neither x nor y is a displacement
  std::vector<double> response_;  ///< at the points
  bool is_moved_ = false;         ///< the replay follows values other than x
  std::string problem_;
};

}  // namespace monograin
