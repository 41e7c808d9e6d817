#include "engine/unmet_demands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "system/resolution.hpp"

namespace monograin {

void UnmetDemands::begin_step(double xi) {
  std::ranges::fill(open_since_, std::nullopt);
  note_open(xi);
}

void UnmetDemands::note_open(double xi) {
  for (std::size_t c = 0; c < open_since_.size(); ++c) {
    const bool is_open = scene_.system->is_open(static_cast<int>(c));
    if (!is_open) open_since_[c].reset();
    if (is_open && !open_since_[c]) open_since_[c] = xi;
  }
}

void UnmetDemands::note_begin(const StepPlan& plan) {
  if (!plan.leg.is_first()) return;
  at_begin_.clear();
  for (std::size_t i = 0; i < plan.conditions.size(); ++i) at_begin_.push_back(guard_set_.value_at_begin(i));
}

void UnmetDemands::note_held_at_begin(const Condition& condition, const StepClock& clock) {
  notes_.add(clock.number, condition_text(scene_, condition) + " holds where the step begins, and ends it there");
}

void UnmetDemands::note_conditions(const StepPlan& plan, const StepClock& clock, double xi, std::span<const double> y) {
  for (std::size_t i = 0; i < plan.conditions.size(); ++i) {
    const Condition& condition = plan.conditions[i];
    const double begin = at_begin_[i];
    const double end = scene_.system->quantity(condition.quantity, condition.channel, xi, y);
    const bool has_gone_away = std::abs(end - condition.target) > std::abs(begin - condition.target);
    notes_.add(clock.number,
               fmt::format("{} was never met{}", condition_text(scene_, condition),
                           has_gone_away ? ": it lay behind where the step began" : ""),
               fmt::format(" ({} at its beginning, {} at its end)", with_unit(begin, condition.quantity),
                           with_unit(end, condition.quantity)));
  }
  for (const std::string& event : plan.ending_events) {
    notes_.add(clock.number, fmt::format("until event = \"{}\" was never met: no such event happened", event));
  }
}

void UnmetDemands::note_forces(const StepPlan& plan, const StepClock& clock, double xi) {
  for (std::size_t c = 0; c < open_since_.size(); ++c) {
    const Ramp& ramp = plan.ramps[c];
    const double force = ramp.value(xi);
    const bool was_open = open_since_[c] && xi - *open_since_[c] > k_same_instant;
    if (ramp.control != Control::force || force == 0.0 || !was_open) continue;
    notes_.add(clock.number,
               fmt::format("no contact bears the force that is prescribed to '{}'", scene_.channels[c].name),
               fmt::format(" ({:.6g} N at its end; open since t = {:.9g} s)", force, clock.time(*open_since_[c])));
  }
}

}  // namespace monograin
