/// Losses: how much the residuals of a fit count.
#pragma once

namespace monograin {

/// How a residual r counts: rho(r), with rho = r^2 where r is small beside the loss' scale c.
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
  /// Half of rho's derivative: r where the loss is linear.
  [[nodiscard]] double influence(double residual) const noexcept;
  /// Half of its second derivative: 1 where the loss is linear.
  [[nodiscard]] double curvature(double residual) const noexcept;
};

}  // namespace monograin
