#include "contacts/centre/obstacles.hpp"

#include <algorithm>

#include "contacts/centre/reaction_cone.hpp"
#include "system/resolution.hpp"

namespace monograin::contacts {
namespace {

/// The walls that touch, as constraints on a velocity: none of them may approach.
std::vector<Obstacle> standing(std::span<const Obstacle> walls, std::span<const char> touches) {
  std::vector<Obstacle> found;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    if (touches[k]) found.push_back({k, walls[k].mean_normal.normalized(), 0.0});
  }
  return found;
}

}  // namespace

std::optional<Eigen::Vector3d> carried_to_support(const Eigen::Vector3d& push, std::span<const Obstacle> walls,
                                                  std::vector<char>& touches, Eigen::Vector3d c) {
  const auto approaches = [](const Obstacle& wall, const Eigen::Vector3d& path) {
    return wall.mean_normal.dot(path) > k_no_direction * wall.mean_normal.norm();
  };
  // No wall is met more often than four times.
  for (std::size_t meeting = 0; meeting <= 4 * walls.size(); ++meeting) {
    const std::vector<Obstacle> in_contact = standing(walls, touches);
    std::vector<Eigen::Vector3d> normals;
    for (const Obstacle& wall : in_contact) normals.push_back(wall.mean_normal);
    // The projection below would then be zero (Moreau's decomposition), and no direction to go on.
    if (in_reaction_cone(push, normals)) return c;
    Eigen::Vector3d path = -push.normalized();
    if (!project_out_of(in_contact, Eigen::Matrix3d::Identity(), k_no_direction, approaches, path)) return std::nullopt;
    path.normalize();
    std::optional<std::size_t> next;
    double nearest = k_infinity;
    for (std::size_t k = 0; k < walls.size(); ++k) {
      if (touches[k] && walls[k].mean_normal.dot(path) < -k_no_direction * walls[k].mean_normal.norm()) touches[k] = 0;
      if (touches[k] || !approaches(walls[k], path)) continue;
      const double distance = std::max(0.0, -walls[k].overlap(c)) / walls[k].mean_normal.dot(path);
      if (next && distance >= nearest) continue;
      next = k;
      nearest = distance;
    }
    if (!next) return std::nullopt;
    c += nearest * path;
    touches[*next] = 1;
  }
  return std::nullopt;
}

}  // namespace monograin::contacts
