#include "exchange/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>

#include "scene/scene.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

/// Columns of a contact class; those that a law may lack are empty.
struct ContactColumns {
  std::size_t displacement;
  std::size_t force;
  std::optional<std::size_t> radius;
  std::optional<std::size_t> pressure;
};

std::size_t column_of(const Table& history, const std::string& name) {
  if (const auto column = history.find(name)) return *column;
  throw std::invalid_argument("the history has no column " + name);
}

double value_of(const Table& history, std::size_t row, std::optional<std::size_t> column, double otherwise) {
  return column ? history.at(row, *column) : otherwise;
}

}  // namespace

bool Motion::moves(std::size_t contact_class) const {
  const auto displacement = [&](const MotionInstant& instant) { return instant.contacts[contact_class].displacement; };
  return std::ranges::any_of(
      instants, [&](const MotionInstant& instant) { return displacement(instant) != displacement(instants.front()); });
}

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
                        history.find(contact.name + ".contact_radius"), history.find(contact.name + ".pressure")});
  }
  const std::size_t time = column_of(history, "time");
  const auto radius = history.find("apparent_radius");
  const std::array centre{history.find("centre_x"), history.find("centre_y"), history.find("centre_z")};
  const std::size_t count = history.row_count();
  for (std::size_t row = 0; row < count; ++row) {
    const double now = history.at(row, time);
    if (row + 1 < count && history.at(row + 1, time) == now) continue;
    MotionInstant instant{.time = now, .radius = value_of(history, row, radius, scenario.radius)};
    for (std::size_t k = 0; k < centre.size(); ++k) {
      instant.centre[static_cast<Eigen::Index>(k)] = value_of(history, row, centre[k], 0.0);
    }
    for (const ContactColumns& columns : contacts) {
      instant.contacts.push_back({history.at(row, columns.displacement), history.at(row, columns.force),
                                  value_of(history, row, columns.radius, k_nan),
                                  value_of(history, row, columns.pressure, k_nan)});
    }
    motion.instants.push_back(std::move(instant));
  }
  return motion;
}

}  // namespace monograin
