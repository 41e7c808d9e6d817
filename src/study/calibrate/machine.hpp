/// The testing machine between sensors and particle: its first touch, its frame's deflection, its load cell's zero.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace monograin {

/// measured displacement = displacement at the particle + offset + compliance * force + deflection(force),
/// measured force = force of the particle + force_offset.
struct Machine {
  double offset = 0.0;                ///< displacement at first touch [m]
  double force_offset = 0.0;          ///< shown without a load [N]
  double compliance = 0.0;            ///< [m/N]
  std::vector<double> forces{};       ///< of a table of deflections, ascending [N]; empty: there is none
  std::vector<double> deflections{};  ///< [m]

  [[nodiscard]] bool adds_nothing() const noexcept {
    return offset == 0.0 && force_offset == 0.0 && compliance == 0.0 && forces.empty();
  }
  /// Displacement [m] that the machine adds to that of the particle under its force. Beyond its ends, a table of
  /// deflections is continued by its first and last pieces.
  [[nodiscard]] double addition(double force) const noexcept;
};

/// Computes the forces of a particle that is driven through displacements; false if it cannot follow them.
using ForcesOf = std::function<bool(const std::vector<double>& particle, std::span<double> forces)>;

/// Finds the displacements at the particle for which the machine in series with it shows x. The frame is deflected by
/// the particle's computed force, not by the measured one, whose error would enter the displacements: an error in the
/// regressors that also turns the particle back and forth.
///
/// Finds all displacements by secants, with one run of the particle for each iteration. They rise and fall with x as
/// long as the particle does not soften more than the frame. Where the particle's force jumps and the machine's line
/// passes through the jump, the force is the middle of the jump.
/// @param tolerance  of the displacements [m]
/// @param particle   first guess, and result
/// @param forces     at the result
/// @return false if the particle cannot follow, or the search fails
[[nodiscard]] bool put_in_series(const Machine& machine, std::span<const double> x, const ForcesOf& forces_of,
                                 double tolerance, std::vector<double>& particle, std::span<double> forces);

/// A compliance with its unit, a length over a force: "20 nm/N".
struct ParsedCompliance {
  std::optional<double> value{};  ///< [m/N]
  std::string unit{};             ///< "nm/N"
  double unit_factor = 1.0;       ///< one unit in m/N
};

/// Parses a compliance; `value` is empty if the text is no number with a unit of length over a unit of force.
[[nodiscard]] ParsedCompliance parse_compliance(std::string_view text);

}  // namespace monograin
