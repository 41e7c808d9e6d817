/// Decides which contacts of a particle touch, and which flow.
#pragma once

#include <span>
#include <vector>

#include "cel/guards.hpp"

namespace monograin::cel {

/// Decides the mode from here on, and logs contacts that are made or lost, or begin or stop to flow.
/// @param fired  guards that have just fired
void decide_mode(Particle& p, Motion& motion, double xi, std::span<const double> y, std::span<const Guard> fired,
                 std::vector<Event>& log);

}  // namespace monograin::cel
