/// Common parts of the laws for a plastic sphere between rigid flat walls: configurations, regimes, the series of the
/// contact radius, the room left to the particle, and the fall of the mean pressure.
///
/// The sphere is one half of a symmetric pair: gamma is the approach of the two centres, every moving wall moves by
/// gamma/2, and the laws depend on
///
///   x = gamma/(2R) = (displacement of a wall)/R
///
/// alone. Lengths are over R, pressures over the strength S (the yield stress, or the strength of a power law), forces
/// over S R^2, works over S R^3. Monotonic loading only: the source has no law for unloading.
/// Source, unless said otherwise: Shahin (2021).
#pragma once

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::plastic {

/// Which walls move: two opposite ones (nothing else touches), two with four fixed ones beside the particle, all six.
enum class Configuration { simple, die, hydrostatic };

[[nodiscard]] std::string_view name(Configuration configuration) noexcept;
/// Configuration with a name, as name() gives it.
/// @throws std::invalid_argument for another word
[[nodiscard]] Configuration configuration_named(std::string_view word);
[[nodiscard]] int moving_walls(Configuration configuration) noexcept;
/// True if walls surround the particle, so that its pores close.
[[nodiscard]] constexpr bool is_enclosed(Configuration configuration) noexcept {
  return configuration != Configuration::simple;
}

/// Regimes, in the order in which a contact passes them. The source has no law for `undefined`, nor for the last two,
/// which belong to contacts that have been unloaded.
enum class Regime {
  open,
  elastic,
  elastic_plastic,
  fully_plastic,
  low_compressibility,
  elastic_volumetric,
  undefined,
  unloading,
  separated
};

/// Words of the regimes, in their order.
inline constexpr std::array<std::string_view, 9> k_regimes{
    "open",      "elastic",   "elastic-plastic", "fully-plastic", "low-compressibility", "elastic-volumetric",
    "undefined", "unloading", "separated"};

[[nodiscard]] constexpr std::string_view name(Regime regime) noexcept {
  return k_regimes[static_cast<std::size_t>(regime)];
}

/// State of one contact at a given x. Everything is 0 without contact.
struct ContactState {
  Regime regime = Regime::open;
  double contact_radius = 0.0;  ///< a/R
  double pressure = 0.0;        ///< mean pressure, P/(S pi a^2)
  double force = 0.0;           ///< P/(S R^2)
  double contact_radius_by_approach = 0.0;
  double pressure_by_approach = 0.0;  ///< unbounded as x -> 0+
  double force_by_approach = 0.0;     ///< dP/dx over S R^2, > 0 in contact
};

/// End of a regime, and the event that marks it.
struct Boundary {
  std::string_view event;
  double approach = 0.0;  ///< x; still belongs to the regime before
  Regime beyond = Regime::undefined;
  bool is_singular = false;  ///< second derivatives of the pressure are unbounded towards it
};

/// Boundaries in ascending order; no law has more than four. The vector does not allocate, because every instant of a
/// run inverts forces with it.
using Boundaries = boost::container::static_vector<Boundary, 4>;

/// A function's value and its derivative with respect to x.
struct ValueAndSlope {
  double value = 0.0;
  double slope = 0.0;
};

/// Coefficients of the contact radius for equal radii (eq. 2.13): a/R = x^(1/2) [D1 - x (D3 - D5 x)].
struct RadiusSeries {
  double first = 0.0, third = 0.0, fifth = 0.0;
};

/// Coefficients of a material without any elastic strain, D_i = alpha_i b_i^(i/2): eq. 2.14 for lambda -> infinity,
/// constants of Table 2.2 as printed. The printed exponent 1/2 of b_i contradicts the values in Table 3.1 for i = 3 and
/// 5.
[[nodiscard]] RadiusSeries rigid_radius_series(Configuration configuration) noexcept;

/// a/R, for x > 0; increasing, because 9 D3^2 < 20 D1 D5 for every fitted set.
[[nodiscard]] ValueAndSlope contact_radius(const RadiusSeries& series, double x) noexcept;

/// Contact of a given radius under a given mean pressure.
[[nodiscard]] ContactState loaded_contact(Regime regime, ValueAndSlope contact_radius, ValueAndSlope pressure) noexcept;

// --- The cell between the planes of the six walls (die, hydrostatic): its volume over the particle's undeformed one is
// chi = (6/pi) (1 - x) in the die and (6/pi) (1 - x)^3 under hydrostatic compression.

/// x at which the cell has the particle's volume: 1 - pi/6 and 1 - (pi/6)^(1/3).
[[nodiscard]] double filled_cell_approach(Configuration configuration) noexcept;
/// chi - 1 without cancellation near the filled cell.
[[nodiscard]] double cell_excess(Configuration configuration, double x) noexcept;
/// chi(from) - chi(to) without cancellation.
[[nodiscard]] double cell_shrinkage(Configuration configuration, double from, double to) noexcept;
/// d chi/dx, < 0.
[[nodiscard]] double cell_slope(Configuration configuration, double x) noexcept;

// --- Fall of the mean pressure in the fully plastic regime.

/// The pressure goes from H_max at x = `start` to H_min at x = `end`, where its slope is zero (eqs. 2.25-2.40). It
/// falls if H_max > 1; otherwise, as of materials that harden strongly, H_min is the greater one and it rises:
///
///   H = H_max - (H_max - H_min) (T(z)/T(Z))^r,   T(z) = tanh(q z) cos(z - s),   z = x - start,   Z = end - start
///
/// with the shift s for which T'(Z) = 0. In simple compression Z ends at the flat disc, x = 1, with H_min = 1.
/// Elsewhere H_min is the mean of two estimates: that of simple compression at the same x, and that which gives the
/// inflexion point the slope of simple compression.
struct PressureFall {
  double greatest = 0.0;         ///< H_max, at `start`
  double start = 0.0;            ///< x at which the fall begins
  double exponent_excess = 0.0;  ///< r - 1, >= 0
  double rate = 0.0;             ///< q
  double end = 0.0;              ///< x at which the fall ends
  double least = 0.0;            ///< H_min, at `end`
  double amplitude = 0.0;        ///< p = (H_max - H_min)/T(Z)^r; negative where the pressure rises instead
  double shift = 0.0;            ///< s; negative for early minima
  double lag = 0.0;              ///< Z - s
  double peak = 0.0;             ///< T(Z)
  double inflexion = 0.0;        ///< approximate z of the inflexion point
  // Values in simple compression, and the two estimates of H_min; in simple compression they equal those above.
  double simple_shift = 0.0;
  double simple_amplitude = 0.0;
  double simple_inflexion = 0.0;
  double simple_least = 0.0;     ///< H_min1
  double steep_amplitude = 0.0;  ///< p_o
  double steep_least = 0.0;      ///< H_min2
};

/// @param minimum  contact radius in the condition for the least pressure (not used in simple compression)
[[nodiscard]] PressureFall make_pressure_fall(Configuration configuration, const RadiusSeries& minimum, double greatest,
                                              double start, double exponent_excess, double rate);

/// Mean pressure H at x. Before `start` its mirror image continues it, so that a trial step there is on a smooth
/// branch.
[[nodiscard]] ValueAndSlope falling_pressure(const PressureFall& fall, double x) noexcept;

/// x at which a sixth of the cell's relative density, the part of one contact, times the share of the cell's face that
/// is in contact reaches Gamma = 0.0593 (eqs. 2.28-2.30, C.2, C.4); between 0 and 1. Die and hydrostatic compression
/// only.
[[nodiscard]] double least_pressure_approach(Configuration configuration, const RadiusSeries& series);

/// x at which the circles of contact reach the edges of the cell's faces and so each other: a/R = 1 in the die, and
/// a/R = 1 - x under hydrostatic compression. The laws do not change there.
/// @throws std::invalid_argument for simple compression, where there are no neighbours
[[nodiscard]] double impingement_approach(Configuration configuration, const RadiusSeries& series);

// --- Helpers for all laws.

/// The x between two bounds at which a regime bears a force, to round-off.
/// @param state  function of x: the regime's ContactState, defined between the bounds and at them
/// @param lower  > 0; the force there is below `force`
/// @param upper  the force there is not below `force`
/// @param guess  initial guess of x; need not lie between the bounds
template <class State>
[[nodiscard]] double approach_between(const State& state, double lower, double upper, double force, double guess) {
  // Newton's method in both logarithms: the laws are close to powers, so that the slope varies little.
  const auto excess = [&](double log_x) {
    const double x = std::clamp(std::exp(log_x), lower, upper);
    const ContactState s = state(x);
    return std::pair(std::log(s.force / force), x * s.force_by_approach / s.force);
  };
  constexpr int bits = 50;  // fewer would do, except next to infinite pressures, where a short step may still be long
  const double log_lower = std::log(lower);
  const double log_upper = std::log(upper);
  double root = log_upper;  // where the bounds are too close for their logarithms to differ
  if (log_lower < log_upper) {
    std::uintmax_t iterations = 200;
    const double log_guess = std::log(std::clamp(guess, lower, upper));
    root = boost::math::tools::newton_raphson_iterate(excess, log_guess, log_lower, log_upper, bits, iterations);
  }
  // Round-off of the logarithm is up to |ln x| times that of x. A last step of Newton's method in x removes it.
  const double x = std::clamp(std::exp(root), lower, upper);
  const ContactState s = state(x);
  return std::clamp(x + (force - s.force) / s.force_by_approach, lower, upper);
}

/// The x at which a regime bears a force, from a close guess and without evaluating the bounds; none if it is not near.
template <class State>
[[nodiscard]] std::optional<double> approach_near(const State& state, double lower, double upper, double force,
                                                  double guess) {
  if (!(guess > 0.0)) return std::nullopt;
  // A guess across a bound is as good as the bound: an event there is located from both sides.
  double x = std::clamp(guess, lower, upper);
  double last = 1.0;
  for (int iteration = 0; x > 0.0 && iteration < 6; ++iteration) {
    const ContactState s = state(x);
    if (!(s.force > 0.0 && s.force_by_approach > 0.0)) return std::nullopt;
    // Newton's method on the logarithms: the next step is about this one squared, times the ratio of this to the last
    // squared.
    const double step = std::log(force / s.force) * s.force / (x * s.force_by_approach);
    if (!(std::abs(step) < 2.0)) return std::nullopt;
    x = std::clamp(x * std::exp(step), lower, upper);
    const double quadratic = std::max(1.0, std::abs(step) / (last * last));
    if (quadratic * step * step < k_epsilon) return x;
    last = std::abs(step);
  }
  return std::nullopt;
}

/// The x between first touch and an upper bound at which a regime bears a force.
template <class State>
[[nodiscard]] double approach_from_touch(const State& state, double upper, double force, double guess) {
  double lower = std::min(guess, upper);
  while (lower > 0.0 && state(lower).force >= force) lower *= 0.5;
  // The force is so small that its x, or the square of its contact radius, underflows.
  if (!(lower > 0.0)) return std::min(guess, upper);
  return approach_between(state, lower, upper, force, guess);
}

/// int P dx from a to b below the point s >= b of a logarithmic singularity of the pressure.
template <class Force>
[[nodiscard]] double work_below_singularity(const Force& force, double a, double b, double s) {
  // In t = (s - x)^(1/6) the integrand behaves as t^5 ln t.
  const auto root = [](double distance) { return std::sqrt(std::cbrt(distance)); };
  const auto integrand = [&](double t) {
    const double t2 = t * t;
    return force(std::clamp(s - t2 * t2 * t2, a, b)) * 6.0 * t2 * t2 * t;
  };
  return boost::math::quadrature::gauss<double, 30>::integrate(integrand, root(s - b), root(s - a));
}

/// Work of one wall over S R^3 from first touch to x, for laws that know the work of all moving walls.
/// @throws std::domain_error as work() of the law
template <class Law>
[[nodiscard]] double work_per_wall(const Law& law, double x) {
  return work(law, x) / moving_walls(law.configuration);
}

/// @throws std::domain_error unless x is below the limit; also for NaN
void require_approach_below(double x, double limit, Limit reason);

/// @param exponent  mu = 1/m of a power law
/// @throws std::invalid_argument unless it is in [0, 1]
void require_exponent(double exponent);

}  // namespace monograin::plastic
