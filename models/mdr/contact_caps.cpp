#include "mdr/contact_caps.hpp"

#include "mdr/guards.hpp"
#include "mdr/resolution.hpp"

namespace monograin::mdr {
namespace {

// Distance (of the guard from zero) from which on caps that have met have parted.
constexpr double k_parted = 1e-6;

/// Overlap of a contact's cap. An idle contact has none; a round-off overlap of 1e-12 R0 would give one 1e-6 R0 wide.
double cap_overlap(const Particle& p, int contact_class) {
  const auto i = static_cast<std::size_t>(contact_class);
  return is_idle(p, i) ? 0.0 : p.contact(i).overlap;
}

}  // namespace

bool ContactCaps::both_touch(const Particle& p, std::size_t pair) const noexcept {
  return p.branch(static_cast<std::size_t>(pairs_[pair].first)).touches() &&
         p.branch(static_cast<std::size_t>(pairs_[pair].second)).touches();
}

double ContactCaps::guard(const Particle& p, std::size_t pair) const {
  const CapPair& caps = pairs_[pair];
  return cap_guard(caps, cap_overlap(p, caps.first), cap_overlap(p, caps.second), p.at().r);
}

std::optional<DomainEnd> ContactCaps::meet(std::size_t pair, double r, std::vector<Event>& log) {
  CapPair& caps = pairs_[pair];
  caps.have_met = true;
  if (!first_radius_) first_radius_ = 1.0 + r;
  const Event event{"caps-intersect", caps.first, caps.first == caps.second ? -1 : caps.second};
  log.push_back(event);
  if (!stops_) return std::nullopt;
  return DomainEnd{event, {Limit::caps_intersect, -1, "R/R0", 1.0 + r}};
}

std::optional<DomainEnd> ContactCaps::meet_at_once(const Particle& p, std::vector<Event>& log) {
  std::optional<DomainEnd> end;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const double distance = both_touch(p, k) ? guard(p, k) : -1.0;
    if (distance < -k_parted) pairs_[k].have_met = false;
    if (distance < -k_zero_guard || pairs_[k].have_met) continue;
    if (const auto limit = meet(k, p.at().r, log)) end = limit;
  }
  return end;
}

}  // namespace monograin::mdr
