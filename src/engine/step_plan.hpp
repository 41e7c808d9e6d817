/// A step of the program, worked out from where its channels stand when it begins.
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
  std::vector<Ramp> ramps;
  double duration = -1.0;  ///< [s]; negative while no channel has said
  std::vector<Condition> conditions;
  std::vector<std::string> ending_events;
  std::vector<int> detaching;  ///< classes that are withdrawn until they are open
};

/// Works out a step that begins at a state.
/// @param held  what each channel keeps when the step says nothing
/// @throws Stop where channels need different times
[[nodiscard]] StepPlan plan_step(const Scene& scene, std::size_t step, std::span<const Ramp> held,
                                 const GuardSet& guard_set, double xi, std::span<const double> y);

/// What a channel keeps after a step when nothing else is said: the end of its ramp, or where that was interrupted, at
/// xi. A wall whose contact has snapped off bears no force any more.
[[nodiscard]] Ramp ramp_after(const StepPlan& plan, const HybridSystem& system, int channel, double xi);

/// A condition in the words of the scenario, e.g. "until axial.force = 1000 N".
[[nodiscard]] std::string condition_text(const Scene& scene, const Condition& condition);

/// A value of a quantity with its unit, e.g. "1000 N".
[[nodiscard]] std::string with_unit(double value, Quantity quantity);

}  // namespace monograin
