#include "nonlocal/system.hpp"

#include <algorithm>
#include <stdexcept>

#include "nonlocal/regimes.hpp"

namespace monograin::nonlocal {

System::System(const Settings& settings, std::vector<ContactClass> classes)
    : classes_(std::move(classes)),
      now_(settings, classes_),
      unknowns_(unknowns_of(classes_, now_.particle.contacts(), now_.particle.scales().depth)),
      observables_(observables_of(classes_, settings.centre)) {}

void System::start(std::span<double> y) {
  std::ranges::fill(y, 0.0);
  Particle& p = now_.particle;
  for (auto* marks : {&p.mode.is_closed, &p.mode.touches}) std::ranges::fill(*marks, 0);
  now_.guards.start();
  now_.has_begun = false;
  now_.least_margin = 1.0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const double gap = classes_[i].gap / p.settings().initial_radius;
    p.rest(i, -gap);
    y[i] = -gap;
  }
}

void System::begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) {
  Particle& p = now_.particle;
  p.set_ramps(ramps, y);
  p.require_pressing_walls(0.0);
  p.carry_to_support(y);
  // A force closes a gap at once; everything else is where it was.
  p.solve(0.0, y);
  p.evaluate(0.0, y);
  resolve_regimes(p, classes_, !now_.has_begun, log);
  mark_touching(p);
  now_.has_begun = true;
  now_.guards.arm(p);
  if (const auto end = now_.guards.limit_at_start(p, y)) throw CannotBegin(*end);
}

std::optional<double> System::closed_quadrature(double xi, std::span<const double> y) {
  return now_.particle.contacts().energy(now_.particle.evaluate(xi, y));
}

std::optional<DomainEnd> System::fire(std::span<const std::size_t> indices, double xi, std::span<double> y,
                                      std::vector<Event>& log) {
  Particle& p = now_.particle;
  p.evaluate_contacts(xi, y);
  std::vector<Guard> fired;
  for (const std::size_t g : indices) fired.push_back(guards()[g]);
  std::optional<DomainEnd> end;
  for (const Guard& guard : fired) {
    Event event{guard.name, guard.index};
    switch (guard.kind) {
      case k_impingement: {
        const Pair& pair = now_.guards.impinge(guard.list_index());
        event = {guard.name, static_cast<int>(pair.first),
                 pair.first == pair.second ? -1 : static_cast<int>(pair.second)};
        break;
      }
      case k_stiffening:
        now_.guards.stiffen();
        break;
      case k_force_ends:
        continue;
      case k_radius:
      case k_centre:
      case k_limit:
        end = GuardSet::end_at(p, guard, xi, y);
        break;
      case k_made: {
        // A wall whose touch guard fires now carries no load yet; it may only move a free centre.
        const auto touches_now = [&](const Guard& other) {
          return other.kind == k_touched && other.index == guard.index;
        };
        if (std::ranges::any_of(fired, touches_now)) continue;
        p.mode.is_closed[guard.list_index()] = true;
        break;
      }
      case k_lost:
        p.mode.is_closed[guard.list_index()] = false;
        break;
      default:
        p.mode.touches[guard.list_index()] = guard.kind == k_touched;
        continue;
    }
    log.push_back(event);
  }
  if (end) return end;
  try {
    p.solve(xi, y);
    resolve_others(p, fired, xi, log);
    mark_touching(p);
  } catch (const std::domain_error&) {
    // Where there is no state, the next evaluation from here throws again.
  }
  now_.guards.arm(p);
  return std::nullopt;
}

double System::controlled(Control control, int contact_class, double xi, std::span<const double> y) {
  return quantity(control == Control::force ? Quantity::force : Quantity::displacement, contact_class, xi, y);
}

}  // namespace monograin::nonlocal
