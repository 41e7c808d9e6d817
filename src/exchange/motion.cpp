#include "exchange/motion.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <stdexcept>

#include "scene/scene.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

/// Column of a history that a law may lack.
class OptionalColumn {
 public:
  OptionalColumn(const Table& table, const std::string& name, double otherwise)
      : table_(table), index_(table.find(name)), otherwise_(otherwise) {}

  [[nodiscard]] double at(std::size_t row) const { return index_ ? table_.at(row, *index_) : otherwise_; }

 private:
  const Table& table_;
  std::optional<std::size_t> index_;
  double otherwise_;
};

/// Column that every history has.
std::vector<double> column_of(const Table& history, const std::string& name) {
  if (!history.find(name)) throw std::invalid_argument("the history has no column " + name);
  return history.column(name);
}

struct ContactColumns {
  std::vector<double> displacement;
  std::vector<double> force;
  OptionalColumn radius;
  OptionalColumn pressure;
};

}  // namespace

Motion motion_of(const CheckedScenario& scenario, const Table& history) {
  const Scene scene = make_scene(scenario);
  if (scene.classes.empty()) {
    throw std::invalid_argument(fmt::format("model {} has no particle between walls", scenario.model));
  }
  Motion motion{.header = history.header, .initial_radius = scenario.radius};
  std::vector<ContactColumns> contacts;
  for (std::size_t i = 0; i < scene.classes.size(); ++i) {
    const ContactClass& contact = scene.classes[i];
    motion.classes.push_back(contact.name);
    for (std::size_t k = 0; k < contact.normals.size(); ++k) {
      motion.walls.push_back({scene.walls[i][k], contact.normals[k], i});
    }
    contacts.push_back({column_of(history, contact.name + ".displacement"), column_of(history, contact.name + ".force"),
                        OptionalColumn(history, contact.name + ".contact_radius", k_nan),
                        OptionalColumn(history, contact.name + ".pressure", k_nan)});
  }
  const std::vector<double> time = column_of(history, "time");
  const OptionalColumn radius(history, "apparent_radius", scenario.radius);
  const std::array centre{OptionalColumn(history, "centre_x", 0.0), OptionalColumn(history, "centre_y", 0.0),
                          OptionalColumn(history, "centre_z", 0.0)};
  for (std::size_t row = 0; row < time.size(); ++row) {
    if (row + 1 < time.size() && time[row + 1] == time[row]) continue;
    MotionInstant instant{.time = time[row],
                          .radius = radius.at(row),
                          .centre = {centre[0].at(row), centre[1].at(row), centre[2].at(row)}};
    for (const ContactColumns& columns : contacts) {
      instant.contacts.push_back(
          {columns.displacement[row], columns.force[row], columns.radius.at(row), columns.pressure.at(row)});
    }
    motion.instants.push_back(std::move(instant));
  }
  return motion;
}

}  // namespace monograin
