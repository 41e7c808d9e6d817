#include "nonlocal/regimes.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nonlocal/guards.hpp"

namespace monograin::nonlocal {
namespace {

Event event_of(bool is_closed, std::size_t i) noexcept {
  return {is_closed ? "contact-made" : "contact-lost", static_cast<int>(i)};
}

/// True if a wall whose contact seems to be made does not touch the surface yet, nor goes on to it. A wall that comes
/// to rest at the surface may be within an integrator's tolerance. False with a free centre, which such a wall moves.
bool only_stands(Particle& p, std::size_t i, double xi, std::span<const double> y) {
  if (p.has_free_centre()) return false;
  std::vector<double> exact(y.begin(), y.end());
  try {
    p.solve(xi, exact);
  } catch (const std::domain_error&) {
    return false;  // the next evaluation from here throws again
  }
  const double touch = p.scales().touch;
  return p.state()[i] <= touch && p.square_ahead(i, xi).value_or(touch) <= 0.0;
}

}  // namespace

void resolve_regimes(Particle& p, std::span<const ContactClass> classes, bool is_first_step, std::vector<Event>& log) {
  const double touch = p.scales().touch;
  const bool are_exact = !is_first_step && !p.has_free_centre();
  for (std::size_t i = 0; i < p.size(); ++i) {
    const bool was_closed = p.mode.is_closed[i];
    if (are_exact && !was_closed && !p.is_force_controlled(i) && p.state()[i] <= touch) continue;
    double square = p.state()[i];
    if (p.is_force_controlled(i)) {
      square = std::max(p.ramp(i).start, p.ramp(i).end);
    } else if (std::abs(square) <= k_just_lost * touch) {
      square = p.square_ahead(i, 0.0).value_or(0.0);
    }
    const bool is_closed = square == 0.0 ? was_closed : !(square < 0.0);
    p.mode.is_closed[i] = is_closed;
    const bool is_first_touch = is_first_step && classes[i].gap == 0.0;
    if (is_closed != was_closed && !is_first_touch) log.push_back(event_of(is_closed, i));
  }
}

void mark_touching(Particle& p) {
  const Scales& scales = p.scales();
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double square = p.state()[i];
    const bool is_off = !p.mode.is_closed[i] && square < -scales.idle;
    p.mode.touches[i] = p.mode.is_closed[i] || square >= -k_begins * scales.touch || (p.mode.touches[i] && !is_off);
  }
}

bool apply_to_contact(Particle& p, const Guard& guard, std::span<const Guard> fired, double xi,
                      std::span<const double> y) {
  const std::size_t i = guard.list_index();
  // A wall whose touch guard fires now carries no load yet; it may only move a free centre.
  const auto touches_now = [&](const Guard& other) { return other.kind == k_touched && other.index == guard.index; };
  switch (guard.kind) {
    case k_made:
      if (std::ranges::any_of(fired, touches_now) || only_stands(p, i, xi, y)) return false;
      p.mode.is_closed[i] = true;
      return true;
    case k_lost:
      p.mode.is_closed[i] = false;
      return true;
    default:
      p.mode.touches[i] = guard.kind == k_touched;
      return false;
  }
}

void resolve_others(Particle& p, std::span<const Guard> fired, double xi, std::vector<Event>& log) {
  const double touch = p.scales().touch;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const bool was_closed = p.mode.is_closed[i];
    const auto comes_to_rest = [&] { return !p.has_free_centre() && p.comes_to_rest(i, xi); };
    const bool is_elsewhere = was_closed ? p.state()[i] < -touch || comes_to_rest() : p.state()[i] > touch;
    const auto is_own = [&](const Guard& guard) { return guard.kind <= k_lost && guard.index == static_cast<int>(i); };
    if (p.is_force_controlled(i) || !is_elsewhere || std::ranges::any_of(fired, is_own)) continue;
    p.mode.is_closed[i] = !was_closed;
    log.push_back(event_of(!was_closed, i));
  }
}

}  // namespace monograin::nonlocal
