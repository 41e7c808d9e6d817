#include "semimech/law.hpp"

#include "system/number_text.hpp"
#include "system/resolution.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace monograin::semimech {
namespace {

using std::numbers::pi;

constexpr double k_yield_pressure = 1.1;  // H at x_y (text before eq. 2.17)
constexpr double k_little_beyond = 1e-3;  // distance beyond zero porosity that trial steps may reach

/// D_i = b_i^(i/2) alpha_i tanh(beta_i lambda^delta_i) (eq. 2.14, Table 2.2).
RadiusSeries radius_series(Configuration configuration, double lambda) noexcept {
  const auto& [d1, d3, d5] = rigid_radius_series(configuration);
  return {.first = d1 * std::tanh(0.3540 * std::pow(lambda, 0.2633)),
          .third = d3 * std::tanh(0.0411 * std::pow(lambda, 0.5366)),
          .fifth = d5 * std::tanh(0.0634 * std::pow(lambda, 0.4766))};
}

Stiffening make_stiffening(Configuration configuration, double zeta, const PressureFall& fall) {
  const double s = 0.2335 * zeta;
  const double excess = cell_excess(configuration, fall.end);  // chi_m - 1, > 0
  Stiffening stiffening{
      .cell_at_least = 1.0 + excess, .softness = s / (1.0 + s), .softness_complement = 1.0 / (1.0 + s)};
  // v of eq. 2.46 put into eq. 2.45, with l/(1 - l) = s and ln(1 - l) = -log1p(s).
  stiffening.pressure_scale = (zeta * excess + fall.least) / (2.0 * s - std::log1p(s));
  stiffening.elastic_volume = (fall.least + stiffening.pressure_scale * std::log1p(s)) / zeta;
  const double v = stiffening.elastic_volume;
  if (!(v < 1.0)) {
    throw std::invalid_argument("bulk modulus over yield stress of " + number_text(zeta) +
                                " is so small that the particle does not fill its cell: its elastic loss of volume " +
                                "would be " + number_text(v) + " of it");
  }
  stiffening.cell_at_zero_porosity = 1.0 - v;
  // 1 - (pi/6 chi_zp)^(1/n) (eq. 2.42) as the filled cell's x and a positive term.
  const double filled = filled_cell_approach(configuration);
  const double n = configuration == Configuration::hydrostatic ? 3.0 : 1.0;
  stiffening.zero_porosity = filled - (1.0 - filled) * std::expm1(std::log1p(-v) / n);
  return stiffening;
}

/// ln(x_Hmax/x), exact near x_Hmax.
double logarithm_to_greatest(const Law& law, double x) noexcept { return std::log1p((law.fall.start - x) / x); }

ValueAndSlope elastic_pressure(const Law& law, double x) noexcept {  // eqs. 2.15, 2.16
  const double factor = 4.0 * law.material.modulus_over_yield / (3.0 * pi);
  const double root = std::sqrt(x);
  return {.value = factor * root, .slope = 0.5 * factor / root};
}

/// Beyond the greatest pressure the curve continues like the nearest integer power: where the exponent is near 1, a
/// mirror image would have a kink there.
ValueAndSlope elastic_plastic_pressure(const Law& law, double x) noexcept {  // eqs. 2.18, 2.21
  const double ratio = logarithm_to_greatest(law, x) / law.yield_logarithm;
  const double rise = law.fall.greatest - k_yield_pressure;
  const double power = std::pow(std::abs(ratio), law.logarithm_exponent - 1.0);
  const double slope = rise * law.logarithm_exponent * power / (law.yield_logarithm * x);
  const bool is_odd = std::lround(law.logarithm_exponent) % 2 != 0;
  const double drop = rise * std::abs(ratio) * power;
  if (ratio >= 0.0) return {.value = law.fall.greatest - drop, .slope = slope};
  return is_odd ? ValueAndSlope{.value = law.fall.greatest + drop, .slope = slope}
                : ValueAndSlope{.value = law.fall.greatest - drop, .slope = -slope};
}

/// A little beyond zero porosity the curve continues along its tangent. For nearly incompressible materials the pole of
/// the logarithm lies there, and a trial step that begins at zero porosity has to end somewhere.
ValueAndSlope low_compressibility_pressure(const Law& law, double x) {  // eq. 2.41
  const Stiffening& c = law.stiffening;
  const double within = std::min(x, c.zero_porosity);
  if (x - within > k_little_beyond) {
    throw DomainError(Limit::cell_filled, "displacement/R0 = " + number_text(x) +
                                              " is too far above zero porosity at " + number_text(c.zero_porosity) +
                                              " for the law of low compressibility");
  }
  const double span = cell_shrinkage(law.configuration, law.fall.end, c.zero_porosity);
  const double y = cell_shrinkage(law.configuration, law.fall.end, within) / span;
  // 1 - l y^2 without cancellation at y = 1, where l is close to 1 for nearly incompressible materials.
  const double rest = cell_shrinkage(law.configuration, within, c.zero_porosity) / span;
  const double argument = rest * (1.0 + y) + c.softness_complement * y * y;
  const double slope =
      -2.0 * c.pressure_scale * c.softness * y / argument * cell_slope(law.configuration, within) / span;
  return {.value = law.fall.least - c.pressure_scale * std::log(argument) + slope * (x - within), .slope = slope};
}

ValueAndSlope elastic_volumetric_pressure(const Law& law, double x) noexcept {  // eq. 2.44
  // 1 - chi is counted from zero porosity, so that the branches join there to the last digit.
  const Stiffening& c = law.stiffening;
  const double loss = c.elastic_volume + cell_shrinkage(law.configuration, c.zero_porosity, x);
  const double zeta = law.material.bulk_over_yield;
  return {.value = zeta * loss, .slope = -zeta * cell_slope(law.configuration, x)};
}

ValueAndSlope pressure_in(const Law& law, Regime regime, double x) {
  switch (regime) {
    case Regime::elastic:
      return elastic_pressure(law, x);
    case Regime::elastic_plastic:
      return elastic_plastic_pressure(law, x);
    case Regime::fully_plastic:
      return falling_pressure(law.fall, x);
    case Regime::low_compressibility:
      if (is_enclosed(law.configuration)) return low_compressibility_pressure(law, x);
      break;
    case Regime::elastic_volumetric:
      if (is_enclosed(law.configuration)) return elastic_volumetric_pressure(law, x);
      break;
    case Regime::open:
    case Regime::undefined:
    case Regime::unloading:
    case Regime::separated:
      break;
  }
  throw std::domain_error("a contact under " + std::string(name(law.configuration)) +
                          " compression has no law for the regime '" + std::string(name(regime)) + "'");
}

/// int of f from a to b.
template <unsigned Points, class Integrand>
double integral(const Integrand& f, double a, double b) {
  return boost::math::quadrature::gauss<double, Points>::integrate(f, a, b);
}

/// x under a small force, where a/R = D1 x^(1/2). Its relative error is of order x.
double small_approach(const Law& law, double force) {
  const double first = law.radius.first;
  const double root = std::cbrt(3.0 * force / (4.0 * law.material.modulus_over_yield * first * first));
  return root * root;
}

}  // namespace

Material make_material(double youngs_modulus, double poisson_ratio, double yield_stress) {
  if (!(youngs_modulus > 0.0) || !std::isfinite(youngs_modulus))
    throw std::invalid_argument("Young's modulus must be positive and finite, but is " + number_text(youngs_modulus));
  if (!(yield_stress > 0.0) || !std::isfinite(yield_stress))
    throw std::invalid_argument("yield stress must be positive and finite, but is " + number_text(yield_stress));
  if (!(poisson_ratio > -1.0 && poisson_ratio <= 0.5))
    throw std::invalid_argument("Poisson's ratio must be in (-1, 0.5], but is " + number_text(poisson_ratio));
  const double ratio = youngs_modulus / yield_stress;
  return {.modulus_over_yield = ratio / ((1.0 - poisson_ratio) * (1.0 + poisson_ratio)),
          .bulk_over_yield = ratio / (3.0 * (1.0 - 2.0 * poisson_ratio))};
}

bool is_in_fitted_range(double value, double lower, double upper) noexcept {
  // Half a dozen products, differences and unit conversions have four times the round-off of a few operations.
  return value >= lower * (1.0 - 4.0 * k_round_off) && value <= upper * (1.0 + 4.0 * k_round_off);
}

std::vector<OutOfRange> outside_calibration(double youngs_modulus, double poisson_ratio, double yield_stress,
                                            Configuration configuration) {
  const Material material = make_material(youngs_modulus, poisson_ratio, yield_stress);
  std::vector<OutOfRange> found;
  const auto check = [&](OutOfRange entry) {
    if (!is_in_fitted_range(entry.value, entry.lower, entry.upper)) found.push_back(entry);
  };
  check({"E/((1-nu^2) Y)", material.modulus_over_yield, k_least_fitted_modulus_over_yield,
         k_greatest_fitted_modulus_over_yield});
  if (is_enclosed(configuration)) {
    check({"E/Y", youngs_modulus / yield_stress, 100.0, 5000.0});
    check({"nu", poisson_ratio, 0.2, 0.48});
    check({"E/(3 (1-2nu) Y)", material.bulk_over_yield, 64.0, 28000.0});
  }
  return found;
}

Law make_law(const Material& material, Configuration configuration) {
  const double lambda = material.modulus_over_yield;
  const double zeta = material.bulk_over_yield;
  if (!(lambda >= k_least_modulus_over_yield) || !std::isfinite(lambda)) {
    throw std::invalid_argument("E/((1-nu^2) Y) = " + number_text(lambda) +
                                ": the pressure would have a kink at its maximum; expected a finite number from " +
                                number_text(k_least_modulus_over_yield) + " on");
  }
  if (is_enclosed(configuration) && !(zeta > 0.0 && std::isfinite(zeta))) {
    throw std::invalid_argument(
        "an enclosed particle needs a positive and finite bulk modulus over yield stress, not " + number_text(zeta) +
        " (nu = 0.5 has none)");
  }

  Law law{.configuration = configuration, .material = material, .radius = radius_series(configuration, lambda)};
  const double root = 3.0 * pi * k_yield_pressure / (4.0 * lambda);
  law.yield_approach = root * root;
  const double greatest = 3.101 * std::tanh(0.6746 * std::pow(lambda, 0.0829));   // eq. 2.19
  const double at_greatest = std::expm1(0.7073 * std::pow(lambda, -0.6547));      // eq. 2.20
  const double rate = 14.1819 * std::tanh(0.3729 * std::pow(lambda, 0.1013));     // eq. 2.39
  const double exponent_excess = std::expm1(1.6199 * std::pow(lambda, -0.3232));  // eq. 2.40
  law.yield_logarithm = std::log(at_greatest / law.yield_approach);
  // eq. 2.22: the slope of the elastic branch at x_y is H/(2 x_y).
  law.logarithm_exponent = 0.5 * k_yield_pressure * law.yield_logarithm / (greatest - k_yield_pressure);
  law.logarithm_amplitude = (greatest - k_yield_pressure) * std::pow(law.yield_logarithm, -law.logarithm_exponent);
  law.fall = make_pressure_fall(configuration, law.radius, greatest, at_greatest, exponent_excess, rate);
  law.calibrated_end = 0.5;
  if (is_enclosed(configuration)) {
    law.stiffening = make_stiffening(configuration, zeta, law.fall);
    law.calibrated_end = law.stiffening.zero_porosity + 0.01;
  }
  Regime regime = Regime::elastic;
  for (const Boundary& end : boundaries(law)) {
    law.boundary_forces.push_back(state_in(law, regime, end.approach).force);
    regime = end.beyond;
  }
  return law;
}

Boundaries boundaries(const Law& law) {
  const bool is_singular = law.logarithm_exponent < 2.0;
  Boundaries list{{"yield", law.yield_approach, Regime::elastic_plastic},
                  {"fully-plastic", law.fall.start, Regime::fully_plastic, is_singular}};
  if (is_enclosed(law.configuration)) {
    list.push_back({"low-compressibility", law.fall.end, Regime::low_compressibility});
    list.push_back({"zero-porosity", law.stiffening.zero_porosity, Regime::elastic_volumetric});
  }
  return list;
}

Regime regime_at(const Law& law, double x) noexcept {
  if (!(x > 0.0)) return Regime::open;
  if (x <= law.yield_approach) return Regime::elastic;
  if (x <= law.fall.start) return Regime::elastic_plastic;
  if (x <= law.fall.end || !is_enclosed(law.configuration)) return Regime::fully_plastic;
  return x <= law.stiffening.zero_porosity ? Regime::low_compressibility : Regime::elastic_volumetric;
}

ContactState state_at(const Law& law, double x) {
  plastic::require_approach_below(x, Law::limit, Limit::walls_meet);
  return state_in(law, regime_at(law, x), x);
}

ContactState state_in(const Law& law, Regime regime, double x) {
  if (regime == Regime::open) return {};
  if (!(x > 0.0)) throw std::domain_error("displacement/R0 = " + number_text(x) + " is no contact");
  return loaded_contact(regime, contact_radius(law.radius, x), pressure_in(law, regime, x));
}

double approach_under(const Law& law, double force, double near) {
  if (force <= 0.0) return 0.0;
  double lower = 0.0;
  Regime regime = Regime::elastic;
  const auto state = [&](double x) { return state_in(law, regime, x); };
  const Boundaries ends = boundaries(law);
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const Boundary& end = ends[k];
    if (force <= law.boundary_forces[k]) {
      if (const auto found = plastic::approach_near(state, lower, end.approach, force, near)) return *found;
      return regime == Regime::elastic
                 ? plastic::approach_from_touch(state, end.approach, force, small_approach(law, force))
                 : plastic::approach_between(state, lower, end.approach, force, lower);
    }
    lower = end.approach;
    regime = end.beyond;
  }
  const double last = std::nextafter(Law::limit, 0.0);
  const double greatest = state(last).force;
  if (force <= greatest) {
    const auto found = plastic::approach_near(state, lower, last, force, near);
    return found ? *found : plastic::approach_between(state, lower, last, force, lower);
  }
  throw DomainError(Limit::walls_meet, "a force of " + number_text(force) + " Y R0^2 is above the greatest, " +
                                           number_text(greatest) +
                                           " Y R0^2 just below displacement/R0 = 1, where the walls meet");
}

double work_in(const Law& law, Regime regime, double x) {
  // Each regime is integrated in a variable in which its force is smooth.
  const auto force = [&](double at) { return state_in(law, regime, at).force; };
  switch (regime) {
    case Regime::elastic:
      // A polynomial of degree 12 in t: exact with 7 points.
      return integral<7>([&](double t) { return force(x * t * t) * 2.0 * x * t; }, 0.0, 1.0);
    case Regime::elastic_plastic: {
      const double last = logarithm_to_greatest(law, x);
      const double span = law.yield_logarithm - last;
      return integral<30>(
          [&](double t) {
            const double at = law.fall.start * std::exp(-(last + span * t * t));
            return force(at) * at * 2.0 * span * t;
          },
          0.0, 1.0);
    }
    case Regime::fully_plastic: {
      const double span = x - law.fall.start;
      return integral<30>([&](double t) { return force(law.fall.start + span * t * t * t) * 3.0 * span * t * t; }, 0.0,
                          1.0);
    }
    case Regime::low_compressibility: {
      // Position of the logarithm's singularity, l y^2 = 1, to first order in 1 - l.
      const double span = cell_shrinkage(law.configuration, law.fall.end, law.stiffening.zero_porosity);
      const double beyond = -0.5 * law.stiffening.softness_complement * span /
                            cell_slope(law.configuration, law.stiffening.zero_porosity);
      return plastic::work_below_singularity(force, law.fall.end, x, law.stiffening.zero_porosity + beyond);
    }
    default:
      return integral<7>(force, law.stiffening.zero_porosity, x);
  }
}

double work(const Law& law, double x) {
  plastic::require_approach_below(x, Law::limit, Limit::walls_meet);
  if (x <= 0.0) return 0.0;
  double sum = 0.0;
  Regime regime = Regime::elastic;
  for (const Boundary& end : boundaries(law)) {
    if (x <= end.approach) break;
    sum += work_in(law, regime, end.approach);
    regime = end.beyond;
  }
  return moving_walls(law.configuration) * (sum + work_in(law, regime, x));
}

}  // namespace monograin::semimech
