#include "continuum/contact_area.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "continuum/sector_mesh.hpp"

namespace monograin {
namespace {

constexpr double k_half_quarter = std::numbers::pi / 4.0;

std::vector<Eigen::Vector3d> surface_nodes(const SectorMesh& mesh) {
  std::vector<Eigen::Vector3d> nodes;
  for (const std::size_t node : mesh.surface_nodes()) nodes.push_back(mesh.nodes[node]);
  return nodes;
}

/// Surface that touches the plane at height 1 along an axis between two radii, and leaves it as a power of the
/// distance.
double area_between(const SectorMesh& mesh, int axis, double inner, double outer, double power) {
  std::vector<Eigen::Vector3d> nodes = surface_nodes(mesh);
  for (Eigen::Vector3d& node : nodes) {
    const double radius = std::hypot(node[(axis + 1) % 3], node[(axis + 2) % 3]);
    const double beyond = std::max(inner - radius, radius - outer);
    // Nodes of a contact are a little beyond the plane, by the springs' compliance.
    node[axis] = beyond <= 0.0 ? 1.0 + 1e-5 : 1.0 - std::pow(beyond, power);
  }
  return contact_area({nodes, mesh.surface.size()}, axis, 1.0);
}

TEST(ContactArea, OfAWedgeIsThatOfItsDiscForAnyPowerOfTheGap) {
  const SectorMesh mesh = sector_mesh({80, 1, 2.5}, 0.02);
  for (const double radius : {0.2, 0.31, 0.45, 0.7}) {
    const double exact = 0.5 * 0.02 * radius * radius;
    EXPECT_NEAR(area_between(mesh, 2, -1.0, radius, 1.35) / exact, 1.0, 0.003) << radius;
    for (const double power : {1.2, 1.5}) {
      EXPECT_NEAR(area_between(mesh, 2, -1.0, radius, power) / exact, 1.0, 0.02) << radius;
    }
  }
}

TEST(ContactArea, OfARingLeavesOutItsMiddle) {
  const SectorMesh mesh = sector_mesh({160, 1, 2.5}, 0.02);
  EXPECT_NEAR(area_between(mesh, 2, 0.3, 0.5, 1.35) / (0.5 * 0.02 * (0.25 - 0.09)), 1.0, 0.01);
}

TEST(ContactArea, OfTheSideOfASectorIsAQuarterOfItsDisc) {
  const SectorMesh mesh = sector_mesh({48, 10, 1.0}, k_half_quarter);
  for (const double radius : {0.15, 0.3, 0.5}) {
    const double exact = 0.25 * std::numbers::pi * radius * radius;
    EXPECT_NEAR(area_between(mesh, 0, -1.0, radius, 1.35) / exact, 1.0, 0.04) << radius;
  }
}

TEST(ContactArea, OfMirrorImagesIsTheSame) {
  const SectorMesh mesh = sector_mesh({24, 6, 1.0}, 2.0 * k_half_quarter);
  for (const double radius : {0.08, 0.15, 0.2, 0.4}) {
    const double at_x = area_between(mesh, 0, -1.0, radius, 1.35);
    EXPECT_NEAR(area_between(mesh, 1, -1.0, radius, 1.35) / at_x, 1.0, 1e-9) << radius;
  }
}

TEST(ContactArea, IsZeroWithoutATouchAndNearlyContinuousAsTheContactGrows) {
  const SectorMesh mesh = sector_mesh({40, 1, 2.5}, 0.02);
  const std::vector<Eigen::Vector3d> nodes = surface_nodes(mesh);
  EXPECT_EQ(contact_area({nodes, 2}, 2, 1.001), 0.0);
  const double element = 0.02;
  double last = area_between(mesh, 2, -1.0, 0.2, 1.35);
  for (double radius = 0.201; radius < 0.4; radius += 0.001) {
    const double area = area_between(mesh, 2, -1.0, radius, 1.35);
    EXPECT_GE(area, last - 1e-9) << radius;
    EXPECT_LT(area - last, 0.02 * radius * 0.4 * element) << radius;
    last = area;
  }
}

TEST(VolumeBelow, OfASphereIsItsVolume) {
  const SectorMesh mesh = sector_mesh({160, 1, 1.0}, 0.02);
  EXPECT_NEAR(volume_below({surface_nodes(mesh), 2}) / (0.02 / 3.0), 1.0, 1e-4);
}

}  // namespace
}  // namespace monograin
