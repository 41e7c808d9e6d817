/// Relative errors, and derivatives by differences.
#pragma once

#include <cmath>

#include "system/resolution.hpp"

namespace monograin {

/// |actual - expected| over |expected|; 0 where both are 0.
[[nodiscard]] inline double relative_error(double actual, double expected) noexcept {
  return actual == expected ? 0.0 : std::abs(actual - expected) / std::abs(expected);
}

/// f'(x) from six values up to three steps away; truncation error f^(7) step^6 / 140.
/// The step is rounded down to a power of two, so that the arguments carry no rounding error.
template <class Function>
[[nodiscard]] double central_difference(Function&& f, double x, double largest_step) {
  const double step = std::exp2(std::floor(std::log2(largest_step)));
  const auto odd_part = [&](int k) { return f(x + k * step) - f(x - k * step); };
  return (45.0 * odd_part(1) - 9.0 * odd_part(2) + odd_part(3)) / (60.0 * step);
}

}  // namespace monograin
