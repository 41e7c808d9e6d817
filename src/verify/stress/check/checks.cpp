#include "verify/stress/check/checks.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "catalogue.hpp"
#include "history/recorder.hpp"
#include "scenario/integrators.hpp"
#include "scene/scene.hpp"
#include "system/resolution.hpp"
#include "verify/probe/profiled_system.hpp"
#include "verify/stress/check/distance.hpp"
#include "verify/stress/check/events.hpp"
#include "verify/stress/check/turn.hpp"
#include "verify/stress/check/variants.hpp"

namespace monograin {
namespace {

// The response of a scene to changed data is measured by a few samples of all directions of change; the worst response
// is a few times larger.
constexpr double k_sample_multiple = 10.0;
constexpr std::uint64_t k_samples = 8;  // in pairs
// A run is stuck if it takes this many times as long as the scene's own run or its reference.
constexpr double k_patience = 4.0;
constexpr double k_slower = 1e6;
// Net force on a free centre, over the largest force of a contact, below which the contacts bear each other. The
// idle contacts of a loose particle are off balance by all that they bear.
constexpr double k_balanced = 0.1;
constexpr Magnification k_magnification{.length = 731.0585, .stress = 1.618034e-5};
// Number of turned copies of a scene that a limit has ended, and of further copies that measure their mutual distance.
constexpr std::uint64_t k_rotations = 4;

/// The larger of two numbers; nan counts as the largest.
double worse(double a, double b) { return a > b || std::isnan(a) ? a : b; }

std::string quoted(const Run& run) {
  return fmt::format("'{}'", run.record.status == RunStatus::complete ? "complete" : run.record.message);
}

double end_time(const Run& run) { return run.record.history.at(run.record.history.row_count() - 1, 0); }

/// True if two runs end at the same instant, to a tolerance, where plastic strain grows without bound: the strain
/// passes other limits there, and either run may stop at any of them.
bool run_away_together(const Run& a, const Run& b, double tolerance) {
  const auto runs_away = [](const Run& run) { return run.record.limit == Limit::loss_of_uniqueness; };
  if (!runs_away(a) && !runs_away(b)) return false;
  return std::abs(end_time(a) - end_time(b)) <= tolerance * std::max(end_time(a), end_time(b));
}

/// Duration [s] of the step in which a run has ended: as prescribed; if a rate is prescribed, the time for a ramp as
/// large as the largest recorded value of the controlled quantity.
double seconds_of_last_step(const Run& run) {
  const Table& table = run.record.history;
  const auto index = static_cast<std::size_t>(table.at(table.row_count() - 1, *table.find("step"))) - 1;
  double seconds = 0.0;
  for (const Channel& channel : make_scene(run.scenario).channels) {
    if (index >= channel.program.size()) continue;
    const Step& step = channel.program[index];
    if (step.duration) return *step.duration;
    if (!step.rate) continue;
    const bool is_length = step.kind == Step::Kind::displacement || step.kind == Step::Kind::detach;
    const double least = is_length ? run.scenario.radius : 0.0;
    const double largest = largest_of_kind(table, is_length ? "displacement" : "force");
    seconds = std::max(seconds, std::max({least, largest, std::abs(step.target)}) / *step.rate);
  }
  return seconds;
}

/// Time between the ends of two runs, over the step in which the first has ended.
double ends_apart(const Run& a, const Run& b) {
  const double apart = std::abs(end_time(a) - end_time(b));
  return apart <= k_stress_round_off * end_time(a) ? 0.0 : apart / seconds_of_last_step(a);
}

/// True if a limit ends a run at a corner of the program that another run passes. If the program leads just up to a
/// limit, round-off decides whether it is met.
bool stops_at_corner(const Run& run, const Run& other, double tolerance) {
  if (run.record.status == RunStatus::complete) return false;
  const Table& events = other.record.events;
  const auto name = *events.find("event");
  const double near = tolerance * seconds_of_last_step(run) + k_stress_round_off * end_time(run);
  for (std::size_t row = 0; row < events.row_count(); ++row) {
    if (events.word(row, name) == "step-end" && std::abs(events.at(row, 0) - end_time(run)) <= near) return true;
  }
  return false;
}

/// Earliest end [s] of the runs that a limit has ended; infinity if there is none.
double first_end(const std::vector<Run>& runs) {
  double first = k_infinity;
  for (const Run& run : runs) {
    if (run.record.status == RunStatus::complete) continue;
    first = std::min(first, end_time(run));
  }
  return first;
}

/// True if a free centre has different positions in two rows.
/// @param tolerance   over the largest component of its position
/// @param negligible  over R0
bool is_elsewhere(const Run& run, std::size_t row, std::size_t other, double tolerance, double negligible) {
  const Table& table = run.record.history;
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    if (!table.columns()[c].name.starts_with("centre_")) continue;
    const double way = std::abs(table.at(row, c) - table.at(other, c));
    if (way > tolerance * largest_magnitude(table, c) + negligible * run.scenario.radius) return true;
  }
  return false;
}

/// True if no contact bears a force at the end of a run, and a free centre is then not where it was at first: idle
/// contacts have moved it, and do not move it back.
bool is_left_elsewhere(const Run& run, double tolerance, double negligible) {
  const Table& table = run.record.history;
  const std::size_t last = table.row_count() - 1;
  const double least = tolerance * largest_of_kind(table, "force");
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    if (kind_of(table.columns()[c]) == "force" && std::abs(table.at(last, c)) > least) return false;
  }
  return is_elsewhere(run, 0, last, tolerance, negligible);
}

/// True if loaded contacts hold a centre in every direction in a row. Force-controlled walls do not hold it. Along
/// directions without support, idle contacts move the centre.
/// @param hold  what else holds it: directions in which nothing moves it
bool is_held(const Run& run, std::span<const ContactClass> classes, std::size_t row, double tolerance,
             Eigen::Matrix3d hold = Eigen::Matrix3d::Zero()) {
  const Table& table = run.record.history;
  const double least = tolerance * largest_of_kind(table, "force");
  for (const ContactClass& c : classes) {
    const auto force = table.find(c.name + ".force");
    if (c.takes_force || !force || !(std::abs(table.at(row, *force)) > least)) continue;
    for (const Eigen::Vector3d& normal : c.normals) hold += normal * normal.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(hold, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0] > k_same_direction;
}

/// True if contacts determine where the centre is in all rows but the first: those of walls whose displacement is
/// prescribed hold it, and all others bear. A wall without load rests, and an idle one moves a loose particle: where
/// they are depends on their path. Forces on a loose particle do not balance.
bool is_always_held(const Run& run, double tolerance) {
  const Table& table = run.record.history;
  const std::vector<ContactClass> classes = make_scene(run.scenario).classes;
  const double least = tolerance * largest_of_kind(table, "force");
  std::vector<Eigen::Vector3d> normals;
  for (const ContactClass& c : classes) normals.insert(normals.end(), c.normals.begin(), c.normals.end());
  const Eigen::Matrix3d unmoved = Eigen::Matrix3d::Identity() - onto_normals(normals);
  for (std::size_t row = 1; row < table.row_count(); ++row) {
    if (!is_held(run, classes, row, tolerance, unmoved)) return false;
    Eigen::Vector3d net = Eigen::Vector3d::Zero();
    double largest = 0.0;
    for (const ContactClass& c : classes) {
      const double force = table.at(row, *table.find(c.name + ".force"));
      if (c.takes_force && !(std::abs(force) > least)) return false;
      for (const Eigen::Vector3d& normal : c.normals) net += force * normal;
      largest = std::max(largest, std::abs(force));
    }
    if (!(net.norm() <= k_balanced * largest)) return false;
  }
  return true;
}

/// True if an integrator has given up for a stated reason: the run then does not show how the scene goes on.
bool has_given_up(const Run& run) { return run.record.status == RunStatus::failed && !stated_end(run).empty(); }

/// True if no overlap ever exceeds the round-off of lengths of the order of R0.
bool is_below_resolution(const Run& run) {
  return run.scenario.radius > 0.0 && deepest_overlap(run.record.history) < k_resolution * run.scenario.radius;
}

class SceneCheck {
 public:
  SceneCheck(const CheckedScenario& scenario, const StressEffort& effort)
      : scenario_(scenario), effort_(effort), end_(thread_seconds() + effort.seconds) {}

  StressVerdict verdict() {
    try {
      check_all();
    } catch (const OutOfTime&) {
      // If the scene itself or its reference has taken much of the time, its copies are expected to take it as well.
      verdict_.is_cut_short = seconds_of_run() < k_patience * own_seconds_;
      if (!verdict_.is_cut_short) {
        report(k_time_rule,
               fmt::format("{} runs have not come to an end within {:g} s", verdict_.runs, effort_.seconds));
      }
    }
    return std::move(verdict_);
  }

 private:
  void check_all() {
    const std::optional<Run> run = try_run(scenario_, "the scene");
    own_seconds_ = seconds_of_run();
    if (!run) return;
    own_ = &*run;
    verdict_.end = stated_end(*run);
    verdict_.violations = check_run(*run);
    // Every comparison would find these violations again.
    if (!verdict_.violations.empty()) return;
    // The scheme without error control has no tolerance, but its copies take the same steps.
    if (run->integrator.used == integrators::k_forward_euler) {
      reference_ = run;
      compares_curves_ = false;
      tolerance_ = own_tolerance(*run);
      share_ = k_stress_round_off;
      return check_copies(*run);
    }
    const bool has_ended = run->record.status != RunStatus::complete;
    // Rows at an integrator's own steps have no counterparts in other runs, and contacts of the size of round-off have
    // no curves. Only the limits at which such runs end are compared.
    compares_curves_ = scenario_.output.points > 0 && !is_below_resolution(*run);
    if (!compares_curves_ && !has_ended) return;

    const bool is_direct = run->integrator.is_direct();
    reference_ = is_direct ? run : try_run(as_reference(scenario_), "reference form");
    if (!reference_) return;
    // The reference's time counts, too: runs with changed data take as long.
    own_seconds_ = std::max(own_seconds_, seconds_of_run());
    if (!is_direct) verdict_.violations = check_run(*reference_);
    if (!verdict_.violations.empty()) return;
    measure_tolerance();
    if (!is_direct) compare("agreement", *reference_, *run);
    if (scenario_.output.points > 0 && !has_given_up(*run)) {
      check_rate(*run);
      check_restart(*run);
      check_retrace(*run);
    }
    check_copies(*run);
  }

  /// Sets the tolerances of comparisons with the scene's own run.
  void measure_tolerance() {
    const bool is_direct = own_->integrator.is_direct();
    share_ = is_direct ? k_stress_round_off : std::max(scenario_.numerics.rtol, k_finest_rtol);
    tolerance_ = std::max(own_tolerance(*own_), own_tolerance(*reference_));
    nothing_ = {.unit = {.length = scenario_.radius, .stress = softest(scenario_)},
                .share = is_direct ? k_stress_round_off : own_absolute_tolerance(*own_),
                .energy_share = direct_work_tolerance(*own_),
                .step_share = tolerance_,
                .length = k_stress_round_off * scenario_.radius};
  }

  // --- copies of the scene that must agree with it

  /// Checks all copies of a scene that a limit has ended; of a complete scene, those that the effort asks for.
  void check_copies(const Run& run) {
    constexpr std::uint64_t k_kinds = 5;
    const bool needs_all = run.record.status != RunStatus::complete || effort_.copies == StressEffort::k_all_copies;
    const std::uint64_t kind = effort_.copies % k_kinds;
    const std::uint64_t which = effort_.copies / k_kinds;
    if (needs_all || kind == 0) check_scale(run);
    if (needs_all || kind == 1) check_order(run);
    for (std::uint64_t sample = 0; sample < k_rotations; ++sample) {
      if (needs_all || (kind == 2 && which % k_rotations == sample)) check_turned(run, sample);
    }
    if (run.integrator.used == integrators::k_forward_euler) return;
    if (needs_all || kind == 4) check_carried(run, which);
    const bool is_direct = run.integrator.is_direct();
    if ((needs_all || (kind == 3 && which % 2 == 0)) && run.integrator.used != integrators::k_ida)
      check_form(run, integrators::k_ida);
    if ((needs_all || (kind == 3 && which % 2 == 1)) && (is_direct || run.integrator.used == integrators::k_ida)) {
      check_form(run, integrators::k_cvode_bdf);
    }
  }

  void check_scale(const Run& run) {
    if (const auto other = try_run(magnified(scenario_, k_magnification), "larger and softer")) {
      compare("scale", run, *other, {.larger = k_magnification, .is_same_form = true});
    }
  }

  void check_order(const Run& run) {
    const std::optional<CheckedScenario> copy = reordered(scenario_);
    const std::optional<Run> other = copy ? try_run(*copy, "reordered") : std::nullopt;
    if (other) compare("order", by_wall(run), by_wall(*other), {.is_same_form = true, .copies = turned_copies(0)});
  }

  /// Run of a turned copy, turned back; nothing if the scene cannot be turned.
  std::optional<Run> turned_back(std::uint64_t sample) {
    const Eigen::Matrix3d rotation = stress_rotation(sample);
    const std::optional<CheckedScenario> copy = turned(scenario_, rotation);
    const std::optional<Run> run = copy ? try_run(*copy, "turned") : std::nullopt;
    return run ? std::optional(by_wall(*run, rotation)) : std::nullopt;
  }

  /// Makes other turned copies than that of a sample. The distances between turned copies show the effect of round-off
  /// of the normals on the scene.
  std::function<std::vector<Run>()> turned_copies(std::uint64_t sample) {
    return [this, sample] {
      std::vector<Run> copies;
      for (std::uint64_t k = 1; k <= k_rotations; ++k) {
        if (auto copy = turned_back(sample + k)) copies.push_back(std::move(*copy));
      }
      return copies;
    };
  }

  void check_turned(const Run& run, std::uint64_t sample) {
    const std::optional<Run> other = turned_back(sample);
    if (other) compare("turned", by_wall(run), *other, {.is_same_form = true, .copies = turned_copies(sample)});
  }

  /// Checks that a motion of all walls carries the particle along and changes nothing else. A copy without a direct
  /// form, because its walls are no longer alike, does not show the digits of a direct scene.
  void check_carried(const Run& run, std::uint64_t sample) {
    if (!scenario_.loading.centre_is_free || !is_always_held(run, tolerance_)) return;
    const std::optional<SharedMotion> motion = shared_motion(scenario_, sample);
    if (!motion) return;
    const CheckedScenario copy = carried(scenario_, *motion);
    if (run.integrator.is_direct() && !make_scene(copy).system->is_solvable()) return;
    const std::optional<Run> other = try_run(copy, "carried");
    if (!other) return;
    Run expected = by_wall(run, *motion);
    Run actual = by_wall(*other);
    // The parts into which a motion splits a class have events of their own.
    if (run.classes.size() != other->classes.size())
      expected.record.events = actual.record.events = Table(run.record.events.columns());
    compare("carried", expected, actual, {.copies = turned_copies(sample)});
  }

  /// Compares the reference with a run by another integrator; the direct form with one at the default tolerance.
  void check_form(const Run& run, const char* integrator) {
    CheckedScenario other = with_integrator(scenario_, integrator);
    if (run.integrator.is_direct()) {
      other.numerics.rtol = integrators::k_default_rtol;
      other.numerics.atol = 1e-4 * integrators::k_default_rtol;
    }
    SceneCheck check(other, effort_);
    check.end_ = end_;
    check.reference_ = reference_;
    check.compares_curves_ = compares_curves_;
    const std::optional<Run> integrated = check.try_run(other, "another form");
    if (integrated) {
      check.own_ = &*integrated;
      check.verdict_.violations = check_run(*integrated);
      check.measure_tolerance();
      if (check.verdict_.violations.empty()) check.compare("form", *reference_, *integrated);
    }
    verdict_.runs += check.verdict_.runs;
    verdict_.is_ill_conditioned |= check.verdict_.is_ill_conditioned;
    for (Violation& violation : check.verdict_.violations) report(violation.check, std::move(violation.detail));
  }

  [[nodiscard]] double seconds_of_run() const { return thread_seconds() - run_begin_; }

  [[nodiscard]] Run run_limited(const CheckedScenario& scenario, const SystemWrapper& wrap = {}) {
    run_begin_ = thread_seconds();
    return effort_.make_run(scenario, [&](std::unique_ptr<HybridSystem> system) {
      return limited(wrap ? wrap(std::move(system)) : std::move(system), end_);
    });
  }

  std::optional<Run> try_run(const CheckedScenario& scenario, std::string_view what) {
    ++verdict_.runs;
    try {
      return run_limited(scenario);
    } catch (const OutOfTime&) {
      throw;
    } catch (const std::exception& error) {
      verdict_.violations.push_back({"exception", fmt::format("{}: {}", what, error.what())});
      return std::nullopt;
    }
  }

  /// Reference runs of a scene whose data are changed by up to a share.
  std::vector<Run> runs_beside(const CheckedScenario& scenario, double share) {
    std::vector<Run> runs;
    for (std::uint64_t sample = 0; sample < k_samples; ++sample) {
      ++verdict_.runs;
      try {
        runs.push_back(run_limited(as_reference(changed(scenario, share, sample))));
      } catch (const OutOfTime&) {
        throw;
      } catch (const std::exception&) {
        continue;  // the changed data are not admissible
      }
    }
    return runs;
  }

  const std::vector<Run>& neighbours() {
    if (!neighbours_) neighbours_ = runs_beside(scenario_, share_);
    return *neighbours_;
  }

  /// Largest measured distance of runs with changed data from a reference; nan without any runs.
  template <class Measure>
  double spread(const Run& reference, const std::vector<Run>& runs, Measure&& measure) {
    double widest = runs.empty() ? k_nan : 0.0;
    for (const Run& run : runs) widest = worse(measure(reference, run), widest);
    return widest;
  }

  /// Largest measured distance that errors in the states cause in the scene's own form, if that is integrated. A
  /// reference in closed form has no such errors. An integrated reference has its own, but may know its states better
  /// than to the tolerance of a step.
  template <class Measure>
  double spread_of_states(Measure&& measure) {
    if (own_->integrator.is_direct()) return 0.0;
    double widest = 0.0;
    // States are disturbed by their tolerated error over k_sample_multiple, by which the spread is multiplied later.
    const double most = (reference_->integrator.is_direct() ? tolerance_ : share_) / k_sample_multiple;
    for (const auto& shares : {std::array{most, most}, {-most, -most}, {most, -most}, {-most, most}}) {
      ++verdict_.runs;
      try {
        const Run run = run_limited(
            scenario_, [&](std::unique_ptr<HybridSystem> system) { return disturbed(std::move(system), shares); });
        const double apart = measure(*own_, run);
        if (std::isfinite(apart)) widest = std::max(widest, apart);
      } catch (const OutOfTime&) {
        throw;
      } catch (const std::exception&) {
        continue;  // the disturbed state is not admissible
      }
    }
    return widest;
  }

  /// True if the reference and all runs with changed data have the same property, also with data changed by as much as
  /// an integrator's tolerated errors.
  template <class Property>
  bool all_share(Property&& property) {
    const auto own = property(*reference_);
    const auto has_it = [&](const Run& run) { return property(run) == own; };
    if (!far_neighbours_) far_neighbours_ = runs_beside(scenario_, tolerance_);
    return std::ranges::all_of(neighbours(), has_it) && std::ranges::all_of(*far_neighbours_, has_it);
  }

  [[nodiscard]] Distance distance_of(const Run& a, const Run& b, const Magnification& larger, double last) const {
    if (!compares_curves_) return {};
    return distance_between(a.record.history, b.record.history, nothing_, larger, last);
  }
  [[nodiscard]] Distance between(const Run& a, const Run& b, const Magnification& larger = {}) const {
    return distance_of(a, b, larger, k_infinity);
  }

  /// Distance at the last rows of two runs; nan if either is not complete.
  [[nodiscard]] Distance between_ends(const Run& a, const Run& b) const {
    if (a.record.status != RunStatus::complete || b.record.status != RunStatus::complete) return {k_nan, {}, 0.0};
    const Table& first = a.record.history;
    const Table& second = b.record.history;
    return distance_at(first, second, {{first.row_count() - 1, second.row_count() - 1}}, nothing_);
  }

  /// How two runs that are compared are related.
  struct Kinship {
    Magnification larger = {};  ///< factors by which the second is larger than the first
    bool is_same_form = false;  ///< the second must give up where the first does
    /// Makes runs the distance of whose ends from each other is allowed.
    std::function<std::vector<Run>()> copies = [] { return std::vector<Run>(); };
  };

  void compare(const char* check, const Run& expected, const Run& actual) {
    compare(check, expected, actual, Kinship());
  }

  void compare(const char* check, const Run& expected, const Run& actual, const Kinship& kinship) {
    const bool is_cut_short = !kinship.is_same_form && (has_given_up(actual) || has_given_up(expected));
    const bool has_limit = expected.record.status != RunStatus::complete;
    const bool runs_away = run_away_together(actual, expected, tolerance_);
    const bool has_same_end = is_cut_short || stated_end(actual) == stated_end(expected) || runs_away;
    const double ends = is_cut_short || runs_away || !has_limit || !has_same_end ? 0.0 : ends_apart(expected, actual);
    const Distance apart = between(expected, actual, kinship.larger);
    const EventNames expected_events = is_cut_short ? EventNames{} : sorted_events(expected);
    const EventNames events = is_cut_short ? EventNames{} : sorted_events(actual);
    if (has_same_end && ends <= tolerance_ && events == expected_events && apart.value <= tolerance_) return;

    // A spread of nan allows any distance: a column is empty, or the data cannot be changed.
    const auto curves_apart = [this](const Run& a, const Run& b) { return between(a, b).value; };
    const double widest = spread(*reference_, neighbours(), curves_apart);
    // The state is not determined from where a run with changed data has met a limit.
    const Distance known = distance_of(expected, actual, kinship.larger, first_end(neighbours()));
    const auto is_beyond = [&](double spread) { return !(known.value <= tolerance_ + k_sample_multiple * spread); };
    const bool is_apart = is_beyond(widest) && is_beyond(spread_of_states(curves_apart));
    // If errors may decide which events happen, either outcome is right.
    const bool is_toss = events != expected_events && !all_share(sorted_events);
    if (is_apart && !std::isnan(widest) && !is_toss) {
      report(check, fmt::format("{} differs by {:.3g}, above {:.3g} ({:.3g} with data changed by {:.1g}), t = {:.9g} s",
                                known.column, known.value, tolerance_, widest, share_, known.time));
      return;
    }
    // Copies differ by round-off only, which may decide only about limits that the program just reaches.
    const bool is_met_at_corner =
        stops_at_corner(expected, actual, tolerance_) || stops_at_corner(actual, expected, tolerance_);
    if (!has_same_end && ((kinship.is_same_form && !is_met_at_corner) || all_share(stated_end))) {
      report(check, fmt::format("ends {} against {}", quoted(actual), quoted(expected)));
      return;
    }
    if (ends > tolerance_ && all_share(stated_end)) {
      const std::vector<Run> copies = kinship.copies();
      double of_ends = spread(*reference_, neighbours(), ends_apart);
      if (!copies.empty()) of_ends = worse(of_ends, spread(copies.front(), copies, ends_apart));
      if (ends > tolerance_ + k_sample_multiple * of_ends) {
        report(check, fmt::format("ends {:.3g} of a step apart, above {:.3g} ({:.3g} with changed data): {} against {}",
                                  ends, tolerance_, of_ends, quoted(actual), quoted(expected)));
        return;
      }
    }
    const bool is_complete = has_same_end && stated_end(actual) == "complete";
    const bool are_crowded = coincide_with_others(actual, missing_from(expected_events, events), tolerance_) &&
                             coincide_with_others(expected, missing_from(events, expected_events), tolerance_);
    if (is_complete && events != expected_events && !are_crowded && !is_toss) {
      report(fmt::format("{}-events", check), first_difference(events, expected_events));
      return;
    }
    verdict_.is_ill_conditioned = true;
  }

  /// Reports a broken rule once, for the first of several copies that break it.
  void report(std::string check, std::string detail) {
    if (std::ranges::count(verdict_.violations, check, &Violation::check) > 0) return;
    verdict_.violations.push_back({std::move(check), std::move(detail)});
  }

  /// Checks that no digit of a history depends on the seconds that the steps of its program take.
  void check_rate(const Run& run) {
    const std::optional<Run> other = try_run(slower(scenario_, k_slower), "slower");
    if (!other) return;
    const Distance apart = distance_between(run.record.history, other->record.history);
    if (apart.value > 0.0 || std::isnan(apart.value)) {
      report("rate", fmt::format("{} differs by {:.3g}, t = {:.9g} s", apart.column, apart.value, apart.time));
    } else if (stated_end(run) != stated_end(*other) || sorted_events(run) != sorted_events(*other)) {
      report("rate", fmt::format("ends {} against {}", quoted(*other), quoted(run)));
    }
  }

  /// Checks that a program with a step cut in two ends in the same state.
  void check_restart(const Run& run) {
    std::size_t cut = 0;
    const std::optional<CheckedScenario> halves = halved(scenario_, cut);
    if (!halves || run.record.status != RunStatus::complete) return;
    const std::optional<Run> other = try_run(*halves, "cut in two");
    if (!other || has_given_up(*other)) return;
    const Distance apart = between_ends(run, *other);
    if (apart.value <= tolerance_) return;
    const double widest =
        spread(*reference_, neighbours(), [this](const Run& a, const Run& b) { return between_ends(a, b).value; });
    const auto is_within = [&](double spread) { return apart.value <= tolerance_ + k_sample_multiple * spread; };
    // Each of the two runs has errors of its own, which the scene may magnify.
    if (std::isnan(widest) || is_within(widest) ||
        is_within(spread_of_states([this](const Run& a, const Run& b) { return between(a, b).value; }))) {
      verdict_.is_ill_conditioned = true;
      return;
    }
    report("restart",
           fmt::format("step {} in two: {} at the end differs by {:.3g}, above {:.3g} ({:.3g} with changed data); {}",
                       cut + 1, apart.column, apart.value, tolerance_, widest, quoted(*other)));
  }

  /// Checks that unloading retraces loading if the law is elastic.
  void check_retrace(const Run& of_scene) {
    const std::optional<CheckedScenario> there = forth_and_back(scenario_);
    if (!there || !(is_elastic(scenario_) || stays_elastic(of_scene))) return;
    const std::optional<Run> run = try_run(*there, "forth and back");
    if (!run || run->record.status != RunStatus::complete || is_below_resolution(*run)) return;
    if (is_left_elsewhere(*run, tolerance_, nothing_.share)) return;
    const Table& table = run->record.history;
    const std::vector<std::size_t> rows = output_rows(table);
    const auto points = static_cast<std::size_t>(scenario_.output.points);
    if (rows.size() != 2 * points + 1) return;
    const Scene scene = make_scene(*there);
    std::vector<std::pair<std::size_t, std::size_t>> pairs, pairs_elsewhere;
    for (std::size_t k = 0; k < points; ++k) {
      const std::size_t row = rows[k];
      const std::size_t back = rows[2 * points - k];
      const bool has_own_place =
          is_held(*run, scene.classes, row, tolerance_) || !is_elsewhere(*run, row, back, tolerance_, nothing_.share);
      (has_own_place ? pairs : pairs_elsewhere).emplace_back(row, back);
    }
    // The position of a centre that contacts do not hold depends on its path; forces do not.
    Negligible nothing_there = nothing_;
    nothing_there.has_any_place = true;
    Distance apart = distance_at(table, table, pairs, nothing_);
    const Distance apart_elsewhere = distance_at(table, table, pairs_elsewhere, nothing_there);
    if (apart_elsewhere.value > apart.value || std::isnan(apart_elsewhere.value)) apart = apart_elsewhere;
    if (apart.value <= tolerance_) return;
    const double widest =
        spread(*run, runs_beside(*there, share_), [this](const Run& a, const Run& b) { return between(a, b).value; });
    if (std::isnan(widest) || apart.value <= tolerance_ + k_sample_multiple * widest) {
      verdict_.is_ill_conditioned = true;
      return;
    }
    report("retrace", fmt::format("{} differs by {:.3g}, above {:.3g} ({:.3g} with changed data), from t = {:.9g} s on",
                                  apart.column, apart.value, tolerance_, widest, apart.time));
  }

  const CheckedScenario& scenario_;
  StressEffort effort_;
  double end_;
  double run_begin_ = thread_seconds();  ///< when the last run began
  double own_seconds_ = 0.0;             ///< time of the scene's own run or its reference, whichever took longer
  const Run* own_ = nullptr;             ///< the scene's own run
  std::optional<Run> reference_;
  double tolerance_ = 0.0;
  Negligible nothing_;
  bool compares_curves_ = true;
  double share_ = 0.0;  ///< relative change of the data that is equivalent to errors of the runs
  std::optional<std::vector<Run>> neighbours_, far_neighbours_;
  StressVerdict verdict_;
};

}  // namespace

double most_seconds_of(const CheckedScenario& scenario) {
  constexpr double k_of_scene = 30.0;
  constexpr double k_of_step = 1.0;
  return std::max(k_of_scene, k_of_step * static_cast<double>(step_count(scenario)));
}

StressVerdict check_scene(const CheckedScenario& scenario, const StressEffort& effort) {
  return SceneCheck(scenario, effort).verdict();
}

StressVerdict check_scene(const CheckedScenario& scenario) {
  return check_scene(scenario, {.seconds = most_seconds_of(scenario)});
}

}  // namespace monograin
