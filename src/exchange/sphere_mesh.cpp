#include "exchange/sphere_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace monograin {
namespace {

/// Least cosine between two corners of an icosahedron that have an edge in common, which is 1/sqrt(5); that of others
/// is negative.
constexpr double k_edge_cosine = 0.4;

SurfaceMesh icosahedron() {
  SurfaceMesh mesh;
  // Corners of three rectangles at right angles, whose sides are in the golden ratio.
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-std::numbers::phi, std::numbers::phi}) {
      mesh.points.insert(mesh.points.end(), {{0.0, a, b}, {a, b, 0.0}, {b, 0.0, a}});
    }
  }
  for (Eigen::Vector3d& point : mesh.points) point.normalize();
  const auto& p = mesh.points;
  const auto share_edge = [&](int i, int j) { return p[i].dot(p[j]) > k_edge_cosine; };
  const int count = static_cast<int>(p.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      for (int k = j + 1; k < count; ++k) {
        if (!share_edge(i, j) || !share_edge(j, k) || !share_edge(i, k)) continue;
        const bool is_outward = (p[j] - p[i]).cross(p[k] - p[i]).dot(p[i]) > 0.0;
        mesh.triangles.push_back(is_outward ? std::array{i, j, k} : std::array{i, k, j});
      }
    }
  }
  return mesh;
}

/// Divides every triangle into four, with the new corners on the unit sphere.
SurfaceMesh divided(SurfaceMesh mesh) {
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int i, int j) {
    const auto [found, is_new] = middles.try_emplace(std::minmax(i, j), static_cast<int>(mesh.points.size()));
    if (is_new) mesh.points.push_back((mesh.points[i] + mesh.points[j]).normalized());
    return found->second;
  };
  std::vector<std::array<int, 3>> triangles;
  for (const auto& [a, b, c] : mesh.triangles) {
    const int ab = middle(a, b);
    const int bc = middle(b, c);
    const int ca = middle(c, a);
    triangles.insert(triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  mesh.triangles = std::move(triangles);
  return mesh;
}

/// Moves a direction to the edge of the nearest cut if it is closer to it than `reach` [rad].
Eigen::Vector3d moved_to_edge(const Eigen::Vector3d& direction, double radius, std::span<const CuttingPlane> planes,
                              double reach) {
  Eigen::Vector3d moved = direction;
  for (const CuttingPlane& plane : planes) {
    if (std::abs(plane.distance) >= radius) continue;
    const double edge = std::acos(plane.distance / radius);
    const double angle = std::acos(std::clamp(direction.dot(plane.normal), -1.0, 1.0));
    if (std::abs(angle - edge) >= reach) continue;
    reach = std::abs(angle - edge);
    const Eigen::Vector3d across = direction - direction.dot(plane.normal) * plane.normal;
    if (across.norm() > 0.0) moved = std::cos(edge) * plane.normal + std::sin(edge) * across.normalized();
  }
  return moved;
}

}  // namespace

SurfaceMesh unit_sphere(int levels) {
  SurfaceMesh mesh = icosahedron();
  for (int i = 0; i < levels; ++i) mesh = divided(std::move(mesh));
  return mesh;
}

std::vector<CutPoint> cut_sphere(const SurfaceMesh& sphere, double radius, std::span<const CuttingPlane> planes) {
  // The least height of a triangle is more than twice this distance, so that no triangle is folded: each of N has about
  // the area 4 pi/N.
  const double reach = 0.4 * std::sqrt(4.0 * std::numbers::pi / static_cast<double>(sphere.triangles.size()));
  std::vector<CutPoint> points;
  for (const Eigen::Vector3d& corner : sphere.points) {
    const Eigen::Vector3d direction = moved_to_edge(corner, radius, planes, reach);
    double distance = radius;
    int cutting = -1;
    for (std::size_t i = 0; i < planes.size(); ++i) {
      const double cosine = direction.dot(planes[i].normal);
      if (cosine <= 0.0 || planes[i].distance > distance * cosine) continue;
      distance = std::max(planes[i].distance, 0.0) / cosine;
      cutting = static_cast<int>(i);
    }
    points.push_back({distance * direction, cutting});
  }
  return points;
}

}  // namespace monograin
