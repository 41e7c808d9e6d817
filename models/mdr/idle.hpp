/// Idle contacts: below the resolution of the balance of a free centre, forces and overlaps are round-off.
#pragma once

#include "mdr/particle.hpp"

namespace monograin::mdr {

/// Largest overlap of an idle contact: the round-off of lengths, or the overlap to which the round-off of the other
/// forces presses it. Other contacts may bear much more, and be much stiffer.
[[nodiscard]] double resolution(const Particle& p);

/// True for an idle contact: the wall touches a particle with a free centre and carries no load. Its overlap and its
/// rate are round-off; it leaves no dent, and is lost when the gap exceeds the resolution.
[[nodiscard]] bool is_idle(const Particle& p, std::size_t i);

}  // namespace monograin::mdr
