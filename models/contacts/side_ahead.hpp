/// Side (open or closed) to which a contact that just touches is about to move.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "system/resolution.hpp"

namespace monograin::contacts {

/// Finds on which side a contact is at the first trial instant ahead at which it is clearly open or closed.
/// @param xi     step coordinate at which the search begins
/// @param touch  least magnitude that puts the contact on a side
/// @param at     step coordinate -> coordinate of the contact; throws std::domain_error where there is no state
/// @return its coordinate there; 0 if it stays undecided to the end of the step; none if no state exists ahead
template <class At>
[[nodiscard]] std::optional<double> side_ahead(double xi, double touch, At&& at) {
  double later = xi;
  for (double distance = k_ahead; later < 1.0; distance *= 10.0) {
    later = std::min(1.0, xi + distance);
    try {
      if (const double value = at(later); std::abs(value) > touch) return value;
    } catch (const std::domain_error&) {
      return std::nullopt;
    }
  }
  return 0.0;
}

}  // namespace monograin::contacts
