/// The ramp of one wall during a step of the program.
#pragma once

#include <algorithm>
#include <cmath>

#include "system/resolution.hpp"
#include "system/walls.hpp"

namespace monograin::contacts {

/// A wall this near to the centre of the particle (over R0) has reached it.
inline constexpr double k_least_distance = 1e-3;

/// Linear ramp of a wall's displacement over R0, or of its force over the law's unit, during one step. All its values
/// are exact: no integrator computes them.
class WallDrive {
 public:
  WallDrive() = default;
  /// @param unit  unit of what the ramp controls, a displacement [m] or a force [N]
  WallDrive(const Ramp& ramp, double unit)
      : ramp_{ramp.start / unit, ramp.end / unit, ramp.control}, direction_(ramp_.direction()) {}

  [[nodiscard]] bool operator==(const WallDrive&) const = default;
  [[nodiscard]] bool is_force_controlled() const noexcept { return ramp_.is_force_controlled(); }
  [[nodiscard]] double start() const noexcept { return ramp_.start; }
  [[nodiscard]] double end() const noexcept { return ramp_.end; }
  [[nodiscard]] double value(double xi) const noexcept { return ramp_.value(xi); }
  [[nodiscard]] double rate() const noexcept { return ramp_.rate(); }
  /// 1 loading, -1 unloading, 0 holding.
  [[nodiscard]] int direction() const noexcept { return direction_; }
  /// Largest magnitude on the ramp.
  [[nodiscard]] double size() const noexcept { return std::max(std::abs(ramp_.start), std::abs(ramp_.end)); }

  /// Moves the start of the ramp, by no more than round-off.
  void start_at(double value) noexcept {
    ramp_.start = value;
    direction_ = ramp_.direction();
  }
  /// Lets the wall rest, because the ramp is round-off. A displacement stays at its start, so that no force results
  /// from round-off; a force keeps its prescribed values.
  void rest() noexcept {
    direction_ = 0;
    if (!is_force_controlled()) ramp_.end = ramp_.start;
  }

  /// True if a rising ramp has reached a value at a step coordinate, to within round-off.
  [[nodiscard]] bool has_reached(double target, double xi) const noexcept {
    return value(xi) >= target - k_same_value * std::abs(target);
  }
  /// True if a rising ramp ends beyond a value by more than round-off.
  [[nodiscard]] bool goes_beyond(double target) const noexcept {
    return ramp_.end > target + k_same_value * std::abs(target);
  }

 private:
  Ramp ramp_;
  int direction_ = 0;
};

}  // namespace monograin::contacts
