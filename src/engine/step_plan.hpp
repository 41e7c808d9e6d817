/// Ramps, duration and end conditions of a leg of the program, computed from the state at its beginning.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/guard_set.hpp"
#include "scene/scene.hpp"
#include "system/limit.hpp"

namespace monograin {

/// The run cannot go on: it has left the model's domain, or its program contradicts itself.
struct Stop {
  LimitPoint point;
  std::string message;
};

struct StepPlan {
  std::vector<Ramp> ramps;       ///< of the walls; a contact that is lost bears no force below zero
  std::vector<Ramp> prescribed;  ///< by the program
  double duration = 0.0;         ///< [s]
  std::vector<Condition> conditions;
  std::vector<std::string> ending_events;
  Leg leg{};                   ///< place of the ramps in their step
  std::vector<int> detaching;  ///< channels that are withdrawn until their contacts are open
};

/// Plans a leg of the program that begins at the state (xi, y) where the leg before has ended.
/// @param leg      index in the programs
/// @param resting  what each channel keeps if its step does not move it
/// @throws Stop where channels need different times
[[nodiscard]] StepPlan plan_leg(const Scene& scene, std::size_t leg, std::span<const Ramp> resting,
                                const GuardSet& guard_set, double xi, std::span<const double> y);

/// Ramp that a channel keeps after a leg that ended at xi, if the next step does not move it: the value reached at xi,
/// held. A force-controlled wall whose contact is open keeps a force of zero.
/// @param is_over  false: the step goes on after the leg, from the prescribed value
[[nodiscard]] Ramp ramp_after(const StepPlan& plan, const HybridSystem& system, int channel, double xi, bool is_over);

/// A condition in the words of the scenario, e.g. "until axial.force = 1000 N".
[[nodiscard]] std::string condition_text(const Scene& scene, const Condition& condition);

/// A value of a quantity with its unit, e.g. "1000 N".
[[nodiscard]] std::string with_unit(double value, Quantity quantity);

}  // namespace monograin
