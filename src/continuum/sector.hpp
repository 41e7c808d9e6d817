/// Part of a particle that stands for the whole by symmetry.
#pragma once

#include <cstddef>
#include <vector>

#include "exchange/motion.hpp"

namespace monograin {

/// A wall that presses on the sector, with its outward normal along an axis of the sector.
struct SectorWall {
  int axis = 2;               ///< 0, 1, 2: x, y, z
  std::size_t wall = 0;       ///< index into Motion::walls of one of the walls that it stands for
  double multiplicity = 1.0;  ///< contact of the wall over its part in the sector
};

/// Part of a sphere with z >= 0 and longitudes from 0, the x axis, to `angle`. Its flat faces are planes of symmetry.
struct Sector {
  double angle = 0.0;  ///< [rad]
  bool is_axisymmetric = false;
  std::vector<SectorWall> walls{};
  std::vector<std::size_t> sector_wall_of{};  ///< for each wall of the motion, the index of its wall of the sector
};

/// Least sector for the walls of a run as seen from the particle's centre: a thin wedge between two walls, an eighth of
/// a half sphere if the lateral walls move alike, else a quarter.
/// @throws std::invalid_argument unless the walls stand in opposite pairs that move alike and are perpendicular to each
/// other; the message names a wall
[[nodiscard]] Sector sector_of(const Motion& motion);

}  // namespace monograin
