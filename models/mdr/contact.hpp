/// Force, contact radius and stored energy of one contact of the MDR model, without adhesion.
///
/// Every function is homogeneous: lengths in any one unit, stresses in any one unit. Overlaps and forces are positive
/// in compression. Derivatives are exact. Source, unless said otherwise: Zunker and Kamrin (2024).
#pragma once

#include <memory>

#include "mdr/pressure_curve.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {

/// Indenter of an elastic contact: the source's unified ellipse (height 4R, width 2R) or Hertz's parabola.
enum class ElasticProfile { ellipse, parabola };

/// Material of the particle, as far as contact laws depend on it.
struct Material {
  double composite_modulus = 0.0;       ///< E* = E/(1 - nu^2), > 0
  double poisson_ratio = 0.0;           ///< in (-1, 0.5]
  double yield_stress = 0.0;            ///< Y, > 0; infinity: never yields
  double linear_compressibility = 0.0;  ///< strain of a length under unit pressure, 1/(3 kappa) = (1 - 2 nu)/E, >= 0
  /// Overlap over apparent radius at which an elastic contact yields; infinity: it never does.
  double yield_overlap_ratio = k_infinity;
  /// p_Y/Y over delta/R; null: the source's exponential.
  std::shared_ptr<const PressureCurve> pressure_curve{};
};

/// Derived constants from E, nu and Y.
/// @param yield_stress    Y > 0; infinity for a material that never yields
/// @param pressure_curve  p_Y/Y over delta/R; null: the source's exponential
[[nodiscard]] Material make_material(double youngs_modulus, double poisson_ratio, double yield_stress,
                                     std::shared_ptr<const PressureCurve> pressure_curve = nullptr);

/// Overlap over apparent radius at first yield: the root d of (4 E*)/(3 pi Y) sqrt(d) = p_Y/Y (eq. 41), with p_Y/Y =
/// 1 + 1.75 exp(-4.4 d).
/// @param modulus_over_yield  E*/Y, > 0
/// @return d in (0, 1), or infinity where E*/Y is so low that there is no root below 1
[[nodiscard]] double yield_overlap_ratio(double modulus_over_yield);
/// Overlap over apparent radius at first yield, with another p_Y/Y over d than the exponential. If that curve rises
/// faster than the elastic pressure there may be several roots; the function gives the first that shows as a change of
/// sign between two samples.
/// @return d in (0, 1], or infinity where there is no root up to 1 and the end of the curve
[[nodiscard]] double yield_overlap_ratio(double modulus_over_yield, const PressureCurve& pressure_curve);

// With the ellipse, the force of a contact goes with phi and its energy with psi; a = b sin(theta).

/// phi(theta) = theta - sin(theta) cos(theta), for theta in [0, pi/2], to full relative accuracy.
[[nodiscard]] double phi(double theta) noexcept;
/// phi(theta) for known sine and cosine of theta.
[[nodiscard]] double phi_at(double theta, double sine, double cosine) noexcept;

/// Largest argument of inverse_phi(): phi(2 pi/3), rounded down. At that angle an unloading contact is half a recovery
/// above its largest overlap.
inline constexpr double k_largest_phi = 2.5;
/// The angle with phi(theta) = value, for value in [0, k_largest_phi], to full relative accuracy: Kepler's equation
/// t - sin(t) = 2 value of eccentricity 1, with t = 2 theta.
[[nodiscard]] double inverse_phi(double value) noexcept;

/// psi(theta) = sin(theta) - theta cos(theta) - sin(theta)^3/3, for theta in [0, pi/2], to full relative accuracy.
[[nodiscard]] double psi(double theta) noexcept;

/// State of a contact under a given overlap.
struct Contact {
  double contact_radius = 0.0;
  double force = 0.0;
  double by_overlap = 0.0;      ///< dF/d(overlap) along the branch
  double by_radius = 0.0;       ///< dF/dR at fixed overlap (and fixed largest overlap)
  double by_overlap_max = 0.0;  ///< dF/d(largest overlap); 0 except on the unloading branch
};

/// Elastic contact (eqs. 23-25, 29-31).
/// @param radius   apparent radius R > 0
/// @param overlap  delta; <= 0 gives zeros
/// @throws std::domain_error for delta > 2R
[[nodiscard]] Contact elastic_contact(ElasticProfile profile, double composite_modulus, double radius, double overlap);

/// Mean pressure of a fully plastic contact and its fall with the overlap (eq. 28, or the material's own curve).
struct PlasticPressure {
  double pressure = 0.0;   ///< p_Y
  double decrement = 0.0;  ///< -R dp_Y/d(delta)
};
/// Mean pressure of a fully plastic contact. At negative overlaps, which only trials have, a material's own curve goes
/// on with its first pressure.
/// @throws std::domain_error beyond the end of the material's own curve
[[nodiscard]] PlasticPressure plastic_pressure(const Material& material, double overlap_over_radius);

/// Area constant of a contact that yields at the apparent radius R, c = delta_Y^2 - delta_Y R (eqs. 42, 43; area/pi).
[[nodiscard]] double yield_area_constant(double yield_overlap_ratio, double radius) noexcept;

/// Fully plastic contact at its largest overlap (eqs. 16, 21, 28, 36): F = pi p_Y (2 delta R - delta^2 + c). Trials may
/// lead to overlaps without contact area, where F is negative.
/// @param area_constant  c of yield_area_constant
/// @throws std::domain_error beyond the end of the material's own curve
[[nodiscard]] Contact plastic_contact(const Material& material, double radius, double overlap, double area_constant);

/// Elastic indenter that is left when a fully plastic contact unloads (eqs. 27-35), fixed while R and the largest
/// overlap are.
struct UnloadingShape {
  double radius = 0.0;            ///< R
  double overlap_max = 0.0;       ///< largest overlap m
  double contact_radius_max = 0;  ///< a_max = B/2
  double pressure = 0.0;          ///< p_Y
  double height = 0.0;            ///< A = 4 p_Y a_max / E*
  double rho = 0.0;               ///< share of the elastic recovery that moves the centre, in (0, 1)
  double recovery = 0.0;          ///< A (1 - rho)/2: the contact opens at m - recovery
  // Derivatives by m at fixed R and by R at fixed m; logarithmic ones for pressure and contact radius.
  double log_pressure_by_max = 0, log_pressure_by_radius = 0;              ///< p_x / p_Y
  double log_contact_radius_by_max = 0, log_contact_radius_by_radius = 0;  ///< a_x / a_max
  double rho_by_max = 0, rho_by_radius = 0;                                ///< rho_x
};

/// Indenter that a fully plastic contact leaves when it unloads from the overlap m, with derivatives (eqs. 27-35).
/// @throws std::domain_error where a_max^2 or the distance of the indenter's tip from the centre is not positive, and
/// beyond the end of the material's own pressure curve
[[nodiscard]] UnloadingShape unloading_shape(const Material& material, double radius, double overlap_max,
                                             double area_constant);

/// Unloading shape from the contact radius and mean pressure at the largest overlap, whichever law gives these. Its
/// derivatives with respect to m and R are zero.
/// @throws std::domain_error where the distance of the indenter's tip from the centre is not positive
[[nodiscard]] UnloadingShape unloading_shape_of(double composite_modulus, double poisson_ratio, double radius,
                                                double overlap_max, double contact_radius, double pressure);

/// Distance from the largest overlap over the recovery, u = (m - delta)/recovery: 0 at the maximum, 1 where the contact
/// opens.
[[nodiscard]] double unloading_fraction(const UnloadingShape& shape, double overlap) noexcept;

/// Contact on the unloading branch; zeros where it is open (u >= 1). Overlaps above m continue the branch analytically,
/// up to one recovery above; beyond that the force is constant.
[[nodiscard]] Contact unloading_contact(const UnloadingShape& shape, double composite_modulus, double overlap);

/// Contact on the unloading branch, from the distance to the overlap at which the contact opens, over the recovery: 0
/// there, 1 at the largest overlap. Keeps its digits where the recovery is a small share of the overlap.
[[nodiscard]] Contact recompressed_contact(const UnloadingShape& shape, double composite_modulus, double share);

/// Overlap at which an elastic contact bears a force; 0 for a force <= 0.
/// @throws std::domain_error for a force above that of an overlap of twice the radius (ellipse)
[[nodiscard]] double elastic_overlap(ElasticProfile profile, double composite_modulus, double radius, double force);
/// Overlap at which a fully plastic contact bears a force >= 0, on the rising part of its curve.
/// @param guess  an overlap nearby, to begin with
/// @throws std::domain_error where no overlap below the radius, or up to the end of the material's own pressure curve,
/// bears the force
[[nodiscard]] double plastic_overlap(const Material& material, double radius, double force, double area_constant,
                                     double guess);
/// Share, as in recompressed_contact(), at which a contact on the unloading branch bears a force >= 0.
/// @throws std::domain_error as unloading_overlap()
[[nodiscard]] double recompressed_share(const UnloadingShape& shape, double force);
/// Overlap at which a contact on the unloading branch bears a force >= 0. Forces above that of the largest overlap
/// continue the branch analytically, up to half a recovery above.
/// @throws std::domain_error beyond that
[[nodiscard]] double unloading_overlap(const UnloadingShape& shape, double force);

// Stored energies: recoverable work of the walls at fixed R and fixed largest overlap; dPi = F d(delta_o).

/// Stored energy of an elastic contact; 0 where it is open.
[[nodiscard]] double elastic_energy(ElasticProfile profile, double composite_modulus, double radius, double overlap);
/// Stored energy of a yielded contact at its largest overlap: (1 - rho) (8/3) p_Y^2 a_max^3 / E*.
[[nodiscard]] double plastic_energy(const UnloadingShape& shape) noexcept;
/// Stored energy on the unloading branch and its continuation; 0 where the contact is open.
[[nodiscard]] double unloading_energy(const UnloadingShape& shape, double overlap) noexcept;

/// Primitive over the overlap of the force of plastic_contact at fixed R (up to a constant), for overlaps > 0.
/// @throws std::domain_error beyond the end of the material's own pressure curve
[[nodiscard]] double plastic_work_primitive(const Material& material, double radius, double overlap,
                                            double area_constant);

}  // namespace monograin::mdr
