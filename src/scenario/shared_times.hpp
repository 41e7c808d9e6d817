/// Times within the steps that several walls take together.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "scenario/scenario.hpp"

namespace monograin {

/// Divides each step of all programs at the times of all of them: a table beside a ramp, a hold, or a table with other
/// times. The values that the programs prescribe stay as they are, because they are linear between these times.
/// @param programs  with equal numbers of steps, which take equal times
/// @param most      number of ramps beyond which the programs stay as they are
/// @return number of ramps of all programs, divided
std::size_t share_times(std::span<std::vector<Step>* const> programs,
                        std::size_t most = std::numeric_limits<std::size_t>::max());

}  // namespace monograin
