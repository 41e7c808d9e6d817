#include "scene/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "catalogue.hpp"
#include "scenario/model_input.hpp"
#include "scene/program_reach.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

std::vector<Wall> preset_walls(const CheckedScenario& scenario) {
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
    // In the y-z plane, the angle counted from y (Agarwal and Gonzalez, 2018).
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

/// Names of classes: that of a group if the group is one class, with the axis if symmetry splits the group, else that
/// of the first wall.
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
  // If axes do not distinguish the classes (walls are not merged at all), each class is named after its first wall.
  for (std::size_t c = 0; c < names.size(); ++c) names[c] = walls[first_wall[c]].name;
  return names;
}

/// True if a free centre may move: it stays at rest if the normals of every class add up to zero.
bool may_move_centre(const CheckedScenario& scenario, const std::vector<ContactClass>& classes) {
  return scenario.loading.centre_is_free && std::ranges::any_of(classes, [](const ContactClass& c) {
           Eigen::Vector3d sum = Eigen::Vector3d::Zero();
           for (const Eigen::Vector3d& normal : c.normals) sum += normal;
           return sum.norm() > k_no_direction * c.multiplicity();
         });
}

/// Channels of a model without walls. A lateral one follows the steps, and takes as long as they do.
std::vector<Channel> channels_without_walls(const CheckedScenario& scenario,
                                            const std::vector<RestingChannel>& at_rest) {
  std::vector<Channel> channels;
  for (const RestingChannel& rest : at_rest) {
    Channel& channel = channels.emplace_back(Channel{std::string(rest.name), rest.at_rest, {}});
    if (!rest.is_lateral) {
      channel.program = scenario.loading.steps;
      continue;
    }
    for (const Step& step : scenario.loading.steps) {
      Step follows;
      if (step.lateral) {
        follows.kind = step.lateral->kind;
        follows.target = step.lateral->target;
      }
      channel.program.push_back(std::move(follows));
    }
  }
  return channels;
}

/// Makes a corner of every program where one of them has a corner: rows do not depend on which wall is named first.
void share_corners(std::vector<Channel>& channels) {
  std::size_t count = 0;
  for (const Channel& channel : channels) count = std::max(count, channel.program.size());
  for (std::size_t k = 0; k < count; ++k) {
    const auto has_leg = [k](const Channel& channel) { return k < channel.program.size(); };
    const bool is_corner = std::ranges::any_of(
        channels, [&](const Channel& channel) { return has_leg(channel) && channel.program[k].leg.is_corner; });
    for (Channel& channel : channels) {
      if (has_leg(channel)) channel.program[k].leg.is_corner = is_corner;
    }
  }
}

/// Adds the contact classes of the walls, and their channels, to a scene.
void add_walls(const CheckedScenario& scenario, bool merges_walls, Scene& scene) {
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
  share_corners(scene.channels);
  if (class_count < walls.size()) {
    std::vector<std::string> parts;
    for (const ContactClass& c : scene.classes) parts.push_back(fmt::format("{} x{}", c.name, c.normals.size()));
    scene.skipped.push_back(fmt::format("{} of {} walls, the same by symmetry: {}", walls.size() - class_count,
                                        walls.size(), fmt::join(parts, ", ")));
  }
}

}  // namespace

std::span<const Step> Scene::longest_program() const noexcept {
  std::span<const Step> longest;
  for (const Channel& channel : channels) {
    if (channel.program.size() > longest.size()) longest = channel.program;
  }
  return longest;
}

std::size_t Scene::channel_of(std::string_view wall) const {
  for (std::size_t c = 0; c < walls.size(); ++c) {
    if (channels[c].name == wall || std::ranges::find(walls[c], wall) != walls[c].end()) return c;
  }
  // Where walls are not merged, each of a preset class is a class of its own.
  const auto is_of_class = [&](const std::vector<std::string>& names) { return names.front().starts_with(wall); };
  return static_cast<std::size_t>(std::ranges::find_if(walls, is_of_class) - walls.begin());
}

std::vector<Wall> make_walls(const CheckedScenario& scenario) {
  if (scenario.loading.configuration != Loading::Configuration::walls) return preset_walls(scenario);
  std::vector<Wall> walls;
  for (const WallSpec& spec : scenario.loading.walls) {
    const Eigen::Vector3d normal(spec.normal[0], spec.normal[1], spec.normal[2]);
    const std::vector<Step>& steps = spec.steps.empty() ? scenario.loading.steps : spec.steps;
    walls.push_back({spec.name, "", normal.stableNormalized(), spec.gap, spec.is_fixed ? std::vector<Step>{} : steps});
  }
  return walls;
}

Scene make_scene(const CheckedScenario& scenario, bool merges_walls) {
  const Model& model = *find_model(scenario.model);
  const ModelInput input = model_input(scenario);
  const bool has_walls = model.has_walls();
  Scene scene;
  if (has_walls)
    add_walls(scenario, merges_walls, scene);
  else
    scene.channels = channels_without_walls(scenario, model.channels(input));
  const bool moves_centre = may_move_centre(scenario, scene.classes);
  scene.system = model.bind(input, scene.classes, program_reach(model, input, scene.channels, moves_centre));

  const auto unknowns = scene.system->unknowns();
  const auto is_algebraic = [](const Unknown& u) { return u.kind == Unknown::Kind::algebraic; };
  const bool takes_force = std::ranges::any_of(scene.classes, &ContactClass::takes_force);
  if (has_walls && !takes_force && std::ranges::none_of(unknowns, is_algebraic)) {
    scene.skipped.emplace_back(scenario.loading.centre_is_free
                                   ? "algebraic unknowns: by symmetry the wall forces balance on the centre at rest"
                                   : "algebraic unknowns: displacements are prescribed and the centre is fixed");
  }
  if (model.has_adhesion() && !model.adheres(scenario.material)) {
    scene.skipped.emplace_back("adhesion: the surface energy is zero");
  }
  scene.skipped.emplace_back("guards that cannot fire before the end of a step");
  scene.skipped.emplace_back("observables between output points");
  return scene;
}

std::vector<DerivedParameter> derived_parameters(const CheckedScenario& scenario) {
  const Model& model = *find_model(scenario.model);
  std::vector<DerivedParameter> list;
  if (scenario.radius > 0.0) list.push_back({"radius", scenario.radius, "m"});
  if (model.parameters == nullptr) return list;
  Scene scene;
  if (model.has_walls()) add_walls(scenario, true, scene);
  std::vector<Ramp> ramps;
  for (const Channel& channel : scene.channels) {
    Ramp ramp = channel.at_rest;
    const auto control = channel.program.empty() ? std::nullopt : control_of(channel.program.front().kind);
    if (control == Control::force) ramp = {0.0, channel.program.front().target, Control::force};
    if (control == Control::displacement) ramp.end = channel.program.front().target;
    ramps.push_back(ramp);
  }
  const std::vector<DerivedParameter> own = model.parameters(model_input(scenario), {scene.classes, ramps});
  list.insert(list.end(), own.begin(), own.end());
  return list;
}

}  // namespace monograin
