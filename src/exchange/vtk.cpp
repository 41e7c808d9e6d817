#include "exchange/vtk.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "exchange/sphere_mesh.hpp"
#include "scenario/text_file.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_most_instants = 200;
constexpr int k_sphere_levels = 4;
/// Side of the square that stands for a wall, over R0.
constexpr double k_wall_side = 2.4;

constexpr std::string_view k_byte_order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";

/// Polygons with values at their points and of themselves, as text of a .vtp file with raw binary data at its end.
class PolyData {
 public:
  explicit PolyData(std::span<const Eigen::Vector3d> points) : point_count_(points.size()) {
    points_ = array<float>("", "Float32", 3, coordinates(points));
  }

  void add_polygons(std::span<const int> corners, std::size_t corners_each) {
    const std::vector<std::int32_t> connectivity(corners.begin(), corners.end());
    std::vector<std::int32_t> ends;
    for (std::size_t end = corners_each; end <= corners.size(); end += corners_each) {
      ends.push_back(static_cast<std::int32_t>(end));
    }
    polygon_count_ = ends.size();
    polygons_ = array<std::int32_t>("connectivity", "Int32", 1, connectivity) +
                array<std::int32_t>("offsets", "Int32", 1, ends);
  }
  void add_point_vectors(std::string_view name, std::span<const Eigen::Vector3d> values) {
    point_data_ += array<float>(name, "Float32", 3, coordinates(values));
  }
  void add_point_values(std::string_view name, std::span<const double> values) {
    point_data_ += array<float>(name, "Float32", 1, std::vector<float>(values.begin(), values.end()));
  }
  void add_polygon_values(std::string_view name, std::span<const double> values) {
    polygon_data_ += array<float>(name, "Float32", 1, std::vector<float>(values.begin(), values.end()));
  }

  [[nodiscard]] std::string text() const {
    std::string text = fmt::format(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\">\n"
        "<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfPolys=\"{}\">\n"
        "<PointData>\n{}</PointData>\n<CellData>\n{}</CellData>\n<Points>\n{}</Points>\n<Polys>\n{}</Polys>\n"
        "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_",
        k_byte_order, point_count_, polygon_count_, point_data_, polygon_data_, points_, polygons_);
    text += appended_;
    text += "\n</AppendedData>\n</VTKFile>\n";
    return text;
  }

 private:
  static std::vector<float> coordinates(std::span<const Eigen::Vector3d> vectors) {
    std::vector<float> values;
    for (const Eigen::Vector3d& vector : vectors) {
      for (const double component : vector) values.push_back(static_cast<float>(component));
    }
    return values;
  }

  /// Appends the bytes of an array; returns the element that describes it.
  template <class Value>
  std::string array(std::string_view name, std::string_view type, int components, const std::vector<Value>& values) {
    const std::size_t offset = appended_.size();
    const std::uint64_t size = values.size() * sizeof(Value);
    appended_.resize(offset + sizeof(size) + size);
    std::memcpy(appended_.data() + offset, &size, sizeof(size));
    if (size > 0) std::memcpy(appended_.data() + offset + sizeof(size), values.data(), size);
    return fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n", type,
        name, components, offset);
  }

  std::size_t point_count_;
  std::size_t polygon_count_ = 0;
  std::string points_;
  std::string polygons_;
  std::string point_data_;
  std::string polygon_data_;
  std::string appended_;
};

/// Planes that cut the particle, as the motion goes on.
class Cuts {
 public:
  explicit Cuts(const Motion& motion) : motion_(motion) {
    for (const MovingWall& wall : motion.walls) planes_.push_back({wall.normal, k_infinity});
  }

  /// A wall that bears a force cuts where it is; another one leaves the cut where it last pressed, or pushes it in.
  void follow(const MotionInstant& instant) {
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      const MovingWall& wall = motion_.walls[i];
      const double distance = motion_.distance(wall, instant);
      const bool presses = instant.contacts[wall.contact_class].force != 0.0;
      planes_[i].distance = presses ? distance : std::min(planes_[i].distance, distance);
    }
  }
  [[nodiscard]] std::span<const CuttingPlane> planes() const noexcept { return planes_; }

 private:
  const Motion& motion_;
  std::vector<CuttingPlane> planes_{};
};

/// True if a contact has a pressure at some time.
bool has_pressures(const Motion& motion) {
  return std::ranges::any_of(motion.instants, [](const MotionInstant& instant) {
    return std::ranges::any_of(instant.contacts, [](const ContactInstant& c) { return !std::isnan(c.pressure); });
  });
}

std::string particle_text(const Motion& motion, const MotionInstant& instant, std::span<const CuttingPlane> planes,
                          const SurfaceMesh& sphere, bool has_pressure) {
  const std::vector<CutPoint> cut = cut_sphere(sphere, instant.radius, planes);
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3d> displacements;
  std::vector<double> pressures;
  std::vector<double> walls;
  for (std::size_t i = 0; i < cut.size(); ++i) {
    const Eigen::Vector3d& from_centre = cut[i].position;
    positions.emplace_back(instant.centre + from_centre);
    displacements.emplace_back(positions.back() - motion.initial_radius * sphere.points[i]);
    walls.push_back(cut[i].plane + 1);
    double pressure = 0.0;
    if (cut[i].plane >= 0) {
      const MovingWall& wall = motion.walls[static_cast<std::size_t>(cut[i].plane)];
      const ContactInstant& contact = instant.contacts[wall.contact_class];
      const double from_axis = (from_centre - from_centre.dot(wall.normal) * wall.normal).norm();
      if (contact.force != 0.0 && !(from_axis > contact.radius)) pressure = contact.pressure;
    }
    pressures.push_back(pressure);
  }
  std::vector<int> corners;
  for (const auto& triangle : sphere.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  PolyData data(positions);
  data.add_polygons(corners, 3);
  data.add_point_vectors("displacement", displacements);
  if (has_pressure) data.add_point_values("pressure", pressures);
  data.add_point_values("wall", walls);
  return data.text();
}

std::string walls_text(const Motion& motion, const MotionInstant& instant) {
  std::vector<Eigen::Vector3d> points;
  std::vector<int> corners;
  std::vector<double> forces;
  std::vector<double> displacements;
  const double half = 0.5 * k_wall_side * motion.initial_radius;
  for (const MovingWall& wall : motion.walls) {
    const Eigen::Vector3d middle = instant.centre + motion.distance(wall, instant) * wall.normal;
    const Eigen::Vector3d across = wall.normal.unitOrthogonal();
    const Eigen::Vector3d along = wall.normal.cross(across);
    for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      corners.push_back(static_cast<int>(points.size()));
      points.emplace_back(middle + half * (a * across + b * along));
    }
    forces.push_back(instant.contacts[wall.contact_class].force);
    displacements.push_back(instant.contacts[wall.contact_class].displacement);
  }
  PolyData data(points);
  data.add_polygons(corners, 4);
  data.add_polygon_values("force", forces);
  data.add_polygon_values("displacement", displacements);
  return data.text();
}

}  // namespace

void write_vtk(const Motion& motion, const fs::path& folder) {
  const SurfaceMesh sphere = unit_sphere(k_sphere_levels);
  const bool has_pressure = has_pressures(motion);
  const std::size_t count = motion.instants.size();
  const std::size_t written = std::min(count, k_most_instants);
  Cuts cuts(motion);
  std::string list;
  std::size_t number = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const MotionInstant& instant = motion.instants[i];
    cuts.follow(instant);
    // The first and the last are among them.
    if (written > 1 && i != number * (count - 1) / (written - 1)) continue;
    const std::array parts{std::pair{"particle", particle_text(motion, instant, cuts.planes(), sphere, has_pressure)},
                           std::pair{"walls", walls_text(motion, instant)}};
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const std::string name = fmt::format("{}-{:04}.vtp", parts[part].first, number);
      write_text_file(folder / name, parts[part].second);
      list += fmt::format("<DataSet timestep=\"{}\" part=\"{}\" file=\"{}\"/>\n", instant.time, part, name);
    }
    ++number;
  }
  write_text_file(folder / k_vtk_series,
                  fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
                              "byte_order=\"{}\">\n<Collection>\n{}</Collection>\n</VTKFile>\n",
                              k_byte_order, list));
}

}  // namespace monograin
