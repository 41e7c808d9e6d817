// Random scenes of the MDR model: properties that hold for all walls, programs and materials.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <initializer_list>
#include <iostream>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stress_test/dice.hpp"
#include "support/test_run.hpp"

namespace monograin::random_scenes_test {
namespace {

// --- the scenes

Eigen::Vector3d direction(Dice& dice) {
  const double z = dice.uniform(-1.0, 1.0);
  const double angle = dice.uniform(0.0, 2.0 * std::numbers::pi);
  const double rho = std::sqrt(1.0 - z * z);
  return {rho * std::cos(angle), rho * std::sin(angle), z};
}

// Largest displacement of a wall; soft and well confined scenes meet their limits before.
constexpr double k_deepest = 0.35;
constexpr double k_least_angle = 40.0 * std::numbers::pi / 180.0;

/// Ramps in and out, partly by force, partly to tension; holds in between. Steps of one second.
std::vector<Step> random_program(Dice& dice, std::size_t steps, double yield_stress, double surface_energy) {
  std::vector<Step> program;
  double deepest = 0.0;
  for (std::size_t i = 0; i < steps; ++i) {
    const double what = dice.uniform(0.0, 1.0);
    if (what < 0.35) {
      // One throw in each statement: within an expression compilers differ in their order.
      const double largest = yield_stress * dice.one_of<double>({0.1, 0.5, 1.0, 2.0});
      const double force = dice.uniform(0.0, largest);
      const bool pulls = dice.happens(0.2);
      // Loads beside pull-off, which is at 4.7 dg R under force.
      const double tension = surface_energy > 0.0 ? dice.uniform(0.0, 7.0) * surface_energy : 0.3 * force;
      program.push_back(force_ramp(pulls ? -tension : force));
    } else if (what < 0.45) {
      program.push_back(hold());
    } else {
      const double back = dice.one_of<double>({0.008, 0.04, 0.2, 0.4});
      const bool goes_in = i % 2 == 0;
      const double target = goes_in ? dice.uniform(0.8 * deepest, k_deepest) : deepest - dice.uniform(0.0, back);
      deepest = std::max(deepest, target);
      program.push_back(ramp(target));
    }
  }
  return program;
}

std::vector<Eigen::Vector3d> random_normals(Dice& dice) {
  std::vector<Eigen::Vector3d> normals;
  const std::size_t count = 2 + dice.below(5);
  while (normals.size() < count) {
    const Eigen::Vector3d candidate = direction(dice);
    const bool is_apart = std::ranges::all_of(
        normals, [&](const Eigen::Vector3d& n) { return candidate.dot(n) < std::cos(k_least_angle); });
    if (is_apart) normals.push_back(candidate);
  }
  return normals;
}

CheckedScenario random_scenario(std::uint64_t seed) {
  Dice dice(seed);
  const double modulus_over_yield = dice.log_uniform(6.0, 1e4);
  const double poisson_ratio = dice.one_of<double>({0.0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.49, 0.5});
  const double surface_energy = dice.happens(0.6) ? dice.log_uniform(1e-9, 1e-3) : 0.0;
  const auto configuration =
      dice.one_of<Configuration>({Configuration::simple, Configuration::die, Configuration::hydrostatic,
                                  Configuration::oblique_die, Configuration::walls});
  CheckedScenario scenario = mdr_scenario(configuration, modulus_over_yield, poisson_ratio, {});
  scenario.name = fmt::format("seed {}", seed);
  scenario.material["surface_energy"] = surface_energy;
  scenario = with(scenario, "radius_rule", dice.one_of<const char*>({"gated", "yielded", "seed"}));
  scenario = with(scenario, "elastic_profile", dice.one_of<const char*>({"ellipse", "parabola"}));
  scenario = with(scenario, "delta_max_rule", dice.one_of<const char*>({"running-maximum", "shifted"}));
  scenario.loading.oblique_angle = 45.0 * std::numbers::pi / 180.0;
  const std::size_t steps = 2 + dice.below(4);
  const auto program = [&] { return random_program(dice, steps, 1.0 / modulus_over_yield, surface_energy); };
  if (configuration != Configuration::walls) {
    scenario.loading.steps = program();
    return with_points(scenario, 20);
  }
  std::vector<WallSpec> walls;
  for (const Eigen::Vector3d& normal : random_normals(dice)) {
    const double gap = dice.happens(0.3) ? dice.uniform(0.0, 0.05) : 0.0;
    const bool is_fixed = !walls.empty() && dice.happens(0.3);
    walls.push_back(wall(fmt::format("w{}", walls.size()), normal, is_fixed ? std::vector<Step>{} : program(), gap));
  }
  return with_points(between(std::move(scenario), std::move(walls)), 20);
}

std::string option(const CheckedScenario& scenario, const std::string& name) {
  return std::get<std::string>(scenario.options.at(name));
}

// --- checks of a run

/// Scenes that break a rule, each with its seed.
class Breaches {
 public:
  void add(std::uint64_t seed, const std::string& what) { lines_.push_back(fmt::format("seed {}: {}", seed, what)); }
  [[nodiscard]] std::size_t count() const noexcept { return lines_.size(); }
  [[nodiscard]] std::string text() const { return fmt::format("{}\n", fmt::join(lines_, "\n")); }

 private:
  std::vector<std::string> lines_;
};

/// Limits of the model at which a run may end, in the words of its messages.
constexpr std::array<std::string_view, 9> k_limits{
    "the free surface of the particle is used up",
    "singular growth of the apparent radius",
    "the volume balance of the growing radius has no solution nearby",
    "the particle is compressed elastically to half its volume",
    "elastic compression to less than half the volume",
    "a wall has reached the centre of the particle",
    "the wall has reached the centre of the particle",
    "the largest that a plastic contact bears",
    "overlap above twice the apparent radius",
};

/// End of a run: complete, the limit that it met, or a failure.
std::string end_of(const TestRun& result) {
  if (result.record.status == RunStatus::complete) return "complete";
  const std::string& message = result.record.message;
  const auto names_it = [&](std::string_view limit) { return message.find(limit) != std::string::npos; };
  const auto found = std::ranges::find_if(k_limits, names_it);
  if (result.record.status == RunStatus::failed || found == k_limits.end()) return {};
  return std::string(*found);
}

/// First position in a table without a number.
std::string place_without_number(const Table& table) {
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    for (std::size_t c = 0; c < table.columns().size(); ++c) {
      if (!std::isfinite(table.at(row, c))) return fmt::format("{} in row {}", table.columns()[c].name, row);
    }
  }
  return {};
}

/// True if there is an event with a name at a time; of any class, or of a given one.
bool has_event_at(const TestRun& result, std::string_view name, double time, std::string_view contact_class = {}) {
  const Table& table = result.record.events;
  for (std::size_t i = 0; i < table.row_count(); ++i) {
    if (table.word(i, *table.find("event")) == name && table.at(i, *table.find("time")) == time &&
        (contact_class.empty() || table.word(i, *table.find("class")) == contact_class))
      return true;
  }
  return false;
}

/// Largest deviation from work = stored energy + dissipation, over the largest of these.
double energy_gap(const TestRun& result) {
  const auto work = result.column("work");
  const auto stored = result.column("stored_energy");
  const auto dissipation = result.column("dissipation");
  const double scale = std::max({largest(work), largest(stored), largest(dissipation)});
  double worst = 0.0;
  for (std::size_t row = 0; row < work.size(); ++row) {
    const double gap = std::abs(work[row] - stored[row] - dissipation[row]) / (scale > 0.0 ? scale : 1.0);
    if (!(gap <= worst)) worst = gap;
  }
  return worst;
}

struct Shrinking {
  double after_yield = 0.0;  ///< largest decrease from the row before a yield to the one after it, or to the next
  double elsewhere = 0.0;
};

/// Decreases of the apparent radius from one row to the next.
Shrinking shrinking(const TestRun& result) {
  const auto times = result.column("time");
  const auto radius = result.column("apparent_radius");
  Shrinking largest;
  for (std::size_t row = 1; row < radius.size(); ++row) {
    const double decrease = radius[row - 1] - radius[row];
    if (decrease <= 0.0) continue;
    double& place = has_event_at(result, "yield", times[row - 1]) ? largest.after_yield : largest.elsewhere;
    place = std::max(place, decrease);
  }
  return largest;
}

struct Losses {
  double least = 0.0;      ///< of the dissipation
  double at_yield = 0.0;   ///< largest decrease from just before a yield to the next row
  double elsewhere = 0.0;  ///< largest decrease from one row to another
};

/// Decreases of the dissipation, over the largest energy, while the caps of the contacts are apart.
Losses losses(const TestRun& result) {
  const auto times = result.column("time");
  const auto dissipation = result.column("dissipation");
  const double scale = std::max(largest(result.column("work")), largest(result.column("stored_energy")));
  const double caps = result.time_of("caps-intersect");
  Losses losses;
  if (scale == 0.0) return losses;
  std::size_t before = 0;
  for (std::size_t row = 0; row < dissipation.size(); ++row) {
    losses.least = std::min(losses.least, dissipation[row] / scale);
    if (times[row] > caps) continue;
    double& place = has_event_at(result, "yield", times[before]) ? losses.at_yield : losses.elsewhere;
    place = std::min(place, (dissipation[row] - dissipation[before]) / scale);
    before = row;
  }
  return losses;
}

/// Largest deviation of a closed contact's force from its program, over the largest prescribed force.
double distance_from_program(const TestRun& result) {
  const Table& table = result.record.history;
  const auto times = result.column("time");
  const auto steps = result.column("step");
  const auto rows = result.column("row");
  double worst = 0.0;
  for (std::size_t c = 0; c < result.scene.classes.size(); ++c) {
    const std::vector<Step>& program = result.scene.channels[c].program;
    const std::string& name = result.scene.classes[c].name;
    const auto forces = result.column(name + ".force");
    const std::size_t regime = *table.find(name + ".regime");
    double scale = 0.0;
    for (const Step& step : program) {
      if (step.kind == Step::Kind::force) scale = std::max(scale, std::abs(step.target));
    }
    if (scale == 0.0) continue;
    scale = std::max(scale, largest(forces));
    const auto is_closed = [&](std::size_t row) {
      const std::string_view word = table.word(row, regime);
      return word != "open" && word != "separated";
    };
    bool is_by_force = false;
    double start = 0.0;
    double end = 0.0;
    for (std::size_t row = 0; row < times.size(); ++row) {
      const auto step = static_cast<std::size_t>(steps[row]) - 1;
      if (row == 0 || steps[row] != steps[row - 1]) {
        // A ramp of the force starts from the present force; a lost wall carries none.
        if (is_by_force && row > 0) start = is_closed(row - 1) ? end : 0.0;
        if (!is_by_force) start = row > 0 ? forces[row - 1] : 0.0;
        if (program[step].kind != Step::Kind::hold) is_by_force = program[step].kind == Step::Kind::force;
        end = program[step].kind == Step::Kind::force ? program[step].target : start;
      }
      if (!is_by_force || !is_closed(row)) continue;
      // Just after a yield the force has jumped, and its wall has not yet moved on.
      if (rows[row] == 1.0 && has_event_at(result, "yield", times[row], name)) continue;
      const double expected = std::lerp(start, end, times[row] - static_cast<double>(step));
      const double distance = std::abs(forces[row] - expected) / scale;
      if (!(distance <= worst)) worst = distance;
    }
  }
  return worst;
}

// --- scenes solved at every instant

/// Compares a measured value of one scene with its largest allowed value.
void check(std::uint64_t seed, const char* what, double value, double most, Breaches& breaches) {
  if (!(value <= most)) breaches.add(seed, fmt::format("{} {:.3g}, above {:.3g}", what, value, most));
}

void check_rules(std::uint64_t seed, const CheckedScenario& scenario, const TestRun& result, Breaches& breaches) {
  const auto expect_at_most = [&](const char* what, double value, double most) {
    check(seed, what, value, most, breaches);
  };
  const std::string place = place_without_number(result.record.history);
  if (!place.empty()) breaches.add(seed, "no number in " + place);
  expect_at_most("energy gap", energy_gap(result), 1e-15);  // 3.3e-16: one rounding
  // 1.1e-12: round-off of the overlap on a steep unloading branch.
  expect_at_most("distance from the prescribed force", distance_from_program(result), 1e-11);

  // With the ellipse the force jumps up at yield. Under force control the wall then retreats, and the radius follows to
  // keep the volume: by 2.6e-4 R0 at most for E/Y from 10 on, and by 1.6e-3 R0 below, where yield comes late.
  const bool jumps = option(scenario, "elastic_profile") == "ellipse";
  const bool is_soft = scenario.material.at("yield_stress") > 0.1;
  const Shrinking shrunk = shrinking(result);
  expect_at_most("shrinking", shrunk.elsewhere,
                 2.0 * std::numeric_limits<double>::epsilon());  // R is a root, found but for rounding
  expect_at_most("shrinking after a yield", shrunk.after_yield, jumps ? (is_soft ? 2e-3 : 3e-4) : 0.0);

  if (option(scenario, "radius_rule") != "yielded") return;
  const Losses lost = losses(result);
  expect_at_most("dissipation below zero", -lost.least, 1e-14);  // 2e-15: rounding of the work
  // 5e-13: where a wall changes from force to displacement control, the round-off of its force enters the work.
  expect_at_most("loss of dissipation", -lost.elsewhere, 1e-12);
  // A yield turns lost surface energy into recoverable energy: 2.6e-4. A wall under force that retreats takes work
  // back: 1.6e-5. Elsewhere the law loses up to 1.6e-8 where E/Y is above 150.
  const bool adheres = scenario.material.at("surface_energy") > 0.0;
  expect_at_most("loss of dissipation at a yield", -lost.at_yield, adheres ? 5e-4 : jumps ? 2e-5 : 2e-8);
}

TEST(MdrRandomScenes, KeepTheRulesOfTheModel) {
  constexpr std::uint64_t k_scenes = 2000;
  std::map<std::string, int> ends;
  Breaches failures;
  Breaches breaches;
  for (std::uint64_t seed = 1; seed <= k_scenes; ++seed) {
    const CheckedScenario scenario = random_scenario(seed);
    try {
      const TestRun result = run(scenario);
      const std::string end = end_of(result);
      if (end.empty()) {
        failures.add(seed, result.record.message);
        continue;
      }
      ++ends[end];
      check_rules(seed, scenario, result, breaches);
    } catch (const std::exception& error) {
      failures.add(seed, fmt::format("exception: {}", error.what()));
    }
  }
  std::string summary;
  for (const auto& [end, count] : ends) summary += fmt::format("{} scenes: {}\n", count, end);
  std::cout << summary;
  // No scene may have a regime search without an end, a solver that fails, an exception, or an unknown message.
  EXPECT_EQ(failures.count(), 0U) << failures.text();
  EXPECT_EQ(breaches.count(), 0U) << breaches.text();
  // Nearly all scenes have to be complete: of 2000, 1804 are, 193 use up the free surface, 3 lose half the volume.
  EXPECT_GE(ends["complete"], 1790) << summary;
}

// --- scenes solved in every form

struct Distance {
  double state = 0.0;  ///< of forces, overlaps and the apparent radius, each over the largest of its kind
  double work = 0.0;   ///< over the largest work
};

/// Distance of two runs at their common output points.
Distance distance(const TestRun& actual, const TestRun& expected) {
  const auto largest_difference = [](const std::vector<double>& a, const std::vector<double>& b) {
    double worst = 0.0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
      if (!(std::abs(a[i] - b[i]) <= worst)) worst = std::abs(a[i] - b[i]);
    }
    return worst;
  };
  const auto over = [](double value, double scale) { return scale > 0.0 ? value / scale : value; };
  Distance result;
  result.work =
      over(largest_difference(actual.outputs("work"), expected.outputs("work")), largest(expected.outputs("work")));
  result.state = largest_difference(actual.outputs("apparent_radius"), expected.outputs("apparent_radius"));
  for (const char* name : {"force", "overlap"}) {
    const auto a = actual.outputs_by_class(name);
    const auto b = expected.outputs_by_class(name);
    double worst = 0.0;
    double scale = 0.0;
    for (std::size_t c = 0; c < b.size(); ++c) {
      if (!(largest_difference(a[c], b[c]) <= worst)) worst = largest_difference(a[c], b[c]);
      scale = std::max(scale, largest(b[c]));
    }
    if (!(over(worst, scale) <= result.state)) result.state = over(worst, scale);
  }
  return result;
}

TEST(MdrRandomScenes, AllFormsAgree) {
  constexpr std::uint64_t k_scenes = 500;
  constexpr double k_rtol = Tolerances{}.rtol;
  Breaches other_ends;
  Breaches other_events;
  Breaches distances;
  for (std::uint64_t seed = 1; seed <= k_scenes; ++seed) {
    const CheckedScenario scenario = random_scenario(seed);
    try {
      const TestRun direct = run(scenario);
      bool has_other_events = false;
      for (const char* integrator : k_integrators) {
        if (std::string_view(integrator) == "direct") continue;
        const TestRun other = run(scenario, integrator);
        if (end_of(other) != end_of(direct)) {
          other_ends.add(seed, fmt::format("{}: {} | {}", integrator, other.record.message, direct.record.message));
        }
        has_other_events = has_other_events || other.events() != direct.events();
        const Distance apart = distance(other, direct);
        // The integrated work is exact to ten rtol; the low order of BDF adds steps, and 1.93e-7 is measured.
        const double most_work = (std::string_view(integrator) == "cvode-adams" ? 10.0 : 20.0) * k_rtol;
        // In runs that continue until the radius runs away, errors grow without bound: 1.7e-6.
        const double most = direct.record.status == RunStatus::complete ? 1e-6 : 1e-5;
        check(seed, fmt::format("{}, work", integrator).c_str(), apart.work, most_work, distances);
        check(seed, fmt::format("{}, state", integrator).c_str(), apart.state, most, distances);
      }
      if (has_other_events) other_events.add(seed, describe(scenario));
    } catch (const std::exception& error) {
      other_ends.add(seed, fmt::format("exception: {}", error.what()));
    }
  }
  EXPECT_EQ(other_ends.count(), 0U) << other_ends.text();
  EXPECT_EQ(distances.count(), 0U) << distances.text();
  // Seeds 131, 153, 401 and 411: growth stops or starts within 1e-9 of a step, the accuracy of a located event, of
  // another change. One form then has one more change in between than the other; the numbers agree.
  std::cout << fmt::format("{} scenes with other events\n{}", other_events.count(), other_events.text());
  EXPECT_LE(other_events.count(), 4U) << other_events.text();
}

}  // namespace
}  // namespace monograin::random_scenes_test
