/// The guards of an integration: those of the system in its present mode, and the conditions of the program.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "system/hybrid_system.hpp"

namespace monograin {

/// Ends a step when a quantity of a channel reaches a value: equals it, or crosses it.
struct Condition {
  Quantity quantity = Quantity::force;
  int channel = 0;
  double target = 0.0;  ///< SI

  [[nodiscard]] bool operator==(const Condition&) const = default;
};

/// True if a quantity counts as equal to the target of a condition: within 1e-9 of the larger magnitude.
[[nodiscard]] bool equals_target(double value, double target) noexcept;

/// Evaluations of guards before the end of a branch of solutions: their number, and the ratio of successive distances
/// from that end.
inline constexpr std::size_t k_evaluations_before_end = 12;
inline constexpr double k_approach_to_end = 0.25;

/// True if a guard crosses zero, or reaches it, between two values.
/// @param direction  in which it counts: 1 rising, -1 falling, 0 both
/// @param tolerance  a guard nearer to zero than this before does not cross it
[[nodiscard]] bool crosses(int direction, double before, double after, double tolerance = 0.0) noexcept;

class GuardSet {
 public:
  explicit GuardSet(HybridSystem& system) : system_(system) {}

  /// Takes up the conditions of a leg. The state at its beginning shows on which side of its target each one starts.
  void begin_leg(std::span<const Condition> conditions, double xi, std::span<const double> y);

  /// Index of the first condition that was met where the leg began: its quantity equals its target there, or the leg
  /// before has ended by it. None if none was.
  [[nodiscard]] std::optional<std::size_t> met_at_begin() const noexcept;

  /// Notes which conditions end the step: those among the guards that fired, and those whose quantities equal their
  /// targets. A condition that a jump has passed ends the step as well, but is not met where the next one begins.
  void note_met(std::span<const std::size_t> fired, double xi, std::span<const double> y);

  /// True if a condition has ended the last step where the quantity that a control prescribes to a channel equals a
  /// value.
  [[nodiscard]] bool has_ended_at(Control control, int channel, double value) const noexcept;

  /// Value of a condition's quantity where the leg began.
  [[nodiscard]] double value_at_begin(std::size_t condition) const { return conditions_[condition].begin; }

  /// Lists the guards alive from here on; to be called after every change of the system's mode.
  void renew();

  [[nodiscard]] std::size_t size() const noexcept { return directions_.size(); }
  [[nodiscard]] std::span<const int> directions() const noexcept { return directions_; }
  [[nodiscard]] std::string name(std::size_t guard) const;
  /// Values of all guards alive.
  void values(double xi, std::span<const double> y, std::span<double> out);

  /// The guard of the system at an index; null for a condition of the program.
  [[nodiscard]] const Guard* of_system(std::size_t guard) const noexcept {
    return guard < system_count_ ? &system_.guards()[guard] : nullptr;
  }
  /// True if the guard ends a branch of solutions.
  [[nodiscard]] bool is_branch_end(std::size_t guard) const noexcept {
    const Guard* const at = of_system(guard);
    return at != nullptr && at->is_branch_end;
  }
  /// Number of guards of the system; they come before the conditions of the program.
  [[nodiscard]] std::size_t system_guards() const noexcept { return system_count_; }

  /// True if every guard is monotone over the rest of the leg: its values at two instants show whether it crosses zero
  /// between them.
  [[nodiscard]] bool is_monotone() const noexcept { return is_monotone_; }

  /// True if the present state meets a condition, however it came about (a ramp's end, a jump, a contact lost).
  [[nodiscard]] bool is_met(double xi, std::span<const double> y);

 private:
  struct ConditionState {
    Condition condition;
    double begin = 0.0;            ///< value of the quantity where the leg began
    double scale = 1.0;            ///< larger of target and first distance: makes the root function of order one
    int direction = 1;             ///< direction in which the quantity reaches the target
    bool is_met_at_begin = false;  ///< the condition was met where the leg began
    bool has_ended = false;        ///< the condition has ended the step
  };
  [[nodiscard]] double value(const Condition& condition, double xi, std::span<const double> y);
  [[nodiscard]] double excess(const ConditionState& state, double xi, std::span<const double> y);
  [[nodiscard]] bool has_ended_last_leg(const Condition& condition) const;
  [[nodiscard]] bool vanishes_with_contact(const Condition& condition) const;

  HybridSystem& system_;
  std::vector<ConditionState> conditions_;
  std::vector<ConditionState> of_last_leg_;
  std::vector<std::size_t> rooted_;  ///< conditions with a root function of their own
  std::vector<int> directions_;
  std::size_t system_count_ = 0;
  bool is_monotone_ = false;
};

}  // namespace monograin
