/// Priors: knowledge of a parameter before the data.
#pragma once

#include <string>
#include <string_view>

namespace monograin {

/// Distribution of one parameter. Normal: the parameter itself is normal; lognormal: its natural logarithm; uniform:
/// all values between the bounds are equal.
struct Prior {
  enum class Kind { normal, lognormal, uniform };
  Kind kind = Kind::normal;
  double first = 0.0;   ///< mean, median, lower bound [SI]
  double second = 0.0;  ///< standard deviation [SI], that of the logarithm, upper bound [SI]

  /// Distance from the centre in standard deviations; zero for a uniform one.
  /// @param value  > 0 for a lognormal one
  [[nodiscard]] double deviation(double value) const noexcept;
  /// Derivative of the deviation with respect to the value.
  [[nodiscard]] double slope(double value) const noexcept;
  /// True if the prior adds to the sum of squares; a uniform prior only bounds the search.
  [[nodiscard]] bool is_residual() const noexcept { return kind != Kind::uniform; }
};

/// Name of a kind: "normal", "lognormal", "uniform".
[[nodiscard]] std::string_view word_of(Prior::Kind kind) noexcept;

/// Text that describes a prior, with values in units of the parameter: "normal 1.2 +- 0.1 GPa".
/// @param unit_factor  one unit in SI
[[nodiscard]] std::string describe(const Prior& prior, const std::string& unit, double unit_factor);

}  // namespace monograin
