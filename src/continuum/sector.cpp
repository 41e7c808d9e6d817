#include "continuum/sector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr double k_wedge_angle = 2.0 * std::numbers::pi / 180.0;

/// Two walls on opposite sides.
struct Pair {
  Eigen::Vector3d normal;
  std::size_t contact_class;
  double depth = 0.0;  ///< largest displacement
};

bool move_alike(const Motion& motion, std::size_t a, std::size_t b) {
  return std::ranges::all_of(motion.instants, [&](const MotionInstant& instant) {
    const double difference = instant.contacts[a].displacement - instant.contacts[b].displacement;
    return std::abs(difference) <= k_same_number * motion.initial_radius;
  });
}

double depth_of(const Motion& motion, std::size_t contact_class) {
  double depth = 0.0;
  for (const MotionInstant& instant : motion.instants) {
    depth = std::fmax(depth, instant.contacts[contact_class].displacement);
  }
  return depth;
}

std::vector<Pair> pairs_of(const Motion& motion) {
  std::vector<Pair> pairs;
  for (const MovingWall& wall : motion.walls) {
    const auto opposite = std::ranges::find_if(motion.walls, [&](const MovingWall& other) {
      return (wall.normal + other.normal).norm() < k_same_direction &&
             move_alike(motion, wall.contact_class, other.contact_class);
    });
    if (opposite == motion.walls.end()) {
      throw std::invalid_argument(
          fmt::format("finite elements are made for walls in opposite pairs that move alike; wall '{}' has no such "
                      "partner",
                      wall.name));
    }
    if (&*opposite < &wall) continue;
    for (const Pair& pair : pairs) {
      if (std::abs(pair.normal.dot(wall.normal)) < k_same_direction) continue;
      throw std::invalid_argument(fmt::format(
          "finite elements are made for pairs of walls that are perpendicular to each other; wall '{}' is not",
          wall.name));
    }
    pairs.push_back({wall.normal, wall.contact_class, depth_of(motion, wall.contact_class)});
  }
  return pairs;
}

/// Moves the pair for the z axis to the front: the one unlike the two others, else the one that goes deepest.
void put_axial_first(std::vector<Pair>& pairs, const Motion& motion) {
  std::ranges::stable_sort(pairs, std::ranges::greater{}, &Pair::depth);
  const auto alike = [&](std::size_t a, std::size_t b) {
    return move_alike(motion, pairs[a].contact_class, pairs[b].contact_class);
  };
  if (pairs.size() == 3 && !alike(1, 2) && alike(0, 1)) std::ranges::rotate(pairs, pairs.end() - 1);
}

}  // namespace

Sector sector_of(const Motion& motion) {
  for (const MotionInstant& instant : motion.instants) {
    if (instant.centre.norm() <= k_same_number * motion.initial_radius) continue;
    throw std::invalid_argument("finite elements are made for a particle whose centre stays where it is");
  }
  std::vector<Pair> pairs = pairs_of(motion);
  put_axial_first(pairs, motion);
  if (pairs.size() == 1) {
    return {.angle = k_wedge_angle,
            .is_axisymmetric = true,
            .walls = {{2, pairs[0].contact_class, 2.0 * std::numbers::pi / k_wedge_angle}}};
  }
  const double quarter = 0.5 * std::numbers::pi;
  if (pairs.size() == 3 && move_alike(motion, pairs[1].contact_class, pairs[2].contact_class)) {
    return {.angle = 0.5 * quarter, .walls = {{2, pairs[0].contact_class, 8.0}, {0, pairs[1].contact_class, 4.0}}};
  }
  Sector sector{.angle = quarter, .walls = {{2, pairs[0].contact_class, 4.0}}};
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    sector.walls.push_back({static_cast<int>(i) - 1, pairs[i].contact_class, 4.0});
  }
  return sector;
}

}  // namespace monograin
