#include "mdr/contact_profile.hpp"

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/special_functions/ellint_rd.hpp>
#include <boost/math/special_functions/ellint_rf.hpp>
#include <cmath>
#include <numbers>

#include "system/resolution.hpp"

namespace monograin::mdr {
namespace {

using std::numbers::pi;

// The closed forms of the ellipse are differences that cancel near its tip. Up to this share of its half width their
// integrals are so smooth that a fixed Gauss rule has full accuracy: its error falls like 4^(-2n) at worst.
constexpr double k_tip = 0.5;
using TipRule = boost::math::quadrature::gauss<double, 20>;

/// sqrt(a^2 - x^2), without cancellation.
double chord(double a, double x) noexcept { return std::sqrt((a - x) * (a + x)); }

/// g(a) - g(x) for 0 <= x <= a, without cancellation near the edge.
double below_edge(const Indenter& indenter, double a, double x) noexcept {
  const double squares = (a - x) * (a + x);
  if (indenter.is_parabola()) return indenter.tip_curvature() * squares;
  const double b = indenter.half_width;
  const double heights = chord(b, x) + chord(b, a);
  return heights > 0.0 ? 0.5 * indenter.height * squares / (b * heights) : 0.0;
}

/// int_0^a (g(a) - g(x))/sqrt(r^2 - x^2) dx of the ellipse, for r > a.
/// @param angle  asin(a/r)
double ellipse_outside(const Indenter& indenter, double a, double r, double angle) {
  const double b = indenter.half_width;
  if (a <= k_tip * b)
    return TipRule::integrate([&](double t) { return below_edge(indenter, a, r * std::sin(t)); }, 0.0, angle);
  // (A/2) (E(angle, r/b) - angle sqrt(1 - a^2/b^2)); by Carlson's integrals, because the modulus may be above 1.
  const double sine = a / r;
  const double amplitude = a / b;
  // Complements formed from the rounded quotients would have no digits near the edge.
  const double cosine_square = (r - a) * (r + a) / (r * r);
  const double delta_square = (b - a) * (b + a) / (b * b);
  const double second_kind =
      sine * boost::math::ellint_rf(cosine_square, delta_square, 1.0) -
      amplitude * amplitude * sine / 3.0 * boost::math::ellint_rd(cosine_square, delta_square, 1.0);
  return 0.5 * indenter.height * (second_kind - angle * std::sqrt(delta_square));
}

/// int_0^a (g(a) - g(x))/sqrt(r^2 - x^2) dx of the parabola, for r > a:
/// (A/(4 b^2)) ((a^2 - r^2/2) angle + (a/2) sqrt(r^2 - a^2)).
double parabola_outside(const Indenter& indenter, double a, double r, double angle) {
  if (a <= k_tip * r)
    return TipRule::integrate([&](double t) { return below_edge(indenter, a, r * std::sin(t)); }, 0.0, angle);
  return indenter.tip_curvature() * ((a * a - 0.5 * r * r) * angle + 0.5 * a * chord(r, a));
}

}  // namespace

double ContactProfile::image_displacement(double x) const noexcept {
  const double distance = std::abs(x);
  if (distance > contact_radius) return 0.0;
  const double edge = displacement_1d - profile_height(indenter, contact_radius);
  return edge + below_edge(indenter, contact_radius, distance);
}

double ContactProfile::line_load(double x) const noexcept { return composite_modulus * image_displacement(x); }

double ContactProfile::pressure(double r) const noexcept {
  const double distance = std::abs(r);
  return distance < contact_radius ? pressure_at_chord(chord(contact_radius, distance)) : 0.0;
}

double ContactProfile::pressure_at_chord(double half_chord) const noexcept {
  const double a = contact_radius;
  const double b = indenter.half_width;
  const double slope = indenter.is_parabola() ? half_chord / b : std::atan2(half_chord, chord(b, a));
  const double edge = displacement_1d - profile_height(indenter, a);
  return composite_modulus / pi * (0.5 * indenter.height / b * slope + edge / half_chord);
}

double ContactProfile::surface_displacement(double r) const {
  const double distance = std::abs(r);
  const double a = contact_radius;
  if (distance <= a) return displacement_1d - relaxed_height(distance);
  const double angle = std::atan2(a, chord(distance, a));
  const double edge = displacement_1d - profile_height(indenter, a);
  const double inside = indenter.is_parabola() ? parabola_outside(indenter, a, distance, angle)
                                               : ellipse_outside(indenter, a, distance, angle);
  return 2.0 / pi * (edge * angle + inside);
}

double ContactProfile::relaxed_height(double r) const {
  if (indenter.is_parabola()) return 0.5 * indenter.tip_curvature() * r * r;
  const double distance = std::abs(r);
  const double modulus = distance / indenter.half_width;
  if (modulus > 1.0) return k_nan;
  if (modulus <= k_tip) {
    return 2.0 / pi *
           TipRule::integrate([&](double t) { return profile_height(indenter, distance * std::sin(t)); }, 0.0,
                              0.5 * pi);
  }
  return 0.5 * indenter.height * (1.0 - 2.0 / pi * boost::math::ellint_2(modulus));
}

std::vector<SurfacePoint> surface_of(const ContactProfile& profile) {
  std::vector<SurfacePoint> points;
  const double a = profile.contact_radius;
  const auto add = [&](double r) {
    points.push_back({.radius = r,
                      .pressure = profile.pressure(r),
                      .displacement = profile.surface_displacement(r),
                      .relaxed_height = profile.relaxed_height(r)});
  };
  // As many points around the contact, up to twice its radius, as within. They crowd towards the edge from both sides,
  // because slopes are unbounded there; none lies at the edge itself.
  for (int k = 0; k < k_surface_points; ++k) add(a * std::sin(0.5 * pi * k / k_surface_points));
  for (int k = 1; k <= k_surface_points; ++k) {
    const double share = static_cast<double>(k) / k_surface_points;
    add(a * (1.0 + share * share));
  }
  return points;
}

}  // namespace monograin::mdr
