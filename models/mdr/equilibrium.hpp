/// Radius, centre and walls where they belong in a mode.
#pragma once

#include "mdr/particle.hpp"

namespace monograin::mdr {

/// Moves centre and walls to where they belong at a given radius.
void move_centre_and_walls(Particle& p, double xi, std::span<double> y);
/// Fills in all that follows from the radius: centre and walls; while the radius is held, that as well.
void complete(Particle& p, double xi, std::span<double> y);
/// Solves the volume balance together with the balance of forces, by Newton's method.
/// @throws std::domain_error where the free surface is used up
void grow(Particle& p, double xi, std::span<double> y);

}  // namespace monograin::mdr
