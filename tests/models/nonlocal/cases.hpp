/// Wall sets and reference data for the tests of the nonlocal formulation.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "history/table.hpp"
#include "models/accuracy.hpp"
#include "nonlocal/contacts.hpp"
#include "nonlocal/equilibrium.hpp"
#include "nonlocal/setup.hpp"
#include "support/refusal.hpp"
#include "system/walls.hpp"

namespace monograin::nonlocal {

inline constexpr double k_degree = std::numbers::pi / 180.0;
inline constexpr double k_rubber = 0.48;  // Poisson's ratio of most reference data
inline constexpr std::array k_all_terms{Terms::one, Terms::two, Terms::three, Terms::four, Terms::all};

inline Table reference(const std::string& file) {
  return read_csv(MONOGRAIN_SOURCE_DIR "/tests/models/nonlocal/reference/" + file + ".csv");
}

inline ContactClass both_sides(std::string name, const Eigen::Vector3d& normal) {
  return {.name = std::move(name), .normals = {normal, -normal}};
}

inline std::vector<ContactClass> simple() { return {both_sides("axial", Eigen::Vector3d::UnitZ())}; }

inline std::vector<ContactClass> die() {
  return {both_sides("axial", Eigen::Vector3d::UnitZ()),
          {.name = "lateral",
           .normals = {Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
                       -Eigen::Vector3d::UnitY()}}};
}

inline std::vector<ContactClass> hydrostatic() {
  std::vector<ContactClass> classes = die();
  auto& all = classes[0].normals;
  all.insert(all.end(), classes[1].normals.begin(), classes[1].normals.end());
  classes.pop_back();
  return classes;
}

/// A die with two or four further walls, at an angle from the lateral ones on the y axis.
inline std::vector<ContactClass> oblique_die(double degrees = 37.5, int oblique_walls = 2) {
  const double c = std::cos(degrees * k_degree);
  const double s = std::sin(degrees * k_degree);
  std::vector<ContactClass> classes{
      both_sides("axial", Eigen::Vector3d::UnitZ()), both_sides("lateral-x", Eigen::Vector3d::UnitX()),
      both_sides("lateral-y", Eigen::Vector3d::UnitY()), both_sides("oblique", {0.0, c, s})};
  if (oblique_walls == 4) {
    classes[3].normals.emplace_back(0.0, c, -s);
    classes[3].normals.emplace_back(0.0, -c, s);
  }
  return classes;
}

inline std::vector<ContactClass> wall_set(std::string_view name) {
  if (name == "simple") return simple();
  if (name == "die") return die();
  if (name == "hydrostatic") return hydrostatic();
  return oblique_die();
}

/// Classes of one wall each, in the order of the given classes.
inline std::vector<ContactClass> single_walls(std::span<const ContactClass> classes) {
  std::vector<ContactClass> walls;
  for (const ContactClass& group : classes) {
    for (const Eigen::Vector3d& normal : group.normals) walls.push_back({.name = group.name, .normals = {normal}});
  }
  return walls;
}

inline std::vector<ContactClass> turned(std::vector<ContactClass> classes, const Eigen::Quaterniond& rotation) {
  for (ContactClass& group : classes) {
    for (Eigen::Vector3d& normal : group.normals) normal = rotation * normal;
  }
  return classes;
}

/// Cases with one column group per wall.
struct SingleWalls {
  std::vector<std::string> names;
  std::vector<Eigen::Vector3d> normals;

  [[nodiscard]] std::vector<ContactClass> classes() const {
    std::vector<ContactClass> list;
    for (std::size_t i = 0; i < names.size(); ++i) list.push_back({.name = names[i], .normals = {normals[i]}});
    return list;
  }
};

inline SingleWalls trigonal_walls() {
  SingleWalls walls{.names = {"z+", "z-", "l0", "l120", "l240"},
                    .normals = {Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitZ()}};
  for (const double degrees : {0.0, 120.0, 240.0})
    walls.normals.emplace_back(std::cos(degrees * k_degree), std::sin(degrees * k_degree), 0.0);
  return walls;
}

struct Scene {
  const char* name;
  std::vector<ContactClass> classes;
  Centre centre;
  double poisson_ratio;
  std::vector<double> displacements;
};

inline std::vector<Scene> scenes() {
  return {{"die", die(), Centre::fixed, k_rubber, {0.35, 0.02}},
          {"die with open walls", single_walls(die()), Centre::free, k_rubber, {0.2, 0.2, 0.01, 0.03, -0.1, -0.1}},
          {"oblique die", oblique_die(), Centre::fixed, 0.3, {0.2, 0.01, 0.0, -0.01}},
          {"close walls", oblique_die(20.0, 4), Centre::fixed, k_rubber, {0.3, 0.01, 0.01, 0.0}},
          {"trigonal", trigonal_walls().classes(), Centre::free, 0.4, {0.15, 0.13, 0.0, 0.04, -0.01}}};
}

/// Constant displacements, or forces.
inline std::vector<Ramp> held(std::span<const double> values, Control control = Control::displacement) {
  std::vector<Ramp> ramps;
  for (const double value : values) ramps.push_back({.start = value, .end = value, .control = control});
  return ramps;
}

/// The first class goes from 0 to a displacement, all others stay at first touch.
inline std::vector<Ramp> compression(std::size_t class_count, double displacement) {
  std::vector<Ramp> ramps(class_count);
  ramps[0].end = displacement;
  return ramps;
}

/// The contacts of a state, by value.
inline std::vector<ContactState> states_of(Contacts& contacts, std::span<const double> y) {
  std::vector<ContactState> states(contacts.class_count());
  contacts.contacts(y, states);
  return states;
}

/// Moves a state to the equilibrium at an instant of a step.
inline void solve(Contacts& contacts, std::span<const Ramp> ramps, double xi, std::span<double> y) {
  EquilibriumSearch(contacts).solve(contacts, ramps, xi, y);
}

/// State under displacements, found from the unloaded one.
inline std::vector<double> state_under(Contacts& contacts, std::span<const double> displacements) {
  std::vector<double> y(contacts.unknown_count(), 0.0);
  for (std::size_t j = 0; j < displacements.size(); ++j) y[j] = std::min(displacements[j], 0.0);
  solve(contacts, held(displacements), 1.0, y);
  return y;
}

/// Settings of a sphere of radius 1 and Young's modulus 1.
inline Settings unit_settings(Centre centre = Centre::fixed) {
  return {.model = {.poisson_ratio = k_rubber},
          .initial_radius = 1.0,
          .youngs_modulus = 1.0,
          .centre = centre,
          .reach = {.displacement = 0.3}};
}

}  // namespace monograin::nonlocal
