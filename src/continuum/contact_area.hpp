/// Contact area and volume of a deformed sector.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace monograin {

/// Positions of the surface nodes of a sector, longitude by longitude, each from the pole to the equator.
struct SectorSurface {
  std::span<const Eigen::Vector3d> nodes;
  std::size_t longitudes = 0;

  [[nodiscard]] std::size_t per_longitude() const noexcept { return nodes.size() / longitudes; }
  [[nodiscard]] const Eigen::Vector3d& at(std::size_t longitude, std::size_t index) const {
    return nodes[longitude * per_longitude() + index];
  }
};

/// Area of the part of a surface that touches a flat wall at a height along an axis. The edge of the contact lies
/// between nodes: the surface leaves the wall as a power of the distance from the edge.
[[nodiscard]] double contact_area(const SectorSurface& surface, int axis, double height);

/// Volume between a surface and the origin.
[[nodiscard]] double volume_below(const SectorSurface& surface);

}  // namespace monograin
