#include "continuum/contact_area.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace monograin {
namespace {

using Eigen::Vector2d;

/// Power of the distance from the edge with which the gap grows: 3/2 for an elastic contact, 1.2 beside a plastic one.
constexpr double k_gap_power = 1.35;

/// A surface seen along the normal of a wall. `distances` grow in proportion to the distance from the contact's edge,
/// and are negative within the contact.
class ContactMap {
 public:
  ContactMap(const SectorSurface& surface, int axis, double height)
      : longitudes_(surface.longitudes), count_(surface.per_longitude()) {
    for (const Eigen::Vector3d& node : surface.nodes) {
      places_.emplace_back(node[(axis + 1) % 3], node[(axis + 2) % 3]);
      const double gap = height - node[axis];
      touches_.push_back(gap <= 0.0);
      distances_.push_back(gap <= 0.0 ? 0.0 : std::pow(gap, 1.0 / k_gap_power));
    }
    for (std::size_t k = 0; k < longitudes_; ++k) {
      for (std::size_t j = 0; j < count_; ++j) {
        if (touches_[index(k, j)]) distances_[index(k, j)] = depth_within(k, j);
      }
    }
  }

  [[nodiscard]] double area() const {
    double sum = 0.0;
    for (std::size_t k = 0; k + 1 < longitudes_; ++k) {
      for (std::size_t j = 0; j + 1 < count_; ++j) {
        const std::array corners{index(k, j), index(k, j + 1), index(k + 1, j + 1), index(k + 1, j)};
        // Half of each division into two triangles: mirror images then have the same area.
        for (std::size_t i = 0; i < corners.size(); ++i) {
          sum += 0.5 * part_of({corners[i], corners[(i + 1) % 4], corners[(i + 2) % 4]});
        }
      }
    }
    return sum;
  }

 private:
  [[nodiscard]] std::size_t index(std::size_t k, std::size_t j) const { return k * count_ + j; }

  /// Distance of a node within the contact from its edge, negative: continued linearly from the next two free nodes
  /// along each line of the mesh, and at most 0.
  [[nodiscard]] double depth_within(std::size_t k, std::size_t j) const {
    double sum = 0.0;
    int number = 0;
    for (const auto& [dk, dj] : {std::array{0, 1}, {0, -1}, {1, 0}, {-1, 0}}) {
      const auto first = neighbour(k, j, dk, dj);
      const auto second = neighbour(k, j, 2 * dk, 2 * dj);
      if (!first || touches_[*first]) continue;
      ++number;
      if (!second || touches_[*second]) continue;
      const std::size_t here = index(k, j);
      const double slope = (distances_[*second] - distances_[*first]) / (places_[*second] - places_[*first]).norm();
      sum += std::fmin(distances_[*first] - slope * (places_[*first] - places_[here]).norm(), 0.0);
    }
    return number == 0 ? 0.0 : sum / number;
  }
  [[nodiscard]] std::optional<std::size_t> neighbour(std::size_t k, std::size_t j, int dk, int dj) const {
    const auto other_k = static_cast<std::ptrdiff_t>(k) + dk;
    const auto other_j = static_cast<std::ptrdiff_t>(j) + dj;
    if (other_k < 0 || other_k >= static_cast<std::ptrdiff_t>(longitudes_)) return std::nullopt;
    if (other_j < 0 || other_j >= static_cast<std::ptrdiff_t>(count_)) return std::nullopt;
    return index(static_cast<std::size_t>(other_k), static_cast<std::size_t>(other_j));
  }

  /// Area of the part of a triangle within the contact; the distance is linear in the triangle.
  [[nodiscard]] double part_of(std::array<std::size_t, 3> corners) const {
    // The corners that touch come first.
    const auto free =
        std::stable_partition(corners.begin(), corners.end(), [this](std::size_t i) { return bool(touches_[i]); });
    const auto touching = static_cast<std::size_t>(free - corners.begin());
    const double whole = area_of(places_[corners[0]], places_[corners[1]], places_[corners[2]]);
    if (touching == 0) return 0.0;
    if (touching == corners.size()) return whole;
    const std::size_t single = touching == 1 ? corners[0] : corners[2];
    double share = 1.0;
    for (const std::size_t corner : corners) {
      if (corner != single) share *= distances_[single] / (distances_[single] - distances_[corner]);
    }
    return touching == 1 ? share * whole : (1.0 - share) * whole;
  }
  static double area_of(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
    const Vector2d u = b - a;
    const Vector2d v = c - a;
    return 0.5 * std::abs(u.x() * v.y() - u.y() * v.x());
  }

  std::size_t longitudes_;
  std::size_t count_;
  std::vector<Vector2d> places_;
  std::vector<bool> touches_;
  std::vector<double> distances_;
};

}  // namespace

double contact_area(const SectorSurface& surface, int axis, double height) {
  return ContactMap(surface, axis, height).area();
}

double volume_below(const SectorSurface& surface) {
  double sixfold = 0.0;
  for (std::size_t k = 0; k + 1 < surface.longitudes; ++k) {
    for (std::size_t j = 0; j + 1 < surface.per_longitude(); ++j) {
      const Eigen::Vector3d& a = surface.at(k, j);
      const Eigen::Vector3d& b = surface.at(k, j + 1);
      const Eigen::Vector3d& c = surface.at(k + 1, j + 1);
      const Eigen::Vector3d& d = surface.at(k + 1, j);
      sixfold += a.dot(b.cross(c)) + a.dot(c.cross(d));
    }
  }
  return std::abs(sixfold) / 6.0;
}

}  // namespace monograin
