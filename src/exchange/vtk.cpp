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
#include "history/staged_folder.hpp"
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

/// True if a contact has a pressure at some time.
bool has_pressures(const Motion& motion) {
  return std::ranges::any_of(motion.instants, [](const MotionInstant& instant) {
    return std::ranges::any_of(instant.contacts, [](const ContactInstant& c) { return !std::isnan(c.pressure); });
  });
}

/// The particle as the motion goes on: its files share the triangles of one sphere.
class Particle {
 public:
  explicit Particle(const Motion& motion) : motion_(motion), has_pressure_(has_pressures(motion)) {
    for (const MovingWall& wall : motion.walls) planes_.push_back({wall.normal, k_infinity});
    for (const auto& triangle : sphere_.triangles) corners_.insert(corners_.end(), triangle.begin(), triangle.end());
  }

  /// Goes on to the next instant. A wall that bears a force cuts where it is; another one leaves the cut where it last
  /// pressed, or pushes it in.
  void follow(const MotionInstant& instant) {
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      const MovingWall& wall = motion_.walls[i];
      const double distance = motion_.distance(wall, instant);
      const bool presses = instant.contacts[wall.contact_class].force != 0.0;
      planes_[i].distance = presses ? distance : std::min(planes_[i].distance, distance);
    }
  }

  /// File of the instant that was followed last.
  [[nodiscard]] std::string text(const MotionInstant& instant) const {
    std::vector<Eigen::Vector3d> positions;
    std::vector<Eigen::Vector3d> displacements;
    std::vector<double> pressures;
    std::vector<double> walls;
    for (const CutPoint& point : cut_sphere(sphere_, instant.radius, planes_)) {
      const Eigen::Vector3d& corner = sphere_.points[positions.size()];
      positions.emplace_back(instant.centre + point.position);
      displacements.emplace_back(positions.back() - motion_.initial_radius * corner);
      pressures.push_back(pressure_at(point, instant));
      walls.push_back(point.plane + 1);
    }
    PolyData data(positions);
    data.add_polygons(corners_, 3);
    data.add_point_vectors("displacement", displacements);
    if (has_pressure_) data.add_point_values("pressure", pressures);
    data.add_point_values("wall", walls);
    return data.text();
  }

 private:
  [[nodiscard]] double pressure_at(const CutPoint& point, const MotionInstant& instant) const {
    if (point.plane < 0) return 0.0;
    const MovingWall& wall = motion_.walls[static_cast<std::size_t>(point.plane)];
    const ContactInstant& contact = instant.contacts[wall.contact_class];
    const double from_axis = (point.position - point.position.dot(wall.normal) * wall.normal).norm();
    return contact.force == 0.0 || from_axis > contact.radius ? 0.0 : contact.pressure;
  }

  const Motion& motion_;
  bool has_pressure_;
  SurfaceMesh sphere_ = unit_sphere(k_sphere_levels);
  std::vector<int> corners_{};  ///< of all triangles
  std::vector<CuttingPlane> planes_{};
};

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
  const std::size_t count = motion.instants.size();
  const std::size_t written = std::min(count, k_most_instants);
  Particle particle(motion);
  std::string list;
  std::size_t number = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const MotionInstant& instant = motion.instants[i];
    particle.follow(instant);
    // The first and the last are among them.
    if (written > 1 && i != number * (count - 1) / (written - 1)) continue;
    const std::array parts{std::pair{"particle", particle.text(instant)},
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

void save_vtk(const CheckedScenario& scenario, const Table& history, const fs::path& target) {
  StagedFolder staged(target, k_vtk_series);
  write_vtk(motion_of(scenario, history), staged.path());
  staged.publish(staged.age());
}

}  // namespace monograin
