/// Triangles of a sphere that flat walls cut.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace monograin {

/// A closed surface of triangles, whose corners are counterclockwise as seen from outside.
struct SurfaceMesh {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;
};

/// Unit sphere: an icosahedron, each of whose triangles is divided into four `levels` times.
/// @param levels  0 to 8; gives 10 4^levels + 2 points
[[nodiscard]] SurfaceMesh unit_sphere(int levels);

/// A plane that cuts the sphere.
struct CuttingPlane {
  Eigen::Vector3d normal;  ///< unit, outward
  double distance = 0.0;   ///< of the plane from the sphere's centre, along the normal
};

/// A corner of a cut sphere.
struct CutPoint {
  Eigen::Vector3d position;  ///< relative to the centre
  int plane = -1;            ///< index of the plane on which the point lies; -1: on the sphere
};

/// Corners of a sphere, with all that lies beyond the planes moved onto them, towards the centre. Corners near the edge
/// of a cut are moved to the edge, which is a circle. The triangles stay those of the unit sphere.
/// @param sphere  as unit_sphere() makes it
[[nodiscard]] std::vector<CutPoint> cut_sphere(const SurfaceMesh& sphere, double radius,
                                               std::span<const CuttingPlane> planes);

}  // namespace monograin
