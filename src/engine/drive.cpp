#include "engine/drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "engine/fired_guards.hpp"
#include "engine/forward_sensitivities.hpp"
#include "engine/guard_set.hpp"
#include "engine/output_rows.hpp"
#include "engine/step_clock.hpp"
#include "engine/step_plan.hpp"
#include "engine/step_work.hpp"
#include "engine/unmet_demands.hpp"
#include "scenario/integrators.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

/// Approximate number of output points in a leg. Points that divide a step are counted as if it had one leg.
[[nodiscard]] std::size_t rows_of_leg(const Scene& scene, const Output& output) {
  if (output.times.empty()) return static_cast<std::size_t>(output.points);
  return output.times.size() / std::max<std::size_t>(scene.leg_count(), 1);
}

/// A run. Its time is divided into
///
///   program        all steps
///   step           as a scenario gives it: with its conditions and its output points
///   leg            part of a step in which every prescribed value is a linear ramp; tables and sines have many, other
///                  steps have one. The step coordinate xi runs from 0 to 1 in each leg
///   segment        between two events in a leg; the equations are smooth there
///   internal step  of the integrator (the direct form calls it a piece)
///
/// and each function calls the one below it:
///
///   run_program()          all legs, with the rows at corners and ends
///     begin_leg()          plans the ramps and restarts the system
///     run_leg()            ends at once if a condition is met; else places the output points
///       cover_leg()        all segments, and the remainder after the last event
///         cover_segment()  twice if the derivatives have to find the end of a branch first
///           advance_to_guard()  internal steps
///         handle_event()   between two segments
///     end_leg()
///   rehearse()             all legs of a step without rows, to find out where the step will end
class Drive {
 public:
  Drive(Scene& scene, std::string_view integrator, const Tolerances& tolerances, const Output& output,
        HistorySink& sink, ForwardSensitivities* sensitivities)
      : scene_(scene),
        system_(*scene.system),
        guard_set_(system_),
        integrator_(
            make_integrator(integrator, system_, guard_set_, tolerances, rows_of_leg(scene, output), sensitivities)),
        sensitivities_(sensitivities),
        work_(*integrator_, guard_set_),
        rows_(output, clock_, *integrator_, sink, sensitivities, system_.unknowns().size()),
        demands_(scene, guard_set_),
        y_(system_.unknowns().size()),
        trial_(y_.size()) {
    if (integrator != integrators::k_direct) rtol_ = tolerances.rtol;
    for (const Channel& channel : scene.channels) resting_ramps_.push_back(channel.at_rest);
  }

  DriveResult run() {
    DriveResult result;
    try {
      run_program();
    } catch (LostSensitivities& lost) {
      lost.evaluations = evaluations();
      throw;
    } catch (const Stop& stop) {
      stop_at(stop.point, stop.message, result);
    } catch (const CannotBegin& error) {
      stop_at(error.point(), clock_.where(0.0) + error.what(), result);
      rows_.close_instant(0.0, y_, std::vector<Event>{{error.end().event}});
    } catch (const std::domain_error& error) {
      stop_at(as_domain_error(error).point(), clock_.where(xi_) + error.what(), result);
      record_limit();
    } catch (const SolverError& error) {
      result.status = RunStatus::failed;
      result.failure = error.failure();
      result.message = clock_.where(error.xi()) + error.what();
      result.difficulty = difficulty_here();
      if (result.difficulty) result.message += fmt::format("; {}", advice(*result.difficulty));
      if (rtol_ && *rtol_ < k_finest_rtol) {
        result.message += fmt::format("; rtol = {:.3g} asks for errors of the size of round-off, expected {:g} or more",
                                      *rtol_, k_finest_rtol);
      }
    }
    result.statistics = integrator_->statistics();
    result.statistics.rhs_evaluations = evaluations();
    result.statistics.events = event_count_;
    for (const Diagnostic& warning : system_.warnings()) {
      result.warnings.push_back(fmt::format("{} ({} = {:.6g})", warning.message, warning.quantity, warning.value));
    }
    for (std::string& note : demands_.texts()) result.warnings.push_back(std::move(note));
    if (result.status == RunStatus::complete) {
      if (auto note = rows_.note_unreached_times(clock_.time(xi_))) result.warnings.push_back(*std::move(note));
    }
    return result;
  }

 private:
  void run_program() {
    system_.start(y_);
    with_sensitivities([](ForwardSensitivities& s) { s.start(); });
    std::vector<Event> log;
    bool is_met = false;
    for (std::size_t leg = 0; leg < scene_.leg_count(); ++leg) {
      // A condition ends all that is left of a table or a sine.
      if (is_met && !place_of(leg).is_first()) continue;
      begin_leg(leg, log);
      // The rows before this corner are recorded already; the row after it belongs to the leg that begins.
      const bool is_instant = plan_.leg.is_corner || !log.empty();
      if (!plan_.leg.is_corner) rows_.pass_joint(is_instant);
      if (leg == 0)
        rows_.write_first(y_, log);
      else if (is_instant)
        rows_.close_instant(0.0, y_, log);
      is_met = run_leg(log);
      end_leg(is_met, log);
    }
    rows_.close_instant(xi_, y_, log);
  }

  /// Evaluations of the equations of the run and of the neighbours that give its derivatives.
  [[nodiscard]] long evaluations() const {
    const long of_neighbours = sensitivities_ != nullptr ? sensitivities_->evaluations() : 0;
    return integrator_->statistics().rhs_evaluations + of_neighbours;
  }

  [[nodiscard]] const Leg& place_of(std::size_t leg) const { return scene_.longest_program()[leg].leg; }

  /// Records the end of a leg, and of the step if it is its last one.
  /// @param log  takes the events there
  void end_leg(bool is_met, std::vector<Event>& log) {
    const bool is_over = is_met || plan_.leg.is_last();
    if (!is_met && is_over) demands_.note_unmet_conditions(plan_, clock_, xi_, y_);
    demands_.note_unborne_forces(plan_, clock_, xi_);
    rows_.end_leg(xi_);
    if (is_over || place_of(clock_.leg + 1).is_corner)
      rows_.open_instant(xi_, y_);
    else
      rows_.reach_joint(xi_, y_);
    log.clear();
    if (is_met) log.push_back({"until-met"});
    if (is_over) log.push_back({"step-end"});
    rest_where_reached(is_over);
  }

  /// Sets what each channel keeps in a step that does not move it.
  void rest_where_reached(bool is_over) {
    for (std::size_t c = 0; c < resting_ramps_.size(); ++c) {
      resting_ramps_[c] = ramp_after(plan_, system_, static_cast<int>(c), xi_, is_over);
    }
  }

  /// Puts the limit that stops the run into the result, with the contact class if the limit belongs to one.
  void stop_at(const LimitPoint& point, std::string message, DriveResult& result) const {
    result.status = RunStatus::stopped;
    result.limit = point.limit;
    result.message = std::move(message);
    const auto classes = system_.classes();
    if (point.contact_class < 0 || static_cast<std::size_t>(point.contact_class) >= classes.size()) return;
    result.message += fmt::format(", at '{}'", classes[static_cast<std::size_t>(point.contact_class)].name);
  }

  [[nodiscard]] std::optional<Difficulty> difficulty_here() {
    try {
      return system_.difficulty(xi_, y_);
    } catch (const std::domain_error&) {
      return std::nullopt;
    }
  }

  [[nodiscard]] bool has_ending_event(const std::vector<Event>& log) const {
    return std::ranges::any_of(log, [&](const Event& event) {
      return std::ranges::find(plan_.ending_events, event.name) != plan_.ending_events.end();
    });
  }

  [[nodiscard]] bool is_detached() const {
    return !plan_.detaching.empty() && std::ranges::all_of(plan_.detaching, [&](int c) { return system_.is_open(c); });
  }

  /// Applies an action to the sensitivities if there are any. They take no part in the rehearsal of a step.
  template <class Action>
  void with_sensitivities(Action&& action) {
    if (sensitivities_ != nullptr && sensitivities_->is_active()) action(*sensitivities_);
  }

  void begin_leg(std::size_t leg, std::vector<Event>& log) {
    plan_ = plan_leg(scene_, leg, resting_ramps_, guard_set_, xi_, y_);
    clock_ = clock_.next(xi_, leg, plan_.leg, plan_.duration);
    xi_ = 0.0;
    const std::size_t logged = log.size();
    system_.begin_step(plan_.ramps, y_, log);
    with_sensitivities(
        [&](ForwardSensitivities& s) { s.begin_leg(clock_.leg, plan_, std::span(log).subspan(logged)); });
  }

  /// Runs the leg that has begun; leaves xi_ and y_ where it ends. Returns whether a condition ended it.
  /// @param log  events at its beginning; one of them may be the event that ends the step
  bool run_leg(const std::vector<Event>& log) {
    xi_ = 0.0;
    guard_set_.begin_leg(plan_.conditions, 0.0, y_);
    demands_.begin_leg(plan_, clock_);
    with_sensitivities(
        [this](ForwardSensitivities& s) { s.expect_met_at_begin(guard_set_.met_at_begin().has_value()); });
    rows_.begin_leg();
    if (const auto met = guard_set_.met_at_begin()) {
      demands_.note_met_at_begin(plan_.conditions[*met], clock_);
      return true;
    }
    if (has_ending_event(log)) return true;
    if (is_detached()) return false;
    place_rows();
    return cover_leg();
  }

  [[nodiscard]] bool may_end_early() const noexcept {
    return !plan_.conditions.empty() || !plan_.ending_events.empty() || !plan_.detaching.empty();
  }

  /// Output points divide the step up to its end. If that may come early, the step runs once without recording.
  void place_rows() {
    if (plan_.leg.is_first()) {
      rehearsal_ = {};
      if (may_end_early() && rows_.needs_end_of_step()) rehearsal_ = rehearse();
    }
    rows_.place(plan_.leg, rehearsal_.end, may_end_early() && !rehearsal_.stops);
  }

  struct Rehearsal {
    double end = 1.0;    ///< share of the step's time where the step ends, by a condition or as the run cannot go on
    bool stops = false;  ///< the run cannot go on
  };
  /// Runs the step that has begun without recording it, then restores its beginning.
  Rehearsal rehearse() {
    const std::function<void()> restore = system_.checkpoint();
    const std::vector<double> state = y_;
    const long event_count = event_count_;
    const StepPlan plan = plan_;
    const StepClock clock = clock_;
    const std::vector<Ramp> resting_ramps = resting_ramps_;
    rows_.pause();
    if (sensitivities_ != nullptr) sensitivities_->set_active(false);
    Rehearsal result{.stops = true};
    try {
      cover_rest_of_step();
      result.stops = false;
    } catch (const Stop&) {  // the recorded run will end here again
    } catch (const std::domain_error&) {
    } catch (const SolverError&) {
    }
    rows_.resume();
    if (sensitivities_ != nullptr) sensitivities_->set_active(true);
    restore();
    const double end = std::lerp(plan_.leg.begin, plan_.leg.end, xi_);
    result.end = end > rows_.least_length() ? end : 0.0;
    xi_ = 0.0;
    plan_ = plan;
    clock_ = clock;
    resting_ramps_ = resting_ramps;
    y_ = state;
    event_count_ = event_count;
    guard_set_.begin_leg(plan_.conditions, 0.0, y_);
    return result;
  }

  /// Covers the leg that has begun, and those that follow in its step, without recording.
  void cover_rest_of_step() {
    bool is_met = cover_leg();
    while (!is_met && !plan_.leg.is_last()) {
      rest_where_reached(false);
      std::vector<Event> log;
      begin_leg(clock_.leg + 1, log);
      guard_set_.begin_leg(plan_.conditions, 0.0, y_);
      is_met = guard_set_.met_at_begin() || has_ending_event(log) || cover_leg();
    }
  }

  /// Covers the leg from the present state to where it ends. Returns whether a condition ended it.
  bool cover_leg() {
    demands_.begin_openings(xi_);
    work_.begin();
    while (clock_.duration > 0.0 && 1.0 - xi_ > k_same_instant) {
      const double segment_start = xi_;
      change_state([this](std::span<double> y) { xi_ = system_.leave_singularity(xi_, y); });
      with_sensitivities([this](ForwardSensitivities& s) { s.leave_singularity(xi_); });
      if (xi_ == 1.0) break;
      const auto last = cover_segment();
      if (!last) break;
      ++event_count_;
      work_.count_event(xi_ - segment_start, xi_);
      if (handle_event(*last)) return true;
      if (is_detached()) return false;
    }
    const bool is_solved = solve_remainder();
    xi_ = 1.0;
    with_sensitivities([&](ForwardSensitivities& s) { s.end_leg(y_, is_solved); });
    guard_set_.note_met({}, xi_, y_);
    return guard_set_.is_met(xi_, y_);
  }

  /// Integrates to the first guard that fires, or to the end of the leg. If a branch of solutions ends there, a run
  /// with sensitivities integrates the segment again: the first pass finds how that end moves with the numbers.
  /// @return where the integrator's last step began; nothing if no guard has fired
  std::optional<double> cover_segment() {
    const bool may_need_aim =
        sensitivities_ != nullptr && sensitivities_->is_active() && sensitivities_->may_end_branch();
    if (!may_need_aim) return advance_to_guard();
    const double xi = xi_;
    const std::vector<double> state = y_;
    rows_.buffer();
    std::optional<double> last;
    try {
      last = advance_to_guard();
    } catch (...) {
      rows_.flush_buffer();
      throw;
    }
    if (last && sensitivities_->aim(integrator_->fired(), xi_, y_)) {
      rows_.drop_buffer();
      xi_ = xi;
      y_ = state;
      return advance_to_guard();
    }
    rows_.flush_buffer();
    return last;
  }

  /// Takes internal steps until a guard fires or the leg ends. @return as cover_segment()
  std::optional<double> advance_to_guard() {
    integrator_->begin(xi_, y_);
    while (true) {
      const double last = xi_;
      work_.begin_internal_step(last);
      const Integrator::Advance advance = integrator_->advance();
      work_.end_internal_step(last, advance.xi);
      // Position and state change together: if an output row meets a limit, the run ends with both.
      change_state([&](std::span<double> y) { integrator_->dense_output(advance.xi, y); });
      xi_ = advance.xi;
      rows_.write_before(last, xi_);
      with_sensitivities([&](ForwardSensitivities&) { integrator_->dense_sensitivities(xi_); });
      // An event this close to the end of the leg is at the end: what is left of a ramp is round-off.
      if (advance.hit_guard && 1.0 - xi_ <= k_same_instant) xi_ = 1.0;
      if (advance.hit_guard) return last;
      if (xi_ >= 1.0) return std::nullopt;
    }
  }

  /// Solves for the state at the end of the leg. An event may leave a remainder that is round-off, but an overlap
  /// may be as small. Returns whether there was a remainder.
  bool solve_remainder() {
    if (!(clock_.duration > 0.0 && xi_ < 1.0)) return false;
    change_state([this](std::span<double> y) {
      if (system_.is_solvable())
        system_.solve(1.0, y);
      else
        system_.complete(1.0, y);
    });
    return true;
  }

  /// Applies a change to the state. If the change throws at the end of the equations, the state stays as it was, and
  /// the run ends with it.
  template <class Change>
  void change_state(Change&& change) {
    trial_ = y_;
    change(trial_);
    std::swap(y_, trial_);
  }

  /// Applies the transitions of the guards that fire at xi_. Returns whether a condition of the program ends the step.
  /// @param last  step coordinate where the integrator's last step began
  bool handle_event(double last) {
    const std::vector<std::size_t> fired = fired_guards(guard_set_, *integrator_, last, xi_, y_);
    with_sensitivities([&](ForwardSensitivities& s) { s.locate(fired, xi_, y_); });
    std::vector<std::size_t> of_system;
    for (const std::size_t guard : fired) {
      if (guard < guard_set_.system_guards()) of_system.push_back(guard);
    }
    bool is_met = of_system.size() < fired.size();
    if (are_marks(guard_set_, of_system))
      is_met = pass_marks(of_system) || is_met;
    else if (!of_system.empty())
      is_met = make_transitions(of_system) || is_met;
    if (is_met) guard_set_.note_met(fired, xi_, y_);
    guard_set_.renew();
    with_sensitivities([&](ForwardSensitivities& s) { s.end_event(fired, xi_, is_met); });
    demands_.note_open(xi_);
    return is_met;
  }

  /// Logs guards that change nothing. Returns whether one of their events ends the step.
  bool pass_marks(const std::vector<std::size_t>& guards) {
    std::vector<Event> log;
    static_cast<void>(system_.fire(guards, xi_, y_, log));
    with_sensitivities([&](ForwardSensitivities& s) { s.pass_mark(guards, xi_, log); });
    if (!log.empty()) {
      rows_.open_instant(xi_, y_);
      rows_.close_instant(xi_, y_, log);
    }
    return has_ending_event(log);
  }

  /// Makes the transitions of guards of the system, and solves for the state after them. Returns whether that state or
  /// one of the events meets a condition of the program.
  bool make_transitions(const std::vector<std::size_t>& guards) {
    const bool is_seen =
        std::ranges::any_of(guards, [this](std::size_t guard) { return !system_.guards()[guard].is_silent; });
    if (is_seen) rows_.open_instant(xi_, y_);
    std::vector<Event> log;
    const auto end = system_.fire(guards, xi_, y_, log);
    if (!end) with_sensitivities([&](ForwardSensitivities& s) { s.fire(guards, log); });
    std::exception_ptr failure;
    try {
      if (!end) change_state([this](std::span<double> y) { system_.solve(xi_, y); });
      if (!end) with_sensitivities([](ForwardSensitivities& s) { s.solve(); });
    } catch (const std::domain_error&) {
      failure = std::current_exception();
    }
    // The row after the events is written even if no state was found: the transitions have been made.
    if (is_seen) rows_.close_instant(xi_, y_, log);
    if (end) throw Stop{end->point, clock_.where(xi_) + text_of(end->point)};
    if (failure) std::rethrow_exception(failure);
    return guard_set_.is_met(xi_, y_) || has_ending_event(log);
  }

  /// Records the state where the equations end, if it can still be observed.
  void record_limit() {
    try {
      rows_.open_instant(xi_, y_);
      rows_.close_instant(xi_, y_, std::vector<Event>{{"limit"}});
    } catch (const std::domain_error&) {
      return;  // the history ends with the row before the limit
    }
  }

  Scene& scene_;
  HybridSystem& system_;
  GuardSet guard_set_;
  std::unique_ptr<Integrator> integrator_;
  ForwardSensitivities* sensitivities_;  ///< null if there are none
  StepClock clock_;
  StepWork work_;
  OutputRows rows_;
  UnmetDemands demands_;
  std::optional<double> rtol_;  ///< empty for the direct form, which has no tolerance
  std::vector<double> y_;
  std::vector<double> trial_;        ///< state that replaces y_ if it can be computed
  std::vector<Ramp> resting_ramps_;  ///< what each channel keeps in a step that does not move it
  StepPlan plan_;
  Rehearsal rehearsal_;  ///< of the present step
  double xi_ = 0.0;      ///< present step coordinate
  long event_count_ = 0;
};

}  // namespace

std::string_view to_string(RunStatus status) noexcept {
  switch (status) {
    case RunStatus::complete:
      return "complete";
    case RunStatus::stopped:
      return "stopped";
    case RunStatus::failed:
      return "failed";
  }
  return "";
}

DriveResult drive(Scene& scene, std::string_view integrator, const Tolerances& tolerances, const Output& output,
                  HistorySink& sink, ForwardSensitivities* sensitivities) {
  return Drive(scene, integrator, tolerances, output, sink, sensitivities).run();
}

}  // namespace monograin
