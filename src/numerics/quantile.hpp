/// Quantiles of samples.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace monograin {

/// Quantile by linear interpolation between order statistics (Hyndman and Fan (1996), definition 7).
/// @param ascending  sorted values, at least one
/// @param share      between 0 and 1
[[nodiscard]] inline double quantile(std::span<const double> ascending, double share) noexcept {
  const double place = share * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, ascending.size() - 1);
  return std::lerp(ascending[below], ascending[above], place - static_cast<double>(below));
}

}  // namespace monograin
