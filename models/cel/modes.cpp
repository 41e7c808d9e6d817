#include "cel/modes.hpp"

#include <algorithm>
#include <cmath>

#include "cel/newton.hpp"
#include "contacts/side_ahead.hpp"

namespace monograin::cel {
namespace {

/// Distance of the yield function from zero up to which a contact may flow.
constexpr double k_at_yield = 1e-9;
/// Least rate of the yield function at which a contact at yield begins to flow.
constexpr double k_least_rate = 1e-13;
/// Relative difference of the rates of dents that is round-off.
constexpr double k_alike = 1e-6;

/// Elastic displacement of a contact at the first trial instant ahead at which it is clearly open or closed, or else 0.
/// Trials begin with the motion at this instant.
double displacement_ahead(const Particle& p, const Motion& motion, std::size_t i, double xi,
                          std::span<const double> y) {
  Particle ahead = p;
  Newton newton;
  const auto at = [&](double later) {
    std::vector<double> state(y.begin(), y.end());
    for (std::size_t j = 0; j < p.layout().size(); ++j) state[j] += (later - xi) * motion.drawn_rates()[j];
    newton.solve(ahead, later, state);
    return state[i];
  };
  return contacts::side_ahead(xi, Particle::k_touch * p.depth(), at).value_or(0.0);
}

/// True if a contact touches from here on: by its elastic displacement or, if that is within its slack, by the
/// displacement a little later.
bool will_touch(const Particle& p, const Motion& motion, std::size_t i, double xi, std::span<const double> y) {
  const ClassState& c = p.classes[i];
  if (c.takes_force()) return c.contact.F > 0.0 || c.drive.rate() > 0.0;
  const double u = c.contact.u;
  return (std::abs(u) > p.slack(i) ? u : displacement_ahead(p, motion, i, xi, y)) > 0.0;
}

/// Finds the largest set of contacts that can flow together. Takes in all contacts at yield whose yield function would
/// rise if they did not flow, and drops contacts whose dents would then shrink: first those that would shrink fastest,
/// equal ones together, and for good, so that the order of the walls does not matter.
/// @param may_flow  false for contacts that are ruled out
void decide_flow(Particle& p, Motion& motion, double xi, std::span<const double> y, std::vector<bool>& may_flow) {
  for (ClassState& c : p.classes) c.flows = false;
  for (bool has_changed = true; has_changed;) {
    p.forget();
    motion.evaluate(p, xi, y);
    const auto dent_rate = [&](std::size_t i) { return motion.rates()[p.layout().dent(i)]; };
    double worst = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) worst = std::min(worst, dent_rate(i));
    has_changed = worst < 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      ClassState& c = p.classes[i];
      if (worst < 0.0) {
        if (c.flows && dent_rate(i) <= worst * (1.0 - k_alike)) c.flows = may_flow[i] = false;
      } else if (!c.flows && may_flow[i] && c.touches && c.yield.f > -k_at_yield &&
                 motion.yield_rate(p, i) > k_least_rate) {
        c.flows = has_changed = true;
      }
    }
  }
}

}  // namespace

void decide_mode(Particle& p, Motion& motion, double xi, std::span<const double> y, std::span<const Guard> fired,
                 std::vector<Event>& log) {
  motion.evaluate(p, xi, y);
  const auto has_fired = [&](int kind, std::size_t i) {
    return std::ranges::any_of(fired, [&](const Guard& g) { return g.kind == kind && g.index == static_cast<int>(i); });
  };
  const auto note = [&](std::string_view event, std::size_t i) { log.push_back({event, static_cast<int>(i)}); };
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (has_fired(k_made, i) || has_fired(k_lost, i)) continue;
    const bool touches = will_touch(p, motion, i, xi, y);
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
