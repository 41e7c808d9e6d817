/// Losses: functions that weigh the residuals of a fit.
#pragma once

namespace monograin {

/// Loss rho(r) of a residual r. rho = r^2 if r is small beside the scale c of the loss.
enum class Loss {
  linear,   ///< r^2
  huber,    ///< r^2 up to c, then 2 c |r| - c^2
  soft_l1,  ///< 2 c^2 (sqrt(1 + (r/c)^2) - 1)
  cauchy    ///< c^2 log(1 + (r/c)^2)
};

struct LossFunction {
  Loss kind = Loss::linear;
  double scale = 1.0;  ///< c > 0, in units of the residuals

  [[nodiscard]] double rho(double residual) const noexcept;
  /// Half of rho's derivative: r for the linear loss.
  [[nodiscard]] double influence(double residual) const noexcept;
  /// Half of rho's second derivative: 1 for the linear loss.
  [[nodiscard]] double curvature(double residual) const noexcept;
};

}  // namespace monograin
