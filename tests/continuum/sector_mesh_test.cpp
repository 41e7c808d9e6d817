#include "continuum/sector_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <numbers>

namespace monograin {
namespace {

constexpr double k_quarter = std::numbers::pi / 2.0;

/// Determinant of the map from the unit cube to a brick, at one of its eight points of integration.
double determinant(const SectorMesh& mesh, const std::array<std::size_t, 8>& brick, const Eigen::Vector3d& at) {
  const std::array<Eigen::Vector3d, 8> corners{
      {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < 8; ++i) {
    const Eigen::Vector3d& c = corners[i];
    const Eigen::Vector3d factors = Eigen::Vector3d::Ones() + c.cwiseProduct(at);
    const Eigen::Vector3d slope(c.x() * factors.y() * factors.z(), c.y() * factors.x() * factors.z(),
                                c.z() * factors.x() * factors.y());
    jacobian += 0.125 * mesh.nodes[brick[i]] * slope.transpose();
  }
  return jacobian.determinant();
}

/// Volume of the bricks, and the least determinant at any point of integration.
std::pair<double, double> volume_and_least(const SectorMesh& mesh) {
  const double g = 1.0 / std::numbers::sqrt3;
  double volume = 0.0;
  double least = 1.0;
  for (const auto& brick : mesh.bricks) {
    for (const double x : {-g, g}) {
      for (const double y : {-g, g}) {
        for (const double z : {-g, g}) {
          const double value = determinant(mesh, brick, {x, y, z});
          volume += value;
          least = std::min(least, value);
        }
      }
    }
  }
  return {volume, least};
}

struct MeshCase {
  SectorMeshSize size;
  double angle;
};
const std::vector<MeshCase> k_cases{{{16, 4, 1.0}, k_quarter / 2.0}, {{24, 1, 2.5}, 0.035},
                                    {{40, 1, 2.5}, 0.035},           {{160, 1, 2.5}, 0.035},
                                    {{24, 5, 1.0}, k_quarter},       {{48, 10, 1.0}, k_quarter / 2.0}};

TEST(SectorMesh, FillsTheSectorWithBricksThatAreNotInverted) {
  for (const auto& [size, angle] : k_cases) {
    const SectorMesh mesh = sector_mesh(size, angle);
    const auto [volume, least] = volume_and_least(mesh);
    EXPECT_GT(least, 0.0) << size.meridian;
    // The part of a unit sphere above z = 0 has the volume 2/3 pi; flat elements cut a little off.
    const double exact = angle / 3.0;
    EXPECT_LT(volume, exact) << size.meridian;
    const double element = k_quarter / size.meridian;
    const double across = mesh.longitudes[1];
    EXPECT_NEAR(volume / exact, 1.0, 2.0 * element * element + across * across) << size.meridian;
  }
}

TEST(SectorMesh, HasNoGapsBetweenBricks) {
  constexpr std::array<std::array<std::size_t, 4>, 6> faces{
      {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
  for (const auto& [size, angle] : k_cases) {
    const SectorMesh mesh = sector_mesh(size, angle);
    std::map<std::array<std::size_t, 4>, int> uses;
    for (const auto& brick : mesh.bricks) {
      for (const auto& face : faces) {
        std::array<std::size_t, 4> nodes{brick[face[0]], brick[face[1]], brick[face[2]], brick[face[3]]};
        std::ranges::sort(nodes);
        ++uses[nodes];
      }
    }
    const auto on = [&](const std::array<std::size_t, 4>& face, auto&& is_on) {
      return std::ranges::all_of(face, [&](std::size_t node) { return is_on(mesh.nodes[node]); });
    };
    for (const auto& [face, count] : uses) {
      ASSERT_LE(count, 2);
      if (count == 2) continue;
      const bool is_outside = on(face, [](const Eigen::Vector3d& x) { return std::abs(x.norm() - 1.0) < 1e-12; }) ||
                              on(face, [](const Eigen::Vector3d& x) { return x.z() == 0.0; }) ||
                              on(face, [](const Eigen::Vector3d& x) { return x.y() == 0.0; }) ||
                              on(face, [](const Eigen::Vector3d& x) { return std::hypot(x.x(), x.y()) < 1e-12; }) ||
                              on(face, [&](const Eigen::Vector3d& x) {
                                return std::abs(x.y() * std::cos(angle) - x.x() * std::sin(angle)) < 1e-12;
                              });
      EXPECT_TRUE(is_outside) << size.meridian;
    }
  }
}

TEST(SectorMesh, ListsSurfaceAxisAndEquator) {
  const SectorMesh mesh = sector_mesh({24, 5, 2.0}, k_quarter / 2.0);
  ASSERT_EQ(mesh.surface.size(), 6U);
  EXPECT_EQ(mesh.surface_nodes().size(), 6U * 25U);
  for (const auto& line : mesh.surface) {
    EXPECT_EQ(mesh.nodes[line.front()].z(), 1.0);
    EXPECT_EQ(mesh.nodes[line.back()].z(), 0.0);
  }
  const double at_pole = mesh.nodes[mesh.surface[0][1]].x();
  const double at_equator = mesh.nodes[mesh.surface[0][23]].z();
  EXPECT_NEAR(at_equator / at_pole, 2.0, 0.01);
  EXPECT_EQ(mesh.nodes[mesh.centre].norm(), 0.0);
  for (const std::size_t node : mesh.axis) {
    EXPECT_EQ(mesh.nodes[node].x(), 0.0);
    EXPECT_GT(mesh.nodes[node].z(), 0.0);
  }
  for (const std::size_t node : mesh.equator) EXPECT_EQ(mesh.nodes[node].z(), 0.0);
}

}  // namespace
}  // namespace monograin
