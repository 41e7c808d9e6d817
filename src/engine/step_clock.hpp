/// Where a run stands in its program.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>

namespace monograin {

/// The present ramp of the program, and the instant at which it began.
struct StepClock {
  std::size_t step = 0;    ///< index of the ramp in the programs
  double start = 0.0;      ///< [s]
  double duration = 0.0;   ///< [s]
  std::size_t number = 1;  ///< of the step that the ramp belongs to

  /// Instant [s] of a step coordinate.
  [[nodiscard]] double time(double xi) const noexcept { return start + xi * duration; }
  /// Step coordinate of an instant [s], in a step that takes time.
  [[nodiscard]] double step_coordinate(double instant) const noexcept { return (instant - start) / duration; }
  /// Number of the step in a history.
  [[nodiscard]] int label() const noexcept { return static_cast<int>(number); }
  /// Beginning of a message, e.g. "step 2, t = 1.5 s: ".
  [[nodiscard]] std::string where(double xi) const { return fmt::format("step {}, t = {:.9g} s: ", number, time(xi)); }
};

}  // namespace monograin
