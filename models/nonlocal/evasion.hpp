/// How the centre of an elastic sphere evades walls that carry nothing.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contacts/centre/obstacles.hpp"
#include "nonlocal/contacts.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {

/// Approach of a wall while no contact is loaded; exactly 0 if the wall touches up to round-off. The round-off is
/// relative to the distance of the centre, whatever the axes along which it moves.
[[nodiscard]] double free_approach(const contacts::Obstacle& wall, const Eigen::Vector3d& centre);
/// Moves the centre within the subspace of a projector to the nearest position where no wall overlaps the surface.
/// Walls are taken in turn; one that would overlap touches the surface from then on.
/// @return false, with the centre unchanged, if the walls leave no such position
[[nodiscard]] bool clear_walls(std::span<const contacts::Obstacle> walls, const Eigen::Matrix3d& projector,
                               Eigen::Vector3d& centre);
/// clear_walls(), repeated to remove the small overlap that the round-off of a long displacement leaves.
[[nodiscard]] bool release_centre(std::span<const contacts::Obstacle> walls, const Eigen::Matrix3d& projector,
                                  Eigen::Vector3d& centre);
/// Writes the position of the centre to a state, and the gaps that the walls then have.
void put_centre(const Contacts& contacts, std::span<const contacts::Obstacle> walls, const Eigen::Vector3d& centre,
                std::span<double> y);

}  // namespace monograin::nonlocal
