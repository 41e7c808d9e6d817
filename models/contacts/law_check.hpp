/// Check of a user's law of one contact: whether its functions belong together.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "system/number_text.hpp"

namespace monograin::contacts {

/// Looks for functions of a law that do not belong together, on the branch of a fresh contact: force, slope, inverse,
/// work and regime. Values count as equal within a part in a thousand. Displacements at which the law has ended do not
/// count.
/// @param reach  largest displacement, over R0; 0 or infinite: unknown
/// @return the first contradiction found, a sentence; empty if there is none
template <class Law>
[[nodiscard]] std::string contradiction_in(const Law& law, double reach) {
  constexpr double k_equal = 1e-3;
  constexpr double k_first_reach = 0.01;
  constexpr double k_step = 1e-5;        // of differences, over the displacement beyond the opening
  constexpr double k_least_step = 1e-6;  // of differences, over the displacement
  const auto differ = [](double a, double b, double scale) { return !(std::abs(a - b) <= k_equal * std::abs(scale)); };
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
  bool is_first = true;
  for (const double share : {0.2, 0.5, 0.9}) {
    const double depth = share * (end - opening);
    const double d = opening + depth;
    const double h = std::max(k_step * depth, k_least_step * std::abs(d));
    const std::string at = " at displacement " + text(d) + " R0";
    try {
      const double force = law.force(branch, d);
      const double growth = (law.force(branch, d + h) - law.force(branch, d - h)) / (2.0 * h);
      if (!std::isfinite(force) || !std::isfinite(growth)) {
        // Further on, the law may have ended.
        return is_first ? "force(b, d) is " + text(force) + at + "; expected a finite number" : std::string();
      }
      is_first = false;
      const double slope = law.slope(branch, d);
      if (differ(slope, growth, std::max({std::abs(slope), std::abs(growth), std::abs(force) / depth}))) {
        return "slope(b, d) is " + text(slope) + at + ", but force(b, d) grows by " + text(growth) + " there";
      }
      if constexpr (requires { law.work(branch, d); }) {
        const double by_work = (law.work(branch, d + h) - law.work(branch, d - h)) / (2.0 * h);
        if (differ(by_work, force, std::max(std::abs(force), std::abs(growth) * depth))) {
          return "work(b, d) grows by " + text(by_work) + at + ", but force(b, d) is " + text(force) + " there";
        }
      }
      if (!(force > 0.0) || !(slope > 0.0)) continue;
      if (const double inverse = law.displacement(branch, force); differ(inverse, d, depth)) {
        return "displacement(b, F) is " + text(inverse) + " for the force" + at + "; expected that displacement";
      }
    } catch (const std::domain_error&) {  // the law has ended
      return {};
    }
  }
  return {};
}

}  // namespace monograin::contacts
