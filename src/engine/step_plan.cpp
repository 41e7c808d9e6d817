#include "engine/step_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "system/resolution.hpp"

namespace monograin {
namespace {

/// A quantity of a condition: its word in scenario files and its unit.
struct QuantityWords {
  Quantity quantity;
  std::string_view name;
  std::string_view unit;
  bool is_of_contact;  ///< each contact class has its own
};

constexpr std::array k_quantities{
    QuantityWords{Quantity::force, "force", "N", true},
    QuantityWords{Quantity::displacement, "displacement", "m", true},
    QuantityWords{Quantity::pressure, "pressure", "Pa", true},
    QuantityWords{Quantity::contact_radius, "contact_radius", "m", true},
    QuantityWords{Quantity::apparent_radius, "apparent_radius", "m", false},
    QuantityWords{Quantity::stress_axial, "stress_axial", "Pa", false},
    QuantityWords{Quantity::stress_lateral, "stress_lateral", "Pa", false},
    QuantityWords{Quantity::relative_density, "relative_density", "", false},
};

const QuantityWords& words_of(Quantity quantity) {
  return *std::ranges::find(k_quantities, quantity, &QuantityWords::quantity);
}

struct StateAt {
  HybridSystem& system;
  double xi = 0.0;
  std::span<const double> y;
};

/// Ramp of a channel in a leg: from the present value of the controlled quantity to the step's target.
/// @param resting  what the channel keeps if the step does not move it
Ramp ramp_of(const Step& step, int channel, const Ramp& resting, const StateAt& state, const GuardSet& guard_set) {
  const bool is_detaching = step.kind == Step::Kind::detach;
  const std::optional<Control> control = is_detaching ? Control::displacement : control_of(step.kind);
  if (!control) return resting;
  Ramp ramp = resting;
  if (ramp.control != *control) {
    const double present = state.system.controlled(*control, channel, state.xi, state.y);
    ramp = {present, present, *control};
  }
  if (is_detaching) {
    // Withdrawal by one apparent radius: no contact stays closed that far.
    ramp.end = ramp.start - state.system.quantity(Quantity::apparent_radius, channel, state.xi, state.y);
    return ramp;
  }
  // The value at which a condition has ended the last step has an integrator's error: a ramp to that value holds it.
  if (guard_set.has_ended_at(*control, channel, step.target)) ramp.start = step.target;
  ramp.end = std::lerp(ramp.start, step.target, step.share);
  return ramp;
}

/// The part of a leg that a lost contact follows: none of a force below zero. Legs of a table or a sine end where their
/// force passes zero, so that contact is made again there.
Ramp without_pull(Ramp ramp) {
  ramp.start = std::max(ramp.start, 0.0);
  ramp.end = std::max(ramp.end, 0.0);
  return ramp;
}

}  // namespace

StepPlan plan_leg(const Scene& scene, std::size_t leg, std::span<const Ramp> resting, const GuardSet& guard_set,
                  double xi, std::span<const double> y) {
  StepPlan plan;
  plan.leg = scene.longest_program()[leg].leg;
  bool has_duration = false;
  for (std::size_t c = 0; c < scene.channels.size(); ++c) {
    const Channel& channel = scene.channels[c];
    plan.ramps.push_back(resting[c]);
    plan.prescribed.push_back(resting[c]);
    if (leg >= channel.program.size()) continue;
    const Step& of_channel = channel.program[leg];
    const int index = static_cast<int>(c);
    const Ramp ramp = ramp_of(of_channel, index, resting[c], {*scene.system, xi, y}, guard_set);
    plan.prescribed.back() = ramp;
    const bool is_lost = ramp.control == Control::force && ramp.start < 0.0 && scene.system->is_open(index);
    plan.ramps.back() = is_lost ? without_pull(ramp) : ramp;
    if (of_channel.kind == Step::Kind::detach) plan.detaching.push_back(index);
    for (const Until& until : of_channel.until) {
      if (until.is_event())
        plan.ending_events.push_back(until.event);
      else
        plan.conditions.push_back(
            {until.quantity, until.wall.empty() ? index : static_cast<int>(scene.channel_of(until.wall)), until.value});
    }
    if (!of_channel.duration && !of_channel.rate) continue;  // takes as long as the others
    const double duration =
        of_channel.duration ? *of_channel.duration : std::abs(ramp.end - ramp.start) / *of_channel.rate;
    if (has_duration && std::abs(duration - plan.duration) > k_same_number * std::max(duration, plan.duration)) {
      throw Stop{
          {.limit = Limit::unequal_durations},
          fmt::format("step {}: the walls of class '{}' need {:.6g} s where others need {:.6g} s, and steps end "
                      "together; give equal durations",
                      count_steps(std::span(channel.program).first(leg + 1)), channel.name, duration, plan.duration)};
    }
    plan.duration = std::max(plan.duration, duration);
    has_duration = true;
  }
  return plan;
}

Ramp ramp_after(const StepPlan& plan, const HybridSystem& system, int channel, double xi, bool is_over) {
  if (!is_over) {
    const Ramp& prescribed = plan.prescribed[static_cast<std::size_t>(channel)];
    return {prescribed.end, prescribed.end, prescribed.control};
  }
  const Ramp& ramp = plan.ramps[static_cast<std::size_t>(channel)];
  const bool is_lost = ramp.control == Control::force && system.is_open(channel);
  const double value = is_lost ? 0.0 : ramp.value(xi);
  return {value, value, ramp.control};
}

std::string condition_text(const Scene& scene, const Condition& condition) {
  const QuantityWords& words = words_of(condition.quantity);
  const Channel& channel = scene.channels[static_cast<std::size_t>(condition.channel)];
  return fmt::format("until {}{}{} = {}", words.is_of_contact ? channel.name : "", words.is_of_contact ? "." : "",
                     words.name, with_unit(condition.target, condition.quantity));
}

std::string with_unit(double value, Quantity quantity) {
  const std::string_view unit = words_of(quantity).unit;
  return fmt::format("{:.6g}{}{}", value, unit.empty() ? "" : " ", unit);
}

}  // namespace monograin
