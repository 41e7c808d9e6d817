/// The program as models see it: contact classes of walls, controlled quantities, conditions and ramps.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

namespace monograin {

/// Contact class: walls that have the same history by symmetry. One wall is computed, and counts as often as the class
/// has walls.
struct ContactClass {
  std::string name;
  std::vector<Eigen::Vector3d> normals;  ///< unit, outward, one per wall; never empty
  double gap = 0.0;                      ///< distance from the undeformed particle at the start [m], >= 0
  bool takes_force = false;              ///< true if any step of the program prescribes its force

  /// Number of walls of the class.
  [[nodiscard]] double multiplicity() const noexcept { return static_cast<double>(normals.size()); }
};

/// Controlled quantity. At a wall: its displacement [m], positive towards the centre, or the force of one wall [N],
/// positive in compression. Without walls: a strain, a stress [Pa] or a packing fraction, with the signs of the model.
enum class Control { displacement, force, strain, stress, packing_fraction };

/// Quantities that a condition of the program can compare with a value; the last three belong to a material point.
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

/// A condition that ends a step early: a quantity reaches a value, or an event happens.
struct Until {
  Quantity quantity = Quantity::force;
  double value = 0.0;   ///< [SI]
  std::string event{};  ///< name of the event to wait for; empty: wait for the quantity
  std::string wall{};   ///< class or wall whose quantity counts; empty: that of the step

  [[nodiscard]] bool is_event() const noexcept { return !event.empty(); }
  /// True if the condition waits for this quantity to reach its value.
  [[nodiscard]] bool is_of(Quantity other) const noexcept { return !is_event() && quantity == other; }
  [[nodiscard]] bool operator==(const Until&) const = default;
};

/// Largest values that a program prescribes for any wall; 0 for a quantity that the program does not control.
struct Reach {
  double displacement = 0.0;  ///< [m]
  double force = 0.0;         ///< [N]
};

/// Linear ramp of the controlled quantity of one channel, a contact class or a direction, during a step.
struct Ramp {
  double start = 0.0;
  double end = 0.0;
  Control control = Control::displacement;

  [[nodiscard]] bool operator==(const Ramp&) const = default;
  [[nodiscard]] bool is_force_controlled() const noexcept { return control == Control::force; }
  /// Value at a step coordinate; exact at both ends, and to the last digit next to zero.
  [[nodiscard]] double value(double xi) const noexcept { return std::lerp(start, end, xi); }
  /// Rate of the value per step of the program.
  [[nodiscard]] double rate() const noexcept { return end - start; }
  /// 1 if the value grows, -1 if it falls, else 0.
  [[nodiscard]] int direction() const noexcept { return (end > start) - (end < start); }
};

}  // namespace monograin
