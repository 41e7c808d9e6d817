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

/// About how many output points a step has.
[[nodiscard]] std::size_t rows_of_step(const Scene& scene, const Output& output) {
  if (output.times.empty()) return static_cast<std::size_t>(output.points);
  return output.times.size() / std::max<std::size_t>(scene.step_count(), 1);
}

class Drive {
 public:
  Drive(Scene& scene, std::string_view integrator, const Tolerances& tolerances, const Output& output,
        HistorySink& sink, ForwardSensitivities* sensitivities)
      : scene_(scene),
        system_(*scene.system),
        guard_set_(system_),
        integrator_(
            make_integrator(integrator, system_, guard_set_, tolerances, rows_of_step(scene, output), sensitivities)),
        sensitivities_(sensitivities),
        work_(*integrator_, guard_set_),
        rows_(output, clock_, *integrator_, sink, sensitivities, system_.unknowns().size()),
        demands_(scene, guard_set_),
        y_(system_.unknowns().size()),
        trial_(y_.size()) {
    if (integrator != integrators::k_direct) rtol_ = tolerances.rtol;
    for (const Channel& channel : scene.channels) held_.push_back(channel.at_rest);
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
    follow([](ForwardSensitivities& s) { s.start(); });
    std::vector<Event> log;
    bool is_met = false;
    for (std::size_t step = 0; step < scene_.step_count(); ++step) {
      // A condition ends all that is left of a table or a sine.
      if (is_met && !leg(step).is_first()) continue;
      begin_step(step, log);
      // The rows before this corner are recorded already; the row after it belongs to the step that begins.
      const bool is_instant = plan_.leg.is_corner || !log.empty();
      if (!plan_.leg.is_corner) rows_.pass_joint(is_instant);
      if (step == 0)
        rows_.write_first(y_, log);
      else if (is_instant)
        rows_.close_instant(0.0, y_, log);
      is_met = integrate_step(log);
      end_step(is_met, log);
    }
    rows_.close_instant(xi_, y_, log);
  }

  /// Evaluations of the equations of the run and of the neighbours that give its derivatives.
  [[nodiscard]] long evaluations() const {
    const long of_neighbours = sensitivities_ != nullptr ? sensitivities_->evaluations() : 0;
    return integrator_->statistics().rhs_evaluations + of_neighbours;
  }

  [[nodiscard]] const Leg& leg(std::size_t step) const { return scene_.longest_program()[step].leg; }

  /// Records the end of a leg, and of the step if it is its last one.
  /// @param log  takes the events there
  void end_step(bool is_met, std::vector<Event>& log) {
    const bool is_over = is_met || plan_.leg.is_last();
    if (!is_met && is_over) demands_.note_conditions(plan_, clock_, xi_, y_);
    demands_.note_forces(plan_, clock_, xi_);
    rows_.end_step(xi_);
    if (is_over || leg(clock_.step + 1).is_corner)
      rows_.open_instant(xi_, y_);
    else
      rows_.reach_joint(xi_, y_);
    log.clear();
    if (is_met) log.push_back({"until-met"});
    if (is_over) log.push_back({"step-end"});
    hold_what_is_reached(is_over);
  }

  void hold_what_is_reached(bool is_over) {
    for (std::size_t c = 0; c < held_.size(); ++c) {
      held_[c] = ramp_after(plan_, system_, static_cast<int>(c), xi_, is_over);
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
  void follow(Action&& action) {
    if (sensitivities_ != nullptr && sensitivities_->is_active()) action(*sensitivities_);
  }

  void begin_step(std::size_t step, std::vector<Event>& log) {
    plan_ = plan_step(scene_, step, held_, guard_set_, xi_, y_);
    clock_ = clock_.next(xi_, step, plan_.leg, plan_.duration);
    xi_ = 0.0;
    const std::size_t logged = log.size();
    system_.begin_step(plan_.ramps, y_, log);
    follow([&](ForwardSensitivities& s) { s.begin_step(clock_.step, plan_, std::span(log).subspan(logged)); });
  }

  /// Integrates the step that has begun; leaves xi_ and y_ where it ends. Returns whether a condition ended it.
  /// @param log  events at its beginning; one of them may be the event that ends the step
  bool integrate_step(const std::vector<Event>& log) {
    xi_ = 0.0;
    guard_set_.begin_step(plan_.conditions, 0.0, y_);
    demands_.note_begin(plan_, clock_);
    follow([this](ForwardSensitivities& s) { s.expect_held(guard_set_.held_at_begin().has_value()); });
    rows_.begin_step();
    if (const auto held = guard_set_.held_at_begin()) {
      demands_.note_held_at_begin(plan_.conditions[*held], clock_);
      return true;
    }
    if (has_ending_event(log)) return true;
    if (is_detached()) return false;
    place_rows();
    return integrate();
  }

  [[nodiscard]] bool may_end_early() const noexcept {
    return !plan_.conditions.empty() || !plan_.ending_events.empty() || !plan_.detaching.empty();
  }

  /// Output points divide the step up to its end. If that may come early, the step runs once without recording.
  void place_rows() {
    if (plan_.leg.is_first()) {
      rehearsal_ = {};
      if (may_end_early() && rows_.divide_step()) rehearsal_ = rehearse();
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
    const std::vector<Ramp> held = held_;
    rows_.pause();
    if (sensitivities_ != nullptr) sensitivities_->set_active(false);
    Rehearsal result{.stops = true};
    try {
      integrate_legs();
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
    held_ = held;
    y_ = state;
    event_count_ = event_count;
    guard_set_.begin_step(plan_.conditions, 0.0, y_);
    return result;
  }

  /// Integrates the leg that has begun, and those that follow in its step, without recording.
  void integrate_legs() {
    bool is_met = integrate();
    while (!is_met && !plan_.leg.is_last()) {
      hold_what_is_reached(false);
      std::vector<Event> log;
      begin_step(clock_.step + 1, log);
      guard_set_.begin_step(plan_.conditions, 0.0, y_);
      is_met = guard_set_.held_at_begin() || has_ending_event(log) || integrate();
    }
  }

  /// Integrates from the present state to where the step ends. Returns whether a condition ended it.
  bool integrate() {
    demands_.begin_step(xi_);
    work_.begin();
    while (clock_.duration > 0.0 && 1.0 - xi_ > k_same_instant) {
      const double segment_start = xi_;
      change_state([this](std::span<double> y) { xi_ = system_.leave_singularity(xi_, y); });
      follow([this](ForwardSensitivities& s) { s.leave_singularity(xi_); });
      if (xi_ == 1.0) break;
      const auto last = integrate_segment();
      if (!last) break;
      ++event_count_;
      work_.count_event(xi_ - segment_start, xi_);
      if (handle_event(*last)) return true;
      if (is_detached()) return false;
    }
    const bool is_solved = solve_remainder();
    xi_ = 1.0;
    follow([&](ForwardSensitivities& s) { s.end_step(y_, is_solved); });
    guard_set_.note_met({}, xi_, y_);
    return guard_set_.is_met(xi_, y_);
  }

  /// Integrates to the first guard that fires, or to the end of the step. If a branch of solutions ends there, a run
  /// with sensitivities integrates the segment again: the first pass finds how that end moves with the numbers.
  /// @return where the integrator's last step began; nothing if no guard has fired
  std::optional<double> integrate_segment() {
    const bool may_need_aim =
        sensitivities_ != nullptr && sensitivities_->is_active() && sensitivities_->may_end_branch();
    if (!may_need_aim) return go_to_event();
    const double xi = xi_;
    const std::vector<double> state = y_;
    rows_.hold();
    std::optional<double> last;
    try {
      last = go_to_event();
    } catch (...) {
      rows_.release_held();
      throw;
    }
    if (last && sensitivities_->aim(integrator_->fired(), xi_, y_)) {
      rows_.drop_held();
      xi_ = xi;
      y_ = state;
      return go_to_event();
    }
    rows_.release_held();
    return last;
  }

  std::optional<double> go_to_event() {
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
      follow([&](ForwardSensitivities&) { integrator_->dense_sensitivities(xi_); });
      // An event this close to the end of the step is at the end: what is left of a ramp is round-off.
      if (advance.hit_guard && 1.0 - xi_ <= k_same_instant) xi_ = 1.0;
      if (advance.hit_guard) return last;
      if (xi_ >= 1.0) return std::nullopt;
    }
  }

  /// Solves for the state at the end of the step. An event may leave a remainder that is round-off, but an overlap
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
    follow([&](ForwardSensitivities& s) { s.locate(fired, xi_, y_); });
    std::vector<std::size_t> of_system;
    for (const std::size_t guard : fired) {
      if (guard < guard_set_.system_guards()) of_system.push_back(guard);
    }
    bool is_met = of_system.size() < fired.size();
    if (are_marks(guard_set_, of_system)) {
      std::vector<Event> log;
      static_cast<void>(system_.fire(of_system, xi_, y_, log));
      follow([&](ForwardSensitivities& s) { s.pass_mark(of_system, xi_, log); });
      if (!log.empty()) {
        rows_.open_instant(xi_, y_);
        rows_.close_instant(xi_, y_, log);
      }
      is_met = is_met || has_ending_event(log);
    } else if (!of_system.empty()) {
      const bool is_seen =
          std::ranges::any_of(of_system, [this](std::size_t guard) { return !system_.guards()[guard].is_silent; });
      if (is_seen) rows_.open_instant(xi_, y_);
      std::vector<Event> log;
      const auto end = system_.fire(of_system, xi_, y_, log);
      if (!end) follow([&](ForwardSensitivities& s) { s.fire(of_system, log); });
      std::exception_ptr failure;
      try {
        if (!end) change_state([this](std::span<double> y) { system_.solve(xi_, y); });
        if (!end) follow([](ForwardSensitivities& s) { s.solve(); });
      } catch (const std::domain_error&) {
        failure = std::current_exception();
      }
      // The row after the events is written even if no state was found: the transitions have been made.
      if (is_seen) rows_.close_instant(xi_, y_, log);
      if (end) throw Stop{end->point, clock_.where(xi_) + text_of(end->point)};
      if (failure) std::rethrow_exception(failure);
      is_met = is_met || guard_set_.is_met(xi_, y_) || has_ending_event(log);
    }
    if (is_met) guard_set_.note_met(fired, xi_, y_);
    guard_set_.renew();
    follow([&](ForwardSensitivities& s) { s.end_event(fired, xi_, is_met); });
    demands_.note_open(xi_);
    return is_met;
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
  std::vector<double> trial_;  ///< state that replaces y_ if it can be computed
  std::vector<Ramp> held_;     ///< what each channel keeps when a step says nothing
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
