/// Adhesive contact of the MDR model: stuck, peeling and critical states of the edge, their forces and energies.
///
/// In its one-dimensional image a contact is a relaxed profile g(x) pressed by delta_1D into independent springs, which
/// stand for |x| < a. The springs at the edge are stretched by -w(a) = g(a) - delta_1D, and tear where that reaches
/// Dl(a) = sqrt(2 pi a dg/E*). Functions are homogeneous: lengths in any one unit, stresses in any one unit, the
/// surface energy dg (of the particle-wall contact) in stress times length. Forces are positive in compression.
/// Source: Zunker and Kamrin (2024), sections 3.2 and 6, Appendix A.
#pragma once

#include "mdr/contact.hpp"
#include "system/walls.hpp"

namespace monograin::mdr {

/// Relaxed profile of a contact: an ellipse of height A and width 2b, or the parabola A x^2/(4 b^2) of the same tip.
struct Indenter {
  ElasticProfile profile = ElasticProfile::ellipse;
  double height = 0.0;      ///< A
  double half_width = 0.0;  ///< b

  [[nodiscard]] bool is_parabola() const noexcept { return profile == ElasticProfile::parabola; }
  /// Height over x^2 of the parabola A x^2/(4 b^2), which is also the tip of the ellipse.
  [[nodiscard]] double tip_curvature() const noexcept { return 0.25 * height / (half_width * half_width); }
};

/// Constants of an adhesive interface.
struct Adhesion {
  double composite_modulus = 0.0;  ///< E*, > 0
  double surface_energy = 0.0;     ///< dg of the particle-wall contact, >= 0
};
/// Factor of Dl' in the condition of pull-off, g' = factor Dl' (xi of eq. 15): 1 under displacement, 3 under force
/// control.
[[nodiscard]] constexpr double control_factor(Control control) noexcept {
  return control == Control::force ? 3.0 : 1.0;
}

/// Indenter of an elastic contact: A = 4R, b = R.
[[nodiscard]] Indenter elastic_indenter(ElasticProfile profile, double radius) noexcept;
/// Indenter of a yielded contact below its largest overlap: the ellipse of its unloading shape.
[[nodiscard]] Indenter unloading_indenter(const UnloadingShape& shape) noexcept;

/// Height g(a) of the relaxed profile, for a in [0, b] (eqs. 23, 28).
[[nodiscard]] double profile_height(const Indenter& indenter, double a) noexcept;
/// Round-off of g(a) due to that of a and b; large near the end of the ellipse, which is steep.
[[nodiscard]] double profile_round_off(const Indenter& indenter, double a) noexcept;
/// Contact radius without adhesion under delta_1D, where g(a) = delta_1D; 0 for delta_1D <= 0, b from A/2 on.
[[nodiscard]] double free_contact_radius(const Indenter& indenter, double displacement_1d) noexcept;
/// Force without adhesion at the contact radius a: 2 E* int_0^a (g(a) - g(x)) dx.
[[nodiscard]] double free_force(const Indenter& indenter, double composite_modulus, double a) noexcept;

/// Stretch at which the springs at the edge tear, Dl(a) = sqrt(2 pi a dg/E*) (eq. 11).
[[nodiscard]] double critical_stretch(const Adhesion& adhesion, double a) noexcept;

/// Contact radius at pull-off, where g' = control_factor() Dl' (eq. 15).
[[nodiscard]] double critical_radius(const Indenter& indenter, const Adhesion& adhesion, Control control);

/// State of an edge in equilibrium at the radius a.
struct PeelState {
  double contact_radius = 0.0;
  double displacement_1d = 0.0;  ///< g(a) - Dl(a)
  double force = 0.0;            ///< free_force(a) - 2 E* a Dl(a)
};
/// Equilibrium of an edge at the radius a, stable or not.
[[nodiscard]] PeelState peel_state(const Indenter& indenter, const Adhesion& adhesion, double a) noexcept;

/// Stable (outer) equilibrium of an edge under delta_1D; the critical state if delta_1D lies below that of pull-off.
/// Runs take it from peeling_contact(), with derivatives; this form shows the accuracy of the edge by itself.
/// @param critical_radius  critical_radius() of displacement control
[[nodiscard]] PeelState peel_at_displacement(const Indenter& indenter, const Adhesion& adhesion, double critical_radius,
                                             double displacement_1d);
/// Stable (outer) equilibrium of an edge under a force; the critical state if the force lies below that of pull-off.
/// @param critical_radius  critical_radius() of force control
[[nodiscard]] PeelState peel_at_force(const Indenter& indenter, const Adhesion& adhesion, double critical_radius,
                                      double force);

/// One-dimensional image of a contact: delta_1D and the indenter, with their partial derivatives.
struct Image {
  struct Change {
    double displacement_1d = 0.0;  ///< d(delta_1D)
    double height = 0.0;           ///< dA/A
    double half_width = 0.0;       ///< db/b
  };
  Indenter indenter;
  double displacement_1d = 0.0;  ///< delta_1D
  double by_overlap = 1.0;       ///< d(delta_1D)/d(delta) = 1/(1 - rho)
  Change by_radius;              ///< at fixed overlap and largest overlap
  Change by_overlap_max{};       ///< at fixed overlap and radius
};
/// Image of an elastic contact.
[[nodiscard]] Image elastic_image(ElasticProfile profile, double radius, double overlap) noexcept;
/// Image of a yielded contact below its largest overlap.
[[nodiscard]] Image unloading_image(const UnloadingShape& shape, double overlap) noexcept;
/// Overlap on the unloading branch at a delta_1D.
[[nodiscard]] double overlap_at(const UnloadingShape& shape, double displacement_1d) noexcept;

/// Contact whose edge sticks at the radius a (eqs. 45, 46).
[[nodiscard]] Contact sticking_contact(const Image& image, double composite_modulus, double a) noexcept;
/// Contact whose edge peels (eqs. 46-48); below the critical delta_1D, with its edge at the critical radius.
/// @param critical_radius  critical_radius() of displacement control
[[nodiscard]] Contact peeling_contact(const Image& image, const Adhesion& adhesion, double critical_radius);
/// d2F/d(delta)2 of a contact whose edge peels at the radius a: how fast its stiffness falls as the contact opens. Kept
/// finite at pull-off, like the stiffness.
[[nodiscard]] double peeling_softening(const Image& image, const Adhesion& adhesion, double a) noexcept;
/// Derivatives of the displacement of the springs at the edge, delta_1D - g(a) at fixed a, by the overlap and by R,
/// with which the indenter changes. On the ellipse, whose slope is unbounded, both are times the edge's cosine.
struct EdgePress {
  double by_overlap = 0.0;
  double by_radius = 0.0;
};
[[nodiscard]] EdgePress edge_press(const Image& image, const Image::Change& by_radius, double a) noexcept;

/// Energy of the springs and the surface, (1 - rho)(U_s - pi a^2 dg), with the edge at a.
[[nodiscard]] double adhesive_energy(const Image& image, const Adhesion& adhesion, double a) noexcept;

}  // namespace monograin::mdr
