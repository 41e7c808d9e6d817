/// Regimes of the contacts of a nonlocal particle, decided from its states.
#pragma once

#include <span>
#include <vector>

#include "nonlocal/particle.hpp"
#include "system/regimes.hpp"

namespace monograin::nonlocal {

/// Sets the regimes at the start of a step, from the state evaluated last. Touching walls belong to the side to which
/// they go.
/// @param is_first_step  walls that touch the fresh particle are in contact from the start, without an event
void resolve_regimes(Particle& p, std::span<const ContactClass> classes, bool is_first_step, std::vector<Event>& log);
/// Marks the walls that touch in the state evaluated last. A wall loses its mark once its gap exceeds Scales::idle.
void mark_touching(Particle& p);
/// Switches the regime of contacts that are on another side in the exact state, evaluated last, than in the integrated
/// one; their guards would not cross any more. At a fixed centre, a wall at which the surface comes to rest carries
/// nothing, as before it was pressed.
/// @param fired  guards whose contacts have been decided
void resolve_others(Particle& p, std::span<const Guard> fired, double xi, std::vector<Event>& log);

}  // namespace monograin::nonlocal
