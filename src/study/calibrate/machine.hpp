/// The testing machine between the sensor of displacement and the particle: where it touches, and how far its frame
/// gives way.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace monograin {

/// measured displacement = displacement at the particle + offset + compliance * force + deflection(force).
///
/// The measured force is what deflects the frame. Then the particle's displacements are known before the run, and drive
/// it. An error e of the measured force moves them by compliance * e; the residual of a fit to forces is then
/// (1 + compliance * contact stiffness) e.
struct Machine {
  double offset = 0.0;                ///< displacement at first touch [m]
  double compliance = 0.0;            ///< [m/N]
  std::vector<double> forces{};       ///< of a table of deflections, ascending [N]; empty: there is none
  std::vector<double> deflections{};  ///< [m]

  [[nodiscard]] bool is_rigid() const noexcept { return offset == 0.0 && compliance == 0.0 && forces.empty(); }
  /// What the machine adds to the displacement of the particle under this force [m]. The table is continued by its
  /// first and last pieces.
  [[nodiscard]] double addition(double force) const noexcept;
};

/// A compliance with its unit, a length over a force: "20 nm/N".
struct ParsedCompliance {
  std::optional<double> value{};  ///< [m/N]
  std::string unit{};             ///< "nm/N"
  double unit_factor = 1.0;       ///< one unit in m/N
};

/// Nothing in `value` where the text is no number with a unit of length over a unit of force.
[[nodiscard]] ParsedCompliance parse_compliance(std::string_view text);

}  // namespace monograin
