#include "numerics/loss.hpp"

#include <algorithm>
#include <cmath>

namespace monograin {

double LossFunction::rho(double residual) const noexcept {
  const double u = residual / scale;
  switch (kind) {
    case Loss::linear:
      return residual * residual;
    case Loss::huber:
      return std::abs(u) <= 1.0 ? residual * residual : scale * scale * (2.0 * std::abs(u) - 1.0);
    case Loss::soft_l1:  // sqrt(1 + u^2) - 1 in a form that keeps its digits
      return 2.0 * residual * residual / (std::sqrt(1.0 + u * u) + 1.0);
    case Loss::cauchy:
      return scale * scale * std::log1p(u * u);
  }
  return 0.0;
}

double LossFunction::influence(double residual) const noexcept {
  const double u = residual / scale;
  switch (kind) {
    case Loss::linear:
      return residual;
    case Loss::huber:
      return scale * std::clamp(u, -1.0, 1.0);
    case Loss::soft_l1:
      return residual / std::sqrt(1.0 + u * u);
    case Loss::cauchy:
      return residual / (1.0 + u * u);
  }
  return 0.0;
}

double LossFunction::curvature(double residual) const noexcept {
  const double u2 = residual * residual / (scale * scale);
  switch (kind) {
    case Loss::linear:
      return 1.0;
    case Loss::huber:
      return u2 <= 1.0 ? 1.0 : 0.0;
    case Loss::soft_l1:
      return 1.0 / ((1.0 + u2) * std::sqrt(1.0 + u2));
    case Loss::cauchy:
      return (1.0 - u2) / ((1.0 + u2) * (1.0 + u2));
  }
  return 0.0;
}

}  // namespace monograin
