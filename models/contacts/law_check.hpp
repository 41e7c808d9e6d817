/// Check of a user's law of one contact: whether its functions belong together.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "contacts/wall_contact.hpp"
#include "system/number_text.hpp"

namespace monograin::contacts {

/// Compares the functions of a law with each other. Values count as equal within a part in a thousand.
template <class Law>
class LawCheck {
 public:
  using Branch = typename Law::Branch;
  explicit LawCheck(const Law& law) : law_(law) {}

  /// Checks force, slope, work and inverse of a branch.
  /// @param must_be_finite  false: a law whose force is not finite there has ended, which is no contradiction
  /// @return the contradiction, a sentence; empty if there is none
  [[nodiscard]] std::string at(const Branch& b, double d, bool must_be_finite) const {
    const double opening = law_.opening(b);
    const double depth = d - opening;
    const double h = std::max(k_step * depth, k_least_step * std::abs(d));
    const std::string place = " at displacement " + text(d) + " R0";
    const double force = law_.force(b, d);
    const double growth = (law_.force(b, d + h) - law_.force(b, d - h)) / (2.0 * h);
    if (!std::isfinite(force) || !std::isfinite(growth)) {
      return must_be_finite ? "force(b, d) is " + text(force) + place + "; expected a finite number" : std::string();
    }
    if (!(force > 0.0)) {
      return "force(b, d) is " + text(force) + place + ", and the contact opens at " + text(opening) +
             " R0; expected a force above 0 beyond that";
    }
    const double slope = law_.slope(b, d);
    if (differ(slope, growth, std::max({std::abs(slope), std::abs(growth), force / depth}))) {
      return "slope(b, d) is " + text(slope) + place + ", but force(b, d) grows by " + text(growth) + " there";
    }
    if constexpr (requires { law_.work(b, d); }) {
      const double by_work = (law_.work(b, d + h) - law_.work(b, d - h)) / (2.0 * h);
      if (differ(by_work, force, std::max(force, std::abs(growth) * depth))) {
        return "work(b, d) grows by " + text(by_work) + place + ", but force(b, d) is " + text(force) + " there";
      }
    }
    if (!(slope > 0.0)) return {};
    if (const double inverse = law_.displacement(b, force); differ(inverse, d, depth)) {
      return "displacement(b, F) is " + text(inverse) + " for the force" + place + "; expected that displacement";
    }
    return {};
  }

  /// Checks that unloading begins at the force of loading, that its functions belong together, and that loading goes on
  /// from there after a reload.
  [[nodiscard]] std::string where_unloading_begins_at(const Branch& loading, double d) const {
    Law law = law_;
    if constexpr (requires { law.refuses_unloading(); }) {
      if (law.refuses_unloading()) return {};
    }
    Branch b = loading;
    if constexpr (requires { law.turn(b, d); }) law.turn(b, d);
    const std::string place = " where unloading begins at displacement " + text(d) + " R0";
    const double force = law_.force(loading, d);
    if (const double now = law.force(b, d); differ(now, force, force)) {
      return "force(b, d) is " + text(now) + place + ", and was " + text(force) + " before";
    }
    const double opening = law.opening(b);
    if (std::string found = LawCheck(law).at(b, opening + 0.9 * (d - opening), true); !found.empty()) {
      return found + ", in unloading";
    }
    if constexpr (requires { law.reload(b); }) law.reload(b);
    const double beyond = d + k_step * (d - law_.opening(loading));
    const double expected = law_.force(loading, beyond);
    const double expected_slope = law_.slope(loading, beyond);
    if (!std::isfinite(expected) || !std::isfinite(expected_slope)) return {};  // the law has ended
    const double now = law.force(b, beyond);
    const double slope = law.slope(b, beyond);
    if (!differ(now, expected, expected) && !differ(slope, expected_slope, expected_slope)) return {};
    return "after unloading begins at displacement " + text(d) + " R0 and reloading, force and slope beyond it are " +
           text(now) + " and " + text(slope) + "; without unloading they are " + text(expected) + " and " +
           text(expected_slope);
  }

 private:
  static constexpr double k_equal = 1e-3;
  static constexpr double k_step = 1e-5;        ///< of differences, over the displacement beyond the opening
  static constexpr double k_least_step = 1e-6;  ///< of differences, over the displacement

  [[nodiscard]] static bool differ(double a, double b, double scale) {
    return !(std::abs(a - b) <= k_equal * std::abs(scale));
  }
  [[nodiscard]] static std::string text(double value) { return number_text(value, 6); }

  const Law& law_;
};

/// Finds functions of a law that do not belong together, on the branch of a fresh contact and where it unloads.
/// Displacements at which the law has ended do not count.
/// @param reach  largest displacement, over R0; 0 or infinite: unknown
/// @return the first contradiction found, a sentence; empty if there is none
template <class Law>
[[nodiscard]] std::string contradiction_in(const Law& law, double reach) {
  constexpr double k_first_reach = 0.01;
  constexpr std::array k_shares{0.2, 0.5, 0.9};  // of the reach: near its ends differences lose digits, or leave it
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
    if (const std::optional<Boundary> ahead = law.next(branch)) end = std::min(end, ahead->position);
  }
  const LawCheck check(law);
  bool is_first = true;
  for (const double share : k_shares) {
    const double d = opening + share * (end - opening);
    try {
      if (std::string found = check.at(branch, d, is_first); !found.empty()) return found;
      if (!std::isfinite(law.force(branch, d))) return {};
      if (std::string found = check.where_unloading_begins_at(branch, d); !found.empty()) return found;
    } catch (const std::domain_error&) {  // the law has ended
      return {};
    }
    is_first = false;
  }
  return {};
}

}  // namespace monograin::contacts
