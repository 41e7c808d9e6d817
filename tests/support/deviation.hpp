#pragma once

#include <cmath>
#include <limits>

namespace monograin {

/// Distance of a value from the expected one. Infinite where only one of them is a number: std::max() would drop a NaN.
inline double deviation(double actual, double expected) {
  if (std::isnan(actual) && std::isnan(expected)) return 0.0;
  const double error = std::abs(actual - expected);
  return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
}

}  // namespace monograin
