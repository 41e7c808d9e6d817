#include "nonlocal/evasion.hpp"

#include <algorithm>
#include <cmath>

namespace monograin::nonlocal {
namespace {

constexpr int k_refinements = 2;         // repeated clearances of one position
constexpr double k_no_approach = 1e-30;  // over R0; less is round-off of zero

}  // namespace

double free_approach(const contacts::Obstacle& wall, const Eigen::Vector3d& centre) {
  const double sum = wall.overlap(centre);
  const double size = std::abs(wall.overlap_at_origin) + wall.mean_normal.norm() * centre.norm();
  return std::abs(sum) <= std::max(k_round_off * size, k_no_approach) ? 0.0 : sum;
}

bool clear_walls(std::span<const contacts::Obstacle> walls, const Eigen::Matrix3d& projector, Eigen::Vector3d& centre) {
  const auto overlaps = [](const contacts::Obstacle& wall, const Eigen::Vector3d& at) {
    return !(free_approach(wall, at) <= 0.0);
  };
  return contacts::project_out_of(walls, projector, k_same_direction, overlaps, centre);
}

bool release_centre(std::span<const contacts::Obstacle> walls, const Eigen::Matrix3d& projector,
                    Eigen::Vector3d& centre) {
  if (!clear_walls(walls, projector, centre)) return false;
  for (int refinement = 0; refinement < k_refinements; ++refinement) {
    if (!clear_walls(walls, projector, centre)) break;
  }
  return true;
}

void put_centre(const Contacts& contacts, std::span<const contacts::Obstacle> walls, const Eigen::Vector3d& centre,
                std::span<double> y) {
  for (const contacts::Obstacle& wall : walls) y[wall.index] = std::min(free_approach(wall, centre), 0.0);
  contacts.set_centre(centre, y);
}

}  // namespace monograin::nonlocal
