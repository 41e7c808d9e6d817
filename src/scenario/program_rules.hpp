/// Rules between the programs of walls, which end their steps together.
#pragma once

#include <span>
#include <string_view>

#include "scenario/faults.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// Program of a wall, or of all walls that a preset configuration drives.
struct WallProgram {
  std::string_view wall;  ///< name in messages
  SourceLocation where;   ///< of the wall
  double gap = 0.0;       ///< [m]
  std::span<const Step> steps;
};

/// Reports programs with different numbers of steps, steps of different durations as far as the text gives them, and
/// tables or sines that do not begin where their wall is. What only a run can show is left to it.
void check_programs(std::span<const WallProgram> programs, FaultList& faults);

}  // namespace monograin
