/// A smooth function on an interval, known at the nodes of a Gauss-Legendre rule.
#pragma once

#include <array>
#include <cstddef>

namespace monograin {

inline constexpr std::size_t k_legendre_nodes = 12;
using LegendreSamples = std::array<double, k_legendre_nodes>;

/// The rule's nodes on [-1, 1], and what samples there are multiplied by.
class LegendreNodes {
 public:
  /// Places before a node from which a function is extended to it.
  static constexpr std::size_t k_known = 3;

  /// What extends the polynomial through values and slopes at the last places before a node, the nearest first, to that
  /// node; the beginning of the interval, -1, is one of the places.
  struct Ahead {
    std::array<double, k_known> values{};
    std::array<double, k_known> slopes{};
    double onward = 0.0;  ///< the distance to the node over that between the last two places
  };

  [[nodiscard]] static const LegendreNodes& instance();

  LegendreSamples places{};
  std::array<LegendreSamples, k_legendre_nodes> to_coefficients{};  ///< of Legendre polynomials
  std::array<Ahead, k_legendre_nodes> ahead{};

 private:
  LegendreNodes();
  [[nodiscard]] double place_before(std::size_t node, std::size_t back) const noexcept;
  [[nodiscard]] double cardinal(std::size_t node, std::size_t i, std::size_t count, double& slope) const noexcept;
};

/// A sum of Legendre polynomials through samples at the nodes.
class LegendreSeries {
 public:
  void fit(const LegendreNodes& nodes, const LegendreSamples& samples) noexcept;

  /// @param t  in [-1, 1]
  [[nodiscard]] double value(double t) const noexcept;
  /// From -1 to t.
  [[nodiscard]] double integral(double t) const noexcept;

  /// How many times as long the interval could be for the series to have converged just so; its last term goes with the
  /// length to the power of its degree.
  /// @param negligible  error of the integral over [-1, 1] that does not count, however large a share of it that is
  [[nodiscard]] double reach(double negligible) const noexcept;

 private:
  LegendreSamples coefficients_{};
};

}  // namespace monograin
