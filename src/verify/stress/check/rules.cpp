#include "verify/stress/check/rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <span>

#include "catalogue.hpp"
#include "contacts/centre/reaction_cone.hpp"
#include "history/energy.hpp"
#include "scenario/integrators.hpp"
#include "scenario/model_input.hpp"
#include "scene/scene.hpp"
#include "system/resolution.hpp"
#include "verify/stress/check/distance.hpp"

namespace monograin {
namespace {

// Error over rtol for each step of a long program: errors of work have one sign and add up (measured: 16).
constexpr double k_rtol_multiple_of_step = 25.0;
// Error of the direct form's work over rtol (measured: 0.0014).
constexpr double k_direct_work = 1e-2;
// Events of one step of the program; fifty times as many as scenes show.
constexpr std::size_t k_most_events_per_step = 200;
// Events from one end of growth to the next, if growth ends again and again.
constexpr std::size_t k_most_events_between_ends = 10;
// Evaluations of equations and guards for each row, event and step of the program. Of 1,761 drawn scenes half of the
// direct runs need 3 or fewer, 99 % 102, the worst 159. Of the integrated ones half need 7 to 162, by integrator, 99 %
// 103 to 2,214, the worst 3,566.
constexpr long k_most_work_direct = 1000;
constexpr long k_most_work_integrated = 20000;
// Share of the rest of a force's ramp that check_hold() samples ahead, and of the largest force that is small beside
// it.
constexpr double k_little = 1e-3;
// Largest gap at which a wall touches, over the depth to which a program presses: the accuracy of positions.
constexpr double k_touch = 1e-9;
// Change of an overlap, over the largest, that is no jump: the weak spring by which a model holds a free centre is set
// to rest.
constexpr double k_jump = 1e-6;
// Largest resultant, over the forces, that laws leave of forces in balance. Walls whose alignment is worse than this do
// not balance each other.
constexpr double k_left_over = 1e-9;

bool adheres(const CheckedScenario& scenario) { return find_model(scenario.model)->adheres(scenario.material); }

Dimension find_dimension(const std::string& model, std::string_view key) {
  const std::span<const QuantityKey> keys = find_model(model)->material;
  return std::ranges::find(keys, key, &QuantityKey::name)->dimension;
}

double stiffest_modulus(const Run& run) {
  double stiffest = 0.0;
  for (const auto& [key, value] : run.scenario.material) {
    if (find_dimension(run.scenario.model, key) == Dimension::stress) stiffest = std::max(stiffest, value);
  }
  return stiffest;
}

/// Energy [J] that counts as zero: the round-off of overlaps, which are differences of lengths of the order of R0, or
/// an integrator's absolute tolerance.
double energy_floor(const Run& run) {
  const double negligible = run.integrator.is_direct() ? 0.0 : own_absolute_tolerance(run) * softest(run.scenario);
  return std::max(k_stress_round_off * stiffest_modulus(run), negligible) * std::pow(run.scenario.radius, 3);
}

/// Round-off of the force [N] of a contact that unloads: that of its overlap, a difference of lengths of the order of
/// R0, times its unloading stiffness. 0 without a column for the contact radius.
double force_floor(const Run& run, std::size_t row, const std::string& wall) {
  const auto contact_radius = run.record.history.find(wall + ".contact_radius");
  if (!contact_radius) return 0.0;
  return k_stress_round_off * 2.0 * stiffest_modulus(run) * run.record.history.at(row, *contact_radius) *
         run.scenario.radius;
}

using Violations = std::vector<Violation>;

void check_end(const Run& run, Violations& found) {
  if (!stated_end(run).empty()) return;
  const bool has_failed = run.record.status == RunStatus::failed;
  found.push_back({has_failed ? "solver" : "unstated-limit", run.record.message});
}

/// Rows of a table as models see them.
class TableRows final : public HistoryRows {
 public:
  explicit TableRows(const Table& table) : table_(table) {}
  [[nodiscard]] std::size_t row_count() const noexcept override { return table_.row_count(); }
  [[nodiscard]] std::optional<std::size_t> find(std::string_view column) const noexcept override {
    return table_.find(column);
  }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const override { return table_.at(row, column); }
  [[nodiscard]] std::string_view word(std::size_t row, std::size_t column) const override {
    return table_.word(row, column);
  }
  [[nodiscard]] double largest_magnitude(std::size_t column) const override {
    return monograin::largest_magnitude(table_, column);
  }

 private:
  const Table& table_;
};

void check_numbers(const Run& run, const CheckedRun& checked, Violations& found) {
  const Table& table = run.record.history;
  const auto may_be_undefined = find_model(run.scenario.model)->may_be_undefined;
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    const Column& column = table.columns()[c];
    if (column.holds_words()) continue;
    for (std::size_t row = 0; row < table.row_count(); ++row) {
      if (std::isfinite(table.at(row, c))) continue;
      const bool may_be = may_be_undefined != nullptr && may_be_undefined(checked, row, column.name);
      if (may_be && std::isnan(table.at(row, c))) continue;
      found.push_back({"no-number", fmt::format("{} = {} in row {}, t = {:.9g} s", column.name, table.at(row, c), row,
                                                table.at(row, 0))});
      return;
    }
  }
}

void check_forces(const Run& run, Violations& found) {
  if (adheres(run.scenario)) return;
  const Table& table = run.record.history;
  const double scale = largest_of_kind(table, "force");
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    if (kind_of(table.columns()[c]) != "force") continue;
    for (std::size_t row = 0; row < table.row_count(); ++row) {
      if (!(table.at(row, c) < -own_tolerance(run) * scale)) continue;
      found.push_back({"tension", fmt::format("{} = {:.6g} N of at most {:.6g} N at t = {:.9g} s",
                                              table.columns()[c].name, table.at(row, c), scale, table.at(row, 0))});
      return;
    }
  }
}

/// Checks that a contact which bears keeps its overlap where a step ends and the next one begins.
void check_step_starts(const Run& run, Violations& found) {
  if (adheres(run.scenario)) return;
  const Table& table = run.record.history;
  const double most = std::max(own_tolerance(run), k_jump) * largest_of_kind(table, "overlap");
  const double least_force = k_little * largest_of_kind(table, "force");
  const auto step = *table.find("step");
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    if (kind_of(table.columns()[c]) != "overlap") continue;
    const std::string& name = table.columns()[c].name;
    const auto force = *table.find(name.substr(0, name.rfind('.')) + ".force");
    for (std::size_t row = 1; row < table.row_count(); ++row) {
      if (table.at(row, step) == table.at(row - 1, step)) continue;
      if (std::min(table.at(row, force), table.at(row - 1, force)) <= least_force) continue;
      const double jump = table.at(row, c) - table.at(row - 1, c);
      if (!(std::abs(jump) > most)) continue;
      found.push_back({"jump", fmt::format("{} goes from {:.6g} to {:.6g} m at once, t = {:.9g} s", name,
                                           table.at(row - 1, c), table.at(row, c), table.at(row, 0))});
      return;
    }
  }
}

/// Force prescribed to the walls of a class at the end of a step; nothing if a displacement is prescribed.
/// @param step  counted from 0
std::optional<double> prescribed_force(const Channel& channel, std::size_t step) {
  std::optional<double> force;
  for (std::size_t k = 0; k <= step && k < channel.program.size(); ++k) {
    const Step& planned = channel.program[k];
    if (planned.kind == Step::Kind::force)
      force = planned.target;
    else if (planned.kind != Step::Kind::hold)
      force.reset();
  }
  return force;
}

/// Column that shows the quantity which a step prescribes to a channel; none if the column need not reach the target.
/// Contacts of a free centre move with it, and a wall cannot pull a contact that does not adhere or may have snapped
/// off.
std::optional<std::string> column_of(const CheckedScenario& scenario, const Scene& scene, const Channel& channel,
                                     const Step& step) {
  const auto control = control_of(step.kind);
  if (!control) return std::nullopt;
  const Model& model = *find_model(scenario.model);
  if (!model.has_walls()) {
    const bool is_lateral = &channel != &scene.channels.front();
    const auto drives = is_lateral ? model.lateral_drives : model.drives;
    const DriveKey& drive = *std::ranges::find(drives, *control, &DriveKey::control);
    return std::string(drive.column.empty() ? drive.name : drive.column);
  }
  if (*control == Control::displacement && scenario.loading.centre_is_free) return std::nullopt;
  const bool may_open = step.target < 0.0 || adheres(scenario);
  if (*control == Control::force && may_open) return std::nullopt;
  return fmt::format("{}.{}", channel.name, *control == Control::force ? "force" : "displacement");
}

/// Checks that the last step reaches its targets, unless a condition or a withdrawal may end it.
void check_program(const Run& run, Violations& found) {
  if (run.record.status != RunStatus::complete) return;
  const Table& table = run.record.history;
  const Scene scene = make_scene(run.scenario);
  const auto has_last_step = [&](const Channel& channel) { return channel.program.size() == scene.leg_count(); };
  const auto may_end_early = [&](const Channel& channel) {
    return has_last_step(channel) &&
           (!channel.program.back().until.empty() || channel.program.back().kind == Step::Kind::detach);
  };
  if (std::ranges::any_of(scene.channels, may_end_early)) return;
  for (const Channel& channel : scene.channels) {
    if (!has_last_step(channel)) continue;
    const double target = channel.program.back().target;
    const auto name = column_of(run.scenario, scene, channel, channel.program.back());
    if (!name) continue;
    const std::size_t column = *table.find(*name);
    const std::size_t last_row = table.row_count() - 1;
    const double last = table.at(last_row, column);
    const double scale = std::max(std::abs(target), largest_magnitude(table, column));
    const double floor = name->ends_with("force") ? force_floor(run, last_row, channel.name) : 0.0;
    if (std::abs(last - target) <= own_tolerance(run) * scale + floor) continue;
    found.push_back({"program", fmt::format("{} ends {:.3g} off {:.9g}", *name, last - target, target)});
    return;
  }
}

/// Greatest depth [m] to which a program presses, but at most R0.
double deepest_asked_for(const CheckedScenario& scenario, const Scene& scene) {
  const Model& model = *find_model(scenario.model);
  const ModelInput input = model_input(scenario);
  double deepest = 0.0;
  for (const Channel& channel : scene.channels) {
    for (const Step& step : channel.program) {
      if (step.kind == Step::Kind::displacement) deepest = std::max(deepest, step.target);
      if (step.kind != Step::Kind::force || !(step.target > 0.0) || model.reach == nullptr) continue;
      const Until until{.quantity = Quantity::force, .value = step.target};
      deepest = std::max(deepest, model.reach(input, until).displacement);
    }
  }
  return std::min(deepest, scenario.radius);
}

/// Checks the limit that forces drive the centre away: it is right only if no touching contacts could balance them.
void check_hold(const Run& run, Violations& found) {
  if (run.record.limit != Limit::centre_driven_away || adheres(run.scenario)) return;
  const Table& table = run.record.history;
  const std::size_t last = table.row_count() - 1;
  const auto step = static_cast<std::size_t>(table.at(last, *table.find("step"))) - 1;
  const Scene scene = make_scene(run.scenario);
  std::vector<std::pair<double, Eigen::Vector3d>> pushes;  // prescribed force and sum of normals, for each class
  double largest = 0.0;
  std::vector<Eigen::Vector3d> others, bearing;
  const double touch = k_touch * deepest_asked_for(run.scenario, scene);
  for (std::size_t c = 0; c < scene.classes.size(); ++c) {
    const ContactClass& contact_class = scene.classes[c];
    Eigen::Vector3d normals = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& normal : contact_class.normals) normals += normal;
    if (normals.norm() < k_no_direction) continue;
    const auto at_end = [&](const char* column) {
      return table.at(last, *table.find(fmt::format("{}.{}", contact_class.name, column)));
    };
    const std::string_view regime = table.word(last, *table.find(contact_class.name + ".regime"));
    // With a law that moves the surface, loaded contacts lift it elsewhere: a negative overlap is not the gap.
    const double overlap = at_end("overlap");
    const bool touches = find_model(run.scenario.model)->moves_surface ? regime != "open" || std::abs(overlap) <= touch
                                                                       : overlap >= -touch && regime != "separated";
    if (const auto force = prescribed_force(scene.channels[c], step)) {
      // The force a little later in the step, because other forces may still be zero.
      pushes.emplace_back(std::lerp(at_end("force"), *force, k_little), normals);
      largest = std::max(largest, pushes.back().first);
    } else if (touches) {
      others.push_back(normals.normalized());
      if (at_end("force") > 0.0) bearing.push_back(others.back());
    }
  }
  Eigen::Vector3d push = Eigen::Vector3d::Zero();
  Eigen::Vector3d small_push = Eigen::Vector3d::Zero();
  for (const auto& [force, normals] : pushes) (force < k_little * largest ? small_push : push) += force * normals;
  if (!(push.norm() > 0.0) || !in_reaction_cone(push, others, k_left_over)) return;
  // Beside much larger forces the test does not show whether small ones can be balanced: they are tested alone. Loaded
  // contacts may also yield some of their force to balance them.
  for (const Eigen::Vector3d& normal : bearing) others.push_back(-normal);
  if (small_push.norm() > 0.0 && !in_reaction_cone(small_push, others, k_left_over)) return;
  found.push_back(
      {"held-centre", fmt::format("contacts that touch could balance the forces of '{}'", run.record.message)});
}

void check_energy(const Run& run, Violations& found) {
  const Table& table = run.record.history;
  const auto work = table.find("work");
  const auto stored = table.find("stored_energy");
  const auto dissipation = table.find("dissipation");
  if (!work || !stored) return;
  const double scale = std::max(largest_magnitude(table, *work), largest_magnitude(table, *stored));
  if (scale == 0.0) return;
  const bool is_conservative = is_elastic(run.scenario);
  // Integrated runs of a conservative law are compared with the direct form instead, which allows for errors that the
  // scene magnifies.
  if (is_conservative && !run.integrator.is_direct()) return;
  // A law that returns more energy than it received has to warn of it.
  const bool is_warned = run.record.creates_energy;
  const double of_run = run.integrator.is_direct() ? direct_work_tolerance(run) : own_tolerance(run);
  const double share = is_conservative ? integrators::k_direct_tolerance : k_least_noted_fall;
  const double most = (share + of_run) * scale + energy_floor(run);
  double highest = 0.0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const double lost = table.at(row, *work) - table.at(row, *stored);
    if (dissipation) {
      const double gap = lost - table.at(row, *dissipation);
      // Round-off of the sum of three energies.
      if (std::abs(gap) > 8.0 * k_epsilon * scale) {
        found.push_back(
            {"energy-balance", fmt::format("work - stored energy - dissipation = {:.3g} of {:.6g} J, t = {:.9g} s", gap,
                                           scale, table.at(row, 0))});
        return;
      }
    }
    if (is_conservative && std::abs(lost) > most) {
      found.push_back({"elastic-energy", fmt::format("work - stored energy = {:.3g} of {:.6g} J, t = {:.9g} s", lost,
                                                     scale, table.at(row, 0))});
      return;
    }
    highest = std::max(highest, lost);
    if (highest - lost > most && !is_warned) {
      found.push_back(
          {"energy-made", fmt::format("the dissipation falls by {:.3g} of {:.6g} J without a warning, t = {:.9g} s",
                                      highest - lost, scale, table.at(row, 0))});
      return;
    }
  }
}

/// True if modes may alternate without end: with adhesion and a free centre, or with a particle that grows until a
/// contact is made and stops growing while it is closed (docs/reference/limits.md).
bool may_go_on(const Run& run) {
  if (!adheres(run.scenario)) return false;
  if (run.scenario.loading.centre_is_free) return true;
  const Table& events = run.record.events;
  const auto name = *events.find("event");
  std::size_t ends = 0;
  for (std::size_t row = 0; row < events.row_count(); ++row) ends += events.word(row, name) == "growth-off" ? 1 : 0;
  return ends * k_most_events_between_ends >= k_most_events_per_step;
}

/// The reason of a failed run, if docs/reference/limits.md names it; else empty.
std::string stated_failure(const Run& run) {
  const RunRecord& record = run.record;
  if (!record.failure) return "";
  const Failure failure = *record.failure;
  if (!run.integrator.is_direct() && run.scenario.numerics.rtol < k_finest_rtol) return "tolerance of round-off";
  if (failure == Failure::endless_events || failure == Failure::chattering) {
    return may_go_on(run) ? "events without end" : "";
  }
  const bool is_too_much_work = failure == Failure::too_much_work;
  // A material by itself may be so stiff that no method is quick.
  const bool may_be_stiff = !suits_stiff_equations(run.integrator.used) || !find_model(run.scenario.model)->has_walls();
  if (is_too_much_work && may_be_stiff) return "stiff equations";
  if (!record.difficulty || (is_too_much_work && record.difficulty == Difficulty::soft_centre)) return "";
  return advice(*record.difficulty);
}

void check_events(const Run& run, Violations& found) {
  std::map<double, std::size_t> counts;
  const Table& events = run.record.events;
  const auto step = *events.find("step");
  const auto name = *events.find("event");
  for (std::size_t row = 0; row < events.row_count(); ++row) {
    // Intersecting caps change nothing, and the cap of a wall that comes in may intersect those of all others.
    if (events.word(row, name) == "caps-intersect") continue;
    if (++counts[events.at(row, step)] == k_most_events_per_step && !may_go_on(run)) {
      found.push_back(
          {"endless-events", fmt::format("{} events in step {}", k_most_events_per_step, events.at(row, step))});
    }
  }
  const auto time = *run.record.history.find("time");
  for (std::size_t row = 1; row < run.record.history.row_count(); ++row) {
    const double before = run.record.history.at(row - 1, time);
    const double now = run.record.history.at(row, time);
    if (now >= before) continue;
    found.push_back({"time", fmt::format("goes back from {} s to {} s", before, now)});
    return;
  }
}

/// Checks that the work of a run is in proportion to its rows, events and steps. Exempt are fixed steps, whose number
/// follows from the tolerance, and methods that are not made for stiff equations: the engine fails if they take too
/// many steps.
void check_work(const Run& run, Violations& found) {
  if (!suits_stiff_equations(run.integrator.used)) return;
  // The run has failed because of its work; check_end() judges whether it may.
  if (run.record.failure == Failure::too_much_work) return;
  const long most = run.integrator.is_direct() ? k_most_work_direct : k_most_work_integrated;
  const Statistics& done = run.record.statistics;
  const long work = done.rhs_evaluations + done.guard_evaluations;
  const auto shown =
      static_cast<long>(run.record.history.row_count() + run.record.events.row_count() + step_count(run.scenario));
  if (work <= most * shown) return;
  found.push_back({"work", fmt::format("{} evaluations, {} for each of {} rows, events and steps, above {}", work,
                                       work / shown, shown, most)});
}

}  // namespace

double softest(const CheckedScenario& scenario) {
  double least = k_infinity;
  for (const QuantityKey& key : find_model(scenario.model)->material) {
    const auto found = scenario.material.find(std::string(key.name));
    if (key.dimension == Dimension::stress && found != scenario.material.end() && found->second > 0.0) {
      least = std::min(least, found->second);
    }
  }
  return least;
}

bool is_elastic(const CheckedScenario& scenario) {
  const auto is_elastic = find_model(scenario.model)->is_elastic;
  return is_elastic != nullptr && is_elastic(model_input(scenario));
}

bool stays_elastic(const Run& run) {
  if (find_model(run.scenario.model)->has_walls()) return false;
  const Table& events = run.record.events;
  const auto event = *events.find("event");
  for (std::size_t row = 0; row < events.row_count(); ++row) {
    if (events.word(row, event) == "yield") return false;
  }
  return true;
}

std::size_t step_count(const CheckedScenario& scenario) {
  std::size_t count = scenario.loading.steps.size();
  for (const WallSpec& wall : scenario.loading.walls) count = std::max(count, wall.steps.size());
  return count;
}

double direct_work_tolerance(const Run& run) {
  return run.integrator.is_direct() ? k_direct_work * run.scenario.numerics.rtol : 0.0;
}

double own_tolerance(const Run& run) {
  if (run.integrator.is_direct()) return integrators::k_direct_tolerance;
  const auto steps = static_cast<double>(step_count(run.scenario));
  return std::max(integrators::k_error_over_rtol, k_rtol_multiple_of_step * steps) *
         std::max(run.scenario.numerics.rtol, k_finest_rtol);
}

double own_absolute_tolerance(const Run& run) {
  if (run.integrator.is_direct()) return k_stress_round_off;
  return own_tolerance(run) / run.scenario.numerics.rtol * run.scenario.numerics.atol;
}

std::vector<Violation> check_run(const Run& run) {
  Violations found;
  const TableRows rows(run.record.history);
  const Scene scene = make_scene(run.scenario);
  const ModelInput input = model_input(run.scenario);
  const CheckedRun checked{input, rows, scene.classes, own_tolerance(run), k_stress_round_off};
  check_end(run, found);
  check_numbers(run, checked, found);
  check_hold(run, found);
  check_events(run, found);
  check_work(run, found);
  // Fixed steps control no error, nor do they end where a contact opens: the rules below do not hold for them.
  if (run.integrator.used == integrators::k_forward_euler) return found;
  check_forces(run, found);
  check_step_starts(run, found);
  check_energy(run, found);
  check_program(run, found);
  if (const auto check = find_model(run.scenario.model)->check) check(checked, found);
  return found;
}

std::string stated_end(const Run& run) {
  const RunRecord& record = run.record;
  if (record.status == RunStatus::complete) return "complete";
  if (record.status == RunStatus::failed) return stated_failure(run);
  // The two limits describe one situation: whether walls or forces push the centre does not matter.
  if (record.limit == Limit::centre_driven_away) return std::string(code(Limit::centre_not_held));
  const bool is_stated = record.limit && record.limit != Limit::no_solution && record.limit != Limit::unequal_durations;
  return is_stated ? std::string(code(*record.limit)) : std::string();
}

}  // namespace monograin
