/// Lateral contacts of the die. They bear a load of their own but do not act back on the moving walls, and do no work.
/// Source: Shahin (2021), section 2.6.
#pragma once

#include "semimech/law.hpp"

namespace monograin::semimech {

/// Constants of the lateral contacts. Their displacement x_s = tau x^omega was fitted with both displacements in
/// millimetres for R = 10 mm (eqs. 2.49-2.51); tau is made dimensionless here.
struct LateralLaw {
  double log_coefficient = 0.0;                   ///< ln tau
  double exponent = 0.0;                          ///< omega
  double yield_approach = 0.0;                    ///< x at which a lateral contact yields
  double onset = 0.0;                             ///< x from which all contacts bear the same pressure
  static constexpr double small_range_end = 0.1;  ///< x up to which x_s is fitted
};

/// Range of lambda over which the lateral contacts were fitted.
constexpr double k_least_lateral_modulus_over_yield = 163.08;
constexpr double k_greatest_lateral_modulus_over_yield = 4954.40;

/// @throws std::invalid_argument unless the law is that of the die
[[nodiscard]] LateralLaw make_lateral(const Law& law);

/// x at which all contacts begin to bear the same pressure. For its own five materials, Table 2.4, which comes from
/// computed contact areas. For other materials, 0.409833 + 4.03e-4 (lambda/1000)^(-1.4956), with lambda limited to the
/// table's range; this formula meets the table within 8.3e-5.
[[nodiscard]] double lateral_onset(double modulus_over_yield) noexcept;

/// x_s and dx_s/dx, for x > 0.
[[nodiscard]] ValueAndSlope lateral_approach(const LateralLaw& lateral, double x) noexcept;

/// Ends of a lateral contact's regimes, in terms of the primary x: `yield`, the end of the small range and zero
/// porosity (no events of the lateral contact: empty names), and `secondary-onset`. `undefined` between the two ranges.
[[nodiscard]] Boundaries boundaries(const Law& law, const LateralLaw& lateral);

/// State of a lateral contact by the formulas of one regime, with derivatives with respect to the primary x > 0.
/// `elastic` and `elastic_plastic`: that of a primary contact at x_s. `low_compressibility` and `elastic_volumetric`:
/// the pressure of the primary contacts, everything else NaN. `undefined`: NaN.
/// @throws std::domain_error as state_in
[[nodiscard]] ContactState lateral_state_in(const Law& law, const LateralLaw& lateral, Regime regime, double x);

}  // namespace monograin::semimech
