/// Where a run stands in its program.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <optional>
#include <string>

#include "scenario/scenario.hpp"

namespace monograin {

/// The present ramp of the program, and the instant at which it began.
struct StepClock {
  std::size_t step = 0;         ///< index of the ramp in the programs
  double start = 0.0;           ///< [s]
  double duration = 0.0;        ///< [s]
  std::size_t number = 1;       ///< of the step that the ramp belongs to
  double begin_of_step = 0.0;   ///< [s]
  std::optional<double> end{};  ///< [s] of a leg, from the beginning of its step; none: start + duration

  /// Instant [s] of a step coordinate.
  [[nodiscard]] double time(double xi) const noexcept { return end && xi == 1.0 ? *end : start + xi * duration; }
  /// The clock of the next ramp, which begins at a step coordinate of this one.
  [[nodiscard]] StepClock next(double xi, std::size_t ramp, const Leg& leg, double its_duration) const {
    StepClock clock{.step = ramp, .start = time(xi), .duration = its_duration, .number = number};
    if (ramp > 0 && leg.is_first()) ++clock.number;
    clock.begin_of_step = leg.is_first() ? clock.start : begin_of_step;
    if (!leg.is_whole()) clock.end = clock.begin_of_step + leg.end_time;
    return clock;
  }
  /// Step coordinate of an instant [s], in a step that takes time.
  [[nodiscard]] double step_coordinate(double instant) const noexcept { return (instant - start) / duration; }
  /// Number of the step in a history.
  [[nodiscard]] int label() const noexcept { return static_cast<int>(number); }
  /// Beginning of a message, e.g. "step 2, t = 1.5 s: ".
  [[nodiscard]] std::string where(double xi) const { return fmt::format("step {}, t = {:.9g} s: ", number, time(xi)); }
};

}  // namespace monograin
