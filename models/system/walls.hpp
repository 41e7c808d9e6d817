/// What the models see of a program: contact classes of walls, and what a step prescribes them, a packing or a material
/// point.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace monograin {

/// Walls that share the same history. One of them is computed; it counts as often as the class has walls.
struct ContactClass {
  std::string name;
  std::vector<Eigen::Vector3d> normals;  ///< unit, outward, one per wall; never empty
  double gap = 0.0;                      ///< distance from the undeformed particle at the start [m], >= 0
  bool takes_force = false;              ///< whether the program ever prescribes its force

  [[nodiscard]] double multiplicity() const noexcept { return static_cast<double>(normals.size()); }
};

/// What is prescribed: at a wall its displacement, towards the centre positive [m], or the force of one wall,
/// compression positive [N]; elsewhere a strain, a stress [Pa] or a packing fraction, with the signs of their model.
enum class Control { displacement, force, strain, stress, packing_fraction };

/// Quantities that a program's condition can ask for; the last three at a material point.
enum class Quantity {
  force,
  displacement,
  pressure,
  contact_radius,
  apparent_radius,
  stress_axial,
  stress_lateral,
  relative_density
};

/// A condition that ends a step before its time: a quantity reaches a value, or an event happens.
struct Until {
  Quantity quantity = Quantity::force;
  double value = 0.0;   ///< [SI]
  std::string event{};  ///< its name; empty: the condition is the quantity's

  [[nodiscard]] bool is_event() const noexcept { return !event.empty(); }
  /// Whether it is that quantity which is to reach the value.
  [[nodiscard]] bool is_of(Quantity other) const noexcept { return !is_event() && quantity == other; }
  [[nodiscard]] bool operator==(const Until&) const = default;
};

/// How far a program goes with any wall; 0 where it prescribes no such thing.
struct Reach {
  double displacement = 0.0;  ///< [m]
  double force = 0.0;         ///< [N]
};

/// Linear ramp of the controlled quantity of one channel, a contact class or a direction, during a step.
struct Ramp {
  double start = 0.0;
  double end = 0.0;
  Control control = Control::displacement;
};

}  // namespace monograin
