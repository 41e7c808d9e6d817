#include "engine/guard_set.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "system/resolution.hpp"

namespace monograin {

bool equals_target(double value, double target) noexcept {
  return std::abs(value - target) <= k_same_number * std::max(std::abs(value), std::abs(target));
}

bool crosses(int direction, double before, double after, double tolerance) noexcept {
  const bool rises = before < -tolerance && after >= 0.0;
  const bool falls = before > tolerance && after <= 0.0;
  return (rises && direction >= 0) || (falls && direction <= 0);
}

void GuardSet::begin_leg(std::span<const Condition> conditions, double xi, std::span<const double> y) {
  std::swap(conditions_, of_last_leg_);
  conditions_.clear();
  for (const Condition& condition : conditions) {
    const double begin = value(condition, xi, y);
    const double distance = begin - condition.target;
    const double scale = std::max(std::abs(condition.target), std::abs(distance));
    conditions_.push_back({.condition = condition,
                           .begin = begin,
                           .scale = scale > 0.0 ? scale : 1.0,
                           .direction = distance < 0.0 ? 1 : -1,
                           .is_met_at_begin = equals_target(begin, condition.target) || has_ended_last_leg(condition)});
  }
  renew();
}

bool GuardSet::has_ended_last_leg(const Condition& condition) const {
  return std::ranges::any_of(
      of_last_leg_, [&](const ConditionState& state) { return state.has_ended && state.condition == condition; });
}

std::optional<std::size_t> GuardSet::met_at_begin() const noexcept {
  const auto met = std::ranges::find_if(conditions_, &ConditionState::is_met_at_begin);
  if (met == conditions_.end()) return std::nullopt;
  return static_cast<std::size_t>(met - conditions_.begin());
}

void GuardSet::note_met(std::span<const std::size_t> fired, double xi, std::span<const double> y) {
  for (const std::size_t guard : fired) {
    if (guard >= system_count_) conditions_[rooted_[guard - system_count_]].has_ended = true;
  }
  for (ConditionState& state : conditions_) {
    state.has_ended = state.has_ended || equals_target(value(state.condition, xi, y), state.condition.target);
  }
}

bool GuardSet::has_ended_at(Control control, int channel, double value) const noexcept {
  return std::ranges::any_of(conditions_, [&](const ConditionState& state) {
    const Condition& condition = state.condition;
    const bool is_prescribed = (control == Control::force && condition.quantity == Quantity::force) ||
                               (control == Control::displacement && condition.quantity == Quantity::displacement);
    return state.has_ended && is_prescribed && condition.channel == channel && equals_target(value, condition.target);
  });
}

void GuardSet::renew() {
  directions_.clear();
  rooted_.clear();
  for (const Guard& guard : system_.guards()) directions_.push_back(guard.direction);
  system_count_ = directions_.size();
  for (std::size_t i = 0; i < conditions_.size(); ++i) {
    if (vanishes_with_contact(conditions_[i].condition)) continue;
    rooted_.push_back(i);
    directions_.push_back(conditions_[i].direction);
  }
  is_monotone_ = rooted_.empty() && std::ranges::all_of(system_.guards(), &Guard::is_monotone);
}

/// True if the condition is met by losing the contact: force, pressure and contact radius become zero there and stay
/// zero. Such a condition needs no root function: the system has an event there, after which is_met() finds it. The
/// force and pressure of an adhesive contact pass through zero earlier.
bool GuardSet::vanishes_with_contact(const Condition& condition) const {
  if (condition.target != 0.0) return false;
  if (condition.quantity == Quantity::contact_radius) return true;
  const bool is_force = condition.quantity == Quantity::force || condition.quantity == Quantity::pressure;
  return is_force && !system_.contacts_adhere();
}

std::string GuardSet::name(std::size_t guard) const {
  const Guard* const at = of_system(guard);
  if (at == nullptr) return "until";
  std::string result(at->name);
  if (at->index >= 0 && static_cast<std::size_t>(at->index) < system_.classes().size()) {
    result += " of " + system_.classes()[static_cast<std::size_t>(at->index)].name;
  }
  return result;
}

double GuardSet::value(const Condition& condition, double xi, std::span<const double> y) {
  return system_.quantity(condition.quantity, condition.channel, xi, y);
}

double GuardSet::excess(const ConditionState& state, double xi, std::span<const double> y) {
  return (value(state.condition, xi, y) - state.condition.target) / state.scale;
}

void GuardSet::values(double xi, std::span<const double> y, std::span<double> out) {
  system_.guard_values(xi, y, out.first(system_count_));
  for (std::size_t i = 0; i < rooted_.size(); ++i) out[system_count_ + i] = excess(conditions_[rooted_[i]], xi, y);
}

bool GuardSet::is_met(double xi, std::span<const double> y) {
  return std::ranges::any_of(conditions_, [&](const ConditionState& state) {
    const double now = value(state.condition, xi, y);
    const double target = state.condition.target;
    return state.direction * (now - target) >= 0.0 || equals_target(now, target);
  });
}

}  // namespace monograin
