#include "history/wall_checks.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "system/resolution.hpp"

namespace monograin {
namespace {

// A cell that extends this many times as far as its farthest wall counts as open.
constexpr double k_open = 1e3;
// Path of a centre that gets a warning, over that of the farthest wall, beyond a radius.
constexpr double k_escaping = 3.0;
// Least net force on a fixed centre that gets a warning, over the largest force of a wall.
constexpr double k_least_net_force = 0.01;

using Polygon = std::vector<Eigen::Vector3d>;

/// A square in the plane of a wall, with sides of 2 half.
Polygon square_in(const WallPlane& wall, double half) {
  const Eigen::Vector3d u = half * wall.normal.unitOrthogonal();
  const Eigen::Vector3d v = wall.normal.cross(u);
  const Eigen::Vector3d middle = wall.distance * wall.normal;
  return {middle + u + v, middle - u + v, middle - u - v, middle + u - v};
}

/// The part of a convex polygon inside a wall.
Polygon clipped(const Polygon& polygon, const WallPlane& wall) {
  Polygon inside;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Eigen::Vector3d& a = polygon[k];
    const Eigen::Vector3d& b = polygon[(k + 1) % polygon.size()];
    const double depth_a = wall.distance - wall.normal.dot(a);
    const double depth_b = wall.distance - wall.normal.dot(b);
    if (depth_a >= 0.0) inside.push_back(a);
    if ((depth_a < 0.0) != (depth_b < 0.0)) inside.push_back(a + depth_a / (depth_a - depth_b) * (b - a));
  }
  return inside;
}

double area_of(const Polygon& polygon) {
  Eigen::Vector3d twice = Eigen::Vector3d::Zero();
  for (std::size_t k = 2; k < polygon.size(); ++k)
    twice += (polygon[k - 1] - polygon[0]).cross(polygon[k] - polygon[0]);
  return 0.5 * twice.norm();
}

/// The walls without those that stand behind another one of the same direction; of equal ones, the first stays.
std::vector<WallPlane> foremost(std::span<const WallPlane> walls) {
  std::vector<WallPlane> kept;
  for (const WallPlane& wall : walls) {
    const auto same = std::ranges::find_if(
        kept, [&](const WallPlane& other) { return (other.normal - wall.normal).norm() <= k_same_direction; });
    if (same == kept.end())
      kept.push_back(wall);
    else if (wall.distance < same->distance)
      *same = wall;
  }
  return kept;
}

/// True if walls can enclose a space. Two opposite walls cannot, however close they are: they leave the sides open.
bool can_enclose(std::span<const ContactClass> classes) {
  std::vector<WallPlane> tangent_walls;
  for (const ContactClass& c : classes) {
    for (const Eigen::Vector3d& normal : c.normals) tangent_walls.push_back({normal, 1.0});
  }
  return std::isfinite(space_between(tangent_walls));
}

/// Rows in which a step or the run ends.
std::vector<std::size_t> ends_of_steps(const Table& history) {
  std::vector<std::size_t> ends;
  const auto step = history.find("step");
  for (std::size_t row = 0; row < history.row_count(); ++row) {
    const bool is_last = row + 1 == history.row_count();
    if (is_last || (step && history.at(row, *step) != history.at(row + 1, *step))) ends.push_back(row);
  }
  return ends;
}

/// Columns of one kind, one for each class.
std::vector<std::size_t> columns_of(const Table& history, std::span<const ContactClass> classes, const char* kind) {
  std::vector<std::size_t> columns;
  for (const ContactClass& c : classes) columns.push_back(history.find(fmt::format("{}.{}", c.name, kind)).value());
  return columns;
}

}  // namespace

double space_between(std::span<const WallPlane> all) {
  const std::vector<WallPlane> walls = foremost(all);
  double farthest = 0.0;
  for (const WallPlane& wall : walls) farthest = std::max(farthest, std::abs(wall.distance));
  double volume = 0.0;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    Polygon face = square_in(walls[i], 2.0 * k_open * farthest);
    for (std::size_t j = 0; j < walls.size() && !face.empty(); ++j) {
      if (j != i) face = clipped(face, walls[j]);
    }
    const auto is_far = [&](const Eigen::Vector3d& corner) { return corner.norm() > k_open * farthest; };
    if (std::ranges::any_of(face, is_far)) return k_infinity;
    volume += walls[i].distance * area_of(face) / 3.0;
  }
  return std::max(0.0, volume);
}

std::optional<std::string> space_warning(const Table& history, std::span<const ContactClass> classes, double radius) {
  if (!can_enclose(classes)) return std::nullopt;
  const std::vector<std::size_t> displacements = columns_of(history, classes, "displacement");
  const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
  double least = 1.0;
  double time = 0.0;
  std::vector<WallPlane> walls;
  for (const std::size_t row : ends_of_steps(history)) {
    walls.clear();
    for (std::size_t c = 0; c < classes.size(); ++c) {
      const double distance = radius - history.at(row, displacements[c]);
      for (const Eigen::Vector3d& normal : classes[c].normals) walls.push_back({normal, distance});
    }
    const double share = space_between(walls) / volume;
    if (share < least) {
      least = share;
      time = history.at(row, 0);
    }
  }
  if (!(least < 1.0)) return std::nullopt;
  return fmt::format(
      "the walls leave less space than the particle's volume: a solid particle fills the cell and bears far more than "
      "this law says (space/volume = {:.3g} at t = {:.9g} s)",
      least, time);
}

std::optional<std::string> balance_warning(const Table& history, std::span<const ContactClass> classes) {
  const std::vector<std::size_t> forces = columns_of(history, classes, "force");
  double largest_net = 0.0;
  double largest_force = 0.0;
  double time = 0.0;
  for (std::size_t row = 0; row < history.row_count(); ++row) {
    Eigen::Vector3d net = Eigen::Vector3d::Zero();
    for (std::size_t c = 0; c < classes.size(); ++c) {
      const double force = history.at(row, forces[c]);
      largest_force = std::max(largest_force, std::abs(force));
      for (const Eigen::Vector3d& normal : classes[c].normals) net -= force * normal;
    }
    const auto is_towards = [&](const ContactClass& c) {
      return std::ranges::any_of(c.normals,
                                 [&](const Eigen::Vector3d& n) { return n.dot(net) > k_no_direction * net.norm(); });
    };
    if (net.norm() > largest_net && std::ranges::any_of(classes, is_towards)) {
      largest_net = net.norm();
      time = history.at(row, 0);
    }
  }
  if (!(largest_net > k_least_net_force * largest_force)) return std::nullopt;
  return fmt::format(
      "the forces of the walls do not balance: a fixed centre bears up to {:.3g} N, {:.2g} of the largest force of a "
      "wall (t = {:.9g} s); with [loading] centre = \"equilibrium\" the particle moves until they do",
      largest_net, largest_net / largest_force, time);
}

std::optional<std::string> escape_warning(const Table& history, std::span<const ContactClass> classes, double radius) {
  const auto x = history.find("centre_x");
  if (!x) return std::nullopt;
  const std::vector<std::size_t> displacements = columns_of(history, classes, "displacement");
  double by_walls = 0.0;
  double by_centre = 0.0;
  double time = 0.0;
  for (std::size_t row = 0; row < history.row_count(); ++row) {
    for (const std::size_t column : displacements) {
      by_walls = std::max(by_walls, std::abs(history.at(row, column) - history.at(0, column)));
    }
    const Eigen::Vector3d centre(history.at(row, *x), history.at(row, *x + 1), history.at(row, *x + 2));
    if (!(centre.norm() > by_centre)) continue;
    by_centre = centre.norm();
    time = history.at(row, 0);
  }
  if (!(by_centre > radius + k_escaping * by_walls)) return std::nullopt;
  return fmt::format(
      "the walls squeeze the particle out between them: its centre moves by {:.3g} R0, no wall by more than {:.3g} R0 "
      "(t = {:.9g} s)",
      by_centre / radius, by_walls / radius, time);
}

}  // namespace monograin
