#include "engine/step_work.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "system/resolution.hpp"

namespace monograin {
namespace {

// Events in a row without progress that a leg may have; more of them show that two modes are chattering.
constexpr int k_most_idle_events = 50;
// Internal steps in a row that may leave the step coordinate where it is; after more of them the run fails.
constexpr int k_most_idle_steps = 1000;
// Evaluations of the equations allowed per allowed internal step. Some codes take many evaluations for one step, so
// that a bound on steps alone would not bound the work.
constexpr long k_most_evaluations = 10;
// Events that one leg of the program may have; more of them are taken to go on without end.
constexpr int k_most_events = 1000;

}  // namespace

void StepWork::begin() {
  first_evaluation_ = integrator_.rhs_evaluations();
  internal_steps_ = idle_steps_ = events_ = idle_events_ = 0;
  idle_guards_.clear();
}

void StepWork::begin_internal_step(double xi) {
  const long evaluations = integrator_.rhs_evaluations() - first_evaluation_;
  const long most = integrator_.most_steps();
  if (internal_steps_ == most || evaluations > k_most_evaluations * most) {
    throw SolverError(Failure::too_much_work, xi, integrator_.statistics().last_step,
                      fmt::format("{} internal steps and {} evaluations of the equations have not brought this step of "
                                  "the program to its end; where the equations are stiff, expected cvode-bdf or ida",
                                  internal_steps_, evaluations));
  }
  ++internal_steps_;
}

void StepWork::end_internal_step(double from, double xi) {
  idle_steps_ = xi > from ? 0 : idle_steps_ + 1;
  if (idle_steps_ <= k_most_idle_steps) return;
  throw SolverError(
      Failure::no_progress, xi, integrator_.statistics().last_step,
      fmt::format("{} internal steps in a row are shorter than the round-off of the step coordinate", idle_steps_));
}

void StepWork::count_event(double length, double xi) {
  if (length >= k_same_instant) {
    idle_events_ = 0;
    idle_guards_.clear();
  } else {
    for (const std::size_t guard : integrator_.fired()) idle_guards_.insert(guard_set_.name(guard));
  }
  if (++idle_events_ > k_most_idle_events) {
    throw SolverError(Failure::chattering, xi, 0.0, fmt::format("{}", fmt::join(idle_guards_, ", ")));
  }
  if (++events_ > k_most_events) {
    throw SolverError(Failure::endless_events, xi, 0.0,
                      fmt::format("{} events in one step of the program", k_most_events));
  }
}

}  // namespace monograin
