#include "verify/stress/check/turn.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "catalogue.hpp"
#include "scene/scene.hpp"
#include "stress_test/dice.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

bool takes_free_walls(const CheckedScenario& scenario) {
  return std::ranges::count(find_model(scenario.model)->configurations, std::string_view("walls")) > 0;
}

/// The walls of a scene, also of a preset, as free walls.
std::vector<WallSpec> specs_of(const CheckedScenario& scenario) {
  std::vector<WallSpec> specs;
  for (const Wall& wall : make_walls(scenario)) {
    specs.push_back({.name = wall.name,
                     .normal = {wall.normal.x(), wall.normal.y(), wall.normal.z()},
                     .gap = wall.gap,
                     .is_fixed = wall.steps.empty(),
                     .steps = wall.steps});
  }
  return specs;
}

constexpr std::array<std::string_view, 3> k_centre{"centre_x", "centre_y", "centre_z"};

/// Names of the walls of a class, sorted and joined.
std::string joined_walls(const ClassSummary& of) {
  std::vector<std::string> walls = of.walls;
  std::ranges::sort(walls);
  return fmt::format("{}", fmt::join(walls, "+"));
}

/// A column of the table by wall: its name there, and its index in the table by class.
struct Source {
  std::string name;
  std::size_t column = 0;
};

std::vector<Source> columns_by_wall(const Run& run) {
  const Table& table = run.record.history;
  std::vector<Source> sources;
  std::map<std::string, std::vector<Source>> of_walls;  // sorted by wall, whatever the order of the classes
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    const std::string& name = table.columns()[c].name;
    const std::size_t dot = name.rfind('.');
    const auto own = std::ranges::find(run.classes, name.substr(0, dot), &ClassSummary::name);
    if (dot == std::string::npos || own == run.classes.end()) {
      sources.push_back({name, c});
      continue;
    }
    for (const std::string& wall : own->walls) of_walls[wall].push_back({wall + name.substr(dot), c});
  }
  for (const auto& [wall, columns] : of_walls) sources.insert(sources.end(), columns.begin(), columns.end());
  return sources;
}

Table history_by_wall(const Run& run, const Eigen::Matrix3d& rotation) {
  const Table& table = run.record.history;
  const std::vector<Source> sources = columns_by_wall(run);
  std::vector<Column> columns;
  std::array<std::optional<std::size_t>, 3> centre;
  for (const Source& source : sources) {
    const auto axis = std::ranges::find(k_centre, source.name);
    if (axis != k_centre.end()) centre[static_cast<std::size_t>(axis - k_centre.begin())] = columns.size();
    columns.push_back(table.columns()[source.column]);
    columns.back().name = source.name;
  }
  Table result(columns);
  result.header = table.header;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    std::vector<double> values;
    for (const Source& source : sources) values.push_back(table.at(row, source.column));
    if (centre[0] && centre[1] && centre[2]) {
      const Eigen::Vector3d place =
          rotation.transpose() * Eigen::Vector3d(values[*centre[0]], values[*centre[1]], values[*centre[2]]);
      for (std::size_t axis = 0; axis < 3; ++axis) values[*centre[axis]] = place[static_cast<Eigen::Index>(axis)];
    }
    result.append(values);
  }
  return result;
}

Eigen::Vector3d normal_of(const WallSpec& wall) {
  return Eigen::Vector3d(wall.normal[0], wall.normal[1], wall.normal[2]).stableNormalized();
}

/// Duration [s] of a step, if all walls that move have it in their programs, and say where it ends.
std::optional<double> known_duration(const std::vector<WallSpec>& walls, std::size_t step) {
  std::optional<double> duration;
  for (const WallSpec& wall : walls) {
    if (wall.is_fixed) continue;
    if (step >= wall.steps.size()) return std::nullopt;
    const Step& own = wall.steps[step];
    const bool is_known = own.duration && own.until.empty() && own.share == 1.0 && own.kind != Step::Kind::detach;
    if (!is_known || (duration && *duration != *own.duration)) return std::nullopt;
    duration = own.duration;
  }
  return duration;
}

/// Adds to the displacements of a wall, at the ends of its steps, those by which a motion brings it nearer.
void carry(WallSpec& wall, const SharedMotion& motion) {
  const Eigen::Vector3d normal = normal_of(wall);
  std::optional<double> stands_at = -wall.gap;  // nothing while a force moves the wall
  double begin = 0.0;
  wall.steps.resize(motion.times.size());
  for (std::size_t k = 0; k < wall.steps.size(); ++k) {
    Step& step = wall.steps[k];
    step.duration = motion.times[k] - begin;
    begin = motion.times[k];
    if (step.kind == Step::Kind::force) stands_at.reset();
    if (step.kind == Step::Kind::displacement) stands_at = step.target;
    if (!stands_at) continue;
    step.kind = Step::Kind::displacement;
    step.target = *stands_at - normal.dot(motion.places[k]);
  }
  wall.is_fixed = false;
}

Table events_by_wall(const Run& run) {
  const Table& events = run.record.events;
  std::vector<Column> columns = events.columns();
  for (std::string& label : columns[*events.find("class")].labels) {
    std::vector<std::string> groups;
    for (std::size_t from = 0; from <= label.size();) {
      const std::size_t end = std::min(label.find('/', from), label.size());
      const std::string name = label.substr(from, end - from);
      const auto own = std::ranges::find(run.classes, name, &ClassSummary::name);
      groups.push_back(own == run.classes.end() ? name : joined_walls(*own));
      from = end + 1;
    }
    std::ranges::sort(groups);
    label = fmt::format("{}", fmt::join(groups, "/"));
  }
  Table result(std::move(columns));
  result.header = events.header;
  for (std::size_t row = 0; row < events.row_count(); ++row) result.append(events.row(row));
  return result;
}

}  // namespace

Eigen::Matrix3d stress_rotation(std::uint64_t sample) {
  Dice dice(sample);
  const Eigen::Vector3d axis(1.0, dice.uniform(1.2, 1.8), dice.uniform(2.2, 2.8));
  return Eigen::AngleAxisd(dice.uniform(0.4, 1.1), axis.normalized()).toRotationMatrix();
}

std::optional<CheckedScenario> turned(CheckedScenario scenario, const Eigen::Matrix3d& rotation) {
  if (!find_model(scenario.model)->has_walls() || !takes_free_walls(scenario)) return {};
  scenario.loading.walls = specs_of(scenario);
  scenario.loading.configuration = Loading::Configuration::walls;
  for (WallSpec& wall : scenario.loading.walls) {
    const Eigen::Vector3d normal = rotation * Eigen::Vector3d(wall.normal[0], wall.normal[1], wall.normal[2]);
    wall.normal = {normal.x(), normal.y(), normal.z()};
  }
  return scenario;
}

std::optional<CheckedScenario> reordered(CheckedScenario scenario) {
  if (scenario.loading.walls.size() < 2) return {};
  std::ranges::reverse(scenario.loading.walls);
  return scenario;
}

Eigen::Vector3d SharedMotion::at(double time) const {
  double begin = 0.0;
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (time <= times[k]) return from + (time - begin) / (times[k] - begin) * (places[k] - from);
    begin = times[k];
    from = places[k];
  }
  return from;
}

Eigen::Matrix3d onto_normals(std::span<const Eigen::Vector3d> normals) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& normal : normals) sum += normal * normal.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum);
  Eigen::Matrix3d projection = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) {
    if (solver.eigenvalues()[k] > k_same_direction)
      projection += solver.eigenvectors().col(k) * solver.eigenvectors().col(k).transpose();
  }
  return projection;
}

std::optional<SharedMotion> shared_motion(const CheckedScenario& scenario, std::uint64_t sample) {
  if (!takes_free_walls(scenario)) return {};
  const std::vector<WallSpec> walls = specs_of(scenario);
  double largest = 0.0;
  std::size_t steps = 0;
  std::vector<Eigen::Vector3d> normals;
  for (const WallSpec& wall : walls) {
    normals.push_back(normal_of(wall));
    steps = std::max(steps, wall.steps.size());
    for (const Step& step : wall.steps) {
      if (step.kind == Step::Kind::displacement) largest = std::max(largest, std::abs(step.target));
    }
  }
  const Eigen::Matrix3d projection = onto_normals(normals);
  Dice dice(sample);
  SharedMotion motion;
  for (std::size_t k = 0; k < steps; ++k) {
    const std::optional<double> duration = known_duration(walls, k);
    if (!duration) return {};
    motion.times.push_back((motion.times.empty() ? 0.0 : motion.times.back()) + *duration);
    Eigen::Vector3d place;
    for (double& component : place) component = largest * dice.uniform(-1.0, 1.0);
    motion.places.emplace_back(projection * place);
  }
  return largest > 0.0 ? std::optional(motion) : std::nullopt;
}

CheckedScenario carried(CheckedScenario scenario, const SharedMotion& motion) {
  scenario.loading.walls = specs_of(scenario);
  scenario.loading.configuration = Loading::Configuration::walls;
  for (WallSpec& wall : scenario.loading.walls) carry(wall, motion);
  return scenario;
}

Run by_wall(const Run& run, const Eigen::Matrix3d& rotation) {
  Run result = run;
  result.record.history = history_by_wall(run, rotation);
  result.record.events = events_by_wall(run);
  return result;
}

Run by_wall(const Run& run, const SharedMotion& motion) {
  Run result = by_wall(run);
  const Table& still = result.record.history;
  Table moving(still.columns());
  moving.header = still.header;
  const std::vector<WallSpec> walls = specs_of(run.scenario);
  for (std::size_t row = 0; row < still.row_count(); ++row) {
    std::vector<double> values(still.row(row).begin(), still.row(row).end());
    const Eigen::Vector3d place = motion.at(still.at(row, 0));
    for (std::size_t axis = 0; axis < k_centre.size(); ++axis) {
      if (const auto c = still.find(k_centre[axis])) values[*c] += place[static_cast<Eigen::Index>(axis)];
    }
    for (const WallSpec& wall : walls) values[*still.find(wall.name + ".displacement")] -= normal_of(wall).dot(place);
    moving.append(values);
  }
  result.record.history = std::move(moving);
  return result;
}

}  // namespace monograin
