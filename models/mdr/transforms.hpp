/// Transforms between an axisymmetric contact and its one-dimensional image, for arbitrary profiles. Only the Python
/// package uses them; runs have closed forms.
///
/// Profiles, displacements and pressures are callables of the distance from the axis, r in space and x in the image;
/// they are even functions, and are only called for arguments >= 0. The substitutions below take the square roots out
/// of all kernels, so that a profile which is smooth inside and behaves like a square root (or its inverse) at the edge
/// is integrated to round-off. A function that is unbounded at the edge loses digits, because a rounded r lacks the
/// distance to the edge. A callable of two arguments, r and half the chord sqrt(a^2 - r^2), gets both and loses none. A
/// jump of the integrand, or a logarithm at the axis, costs time and leaves a relative error of 1e-6 or 1e-8.
/// Exceptions of the callables pass through; NaN in gives NaN out. Every function is homogeneous: lengths in any one
/// unit, stresses in any one unit. Source: Zunker and Kamrin (2024), section 3.1.
#pragma once

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>
#include <type_traits>

namespace monograin::mdr {

namespace detail {

// A tolerance below the noise of the integrand would bisect for ever; the depth bounds the cost of a kink.
inline constexpr double k_transform_tolerance = 1e-13;
inline constexpr unsigned k_transform_depth = 15;

/// Integral of f(t) for t from 0 to end.
template <class Function>
[[nodiscard]] double angular_integral(Function&& f, double end) {
  return boost::math::quadrature::gauss_kronrod<double, 61>::integrate(f, 0.0, end, k_transform_depth,
                                                                       k_transform_tolerance);
}

/// Value of a function of the radius, or of the radius and half the chord there.
template <class Function>
[[nodiscard]] double at_chord(Function&& f, double radius, double half_chord) {
  if constexpr (std::is_invocable_v<Function, double, double>) {
    return f(radius, half_chord);
  } else {
    return f(radius);
  }
}

inline constexpr double k_right_angle = 0.5 * std::numbers::pi;

}  // namespace detail

/// Image of a gap or relaxed profile, g1D(x) = x int_0^x g3D'(r)/sqrt(x^2 - r^2) dr (eq. 4).
///
/// @param profile_slope  r -> g3D'(r)
/// @param x              >= 0
template <class Slope>
[[nodiscard]] double profile_1d(Slope&& profile_slope, double x) {
  // r = x sin(t)
  return x * detail::angular_integral([&](double t) { return profile_slope(x * std::sin(t)); }, detail::k_right_angle);
}

/// Gap or relaxed profile of an image, g3D(r) = (2/pi) int_0^r g1D(x)/sqrt(r^2 - x^2) dx (eq. 5).
///
/// @param profile  x -> g1D(x)
/// @param r        >= 0
template <class Profile>
[[nodiscard]] double profile_3d(Profile&& profile, double r) {
  // x = r sin(t)
  return 2.0 / std::numbers::pi *
         detail::angular_integral([&](double t) { return profile(r * std::sin(t)); }, detail::k_right_angle);
}

/// Line load of a contact pressure, q1D(x) = 2 int_x^a r p3D(r)/sqrt(r^2 - x^2) dr (eqs. 9, 17).
///
/// @param pressure        r -> p3D(r), or (r, sqrt(a^2 - r^2)) -> p3D(r); may grow like 1/sqrt(a^2 - r^2)
/// @param contact_radius  a
/// @param x               >= 0
/// @return 0 for x >= a: at x = a the pressure no longer shows the value to which q1D falls (or from which it jumps)
template <class Pressure>
[[nodiscard]] double line_load_1d(Pressure&& pressure, double contact_radius, double x) {
  if (x >= contact_radius) return 0.0;
  // r^2 = x^2 + (a^2 - x^2) sin(t)^2: the cosine of ds cancels both a root and an inverse root at the edge.
  const double chord = std::sqrt((contact_radius - x) * (contact_radius + x));
  return 2.0 * chord *
         detail::angular_integral(
             [&](double t) {
               const double cosine = std::cos(t);
               const double r = std::hypot(contact_radius * std::sin(t), x * cosine);
               return detail::at_chord(pressure, r, chord * cosine) * cosine;
             },
             detail::k_right_angle);
}

/// Contact pressure of a line load,
/// p3D(r) = q1D(a-)/(pi sqrt(a^2 - r^2)) - (1/pi) int_r^a q1D'(x)/sqrt(x^2 - r^2) dx.
///
/// Eq. 9 differentiates a line load that ends continuously; the first term is the jump at the edge of an adhesive
/// contact (or a flat punch).
/// @param line_load_slope  x -> q1D'(x), or (x, sqrt(a^2 - x^2)) -> q1D'(x), inside the contact; may grow like
///                         1/sqrt(a^2 - x^2)
/// @param edge_line_load   q1D just inside the edge
/// @param contact_radius   a
/// @param r                >= 0
/// @return 0 for r >= a
template <class Slope>
[[nodiscard]] double pressure_3d(Slope&& line_load_slope, double edge_line_load, double contact_radius, double r) {
  if (r >= contact_radius) return 0.0;
  // x^2 = r^2 + (a^2 - r^2) sin(t)^2
  const double chord = std::sqrt((contact_radius - r) * (contact_radius + r));
  const double integral = chord * detail::angular_integral(
                                      [&](double t) {
                                        const double cosine = std::cos(t);
                                        const double x = std::hypot(contact_radius * std::sin(t), r * cosine);
                                        return detail::at_chord(line_load_slope, x, chord * cosine) / x * cosine;
                                      },
                                      detail::k_right_angle);
  return (edge_line_load / chord - integral) / std::numbers::pi;
}

/// Displacement of the surface, w3D(r) = (2/pi) int_0^min(r,a) w1D(x)/sqrt(r^2 - x^2) dx (eq. 10, second).
///
/// @param displacement    x -> w1D(x) inside the contact
/// @param contact_radius  a
/// @param r               >= 0
template <class Displacement>
[[nodiscard]] double displacement_3d(Displacement&& displacement, double contact_radius, double r) {
  if (r <= contact_radius) return profile_3d(displacement, r);
  // x = r sin(f), f = end sin(t): a square root of w1D at the edge becomes linear in t.
  const double end = std::atan2(contact_radius, std::sqrt((r - contact_radius) * (r + contact_radius)));
  return 2.0 / std::numbers::pi * end *
         detail::angular_integral([&](double t) { return displacement(r * std::sin(end * std::sin(t))) * std::cos(t); },
                                  detail::k_right_angle);
}

/// Image of the displacement of the surface inside the contact, w1D(x) = w3D(0) + x int_0^x w3D'(r)/sqrt(x^2 - r^2) dr.
///
/// The first of eq. 10 as printed has the dimension of a length squared over a pressure; this is the inverse of the
/// second, and gives delta - x^2/R of Hertz's delta - r^2/(2R).
/// @param displacement_at_axis  w3D(0)
/// @param displacement_slope    r -> w3D'(r) for r <= x
/// @param x                     in [0, a]
template <class Slope>
[[nodiscard]] double displacement_1d(double displacement_at_axis, Slope&& displacement_slope, double x) {
  return displacement_at_axis + profile_1d(displacement_slope, x);
}

/// kappa_n = sqrt(pi) Gamma(n/2 + 1)/Gamma((n + 1)/2): the image of r^n is kappa_n x^n.
///
/// @param exponent  n >= 0, not necessarily an integer
/// @throws std::domain_error for n < 0 or NaN, where the transform does not exist
[[nodiscard]] double power_ratio(double exponent);

/// Image of the profile C r^n, C kappa_n x^n. Domain and errors are those of power_ratio().
[[nodiscard]] double power_profile_1d(double coefficient, double exponent, double x);

/// Profile of the image C x^n, (C/kappa_n) r^n. Domain and errors are those of power_ratio().
[[nodiscard]] double power_profile_3d(double coefficient, double exponent, double r);

}  // namespace monograin::mdr
