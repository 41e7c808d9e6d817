/// The testing machine between the sensor of displacement and the particle: where it touches, and how far its frame
/// gives way.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace monograin {

/// measured displacement = displacement at the particle + offset + compliance * force + deflection(force).
struct Machine {
  double offset = 0.0;                ///< displacement at first touch [m]
  double compliance = 0.0;            ///< [m/N]
  std::vector<double> forces{};       ///< of a table of deflections, ascending [N]; empty: there is none
  std::vector<double> deflections{};  ///< [m]

  [[nodiscard]] bool is_rigid() const noexcept { return offset == 0.0 && compliance == 0.0 && forces.empty(); }
  /// Displacement [m] that the machine adds to that of the particle under this force. The table is continued by its
  /// first and last pieces.
  [[nodiscard]] double addition(double force) const noexcept;
};

/// Forces of a particle that is driven through displacements; false where it cannot follow.
using ForcesOf = std::function<bool(const std::vector<double>& particle, std::span<double> forces)>;

/// Finds the displacements at the particle that the machine shows as x, machine and particle in series: the particle's
/// own force deflects the frame, not the one that was measured. Its error then stays out of the displacements, where it
/// would be an error of the regressors, and turn the particle back and forth.
///
/// Each displacement is found by secants, all of them with one run of the particle. As long as the particle does not
/// soften more than the frame, its displacements rise and fall with x. Where its force jumps and the machine's
/// line goes through the jump, the force is the middle of the jump.
/// @param tolerance  of the displacements [m]
/// @param particle   first guess, and result
/// @param forces     those of the result
/// @return false where the particle cannot follow, or nothing was found
[[nodiscard]] bool put_in_series(const Machine& machine, std::span<const double> x, const ForcesOf& forces_of,
                                 double tolerance, std::vector<double>& particle, std::span<double> forces);

/// A compliance with its unit, a length over a force: "20 nm/N".
struct ParsedCompliance {
  std::optional<double> value{};  ///< [m/N]
  std::string unit{};             ///< "nm/N"
  double unit_factor = 1.0;       ///< one unit in m/N
};

/// Nothing in `value` where the text is no number with a unit of length over a unit of force.
[[nodiscard]] ParsedCompliance parse_compliance(std::string_view text);

}  // namespace monograin
