/// Effect of the force of one contact elsewhere on an elastic sphere: the displacement of the surface, and with it the
/// approach and the radius of other contacts.
///
/// theta in (0, pi] is the angle between the normals of two walls, x = a/R the radius of the contact that is acted
/// upon. Compliances are over 1/(E R); nu in [0, 0.5]. Source, unless said otherwise: Agarwal and Gonzalez (2018).
#pragma once

namespace monograin::nonlocal {

/// Which displacement a point force causes on the surface: that of a half-space, applied to the sphere (the source's),
/// or the sphere's own (this workbench's). The sphere's own displacement also moves the loaded contact itself, by the
/// part of the solution that is regular there. It leaves out a logarithm, whose coefficient (1+nu)(1-2nu)^2/(2 pi)
/// vanishes for incompressible material: 4e-4 at nu = 0.48, but 0.03 at nu = 0.3, where the logarithm is no small
/// correction.
enum class Influence { half_space, sphere };

/// Outward normal displacement per unit force at an angle from it (eq. 18). Negative below 88 (nu = 0) to 71 degrees
/// (nu = 1/2): a close neighbour pushes the surface away from the wall; -infinity as theta -> 0.
[[nodiscard]] double half_space_influence(double poisson_ratio, double theta) noexcept;

/// How the contact radius follows the deformation of the surface: by the source's closed form (eq. 14), by its integral
/// (eq. 8), by the same integral with the displacement projected on the true radial direction (eq. A.10 takes the
/// length of that direction's projection for its component), or not at all.
enum class RadiusRule { closed, integral, projected, none };

/// Largest contact radius over R that has a deformed radius: 1 plus round-off.
constexpr double k_widest = 1.0 + 1e-12;

/// Growth of the contact's radius per unit of its own force (eq. 7), for x in (0, 1]. Unbounded as x -> 0, where its
/// product with the force goes to zero like x^2.
/// @throws std::domain_error for x above k_widest
[[nodiscard]] double local_radius_influence(double poisson_ratio, double x);

/// Growth of the contact's radius per unit force of the opposite contact (eq. 13, without cancellation), x in [0, 1].
/// @throws std::domain_error for x above k_widest
[[nodiscard]] double pole_radius_influence(double poisson_ratio, double x);

/// Growth of the contact's radius per unit force of a contact at an angle theta (eqs. 8, 14), x in [0, 1]. The
/// integrals are singular at theta = asin(x), where the other contact's middle is on this contact's edge: they are
/// exact to round-off ten degrees from there, to 1e-12 a tenth of a degree from there. The closed form has 3/4 of the
/// integral's value at theta = pi/2, x = 1/2, and half of it at x = 3/4.
/// @throws std::domain_error for x above k_widest
[[nodiscard]] double radius_influence(RadiusRule rule, double poisson_ratio, double theta, double x);

/// Quotient in eq. 11 for a contact at an angle theta; the closed form is built on it.
[[nodiscard]] double radius_quotient(double poisson_ratio, double theta) noexcept;

/// Growth of one contact's radius per unit force of many other contacts. Computes once what does not depend on their
/// angles; the caller gives `quotient` = radius_quotient(theta).
class RadiusInfluence {
 public:
  /// @throws std::domain_error for x above k_widest
  RadiusInfluence(RadiusRule rule, double poisson_ratio, double x);
  [[nodiscard]] double operator()(double theta, double quotient) const;

 private:
  RadiusRule rule_;
  double poisson_ratio_;
  double x_;
  double pole_ = 0.0;               ///< of the closed form: its value at the opposite contact
  double slope_ = 0.0;              ///< of the closed form: slope of its straight part
  double critical_angle_ = 0.0;     ///< of the closed form: angle from which it is straight
  double at_critical_angle_ = 0.0;  ///< radius_quotient() at the critical angle
};

/// Angle at the centre between the middle of a contact and its edge. Two contacts impinge where theirs add up to the
/// angle between their walls (eq. 37).
/// @param radius        contact radius in the deformed configuration, over R
/// @param displacement  of the wall towards the centre, over R, < 1
[[nodiscard]] double edge_angle(double radius, double displacement) noexcept;

}  // namespace monograin::nonlocal
