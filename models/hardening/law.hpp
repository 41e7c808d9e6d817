/// Semi-mechanistic law of a rigid-plastic sphere that hardens by a power law, sigma = kappa epsilon^mu, between rigid
/// flat walls. Conventions: plastic/compression.hpp; the strength S is kappa.
///
/// The contact is fully plastic from first touch; an enclosed particle stiffens from x_Hmin on until it fills its cell
/// at x_zp, where the pressure is infinite (it is incompressible). Source, unless said otherwise:
/// Shahin (2021), chapter 3.
#pragma once

#include "plastic/compression.hpp"

namespace monograin::hardening {

using plastic::Boundaries;
using plastic::Configuration;
using plastic::ContactState;
using plastic::PressureFall;
using plastic::RadiusSeries;
using plastic::Regime;

/// Contact radius in the condition for the least pressure: the current one, or that without hardening. The source does
/// not say which; with `ideal`, the pressure at x = 0.475 in the die would rise again with mu from 0.675 on.
enum class MinimumCondition { current, ideal };

/// Derived parameters for one exponent in one configuration.
struct Law {
  Configuration configuration = Configuration::simple;
  double exponent = 0.0;        ///< mu = 1/m, in [0, 1]
  RadiusSeries radius{};        ///< d_i (eq. 3.47)
  PressureFall fall{};          ///< of H/x^(mu/2); starts at 0, x_Hmin = fall.end
  double cell_at_least = 0.0;   ///< chi_m, cell over particle volume at x_Hmin; 0 in simple compression
  double pressure_scale = 0.0;  ///< u (eq. 3.58); 0 in simple compression
  double zero_porosity = 0.0;   ///< x_zp, of the filled cell; 0 in simple compression
  double calibrated_end = 0.0;  ///< x up to which the source compares the law: 0.5 (simple), else x_zp
  double limit = 0.0;           ///< x at which the law ends: 1 (simple), else x_zp
  double force_at_least = 0.0;  ///< P/(kappa R^2) at x_Hmin; in simple compression just below the limit
  static constexpr Regime first_regime = Regime::fully_plastic;

  /// Power of x with which the force begins.
  [[nodiscard]] double first_power() const noexcept { return 1.0 + 0.5 * exponent; }
  [[nodiscard]] static constexpr bool is_work_costly(Regime /*regime*/) noexcept { return true; }
};

/// @param exponent  mu = 1/m
/// @throws std::invalid_argument unless mu is in [0, 1]
[[nodiscard]] Law make_law(double exponent, Configuration configuration,
                           MinimumCondition condition = MinimumCondition::current);

/// Distance from zero porosity, relative to it, at which a run stops: beyond it the pressure grows without bound.
constexpr double k_zero_porosity_margin = 1e-9;

/// Regime boundaries in ascending order. Enclosed particles have `low-compressibility`, and `zero-porosity` at the
/// margin before it, where the law ends. Simple compression has none.
[[nodiscard]] Boundaries boundaries(const Law& law);

/// Regime at x. A boundary belongs to the regime before it; x <= 0 is open.
[[nodiscard]] Regime regime_at(const Law& law, double x) noexcept;

/// State of a contact at x.
/// @throws std::domain_error for x at the limit or above, and NaN
[[nodiscard]] ContactState state_at(const Law& law, double x);

/// State of a contact by the formulas of one regime, also outside of it, for trial steps.
/// @throws std::domain_error for x <= 0 (but open), a regime that the law or the configuration does not have, and low
/// compressibility at zero porosity or beyond
[[nodiscard]] ContactState state_in(const Law& law, Regime regime, double x);

/// x under a force over kappa R^2; 0 for no force.
/// @param near  initial guess of x; 0: none is known
/// @throws std::domain_error for forces that the law does not reach below its limit
[[nodiscard]] double approach_under(const Law& law, double force, double near = 0.0);

/// Work of one wall over kappa R^3 from the beginning of a regime to x: int P dx.
/// @throws std::domain_error as state_in
[[nodiscard]] double work_in(const Law& law, Regime regime, double x);

/// Work of all moving walls over kappa R^3 from first touch to x: n int_0^x P dx over their number n.
/// Relative error below 1e-12.
/// @throws std::domain_error as state_at
[[nodiscard]] double work(const Law& law, double x);

}  // namespace monograin::hardening
