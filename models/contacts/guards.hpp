/// Guards of contacts, with the values at which they fire.
#pragma once

#include <algorithm>
#include <span>
#include <string_view>
#include <vector>

#include "contacts/wall_contact.hpp"

namespace monograin::contacts {

enum GuardKind : int { k_made, k_boundary, k_lost, k_retreat };

class Guards {
 public:
  /// @param target  prescribed value (or displacement, overlap) at which the guard vanishes
  void add(const Guard& guard, double target) {
    list_.push_back(guard);
    targets_.push_back(target);
  }
  void clear() noexcept {
    list_.clear();
    targets_.clear();
  }
  [[nodiscard]] std::span<const Guard> list() const noexcept { return list_; }
  [[nodiscard]] double target(std::size_t guard) const { return targets_[guard]; }
  [[nodiscard]] bool has(GuardKind kind) const noexcept {
    return std::ranges::find(list_, int{kind}, &Guard::kind) != list_.end();
  }

 private:
  std::vector<Guard> list_;
  std::vector<double> targets_;
};

/// Arms the guard that the ramp of a contact reaches next, where nothing but the ramp moves the contact: made, lost, or
/// taken to a boundary.
template <class Law>
void arm_wall(const Law& law, const WallContact<Law>& c, std::size_t i, Guards& guards) {
  const int direction = c.drive().direction();
  const auto add = [&](GuardKind kind, std::string_view name, double target, bool is_branch_end = false) {
    guards.add({.kind = kind,
                .index = static_cast<int>(i),
                .direction = direction,
                .name = name,
                .is_exact = true,
                .is_branch_end = is_branch_end,
                .is_monotone = true},
               target);
  };
  const auto opening = [&] { return c.is_force_controlled() ? 0.0 : law.opening(c.branch()); };
  if (direction > 0 && c.touches()) {
    const auto ahead = c.next(law);
    if (!ahead) return;
    const double target = c.prescribed_at(law, *ahead);
    // Under force, the rate of the displacement is 1 over the slope of the force.
    if (c.passes(target)) add(k_boundary, ahead->event, target, ahead->is_singular && c.is_force_controlled());
  } else if (direction > 0 && c.passes_opening(law)) {
    add(k_made, c.made_event(law), opening());
  } else if (direction < 0 && c.touches() && c.passes_opening(law)) {
    add(k_lost, "contact-lost", opening());
  }
}

}  // namespace monograin::contacts
