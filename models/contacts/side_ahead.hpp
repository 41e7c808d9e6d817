/// The side on which a contact is that just touches.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace monograin::contacts {

/// Coordinate of a contact a little later, as soon as it says open or closed; 0 if it never does, nothing if there is
/// no state any more before that, so that the run will stop.
/// @param xi     step coordinate from which on the contact is watched
/// @param touch  least magnitude that puts the contact on a side
/// @param at     step coordinate -> coordinate of the contact; throws std::domain_error where there is no state
template <class At>
[[nodiscard]] std::optional<double> side_ahead(double xi, double touch, At&& at) {
  constexpr double k_first = 1e-9;  // then ten times further, while it still just touches
  double later = xi;
  for (double distance = k_first; later < 1.0; distance *= 10.0) {
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
