#include "engine/unmet_demands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "system/resolution.hpp"

namespace monograin {
namespace {

/// Relative difference of two values that count as equal where a table begins: what a run computes has the error of its
/// integrator.
constexpr double k_same_start = 1e-6;

}  // namespace

void UnmetDemands::begin_openings(double xi) {
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

void UnmetDemands::begin_leg(const StepPlan& plan, const StepClock& clock) {
  if (!plan.leg.is_first()) return;
  close_step();
  std::ranges::fill(openings_, std::nullopt);
  note_starts(plan, clock);
  at_begin_.clear();
  for (std::size_t i = 0; i < plan.conditions.size(); ++i) at_begin_.push_back(guard_set_.value_at_begin(i));
}

void UnmetDemands::note_met_at_begin(const Condition& condition, const StepClock& clock) {
  notes_.add(clock.step_number, condition_text(scene_, condition) + " holds where the step begins, and ends it there");
}

void UnmetDemands::note_unmet_conditions(const StepPlan& plan, const StepClock& clock, double xi,
                                         std::span<const double> y) {
  for (std::size_t i = 0; i < plan.conditions.size(); ++i) {
    const Condition& condition = plan.conditions[i];
    const double begin = at_begin_[i];
    const double end = scene_.system->quantity(condition.quantity, condition.channel, xi, y);
    const bool has_gone_away = std::abs(end - condition.target) > std::abs(begin - condition.target);
    notes_.add(clock.step_number,
               fmt::format("{} was never met{}", condition_text(scene_, condition),
                           has_gone_away ? ": it lay behind where the step began" : ""),
               fmt::format(" ({} at its beginning, {} at its end)", with_unit(begin, condition.quantity),
                           with_unit(end, condition.quantity)));
  }
  for (const std::string& event : plan.ending_events) {
    notes_.add(clock.step_number, fmt::format("until event = \"{}\" was never met: no such event happened", event));
  }
}

void UnmetDemands::note_starts(const StepPlan& plan, const StepClock& clock) {
  for (std::size_t c = 0; c < scene_.channels.size(); ++c) {
    const Channel& channel = scene_.channels[c];
    if (clock.leg >= channel.program.size() || !channel.program[clock.leg].start) continue;
    const double start = *channel.program[clock.leg].start;
    const Ramp& ramp = plan.prescribed[c];
    const double gap = start - ramp.start;
    if (std::abs(gap) <= k_same_start * std::max({std::abs(start), std::abs(ramp.start), std::abs(ramp.end)})) continue;
    const Quantity quantity = ramp.control == Control::force ? Quantity::force : Quantity::displacement;
    notes_.add(clock.step_number,
               fmt::format("the table or sine of '{}' does not begin where the wall is: a ramp leads from there to its "
                           "next point",
                           channel.name),
               fmt::format(" (it begins at {}, the wall is at {}, a gap of {})", with_unit(start, quantity),
                           with_unit(ramp.start, quantity), with_unit(gap, quantity)));
  }
}

void UnmetDemands::note_opening(std::size_t channel, const StepClock& clock) {
  const std::optional<double>& since = open_since_[channel];
  std::optional<double>& opening = openings_[channel];
  if (!since) {
    opening.reset();
  } else if (!opening || *since > 0.0) {
    opening = clock.time(*since);
  }
}

void UnmetDemands::note_unborne_forces(const StepPlan& plan, const StepClock& clock, double xi) {
  for (std::size_t c = 0; c < open_since_.size(); ++c) {
    note_opening(c, clock);
    const Ramp& ramp = plan.prescribed[c];
    const double force = ramp.value(xi);
    const bool was_open = open_since_[c] && xi - *open_since_[c] > k_same_instant;
    if (ramp.control != Control::force || force == 0.0 || !was_open) continue;
    std::optional<UnborneForce>& unborne = unborne_[c];
    if (unborne && std::abs(force) <= std::abs(unborne->force)) continue;
    unborne = {.step = clock.step_number, .force = force, .time = clock.time(xi), .open_since = *openings_[c]};
  }
}

void UnmetDemands::close_step() {
  for (std::size_t c = 0; c < unborne_.size(); ++c) {
    if (!unborne_[c]) continue;
    notes_.add(unborne_[c]->step,
               fmt::format("no contact bears the force that is prescribed to '{}'", scene_.channels[c].name),
               fmt::format(" ({:.6g} N at t = {:.9g} s; open since t = {:.9g} s)", unborne_[c]->force,
                           unborne_[c]->time, unborne_[c]->open_since));
    unborne_[c].reset();
  }
}

std::vector<std::string> UnmetDemands::texts() {
  close_step();
  return notes_.texts();
}

}  // namespace monograin
