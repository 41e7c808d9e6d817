#include "nonlocal/coupling.hpp"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>

#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

using std::numbers::pi;

/// C = (1 + nu)/(4 pi), the unit of all compliances.
double unit_compliance(double nu) noexcept { return (1.0 + nu) / (4.0 * pi); }

/// @param round_off  relative round-off of the integrand; no refinement gets below it
double integral(const auto& f, double begin, double end, double round_off = 0.0) {
  // The tolerance bounds the error estimate of the embedded Gauss rule; the value is exact to round-off long before.
  const double tolerance = std::max(1e-12, round_off);
  return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(f, begin, end, 8, tolerance);
}

/// Displacement of a half-space's surface under a point force (eqs. A.4, A.5), over C: along the force, and away from
/// its axis over the sine of the angle.
struct SurfaceDisplacement {
  double axial, radial_over_sine;

  SurfaceDisplacement(double nu, double half_sine) noexcept {
    const double inverse = 1.0 / half_sine;
    axial = half_sine + 2.0 * (1.0 - nu) * inverse;
    radial_over_sine = 0.5 * inverse * (1.0 - (1.0 - 2.0 * nu) * inverse / (1.0 + half_sine));
  }
};

void require_inside(double x) {
  if (x <= k_widest) return;
  throw DomainError({Limit::contact_as_wide_as_particle, -1, "contact radius/R0", x});
}

/// sqrt(1 - x^2); 0 for an x that exceeds 1 by round-off.
double depth_of_edge(double x) noexcept { return std::sqrt(std::max(0.0, (1.0 - x) * (1.0 + x))); }

/// int_0^pi f(sin^2(phi/2)) dphi for an f that is analytic up to tan(phi/2) = i branch. The trapezoidal rule on the
/// circle, with tan(phi/2) stretched so that this point and infinity are equally far: the error falls by e for every
/// 1/width points. None if more than k_most points would be needed.
std::optional<double> integral_on_circle(const auto& f, double branch) {
  constexpr std::size_t k_most = 1024;
  constexpr double k_log_accuracy = 45.0;  // -ln(error), with room for f at its branch point
  static const auto k_squared_sines = [] {
    std::array<double, k_most / 2 + 1> squares{};
    for (std::size_t k = 0; k < squares.size(); ++k) {
      const double sine = std::sin(pi * static_cast<double>(k) / static_cast<double>(k_most));
      squares[k] = sine * sine;
    }
    return squares;
  }();
  const double width = 2.0 * std::atanh(std::sqrt(branch));
  std::size_t count = 8;
  while (count < k_most && static_cast<double>(count) * width < k_log_accuracy) count *= 2;
  if (!(static_cast<double>(count) * width >= k_log_accuracy)) return std::nullopt;
  double sum = 0.0;
  for (std::size_t k = 0; k <= count / 2; ++k) {
    const double square = k_squared_sines[k * (k_most / count)];
    const double per_growth = 1.0 / (1.0 - square + branch * square);
    const double share = k == 0 || k == count / 2 ? 0.5 : 1.0;  // an end point has no mirror image
    sum += share * f(branch * square * per_growth) * per_growth;
  }
  return 2.0 * pi / static_cast<double>(count) * std::sqrt(branch) * sum;
}

/// Mean over the contact's edge of the displacement away from its middle (eq. 8).
double edge_influence(bool is_projected, double nu, double theta, double x) {
  const double cap = std::asin(std::min(x, 1.0));
  const double sine = std::sin(theta);
  const double cosine = std::cos(theta);
  const double depth = depth_of_edge(x);
  const double nearest_half_sine = std::sin(0.5 * (theta - cap));
  const double nearest_half_cosine = std::cos(0.5 * (theta - cap));
  const SurfaceDisplacement middle(nu, std::sin(0.5 * theta));
  // Displacement at an angle phi around the contact, given by square = sin^2(phi/2).
  const auto outward = [&](double square) {
    const double across = 1.0 - 2.0 * square;  // cos(phi)
    // sin^2 and cos^2 of beta/2 (eq. 10), both without cancellation where they are small.
    const double turned = x * square * sine;
    const double half_sine = std::sqrt(nearest_half_sine * nearest_half_sine + turned);
    const SurfaceDisplacement edge(nu, half_sine);
    const double axial = -(edge.axial - middle.axial) * sine * across;
    if (is_projected) {
      const double along_squared = 4.0 * square * (1.0 - square);  // sin^2(phi)
      const double edge_arm = -cosine * across * (sine * depth - x * cosine * across) + x * along_squared;
      return axial + edge.radial_over_sine * edge_arm + middle.radial_over_sine * sine * cosine * across;
    }
    // The edge may pass the point opposite to the force.
    const double half_cosine = std::sqrt(std::max(0.0, nearest_half_cosine * nearest_half_cosine - turned));
    const double edge_sine = 2.0 * half_sine * half_cosine;
    const double length = std::sqrt(1.0 - sine * sine * across * across);  // eq. A.10
    return axial + (edge.radial_over_sine * edge_sine - middle.radial_over_sine * sine) * length;
  };
  if (is_projected) {
    const double nearest = std::abs(nearest_half_sine);
    const double branch = nearest / std::hypot(nearest, std::sqrt(x * sine));
    if (const auto sum = integral_on_circle(outward, branch)) return unit_compliance(nu) / pi * *sum;
  }
  // The length of eq. A.10 is |sin(phi)| at theta = pi/2: the halves are smooth, the whole is not.
  // Displacements at the edge and in the middle differ by a share of the order of x, which round-off limits.
  const double round_off = 64.0 * k_epsilon / x;
  const auto around = [&](double phi) {
    const double half = std::sin(0.5 * phi);
    return outward(half * half);
  };
  return unit_compliance(nu) / pi *
         (integral(around, 0.0, 0.5 * pi, round_off) + integral(around, 0.5 * pi, pi, round_off));
}

}  // namespace

double half_space_influence(double poisson_ratio, double theta) noexcept {
  const double nu = poisson_ratio;
  const double s = std::sin(0.5 * theta);
  return unit_compliance(nu) * ((7.0 - 8.0 * nu) * s - 2.0 * (1.0 - 2.0 * nu) - 2.0 * (1.0 - nu) / s);
}

double radius_quotient(double poisson_ratio, double theta) noexcept {
  const double half_cosine = std::cos(0.5 * theta);
  const double square = half_cosine * half_cosine;
  return square * (4.0 * poisson_ratio - 2.0 - 2.0 * square) / std::sin(0.5 * theta);
}

double local_radius_influence(double poisson_ratio, double x) {
  require_inside(x);
  const double q = depth_of_edge(x);
  const double k = std::sqrt(0.5 * (1.0 + q));
  return unit_compliance(poisson_ratio) *
         (k - 2.0 * (1.0 - 2.0 * poisson_ratio) * (1.0 - x / std::sqrt(2.0 * (1.0 + q))) / x);
}

double pole_radius_influence(double poisson_ratio, double x) {
  require_inside(x);
  const double q = depth_of_edge(x);
  const double k = std::sqrt(0.5 * (1.0 + q));
  return unit_compliance(poisson_ratio) *
         (x / std::sqrt(2.0 * (1.0 + q)) - (1.0 - 2.0 * poisson_ratio) * x / ((1.0 + q) * (1.0 + k)));
}

RadiusInfluence::RadiusInfluence(RadiusRule rule, double poisson_ratio, double x)
    : rule_(rule), poisson_ratio_(poisson_ratio), x_(x) {
  require_inside(x);
  if (rule != RadiusRule::closed) return;
  pole_ = pole_radius_influence(poisson_ratio, x);
  slope_ = 0.25 * unit_compliance(poisson_ratio) * (1.0 + 2.0 * poisson_ratio);
  critical_angle_ = pi - pole_ / slope_;
  at_critical_angle_ = radius_quotient(poisson_ratio, critical_angle_);
}

double RadiusInfluence::operator()(double theta, double quotient) const {
  switch (rule_) {
    case RadiusRule::closed:  // eqs. 14, 15
      if (theta > critical_angle_) return pole_ - slope_ * (pi - theta);
      return 0.25 * unit_compliance(poisson_ratio_) * x_ * (quotient - at_critical_angle_);
    case RadiusRule::integral:
      return edge_influence(false, poisson_ratio_, theta, x_);
    case RadiusRule::projected:
      return edge_influence(true, poisson_ratio_, theta, x_);
    case RadiusRule::none:
      return 0.0;
  }
  return 0.0;
}

double radius_influence(RadiusRule rule, double poisson_ratio, double theta, double x) {
  return RadiusInfluence(rule, poisson_ratio, x)(theta, radius_quotient(poisson_ratio, theta));
}

double edge_angle(double radius, double displacement) noexcept { return std::atan2(radius, 1.0 - displacement); }

}  // namespace monograin::nonlocal
