/// Semi-mechanistic law of an elastic-ideally plastic sphere between rigid flat walls, from first touch to a particle
/// that fills its cell. Conventions: plastic/compression.hpp; the strength S is the yield stress.
///
/// Between x_y < x_Hmax < x_Hmin < x_zp the mean pressure follows five laws that join with their slopes; simple
/// compression has the first three only. The contact radius is one series throughout. In the elastic regime the
/// pressure is Hertz's but the contact radius is not, so the force is D1^2 times Hertz's: 1.35 to 3.07 times in simple
/// compression, 1.42 to 3.22 in a die, 1.58 to 3.59 under hydrostatic compression, over all E/((1-nu^2) Y) of the law.
/// Source, unless said otherwise: Shahin (2021), chapter 2.
#pragma once

#include <vector>

#include "plastic/compression.hpp"

namespace monograin::semimech {

using plastic::Boundaries;
using plastic::Boundary;
using plastic::Configuration;
using plastic::ContactState;
using plastic::PressureFall;
using plastic::RadiusSeries;
using plastic::Regime;
using plastic::ValueAndSlope;

/// The two ratios of a material on which the law depends.
struct Material {
  double modulus_over_yield = 0.0;  ///< lambda = E/((1-nu^2) Y)
  double bulk_over_yield = 0.0;     ///< zeta = E/(3 (1-2nu) Y); infinity for nu = 0.5
};

/// @throws std::invalid_argument unless E > 0 and Y > 0, both finite, and nu in (-1, 0.5]
[[nodiscard]] Material make_material(double youngs_modulus, double poisson_ratio, double yield_stress);

/// Least lambda at which the elastic-plastic branch can end with the slope zero (c2 = 1); printed as 22.08.
constexpr double k_least_modulus_over_yield = 22.093089842902306;

/// A quantity outside the range over which the source fitted its constants.
struct OutOfRange {
  std::string_view quantity;
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

/// True for a ratio inside a fitted range, or outside of it by round-off of the products it is made of.
[[nodiscard]] bool is_in_fitted_range(double value, double lower, double upper) noexcept;

/// Range of lambda over which the source fitted the law.
constexpr double k_least_fitted_modulus_over_yield = 117.24;
constexpr double k_greatest_fitted_modulus_over_yield = 5933.40;

/// Ratios of a material that are outside the source's calculations: lambda in 117.24..5933.40 and, where the particle
/// is enclosed, E/Y in 100..5000, nu in 0.2..0.48 and zeta in 64..28000 (ranges of Tables 2.1 and A.1). A ratio at an
/// end of its range is inside, whatever the round-off of its digits.
[[nodiscard]] std::vector<OutOfRange> outside_calibration(double youngs_modulus, double poisson_ratio,
                                                          double yield_stress, Configuration configuration);

/// Constants of the low-compressibility and elastic-volumetric regimes (eqs. 2.41-2.47).
struct Stiffening {
  double cell_at_least = 0.0;        ///< chi_m, cell over particle volume at x_Hmin
  double softness = 0.0;             ///< l = 0.2335 zeta/(1 + 0.2335 zeta)
  double softness_complement = 0.0;  ///< 1 - l
  double pressure_scale = 0.0;       ///< u
  double elastic_volume = 0.0;       ///< v, elastic loss of volume at zero porosity
  double cell_at_zero_porosity = 0;  ///< chi_zp = 1 - v
  double zero_porosity = 0.0;        ///< x_zp, above the filled cell's x by the elastic loss of volume
};

/// A material's derived parameters in one configuration.
struct Law {
  Configuration configuration = Configuration::simple;
  Material material{};
  RadiusSeries radius{};             ///< D_i (eq. 2.14)
  double yield_approach = 0.0;       ///< x_y (eq. 2.17), where H = 1.1
  double yield_logarithm = 0.0;      ///< ln(x_Hmax/x_y)
  double logarithm_amplitude = 0.0;  ///< c1 (eq. 2.23)
  double logarithm_exponent = 0.0;   ///< c2 (eq. 2.22), >= 1
  PressureFall fall{};               ///< x_Hmax = fall.start, x_Hmin = fall.end
  Stiffening stiffening{};           ///< zeros in simple compression
  double calibrated_end = 0.0;       ///< x up to which the source compares the law: 0.5 (simple), x_zp + 0.01
  boost::container::static_vector<double, 4> boundary_forces{};  ///< P/(Y R^2) at each of boundaries()
  static constexpr double limit = 1.0;                           ///< x at which the walls meet; the law ends before
  static constexpr Regime first_regime = Regime::elastic;

  /// Power of x with which the force begins.
  [[nodiscard]] static constexpr double first_power() noexcept { return 1.5; }
  /// True where work is a quadrature of 30 forces; of polynomials it is not.
  [[nodiscard]] static constexpr bool is_work_costly(Regime regime) noexcept {
    return regime != Regime::elastic && regime != Regime::elastic_volumetric;
  }
};

/// @throws std::invalid_argument naming the numbers for lambda below its least value, and for zeta that is not finite
/// or so small that the particle would not fill its cell before x = 1 (die, hydrostatic)
[[nodiscard]] Law make_law(const Material& material, Configuration configuration);

/// Regime boundaries in ascending order: `yield`, `fully-plastic`, and for enclosed particles `low-compressibility`,
/// `zero-porosity`. The last regime goes on to the limit.
[[nodiscard]] Boundaries boundaries(const Law& law);

/// Regime at x. A boundary belongs to the regime before it; x <= 0 is open.
[[nodiscard]] Regime regime_at(const Law& law, double x) noexcept;

/// State of a contact at x.
/// @throws std::domain_error for x >= 1 and NaN
[[nodiscard]] ContactState state_at(const Law& law, double x);

/// State of a contact by the formulas of one regime, also somewhat outside of it, for trial steps. The formulas are
/// continued analytically. Those with an infinite second derivative at x_Hmax continue as their mirror image, and low
/// compressibility along its tangent a little beyond zero porosity.
/// @throws std::domain_error for x <= 0 (but open), a regime that the configuration does not have, and low
/// compressibility farther beyond zero porosity
[[nodiscard]] ContactState state_in(const Law& law, Regime regime, double x);

/// x under a force over Y R^2; 0 for no force.
/// @param near  initial guess of x; 0: none is known
/// @throws std::domain_error for forces that the law does not reach below its limit
[[nodiscard]] double approach_under(const Law& law, double force, double near = 0.0);

/// Work of one wall over Y R^3 from the beginning of a regime to x: int P dx. Relative error of the sum below 1e-12.
/// @throws std::domain_error as state_in
[[nodiscard]] double work_in(const Law& law, Regime regime, double x);

/// Work of all moving walls over Y R^3 from first touch to x: n int_0^x P dx over their number n.
/// Relative error below 1e-12.
/// @throws std::domain_error as state_at
[[nodiscard]] double work(const Law& law, double x);

}  // namespace monograin::semimech
