#include "continuum/sector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr double k_wedge_angle = 2.0 * std::numbers::pi / 180.0;

/// Two walls on opposite sides, by their indices.
struct Pair {
  std::array<std::size_t, 2> walls;
  double depth = 0.0;  ///< largest overlap
};

bool move_alike(const Motion& motion, std::size_t a, std::size_t b) {
  return std::ranges::all_of(motion.instants, [&](const MotionInstant& instant) {
    const double difference = motion.overlap(motion.walls[a], instant) - motion.overlap(motion.walls[b], instant);
    return std::abs(difference) <= k_same_number * motion.initial_radius;
  });
}

double depth_of(const Motion& motion, std::size_t wall) {
  double depth = 0.0;
  for (const MotionInstant& instant : motion.instants) {
    depth = std::fmax(depth, motion.overlap(motion.walls[wall], instant));
  }
  return depth;
}

std::size_t partner_of(const Motion& motion, std::size_t wall) {
  for (std::size_t other = 0; other < motion.walls.size(); ++other) {
    const double sum = (motion.walls[wall].normal + motion.walls[other].normal).norm();
    if (sum < k_same_direction && move_alike(motion, wall, other)) return other;
  }
  throw std::invalid_argument(
      fmt::format("finite elements are made for walls in opposite pairs that move alike, as seen from the centre; wall "
                  "'{}' has no such partner",
                  motion.walls[wall].name));
}

std::vector<Pair> pairs_of(const Motion& motion) {
  std::vector<Pair> pairs;
  for (std::size_t wall = 0; wall < motion.walls.size(); ++wall) {
    const std::size_t partner = partner_of(motion, wall);
    if (partner < wall) continue;
    for (const Pair& pair : pairs) {
      if (std::abs(motion.walls[pair.walls[0]].normal.dot(motion.walls[wall].normal)) < k_same_direction) continue;
      throw std::invalid_argument(fmt::format(
          "finite elements are made for pairs of walls that are perpendicular to each other; wall '{}' is not",
          motion.walls[wall].name));
    }
    pairs.push_back({{wall, partner}, depth_of(motion, wall)});
  }
  return pairs;
}

}  // namespace

Sector sector_of(const Motion& motion) {
  std::vector<Pair> pairs = pairs_of(motion);
  std::ranges::stable_sort(pairs, std::ranges::greater{}, &Pair::depth);
  const auto alike = [&](std::size_t a, std::size_t b) {
    return pairs.size() == 3 && move_alike(motion, pairs[a].walls[0], pairs[b].walls[0]);
  };
  // The pair on the axis is the one unlike the two others, else the one that goes deepest.
  if (!alike(1, 2) && alike(0, 1)) std::rotate(pairs.begin(), pairs.end() - 1, pairs.end());

  const double quarter = 0.5 * std::numbers::pi;
  Sector sector{.angle = quarter, .is_axisymmetric = pairs.size() == 1};
  if (sector.is_axisymmetric) sector.angle = k_wedge_angle;
  const bool is_mirrored = alike(1, 2);
  if (is_mirrored) sector.angle = 0.5 * quarter;
  sector.sector_wall_of.resize(motion.walls.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const bool is_second_of_mirror = is_mirrored && i == 2;
    if (!is_second_of_mirror) {
      const double multiplicity = i == 0 ? 2.0 * std::numbers::pi / sector.angle : 4.0;
      sector.walls.push_back({i == 0 ? 2 : static_cast<int>(i) - 1, pairs[i].walls[0], multiplicity});
    }
    for (const std::size_t wall : pairs[i].walls) sector.sector_wall_of[wall] = sector.walls.size() - 1;
  }
  return sector;
}

}  // namespace monograin
