/// The work that one leg of a program may take.
#pragma once

#include <set>
#include <string>

#include "engine/guard_set.hpp"
#include "engine/integrator.hpp"

namespace monograin {

/// Counts the work in a leg of the program, and gives a leg up that goes on without end. Internal steps and events are
/// idle as long as the step coordinate does not move.
class StepWork {
 public:
  StepWork(const Integrator& integrator, const GuardSet& guard_set) : integrator_(integrator), guard_set_(guard_set) {}

  void begin();

  /// Counts an internal step that is about to begin. @throws SolverError if the step has had all the work it may take
  void begin_internal_step(double xi);
  /// Counts it as idle if it has not moved xi. @throws SolverError after too many idle ones in a row
  void end_internal_step(double from, double xi);
  /// Counts an event at xi, with the guards that the integrator found there.
  /// @param length  of the segment that the event ends
  /// @throws SolverError if events follow each other without end
  void count_event(double length, double xi);

 private:
  const Integrator& integrator_;
  const GuardSet& guard_set_;
  long first_evaluation_ = 0;  ///< evaluations of the equations before the leg
  long internal_steps_ = 0;
  int idle_steps_ = 0;
  int events_ = 0;
  int idle_events_ = 0;
  std::set<std::string> idle_guards_;  ///< names of guards that have fired in idle events
};

}  // namespace monograin
