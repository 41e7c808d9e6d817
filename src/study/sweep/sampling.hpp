/// Samples of a unit cube: random, quasi-random, and those for the estimate of sensitivity indices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "study/sweep/design.hpp"

namespace monograin {

/// Largest number of dimensions of Sobol's sequence in this implementation.
inline constexpr std::size_t k_most_sobol_dimensions = 40;

/// Points of the open cube by the name of a design: "sobol" and "halton" (low-discrepancy sequences, shifted by a
/// random vector modulo 1), "lhs" (Latin hypercube: in every dimension one point in each of as many slices as there are
/// points), "random".
/// Sources: Sobol' (1967); Halton (1964); McKay, Beckman, Conover (1979); Cranley, Patterson (1976) for the shift.
/// @param factors  dimensions, at least 1; of Sobol's at most k_most_sobol_dimensions
[[nodiscard]] Design sampled_design(std::string_view name, std::size_t factors, std::size_t runs, std::uint64_t seed);

/// Points for Sobol indices: for every sample a point a, a point b, and for each factor the point a with that factor's
/// coordinate from b. There are (factors + 2) * samples of them.
/// Source: Saltelli et al. (2010), with a and b from one sequence of Sobol in twice the dimensions.
/// @param factors  at most half of k_most_sobol_dimensions
[[nodiscard]] Design saltelli_design(std::size_t factors, std::size_t samples, std::uint64_t seed);

/// Points for elementary effects: trajectories of factors + 1 points. From a point to the next, one coordinate changes
/// by a half, in random order and direction. Coordinates are the middles of four equal slices.
/// Source: Morris (1991).
[[nodiscard]] Design morris_design(std::size_t factors, std::size_t trajectories, std::uint64_t seed);

}  // namespace monograin
