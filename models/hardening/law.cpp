#include "hardening/law.hpp"

#include "system/number_text.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace monograin::hardening {
namespace {

using std::numbers::pi;

constexpr double k_rate = 14.1819;  // q of eq. 2.39 for lambda -> infinity; r of eq. 2.40 is 1 there

Limit reason_of_limit(const Law& law) noexcept {
  return is_enclosed(law.configuration) ? Limit::cell_filled : Limit::walls_meet;
}

/// d_i (eq. 3.47, whose indices are 1, 3, 5).
RadiusSeries radius_series(Configuration configuration, double mu) noexcept {
  const auto& [d1, d3, d5] = rigid_radius_series(configuration);
  return {.first = d1 * std::exp(-0.485 * mu),
          .third = d3 * std::exp(-1.455 * mu),
          .fifth = d5 * std::exp(-0.5279 * std::pow(mu, 0.4616))};
}

/// Mean pressure H of low compressibility without its factor x^(mu/2), and the slope of that.
plastic::ValueAndSlope reduced_low_compressibility_pressure(const Law& law, double x) {
  const double span = law.cell_at_least - 1.0;
  const double rest = cell_excess(law.configuration, x) / span;  // 1 - y
  const double y = cell_shrinkage(law.configuration, law.fall.end, x) / span;
  const double argument = rest * (1.0 + y);
  if (!(argument > 0.0)) {
    throw DomainError(Limit::cell_filled, "displacement/R0 = " + number_text(x) +
                                              " is not between the least pressure and zero porosity at " +
                                              number_text(law.zero_porosity) +
                                              " as the law of low compressibility demands");
  }
  return {.value = law.fall.least - law.pressure_scale * std::log(argument),
          .slope = -2.0 * law.pressure_scale * y / argument * cell_slope(law.configuration, x) / span};
}

plastic::ValueAndSlope reduced_pressure(const Law& law, Regime regime, double x) {
  if (regime == Regime::fully_plastic) return falling_pressure(law.fall, x);
  if (regime == Regime::low_compressibility && is_enclosed(law.configuration))
    return reduced_low_compressibility_pressure(law, x);
  throw std::domain_error("a hardening contact under " + std::string(name(law.configuration)) +
                          " compression has no law for the regime '" + std::string(name(regime)) + "'");
}

/// Coefficient c of the force P = c x^(1 + mu/2) for small x.
double small_force_coefficient(const Law& law) noexcept {
  return pi * law.fall.greatest * law.radius.first * law.radius.first;
}

/// Largest x of the fully plastic regime.
double end_of_fall(const Law& law) noexcept { return std::min(law.fall.end, std::nextafter(law.limit, 0.0)); }

void set_end(Law& law, double calibrated_end, double limit) {
  law.calibrated_end = calibrated_end;
  law.limit = limit;
  law.force_at_least = state_in(law, Regime::fully_plastic, end_of_fall(law)).force;
}

}  // namespace

Law make_law(double exponent, Configuration configuration, MinimumCondition condition) {
  plastic::require_exponent(exponent);
  Law law{.configuration = configuration, .exponent = exponent, .radius = radius_series(configuration, exponent)};
  const RadiusSeries minimum = condition == MinimumCondition::current ? law.radius : rigid_radius_series(configuration);
  // eq. 3.48. The amplitudes of the fall need this value, too, where the source prints 3.101: only then is the pressure
  // continuous at its minimum, and positive in simple compression.
  const double greatest = 3.101 * std::exp(-1.748 * exponent);
  law.fall = make_pressure_fall(configuration, minimum, greatest, 0.0, 0.0, k_rate);
  if (!is_enclosed(law.configuration)) {
    set_end(law, 0.5, 1.0);
    return law;
  }
  const double excess = cell_excess(configuration, law.fall.end);
  law.cell_at_least = 1.0 + excess;
  law.pressure_scale = excess / (0.467 * std::exp(-0.5883 * exponent));
  law.zero_porosity = filled_cell_approach(configuration);
  set_end(law, law.zero_porosity, law.zero_porosity);
  return law;
}

Boundaries boundaries(const Law& law) {
  if (!is_enclosed(law.configuration)) return {};
  return {{"low-compressibility", law.fall.end, Regime::low_compressibility},
          {"zero-porosity", law.zero_porosity * (1.0 - k_zero_porosity_margin), Regime::undefined}};
}

Regime regime_at(const Law& law, double x) noexcept {
  if (!(x > 0.0)) return Regime::open;
  return x <= law.fall.end || !is_enclosed(law.configuration) ? Regime::fully_plastic : Regime::low_compressibility;
}

ContactState state_at(const Law& law, double x) {
  plastic::require_approach_below(x, law.limit, reason_of_limit(law));
  return state_in(law, regime_at(law, x), x);
}

ContactState state_in(const Law& law, Regime regime, double x) {
  if (regime == Regime::open) return {};
  if (!(x > 0.0)) throw std::domain_error("displacement/R0 = " + number_text(x) + " is no contact");
  const auto [reduced, slope] = reduced_pressure(law, regime, x);
  const double half = 0.5 * law.exponent;
  const double factor = std::pow(x, half);
  return loaded_contact(regime, contact_radius(law.radius, x),
                        {.value = reduced * factor, .slope = (slope + reduced * half / x) * factor});
}

double approach_under(const Law& law, double force, double near) {
  if (force <= 0.0) return 0.0;
  const auto fully_plastic = [&](double x) { return state_in(law, Regime::fully_plastic, x); };
  const double last = std::nextafter(law.limit, 0.0);
  const double end = end_of_fall(law);
  double greatest = law.force_at_least;
  if (force <= greatest) {
    if (const auto found = plastic::approach_near(fully_plastic, 0.0, end, force, near)) return *found;
    const double guess = std::pow(force / small_force_coefficient(law), 1.0 / (1.0 + 0.5 * law.exponent));
    return plastic::approach_from_touch(fully_plastic, end, force, guess);
  }
  if (is_enclosed(law.configuration)) {
    const auto stiffening = [&](double x) { return state_in(law, Regime::low_compressibility, x); };
    greatest = stiffening(last).force;
    if (force <= greatest) return plastic::approach_between(stiffening, end, last, force, end);
  }
  throw DomainError(reason_of_limit(law), "a force of " + number_text(force) + " kappa R0^2 is above the greatest, " +
                                              number_text(greatest) +
                                              " kappa R0^2 just below displacement/R0 = " + number_text(law.limit) +
                                              ": " + std::string(sentence(reason_of_limit(law))));
}

double work_in(const Law& law, Regime regime, double x) {
  // Each regime is integrated in a variable in which its force is smooth.
  const auto force = [&](double at) { return state_in(law, regime, at).force; };
  if (regime == Regime::low_compressibility)
    return plastic::work_below_singularity(force, law.fall.end, x, law.zero_porosity);
  return boost::math::quadrature::gauss<double, 30>::integrate(
      [&](double t) { return force(x * t * t * t) * 3.0 * x * t * t; }, 0.0, 1.0);
}

double work(const Law& law, double x) {
  plastic::require_approach_below(x, law.limit, reason_of_limit(law));
  if (x <= 0.0) return 0.0;
  double sum = work_in(law, Regime::fully_plastic, std::min(x, law.fall.end));
  if (x > law.fall.end) sum += work_in(law, Regime::low_compressibility, x);
  return moving_walls(law.configuration) * sum;
}

}  // namespace monograin::hardening
