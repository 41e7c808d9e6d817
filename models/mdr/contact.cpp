#include "mdr/contact.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "elastic/hertz.hpp"
#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {
namespace {

using std::numbers::pi;

// Angle from which on theta - sin(theta) cos(theta) loses no digits.
constexpr double k_large_angle = 0.5;

// psi(theta) = sum_(k>=2) (-1)^k (3 - 4n + 3^(n-1)) theta^n / (4 n!), n = 2k + 1.
constexpr int k_psi_terms = 12;
constexpr auto k_psi_coefficients = [] {
  std::array<double, k_psi_terms> coefficients{};
  double factorial = 24.0;  // (n - 1)!
  double power = 27.0;      // 3^(n-2)
  for (int i = 0; i < k_psi_terms; ++i) {
    const int n = 2 * (i + 2) + 1;
    factorial *= n;
    power *= 3.0;
    coefficients[static_cast<std::size_t>(i)] = (i % 2 == 0 ? 0.25 : -0.25) * (3.0 - 4.0 * n + power) / factorial;
    factorial *= n + 1;
    power *= 3.0;
  }
  return coefficients;
}();

/// Angle of the ellipse's parametrisation from its versine y = 1 - cos(theta), without cancellation.
double angle_from_versine(double y) noexcept { return 2.0 * std::asin(std::sqrt(0.5 * y)); }

double elastic_versine(double radius, double overlap) {
  const double y = overlap / (2.0 * radius);
  if (y > 1.0) throw DomainError(Limit::overlap_of_diameter);
  return y;
}

// First yield is solved for s = sqrt(d): the excess of the elastic mean pressure over the plastic one, both over Y, is
// a smooth function of s.

double elastic_excess(double modulus_over_yield, double s, const PressureRatio& plastic) noexcept {
  return 4.0 / (3.0 * pi) * modulus_over_yield * s - plastic.value;
}

/// The s at which the elastic mean pressure is the yield stress.
double root_overlap_of_unit_pressure(double modulus_over_yield) noexcept { return 0.75 * pi / modulus_over_yield; }

/// s^2 at the root of the excess between the bounds.
template <class Excess>
double square_of_root(const Excess& excess, double lower, double upper) {
  const double at_lower = excess(lower);
  const double at_upper = excess(upper);
  // Where the plastic pressure is constant, the bounds equal the root to within round-off.
  if (!(at_lower < 0.0)) return lower * lower;
  if (!(at_upper > 0.0)) return upper * upper;
  std::uintmax_t iterations = 100;
  const auto [below, above] = boost::math::tools::toms748_solve(
      excess, lower, upper, at_lower, at_upper, boost::math::tools::eps_tolerance<double>(), iterations);
  const double s = 0.5 * (below + above);
  return s * s;
}

/// Angle theta with cos(theta) = u, for u in [0, 1), and slightly beyond the largest overlap (u < 0).
double unloading_angle(double u) noexcept { return u > 0.5 ? angle_from_versine(1.0 - u) : std::acos(u); }

/// Indenter that a contact leaves when it unloads. zeta is the depth of the particle's centre below its tip over a_max,
/// s = sqrt(1 + zeta^2), k = 1/(2 (1 - nu)).
struct IndenterLeft {
  UnloadingShape shape;
  double zeta, s, k;
};

IndenterLeft indenter_left(double composite_modulus, double poisson_ratio, double radius, double overlap_max,
                           double contact_radius, double pressure) {
  const double a = contact_radius;
  const double height = 4.0 * pressure * a / composite_modulus;
  const double depth = radius - overlap_max + 0.5 * height;
  if (!(depth > 0.0)) throw DomainError(Limit::wall_at_centre);
  const double zeta = depth / a;
  const double s = std::sqrt(1.0 + zeta * zeta);
  const double k = 1.0 / (2.0 * (1.0 - poisson_ratio));
  const double rho = (1.0 + k * zeta / s) / (s + zeta);  // eq. 34
  return {{.radius = radius,
           .overlap_max = overlap_max,
           .contact_radius_max = a,
           .pressure = pressure,
           .height = height,
           .rho = rho,
           .recovery = 0.5 * height * (1.0 - rho)},
          zeta,
          s,
          k};
}

}  // namespace

Material make_material(double youngs_modulus, double poisson_ratio, double yield_stress,
                       std::shared_ptr<const PressureCurve> pressure_curve) {
  const double modulus = composite_modulus(youngs_modulus, poisson_ratio);
  return {.composite_modulus = modulus,
          .poisson_ratio = poisson_ratio,
          .yield_stress = yield_stress,
          .linear_compressibility = (1.0 - 2.0 * poisson_ratio) / youngs_modulus,
          .yield_overlap_ratio = pressure_curve ? yield_overlap_ratio(modulus / yield_stress, *pressure_curve)
                                                : yield_overlap_ratio(modulus / yield_stress),
          .pressure_curve = std::move(pressure_curve)};
}

double yield_overlap_ratio(double modulus_over_yield) {
  const auto excess = [=](double s) { return elastic_excess(modulus_over_yield, s, exponential_pressure(s * s)); };
  if (!(excess(1.0) > 0.0)) return k_infinity;
  // The pressure ratio falls from its value at 0 to 1, which brackets the root closely however stiff the material.
  const double unit = root_overlap_of_unit_pressure(modulus_over_yield);
  return square_of_root(excess, unit, std::min(1.0, exponential_pressure(0.0).value * unit));
}

double yield_overlap_ratio(double modulus_over_yield, const PressureCurve& pressure_curve) {
  const auto excess = [&](double s) {
    // Round-off of the square must not lead beyond the end of the curve.
    const double overlap = std::min(s * s, pressure_curve.end());
    return elastic_excess(modulus_over_yield, s, pressure_curve.at(overlap));
  };
  const double unit = root_overlap_of_unit_pressure(modulus_over_yield);
  double lower = 0.0;
  for (const double knot : pressure_curve.knots().subspan(1)) {
    const double upper = std::sqrt(std::min(knot, 1.0));
    if (excess(upper) > 0.0) {
      // The pressure of a piece lies between those at its ends. The least and the greatest of them bracket the root.
      const auto [least, greatest] =
          std::minmax({pressure_curve.at(lower * lower).value, pressure_curve.at(std::min(upper * upper, knot)).value});
      return square_of_root(excess, std::max(lower, least * unit), std::min(upper, greatest * unit));
    }
    if (knot >= 1.0) break;
    lower = upper;
  }
  return k_infinity;
}

double phi(double theta) noexcept {
  if (theta >= k_large_angle) return theta - std::sin(theta) * std::cos(theta);
  // (t - sin t)/2 with t = 2 theta as a nested Taylor series, whose denominators are n (n + 1) for n = 4, 6, ..., 18;
  // the last term kept is below 1e-17 of the sum at t = 1.
  const double t = 2.0 * theta;
  const double s = t * t;
  double sum = 1.0;
  for (const double denominator : {342.0, 272.0, 210.0, 156.0, 110.0, 72.0, 42.0, 20.0})
    sum = 1.0 - s / denominator * sum;
  return t * s / 12.0 * sum;
}

double phi_at(double theta, double sine, double cosine) noexcept {
  return theta >= k_large_angle ? theta - sine * cosine : phi(theta);
}

// Boost's newton_raphson_iterate() takes 1.3 times the instructions.
double inverse_phi(double value) noexcept {
  constexpr double k_last_angle_step = 1e-9;  // over theta; the next step of Newton's method is round-off
  double theta = std::cbrt(1.5 * value);      // phi = (2/3) theta^3 (1 - theta^2/5 + ...)
  if (theta == 0.0) return 0.0;
  for (int iteration = 0; iteration < 20; ++iteration) {
    const double sine = std::sin(theta);
    const double step = (value - phi(theta)) / (2.0 * sine * sine);
    theta += step;
    if (std::abs(step) < k_last_angle_step * theta) break;
  }
  return theta;
}

double psi(double theta) noexcept {
  if (theta >= 1.0) {
    const double s = std::sin(theta);
    return s - theta * std::cos(theta) - s * s * s / 3.0;
  }
  const double square = theta * theta;
  double sum = 0.0;
  for (auto c = k_psi_coefficients.rbegin(); c != k_psi_coefficients.rend(); ++c) sum = sum * square + *c;
  return sum * square * square * theta;
}

Contact elastic_contact(ElasticProfile profile, double composite_modulus, double radius, double overlap) {
  if (overlap <= 0.0) return {};
  switch (profile) {
    case ElasticProfile::ellipse: {
      const double y = elastic_versine(radius, overlap);
      const double theta = angle_from_versine(y);
      const double sine = std::sqrt(y * (2.0 - y));
      const double phi_theta = phi_at(theta, sine, 1.0 - y);
      const double a = radius * sine;
      return {.contact_radius = a,
              .force = 2.0 * composite_modulus * radius * radius * phi_theta,
              .by_overlap = 2.0 * composite_modulus * a,
              .by_radius = 4.0 * composite_modulus * radius * (phi_theta - y * sine)};
    }
    case ElasticProfile::parabola: {
      const double a = hertz_contact_radius(radius, overlap);
      const double force = hertz_force(composite_modulus, radius, overlap);
      return {.contact_radius = a,
              .force = force,
              .by_overlap = 2.0 * composite_modulus * a,
              .by_radius = force / (2.0 * radius)};
    }
  }
  return {};
}

PlasticPressure plastic_pressure(const Material& material, double overlap_over_radius) {
  // A sampled curve begins at zero overlap.
  if (material.pressure_curve && overlap_over_radius < 0.0) {
    return {.pressure = material.yield_stress * material.pressure_curve->at(0.0).value, .decrement = 0.0};
  }
  const auto [value, slope] = material.pressure_curve ? material.pressure_curve->at(overlap_over_radius)
                                                      : exponential_pressure(overlap_over_radius);
  return {.pressure = material.yield_stress * value, .decrement = -material.yield_stress * slope};
}

double yield_area_constant(double yield_overlap_ratio, double radius) noexcept {
  return yield_overlap_ratio * (yield_overlap_ratio - 1.0) * radius * radius;
}

Contact plastic_contact(const Material& material, double radius, double overlap, double area_constant) {
  // The formulas also hold without contact area: their negative force pulls a trial back to positive area.
  const double area = 2.0 * overlap * radius - overlap * overlap + area_constant;
  const auto [pressure, decrement] = plastic_pressure(material, overlap / radius);
  return {.contact_radius = std::sqrt(std::max(area, 0.0)),
          .force = pi * pressure * area,
          .by_overlap = pi * (2.0 * pressure * (radius - overlap) - decrement / radius * area),
          .by_radius = pi * (2.0 * pressure * overlap + decrement * overlap / (radius * radius) * area)};
}

UnloadingShape unloading_shape_of(double composite_modulus, double poisson_ratio, double radius, double overlap_max,
                                  double contact_radius, double pressure) {
  return indenter_left(composite_modulus, poisson_ratio, radius, overlap_max, contact_radius, pressure).shape;
}

UnloadingShape unloading_shape(const Material& material, double radius, double overlap_max, double area_constant) {
  const double m = overlap_max;
  const double area = 2.0 * m * radius - m * m + area_constant;
  if (!(area > 0.0)) throw std::domain_error("contact area of a plastic contact is not positive");
  const auto [pressure, decrement] = plastic_pressure(material, m / radius);
  const double a = std::sqrt(area);
  auto [shape, zeta, s, k] = indenter_left(material.composite_modulus, material.poisson_ratio, radius, m, a, pressure);

  shape.log_pressure_by_max = -decrement / (radius * pressure);
  shape.log_pressure_by_radius = decrement * m / (radius * radius * pressure);
  shape.log_contact_radius_by_max = (radius - m) / area;
  shape.log_contact_radius_by_radius = m / area;

  // zeta/s - 1 = -1/(s (s + zeta)), which keeps its digits for small contacts (zeta >> 1).
  const double rho_by_zeta = (k / (s * s) - (1.0 + k * zeta / s)) / (s * (s + zeta));
  const double height_by_max = shape.height * (shape.log_pressure_by_max + shape.log_contact_radius_by_max);
  const double height_by_radius = shape.height * (shape.log_pressure_by_radius + shape.log_contact_radius_by_radius);
  shape.rho_by_max = rho_by_zeta * ((0.5 * height_by_max - 1.0) / a - zeta * shape.log_contact_radius_by_max);
  shape.rho_by_radius = rho_by_zeta * ((0.5 * height_by_radius + 1.0) / a - zeta * shape.log_contact_radius_by_radius);
  return shape;
}

double unloading_fraction(const UnloadingShape& shape, double overlap) noexcept {
  return (shape.overlap_max - overlap) / shape.recovery;
}

namespace {

/// Contact on the unloading branch at u = cos(theta), given theta and its sine.
Contact on_unloading_branch(const UnloadingShape& shape, double composite_modulus, double u, double theta,
                            double sine) {
  const double phi_theta = phi_at(theta, sine, u);
  const double yield_force = 2.0 * shape.pressure * shape.contact_radius_max * shape.contact_radius_max;
  const double a = shape.contact_radius_max * sine;

  const auto by = [&](double pressure_x, double contact_radius_x, double rho_x, double overlap_max_x) {
    const double u_x =
        overlap_max_x / shape.recovery - u * (pressure_x + contact_radius_x) + u * rho_x / (1.0 - shape.rho);
    return yield_force * ((pressure_x + 2.0 * contact_radius_x) * phi_theta - 2.0 * sine * u_x);
  };
  return {.contact_radius = a,
          .force = yield_force * phi_theta,
          .by_overlap = 2.0 * composite_modulus * a / (1.0 - shape.rho),
          .by_radius = by(shape.log_pressure_by_radius, shape.log_contact_radius_by_radius, shape.rho_by_radius, 0.0),
          .by_overlap_max = by(shape.log_pressure_by_max, shape.log_contact_radius_by_max, shape.rho_by_max, 1.0)};
}

}  // namespace

Contact unloading_contact(const UnloadingShape& shape, double composite_modulus, double overlap) {
  // Trials more than one recovery above the largest overlap keep the force of that overlap.
  const double u = std::max(unloading_fraction(shape, overlap), -1.0);
  if (u >= 1.0) return {};
  return on_unloading_branch(shape, composite_modulus, u, unloading_angle(u), std::sqrt((1.0 - u) * (1.0 + u)));
}

Contact recompressed_contact(const UnloadingShape& shape, double composite_modulus, double share) {
  if (share <= 0.0) return {};
  const double within = std::min(share, 2.0);
  return on_unloading_branch(shape, composite_modulus, 1.0 - within, 2.0 * std::asin(std::sqrt(0.5 * within)),
                             std::sqrt(within * (2.0 - within)));
}

double elastic_overlap(ElasticProfile profile, double composite_modulus, double radius, double force) {
  if (force <= 0.0) return 0.0;
  switch (profile) {
    case ElasticProfile::ellipse: {
      const double value = force / (2.0 * composite_modulus * radius * radius);
      if (value > 0.5 * pi) throw DomainError(Limit::overlap_of_diameter);
      const double sine = std::sin(0.5 * inverse_phi(value));
      return 4.0 * radius * sine * sine;
    }
    case ElasticProfile::parabola:
      return hertz_overlap(composite_modulus, radius, force);
  }
  return 0.0;
}

double plastic_overlap(const Material& material, double radius, double force, double area_constant, double guess) {
  constexpr double k_inside = 1e-3;  // least distance of the first overlap from the ends of the bracket
  // Steps, over the overlap, that end the search: any as short as the first, and those below the second that are no
  // shorter than the step before.
  constexpr double k_shortest_overlap_step = 1e-16;
  constexpr double k_noisy_overlap_step = 1e-13;
  // At `low` the contact has no area; the force rises from there to its largest value not far below the radius, and
  // then falls. The ends of the bracket may therefore have equal signs, which bracketing root finders do not accept.
  // Newton's method is used, with bisection where the force falls.
  double low = radius - std::sqrt(radius * radius + area_constant);
  double high = radius;
  double overlap = std::clamp(guess, low + k_inside * (radius - low), (1.0 - k_inside) * radius);
  double last_step = k_infinity;
  for (int iteration = 0; iteration < k_most_newton_steps; ++iteration) {
    const Contact contact = plastic_contact(material, radius, overlap, area_constant);
    const double missing = force - contact.force;
    const bool is_rising = contact.by_overlap > 0.0;
    // Past its largest value the force falls, and the overlap sought is smaller.
    (is_rising && missing > 0.0 ? low : high) = overlap;
    double next = overlap + missing / contact.by_overlap;
    const bool is_outside = !is_rising || !(next >= low && next <= high);
    if (is_outside) next = std::midpoint(low, high);
    const double size = std::abs(next - overlap);
    overlap = next;
    if (size > k_shortest_overlap_step * overlap && (size < last_step || size >= k_noisy_overlap_step * overlap)) {
      last_step = size;
      continue;
    }
    // If the prescribed force exceeds the largest one, the search ends at the overlap of the largest one.
    if (is_outside && missing > k_no_net_force * force) break;
    return overlap;
  }
  throw DomainError(Limit::greatest_force);
}

double recompressed_share(const UnloadingShape& shape, double force) {
  const double a = shape.contact_radius_max;
  const double value = force / (2.0 * shape.pressure * a * a);
  if (value > k_largest_phi) throw std::domain_error("overlap beyond the end of the unloading branch");
  const double sine = value > 0.0 ? std::sin(0.5 * inverse_phi(value)) : 0.0;
  return 2.0 * sine * sine;
}

double unloading_overlap(const UnloadingShape& shape, double force) {
  return shape.overlap_max - shape.recovery * (1.0 - recompressed_share(shape, force));
}

double elastic_energy(ElasticProfile profile, double composite_modulus, double radius, double overlap) {
  if (overlap <= 0.0) return 0.0;
  switch (profile) {
    case ElasticProfile::ellipse:
      return 4.0 * composite_modulus * radius * radius * radius *
             psi(angle_from_versine(elastic_versine(radius, overlap)));
    case ElasticProfile::parabola:
      return hertz_energy(composite_modulus, radius, overlap);
  }
  return 0.0;
}

double plastic_energy(const UnloadingShape& shape) noexcept { return unloading_energy(shape, shape.overlap_max); }

double unloading_energy(const UnloadingShape& shape, double overlap) noexcept {
  const double u = unloading_fraction(shape, overlap);
  if (u >= 1.0) return 0.0;
  const double a = shape.contact_radius_max;
  const double scale = 2.0 * shape.recovery * shape.pressure * a * a;
  if (u <= -1.0) return scale * (psi(pi) - pi * (1.0 + u));
  return scale * psi(unloading_angle(u));
}

double plastic_work_primitive(const Material& material, double radius, double overlap, double area_constant) {
  // Counted from zero overlap, so that it is no larger than the work itself where the yield overlap is small.
  const double x = overlap / radius;
  const auto [zeroth, first, second] =
      material.pressure_curve ? material.pressure_curve->moments(x) : exponential_moments(x);
  const double square = radius * radius;
  return pi * material.yield_stress * radius * (square * (2.0 * first - second) + area_constant * zeroth);
}

}  // namespace monograin::mdr
