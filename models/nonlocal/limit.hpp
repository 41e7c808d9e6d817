/// The point at which a step of the program leaves the domain of the nonlocal formulation.
#pragma once

#include <optional>
#include <span>

#include "nonlocal/contacts.hpp"

namespace monograin::nonlocal {

/// Follows the equilibria of a step from xi = 0 and returns the xi at which the margin vanishes; none if the path
/// reaches `end` before.
///
/// Under displacement control the path turns back at the limit, so that xi cannot parametrize it. The function follows
/// the path in its arc length, in which nothing is singular. The returned xi is exact to round-off, the state at the
/// limit to the square root of round-off.
/// @param ramps  over R and E R^2 (nonlocal/contacts.hpp)
/// @param y      in: the state at xi = 0; out: the state at the limit, or at `end`
/// @throws std::domain_error if there is no state before the limit (EquilibriumSearch::solve), or if the path cannot be
/// continued
[[nodiscard]] std::optional<double> limit_of_step(Contacts& contacts, std::span<const Ramp> ramps, double end,
                                                  std::span<double> y);

}  // namespace monograin::nonlocal
