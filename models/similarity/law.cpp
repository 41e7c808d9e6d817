#include "similarity/law.hpp"

#include "system/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace monograin::similarity {
namespace {

using std::numbers::pi;

constexpr Pair k_equal_pair{.curvature = 2.0, .cubed_curvature = 2.0};  // R = 1; gamma = 2x

double cubed_curvature(const Law& law, const Pair& pair) noexcept {
  return law.radius == RadiusRule::corrected ? pair.cubed_curvature : 0.0;
}

/// Strength of one material against itself.
double equal_strength(const Law& law) noexcept { return std::exp2(-law.exponent); }

/// a with gamma = (a^2 A/2 + a^4 B/8)/c^2 (eq. B.24 without cancellation; eq. 2.5 for B = 0).
double radius_of(const Law& law, const Pair& pair, double approach) noexcept {
  const double a = pair.curvature;
  const double b = cubed_curvature(law, pair);
  return std::sqrt(4.0 * law.area_constant * approach /
                   (a + std::sqrt(a * a + 2.0 * b * law.area_constant * approach)));
}

double force_coefficient(const Law& law, const Pair& pair, double strength) noexcept {
  return pi * law.pressure_constant * std::pow(pair.curvature, law.exponent) * strength;
}

}  // namespace

Pair pair_of(double first_radius, double second_radius) {
  if (!(first_radius > 0.0 && second_radius > 0.0) || (std::isinf(first_radius) && std::isinf(second_radius))) {
    throw std::invalid_argument("radii must be positive and not both infinite, but are " + number_text(first_radius) +
                                " and " + number_text(second_radius));
  }
  const double first = 1.0 / first_radius;
  const double second = 1.0 / second_radius;
  return {.curvature = first + second, .cubed_curvature = first * first * first + second * second * second};
}

double pair_strength(double first, double second, double exponent) {
  plastic::require_exponent(exponent);
  if (!(first > 0.0 && second > 0.0) || (std::isinf(first) && std::isinf(second))) {
    throw std::invalid_argument("strengths must be positive and not both infinite, but are " + number_text(first) +
                                " and " + number_text(second));
  }
  const auto [weaker, stronger] = std::minmax(first, second);
  // The formula below would give m ln 1 for equal strengths, which is not a number where m is infinite.
  if (exponent == 0.0) return weaker;
  const double power = std::exp(std::log(weaker / stronger) / exponent);
  return weaker * std::exp(-exponent * std::log1p(power));
}

Law make_law(double exponent, RadiusRule radius) {
  plastic::require_exponent(exponent);
  return {.exponent = exponent,
          .area_constant = 1.43 * std::exp(-0.97 * exponent),
          .pressure_constant = 3.0 * std::pow(6.0, -exponent),
          .radius = radius};
}

PairContact pair_contact(const Law& law, const Pair& pair, double strength, double approach) noexcept {
  if (approach <= 0.0) return {};
  const double a = radius_of(law, pair, approach);
  const double slope = law.area_constant / (a * (pair.curvature + 0.5 * cubed_curvature(law, pair) * a * a));
  const double force_over_radius = force_coefficient(law, pair, strength) * std::pow(a, law.exponent) * a;
  return {.contact_radius = a,
          .force = force_over_radius * a,
          .contact_radius_by_approach = slope,
          .force_by_approach = (2.0 + law.exponent) * force_over_radius * slope};
}

double pair_approach(const Law& law, const Pair& pair, double strength, double force) noexcept {
  if (force <= 0.0) return 0.0;
  const double a = std::pow(force / force_coefficient(law, pair, strength), 1.0 / (2.0 + law.exponent));
  return a * a * (0.5 * pair.curvature + 0.125 * cubed_curvature(law, pair) * a * a) / law.area_constant;
}

double pair_work(const Law& law, const Pair& pair, double strength, double approach) noexcept {
  if (approach <= 0.0) return 0.0;
  // int P (d gamma/da) da.
  const double a = radius_of(law, pair, approach);
  const double force = force_coefficient(law, pair, strength) * std::pow(a, 2.0 + law.exponent);
  return force * a * a / law.area_constant *
         (pair.curvature / (4.0 + law.exponent) + 0.5 * cubed_curvature(law, pair) * a * a / (6.0 + law.exponent));
}

ContactState state_in(const Law& law, Regime /*regime*/, double x) noexcept {
  if (x <= 0.0) return {};
  const PairContact contact = pair_contact(law, k_equal_pair, equal_strength(law), 2.0 * x);
  // H = k (a/R)^mu for equal spheres (eqs. 3.42-3.44).
  const double a = contact.contact_radius;
  const double slope = 2.0 * contact.contact_radius_by_approach;
  const double pressure = law.pressure_constant * std::pow(a, law.exponent);
  return {.regime = Regime::fully_plastic,
          .contact_radius = a,
          .pressure = pressure,
          .force = contact.force,
          .contact_radius_by_approach = slope,
          .pressure_by_approach = law.exponent * pressure / a * slope,
          .force_by_approach = 2.0 * contact.force_by_approach};
}

ContactState state_at(const Law& law, double x) {
  plastic::require_approach_below(x, Law::limit, Limit::walls_meet);
  return state_in(law, Regime::fully_plastic, x);
}

double approach_under(const Law& law, double force, double /*near*/) {
  const double x = 0.5 * pair_approach(law, k_equal_pair, equal_strength(law), force);
  if (x < Law::limit) return x;
  throw DomainError(Limit::walls_meet, "a force of " + number_text(force) + " kappa R0^2 leads to displacement/R0 = " +
                                           number_text(x) + ", not below 1, where the walls meet");
}

double work_per_wall(const Law& law, double x) {
  plastic::require_approach_below(x, Law::limit, Limit::walls_meet);
  // The pair's work is that of its two walls.
  return 0.5 * pair_work(law, k_equal_pair, equal_strength(law), 2.0 * x);
}

}  // namespace monograin::similarity
