/// Observables of a model: what histories, programs and figures read from the state of a system.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "system/walls.hpp"

namespace monograin {

/// A warning for the user, with the value of the quantity that caused it.
struct Diagnostic {
  std::string message;
  std::string_view quantity;  ///< name of the quantity, e.g. "E/Y"
  double value = 0.0;
};

/// A column of the history that the system computes.
struct Observable {
  std::string name;
  std::string unit;
  std::span<const std::string_view> words;  ///< if not empty, the value is an index into `words`
};

/// Quantities of a wall and its contact, in SI units.
struct AtWall {
  double force = 0.0;
  double displacement = 0.0;
  double pressure = 0.0;
  double contact_radius = 0.0;
  double apparent_radius = 0.0;
};

/// Selects one quantity of a wall, in SI units.
/// @throws std::logic_error for a quantity that walls do not have
[[nodiscard]] inline double quantity_of(const AtWall& wall, Quantity quantity) {
  switch (quantity) {
    case Quantity::force:
      return wall.force;
    case Quantity::displacement:
      return wall.displacement;
    case Quantity::pressure:
      return wall.pressure;
    case Quantity::contact_radius:
      return wall.contact_radius;
    case Quantity::apparent_radius:
      return wall.apparent_radius;
    default:
      throw std::logic_error("no such quantity at a wall");
  }
}

/// Points of a surface from the middle of a contact to its edge.
inline constexpr int k_surface_points = 128;

/// State of the particle's surface at one radius, under or around a contact.
struct SurfacePoint {
  double radius = 0.0;          ///< distance from the contact's middle [m]
  double pressure = 0.0;        ///< compression positive [Pa]
  double displacement = 0.0;    ///< displacement of the surface into the particle [m]
  double relaxed_height = 0.0;  ///< height of the unloaded surface relative to its middle [m]; NaN if unknown
};

/// Names of the observables that are energies: the work, the stored energy and the dissipation.
inline constexpr std::array<std::string_view, 3> k_energy_observables{"work", "stored_energy", "dissipation"};
/// True if the observable is the work, the stored energy or the dissipation.
[[nodiscard]] constexpr bool is_energy(std::string_view observable) noexcept {
  return std::ranges::find(k_energy_observables, observable) != k_energy_observables.end();
}

/// Observables of a system.
class Observables {
 public:
  /// Columns of the history that this system computes.
  [[nodiscard]] virtual std::span<const Observable> observables() const noexcept = 0;
  /// Computes the value of every observable in its unit, in the order of observables(); NaN if it is undefined.
  virtual void observe(double xi, std::span<const double> y, std::span<double> values) = 0;

  /// Present value of one quantity of one channel, in SI units.
  /// @throws std::logic_error for a quantity that scenarios cannot ask of this model
  [[nodiscard]] virtual double quantity(Quantity quantity, int channel, double xi, std::span<const double> y) = 0;
  /// Present value, in SI units, of the quantity that a control prescribes for a channel; a new ramp starts from it.
  /// The displacement of a wall is its position, counted towards the initial position of the centre.
  /// @throws std::logic_error for a control that scenarios cannot use with this model
  [[nodiscard]] virtual double controlled(Control control, int channel, double xi, std::span<const double> y) = 0;
  /// Pressure and surface under a contact, from its middle outwards; empty if it is open, or the model has no surface.
  [[nodiscard]] virtual std::vector<SurfacePoint> surface(int /*contact_class*/, double /*xi*/,
                                                          std::span<const double> /*y*/) {
    return {};
  }

  /// Warnings for the user that this run has collected so far.
  [[nodiscard]] virtual std::vector<Diagnostic> warnings() const { return {}; }

 protected:
  Observables() = default;
  Observables(const Observables&) = default;
  Observables& operator=(const Observables&) = default;
  ~Observables() = default;
};

}  // namespace monograin
