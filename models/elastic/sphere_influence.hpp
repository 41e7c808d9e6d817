/// Displacement of the surface of an elastic sphere under a point force, in closed form and by its exact series.
///
/// theta in (0, pi] is the angle at the centre between the force and a point of the surface. Displacements per unit
/// force are over 1/(E R); nu in [0, 0.5]. Not from a source: the series of the sphere's Legendre modes, summed here.
#pragma once

#include <Eigen/Core>

namespace monograin {

/// Angle between two directions, to full accuracy also where they are nearly parallel.
[[nodiscard]] double angle_between(const Eigen::Vector3d& first, const Eigen::Vector3d& second) noexcept;

/// Outward normal displacement of a sphere per unit force at an angle from it, without rigid translation: exact sum
/// over all Legendre polynomials. Errors below 1e-14 of the value at theta, or of 1.
[[nodiscard]] double sphere_influence(double poisson_ratio, double theta);

/// Limit of sphere_influence as theta -> 0, without the half-space's displacement (1-nu^2)/(2 pi sin(theta/2)), which
/// the local law contains, and without the logarithm of sin(theta/2).
[[nodiscard]] double sphere_self_influence(double poisson_ratio);

/// Self influence of a contact of finite size: with the logarithm, taken at half_sine = sin(theta/2) of the contact's
/// own radius, and with the modes up to `last` only. Error below 1e-12 for `last` above 1000.
[[nodiscard]] double sphere_self_influence(double poisson_ratio, double half_sine, int last);

}  // namespace monograin
