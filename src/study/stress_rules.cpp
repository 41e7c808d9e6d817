#include "study/stress_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <span>

#include "catalogue.hpp"
#include "compressible/material_point_info.hpp"
#include "compressible/yield_surface.hpp"
#include "elastic/hertz.hpp"
#include "mdr/contact.hpp"
#include "packing/law.hpp"
#include "reaction_cone.hpp"
#include "scene/mdr_law.hpp"
#include "scene/packing_law.hpp"
#include "scene/scene.hpp"
#include "study/stress_distance.hpp"

namespace monograin {
namespace {

constexpr double k_epsilon = std::numeric_limits<double>::epsilon();

// Error of a controlled integrator over its rtol; README, "Accuracy and speed".
constexpr double k_rtol_multiple = 100.0;
// The multiple for each step of a long program: errors of work have one sign, and add up (measured: 16).
constexpr double k_rtol_multiple_of_step = 25.0;
// Two runs of the direct form: each is polished to 1e-12 of the largest values (README), and work is a sum of
// quadratures.
constexpr double k_direct_tolerance = 1e-10;
// Error of that work over the tolerance it is asked for (measured: 0.0014).
constexpr double k_direct_work = 1e-2;
// Fall of the dissipation from which on models warn, over the work.
constexpr double k_tolerated_loss = 1e-6;
// Events of one step of the program; a fifty-fold of what scenes show.
constexpr std::size_t k_most_events_per_step = 200;
// Where growth ends again and again, events between.
constexpr std::size_t k_most_events_between_ends = 10;
// Evaluations of equations and guards for each row, event and step of the program. Of 1,761 drawn scenes half of the
// direct runs need 3 or fewer, 99 % 102, the worst 159. Of the integrated ones half need 7 to 162, by integrator, 99 %
// 103 to 2,214, the worst 3,566.
constexpr long k_most_work_direct = 1000;
constexpr double k_most_work_integrated = 20000.0;
// Resultant of unit normals below which a class of walls does not act on the centre.
constexpr double k_no_direction = 1e-6;
// Of what is left of a force's way; of the largest force, what is small beside it.
constexpr double k_little = 1e-3;
// Gaps at which a wall touches, over how deep a program presses: as well as that places are known.
constexpr double k_touch = 1e-9;
// What laws leave of forces that balance, over these: walls that align but for more than that balance no others.
constexpr double k_left_over = 1e-9;

double material(const Scenario& scenario, const char* key) {
  const auto found = scenario.material.find(key);
  return found == scenario.material.end() ? 0.0 : found->second;
}

std::string option(const Scenario& scenario, const char* key) {
  const auto found = scenario.options.find(key);
  const auto* word = found == scenario.options.end() ? nullptr : std::get_if<std::string>(&found->second);
  return word == nullptr ? std::string() : *word;
}

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

/// Rounding of an energy, overlaps being differences of lengths of the order of R0; or what an integrator takes for
/// nothing.
double energy_floor(const Run& run) {
  const double negligible = run.integrator.used == "direct" ? 0.0 : own_absolute_tolerance(run) * softest(run.scenario);
  return std::max(k_stress_rounding * stiffest_modulus(run), negligible) * std::pow(run.scenario.radius, 3);
}

/// Rounding of the force of a contact that goes back, for the same reason: how stiff that is does not show in a curve
/// along which the particle grows.
double force_floor(const Run& run, std::size_t row, const std::string& wall) {
  const auto contact_radius = run.record.history.find(wall + ".contact_radius");
  if (!contact_radius) return 0.0;
  return k_stress_rounding * 2.0 * stiffest_modulus(run) * run.record.history.at(row, *contact_radius) *
         run.scenario.radius;
}

using Violations = std::vector<Violation>;

void check_end(const Run& run, Violations& found) {
  if (!stated_end(run).empty()) return;
  const bool has_failed = run.record.status == RunStatus::failed;
  found.push_back({has_failed ? "solver" : "unstated-limit", run.record.message});
}

void check_numbers(const Run& run, Violations& found) {
  const Table& table = run.record.history;
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    const Column& column = table.columns()[c];
    if (column.holds_words()) continue;
    const std::size_t dot = column.name.rfind('.');
    const auto regime = dot == std::string::npos ? std::nullopt : table.find(column.name.substr(0, dot) + ".regime");
    for (std::size_t row = 0; row < table.row_count(); ++row) {
      if (std::isfinite(table.at(row, c))) continue;
      // Where a source has no law for a lateral contact, its columns are empty.
      const bool may_be_empty = regime && std::isnan(table.at(row, c)) &&
                                (run.scenario.model == "semimech" || run.scenario.model == "hardening") &&
                                column.name.starts_with("lateral");
      // The formulas of the deformed contact radius end where a contact is as wide as the particle.
      const auto radius = table.find(column.name.substr(0, dot) + ".contact_radius");
      const bool is_beyond = column.name.ends_with(".contact_radius_deformed") && radius &&
                             table.at(row, *radius) >= run.scenario.radius * (1.0 - k_stress_rounding);
      if (is_beyond && std::isnan(table.at(row, c))) continue;
      // Below jamming there is no coordination number.
      if (may_be_empty || (column.name == "coordination_number" && std::isnan(table.at(row, c)))) continue;
      found.push_back({"no-number", fmt::format("{} = {} in row {}, t = {:.9g} s", column.name, table.at(row, c), row,
                                                table.at(row, 0))});
      return;
    }
  }
}

void check_forces(const Run& run, Violations& found) {
  // A fixed step does not end where a contact opens.
  if (material(run.scenario, "surface_energy") > 0.0 || run.integrator.used == "explicit") return;
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

/// Rows of a history that break something, the first of each: where `excess` is not below zero.
template <class Excess>
void check_rows(const Run& run, const char* check, const char* what, Violations& found, Excess&& excess) {
  const Table& table = run.record.history;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const double value = excess(table, row);
    if (value <= 0.0) continue;
    found.push_back({check, fmt::format("{}, by {:.3g} at t = {:.9g} s", what, value, table.at(row, 0))});
    return;
  }
}

/// Between elastic spheres and walls an overlap without a force is a contact that was missed.
void check_contacts(const Run& run, Violations& found) {
  const Table& table = run.record.history;
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    if (kind_of(table.columns()[c]) != "overlap") continue;
    const std::string& name = table.columns()[c].name;
    const auto force = *table.find(name.substr(0, name.rfind('.')) + ".force");
    const std::string what = fmt::format("{} is past the surface, without a force", name);
    check_rows(run, "missed-contact", what.c_str(), found, [&](const Table& t, std::size_t row) {
      return t.at(row, force) == 0.0 ? t.at(row, c) / run.scenario.radius - own_tolerance(run) : 0.0;
    });
  }
}

/// What the walls of a class are to press with at the end of a step, counted from 0; nothing where a displacement is
/// prescribed.
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

/// The column that shows what a channel of the program prescribes; none where it need not come to that: contacts of a
/// free centre move with it, and no wall pulls one that does not adhere, or may have snapped off.
std::optional<std::string> column_of(const Scenario& scenario, const Channel& channel, const Step& step) {
  constexpr std::array<std::string_view, 5> k_kinds{"displacement", "force", "strain", "stress", "packing_fraction"};
  const auto control = control_of(step.kind);
  if (!control) return std::nullopt;
  const std::string_view kind = k_kinds[static_cast<std::size_t>(*control)];
  if (scenario.model == "packing") return std::string(kind);
  if (scenario.model == "material-point") return fmt::format("{}_{}", kind, channel.name);
  if (*control == Control::displacement && scenario.loading.centre_is_free) return std::nullopt;
  const bool may_open = step.target < 0.0 || material(scenario, "surface_energy") > 0.0;
  if (*control == Control::force && may_open) return std::nullopt;
  return fmt::format("{}.{}", channel.name, kind);
}

/// What the last step prescribes is reached, unless something else may end it.
void check_program(const Run& run, Violations& found) {
  if (run.record.status != RunStatus::complete) return;
  const Table& table = run.record.history;
  const Scene scene = make_scene(run.scenario);
  const auto has_last_step = [&](const Channel& channel) { return channel.program.size() == scene.step_count(); };
  const auto may_end_early = [&](const Channel& channel) {
    return has_last_step(channel) &&
           (!channel.program.back().until.empty() || channel.program.back().kind == Step::Kind::detach);
  };
  if (std::ranges::any_of(scene.channels, may_end_early)) return;
  for (const Channel& channel : scene.channels) {
    if (!has_last_step(channel)) continue;
    const double target = channel.program.back().target;
    const auto name = column_of(run.scenario, channel, channel.program.back());
    if (!name) continue;
    const std::size_t column = *table.find(*name);
    const std::size_t last_row = table.row_count() - 1;
    const double last = table.at(last_row, column);
    const double scale = std::max(std::abs(target), largest_magnitude(table, column));
    // What is rounded: strains of order one, lengths of the order of R0.
    const double unit = scene.classes.empty() ? 1.0 : name->ends_with("displacement") ? run.scenario.radius : 0.0;
    // The force of a shallow contact is known as well as its overlap, a difference of such lengths.
    double by_overlap = 0.0;
    if (name->ends_with("force")) {
      by_overlap = std::max(change_with_overlap(table, last_row, column, k_stress_rounding * run.scenario.radius),
                            force_floor(run, last_row, channel.name));
    }
    if (std::abs(last - target) <= own_tolerance(run) * scale + k_stress_rounding * unit + by_overlap) continue;
    found.push_back({"program", fmt::format("{} ends {:.3g} off {:.9g}", *name, last - target, target)});
    return;
  }
}

/// How deep a program presses at most, as far as contacts are elastic and not as wide as the particle.
double deepest_asked_for(const Scenario& scenario, const Scene& scene) {
  const double modulus = composite_modulus(material(scenario, "youngs_modulus"), material(scenario, "poisson_ratio"));
  double deepest = 0.0;
  for (const Channel& channel : scene.channels) {
    for (const Step& step : channel.program) {
      if (step.kind == Step::Kind::displacement) deepest = std::max(deepest, step.target);
      if (step.kind != Step::Kind::force || !(step.target > 0.0)) continue;
      const double overlap = mdr::elastic_overlap(mdr::ElasticProfile::parabola, modulus, scenario.radius, step.target);
      deepest = std::max(deepest, overlap);
    }
  }
  return std::min(deepest, scenario.radius);
}

/// That forces drive the centre away holds only where no contacts that touch could balance them.
void check_hold(const Run& run, Violations& found) {
  if (run.record.limit != Limit::centre_driven_away || material(run.scenario, "surface_energy") > 0.0) return;
  const Table& table = run.record.history;
  const std::size_t last = table.row_count() - 1;
  const auto step = static_cast<std::size_t>(table.at(last, *table.find("step"))) - 1;
  const Scene scene = make_scene(run.scenario);
  std::vector<std::pair<double, Eigen::Vector3d>> pushes;  // by prescribed forces, and their normals
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
    // Where contacts bear, they lift the surface of this law elsewhere: the overlap is no gap there.
    const double overlap = at_end("overlap");
    const bool touches = run.scenario.model == "nonlocal" ? regime != "open" || std::abs(overlap) <= touch
                                                          : overlap >= -touch && regime != "separated";
    if (const auto force = prescribed_force(scene.channels[c], step)) {
      // A little later, as others may have yet to begin.
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
  // Beside forces so much larger it is not seen whether the small ones can be balanced. Where contacts bear, they may
  // also give way.
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
  // Fixed steps control no error.
  if (run.integrator.used == "explicit") return;
  const bool is_conservative = is_elastic(run.scenario);
  // What integrators make of a law that keeps its energy is found where they are compared with the direct form, with
  // what the scene magnifies.
  if (is_conservative && run.integrator.used != "direct") return;
  // A law that gives back more than was put in has to say so.
  const bool is_warned = run.record.creates_energy;
  const double of_run = run.integrator.used == "direct" ? direct_work_tolerance(run) : own_tolerance(run);
  const double share = is_conservative ? k_direct_tolerance : k_tolerated_loss;
  const double most = (share + of_run) * scale + energy_floor(run);
  double highest = 0.0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const double lost = table.at(row, *work) - table.at(row, *stored);
    if (dissipation) {
      const double gap = lost - table.at(row, *dissipation);
      // Their sum is rounded once or twice.
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

/// How far the apparent radius of model mdr may fall, over R0. A contact of the ellipse that yields could bear more at
/// once, so that under a prescribed force n walls give way by some dx, and their caps of overlap d become smaller by
/// pi d (2 - d) dx; a step of Newton's method on the volume balance, of slope 4 pi (1 - n d/2), says by how much the
/// radius follows. A bound, because the walls give way by less where it does.
double most_fall_at_yield(const Scenario& scenario) {
  if (option(scenario, "elastic_profile") == "parabola") return 0.0;
  const mdr::Material law = mdr_material_of(scenario);
  const double d = law.yield_overlap_ratio;
  double count = 0.0;
  const Scene scene = make_scene(scenario);
  for (const ContactClass& c : scene.system->classes()) count += c.takes_force ? c.multiplicity() : 0;
  if (count == 0.0 || !std::isfinite(d)) return 0.0;
  const mdr::Contact before = mdr::elastic_contact(mdr::ElasticProfile::ellipse, law.composite_modulus, 1.0, d);
  const mdr::Contact after = mdr::plastic_contact(law, 1.0, d, mdr::yield_area_constant(d, 1.0));
  const double slope = 1.0 - 0.5 * count * d;
  if (!(after.by_overlap > 0.0 && slope > 0.0)) return std::numeric_limits<double>::infinity();
  return 0.25 * count * d * (2.0 - d) * (after.force - before.force) / (after.by_overlap * slope);
}

void check_ratchet(const Run& run, Violations& found) {
  const Table& table = run.record.history;
  const auto radius = table.find("apparent_radius");
  if (!radius) return;
  const double most = (most_fall_at_yield(run.scenario) + own_tolerance(run)) * run.scenario.radius;
  double largest = 0.0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const double now = table.at(row, *radius);
    if (largest - now > most) {
      found.push_back({"shrinking", fmt::format("apparent radius falls by {:.3g} R0, t = {:.9g} s",
                                                (largest - now) / run.scenario.radius, table.at(row, 0))});
      return;
    }
    largest = std::max(largest, now);
  }
}

/// Whether modes may answer each other without end: those of contacts that adhere to a free centre, or to a particle
/// that grows until one is touched and no longer while it is (README, "Limits").
bool may_go_on(const Run& run) {
  if (!(material(run.scenario, "surface_energy") > 0.0)) return false;
  if (run.scenario.loading.centre_is_free) return true;
  const Table& events = run.record.events;
  const auto name = *events.find("event");
  std::size_t ends = 0;
  for (std::size_t row = 0; row < events.row_count(); ++row) ends += events.word(row, name) == "growth-off" ? 1 : 0;
  return ends * k_most_events_between_ends >= k_most_events_per_step;
}

/// The reason of a failed run, if README's limits name it; else empty.
std::string stated_failure(const Run& run) {
  const RunRecord& record = run.record;
  if (!record.failure) return "";
  const Failure failure = *record.failure;
  if (run.integrator.used != "direct" && run.scenario.numerics.rtol < k_finest_rtol) return "tolerance of round-off";
  if (failure == Failure::endless_events || failure == Failure::chattering) {
    return may_go_on(run) ? "events without end" : "";
  }
  const bool is_too_much_work = failure == Failure::too_much_work;
  // A material by itself may be so stiff that no method is quick.
  const bool may_be_stiff = !suits_stiff_equations(run.integrator.used) || !find_model(run.scenario.model)->has_walls();
  if (is_too_much_work && may_be_stiff) return "stiff equations";
  if (!record.difficulty || (is_too_much_work && record.difficulty == Difficulty::soft_centre)) return "";
  return std::string(advice(*record.difficulty));
}

void check_events(const Run& run, Violations& found) {
  std::map<double, std::size_t> counts;
  const Table& events = run.record.events;
  const auto step = *events.find("step");
  const auto name = *events.find("event");
  for (std::size_t row = 0; row < events.row_count(); ++row) {
    // Caps that meet change nothing: a wall that comes in meets those of all others.
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

/// A run takes work in proportion to what it shows. Fixed steps are as many as the tolerance says, and methods that are
/// not made for stiff equations take many where these are; the program itself says when they are too many.
void check_work(const Run& run, Violations& found) {
  if (!suits_stiff_equations(run.integrator.used)) return;
  // As a method of order 4 needs more at a finer tolerance.
  const double finer = std::pow(std::max(1.0, 1e-8 / run.scenario.numerics.rtol), 0.25);
  const long most = run.integrator.used == "direct" ? k_most_work_direct : std::lround(k_most_work_integrated * finer);
  const Statistics& done = run.record.statistics;
  const long work = done.rhs_evaluations + done.guard_evaluations;
  const auto shown =
      static_cast<long>(run.record.history.row_count() + run.record.events.row_count() + step_count(run.scenario));
  if (work <= most * shown) return;
  found.push_back({"work", fmt::format("{} evaluations, {} for each of {} rows, events and steps, above {}", work,
                                       work / shown, shown, most)});
}

/// That a column's values only grow.
void check_growth(const Run& run, const char* name, double tolerance, Violations& found) {
  double largest = 0.0;
  check_rows(run, "shrinking", name, found, [&, place = *run.record.history.find(name)](const Table& table, auto row) {
    const double value = table.at(row, place);
    largest = std::max(largest, value);
    return largest - value - tolerance;
  });
}

void check_packing(const Run& run, Violations& found) {
  const Table& table = run.record.history;
  const double tolerance = own_tolerance(run);
  const auto fraction = *table.find("packing_fraction");
  check_rows(run, "density", "the packing fraction passes 1", found,
             [&](const Table& t, std::size_t row) { return t.at(row, fraction) - 1.0 - tolerance; });
  const auto stress = *table.find("stress");
  const double scale = largest_magnitude(table, stress);
  check_rows(run, "tension", "the packing pulls", found,
             [&](const Table& t, std::size_t row) { return -t.at(row, stress) - tolerance * scale; });
  const packing::Law law = packing_law_of(run.scenario);
  const double full = std::max(packing::full_plasticity(law), law.jamming);
  const auto regime = *table.find("regime");
  check_rows(run, "regime", "the regime does not belong to the packing fraction", found,
             [&](const Table& t, std::size_t row) {
               const std::string_view word = t.word(row, regime);
               const double phi = t.at(row, fraction);
               if (word == "unjammed") return phi / law.jamming - 1.0 - tolerance;
               return (word == "fully-plastic" ? full / phi : phi / full) - 1.0 - tolerance;
             });
  // It grows like a root from jamming on, and is compared by what it follows from.
  const auto coordination = *table.find("coordination_number");
  check_rows(run, "coordination", "the coordination number does not belong to the packing fraction", found,
             [&](const Table& t, std::size_t row) {
               const double number = t.at(row, coordination);
               if (std::isnan(number)) return -1.0;
               return std::abs(number / packing::coordination_number(law, t.at(row, fraction)) - 1.0) -
                      k_stress_rounding;
             });
  const auto plastic = *table.find("plastic_fraction");
  check_rows(run, "plastic-fraction", "the plastic fraction is not within 0 and 1", found,
             [&](const Table& t, std::size_t row) {
               return std::max(-t.at(row, plastic), t.at(row, plastic) - 1.0) - tolerance;
             });
  if (!is_elastic(run.scenario)) check_growth(run, "plastic_fraction", tolerance, found);
}

void check_material_point(const Run& run, Violations& found) {
  const Scenario& scenario = run.scenario;
  const Table& table = run.record.history;
  const double tolerance = own_tolerance(run);
  const bool is_compressible = option(scenario, "yield_model") != "vm";
  const double yield_pressure = material(scenario, "yield_pressure");
  // Stresses are moduli times strains; what is prescribed stands there without their rounding. Densities and strengths
  // follow from the plastic strain by itself.
  const compressible::Parameters law =
      compressible::parameters_from(scenario.material, option(scenario, "yield_model"));
  const auto phi = *table.find("phi");
  const double strain_rounding =
      k_stress_rounding * std::max(1.0, largest_magnitude(table, *table.find("strain_axial")));
  const auto at = [&](const Table& t, std::size_t row) { return compressible::properties_at(law, t.at(row, phi)); };
  const auto p = *table.find("p");
  const auto s = *table.find("s");
  const auto axial = *table.find("stress_axial");
  const auto lateral = *table.find("stress_lateral");
  const double scale = std::max(largest_magnitude(table, p), largest_magnitude(table, s));
  check_rows(
      run, "stress-invariants", "p and s do not belong to the axial and the lateral stress", found,
      [&](const Table& t, std::size_t row) {
        const double of_axial = t.at(row, p) + 2.0 / 3.0 * t.at(row, s) - t.at(row, axial);
        const double of_lateral = t.at(row, p) - t.at(row, s) / 3.0 - t.at(row, lateral);
        const compressible::Properties now = at(t, row);
        const double stiffness = yield_pressure * std::max({now.bulk_modulus.value, now.shear_modulus.value, 1.0});
        return std::max(std::abs(of_axial), std::abs(of_lateral)) - tolerance * scale - strain_rounding * stiffness;
      });
  const auto f = *table.find("yield_function");
  check_rows(run, "yield", "the stress is outside the yield surface", found, [&](const Table& t, std::size_t row) {
    const compressible::Properties now = at(t, row);
    const double of_p = t.at(row, p) / yield_pressure;
    const double of_s = t.at(row, s) / yield_pressure;
    const compressible::Yield y =
        compressible::yield_on(law, now, compressible::branch_at(law, now, of_p, of_s), of_p, of_s);
    const double by_strain =
        std::abs(y.f_p) * now.bulk_modulus.value + 3.0 * std::abs(y.f_s) * now.shear_modulus.value + std::abs(y.f_phi);
    return t.at(row, f) - tolerance - strain_rounding * by_strain;
  });
  if (!is_compressible) {
    check_growth(run, "phi", tolerance, found);
    return;
  }
  // Solid is neither made nor lost.
  const auto density = *table.find("relative_density");
  const auto volumetric = *table.find("plastic_strain_volumetric");
  const double initial = table.at(0, density);
  check_rows(run, "mass", "relative density and plastic strain do not belong together", found,
             [&](const Table& t, std::size_t row) {
               const double solid = t.at(row, density) * std::exp(t.at(row, volumetric));
               return std::abs(solid / initial - 1.0) - k_stress_rounding;
             });
  check_rows(run, "density", "the relative density passes 1", found,
             [&](const Table& t, std::size_t row) { return t.at(row, density) - 1.0 - tolerance; });
}

}  // namespace

double softest(const Scenario& scenario) {
  double least = std::numeric_limits<double>::infinity();
  for (const QuantityKey& key : find_model(scenario.model)->material) {
    const auto found = scenario.material.find(std::string(key.name));
    if (key.dimension == Dimension::stress && found != scenario.material.end() && found->second > 0.0) {
      least = std::min(least, found->second);
    }
  }
  return least;
}

bool is_elastic(const Scenario& scenario) {
  if (scenario.model == "packing") return !scenario.material.contains("hardening_modulus");
  return scenario.model == "hertz" || scenario.model == "nonlocal";
}

bool stays_elastic(const Run& run) {
  if (run.scenario.model != "material-point") return false;
  const Table& events = run.record.events;
  const auto event = *events.find("event");
  for (std::size_t row = 0; row < events.row_count(); ++row) {
    if (events.word(row, event) == "yield") return false;
  }
  return true;
}

std::size_t step_count(const Scenario& scenario) {
  std::size_t count = scenario.loading.steps.size();
  for (const WallSpec& wall : scenario.loading.walls) count = std::max(count, wall.steps.size());
  return count;
}

double direct_work_tolerance(const Run& run) {
  return run.integrator.used == "direct" ? k_direct_work * run.scenario.numerics.rtol : 0.0;
}

double own_tolerance(const Run& run) {
  if (run.integrator.used == "direct") return k_direct_tolerance;
  const auto steps = static_cast<double>(step_count(run.scenario));
  return std::max(k_rtol_multiple, k_rtol_multiple_of_step * steps) *
         std::max(run.scenario.numerics.rtol, k_finest_rtol);
}

double own_absolute_tolerance(const Run& run) {
  if (run.integrator.used == "direct") return k_stress_rounding;
  return own_tolerance(run) / run.scenario.numerics.rtol * run.scenario.numerics.atol;
}

std::vector<Violation> check_run(const Run& run) {
  Violations found;
  check_end(run, found);
  check_numbers(run, found);
  check_forces(run, found);
  check_hold(run, found);
  check_energy(run, found);
  check_ratchet(run, found);
  check_events(run, found);
  check_work(run, found);
  // Fixed steps control no error, and have none of these.
  if (run.integrator.used == "explicit") return found;
  check_program(run, found);
  if (run.scenario.model == "hertz") check_contacts(run, found);
  if (run.scenario.model == "packing") check_packing(run, found);
  if (run.scenario.model == "material-point") check_material_point(run, found);
  return found;
}

std::string stated_end(const Run& run) {
  const RunRecord& record = run.record;
  if (record.status == RunStatus::complete) return "complete";
  if (record.status == RunStatus::failed) return stated_failure(run);
  // Two sentences for one place: walls push the centre where forces do.
  if (record.limit == Limit::centre_driven_away) return std::string(code(Limit::centre_not_held));
  const bool is_stated = record.limit && record.limit != Limit::no_solution && record.limit != Limit::unequal_durations;
  return is_stated ? std::string(code(*record.limit)) : std::string();
}

}  // namespace monograin
