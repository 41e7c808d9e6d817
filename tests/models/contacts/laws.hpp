/// Small laws, for the tests of the base of laws whose contacts depend on their own wall alone.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "contacts/columns.hpp"
#include "contacts/wall_contact.hpp"

namespace monograin::contacts_test {

inline constexpr double k_end = 0.8;  // of both laws

/// F = k R0 d, up to a largest displacement.
struct Spring {
  struct Branch {};
  static constexpr std::array<std::string_view, 2> k_regimes{"open", "pressed"};
  double stiffness = 1.0;  ///< k [Pa]

  [[nodiscard]] double unit_force(double radius) const { return stiffness * radius * radius; }
  [[nodiscard]] double force(Branch, double d) const { return d; }
  [[nodiscard]] double slope(Branch, double) const { return 1.0; }
  [[nodiscard]] double displacement(Branch, double force) const { return force; }
  [[nodiscard]] double opening(Branch) const { return 0.0; }
  [[nodiscard]] double work(Branch, double d) const { return 0.5 * d * d; }
  [[nodiscard]] double stored(Branch b, double d) const { return work(b, d); }
  [[nodiscard]] int regime(Branch, bool touches) const { return touches ? 1 : 0; }
};

/// The law of Walton and Braun: F = d under loading; unloading from the largest displacement is stiffer by a ratio. The
/// law hardens at a knee, and ends.
struct Hysteretic {
  struct Branch {
    bool is_past_knee = false;
    bool unloads = false;
    double largest = 0.0;
    double force = 0.0;  ///< there
  };
  static constexpr std::array<std::string_view, 4> k_regimes{"open", "loading", "hardened", "unloading"};
  static constexpr double k_knee = 0.3;
  static constexpr double k_hardening = 2.0;  ///< slope beyond the knee
  static constexpr double k_ratio = 4.0;      ///< slope under unloading

  [[nodiscard]] double unit_force(double radius) const { return radius * radius; }
  [[nodiscard]] double opening(const Branch& b) const { return b.unloads ? b.largest - b.force / k_ratio : 0.0; }
  [[nodiscard]] double slope(const Branch& b, double) const {
    return b.unloads ? k_ratio : b.is_past_knee ? k_hardening : 1.0;
  }
  [[nodiscard]] double force(const Branch& b, double d) const {
    if (b.unloads) return k_ratio * (d - opening(b));
    return b.is_past_knee ? k_knee + k_hardening * (d - k_knee) : d;
  }
  [[nodiscard]] double displacement(const Branch& b, double force) const {
    if (b.unloads) return opening(b) + force / k_ratio;
    return b.is_past_knee ? k_knee + (force - k_knee) / k_hardening : force;
  }
  [[nodiscard]] double stored(const Branch& b, double d) const { return 0.5 * force(b, d) * force(b, d) / k_ratio; }
  [[nodiscard]] std::optional<contacts::Boundary> next(const Branch& b) const {
    if (!b.is_past_knee) return contacts::Boundary{k_knee, "knee"};
    return contacts::Boundary{k_end, "limit", LimitPoint{Limit::walls_meet, -1, "displacement/R0", k_end}};
  }
  void pass(Branch& b) const { b.is_past_knee = true; }
  void turn(Branch& b, double d) const { b = {b.is_past_knee, true, d, force(b, d)}; }
  void reload(Branch& b) const { b.unloads = false; }
  [[nodiscard]] int regime(const Branch& b, bool touches) const {
    return !touches ? 0 : b.unloads ? 3 : b.is_past_knee ? 2 : 1;
  }
};

/// The hysteretic law with its work in closed form.
struct HystereticInClosedForm : Hysteretic {
  [[nodiscard]] double work(const Branch& b, double d) const {
    if (b.unloads) return stored(b, d);
    return b.is_past_knee ? 0.5 * (force(b, d) * force(b, d) - k_knee * k_knee) / k_hardening : 0.5 * d * d;
  }
};

/// F = d^(3/2), without unloading; under a force, its displacement is integrated. Lateral walls of a die show a tenth
/// of its force, and yield at a force of 0.1.
struct Powerful {
  struct Branch {
    bool has_yielded = false;
  };
  static constexpr std::array<std::string_view, 3> k_regimes{"open", "pressed", "yielded"};

  [[nodiscard]] double unit_force(double radius) const { return radius * radius; }
  [[nodiscard]] double force(Branch, double d) const { return d > 0.0 ? d * std::sqrt(d) : 0.0; }
  [[nodiscard]] double slope(Branch, double d) const { return 1.5 * std::sqrt(d); }
  [[nodiscard]] std::pair<double, double> force_and_slope(Branch b, double d) const {
    return {force(b, d), slope(b, d)};
  }
  [[nodiscard]] double displacement(Branch, double force) const { return std::cbrt(force * force); }
  [[nodiscard]] double coordinate_power(Branch) const { return 1.5; }
  [[nodiscard]] double opening(Branch) const { return 0.0; }
  [[nodiscard]] int regime(Branch, bool touches) const { return touches ? 1 : 0; }
  [[nodiscard]] std::optional<contacts::Boundary> next(Branch b) const {
    if (b.has_yielded) return std::nullopt;
    return contacts::Boundary{.position = 0.1, .event = "yield", .is_of_followers = true};
  }
  void pass(Branch& b) const { b.has_yielded = true; }
  [[nodiscard]] std::optional<std::string_view> refuses_unloading() const { return "nothing helps"; }
  [[nodiscard]] bool follows(const ContactClass& walls) const { return std::abs(walls.normals.front().z()) < 0.5; }
  [[nodiscard]] contacts::VisibleContact follower(Branch b, bool touches, double d) const {
    return {.overlap = d, .force = 0.1 * force(b, d), .regime = !touches ? 0.0 : b.has_yielded ? 2.0 : 1.0};
  }
};

}  // namespace monograin::contacts_test
