/// Check of a user's law of one contact: whether its functions belong together.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "system/number_text.hpp"

namespace monograin::contacts {

/// Looks for functions of a law that do not belong together, on the branch of a fresh contact: force, slope, inverse,
/// work and regime. Values count as equal within a part in a thousand.
/// @param reach  largest displacement, over R0; 0 or infinite: unknown
/// @return the first contradiction found, a sentence; empty if there is none
template <class Law>
[[nodiscard]] std::string contradiction_in(const Law& law, double reach) {
  constexpr double k_equal = 1e-3;
  constexpr double k_first_reach = 0.01;
  constexpr double k_step = 1e-5;  // of differences, over the displacement beyond the opening
  const auto differ = [](double a, double b) {
    return !(std::abs(a - b) <= k_equal * std::max(std::abs(a), std::abs(b)));
  };
  const auto text = [](double value) { return number_text(value, 6); };
  const typename Law::Branch branch{};
  const auto count = static_cast<int>(Law::k_regimes.size());
  for (const bool touches : {false, true}) {
    const int regime = law.regime(branch, touches);
    if (regime < 0 || regime >= count) {
      return "regime(b, touches) is " + std::to_string(regime) + "; expected a place in k_regimes, from 0 to " +
             std::to_string(count - 1);
    }
  }
  const double opening = law.opening(branch);
  double end = opening + (reach > 0.0 && std::isfinite(reach) ? reach : k_first_reach);
  if constexpr (requires { law.next(branch); }) {
    if (const auto ahead = law.next(branch)) end = std::min(end, ahead->position);
  }
  for (const double share : {0.2, 0.5, 0.9}) {
    const double depth = share * (end - opening);
    const double d = opening + depth;
    const double h = k_step * depth;
    const std::string at = " at displacement " + text(d) + " R0";
    const double force = law.force(branch, d);
    if (!std::isfinite(force)) return "force(b, d) is " + text(force) + at + "; expected a finite number";
    const double growth = (law.force(branch, d + h) - law.force(branch, d - h)) / (2.0 * h);
    if (const double slope = law.slope(branch, d); differ(slope, growth)) {
      return "slope(b, d) is " + text(slope) + at + ", but force(b, d) grows by " + text(growth) + " there";
    }
    if constexpr (requires { law.work(branch, d); }) {
      const double by_work = (law.work(branch, d + h) - law.work(branch, d - h)) / (2.0 * h);
      if (differ(by_work, force)) {
        return "work(b, d) grows by " + text(by_work) + at + ", but force(b, d) is " + text(force) + " there";
      }
    }
    if (!(force > 0.0)) continue;
    if (const double inverse = law.displacement(branch, force); differ(inverse - opening, depth)) {
      return "displacement(b, F) is " + text(inverse) + " for the force" + at + "; expected that displacement";
    }
  }
  return {};
}

}  // namespace monograin::contacts
