/// Where a run stands in its program.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <optional>
#include <string>

#include "scenario/scenario.hpp"

namespace monograin {

/// The present leg of the program, and the instant at which it began.
struct StepClock {
  std::size_t leg = 0;          ///< index in the programs
  double start = 0.0;           ///< [s], of the leg
  double duration = 0.0;        ///< [s], of the leg
  std::optional<double> end{};  ///< [s], of a leg that is not the only one of its step; none: start + duration
  std::size_t step_number = 1;  ///< of the step that the leg belongs to
  double step_start = 0.0;      ///< [s]

  /// Instant [s] of a step coordinate.
  [[nodiscard]] double time(double xi) const noexcept { return end && xi == 1.0 ? *end : start + xi * duration; }
  /// The clock of the next leg, which begins at a step coordinate of this one.
  /// @param place          of the next leg in its step
  /// @param next_duration  [s]
  [[nodiscard]] StepClock next(double xi, std::size_t next_leg, const Leg& place, double next_duration) const {
    StepClock clock{.leg = next_leg, .start = time(xi), .duration = next_duration, .step_number = step_number};
    if (next_leg > 0 && place.is_first()) ++clock.step_number;
    clock.step_start = place.is_first() ? clock.start : step_start;
    if (!place.is_whole()) clock.end = clock.step_start + place.end_time;
    return clock;
  }
  /// Step coordinate of an instant [s], in a leg that takes time.
  [[nodiscard]] double step_coordinate(double instant) const noexcept { return (instant - start) / duration; }
  /// step_number in the type of a history's column.
  [[nodiscard]] int step_label() const noexcept { return static_cast<int>(step_number); }
  /// Beginning of a message, e.g. "step 2, t = 1.5 s: ".
  [[nodiscard]] std::string where(double xi) const {
    return fmt::format("step {}, t = {:.9g} s: ", step_number, time(xi));
  }
};

}  // namespace monograin
