/// Where a step of the program leaves the domain of the nonlocal formulation.
#pragma once

#include <optional>
#include <span>

#include "elastic/nonlocal_contacts.hpp"

namespace monograin::nonlocal {

/// The coordinate xi at which the margin vanishes on the way of a step from 0 to `end`; none if that is reached before.
///
/// Under displacement control the path turns back there, so that xi cannot lead along it: it is followed in its own
/// length, in which nothing is singular. xi is then exact to rounding, the state at the limit to the root of that.
/// @param ramps  over R and E R^2 (elastic/nonlocal_contacts.hpp)
/// @param y      in: the state at xi = 0; out: that at the limit, or at `end`
/// @throws std::domain_error where Contacts::solve does before the limit
[[nodiscard]] std::optional<double> limit_of_step(Contacts& contacts, std::span<const Ramp> ramps, double end,
                                                  std::span<double> y);

}  // namespace monograin::nonlocal
