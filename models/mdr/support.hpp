/// Support of a free centre: which contacts can balance a push on it.
#pragma once

#include <span>
#include <vector>

#include "mdr/particle.hpp"
#include "system/regimes.hpp"

namespace monograin::mdr {

/// True if the other touching contacts can balance the push of contact i on the free centre. Contacts whose edges stick
/// or peel can pull as well.
[[nodiscard]] bool is_supported(const Particle& p, std::size_t i);
/// Projector on the directions in which no touching contact under displacement control constrains the centre.
[[nodiscard]] CentreMatrix unconstrained_directions(Particle& p);
/// Sum of the prescribed forces of touching walls on a free centre, at the step coordinate xi.
[[nodiscard]] CentreVector prescribed_push(const Particle& p, double xi) noexcept;
/// Largest prescribed force of a touching class within the step, summed over its walls.
[[nodiscard]] double largest_prescribed_force(const Particle& p) noexcept;

/// Checks that the prescribed forces do not drive a free centre away.
/// @throws std::domain_error if these forces leave a net push, at the start or the end of the step, along a direction
/// in which no touching wall under displacement control constrains the centre
void check_support(Particle& p);

/// Moves a loose particle with the walls whose forces begin to press it, to walls that support these forces, as
/// contacts::carried_to_support() finds them, and changes the contacts that open or close on the path. No force
/// resists the motion, which therefore takes no time. On its path the centre slides along walls that it touches.
/// Does nothing if a contact bears, if no wall is in the path, or at xi > 0: forces begin with a step.
/// @param y  receives the centre
void carry_to_support(Particle& p, double xi, std::span<double> y, std::vector<Event>& log);

/// Closes or opens the contacts that close or open together with contact i, because on a free centre only other
/// contacts balance it. When contact i closes, the nearest walls close until they support it, if they can. When contact
/// i opens, those contacts open that the remaining ones do not support. Does nothing where contacts adhere.
/// @param is_made  true: contact i has closed; false: it has opened
void balance_touch(Particle& p, std::size_t i, bool is_made, std::vector<Event>& log);

/// Loses the idle contacts that the centre leaves faster than their walls follow: an idle contact can push the centre,
/// but not pull it. If walls close in on the centre from opposite sides, or a force presses the centre against them,
/// their contacts are about to carry load; then only idle contacts that no other contact opposes may be lost.
/// @param is_left  set for contacts that stay open at this instant
/// @return whether any contact was lost
[[nodiscard]] bool lose_idle_contacts(Particle& p, double xi, std::span<const double> y, std::vector<bool>& is_left,
                                      std::vector<Event>& log);

}  // namespace monograin::mdr
