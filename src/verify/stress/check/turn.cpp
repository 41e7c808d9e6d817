#include "verify/stress/check/turn.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "catalogue.hpp"
#include "scene/scene.hpp"
#include "stress/dice.hpp"

namespace monograin {
namespace {

bool takes_free_walls(const CheckedScenario& scenario) {
  return std::ranges::count(find_model(scenario.model)->configurations, std::string_view("walls")) > 0;
}

std::vector<WallSpec> specs_of(const CheckedScenario& scenario) {
  std::vector<WallSpec> specs;
  for (const Wall& wall : make_walls(scenario)) {
    specs.push_back({.name = wall.name,
                     .normal = {wall.normal.x(), wall.normal.y(), wall.normal.z()},
                     .gap = wall.gap,
                     .is_fixed = wall.steps.empty(),
                     .steps = wall.steps,
                     .where = {}});
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

Run by_wall(const Run& run, const Eigen::Matrix3d& rotation) {
  Run result = run;
  result.record.history = history_by_wall(run, rotation);
  result.record.events = events_by_wall(run);
  return result;
}

}  // namespace monograin
