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
      : scene_(scene),
        guard_set_(guard_set),
        open_since_(scene.channels.size()),
        openings_(scene.channels.size()),
        unborne_(scene.channels.size()) {}

  /// The run begins to cover a leg at xi: contacts that are open there count as open from there on.
  void begin_openings(double xi);
  /// Records since when in this leg each channel's contact has been open.
  void note_open(double xi);

  /// A leg begins. If it is the first one of its step, keeps the values of the conditions' quantities there, and notes
  /// tables and sines that do not begin where their walls are.
  void begin_leg(const StepPlan& plan, const StepClock& clock);
  /// A condition holds where the step begins, and ends it there.
  void note_met_at_begin(const Condition& condition, const StepClock& clock);
  /// A step has ended by none of its conditions.
  void note_unmet_conditions(const StepPlan& plan, const StepClock& clock, double xi, std::span<const double> y);
  /// A leg has ended. Notes the prescribed forces of contacts that are open there.
  void note_unborne_forces(const StepPlan& plan, const StepClock& clock, double xi);

  [[nodiscard]] std::vector<std::string> texts();

 private:
  /// The largest force of a step that no contact bears.
  struct UnborneForce {
    std::size_t step = 1;     ///< number of the step
    double force = 0.0;       ///< [N]
    double time = 0.0;        ///< [s]
    double open_since = 0.0;  ///< [s]
  };
  void close_step();
  void note_starts(const StepPlan& plan, const StepClock& clock);
  /// Keeps the opening of a contact over the legs of a step.
  void note_opening(std::size_t channel, const StepClock& clock);

  const Scene& scene_;
  const GuardSet& guard_set_;
  std::vector<std::optional<double>> open_since_;  ///< step coordinate, for each channel; empty while it is closed
  std::vector<std::optional<double>> openings_;    ///< [s], in this step; of each channel that is open at a leg's end
  std::vector<std::optional<UnborneForce>> unborne_;  ///< of the present step, for each channel
  std::vector<double> at_begin_;                      ///< of the step, by condition
  ProgramNotes notes_;
};

}  // namespace monograin
