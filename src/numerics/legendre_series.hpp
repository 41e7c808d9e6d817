/// A smooth function on an interval, known at the nodes of a Gauss-Legendre rule.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace monograin {

inline constexpr std::size_t k_most_nodes = 12;
/// One for each node; what is beyond their number is not used.
using LegendreSamples = std::array<double, k_most_nodes>;

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

  /// Six nodes: what a smooth state needs to be guessed from.
  [[nodiscard]] static const LegendreNodes& few();
  /// Twelve: what an integral needs to be round-off's.
  [[nodiscard]] static const LegendreNodes& many();

  std::size_t count;
  LegendreSamples places{};
  std::array<LegendreSamples, k_most_nodes> to_coefficients{};  ///< of Legendre polynomials, for each sample
  std::array<Ahead, k_most_nodes> ahead{};

 private:
  /// @param abscissae,weights  of the half from the middle onwards
  LegendreNodes(std::span<const double> abscissae, std::span<const double> weights);
  [[nodiscard]] double place_before(std::size_t node, std::size_t back) const noexcept;
  [[nodiscard]] double cardinal(std::size_t node, std::size_t i, std::size_t known, double& slope) const noexcept;
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
  /// @param rounding    last coefficients that may be rounding, and are where the second half does not fall either
  [[nodiscard]] double reach(double negligible, double rounding = 0.0) const noexcept;
  /// The last coefficients, and the largest one.
  [[nodiscard]] double tail() const noexcept;
  [[nodiscard]] double largest() const noexcept;
  /// Its last two terms over the largest one: how far it is from having converged. Nothing where they are negligible.
  [[nodiscard]] double rest(double negligible) const noexcept;

 private:
  [[nodiscard]] double largest_of(std::size_t begin, std::size_t end) const noexcept;

  LegendreSamples coefficients_{};
  std::size_t count_ = 0;
  std::size_t terms_ = 0;  ///< up to the last that is not zero: none of what stays as it is
};

}  // namespace monograin
