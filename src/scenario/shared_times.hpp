/// Times within the steps that several walls take together.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scenario/scenario.hpp"

namespace monograin {

/// Divides each step of all programs at the times of all of them: a table beside a ramp, a hold, or a table with other
/// times. The values that the programs prescribe stay as they are, because they are linear between these times.
/// @param programs  with equal numbers of steps, which take equal times
void share_times(std::span<std::vector<Step>* const> programs);

}  // namespace monograin
