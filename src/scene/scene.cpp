#include "scene/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "catalogue.hpp"
#include "scene/mdr_law.hpp"
#include "scene/nonlocal_model.hpp"
#include "scene/plastic_law.hpp"

namespace monograin {
namespace {

std::vector<Wall> preset_walls(const Scenario& scenario) {
  const Loading& loading = scenario.loading;
  const bool is_hydrostatic = loading.configuration == Loading::Configuration::hydrostatic;
  const std::vector<Step> lateral_steps = is_hydrostatic ? loading.steps : std::vector<Step>{};
  const std::string lateral = is_hydrostatic ? "axial" : "lateral";
  std::vector<Wall> walls;
  const auto add_pair = [&](const std::string& name, const std::string& group, const Eigen::Vector3d& normal,
                            const std::vector<Step>& steps) {
    walls.push_back({name + "+", group, normal, 0.0, steps});
    walls.push_back({name + "-", group, -normal, 0.0, steps});
  };
  add_pair("axial-z", "axial", Eigen::Vector3d::UnitZ(), loading.steps);
  if (loading.configuration == Loading::Configuration::simple) return walls;
  add_pair(lateral + "-x", lateral, Eigen::Vector3d::UnitX(), lateral_steps);
  add_pair(lateral + "-y", lateral, Eigen::Vector3d::UnitY(), lateral_steps);
  if (loading.configuration == Loading::Configuration::oblique_die) {
    // In the y-z plane, the angle counted from y (003_97bacd62ecebe201.txt).
    const double c = std::cos(loading.oblique_angle);
    const double s = std::sin(loading.oblique_angle);
    add_pair("oblique-1", "oblique", {0.0, c, s}, {});
    if (loading.oblique_walls == 4) add_pair("oblique-2", "oblique", {0.0, c, -s}, {});
  }
  return walls;
}

std::string axis_of(const Eigen::Vector3d& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return axis == 0 ? "x" : axis == 1 ? "y" : "z";
}

/// Class names: the group's where it is one class, with its axis where symmetry splits it, else the first wall's.
std::vector<std::string> class_names(const std::vector<Wall>& walls, const std::vector<std::size_t>& first_wall) {
  std::vector<std::string> names;
  for (const std::size_t first : first_wall) {
    const std::string& group = walls[first].group;
    const auto in_group =
        std::ranges::count_if(first_wall, [&](std::size_t other) { return walls[other].group == group; });
    if (group.empty())
      names.push_back(walls[first].name);
    else if (in_group == 1)
      names.push_back(group);
    else
      names.push_back(group + "-" + axis_of(walls[first].normal));
  }
  std::vector<std::string> sorted = names;
  std::ranges::sort(sorted);
  if (std::ranges::adjacent_find(sorted) == sorted.end()) return names;
  // Not told apart by their axes (walls not merged at all): each class by its first wall.
  for (std::size_t c = 0; c < names.size(); ++c) names[c] = walls[first_wall[c]].name;
  return names;
}

/// How far a wall that is withdrawn so far is taken to reach into the particle: its contacts would have tolerances of
/// the order of what the particle bears there. So is one that is pulled where nothing adheres.
constexpr double k_share_of_withdrawal = 1e-4;

/// Factor within which laws say where a condition is met that does not tell it: what the last ramp may have led to
/// already need not end the next one.
constexpr double k_known_within = 3.0;

/// Whether a free centre may leave its place: classes of walls that push it to no side keep it there.
bool may_move_centre(const Scenario& scenario, const std::vector<ContactClass>& classes) {
  constexpr double k_no_push = 1e-6;  // of unit normals
  return scenario.loading.centre_is_free && std::ranges::any_of(classes, [](const ContactClass& c) {
           Eigen::Vector3d sum = Eigen::Vector3d::Zero();
           for (const Eigen::Vector3d& normal : c.normals) sum += normal;
           return sum.norm() > k_no_push * c.multiplicity();
         });
}

/// How far a condition lets a ramp go that leads on to its target; infinity where the model has to be run to say so.
Reach end_of(const Scenario& scenario, bool centre_moves, const Until& until) {
  Reach end{.displacement = std::numeric_limits<double>::infinity(), .force = std::numeric_limits<double>::infinity()};
  if (!(until.value > 0.0) && until.quantity != Until::Quantity::event) return end;
  if (is_plastic(scenario.model)) return plastic_reach(scenario, until);
  if (scenario.model == "mdr" || scenario.model == "hertz") end = mdr_reach(scenario, until);
  if (scenario.model == "nonlocal") end = nonlocal_reach(scenario, until);
  // The centre goes along: its walls go farther than their contacts.
  if (centre_moves) end.displacement = std::numeric_limits<double>::infinity();
  if (until.quantity == Until::Quantity::displacement) end.displacement = until.value;
  if (until.quantity == Until::Quantity::force) end.force = until.value;
  return end;
}

/// Number of steps up to one that ends every run that comes to it: walls of the nonlocal law cannot pull.
std::size_t count_to_pull(const Scenario& scenario, const std::vector<Channel>& channels) {
  std::size_t count = 0;
  for (const Channel& channel : channels) count = std::max(count, channel.program.size());
  if (scenario.model != "nonlocal") return count;
  for (std::size_t k = 0; k < count; ++k) {
    bool pulls = false;
    bool may_end_before = false;  // a condition on one wall ends the step of all
    for (const Channel& channel : channels) {
      if (k >= channel.program.size()) continue;
      const Step& step = channel.program[k];
      pulls = pulls || (step.kind == Step::Kind::force && step.target < 0.0);
      may_end_before = may_end_before || !step.until.empty();
    }
    if (pulls && !may_end_before) return k + 1;
  }
  return count;
}

/// Largest displacement or force of the programs.
double largest_target(const Scenario& scenario, const Scene& scene, Step::Kind kind) {
  double largest = 0.0;
  const std::vector<Channel>& channels = scene.channels;
  const bool centre_moves = may_move_centre(scenario, scene.classes);
  const auto energy = scenario.material.find("surface_energy");
  const bool adheres = energy != scenario.material.end() && energy->second > 0.0;
  const bool is_displacement = kind == Step::Kind::displacement;
  // Steps that a run comes to: what lies beyond would make tolerances as large as what is reached.
  std::size_t count = count_to_pull(scenario, channels);
  for (const Channel& channel : channels) {
    const std::size_t first = first_without_branch(scenario, channel.program);
    if (first < channel.program.size()) count = std::min(count, first);
  }
  for (const Channel& channel : channels) {
    double before = 0.0;  // where the last ramp of this kind has led, at most
    for (const Step& step : std::span(channel.program).first(std::min(count, channel.program.size()))) {
      if (step.kind == Step::Kind::hold) continue;
      if (step.kind != kind) {
        before = 0.0;
        continue;
      }
      const bool is_withdrawal = step.target < 0.0 && (is_displacement || !adheres);
      double reach = (is_withdrawal ? k_share_of_withdrawal : 1.0) * std::abs(step.target);
      for (const Until& until : step.until) {
        // Later steps may begin beyond an event, or a value, which then does not end them.
        if (until.quantity == Until::Quantity::event && &step != &channel.program.front()) continue;
        const Reach end = end_of(scenario, centre_moves, until);
        const double place = is_displacement ? end.displacement : end.force;
        const bool is_exact =
            until.quantity == (is_displacement ? Until::Quantity::displacement : Until::Quantity::force);
        if (place > (is_exact ? 1.0 : k_known_within) * before) reach = std::min(reach, place);
      }
      before = is_withdrawal ? 0.0 : reach;
      largest = std::max(largest, reach);
    }
  }
  return largest;
}

/// Contact classes of the walls and their channels.
void add_walls(const Scenario& scenario, bool merges_walls, Scene& scene) {
  const std::vector<Wall> walls = make_walls(scenario);
  std::vector<std::size_t> class_of(walls.size());
  if (merges_walls) {
    class_of = symmetry_classes(walls);
  } else {
    for (std::size_t i = 0; i < walls.size(); ++i) class_of[i] = i;
  }
  const std::size_t class_count = walls.empty() ? 0 : *std::ranges::max_element(class_of) + 1;
  std::vector<std::size_t> first_wall(class_count, walls.size());
  for (std::size_t i = walls.size(); i-- > 0;) first_wall[class_of[i]] = i;

  scene.classes.resize(class_count);
  scene.walls.resize(class_count);
  const std::vector<std::string> names = class_names(walls, first_wall);
  for (std::size_t i = 0; i < walls.size(); ++i) {
    scene.classes[class_of[i]].normals.push_back(walls[i].normal);
    scene.walls[class_of[i]].push_back(walls[i].name);
  }
  for (std::size_t c = 0; c < class_count; ++c) {
    scene.classes[c].name = names[c];
    scene.classes[c].gap = walls[first_wall[c]].gap;
    const double start = 0.0 - scene.classes[c].gap;  // not -0
    scene.channels.push_back({names[c], {start, start, Control::displacement}, walls[first_wall[c]].steps});
    scene.classes[c].takes_force =
        std::ranges::any_of(scene.channels[c].program, [](const Step& step) { return step.kind == Step::Kind::force; });
  }
  if (class_count < walls.size()) {
    std::vector<std::string> parts;
    for (const ContactClass& c : scene.classes) parts.push_back(fmt::format("{} x{}", c.name, c.normals.size()));
    scene.skipped.push_back(fmt::format("{} of {} walls, the same by symmetry: {}", walls.size() - class_count,
                                        walls.size(), fmt::join(parts, ", ")));
  }
}

}  // namespace

std::size_t Scene::step_count() const noexcept {
  std::size_t count = 0;
  for (const Channel& channel : channels) count = std::max(count, channel.program.size());
  return count;
}

std::vector<Wall> make_walls(const Scenario& scenario) {
  if (scenario.loading.configuration != Loading::Configuration::walls) return preset_walls(scenario);
  std::vector<Wall> walls;
  for (const WallSpec& spec : scenario.loading.walls) {
    const Eigen::Vector3d normal(spec.normal[0], spec.normal[1], spec.normal[2]);
    const std::vector<Step>& steps = spec.steps.empty() ? scenario.loading.steps : spec.steps;
    walls.push_back({spec.name, "", normal.stableNormalized(), spec.gap, spec.is_fixed ? std::vector<Step>{} : steps});
  }
  return walls;
}

Scene make_scene(const Scenario& scenario, bool merges_walls) {
  const bool has_walls = find_model(scenario.model)->has_walls();
  Scene scene;
  if (has_walls)
    add_walls(scenario, merges_walls, scene);
  else
    scene.channels = channels_without_walls(scenario);
  scene.system = bind_model(scenario, scene.classes,
                            {.displacement = largest_target(scenario, scene, Step::Kind::displacement),
                             .force = largest_target(scenario, scene, Step::Kind::force)});

  const auto unknowns = scene.system->unknowns();
  const auto is_algebraic = [](const Unknown& u) { return u.kind == Unknown::Kind::algebraic; };
  const bool takes_force = std::ranges::any_of(scene.classes, &ContactClass::takes_force);
  if (has_walls && !takes_force && std::ranges::none_of(unknowns, is_algebraic)) {
    scene.skipped.emplace_back(scenario.loading.centre_is_free
                                   ? "algebraic unknowns: by symmetry the wall forces balance on the centre at rest"
                                   : "algebraic unknowns: displacements are prescribed and the centre is fixed");
  }
  if (const auto energy = scenario.material.find("surface_energy");
      energy != scenario.material.end() && energy->second == 0.0) {
    scene.skipped.emplace_back("adhesion: the surface energy is zero");
  }
  if (scenario.model == "hertz")
    scene.skipped.emplace_back("yield and growth of the apparent radius: not part of the model");
  scene.skipped.emplace_back("guards that cannot fire before the end of a step");
  scene.skipped.emplace_back("observables between output points");
  return scene;
}

}  // namespace monograin
