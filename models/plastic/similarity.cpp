#include "plastic/similarity.hpp"

#include "system/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace monograin::plastic {
namespace {

using std::numbers::pi;

constexpr SimilarityPair k_equal_pair{.curvature = 2.0, .cubed_curvature = 2.0};  // R = 1; gamma = 2x

void require_exponent(double exponent) {
  if (!(exponent >= 0.0 && exponent <= 1.0))
    throw std::invalid_argument("the hardening exponent 1/m must be in [0, 1], but is " + number_text(exponent));
}

double cubed_curvature(const SimilarityLaw& law, const SimilarityPair& pair) noexcept {
  return law.radius == SimilarityRadius::corrected ? pair.cubed_curvature : 0.0;
}

/// Strength of one material against itself.
double equal_strength(const SimilarityLaw& law) noexcept { return std::exp2(-law.exponent); }

/// a with gamma = (a^2 A/2 + a^4 B/8)/c^2 (eq. B.24 without cancellation; eq. 2.5 for B = 0).
double radius_of(const SimilarityLaw& law, const SimilarityPair& pair, double approach) noexcept {
  const double a = pair.curvature;
  const double b = cubed_curvature(law, pair);
  return std::sqrt(4.0 * law.area_constant * approach /
                   (a + std::sqrt(a * a + 2.0 * b * law.area_constant * approach)));
}

double force_coefficient(const SimilarityLaw& law, const SimilarityPair& pair, double strength) noexcept {
  return pi * law.pressure_constant * std::pow(pair.curvature, law.exponent) * strength;
}

}  // namespace

SimilarityPair make_similarity_pair(double first_radius, double second_radius) {
  if (!(first_radius > 0.0 && second_radius > 0.0) || (std::isinf(first_radius) && std::isinf(second_radius))) {
    throw std::invalid_argument("radii must be positive and not both infinite, but are " + number_text(first_radius) +
                                " and " + number_text(second_radius));
  }
  const double first = 1.0 / first_radius;
  const double second = 1.0 / second_radius;
  return {.curvature = first + second, .cubed_curvature = first * first * first + second * second * second};
}

double similarity_strength(double first, double second, double exponent) {
  require_exponent(exponent);
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

SimilarityLaw make_similarity(double exponent, SimilarityRadius radius) {
  require_exponent(exponent);
  return {.exponent = exponent,
          .area_constant = 1.43 * std::exp(-0.97 * exponent),
          .pressure_constant = 3.0 * std::pow(6.0, -exponent),
          .radius = radius};
}

SimilarityContact similarity_contact(const SimilarityLaw& law, const SimilarityPair& pair, double strength,
                                     double approach) noexcept {
  if (approach <= 0.0) return {};
  const double a = radius_of(law, pair, approach);
  const double slope = law.area_constant / (a * (pair.curvature + 0.5 * cubed_curvature(law, pair) * a * a));
  const double force_over_radius = force_coefficient(law, pair, strength) * std::pow(a, law.exponent) * a;
  return {.contact_radius = a,
          .force = force_over_radius * a,
          .contact_radius_by_approach = slope,
          .force_by_approach = (2.0 + law.exponent) * force_over_radius * slope};
}

double similarity_approach(const SimilarityLaw& law, const SimilarityPair& pair, double strength,
                           double force) noexcept {
  if (force <= 0.0) return 0.0;
  const double a = std::pow(force / force_coefficient(law, pair, strength), 1.0 / (2.0 + law.exponent));
  return a * a * (0.5 * pair.curvature + 0.125 * cubed_curvature(law, pair) * a * a) / law.area_constant;
}

double similarity_work(const SimilarityLaw& law, const SimilarityPair& pair, double strength,
                       double approach) noexcept {
  if (approach <= 0.0) return 0.0;
  // int P (d gamma/da) da.
  const double a = radius_of(law, pair, approach);
  const double force = force_coefficient(law, pair, strength) * std::pow(a, 2.0 + law.exponent);
  return force * a * a / law.area_constant *
         (pair.curvature / (4.0 + law.exponent) + 0.5 * cubed_curvature(law, pair) * a * a / (6.0 + law.exponent));
}

ContactState contact_of(const SimilarityLaw& law, double x) noexcept {
  if (x <= 0.0) return {};
  const SimilarityContact contact = similarity_contact(law, k_equal_pair, equal_strength(law), 2.0 * x);
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

ContactState state_at(const SimilarityLaw& law, double x) {
  require_approach_below(x, k_similarity_limit, Limit::walls_meet);
  return contact_of(law, x);
}

double approach_under(const SimilarityLaw& law, double force) {
  if (std::isnan(force)) throw std::domain_error("the force is not a number");
  const double x = 0.5 * similarity_approach(law, k_equal_pair, equal_strength(law), force);
  if (x < k_similarity_limit) return x;
  throw DomainError(Limit::walls_meet, "a force of " + number_text(force) + " kappa R0^2 leads to displacement/R0 = " +
                                           number_text(x) + ", not below 1, where the walls meet");
}

double work_per_wall(const SimilarityLaw& law, double x) {
  require_approach_below(x, k_similarity_limit, Limit::walls_meet);
  // The pair's work is that of its two walls.
  return 0.5 * similarity_work(law, k_equal_pair, equal_strength(law), 2.0 * x);
}

}  // namespace monograin::plastic
