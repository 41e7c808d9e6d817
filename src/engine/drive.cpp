#include "engine/drive.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>

#include "engine/forward_sensitivities.hpp"
#include "engine/guard_set.hpp"
#include "engine/program_notes.hpp"
#include "engine/step_plan.hpp"
#include "scenario/integrators.hpp"

namespace monograin {
namespace {

// Step coordinates closer than this are equal to within round-off: a remainder of a step that short is not integrated,
// and an output point that near to an event falls on it. Also the tolerance of exact guards.
constexpr double k_round_off = 1e-13;
// Events in a row without progress that a step may have; more of them show that two modes are chattering.
constexpr int k_most_idle_events = 50;
// Internal steps in a row that may leave the step coordinate where it is; after more of them the run fails.
constexpr int k_most_idle_steps = 1000;
// Evaluations of the equations allowed per allowed internal step. Some codes take many evaluations for one step, so
// that a bound on steps alone would not bound the work.
constexpr long k_most_evaluations = 10;
// Events that one step of the program may have; more of them are taken to go on without end.
constexpr int k_most_events = 1000;
// Finer tolerances may be below the round-off of a scene's own equations.
constexpr double k_surest_rtol = 1e-11;
// Relative difference below which an output time is the program's end.
constexpr double k_same_instant = 1e-12;

// Step coordinate of the output point at the end of a step that may end early, wherever that will be.
constexpr double k_at_end = std::numeric_limits<double>::infinity();

/// An output point of the present step.
struct OutputPoint {
  double xi = 0.0;
  double time = 0.0;
};

/// An output row that is not recorded yet.
struct HeldRow {
  double time = 0.0;
  double xi = 0.0;
  std::vector<double> state;
  std::vector<double> derivatives;
};

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
        sink_(sink),
        sensitivities_(sensitivities),
        output_(output),
        y_(system_.unknowns().size()),
        output_state_(y_.size()),
        open_since_(scene.channels.size()) {
    if (integrator != integrators::k_direct) rtol_ = tolerances.rtol;
    for (const Channel& channel : scene.channels) held_.push_back(channel.at_rest);
    outputs_.reserve(output.times.empty() ? static_cast<std::size_t>(output.points) : output.times.size());
  }

  DriveResult run() {
    DriveResult result;
    try {
      run_program();
    } catch (const Stop& stop) {
      stop_at(stop.point, stop.message, result);
    } catch (const CannotBegin& error) {
      stop_at(error.point(), where(0.0) + error.what(), result);
      close_instant(step_start_, 0.0, {error.end().event});
    } catch (const std::domain_error& error) {
      stop_at(as_domain_error(error).point(), where(xi_) + error.what(), result);
      record_limit();
    } catch (const SolverError& error) {
      result.status = RunStatus::failed;
      result.failure = error.failure();
      result.message = where(error.xi()) + error.what();
      result.difficulty = difficulty_here();
      if (result.difficulty) result.message += fmt::format("; {}", advice(*result.difficulty));
      if (rtol_ && *rtol_ < k_surest_rtol) {
        result.message += fmt::format("; rtol = {:.3g} asks for errors of the size of rounding, expected {:g} or more",
                                      *rtol_, k_surest_rtol);
      }
    }
    result.statistics = integrator_->statistics();
    if (sensitivities_ != nullptr) result.statistics.rhs_evaluations += sensitivities_->evaluations();
    result.statistics.events = event_count_;
    for (const Diagnostic& warning : system_.warnings()) {
      result.warnings.push_back(fmt::format("{} ({} = {:.6g})", warning.message, warning.quantity, warning.value));
    }
    for (std::string& note : notes_.texts()) result.warnings.push_back(std::move(note));
    if (result.status == RunStatus::complete) note_unreached_times(result.warnings);
    return result;
  }

 private:
  void run_program() {
    system_.start(y_);
    follow([](ForwardSensitivities& s) { s.start(); });
    std::vector<Event> log;
    for (step_ = 0; step_ < scene_.step_count(); ++step_) {
      plan_ = plan_step(scene_, step_, held_, guard_set_, xi_, y_);
      xi_ = 0.0;
      if (step_ > 0) {
        // The rows before this corner are recorded already; the row after it belongs to the step that begins.
        begin_step(log);
        close_instant(step_start_, 0.0, log);
      } else {
        begin_history(log);
      }
      const bool is_met = integrate_step(log);
      if (!is_met) note_unmet_conditions();
      note_forces_not_borne();
      if (next_output_ + 1 == outputs_.size() && outputs_.back().xi == k_at_end) outputs_.back().xi = xi_;
      open_instant(xi_);
      log.clear();
      if (is_met) log.push_back({"until-met"});
      log.push_back({"step-end"});
      step_start_ = time(xi_);
      for (std::size_t c = 0; c < held_.size(); ++c) held_[c] = ramp_after(plan_, system_, static_cast<int>(c), xi_);
    }
    --step_;
    close_instant(step_start_, xi_, log);
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

  [[nodiscard]] double time(double xi) const { return step_start_ + xi * plan_.duration; }
  [[nodiscard]] int step_label() const { return static_cast<int>(step_ + 1); }
  [[nodiscard]] std::string where(double xi) const {
    return fmt::format("step {}, t = {:.9g} s: ", step_ + 1, time(xi));
  }

  // --- the program
  // ----------------------------------------------------------------------------------------------------------

  [[nodiscard]] bool has_ending_event(const std::vector<Event>& log) const {
    return std::ranges::any_of(log, [&](const Event& event) {
      return std::ranges::find(plan_.ending_events, event.name) != plan_.ending_events.end();
    });
  }

  /// Notes the conditions of a step that was ended by none of them.
  void note_unmet_conditions() {
    for (std::size_t i = 0; i < plan_.conditions.size(); ++i) {
      const Condition& condition = plan_.conditions[i];
      const double begin = guard_set_.value_at_begin(i);
      const double end = system_.quantity(condition.quantity, condition.channel, xi_, y_);
      const bool has_gone_away = std::abs(end - condition.target) > std::abs(begin - condition.target);
      notes_.add(step_ + 1,
                 fmt::format("{} was never met{}", condition_text(scene_, condition),
                             has_gone_away ? ": it lay behind where the step began" : ""),
                 fmt::format(" ({} at its beginning, {} at its end)", with_unit(begin, condition.quantity),
                             with_unit(end, condition.quantity)));
    }
    for (const std::string& event : plan_.ending_events) {
      notes_.add(step_ + 1, fmt::format("until event = \"{}\" was never met: no such event happened", event));
    }
  }

  /// Records since when each channel's contact has been open in this step.
  void note_open_contacts() {
    for (std::size_t c = 0; c < open_since_.size(); ++c) {
      const bool is_open = system_.is_open(static_cast<int>(c));
      if (!is_open) open_since_[c].reset();
      if (is_open && !open_since_[c]) open_since_[c] = xi_;
    }
  }

  /// Notes prescribed forces that no contact bears, because it opened before the step ended.
  void note_forces_not_borne() {
    for (std::size_t c = 0; c < open_since_.size(); ++c) {
      const Ramp& ramp = plan_.ramps[c];
      const double force = std::lerp(ramp.start, ramp.end, xi_);
      const bool was_open = open_since_[c] && xi_ - *open_since_[c] > k_round_off;
      if (ramp.control != Control::force || force == 0.0 || !was_open) continue;
      notes_.add(step_ + 1,
                 fmt::format("no contact bears the force that is prescribed to '{}'", scene_.channels[c].name),
                 fmt::format(" ({:.6g} N at its end; open since t = {:.9g} s)", force, time(*open_since_[c])));
    }
  }

  /// Warns of output times beyond the end of the last step.
  void note_unreached_times(std::vector<std::string>& warnings) const {
    const double end = step_start_ * (1.0 + k_same_instant);
    const auto count = std::ranges::count_if(output_.times, [end](double instant) { return instant > end; });
    if (count == 0) return;
    warnings.push_back(
        fmt::format("{} of {} output times lie{} beyond the end of the program, t = {:.9g} s: no rows there", count,
                    output_.times.size(), count == 1 ? "s" : "", step_start_));
  }

  [[nodiscard]] bool is_detached() const {
    return !plan_.detaching.empty() && std::ranges::all_of(plan_.detaching, [&](int c) { return system_.is_open(c); });
  }

  /// Applies an action to the sensitivities if there are any. They take no part in the rehearsal of a step.
  template <class Action>
  void follow(Action&& action) {
    if (sensitivities_ != nullptr && !is_rehearsing_) action(*sensitivities_);
  }

  // --- one step
  // -------------------------------------------------------------------------------------------------------------

  void begin_step(std::vector<Event>& log) {
    const std::size_t logged = log.size();
    system_.begin_step(plan_.ramps, y_, log);
    follow([&](ForwardSensitivities& s) { s.begin_step(step_, plan_, std::span(log).subspan(logged)); });
  }

  /// Integrates the step that has begun; leaves xi_ and y_ where it ends. Returns whether a condition ended it.
  /// @param log  events at its beginning; one of them may be the event that ends the step
  bool integrate_step(const std::vector<Event>& log) {
    xi_ = 0.0;
    guard_set_.begin_step(plan_.conditions, 0.0, y_);
    follow([this](ForwardSensitivities& s) { s.expect_held(guard_set_.held_at_begin().has_value()); });
    outputs_.clear();
    if (const auto held = guard_set_.held_at_begin()) {
      notes_.add(step_ + 1,
                 condition_text(scene_, plan_.conditions[*held]) + " holds where the step begins, and ends it there");
      return true;
    }
    if (has_ending_event(log)) return true;
    if (is_detached()) return false;
    plan_outputs(may_end_early() && has_interior_points() ? rehearse() : 1.0);
    return integrate();
  }

  [[nodiscard]] bool may_end_early() const noexcept {
    return !plan_.conditions.empty() || !plan_.ending_events.empty() || !plan_.detaching.empty();
  }

  /// Runs the step that has begun without recording it, then restores its beginning. Output points divide the step up
  /// to its end, which must be known before they are placed.
  /// @return step coordinate where the step ends, by a condition or because the run cannot go on
  double rehearse() {
    const std::function<void()> restore = system_.checkpoint();
    const std::vector<double> state = y_;
    const long event_count = event_count_;
    is_rehearsing_ = stops_in_step_ = true;
    if (sensitivities_ != nullptr) sensitivities_->set_active(false);
    try {
      static_cast<void>(integrate());
      stops_in_step_ = false;
    } catch (const Stop&) {  // the recorded run will end here again
    } catch (const std::domain_error&) {
    } catch (const SolverError&) {
    }
    is_rehearsing_ = false;
    if (sensitivities_ != nullptr) sensitivities_->set_active(true);
    restore();
    // An end that is round-off leaves no room for rows.
    const double end = xi_ > output_.points * k_round_off ? xi_ : 0.0;
    xi_ = 0.0;
    y_ = state;
    event_count_ = event_count;
    idle_guards_.clear();
    guard_set_.begin_step(plan_.conditions, 0.0, y_);
    return end;
  }

  /// Work done in a step of the program. Idle steps and events are those since the step coordinate last moved.
  struct Work {
    long steps = 0;             ///< internal steps
    long first_evaluation = 0;  ///< evaluations of the equations before the step
    int idle_steps = 0;
    int events = 0;
    int idle_events = 0;
  };

  /// Integrates from the present state to where the step ends. Returns whether a condition ended it.
  bool integrate() {
    std::ranges::fill(open_since_, std::nullopt);
    note_open_contacts();
    Work work{.first_evaluation = integrator_->rhs_evaluations()};
    while (plan_.duration > 0.0 && 1.0 - xi_ > k_round_off) {
      const double segment_start = xi_;
      change_state([this](std::span<double> y) { xi_ = system_.leave_singularity(xi_, y); });
      follow([this](ForwardSensitivities& s) { s.leave_singularity(xi_); });
      if (xi_ == 1.0) break;
      const auto last = integrate_segment(work);
      if (!last) break;
      count_event(xi_ - segment_start, work);
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
  std::optional<double> integrate_segment(Work& work) {
    if (sensitivities_ == nullptr || is_rehearsing_ || !sensitivities_->may_end_branch()) return go_to_event(work);
    const double xi = xi_;
    const std::vector<double> state = y_;
    const std::size_t next_output = next_output_;
    holds_rows_ = true;
    auto last = go_to_event(work);
    holds_rows_ = false;
    if (last && sensitivities_->aim(integrator_->fired(), xi_, y_)) {
      xi_ = xi;
      y_ = state;
      next_output_ = next_output;
      held_rows_.clear();
      return go_to_event(work);
    }
    for (const HeldRow& row : std::exchange(held_rows_, {})) {
      sink_.observe(row.time, step_label(), row.xi, row.state);
      sink_.differentiate(row.derivatives);
      sink_.append(RowSide::output);
    }
    return last;
  }

  std::optional<double> go_to_event(Work& work) {
    integrator_->begin(xi_, y_);
    while (true) {
      const double last = xi_;
      const long of_equations = integrator_->rhs_evaluations() - work.first_evaluation;
      const long most = integrator_->most_steps();
      if (work.steps == most || of_equations > k_most_evaluations * most) throw too_much_work(work.steps, of_equations);
      ++work.steps;
      const Integrator::Advance advance = integrator_->advance();
      work.idle_steps = advance.xi > last ? 0 : work.idle_steps + 1;
      if (work.idle_steps > k_most_idle_steps) throw stalled(work.idle_steps);
      // Position and state change together: if an output row meets a limit, the run ends with both.
      change_state([&](std::span<double> y) { integrator_->dense_output(advance.xi, y); });
      xi_ = advance.xi;
      emit_outputs_before(last, xi_);
      follow([&](ForwardSensitivities&) { integrator_->dense_sensitivities(xi_); });
      if (advance.hit_guard) return last;
      if (xi_ >= 1.0) return std::nullopt;
    }
  }

  /// Counts an event; throws SolverError if events follow each other without end.
  /// @param length  of the segment that the event ends
  void count_event(double length, Work& work) {
    ++event_count_;
    if (length >= k_round_off) {
      work.idle_events = 0;
      idle_guards_.clear();
    } else {
      for (const std::size_t guard : integrator_->fired()) idle_guards_.insert(guard_set_.name(guard));
    }
    if (++work.idle_events > k_most_idle_events) throw chattering();
    if (++work.events > k_most_events) throw endless();
  }

  /// Solves for the state at the end of the step. An event may leave a remainder that is round-off, but a contact may
  /// be equally shallow. Returns whether there was a remainder.
  bool solve_remainder() {
    if (!(plan_.duration > 0.0 && xi_ < 1.0)) return false;
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
    output_state_ = y_;
    change(output_state_);
    std::swap(y_, output_state_);
  }

  /// Applies the transitions of the guards that fire at xi_. Returns whether a condition of the program ends the step.
  /// @param last  step coordinate where the integrator's last step began
  bool handle_event(double last) {
    const std::vector<std::size_t> fired = collect_fired(last);
    follow([&](ForwardSensitivities& s) { s.locate(fired, xi_, y_); });
    std::vector<std::size_t> of_system;
    for (const std::size_t guard : fired) {
      if (guard < guard_set_.system_guards()) of_system.push_back(guard);
    }
    bool is_met = of_system.size() < fired.size();
    if (are_marks(of_system)) {
      std::vector<Event> log;
      static_cast<void>(system_.fire(of_system, xi_, y_, log));
      follow([&](ForwardSensitivities& s) { s.pass_mark(of_system, xi_, log); });
      if (!log.empty()) {
        open_instant(xi_);
        close_instant(time(xi_), xi_, log);
      }
      is_met = is_met || has_ending_event(log);
    } else if (!of_system.empty()) {
      const bool is_seen =
          std::ranges::any_of(of_system, [this](std::size_t guard) { return !system_.guards()[guard].is_silent; });
      if (is_seen) open_instant(xi_);
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
      if (is_seen) close_instant(time(xi_), xi_, log);
      if (end) throw Stop{end->point, where(xi_) + text_of(end->point)};
      if (failure) std::rethrow_exception(failure);
      is_met = is_met || guard_set_.is_met(xi_, y_) || has_ending_event(log);
    }
    if (is_met) guard_set_.note_met(fired, xi_, y_);
    guard_set_.renew();
    follow([&](ForwardSensitivities& s) { s.end_event(fired, xi_, is_met); });
    note_open_contacts();
    return is_met;
  }

  /// True if there are guards, and all of them mark an instant and change nothing.
  [[nodiscard]] bool are_marks(std::span<const std::size_t> guards) const {
    return !guards.empty() && std::ranges::all_of(guards, [this](std::size_t guard) {
      return guard < guard_set_.system_guards() && system_.guards()[guard].is_mark;
    });
  }

  /// Guards that fire at xi_: those the integrator found, and those that reach zero within its accuracy at the same
  /// instant.
  [[nodiscard]] std::vector<std::size_t> collect_fired(double last) {
    std::vector<std::size_t> fired(integrator_->fired().begin(), integrator_->fired().end());
    if (are_marks(fired)) return fired;
    std::vector<double> now(guard_set_.size());
    guard_set_.values(xi_, y_, now);
    const auto tolerance_of = [&](std::size_t g) {
      const bool is_exact = g < guard_set_.system_guards() && system_.guards()[g].is_exact;
      return is_exact ? k_round_off : integrator_->guard_tolerance();
    };
    const auto may_be_met = [&](std::size_t g) {
      const int direction = guard_set_.directions()[g];
      return (direction == 0 || direction * now[g] >= -tolerance_of(g)) && std::ranges::find(fired, g) == fired.end();
    };
    std::vector<std::size_t> others;
    for (std::size_t g = 0; g < guard_set_.size(); ++g) {
      if (may_be_met(g)) others.push_back(g);
    }
    if (!others.empty()) {
      std::vector<double> before(guard_set_.size());
      const double middle = std::midpoint(last, xi_);
      integrator_->dense_output(middle, output_state_);
      guard_set_.values(middle, output_state_, before);
      for (const std::size_t g : others) {
        const double side = before[g] < 0.0 ? 1.0 : -1.0;
        const bool counts = guard_set_.directions()[g] == 0 || guard_set_.directions()[g] == static_cast<int>(side);
        // At its mean rate the guard reaches zero within as long again; a branch may be shorter than the tolerance.
        const double way = side * (now[g] - before[g]);
        const bool has_arrived = way > 0.0 && -side * now[g] <= std::min(tolerance_of(g), std::max(k_round_off, way));
        if (!counts || before[g] == 0.0 || !has_arrived) continue;
        if (g < guard_set_.system_guards() || -side * now[g] <= 0.0 || !goes_away(g, now[g], middle))
          fired.push_back(g);
      }
    }
    std::ranges::sort(fired);
    return fired;
  }

  /// True if a condition of the program was nearer to being met before xi_ than at xi_: a quantity may reverse where
  /// its branch ends.
  /// @param now   value of the guard at xi_
  /// @param from  beginning of the searched interval; the evaluations approach xi_ by a constant factor
  [[nodiscard]] bool goes_away(std::size_t guard, double now, double from) {
    constexpr double k_approach = 0.25;
    constexpr int k_looks = 12;
    std::vector<double> before(guard_set_.size());
    double distance = xi_ - from;
    for (int look = 0; look < k_looks; ++look) {
      distance *= k_approach;
      integrator_->dense_output(xi_ - distance, output_state_);
      guard_set_.values(xi_ - distance, output_state_, before);
      if (std::abs(before[guard]) < std::abs(now) - k_round_off) return true;
    }
    return false;
  }

  [[nodiscard]] SolverError too_much_work(long steps, long of_equations) const {
    return {Failure::too_much_work, xi_, integrator_->statistics().last_step,
            fmt::format(
                "{} internal steps and {} evaluations of the equations have not brought this step of the program to "
                "its end; where the equations are stiff, expected cvode-bdf or ida",
                steps, of_equations)};
  }

  [[nodiscard]] SolverError stalled(int steps) const {
    return {Failure::no_progress, xi_, integrator_->statistics().last_step,
            fmt::format("{} internal steps in a row are shorter than the rounding of the step coordinate", steps)};
  }

  [[nodiscard]] SolverError chattering() const {
    return {Failure::chattering, xi_, 0.0, fmt::format("{}", fmt::join(idle_guards_, ", "))};
  }

  [[nodiscard]] SolverError endless() const {
    return {Failure::endless_events, xi_, 0.0, fmt::format("{} events in one step of the program", k_most_events)};
  }

  // --- recording
  // ------------------------------------------------------------------------------------------------------------

  [[nodiscard]] bool has_interior_points() const noexcept { return output_.times.empty() && output_.points > 1; }

  /// Plans the output points of the step: the listed times, or points at equal intervals.
  /// @param end  step coordinate where the step ends
  void plan_outputs(double end) {
    next_output_ = 0;
    const int first = end > 0.0 ? 1 : output_.points;
    for (int j = first; output_.times.empty() && j <= output_.points; ++j) {
      const double xi = end * (static_cast<double>(j) / output_.points);
      outputs_.push_back({xi, time(xi)});
    }
    if (may_end_early() && !stops_in_step_ && !outputs_.empty()) outputs_.back().xi = k_at_end;
    for (const double instant : output_.times) {
      if (plan_.duration == 0.0) break;
      const double xi = (instant - step_start_) / plan_.duration;
      if (xi > k_round_off && xi < 1.0 + k_round_off) outputs_.push_back({xi > 1.0 - k_round_off ? 1.0 : xi, instant});
    }
  }

  [[nodiscard]] bool records_internal_steps() const { return output_.times.empty() && output_.points == 0; }

  /// Emits the output points before xi. A point that lies before the integrator's last step by round-off is evaluated
  /// at the beginning of that step.
  /// @param last  step coordinate where the integrator's last step began
  void emit_outputs_before(double last, double xi) {
    if (records_internal_steps() && xi < 1.0 && integrator_->fired().empty()) {
      emit_output(time(xi), xi);
    }
    for (; next_output_ < outputs_.size() && outputs_[next_output_].xi < xi - k_round_off; ++next_output_) {
      const double at = std::max(outputs_[next_output_].xi, last);
      emit_output(outputs_[next_output_].time, at);
    }
  }

  /// Emits an output row at xi within the integrator's last step.
  void emit_output(double instant, double xi) {
    integrator_->dense_output(xi, output_state_);
    std::span<const double> derivatives;
    follow([&](ForwardSensitivities& s) {
      integrator_->dense_sensitivities(xi);
      derivatives = s.row_at(xi, output_state_, step_start_, plan_.duration);
    });
    if (holds_rows_) {
      held_rows_.push_back({instant, xi, output_state_, {derivatives.begin(), derivatives.end()}});
      return;
    }
    sink_.observe(instant, step_label(), xi, output_state_);
    sink_.differentiate(derivatives);
    sink_.append(RowSide::output);
  }

  /// Observes the present state.
  void observe_here(double instant, double xi) {
    sink_.observe(instant, step_label(), xi, y_);
    follow([&](ForwardSensitivities& s) { sink_.differentiate(s.row_here()); });
  }

  /// Records the first row. Nothing jumps at the start: the rows before and after an event there are equal.
  void begin_history(std::vector<Event>& log) {
    begin_step(log);
    observe_here(0.0, 0.0);
    if (!log.empty()) sink_.append(RowSide::before);
    sink_.append(RowSide::output);
    if (!log.empty()) close_instant(0.0, 0.0, log);
  }

  /// Records the row just before an event or corner, and the row of an output point that falls on it.
  void open_instant(double xi) {
    if (is_rehearsing_) return;
    observe_here(time(xi), xi);
    sink_.append(RowSide::before);
    if (next_output_ < outputs_.size() && outputs_[next_output_].xi <= xi + k_round_off) {
      ++next_output_;
      sink_.append(RowSide::output);
    }
  }

  /// Records the state where the equations end, if it can still be observed.
  void record_limit() {
    try {
      open_instant(xi_);
      close_instant(time(xi_), xi_, {{"limit"}});
    } catch (const std::domain_error&) {
      return;  // the history ends with the row before the limit
    }
  }

  /// Records the row just after an event or corner, and the events between the rows.
  void close_instant(double instant, double xi, const std::vector<Event>& log) {
    if (is_rehearsing_) return;
    observe_here(instant, xi);
    sink_.append(RowSide::after);
    for (const Event& event : log) sink_.event(event);
  }

  Scene& scene_;
  HybridSystem& system_;
  GuardSet guard_set_;
  std::unique_ptr<Integrator> integrator_;
  std::optional<double> rtol_;  ///< empty for the direct form, which has no tolerance
  HistorySink& sink_;
  ForwardSensitivities* sensitivities_;  ///< null if there are none
  const Output& output_;
  std::vector<double> y_;
  std::vector<double> output_state_;
  std::vector<std::optional<double>> open_since_;  ///< step coordinate, for each channel; empty while it is closed
  std::vector<Ramp> held_;                         ///< what each channel keeps when a step says nothing
  ProgramNotes notes_;

  std::size_t step_ = 0;
  StepPlan plan_;
  double step_start_ = 0.0;  ///< [s]
  double xi_ = 0.0;          ///< present step coordinate
  std::vector<OutputPoint> outputs_;
  std::size_t next_output_ = 0;
  std::vector<HeldRow> held_rows_;  ///< rows of a segment that may have to be integrated again
  bool holds_rows_ = false;
  bool is_rehearsing_ = false;  ///< nothing is recorded
  bool stops_in_step_ = false;  ///< the rehearsal has shown that the run stops in this step
  long event_count_ = 0;
  std::set<std::string> idle_guards_;  ///< guards that have fired since the last progress
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
