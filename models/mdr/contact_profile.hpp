/// Pressure and surface of one contact of the MDR model, in space and in its one-dimensional image, in closed form.
///
/// One form serves all contacts whose image is an indenter: elastic contacts, yielded contacts at and below their
/// largest overlap, each with or without adhesion. Every function is homogeneous: lengths in any one unit, stresses in
/// any one unit. Source, unless said otherwise: Zunker and Kamrin (2024).
#pragma once

#include <vector>

#include "mdr/adhesion.hpp"
#include "system/observables.hpp"

namespace monograin::mdr {

/// A contact as far as its profiles depend on it.
///
/// | contact                         | indenter                 | contact_radius      | displacement_1d       |
/// | elastic                         | of the elastic contact   | free_contact_radius | overlap               |
/// | yielded, at its largest overlap | of the unloading shape   | half width b        | half height A/2       |
/// | yielded, unloading              | of the unloading shape   | free_contact_radius | of its image          |
/// | adhesive, sticking or peeling   | as without adhesion      | that of the edge    | as without adhesion   |
struct ContactProfile {
  Indenter indenter;               ///< A > 0, b > 0
  double composite_modulus = 0.0;  ///< E* > 0
  double contact_radius = 0.0;     ///< a >= 0, for the ellipse at most b
  double displacement_1d = 0.0;    ///< delta_1D; below g(a) the edge is pulled, above would be a flat punch

  /// Displacement of the image, w1D(x) = delta_1D - g(x) for |x| <= a; 0 outside (eq. 6).
  [[nodiscard]] double image_displacement(double x) const noexcept;
  /// Force per length of the image, q1D(x) = E* w1D(x) (eq. 8).
  [[nodiscard]] double line_load(double x) const noexcept;
  /// Contact pressure p3D(r), compression positive; 0 for |r| >= a (eq. 9 and the jump of q1D at an adhesive edge).
  /// Ellipse: E* A/(2 pi b) atan(sqrt((a^2 - r^2)/(b^2 - a^2))); parabola: E* A/(2 pi b^2) sqrt(a^2 - r^2). An edge
  /// that is pulled adds E* w1D(a)/(pi sqrt(a^2 - r^2)), which is unbounded.
  [[nodiscard]] double pressure(double r) const noexcept;
  /// Contact pressure as a function of half the chord, sqrt(a^2 - r^2) > 0, on which alone it depends: near a pulled
  /// edge r lacks the digits of the chord.
  [[nodiscard]] double pressure_at_chord(double half_chord) const noexcept;
  /// Displacement of the surface towards the particle, w3D(r), inside and outside the contact (eq. 10, second).
  [[nodiscard]] double surface_displacement(double r) const;
  /// Height of the relaxed surface, g3D(r) (eq. 5).
  /// Ellipse: (A/2) (1 - (2/pi) E(r/b)), the complete elliptic integral of the modulus r/b. Parabola: A r^2/(8 b^2).
  /// @param r  for the ellipse |r| <= b, NaN beyond
  [[nodiscard]] double relaxed_height(double r) const;
};

/// Points of the pressure and the surface from the contact's middle to twice its radius, in the units of the profile.
/// @param profile  profile of a contact whose radius is not zero
[[nodiscard]] std::vector<SurfacePoint> surface_of(const ContactProfile& profile);

}  // namespace monograin::mdr
