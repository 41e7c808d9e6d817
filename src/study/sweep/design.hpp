/// Space-filling designs of experiments: points in a unit cube, each with a level of one nominal factor if there is
/// one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace monograin {

struct Design {
  std::size_t factors = 0;            ///< continuous ones
  std::size_t level_count = 0;        ///< of the nominal factor; 0: there is none
  std::vector<double> coordinates{};  ///< point by point, each coordinate in [0, 1]
  std::vector<std::size_t> levels{};  ///< of every point, below level_count; empty: no nominal factor

  [[nodiscard]] std::size_t size() const noexcept { return factors == 0 ? 0 : coordinates.size() / factors; }
  [[nodiscard]] std::span<const double> point(std::size_t index) const {
    return std::span(coordinates).subspan(index * factors, factors);
  }
};

/// Maximum projection criterion; the smaller, the better the points fill the cube and all of its projections.
///
///   psi = { mean over i < j of 1 / [ prod_l (x_il - x_jl)^2 (I(v_i != v_j) + 1/k)^2 ] }^(1/(p + 1))
///
/// for p continuous factors and a nominal one with k levels; without that the second bracket drops out and the exponent
/// is 1/p. Infinite where two points share a coordinate, and for fewer than two points nan.
/// Source: Joseph, Gul, Ba (2015), Biometrika 102, 371-380, and its extension to nominal factors.
[[nodiscard]] double maxpro_criterion(const Design& design);

/// The cube that a design has to fill.
struct DesignSpace {
  std::size_t factors = 1;                                  ///< at least 1
  std::size_t level_count = 0;                              ///< of the nominal factor; 0: there is none
  std::function<bool(std::span<const double>)> contains{};  ///< which points are allowed; empty: all
};

/// Fast flexible filling: the function clusters uniform candidates, gives every level one point in each primary
/// cluster, and chooses for each point the candidate of its own sub-cluster that makes the criterion smallest.
/// A design depends on the arguments alone. Time grows as the square of the number of runs: a tenth of a second for 60,
/// half a minute for 10,000; memory grows as the number itself.
/// @param runs  number of points, a positive multiple of the number of levels
/// @throws std::invalid_argument  for another number of runs
/// @throws std::domain_error      if hardly any point of the space is allowed
/// Source: Lekivetz, Jones (2015), Quality and Reliability Engineering International 31, 829-837.
[[nodiscard]] Design maxpro_design(const DesignSpace& space, std::size_t runs, std::uint64_t seed);

}  // namespace monograin
