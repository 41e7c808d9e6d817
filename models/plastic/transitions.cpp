// Transitions of a plastic particle: which guards are alive, and what they change.

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "plastic/system.hpp"

namespace monograin::plastic {
namespace {

enum GuardKind : int { k_made, k_touched, k_boundary, k_lateral_boundary, k_impingement, k_reload, k_lost, k_limit };

// Guards a rounding error beyond the end of a ramp are watched too.
constexpr double k_reach_margin = 1e-9;

/// @param x  displacement over R0 at which the law ends
DomainEnd ended(Limit limit, const Event& event, double x) {
  return {event, {limit, event.contact_class, "displacement/R0", x}};
}

}  // namespace

/// An open contact at the start of a step: closes where its wall stands at the surface and comes in, or is pressed on.
void System::meet_walls(std::size_t i, double x, std::vector<Event>& log) {
  Memory& memory = memory_[i];
  if (direction(i) <= 0 && !(is_loaded(i) && ramps_[i].start > 0.0)) return;
  if (!is_loaded(i) && x < origin(i)) return;
  const bool was_separated = memory.regime == Regime::separated;
  memory.regime = was_separated ? Regime::unloading : first_regime(settings_.law);
  // A driven wall that touches the fresh particle is in contact from the start, without an event.
  const bool is_first_touch = !has_begun_ && classes_[i].gap == 0.0;
  if (!is_first_touch) log.push_back({was_separated ? "dent-touched" : "contact-made", static_cast<int>(i)});
}

void System::turn_back(std::size_t i, double x, std::vector<Event>& log) {
  Memory& memory = memory_[i];
  memory.largest_force = is_loaded(i) ? ramps_[i].start : contact(i, x).force;
  if (settings_.unloading == Unloading::none) {
    throw DomainError({Limit::no_unloading_law, static_cast<int>(i), "displacement/R0", x},
                      "unloading = \"mdr\" adds one");
  }
  if (memory.regime != Regime::elastic) {
    memory.indenter = indenter_at(i, x);
    memory.regime = Regime::unloading;
    if (memory.indenter.recovery > x) {
      const double ratio = memory.indenter.recovery / x;
      overshooting_ = std::max(overshooting_.value_or(ratio), ratio);
    }
  }
  memory.is_on_primary_branch = false;
  memory.largest = x;
  log.push_back({"load-reversal", static_cast<int>(i)});
}

void System::lose_contact(std::size_t i) {
  Memory& memory = memory_[i];
  memory.resting = origin(i);
  memory.regime = memory.regime == Regime::unloading ? Regime::separated : Regime::open;
}

/// Loading goes on from the largest displacement - at x, a rounding error later, which may lie beyond what comes next.
void System::resume_loading(std::size_t i, double x, std::vector<Event>& log) {
  const auto pass = [&](const Boundaries& ends, std::size_t of_class) {
    for (std::size_t& next = memory_[of_class].next; next < ends.size(); ++next) {
      // The last end of a law is for its guard.
      const bool is_last = &ends == &boundaries_ && ends[next].beyond == Regime::undefined;
      if (is_last || x < ends[next].approach) return;
      if (!ends[next].event.empty()) log.push_back({ends[next].event, static_cast<int>(of_class)});
    }
  };
  Memory& memory = memory_[i];
  memory.is_on_primary_branch = true;
  log.push_back({"reload", static_cast<int>(i)});
  pass(boundaries_, i);
  memory.regime = memory.next == 0 ? first_regime(settings_.law) : boundaries_[memory.next - 1].beyond;
  if (impingement_ && !memory.has_impinged && x >= *impingement_) {
    memory.has_impinged = true;
    log.push_back({"impingement", static_cast<int>(i)});
  }
  for (std::size_t lateral = 0; i == first_primary_ && lateral < memory_.size(); ++lateral) {
    if (is_lateral(lateral)) pass(lateral_boundaries_, lateral);
  }
}

/// The end of the law, where a contact goes on a rounding error beyond it: no guard would see it cross.
std::optional<DomainEnd> System::end_passed(std::size_t i, double x, std::vector<Event>& log) const {
  const bool ends_before = !boundaries_.empty() && boundaries_.back().beyond == Regime::undefined;
  if (x < (ends_before ? boundaries_.back().approach : limit(settings_.law))) return std::nullopt;
  log.push_back({ends_before ? boundaries_.back().event : std::string_view("limit"), static_cast<int>(i)});
  return ended(ends_before ? Limit::cell_filled : Limit::walls_meet, log.back(), x);
}

/// Elastic indenter that the contact would leave if it were unloaded from this displacement.
mdr::UnloadingShape System::indenter_at(std::size_t i, double x) const {
  const ContactState now = state_in(settings_.law, memory_[i].regime, x);
  return mdr::unloading_shape_of(modulus_, settings_.poisson_ratio, 1.0, x, now.contact_radius, now.pressure);
}

/// Lateral contacts follow the axial ones while those are loaded, and while nothing has yielded.
void System::resolve_lateral() {
  const Regime primary = memory_[first_primary_].regime;
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    if (!is_lateral(i)) continue;
    Memory& memory = memory_[i];
    if (primary == Regime::open)
      memory.regime = Regime::open;
    else if (!lateral_law_ || primary == Regime::unloading || primary == Regime::separated)
      memory.regime = Regime::undefined;
    else
      memory.regime = memory.next == 0 ? Regime::elastic : lateral_boundaries_[memory.next - 1].beyond;
    has_lateral_gap_ = has_lateral_gap_ || memory.regime == Regime::undefined;
  }
}

void System::add_guard(int kind, std::size_t i, int direction, std::string_view name, double place) {
  guards_.push_back({.kind = kind,
                     .index = static_cast<int>(i),
                     .direction = direction,
                     .name = name,
                     .is_exact = kind == k_reload || !is_loaded(is_lateral(i) ? first_primary_ : i)});
  guard_places_.push_back(place);
}

/// The guards that may fire before the end of the step.
void System::arm_guards(double xi, std::span<const double> y) {
  guards_.clear();
  guard_places_.clear();
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    if (is_lateral(i)) continue;
    double target = ramps_[i].end;
    if (is_loaded(i)) {
      try {
        target = displacement_under_force(i, ramps_[i].end);
      } catch (const std::domain_error&) {
        target = std::numeric_limits<double>::infinity();
      }
    }
    watch_primary(i, displacement(i, xi, y), target);
  }
}

void System::watch_primary(std::size_t i, double x, double target) {
  const Memory& memory = memory_[i];
  const double margin = k_reach_margin * std::max(std::abs(target), std::abs(x));
  const auto is_ahead = [&](double place) { return place <= target + margin; };
  if (direction(i) < 0) {
    // A force that ends at nothing leaves the wall at the surface.
    if (touches(memory.regime) && (is_loaded(i) ? ramps_[i].end < 0.0 : target <= origin(i) + margin)) {
      add_guard(k_lost, i, -1, "contact-lost", origin(i));
    }
    return;
  }
  if (direction(i) == 0) return;
  if (memory.regime == Regime::open || memory.regime == Regime::separated) {
    if (is_loaded(i) || !is_ahead(origin(i))) return;
    if (memory.regime == Regime::open)
      add_guard(k_made, i, 1, "contact-made", origin(i));
    else
      add_guard(k_touched, i, 1, "dent-touched", origin(i));
    return;
  }
  if (!memory.is_on_primary_branch) {
    if (is_ahead(memory.largest)) add_guard(k_reload, i, 1, "reload", memory.largest);
    return;
  }
  if (memory.next < boundaries_.size() && is_ahead(boundaries_[memory.next].approach)) {
    const Boundary& boundary = boundaries_[memory.next];
    add_guard(k_boundary, i, 1, boundary.event, boundary.approach);
  }
  if (impingement_ && !memory.has_impinged && is_ahead(*impingement_)) {
    add_guard(k_impingement, i, 1, "impingement", *impingement_);
  }
  // Where the pressure becomes infinite, the boundary before it ends the run.
  const bool ends_before = !boundaries_.empty() && boundaries_.back().beyond == Regime::undefined;
  if (!ends_before && is_ahead(limit(settings_.law))) add_guard(k_limit, i, 1, "limit", limit(settings_.law));
  if (i != first_primary_) return;
  for (std::size_t lateral = 0; lateral < memory_.size(); ++lateral) {
    if (!is_lateral(lateral) || memory_[lateral].next >= lateral_boundaries_.size()) continue;
    const Boundary& boundary = lateral_boundaries_[memory_[lateral].next];
    if (is_ahead(boundary.approach)) add_guard(k_lateral_boundary, lateral, 1, boundary.event, boundary.approach);
  }
}

void System::guard_values(double xi, std::span<const double> y, std::span<double> values) {
  for (std::size_t g = 0; g < guards_.size(); ++g) {
    const auto own = static_cast<std::size_t>(guards_[g].index);
    const std::size_t i = is_lateral(own) ? first_primary_ : own;
    if (guards_[g].kind == k_lost && is_loaded(i)) {
      values[g] = prescribed(i, xi) / ramps_[i].start;
      continue;
    }
    // To the last digit: a force may end where it was before.
    if (guards_[g].kind == k_reload && is_loaded(i)) {
      values[g] = prescribed(i, xi) / memory_[i].largest_force - 1.0;
      continue;
    }
    // Ramps are as short as contacts are shallow.
    const double scale = is_loaded(i) ? guard_places_[g] : std::max(std::abs(ramps_[i].start), std::abs(ramps_[i].end));
    // A place that follows from the force has no error of its own.
    const double near = displacement(i, xi, y);
    const double x = is_loaded(i) && is_known(i) ? displacement_under_force(i, prescribed(i, xi), near) : near;
    values[g] = (x - guard_places_[g]) / scale;
  }
}

std::optional<DomainEnd> System::fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                      std::vector<Event>& log) {
  std::optional<DomainEnd> end;
  for (const std::size_t g : fired) {
    const Guard guard = guards_[g];
    const auto i = static_cast<std::size_t>(guard.index);
    Memory& memory = memory_[i];
    double x = displacement(is_lateral(i) ? first_primary_ : i, xi, y);
    if (!is_lateral(i)) farthest_ = std::max(farthest_, x);
    const Event event{guard.name, guard.index};
    if (!guard.name.empty() && guard.kind != k_reload) log.push_back(event);
    switch (guard.kind) {
      case k_made:
        memory.regime = first_regime(settings_.law);
        break;
      case k_touched:
        memory.regime = Regime::unloading;
        if (!is_reloaded(i, x)) break;
        resume_loading(i, x, log);
        if (!end) end = end_passed(i, x, log);
        break;
      case k_boundary:
        if (boundaries_[memory.next].beyond == Regime::undefined) {
          end = ended(Limit::cell_filled, event, x);
          break;
        }
        memory.regime = boundaries_[memory.next++].beyond;
        break;
      case k_lateral_boundary:
        ++memory.next;
        break;
      case k_impingement:
        memory.has_impinged = true;
        break;
      case k_reload:
        resume_loading(i, x, log);
        if (!end) end = end_passed(i, x, log);
        break;
      case k_lost:
        x = origin(i);
        lose_contact(i);
        break;
      default:
        end = ended(Limit::walls_meet, event, x);
        break;
    }
    if (classes_[i].takes_force) y[places_[i]] = coordinate(i, x);
  }
  if (end) return end;
  resolve_lateral();
  arm_guards(xi, y);
  return std::nullopt;
}

}  // namespace monograin::plastic
