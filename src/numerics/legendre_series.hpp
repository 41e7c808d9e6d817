/// A smooth function on an interval, known at the nodes of a Gauss-Legendre rule.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace monograin {

inline constexpr std::size_t k_most_nodes = 12;
/// One value for each node of a rule; values beyond the number of nodes are not used.
using LegendreSamples = std::array<double, k_most_nodes>;

/// Nodes of a rule on [-1, 1], and coefficients that turn samples into a series or extrapolate them.
class LegendreNodes {
 public:
  /// Number of positions before a node from which a function is extrapolated to it.
  static constexpr std::size_t k_known = 3;

  /// Coefficients that extrapolate the polynomial through values and slopes at the last positions before a node to that
  /// node. The nearest position comes first; the beginning of the interval, -1, counts as a position.
  struct Ahead {
    std::array<double, k_known> values{};
    std::array<double, k_known> slopes{};
    double onward = 0.0;  ///< distance from the last position to the node over that between the last two positions
  };

  /// The rule with six nodes, enough to predict a smooth state.
  [[nodiscard]] static const LegendreNodes& few();
  /// The rule with twelve nodes, enough to integrate to round-off.
  [[nodiscard]] static const LegendreNodes& many();

  std::size_t count;
  LegendreSamples places{};
  std::array<LegendreSamples, k_most_nodes> to_coefficients{};  ///< contribution of each sample to the coefficients
  std::array<Ahead, k_most_nodes> ahead{};

 private:
  /// @param abscissae, weights  of the half of the rule from the middle onwards
  LegendreNodes(std::span<const double> abscissae, std::span<const double> weights);
  [[nodiscard]] double place_before(std::size_t node, std::size_t back) const noexcept;
  [[nodiscard]] double cardinal(std::size_t node, std::size_t i, std::size_t known, double& slope) const noexcept;
};

/// A sum of Legendre polynomials through samples at the nodes.
class LegendreSeries {
 public:
  void fit(const LegendreNodes& nodes, const LegendreSamples& samples) noexcept;

  /// Value at t in [-1, 1].
  [[nodiscard]] double value(double t) const noexcept;
  /// Integral from -1 to t.
  [[nodiscard]] double integral(double t) const noexcept;

  /// How many times as long the interval could be for the series to just converge; at most 2. The last term is taken to
  /// be proportional to the length to the power of its degree.
  /// @param negligible  error of the integral over [-1, 1] that is tolerated, however small the integral
  /// @param round_off   largest last coefficients that count as round-off if the second half of the series is flat
  [[nodiscard]] double reach(double negligible, double round_off = 0.0) const noexcept;
  /// Sum of the last two coefficients' magnitudes.
  [[nodiscard]] double tail() const noexcept;
  /// Largest magnitude of a coefficient.
  [[nodiscard]] double largest() const noexcept;
  /// Larger one of the last two terms over the largest term: shows how far the series is from convergence. 0 if the
  /// last terms do not exceed `negligible`.
  [[nodiscard]] double rest(double negligible) const noexcept;

 private:
  [[nodiscard]] double largest_of(std::size_t begin, std::size_t end) const noexcept;

  LegendreSamples coefficients_{};
  std::size_t count_ = 0;
  std::size_t terms_ = 0;  ///< number of terms up to the last one that is not zero
};

}  // namespace monograin
