#include "mdr/contact_caps.hpp"

#include <algorithm>

#include "mdr/guards.hpp"
#include "mdr/idle.hpp"

namespace monograin::mdr {

bool ContactCaps::both_touch(const Particle& p, std::size_t pair) const noexcept {
  return p.branch(static_cast<std::size_t>(pairs_[pair].first)).touches() &&
         p.branch(static_cast<std::size_t>(pairs_[pair].second)).touches();
}

void ContactCaps::set_angles(const Particle& p) {
  if (pairs_.empty()) return;
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    // An idle contact has no cap; a round-off overlap of 1e-12 R0 would give one 1e-6 R0 wide.
    angles_[i] = cap_angle(is_idle(p, i) ? 0.0 : p.contact(i).overlap, p.at().growth);
  }
}

void ContactCaps::set_largest_angles(const Particle& p) {
  for (std::size_t i = 0; i < largest_angles_.size(); ++i) {
    const double largest = std::max(p.contact(i).overlap, p.drive(i).end() + p.at().growth);
    // An overlap is linear in xi while radius and centre rest. Up to the radius, a larger cap is nearer to any other.
    const bool is_known = !p.mode.is_growing && !p.centre().is_free() && !p.is_force_controlled(i);
    largest_angles_[i] =
        is_known && largest < 1.0 + p.at().growth ? cap_angle(largest, p.at().growth) : CapAngle{k_nan, k_nan};
  }
}

bool ContactCaps::may_meet(std::size_t pair) const noexcept { return !(guard_at(largest_angles_, pair) < -k_together); }

std::optional<DomainEnd> ContactCaps::meet(std::size_t pair, double growth, std::vector<Event>& log) {
  CapPair& caps = pairs_[pair];
  caps.have_met = true;
  if (!first_radius_) first_radius_ = 1.0 + growth;
  const Event event{"caps-intersect", caps.first, caps.first == caps.second ? -1 : caps.second};
  log.push_back(event);
  if (!stops_) return std::nullopt;
  return DomainEnd{event, {Limit::caps_intersect, -1, "R/R0", 1.0 + growth}};
}

std::optional<DomainEnd> ContactCaps::meet_at_once(const Particle& p, std::vector<Event>& log) {
  std::optional<DomainEnd> end;
  set_angles(p);
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const double distance = both_touch(p, k) ? guard(k) : -1.0;
    if (distance < -k_together) pairs_[k].have_met = false;
    if (distance < -k_zero_guard || pairs_[k].have_met) continue;
    if (const auto limit = meet(k, p.at().growth, log)) end = limit;
  }
  return end;
}

}  // namespace monograin::mdr
