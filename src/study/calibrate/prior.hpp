/// Priors: the knowledge of a parameter before there are data.
#pragma once

#include <string>
#include <string_view>

namespace monograin {

/// A distribution of one parameter. Normal: of the parameter; lognormal: of its natural logarithm; uniform: none but
/// within bounds.
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
  /// Whether it adds to the sum of squares; a uniform one bounds the search alone.
  [[nodiscard]] bool is_residual() const noexcept { return kind != Kind::uniform; }
};

/// "normal", "lognormal", "uniform".
[[nodiscard]] std::string_view word_of(Prior::Kind kind) noexcept;

/// The prior for a reader, its values in units of the parameter: "normal 1.2 +- 0.1 GPa".
/// @param unit_factor  one unit in SI
[[nodiscard]] std::string describe(const Prior& prior, const std::string& unit, double unit_factor);

}  // namespace monograin
