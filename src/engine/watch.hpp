/// The guards an integrator watches: those of the system in its present mode, and the program's own conditions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hybrid_system.hpp"

namespace monograin {

/// Ends a step when a quantity of a channel reaches a value.
struct Condition {
  Quantity quantity = Quantity::force;
  int channel = 0;
  double target = 0.0;  ///< SI
};

class Watch {
 public:
  explicit Watch(HybridSystem& system) : system_(system) {}

  /// Takes up the conditions of a step; which side of its target each one starts on is read from the state.
  void begin_step(std::span<const Condition> conditions, double xi, std::span<const double> y);

  /// Lists what is alive from here on. Call after every change of the system's mode.
  void renew(double xi, std::span<const double> y);

  [[nodiscard]] std::size_t size() const noexcept { return directions_.size(); }
  [[nodiscard]] std::span<const int> directions() const noexcept { return directions_; }
  [[nodiscard]] std::string name(std::size_t guard) const;
  /// Values of all guards alive.
  void values(double xi, std::span<const double> y, std::span<double> out);

  /// How many of the guards, from the first on, are the system's.
  [[nodiscard]] std::size_t system_guards() const noexcept { return system_count_; }

  /// Whether the values of all guards at two instants show what crosses between them.
  [[nodiscard]] bool is_monotone() const noexcept { return is_monotone_; }

  /// Whether a condition is met by the present state, however it came about (a jump, a contact lost).
  [[nodiscard]] bool is_met(double xi, std::span<const double> y);

 private:
  struct Watched {
    Condition condition;
    double scale = 1.0;
    int direction = 0;  ///< in which the target is met; 0 while the quantity sits on it since the step began
  };
  [[nodiscard]] double excess(const Watched& watched, double xi, std::span<const double> y);

  HybridSystem& system_;
  std::vector<Watched> conditions_;
  std::vector<std::size_t> rooted_;  ///< conditions with a root function of their own
  std::vector<int> directions_;
  std::size_t system_count_ = 0;
  bool is_monotone_ = false;
};

}  // namespace monograin
