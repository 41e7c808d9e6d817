/// Equilibrium of the MDR particle in a mode: radius, free centre, and walls under force control.
#pragma once

#include "mdr/particle.hpp"

namespace monograin::mdr {

/// Moves the force-controlled walls in y to their displacements under the prescribed forces, at the radius in y.
void move_walls(const Particle& p, double xi, std::span<double> y);
/// Writes the unknowns of walls whose force is prescribed in other steps only.
void record_walls(const Particle& p, double xi, std::span<double> y) noexcept;
/// Moves the free centre and the force-controlled walls in y to equilibrium at the radius that y has.
/// @throws std::domain_error where no balance is found
void move_centre_and_walls(Particle& p, double xi, std::span<double> y);
/// Fills in all that follows from the radius: centre and walls; while the radius is held, the radius too. Prefers the
/// equilibrium that holds the centre where there are several.
/// @throws std::domain_error where no balance is found
void complete(Particle& p, double xi, std::span<double> y);
/// Solves for the growing radius: the volume balance together with the balance of forces, by Newton's method.
/// @throws std::domain_error where the free surface is used up, so that growth runs away, or the method finds no radius
void grow(Particle& p, double xi, std::span<double> y);

}  // namespace monograin::mdr
