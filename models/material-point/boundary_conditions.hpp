/// Boundary conditions of a material point: the test prescribes the logarithmic strain or the stress of two channels.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "system/walls.hpp"

namespace monograin::material_point {

enum class Channel : std::size_t { axial, lateral };

/// Ramps of both channels during a step of the program.
class BoundaryConditions {
 public:
  BoundaryConditions() = default;
  /// @param ramps           of the axial and the lateral channel; a single one drives both alike
  /// @param yield_pressure  [Pa], unit of the stresses below
  BoundaryConditions(std::span<const Ramp> ramps, double yield_pressure) {
    for (std::size_t channel = 0; channel < ramps_.size(); ++channel) {
      Ramp& ramp = ramps_[channel];
      ramp = ramps[std::min(channel, ramps.size() - 1)];
      if (ramp.control != Control::stress) continue;
      ramp.start /= yield_pressure;
      ramp.end /= yield_pressure;
    }
  }

  [[nodiscard]] bool is_stress(Channel channel) const noexcept { return ramp(channel).control == Control::stress; }
  [[nodiscard]] bool are_stresses() const noexcept { return is_stress(Channel::axial) && is_stress(Channel::lateral); }
  [[nodiscard]] bool are_strains() const noexcept { return !is_stress(Channel::axial) && !is_stress(Channel::lateral); }
  /// Prescribed strain, or stress in yield pressures.
  [[nodiscard]] double value(Channel channel, double xi) const noexcept { return ramp(channel).value(xi); }
  /// Rate of the prescribed value per step of the program.
  [[nodiscard]] double rate(Channel channel) const noexcept { return ramp(channel).rate(); }

 private:
  [[nodiscard]] const Ramp& ramp(Channel channel) const noexcept { return ramps_[static_cast<std::size_t>(channel)]; }

  std::array<Ramp, 2> ramps_{};
};

}  // namespace monograin::material_point
