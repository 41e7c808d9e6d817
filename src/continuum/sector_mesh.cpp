#include "continuum/sector_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace monograin {
namespace {

using Eigen::Vector2d;

/// Radius of the middle that has no rings.
constexpr double k_core_radius = 0.5;
/// Depths from which on elements are twice as long as above.
constexpr std::array k_coarsening_depths{0.10, 0.25};
// Thicknesses of rings over the length of their elements.
constexpr double k_first_thickness = 0.9;
constexpr double k_largest_thickness = 1.1;
constexpr double k_joint_thickness = 2.4;  ///< of a ring in which four elements meet two
constexpr double k_growth = 1.12;          ///< from ring to ring
constexpr double k_joint_middle = 0.45;
/// Part of a rectangle in the outline of the middle; the rest is a circle.
constexpr double k_squareness = 0.6;
constexpr double k_longitude_refinement = 1.8;

/// Positions from 0 to `length` of `count` elements whose lengths grow linearly to `growth` times the first.
std::vector<double> graded(int count, double growth, double length) {
  std::vector<double> positions{0.0};
  for (int i = 0; i < count; ++i) {
    positions.push_back(positions.back() + 1.0 + (growth - 1.0) * i / std::max(count - 1, 1));
  }
  const double scale = length / positions.back();
  for (double& position : positions) position *= scale;
  return positions;
}

/// Quadrangles of the half meridian: x is the distance from the axis, y the height.
class MeridianMesh {
 public:
  explicit MeridianMesh(const SectorMeshSize& size) {
    std::vector<double> angles = graded(size.meridian, size.pole_refinement, 0.5 * std::numbers::pi);
    surface_ = ring(1.0, angles);
    std::vector<std::size_t> outer = surface_;
    double radius = 1.0;
    for (const Ring& next : rings(size.meridian)) {
      if (next.joins) {
        outer = join(outer, angles, radius, next.thickness);
      } else {
        const std::vector<std::size_t> inner = ring(radius - next.thickness, angles);
        add_strip(outer, inner);
        outer = inner;
      }
      radius -= next.thickness;
    }
    add_core(outer, angles);
  }

  std::vector<Vector2d> nodes;
  std::vector<std::array<std::size_t, 4>> quadrangles;  ///< counterclockwise
  [[nodiscard]] const std::vector<std::size_t>& surface() const noexcept { return surface_; }

 private:
  struct Ring {
    double thickness;
    bool joins;
  };

  /// Rings from the surface to the core. The last one leads to the core's outline, which is flatter than a circle.
  static std::vector<Ring> rings(int surface_elements) {
    std::vector<Ring> list;
    double length = 0.5 * std::numbers::pi / surface_elements;
    double thickness = k_first_thickness * length;
    double depth = 0.0;
    const auto add = [&](double thick, bool joins) {
      list.push_back({thick, joins});
      depth += thick;
    };
    const auto add_rings_to = [&](double end) {
      do {
        add(thickness, false);
        thickness = std::fmin(k_growth * thickness, k_largest_thickness * length);
      } while (depth < end);
    };
    for (const double end : k_coarsening_depths) {
      add_rings_to(end);
      add(k_joint_thickness * length, true);
      length *= 2.0;
      thickness = k_first_thickness * length;
    }
    add_rings_to(1.0 - k_core_radius);
    for (Ring& ring : list) ring.thickness *= (1.0 - k_core_radius) / depth;
    return list;
  }

  std::size_t add_node(const Vector2d& position) {
    nodes.push_back(position);
    return nodes.size() - 1;
  }
  std::vector<std::size_t> ring(double radius, std::span<const double> angles) {
    std::vector<std::size_t> list;
    for (const double angle : angles) list.push_back(add_node(radius * Vector2d(std::sin(angle), std::cos(angle))));
    // Nodes of the planes of symmetry lie on them exactly.
    nodes[list.front()].x() = 0.0;
    nodes[list.back()].y() = 0.0;
    return list;
  }
  void add_quadrangle(std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    quadrangles.push_back({a, b, c, d});
  }
  void add_strip(std::span<const std::size_t> outer, std::span<const std::size_t> inner) {
    for (std::size_t i = 0; i + 1 < outer.size(); ++i) add_quadrangle(inner[i], inner[i + 1], outer[i + 1], outer[i]);
  }

  /// A ring in which every four elements outside meet two inside. `angles` become those of the inner side.
  std::vector<std::size_t> join(std::span<const std::size_t> outer, std::vector<double>& angles, double radius,
                                double thickness) {
    std::vector<double> coarse;
    for (std::size_t i = 0; i < angles.size(); i += 2) coarse.push_back(angles[i]);
    const std::vector<std::size_t> inner = ring(radius - thickness, coarse);
    for (std::size_t i = 0; i + 1 < angles.size(); i += 4) {
      const auto o = outer.subspan(i, 5);
      const std::span n = std::span(inner).subspan(i / 2, 3);
      std::array<std::size_t, 3> m{};
      for (std::size_t k = 0; k < m.size(); ++k) {
        const double angle = angles[i + 1 + k];
        m[k] = add_node((radius - k_joint_middle * thickness) * Vector2d(std::sin(angle), std::cos(angle)));
      }
      add_quadrangle(n[0], m[0], o[1], o[0]);
      add_quadrangle(m[0], m[1], o[2], o[1]);
      add_quadrangle(m[1], m[2], o[3], o[2]);
      add_quadrangle(m[2], n[2], o[4], o[3]);
      add_quadrangle(n[0], n[1], m[1], m[0]);
      add_quadrangle(n[1], n[2], m[2], m[1]);
    }
    angles = std::move(coarse);
    return inner;
  }

  /// Fills the middle by a grid; the outline of the grid is `outline`, moved towards a rectangle.
  void add_core(std::span<const std::size_t> outline, std::span<const double> angles) {
    const std::size_t half = (outline.size() - 1) / 2;
    const double corner = angles[half];
    const Vector2d size = k_core_radius * Vector2d(std::sin(corner), std::cos(corner));
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const double along = static_cast<double>(i) / static_cast<double>(half);
      const Vector2d on_rectangle = size.cwiseProduct(i <= half ? Vector2d(along, 1.0) : Vector2d(1.0, 2.0 - along));
      nodes[outline[i]] = (1.0 - k_squareness) * nodes[outline[i]] + k_squareness * on_rectangle;
    }
    // Node (i, j): i from the axis to the right side, j from the equator to the top.
    std::vector<std::vector<std::size_t>> grid(half + 1, std::vector<std::size_t>(half + 1));
    const Vector2d right = nodes[outline.back()];
    const Vector2d top = nodes[outline.front()];
    const Vector2d far_corner = nodes[outline[half]];
    for (std::size_t i = 0; i <= half; ++i) {
      for (std::size_t j = 0; j <= half; ++j) {
        if (j == half) {
          grid[i][j] = outline[i];
        } else if (i == half) {
          grid[i][j] = outline[2 * half - j];
        } else {
          const Vector2d& above = nodes[outline[i]];
          const Vector2d& beside = nodes[outline[2 * half - j]];
          const double u = above.x() / far_corner.x();
          const double v = beside.y() / far_corner.y();
          const Vector2d below = u * right;
          const Vector2d left = v * top;
          grid[i][j] = add_node((1.0 - v) * below + v * above + (1.0 - u) * left + u * beside -
                                (u * (1.0 - v) * right + (1.0 - u) * v * top + u * v * far_corner));
        }
      }
    }
    for (std::size_t i = 0; i < half; ++i) {
      for (std::size_t j = 0; j < half; ++j) {
        add_quadrangle(grid[i][j], grid[i + 1][j], grid[i + 1][j + 1], grid[i][j + 1]);
      }
    }
  }

  std::vector<std::size_t> surface_;
};

std::vector<double> longitudes_of(const SectorMeshSize& size, double angle) {
  const bool has_wall_at_end = angle > 0.3 * std::numbers::pi;
  if (!has_wall_at_end) return graded(size.longitude, k_longitude_refinement, angle);
  std::vector<double> list = graded(size.longitude, k_longitude_refinement, 0.5 * angle);
  for (std::size_t i = list.size() - 1; i-- > 0;) list.push_back(angle - list[i]);
  return list;
}

}  // namespace

std::vector<std::size_t> SectorMesh::surface_nodes() const {
  std::vector<std::size_t> list;
  for (const auto& line : surface) list.insert(list.end(), line.begin(), line.end());
  return list;
}

SectorMesh sector_mesh(const SectorMeshSize& size, double angle) {
  const MeridianMesh meridian(size);
  SectorMesh mesh;
  mesh.per_longitude = meridian.nodes.size();
  mesh.longitudes = longitudes_of(size, angle);
  for (const double longitude : mesh.longitudes) {
    const std::size_t first = mesh.nodes.size();
    for (const Vector2d& node : meridian.nodes) {
      mesh.nodes.emplace_back(node.x() * std::cos(longitude), node.x() * std::sin(longitude), node.y());
    }
    std::vector<std::size_t>& surface = mesh.surface.emplace_back();
    for (const std::size_t node : meridian.surface()) surface.push_back(first + node);
  }
  for (std::size_t k = 0; k + 1 < mesh.longitudes.size(); ++k) {
    const std::size_t here = k * mesh.per_longitude;
    const std::size_t next = here + mesh.per_longitude;
    for (const auto& [a, b, c, d] : meridian.quadrangles) {
      mesh.bricks.push_back({next + a, next + b, next + c, next + d, here + a, here + b, here + c, here + d});
    }
  }
  for (std::size_t i = 0; i < meridian.nodes.size(); ++i) {
    const bool is_on_axis = meridian.nodes[i].x() == 0.0;
    const bool is_on_equator = meridian.nodes[i].y() == 0.0;
    if (is_on_axis && is_on_equator) mesh.centre = i;
    if (is_on_axis && !is_on_equator) mesh.axis.push_back(i);
    if (is_on_equator && !is_on_axis) mesh.equator.push_back(i);
  }
  return mesh;
}

}  // namespace monograin
