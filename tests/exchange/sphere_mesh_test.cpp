#include "exchange/sphere_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace monograin {
namespace {

constexpr double k_sphere_volume = 4.0 / 3.0 * std::numbers::pi;

/// Volume within the triangles of a mesh, by the divergence theorem.
double volume(const SurfaceMesh& mesh, const std::vector<CutPoint>& points) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += points[a].position.dot(points[b].position.cross(points[c].position)) / 6.0;
  }
  return sum;
}

double cap_volume(double radius, double distance) {
  const double height = radius - distance;
  return std::numbers::pi * height * height * (3.0 * radius - height) / 3.0;
}

TEST(UnitSphere, HasTheStatedNumberOfPointsAtUnitDistance) {
  for (int levels = 0; levels < 4; ++levels) {
    const SurfaceMesh mesh = unit_sphere(levels);
    EXPECT_EQ(mesh.points.size(), 10U * (1U << (2 * levels)) + 2U);
    EXPECT_EQ(mesh.triangles.size(), 20U << (2 * levels));
    for (const Eigen::Vector3d& point : mesh.points) EXPECT_NEAR(point.norm(), 1.0, 1e-15);
  }
}

TEST(UnitSphere, IsClosedAndOriented) {
  std::set<std::pair<int, int>> edges;
  for (const auto& [a, b, c] : unit_sphere(2).triangles) {
    for (const std::pair<int, int>& edge : {std::pair{a, b}, {b, c}, {c, a}}) EXPECT_TRUE(edges.insert(edge).second);
  }
  for (const auto& [from, to] : edges) EXPECT_TRUE(edges.contains({to, from}));
}

TEST(CutSphere, IsTheSphereWherePlanesDoNotReachIt) {
  const SurfaceMesh mesh = unit_sphere(3);
  const std::vector<CuttingPlane> planes{{Eigen::Vector3d::UnitX(), 2.5}, {-Eigen::Vector3d::UnitX(), 2.0}};
  const std::vector<CutPoint> points = cut_sphere(mesh, 2.0, planes);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR((points[i].position - 2.0 * mesh.points[i]).norm(), 0.0, 1e-14);
  }
}

TEST(CutSphere, LacksTheCapsBeyondItsPlanes) {
  const double radius = 1.5;
  const std::vector<CuttingPlane> planes{{Eigen::Vector3d(1, 2, 2) / 3.0, 1.2},
                                         {Eigen::Vector3d(-2, -1, 2) / 3.0, 0.9}};
  double error = 1.0;
  for (int levels = 3; levels <= 5; ++levels) {
    const SurfaceMesh mesh = unit_sphere(levels);
    const double expected = k_sphere_volume * std::pow(radius, 3) - cap_volume(radius, 1.2) - cap_volume(radius, 0.9);
    const double now = std::abs(volume(mesh, cut_sphere(mesh, radius, planes)) / expected - 1.0);
    EXPECT_LT(now, 0.4 * error) << levels;
    error = now;
  }
  EXPECT_LT(error, 2e-3);
}

TEST(CutSphere, StaysWithinItsPlanesAndTouchesThem) {
  const SurfaceMesh mesh = unit_sphere(4);
  const std::vector<CuttingPlane> planes{{Eigen::Vector3d::UnitZ(), 0.6}, {Eigen::Vector3d::UnitX(), 0.7}};
  const std::vector<CutPoint> points = cut_sphere(mesh, 1.0, planes);
  std::vector<int> counts(2);
  for (const CutPoint& point : points) {
    for (std::size_t i = 0; i < planes.size(); ++i) {
      EXPECT_LE(point.position.dot(planes[i].normal), planes[i].distance + 1e-15);
    }
    EXPECT_LE(point.position.norm(), 1.0 + 1e-15);
    if (point.plane < 0) {
      EXPECT_NEAR(point.position.norm(), 1.0, 1e-15);
      continue;
    }
    const CuttingPlane& plane = planes[static_cast<std::size_t>(point.plane)];
    EXPECT_NEAR(point.position.dot(plane.normal), plane.distance, 1e-15);
    ++counts[static_cast<std::size_t>(point.plane)];
  }
  // The share of a cap of the unit sphere is (1 - d)/2.
  EXPECT_NEAR(counts[0] / static_cast<double>(points.size()), 0.2, 0.02);
  EXPECT_NEAR(counts[1] / static_cast<double>(points.size()), 0.15, 0.02);
}

TEST(CutSphere, FoldsNoTriangle) {
  const SurfaceMesh mesh = unit_sphere(4);
  const double mean_area = 4.0 * std::numbers::pi / static_cast<double>(mesh.triangles.size());
  for (int k = 1; k < 60; ++k) {
    const double distance = 0.4 + 0.01 * k;
    const std::vector<CuttingPlane> planes{{Eigen::Vector3d(k, 7, -3).normalized(), distance},
                                           {Eigen::Vector3d(-k, -7, 3).normalized(), distance},
                                           {Eigen::Vector3d::UnitZ(), 1.1 * distance}};
    const std::vector<CutPoint> points = cut_sphere(mesh, 1.0, planes);
    for (const auto& [a, b, c] : mesh.triangles) {
      const Eigen::Vector3d& p = points[a].position;
      EXPECT_GT((points[b].position - p).cross(points[c].position - p).dot(p), -1e-3 * mean_area) << k;
    }
  }
}

TEST(CutSphere, HasCornersOnTheCircleOfACut) {
  const SurfaceMesh mesh = unit_sphere(3);
  const std::vector<CutPoint> points =
      cut_sphere(mesh, 1.0, std::vector<CuttingPlane>{{Eigen::Vector3d::UnitZ(), 0.8}});
  int on_circle = 0;
  double next_inside = 0.0;
  for (const CutPoint& point : points) {
    const double from_axis = std::hypot(point.position.x(), point.position.y());
    if (point.position.z() < 0.8 - 1e-12) continue;
    if (std::abs(from_axis - 0.6) < 1e-12) {
      ++on_circle;
    } else {
      next_inside = std::max(next_inside, from_axis);
    }
  }
  // Without corners on the circle its radius would be known to about half a side of a triangle, 0.08, only.
  EXPECT_GE(on_circle, 12);
  EXPECT_LT(next_inside, 0.58);
}

}  // namespace
}  // namespace monograin
