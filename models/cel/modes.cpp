#include "cel/modes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "cel/newton.hpp"
#include "contacts/side_ahead.hpp"
#include "system/resolution.hpp"

namespace monograin::cel {
namespace {

/// Largest coverage to which the law is fitted: half the contact area over pi R0^2, which is 2 for the whole surface.
constexpr double k_most_coverage = 1.7;

/// Names and directions of the guards.
struct Kind {
  GuardKind kind;
  std::string_view name;
  int direction;
};
constexpr std::array k_kinds{Kind{k_made, "contact-made", 1}, Kind{k_lost, "contact-lost", -1},
                             Kind{k_yield, "yield", 1},       Kind{k_reversal, "load-reversal", -1},
                             Kind{k_fold, "limit", -1},       Kind{k_coverage, "limit", -1},
                             Kind{k_away, "limit", -1}};

/// Elastic displacement of a contact at the first trial instant ahead at which it is clearly open or closed; 0 if it
/// stays undecided, none if no state exists ahead. Trials begin with the motion at this instant.
std::optional<double> displacement_ahead(const Particle& p, const Motion& motion, std::size_t i, double xi,
                                         std::span<const double> y) {
  Particle ahead = p;
  Newton newton;
  const auto at = [&](double later) {
    std::vector<double> state(y.begin(), y.end());
    for (std::size_t j = 0; j < p.layout().size(); ++j) state[j] += (later - xi) * motion.drawn_rates()[j];
    newton.solve(ahead, later, state);
    return state[i];
  };
  return contacts::side_ahead(xi, Particle::k_touch * p.depth(), at);
}

/// True if a contact touches from here on: by its elastic displacement or, if that is within its slack, by the
/// displacement a little later.
/// @param is_made, is_lost  which of its guards has fired. A guard that is met is at the slack; one that fires because
/// it is within the integrator's tolerance may be anywhere inside.
bool will_touch(const Particle& p, const Motion& motion, std::size_t i, double xi, std::span<const double> y,
                bool is_made, bool is_lost) {
  const ClassState& c = p.classes[i];
  if (c.is_force_controlled()) return c.contact.F > 0.0 || c.drive.rate() > 0.0;
  const double u = c.contact.u;
  if (std::abs(u) > (is_made || is_lost ? 0.5 : 1.0) * p.slack(i)) return u > 0.0;
  const std::optional<double> ahead = displacement_ahead(p, motion, i, xi, y);
  return ahead ? *ahead > 0.0 : is_made;
}

/// Finds the largest set of contacts that can flow together. Takes in all contacts at yield whose yield function would
/// rise if they did not flow, and drops contacts whose dents would then shrink: first those that would shrink fastest,
/// equal ones together, and for good, so that the order of the walls does not matter.
/// @param may_flow  false for contacts that are ruled out
void decide_flow(Particle& p, Motion& motion, double xi, std::span<const double> y, std::vector<bool>& may_flow) {
  for (ClassState& c : p.classes) c.flows = false;
  for (bool has_changed = true; has_changed;) {
    motion.evaluate(p, xi, y);
    const auto dent_rate = [&](std::size_t i) { return motion.rates()[p.layout().dent(i)]; };
    double worst = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) worst = std::min(worst, dent_rate(i));
    has_changed = worst < 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      ClassState& c = p.classes[i];
      if (worst < 0.0) {
        if (c.flows && dent_rate(i) <= worst * (1.0 - k_at_rest)) c.flows = may_flow[i] = false;
      } else if (!c.flows && may_flow[i] && c.touches && c.yield.f > -k_solved &&
                 motion.yield_rate(p, i) > k_zero_guard) {
        c.flows = has_changed = true;
      }
    }
  }
}

double value_of(const Guard& guard, const Particle& p, const Motion& motion, double xi) {
  const std::size_t i = guard.list_index();
  const ClassState& c = p.classes[i];
  const double dent_rate = motion.rates()[p.layout().dent(i)];
  switch (static_cast<GuardKind>(guard.kind)) {
    case k_made:
      return (c.contact.u - p.slack(i)) / p.depth();
    case k_lost:
      return c.is_force_controlled() ? c.drive.value(xi) / c.drive.size() : (c.contact.u + p.slack(i)) / p.depth();
    case k_yield:
      // More than round-off: a contact that just stopped flowing is at yield.
      return c.yield.f - k_same_value;
    case k_reversal:
      return dent_rate / (std::abs(dent_rate) + std::abs(c.drive.rate()) + p.depth());
    case k_fold:
      return motion.margin() - k_margin_of_fold;
    case k_away:
      return p.centre.room(xi, p.position());
    case k_coverage:
      return k_most_coverage - p.coverage().Om;
  }
  return k_nan;
}

}  // namespace

Guard& GuardSet::add(GuardKind kind, int index) {
  const Kind& of = *std::ranges::find(k_kinds, kind, &Kind::kind);
  list_.push_back({.kind = kind, .index = index, .direction = of.direction, .name = of.name});
  return list_.back();
}

void GuardSet::arm(const Particle& p) {
  list_.clear();
  if (p.is_at_rest()) return;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const int index = static_cast<int>(i);
    const ClassState& c = p.classes[i];
    if (!c.is_force_controlled()) {
      add(c.touches ? k_lost : k_made, index).is_silent = c.is_released;
    } else if (c.drive.end() < 0.0) {
      Guard& lost = add(k_lost, index);
      lost.is_exact = lost.is_monotone = true;
    }
    if (c.touches) add(c.flows ? k_reversal : k_yield, index);
  }
  add(k_fold, -1);
  add(k_coverage, -1);
  if (p.layout().directions > 0 && std::ranges::any_of(p.classes, &ClassState::is_force_controlled)) add(k_away, -1);
}

void GuardSet::values(const Particle& p, const Motion& motion, double xi, std::span<double> values) const {
  for (std::size_t g = 0; g < list_.size(); ++g) values[g] = value_of(list_[g], p, motion, xi);
}

std::optional<DomainEnd> GuardSet::limit_met(const Particle& p, const Motion& motion, double xi) const {
  for (const Guard& guard : list_) {
    if (is_limit(guard) && value_of(guard, p, motion, xi) <= 0.0) return end_at(guard, p, xi);
  }
  return std::nullopt;
}

DomainEnd end_at(const Guard& guard, const Particle& p, double xi) {
  const Event event{guard.name};
  if (guard.kind == k_coverage)
    return {event, {Limit::surface_covered, -1, "share of the surface", 0.5 * p.coverage().Om}};
  if (guard.kind == k_away) return {event, {.limit = Limit::centre_driven_away}};
  double largest = 0.0;
  for (const ClassState& c : p.classes) largest = std::max(largest, c.position(xi));
  return {event, {Limit::applicability, -1, "largest displacement/R0", largest}};
}

void decide_mode(Particle& p, Motion& motion, double xi, std::span<const double> y, std::span<const Guard> fired,
                 std::vector<Event>& log) {
  motion.evaluate(p, xi, y);
  const auto has_fired = [&](int kind, std::size_t i) {
    return std::ranges::any_of(fired, [&](const Guard& g) { return g.kind == kind && g.index == static_cast<int>(i); });
  };
  const auto note = [&](std::string_view event, std::size_t i) { log.push_back({event, static_cast<int>(i)}); };
  for (std::size_t i = 0; i < p.size(); ++i) {
    const bool touches = will_touch(p, motion, i, xi, y, has_fired(k_made, i), has_fired(k_lost, i));
    if (touches != p.classes[i].touches) note(touches ? "contact-made" : "contact-lost", i);
    p.classes[i].touches = touches;
  }
  if (p.is_at_rest()) return;
  std::vector<bool> flowed, may_flow;
  for (std::size_t i = 0; i < p.size(); ++i) {
    flowed.push_back(p.classes[i].flows);
    // A dent that has just come to rest does not grow at this instant.
    may_flow.push_back(!has_fired(k_reversal, i));
  }
  decide_flow(p, motion, xi, y, may_flow);
  motion.begin_flow(xi);
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.classes[i].flows != flowed[i]) note(flowed[i] ? "load-reversal" : "yield", i);
  }
}

}  // namespace monograin::cel
