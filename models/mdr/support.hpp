/// Support of a free centre: which contacts can balance a push on it.
#pragma once

#include "mdr/particle.hpp"

namespace monograin::mdr {

/// True if the other touching contacts can balance a push of one of them on the free centre, or a pull where the side
/// is -1; those whose edges do not follow pull, too.
[[nodiscard]] bool is_supported(const Particle& p, std::size_t i, double side = 1.0);
/// is_supported() where nothing is to be allocated.
/// @param others  work space
[[nodiscard]] bool is_supported(const Particle& p, std::size_t i, double side, std::vector<CentreVector>& others);
/// Projector on the directions in which no touching contact constrains the centre.
[[nodiscard]] CentreMatrix unconstrained_directions(Particle& p);
/// Sum of the prescribed forces on a free centre.
[[nodiscard]] CentreVector prescribed_push(const Particle& p, double xi) noexcept;
/// Largest prescribed force of a class within the step.
[[nodiscard]] double largest_prescribed_force(const Particle& p) noexcept;

/// A wall that pushes a particle which nothing supports from the other side has no equilibrium, unless others adhere;
/// nor have forces that do not balance where no wall stands against them.
/// @throws std::domain_error there
void check_support(Particle& p);

/// Where the centre is free, a contact along its directions is balanced by others only: the nearest ones close with it
/// until they balance it, if they can, and those open with it that the rest does not balance.
void balance_touch(Particle& p, std::size_t i, bool is_made, std::vector<Event>& log);

/// Loses the idle contacts that the others drive the centre away from faster than they follow: an idle contact can push
/// the centre, but not pull it. Where walls close in on it from opposite sides there is no way out, and they are about
/// to bear, as are those that a force presses it against: then only those are asked that no other contact opposes.
/// @param is_left  set for contacts that stay open at this instant
/// @return whether there are any
[[nodiscard]] bool lose_idle_contacts(Particle& p, double xi, std::span<const double> y, std::vector<bool>& is_left,
                                      std::vector<Event>& log);

}  // namespace monograin::mdr
