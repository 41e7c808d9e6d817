#include "verify/stress/draw/generator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <string>
#include <string_view>

#include "catalogue.hpp"
#include "engine/integrator.hpp"
#include "history/run.hpp"
#include "scenario/integrators.hpp"
#include "scene/scene.hpp"
#include "stress_test/draw.hpp"
#include "system/resolution.hpp"
#include "verify/stress/draw/programs.hpp"
#include "verify/stress/draw/walls.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

constexpr int k_most_cycles = 50;
// Tries to draw an admissible scene.
constexpr int k_most_tries = 200;

/// Draws a model for a scene, its configuration, material and options.
ProgramBounds draw_material(Dice& dice, StressScene& scene, const DrawnModels& models) {
  scene.model = *std::next(models.begin(), static_cast<std::ptrdiff_t>(dice.below(models.size())));
  const auto configurations = scene.model->configurations;
  scene.configuration = configurations.empty() ? "" : configurations[dice.below(configurations.size())];
  DrawnMaterial drawn{scene.configuration, scene.model->events, {}, {}};
  const ProgramBounds bounds = scene.model->draw(dice, drawn);
  scene.material = std::move(drawn.values);
  scene.options = std::move(drawn.options);
  return bounds;
}

/// Draws cycles of a program, except for a law without unloading, which cannot repeat a program.
void draw_cycles(Dice& dice, StressScene& scene, const ProgramBounds& bounds) {
  if (!dice.happens(0.15) || bounds.only_loads) return;
  scene.cycles = 2 + static_cast<int>(dice.below(static_cast<std::size_t>(k_most_cycles) - 1));
  scene.points = 3;
}

void draw_oblique_walls(Dice& dice, StressScene& scene) {
  const double least = std::max(scene.model->least_wall_angle, 1e-6);
  if (dice.happens(0.5)) scene.oblique_angle = dice.uniform(least, std::numbers::pi / 2.0 - least);
  if (dice.happens(0.1)) scene.oblique_angle = 1.000001 * least;
  if (dice.happens(0.5)) scene.oblique_walls = 4;
  // At a small angle, the four oblique walls are close to each other.
  if (scene.oblique_walls && scene.oblique_angle && 2.0 * *scene.oblique_angle < 1.01 * least) {
    scene.oblique_walls.reset();
  }
}

/// How the walls of a free set move.
struct FreeSet {
  std::size_t count = 0;  ///< number of steps
  bool have_own = false;  ///< every wall has a program of its own
  bool is_cell = false;   ///< the walls close a cell around the particle
};

void draw_free_walls(Dice& dice, StressScene& scene, const ProgramBounds& bounds, const FreeSet& set) {
  // All walls of a loose particle start with a gap.
  const bool is_loose = scene.centre_is_free && dice.happens(0.1);
  const double shared_gap = dice.happens(0.5) && !is_loose ? 0.0 : dice.log_uniform(1e-12, 0.1);
  // Walls end a step together: all of them take the durations of the first wall.
  std::vector<double> durations;
  for (const std::array<double, 3>& normal :
       set.is_cell ? draw_cell(dice) : draw_normals(dice, scene.model->least_wall_angle)) {
    StressWall wall{.name = fmt::format("w{}", scene.walls.size()), .normal = normal, .gap = 0.0};
    if (is_loose || dice.happens(0.4)) wall.gap = dice.happens(0.5) ? shared_gap : dice.uniform(0.0, 0.05);
    wall.is_fixed = !scene.walls.empty() && dice.happens(0.3);
    if (set.have_own && !wall.is_fixed) {
      wall.steps = draw_program(dice, scene, bounds, set.count, wall.gap, false, false);
      for (std::size_t i = 0; i < set.count; ++i) {
        if (durations.size() <= i) durations.push_back(wall.steps[i].pace);
        wall.steps[i].pace = durations[i];
      }
    }
    scene.walls.push_back(wall);
  }
}

void draw_loading(Dice& dice, StressScene& scene, const ProgramBounds& bounds) {
  const std::size_t count = 1 + dice.below(dice.happens(0.8) ? 4 : 10);
  if (!scene.model->has_walls()) {
    const DrawnMaterial drawn{scene.configuration, scene.model->events, {}, {}};
    scene.steps = stress_steps(scene.model->draw_program(dice, drawn, bounds, count));
    draw_cycles(dice, scene, bounds);
    return;
  }
  const bool are_free = scene.configuration == "walls";
  const bool have_own = are_free && dice.happens(0.5);
  const bool is_cell = are_free && dice.happens(0.2);
  if (scene.model->has_free_centre && dice.happens(is_cell ? 0.5 : 0.2)) scene.centre_is_free = true;
  if (scene.configuration == "oblique-die") draw_oblique_walls(dice, scene);
  if (!have_own) {
    // Free walls move by different distances, and at one rate they would not arrive together.
    scene.steps = draw_program(dice, scene, bounds, count, 0.0, !are_free, true);
    draw_cycles(dice, scene, bounds);
  }
  if (are_free) draw_free_walls(dice, scene, bounds, {count, have_own, is_cell});
}

// --- critical displacements and forces that a first run finds

struct Places {
  std::vector<StressStep> of_events;  ///< steps to the displacement of the first class at an event
  double largest_force = 0.0;         ///< in S R0^2
  double least_force = 0.0;           ///< in S R0^2
};

/// Runs a scene to find displacements at events, and extreme forces, of its first class. That class is always driven.
Places find_places(const StressScene& scene, const fs::path& tables) {
  StressScene first = scene;
  first.integrator = integrators::k_auto;
  const Run run = run_scenario(parse_stress_text(scenario_text(first), tables));
  const double force_unit = scene.stress * scene.radius * scene.radius;
  Places places;
  const std::string& name = run.classes.front().name;
  for (const double force : run.record.history.column(name + ".force")) {
    places.largest_force = std::max(places.largest_force, force / force_unit);
    places.least_force = std::min(places.least_force, force / force_unit);
  }
  const Table& events = run.record.events;
  const auto displacement = *events.find(name + ".displacement");
  const auto step = *events.find("step");
  const auto event = *events.find("event");
  for (std::size_t row = 0; row < events.row_count(); ++row) {
    if (events.word(row, event) == "step-end") continue;
    // Only the steps of the scene's common program are known here.
    const auto index = static_cast<std::size_t>(events.at(row, step)) - 1;
    if (index >= scene.steps.size() || scene.steps[index].kind != Step::Kind::displacement) continue;
    StressStep corner = scene.steps[index];
    corner.target = events.at(row, displacement) / scene.radius;
    if (std::isfinite(corner.target)) places.of_events.push_back(corner);
  }
  return places;
}

/// Raises targets that are below earlier ones, for a law without unloading.
void make_growing(std::vector<StressStep>& steps) {
  double displacement = 0.0;
  double force = 0.0;
  for (StressStep& step : steps) {
    if (step.kind == Step::Kind::displacement) step.target = displacement = std::max(displacement, step.target);
    if (step.kind == Step::Kind::force) step.target = force = std::max(force, step.target);
  }
}

/// Adds a corner of the program next to an event that a first run has passed, or a force next to its extreme force.
void refine(Dice& dice, StressScene& scene, const ProgramBounds& bounds, const fs::path& tables) {
  const Places places = find_places(scene, tables);
  if (!places.of_events.empty() && dice.happens(0.7)) {
    StressStep corner = places.of_events[dice.below(places.of_events.size())];
    const double round_off = k_epsilon * std::floor(dice.uniform(-4.0, 5.0));
    const double nearby = dice.one_of({0.0, 0.0, 1e-14, 1e-12, 1e-10, 1e-8}) * dice.uniform(-1.0, 1.0);
    corner.target *= 1.0 + round_off + nearby;
    corner.until.clear();
    corner.until_event.clear();
    // The new corner precedes the step that passed the event; the program then goes back or on.
    const auto after = std::ranges::find_if(scene.steps, [&](const StressStep& step) {
      return step.kind == corner.kind && step.pace == corner.pace && step.has_rate == corner.has_rate;
    });
    const auto place = scene.steps.insert(after, corner);
    if (!bounds.only_loads && dice.happens(0.5)) {
      StressStep back = corner;
      back.target -= dice.one_of({1e-14, 1e-6, 0.01, 0.3});
      scene.steps.insert(place + 1, back);
    }
    return;
  }
  const double extreme = dice.happens(0.5) && places.least_force < 0.0 ? places.least_force : places.largest_force;
  StressStep last;
  last.kind = Step::Kind::force;
  last.target = extreme * (1.0 + dice.one_of({-1.0, 1.0}) * dice.one_of({0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 0.1}));
  scene.steps.push_back(last);
}

bool is_admissible(const StressScene& scene, const fs::path& tables) {
  try {
    static_cast<void>(parse_stress_text(scenario_text(scene), tables));
    return true;
  } catch (const ScenarioError&) {
    return false;
  }
}

/// True if the direct form finds the state at any instant; also true if the scene is not admissible.
bool is_solvable(StressScene scene, const fs::path& tables) {
  scene.integrator = integrators::k_auto;
  try {
    return make_scene(parse_stress_text(scenario_text(scene), tables)).system->is_solvable();
  } catch (const std::exception&) {
    return true;
  }
}

/// Draws an integrator; the direct form only if the model has it.
std::string draw_integrator(Dice& dice, bool is_solvable) {
  const std::span<const std::string_view> all = integrator_names();
  const double what = dice.uniform(0.0, 1.0);
  if (what < 0.05) return integrators::k_auto;
  if (what < 0.3) return is_solvable ? integrators::k_direct : integrators::k_auto;
  const std::string drawn(all[dice.below(all.size())]);
  return drawn == integrators::k_direct && !is_solvable ? integrators::k_auto : drawn;
}

StressScene draw_scene(Dice& dice, const fs::path& tables, const DrawnModels& models) {
  StressScene scene;
  const ProgramBounds bounds = draw_material(dice, scene, models);
  scene.radius = !scene.model->has_walls() || dice.happens(0.5) ? 1.0 : dice.log_uniform(1e-9, 10.0);
  scene.stress = dice.happens(0.5) ? 1.0 : dice.log_uniform(1e3, 1e12);
  draw_loading(dice, scene, bounds);
  const bool has_direct_form = is_solvable(scene, tables);
  scene.integrator = draw_integrator(dice, has_direct_form);
  scene.rtol = dice.happens(0.5) ? 1e-8 : dice.log_uniform(1e-13, 1e-2);
  // Fixed steps are as many as 1/rtol.
  if (scene.integrator == integrators::k_forward_euler) scene.rtol = dice.log_uniform(1e-3, 1e-2);
  // If the reference has to be integrated, many cycles at a fine tolerance take minutes.
  if (!has_direct_form && scene.cycles > 1) {
    scene.cycles = std::min(scene.cycles, k_most_cycles / 5);
    scene.rtol = std::max(scene.rtol, 1e-8);
  }
  if (dice.happens(0.03)) scene.points = 0;
  const bool shares_steps = scene.model->has_walls() && scene.cycles == 1 && !scene.steps.empty();
  if (shares_steps && dice.happens(0.4) && is_admissible(scene, tables)) {
    refine(dice, scene, bounds, tables);
    if (bounds.only_loads) make_growing(scene.steps);
  }
  return scene;
}

}  // namespace

StressScene draw_stress_scene(std::uint64_t seed, std::uint64_t index, const fs::path& tables,
                              const DrawnModels& models) {
  if (models.empty()) {
    DrawnModels all;
    for (const Model& model : model_catalogue()) {
      if (model.draw != nullptr) all.insert(&model);
    }
    return draw_stress_scene(seed, index, tables, all);
  }
  Dice dice(seed, index);
  // If the parts of a scene do not fit together, the next scene of its sequence is drawn.
  for (int tries = 1;; ++tries) {
    StressScene scene = draw_scene(dice, tables, models);
    if (tries == k_most_tries || is_admissible(scene, tables)) return scene;
  }
}

}  // namespace monograin
