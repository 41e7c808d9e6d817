/// Bricks for a sector of the unit sphere.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace monograin {

/// Fineness of a mesh.
struct SectorMeshSize {
  int meridian = 40;             ///< elements on the surface from pole to equator; a multiple of 8
  int longitude = 1;             ///< elements over the longitudes of a sector; a quarter has twice as many
  double pole_refinement = 1.0;  ///< length of the element at the equator over that at the pole
};

/// Bricks of eight nodes. A mesh of the half meridian is repeated at every longitude, also its nodes on the axis.
struct SectorMesh {
  std::vector<Eigen::Vector3d> nodes;  ///< longitude by longitude
  std::vector<std::array<std::size_t, 8>> bricks;
  std::size_t per_longitude = 0;                  ///< nodes of one meridian
  std::vector<double> longitudes;                 ///< [rad]
  std::vector<std::size_t> axis;                  ///< nodes on the axis of the first meridian, without the centre
  std::size_t centre = 0;                         ///< node at the centre, of the first meridian
  std::vector<std::size_t> equator;               ///< nodes with z = 0 of the first meridian, without the centre
  std::vector<std::vector<std::size_t>> surface;  ///< nodes from the pole to the equator, for each longitude

  /// Nodes of the surface, longitude by longitude.
  [[nodiscard]] std::vector<std::size_t> surface_nodes() const;
};

/// Makes the mesh for longitudes from 0 to `angle`. Elements are fine at the surface, four times as large in the
/// middle, and near the x axis (and the y axis of a quarter) half as wide as between.
/// @param angle  at most pi/2 [rad]
[[nodiscard]] SectorMesh sector_mesh(const SectorMeshSize& size, double angle);

}  // namespace monograin
