/// Walls that the centre of an unloaded particle evades.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace monograin::contacts {

/// A class of walls that the particle must not overlap.
struct Obstacle {
  std::size_t index;            ///< of the class
  Eigen::Vector3d mean_normal;  ///< mean normal along the free directions of the centre
  double overlap_at_origin;     ///< with the centre at its initial position; negative for a gap

  [[nodiscard]] double overlap(const Eigen::Vector3d& c) const { return overlap_at_origin + mean_normal.dot(c); }
};

/// Moves the centre by the smallest displacement after which it clears all walls: projects it onto the intersection of
/// their half-spaces. Takes the walls in turn, as Seidel (1991) does in linear programs: a wall that still overlaps
/// becomes a constraint, in whose plane the walls before it are solved again.
/// @param projector        on the directions in which the centre may move
/// @param least_component  of a mean normal along these directions; a smaller one is zero
/// @param overlaps         (wall, position of the centre) -> whether they overlap by more than round-off
/// @return false, with c unchanged, if there is no such position
template <class Overlaps>
bool project_out_of(std::span<const Obstacle> walls, const Eigen::Matrix3d& projector, double least_component,
                    const Overlaps& overlaps, Eigen::Vector3d& c) {
  Eigen::Vector3d now = c;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const Obstacle& wall = walls[k];
    if (!overlaps(wall, now)) continue;
    const Eigen::Vector3d path = projector * wall.mean_normal;
    const double share = path.squaredNorm();
    if (!(share > least_component * least_component)) return false;
    now = c - path * (wall.overlap(c) / share);
    if (!project_out_of(walls.first(k), projector - path * path.transpose() / share, least_component, overlaps, now))
      return false;
  }
  c = now;
  return true;
}

/// Carries a loose particle along until walls that it touches can balance a push. It slides along walls on its way.
/// @param push     sum of the pushing forces, each along the outward normal of its wall; not zero
/// @param walls    that can bear; their mean normals are not zero
/// @param touches  for each of them whether it touches at c; out: at the position found
/// @return the position of the centre; none if no wall is in the path
[[nodiscard]] std::optional<Eigen::Vector3d> carried_to_support(const Eigen::Vector3d& push,
                                                                std::span<const Obstacle> walls,
                                                                std::vector<char>& touches, Eigen::Vector3d c);

}  // namespace monograin::contacts
