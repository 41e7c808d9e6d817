#include "nonlocal/guards.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

int as_int(std::size_t index) noexcept { return static_cast<int>(index); }

/// Distance of the state of Particle::evaluate_contacts() from a limit; negative beyond it.
double limit_value(Particle& p, const Guard& guard, double xi) {
  if (guard.kind == k_radius) {
    return p.scales().widest - p.contact(guard.list_index()).contact_radius;
  }
  if (guard.kind == k_centre) return 1.0 - p.depth(guard.list_index(), xi);
  // Vanishes where the margin is k_margin_of_fold, in whatever order the walls are eliminated.
  return p.contacts().least_pivot(p.state(), k_margin_of_fold);
}

}  // namespace

std::vector<Pair> pairs_of(const Contacts& contacts) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < contacts.class_count(); ++i) {
    for (const Neighbours& alike : contacts.neighbours(i)) {
      // Opposite walls never meet.
      if (alike.contact_class >= i && alike.angle < std::numbers::pi - k_same_direction)
        pairs.push_back({i, alike.contact_class, alike.angle});
    }
  }
  return pairs;
}

void GuardSet::start() {
  for (Pair& pair : pairs_) pair.has_impinged = false;
  has_stiffened_ = false;
}

const Pair& GuardSet::impinge(std::size_t pair) noexcept {
  pairs_[pair].has_impinged = true;
  return pairs_[pair];
}

Guard& GuardSet::add(int kind, int index, int direction, std::string_view name) {
  return list_.emplace_back(Guard{kind, index, direction, name});
}

void GuardSet::arm(Particle& p) {
  list_.clear();
  bool is_at_rest = true;
  for (std::size_t i = 0; i < p.size(); ++i) is_at_rest = is_at_rest && p.ramp(i).start == p.ramp(i).end;
  if (is_at_rest) return;
  arm_contacts(p);
  if (p.has_free_centre()) arm_carriers(p);
  arm_impingement(p);
  if (p.has_free_centre()) arm_ends_of_forces(p);
  arm_limits(p);
}

/// Arms the guards of contacts made and lost at walls under displacement control.
void GuardSet::arm_contacts(const Particle& p) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_force_controlled(i)) continue;
    if (!p.mode.is_closed[i])
      add(k_made, as_int(i), 1, "contact-made");
    else
      // The other contacts depend on this contact's force, whose second derivative is infinite where contact is lost.
      add(k_lost, as_int(i), -1, "contact-lost").is_branch_end = true;
  }
}

/// Arms the guards of where an open wall begins and ceases to move a free centre.
void GuardSet::arm_carriers(const Particle& p) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_force_controlled(i) || p.mode.is_closed[i]) continue;
    Guard& guard =
        p.mode.touches[i] ? add(k_left, as_int(i), -1, "wall-left") : add(k_touched, as_int(i), 1, "wall-touched");
    guard.is_silent = true;
  }
}

/// Arms the guards of contacts that meet on the surface, each pair once.
void GuardSet::arm_impingement(const Particle& p) {
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const bool both = p.mode.is_closed[pairs_[k].first] && p.mode.is_closed[pairs_[k].second];
    if (both && !pairs_[k].has_impinged) add(k_impingement, as_int(k), -1, "impingement");
  }
}

/// Arms the guards that stop an integrator at k_ahead before the end of a force that bears a free centre.
void GuardSet::arm_ends_of_forces(const Particle& p) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.is_force_controlled(i) || p.end_of_force(i) == k_infinity) continue;
    Guard& guard = add(k_force_ends, as_int(i), -1, "force-ends");
    guard.is_silent = guard.is_exact = true;
  }
}

/// Arms the guards of stiffening, and of the ends of the domain.
void GuardSet::arm_limits(Particle& p) {
  // The formulation stiffens before it reaches its limit, so that the limit needs no guard until then.
  const bool will_stiffen = !has_stiffened_ && p.contacts().least_pivot(p.state(), k_stiff_margin) > 0.0;
  if (!has_stiffened_) add(k_stiffening, -1, -1, "stiffening");
  const Settings& settings = p.settings();
  const bool needs_radius = settings.radius_rule != RadiusRule::none || settings.model.terms == Terms::all;
  for (std::size_t i = 0; needs_radius && i < p.size(); ++i) {
    if (p.mode.is_closed[i]) add(k_radius, as_int(i), -1, "radius-limit");
  }
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.mode.is_closed[i]) add(k_centre, as_int(i), -1, "limit");
  }
  if (!will_stiffen) add(k_limit, -1, -1, "limit");
}

/// Angle that two contacts leave free between their edges; 0 where they meet.
double GuardSet::angle_between_edges(Particle& p, const Pair& pair, double xi) {
  // Each class belongs to many pairs.
  const auto edge = [&](std::size_t i) {
    if (std::isnan(edge_angles_[i])) {
      const double radius = p.contacts().deformed_radius(p.settings().radius_rule, i, p.state());
      edge_angles_[i] = edge_angle(radius, p.depth(i, xi));
    }
    return edge_angles_[i];
  };
  return pair.angle - edge(pair.first) - edge(pair.second);
}

void GuardSet::values(Particle& p, double xi, std::span<const double> y, std::span<double> values) {
  p.evaluate_contacts(xi, y);
  std::ranges::fill(edge_angles_, k_nan);
  const Scales& scales = p.scales();
  for (std::size_t g = 0; g < list_.size(); ++g) {
    const std::size_t index = list_[g].list_index();
    switch (list_[g].kind) {
      case k_made:
        values[g] = (p.state()[index] - scales.touch) / scales.guard_unit;
        break;
      case k_lost:
        values[g] = (p.state()[index] + scales.touch) / scales.guard_unit;
        break;
      case k_touched:
        values[g] = (p.state()[index] + k_begins * scales.touch) / scales.guard_unit;
        break;
      case k_left:
        values[g] = (p.state()[index] + scales.idle) / scales.guard_unit;
        break;
      case k_impingement:
        values[g] = angle_between_edges(p, pairs_[index], xi);
        break;
      case k_stiffening:
        values[g] = p.contacts().least_pivot(p.state(), k_stiff_margin);  // zero where the margin is k_stiff_margin
        break;
      case k_force_ends:
        values[g] = p.end_of_force(index) - k_ahead - xi;
        break;
      default:
        values[g] = limit_value(p, list_[g], xi);
        break;
    }
  }
}

DomainEnd GuardSet::end_at(Particle& p, const Guard& guard, double xi, std::span<const double> y) {
  const Event event{guard.name, guard.index};
  if (guard.kind == k_radius) {
    return {event, {Limit::contact_as_wide_as_particle, guard.index, "contact radius/R0", p.scales().widest}};
  }
  if (guard.kind == k_centre) return {event, {Limit::wall_at_centre, guard.index, "displacement/R0", 1.0}};
  p.evaluate_contacts(xi, y);
  double largest = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) largest = std::max(largest, p.depth(i, xi));
  return {event, {Limit::applicability, -1, "largest displacement/R0", largest}};
}

std::optional<DomainEnd> GuardSet::limit_at_start(Particle& p, std::span<const double> y) const {
  for (const Guard& guard : list_) {
    if (guard.kind < k_radius) continue;
    p.evaluate_contacts(0.0, y);
    const double now = limit_value(p, guard, 0.0);
    if (now > 0.0) continue;
    std::vector<double> ahead(y.begin(), y.end());
    try {
      p.solve(k_ahead, ahead);
    } catch (const std::domain_error&) {
      return end_at(p, guard, 0.0, y);
    }
    p.evaluate_contacts(k_ahead, ahead);
    if (limit_value(p, guard, k_ahead) < now) return end_at(p, guard, 0.0, y);
  }
  return std::nullopt;
}

}  // namespace monograin::nonlocal
