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

}  // namespace

void resolve_regimes(Particle& p, std::span<const ContactClass> classes, bool is_first_step, std::vector<Event>& log) {
  const double touch = p.scales().touch;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const bool was_closed = p.mode.is_closed[i];
    double square = p.state()[i];
    if (p.is_force_controlled(i)) {
      square = std::max(p.ramp(i).start, p.ramp(i).end);
    } else if (std::abs(square) <= touch) {
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
