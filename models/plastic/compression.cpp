#include "plastic/compression.hpp"

#include "system/number_text.hpp"

#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace monograin::plastic {
namespace {

using std::numbers::pi;

constexpr std::array<std::string_view, 3> k_configurations{"simple", "die", "hydrostatic"};
constexpr double k_contact_density = 0.0593;  // Gamma (text after eq. 2.30)

/// T(z) of the fall for an angle z - s.
ValueAndSlope bump(double rate, double z, double angle) noexcept {
  // tanh and sech^2 by one exponential: 1 - tanh^2 would lose its digits where the rise is complete.
  const double decay = std::exp(-2.0 * rate * std::abs(z));
  const double complement = decay > 0.5 ? -std::expm1(-2.0 * rate * std::abs(z)) : 1.0 - decay;
  const double rise = std::copysign(complement / (1.0 + decay), z);
  const double sech_squared = 4.0 * decay / ((1.0 + decay) * (1.0 + decay));
  const double cosine = std::cos(angle);
  return {.value = rise * cosine, .slope = rate * sech_squared * cosine - rise * std::sin(angle)};
}

/// Z - s = atan(2q csch(2qZ)) (eq. 2.26); in this form the hyperbolic sine does not overflow.
double lag_of_shift(double rate, double length) noexcept {
  const double exponent = -2.0 * rate * length;
  return std::atan(4.0 * rate * std::exp(exponent) / -std::expm1(2.0 * exponent));
}

/// Approximate inflexion point of T^r (eqs. 2.34, D.6). It is off by some per cent; H_min is fitted with it as it is.
double inflexion_point(double rate, double exponent_excess, double shift) noexcept {
  const double r = 1.0 + exponent_excess;
  const double t = std::tan(shift);
  const double c = 2.0 * rate * rate + 3.0;
  const double root = std::sqrt(3.0 * c * exponent_excess * (2.0 * r + 1.0) + 9.0 * (2.0 * r * r - 1.0) * t * t);
  if (t < 0.0) return 3.0 * exponent_excess / (root - 3.0 * r * t);
  return (3.0 * r * t + root) / (c * (2.0 * r + 1.0) + 3.0 * (r + 1.0) * t * t);
}

}  // namespace

std::string_view name(Configuration configuration) noexcept {
  return k_configurations[static_cast<std::size_t>(configuration)];
}

Configuration configuration_named(std::string_view word) {
  const auto found = std::ranges::find(k_configurations, word);
  if (found != k_configurations.end()) return static_cast<Configuration>(found - k_configurations.begin());
  throw std::invalid_argument("configuration = '" + std::string(word) +
                              "' is not known; expected one of 'simple', 'die', 'hydrostatic'");
}

int moving_walls(Configuration configuration) noexcept { return configuration == Configuration::hydrostatic ? 6 : 2; }

RadiusSeries rigid_radius_series(Configuration configuration) noexcept {
  constexpr RadiusSeries simple{.first = 1.7527, .third = 2.3702, .fifth = 3.3715};  // alpha_i
  const auto scaled = [&](double b1, double b3, double b5) {
    return RadiusSeries{.first = std::sqrt(b1) * simple.first,
                        .third = b3 * std::sqrt(b3) * simple.third,
                        .fifth = b5 * b5 * std::sqrt(b5) * simple.fifth};
  };
  switch (configuration) {
    case Configuration::simple:
      return simple;
    case Configuration::die:
      return scaled(1.048, 1.1818, 1.2352);
    case Configuration::hydrostatic:
      return scaled(1.1701, 2.4002, 2.9376);
  }
  return {};
}

ValueAndSlope contact_radius(const RadiusSeries& series, double x) noexcept {
  const auto& [d1, d3, d5] = series;
  const double root = std::sqrt(x);
  return {.value = root * (d1 - x * (d3 - d5 * x)), .slope = (d1 - x * (3.0 * d3 - 5.0 * d5 * x)) / (2.0 * root)};
}

ContactState loaded_contact(Regime regime, ValueAndSlope contact_radius, ValueAndSlope pressure) noexcept {
  const double a = contact_radius.value;
  return {.regime = regime,
          .contact_radius = a,
          .pressure = pressure.value,
          .force = pi * pressure.value * a * a,
          .contact_radius_by_approach = contact_radius.slope,
          .pressure_by_approach = pressure.slope,
          .force_by_approach = pi * a * (a * pressure.slope + 2.0 * pressure.value * contact_radius.slope)};
}

double filled_cell_approach(Configuration configuration) noexcept {
  // 1 - pi/6 and 1 - (pi/6)^(1/3). Evaluated, these differences would carry the round-off of numbers above 1/2.
  return configuration == Configuration::hydrostatic ? 0.194004022991765179641517 : 0.476401224401701126922893;
}

double cell_excess(Configuration configuration, double x) noexcept {
  const double filled = filled_cell_approach(configuration);
  const double w = (filled - x) / (1.0 - filled);
  return configuration == Configuration::hydrostatic ? w * (3.0 + w * (3.0 + w)) : w;
}

double cell_shrinkage(Configuration configuration, double from, double to) noexcept {
  const double linear = 6.0 / pi * (to - from);
  if (configuration != Configuration::hydrostatic) return linear;
  const double a = 1.0 - from;
  const double b = 1.0 - to;
  return linear * (a * a + a * b + b * b);
}

double cell_slope(Configuration configuration, double x) noexcept {
  return configuration == Configuration::hydrostatic ? -18.0 / pi * (1.0 - x) * (1.0 - x) : -6.0 / pi;
}

double least_pressure_approach(Configuration configuration, const RadiusSeries& series) {
  const bool is_hydrostatic = configuration == Configuration::hydrostatic;
  const double d1 = series.first;
  const double d3 = series.third;
  const double d5 = series.fifth;
  // pi^2 (a/R)^2 - 144 Gamma (1-x)^n, n = 1 or 5, rises from below 0 to above it.
  const auto excess = [=](double x) {
    const double root_free = d1 - x * (d3 - d5 * x);
    const double slope = d1 - x * (3.0 * d3 - 5.0 * d5 * x);
    const double gap = 1.0 - x;
    const double n = is_hydrostatic ? 5.0 : 1.0;
    const double power = is_hydrostatic ? gap * gap * gap * gap : 1.0;
    return std::pair(pi * pi * x * root_free * root_free - 144.0 * k_contact_density * power * gap,
                     pi * pi * root_free * slope + 144.0 * n * k_contact_density * power);
  };
  std::uintmax_t iterations = 100;
  return boost::math::tools::newton_raphson_iterate(excess, is_hydrostatic ? 0.147 : 0.31, 0.0, 1.0, 30, iterations);
}

double impingement_approach(Configuration configuration, const RadiusSeries& series) {
  if (configuration == Configuration::simple)
    throw std::invalid_argument("contacts impinge on each other in the die and under hydrostatic compression only");
  const double closing = configuration == Configuration::hydrostatic ? 1.0 : 0.0;
  const auto overhang = [&](double x) { return contact_radius(series, x).value - (1.0 - closing * x); };
  std::uintmax_t iterations = 100;
  const auto [below, above] =
      boost::math::tools::toms748_solve(overhang, 0.0, 1.0, boost::math::tools::eps_tolerance<double>(), iterations);
  return 0.5 * (below + above);
}

PressureFall make_pressure_fall(Configuration configuration, const RadiusSeries& minimum, double greatest, double start,
                                double exponent_excess, double rate) {
  const double r = 1.0 + exponent_excess;
  PressureFall fall{
      .greatest = greatest, .start = start, .exponent_excess = exponent_excess, .rate = rate, .end = 1.0, .least = 1.0};

  const double simple_length = 1.0 - start;
  const double simple_lag = lag_of_shift(rate, simple_length);
  const double simple_peak = bump(rate, simple_length, simple_lag).value;
  fall.simple_shift = simple_length - simple_lag;
  fall.simple_amplitude = (greatest - 1.0) / std::pow(simple_peak, r);  // eq. 2.32
  fall.simple_inflexion = inflexion_point(rate, exponent_excess, fall.simple_shift);
  if (configuration == Configuration::simple) {
    fall.amplitude = fall.steep_amplitude = fall.simple_amplitude;
    fall.shift = fall.simple_shift;
    fall.lag = simple_lag;
    fall.peak = simple_peak;
    fall.inflexion = fall.simple_inflexion;
    fall.simple_least = fall.steep_least = fall.least;
    return fall;
  }

  fall.end = least_pressure_approach(configuration, minimum);
  const double length = fall.end - start;
  fall.lag = lag_of_shift(rate, length);
  fall.shift = length - fall.lag;
  fall.peak = bump(rate, length, fall.lag).value;
  fall.inflexion = inflexion_point(rate, exponent_excess, fall.shift);

  const double simple_bump = bump(rate, length, length - fall.simple_shift).value;
  fall.simple_least = greatest - fall.simple_amplitude * std::pow(simple_bump, r);  // eq. 2.33

  // eq. 2.35 as a quotient of the slopes of T^r, which stays finite where r = 1 and the inflexion is at z = 0.
  const auto slope_of_power = [&](double z, double shift) {
    const auto [value, slope] = bump(rate, z, z - shift);
    return std::pow(value, exponent_excess) * slope;
  };
  fall.steep_amplitude = fall.simple_amplitude * slope_of_power(fall.simple_inflexion, fall.simple_shift) /
                         slope_of_power(fall.inflexion, fall.shift);
  const double power = std::pow(fall.peak, r);
  fall.steep_least = greatest - fall.steep_amplitude * power;  // eq. 2.36
  fall.least = 0.5 * (fall.simple_least + fall.steep_least);   // eq. 2.37
  fall.amplitude = (greatest - fall.least) / power;            // eq. 2.38
  return fall;
}

ValueAndSlope falling_pressure(const PressureFall& fall, double x) noexcept {
  // The angle z - s from the far end: exact where the slope has to vanish.
  const auto [value, slope] = bump(fall.rate, x - fall.start, (x - fall.end) + fall.lag);
  const double drop = fall.greatest - fall.least;
  const double ratio = value / fall.peak;
  const double power = std::pow(std::abs(ratio), fall.exponent_excess);
  const double sign = ratio < 0.0 ? -1.0 : 1.0;
  return {.value = fall.greatest - drop * std::abs(ratio) * power,
          .slope = -sign * drop * (1.0 + fall.exponent_excess) * power * slope / fall.peak};
}

void require_approach_below(double x, double limit, Limit reason) {
  if (x < limit) return;
  throw DomainError(reason, "displacement/R0 = " + number_text(x) + " is not below " + number_text(limit) + ": " +
                                std::string(sentence(reason)));
}

void require_exponent(double exponent) {
  if (!(exponent >= 0.0 && exponent <= 1.0))
    throw std::invalid_argument("the hardening exponent 1/m must be in [0, 1], but is " + number_text(exponent));
}

}  // namespace monograin::plastic
