/// Samples of a unit cube: random and quasi-random ones, and those that sensitivity indices are estimated from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "study/sweep/design.hpp"

namespace monograin {

/// The most dimensions that the sequence of Sobol has here.
inline constexpr std::size_t k_most_sobol_dimensions = 40;

/// Points of the open cube by one of the names of designs: "sobol" and "halton" (sequences that leave no gaps, moved by
/// a random vector modulo 1), "lhs" (Latin hypercube: in every dimension one point in each of as many slices as there
/// are points), "random".
/// Sources: Sobol' (1967); Halton (1964); McKay, Beckman, Conover (1979); Cranley, Patterson (1976) for the move.
/// @param factors  dimensions, at least 1; of Sobol's at most k_most_sobol_dimensions
[[nodiscard]] Design sampled_design(std::string_view name, std::size_t factors, std::size_t runs, std::uint64_t seed);

/// Points for Sobol indices: for every sample a point a, a point b, and for each factor the point a with that
/// coordinate of b, so that there are (factors + 2) * samples of them.
/// Source: Saltelli et al. (2010), with a and b from one sequence of Sobol in twice the dimensions.
/// @param factors  at most half of k_most_sobol_dimensions
[[nodiscard]] Design saltelli_design(std::size_t factors, std::size_t samples, std::uint64_t seed);

/// Points for elementary effects: trajectories of factors + 1 points, from each to the next of which one coordinate
/// changes by a half, in random order and direction. Coordinates are the middles of four equal slices.
/// Source: Morris (1991).
[[nodiscard]] Design morris_design(std::size_t factors, std::size_t trajectories, std::uint64_t seed);

}  // namespace monograin
