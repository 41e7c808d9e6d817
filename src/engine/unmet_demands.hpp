/// Demands of a program that a run does not meet.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/guard_set.hpp"
#include "engine/program_notes.hpp"
#include "engine/step_clock.hpp"
#include "engine/step_plan.hpp"

namespace monograin {

/// Notes conditions that ended no step and prescribed forces that no contact has borne.
class UnmetDemands {
 public:
  UnmetDemands(const Scene& scene, const GuardSet& guard_set)
      : scene_(scene), guard_set_(guard_set), open_since_(scene.channels.size()) {}

  void begin_step(double xi);
  /// Records since when in this step each channel's contact has been open.
  void note_open(double xi);

  /// Keeps the values of the conditions' quantities where the first leg of a step begins.
  void note_begin(const StepPlan& plan);
  /// A condition holds where the step begins, and ends it there.
  void note_held_at_begin(const Condition& condition, const StepClock& clock);
  /// A step has ended by none of its conditions.
  void note_conditions(const StepPlan& plan, const StepClock& clock, double xi, std::span<const double> y);
  /// A step has ended. Notes the forces that no contact bears then, because it opened before.
  void note_forces(const StepPlan& plan, const StepClock& clock, double xi);

  [[nodiscard]] std::vector<std::string> texts() const { return notes_.texts(); }

 private:
  const Scene& scene_;
  const GuardSet& guard_set_;
  std::vector<std::optional<double>> open_since_;  ///< step coordinate, for each channel; empty while it is closed
  std::vector<double> at_begin_;                   ///< of the step, by condition
  ProgramNotes notes_;
};

}  // namespace monograin
