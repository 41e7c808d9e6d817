/// Similarity law of a rigid-plastic power-law contact (Biwa and Storakers), and its contact radius with the next term
/// of the spheres' curvature. Every contact is independent of the others and of the configuration.
///
/// Small strains only (no check here).
/// mu = 1/m in [0, 1] throughout; mu = 0 is ideal plasticity.
/// Source, unless said otherwise: Shahin (2021), section 2.2 and appendix B.
#pragma once

#include "plastic/compression.hpp"

namespace monograin::similarity {

using plastic::Boundaries;
using plastic::ContactState;
using plastic::Regime;

/// Relation of contact radius and approach: eq. 2.5, or eq. B.24, which keeps the fourth power of the profile and uses
/// the same constant c^2. The source gives the force with the first only; here a contact has the same force at the same
/// radius with both.
enum class RadiusRule { parabolic, corrected };

/// Two spheres in contact, or a sphere and a wall (radius infinity), in any unit of length.
struct Pair {
  double curvature = 0.0;        ///< 1/R1 + 1/R2 (eq. 2.7)
  double cubed_curvature = 0.0;  ///< 1/R1^3 + 1/R2^3
};

/// @throws std::invalid_argument unless both radii are positive, and one of them finite
[[nodiscard]] Pair pair_of(double first_radius, double second_radius);

/// Strength of two materials kappa_1, kappa_2 > 0 in contact (in eq. 2.8): (kappa_1^(-m) + kappa_2^(-m))^(-1/m); the
/// weaker one's for mu = 0, and against a rigid body (kappa infinity).
/// @throws std::invalid_argument for strengths that are not positive or both infinite, mu outside [0, 1]
[[nodiscard]] double pair_strength(double first, double second, double exponent);

/// Constants of one exponent.
struct Law {
  double exponent = 0.0;         ///< mu
  double area_constant = 0.0;    ///< c^2 = 1.43 exp(-0.97 mu)
  double pressure_constant = 0;  ///< k = 3 6^(-mu)
  RadiusRule radius = RadiusRule::parabolic;
  static constexpr double limit = 1.0;            ///< x at which the walls meet; the law ends before
  static constexpr double calibrated_end = 0.03;  ///< x up to which it follows the computed curves of the source
  static constexpr Regime first_regime = Regime::fully_plastic;

  /// Power of x with which the force begins.
  [[nodiscard]] double first_power() const noexcept { return 1.0 + 0.5 * exponent; }
  [[nodiscard]] static constexpr bool is_work_costly(Regime /*regime*/) noexcept { return false; }
};

/// @throws std::invalid_argument for mu outside [0, 1]
[[nodiscard]] Law make_law(double exponent, RadiusRule radius = RadiusRule::parabolic);

/// Contact of a pair. Units: the pair's length, the strength's stress.
struct PairContact {
  double contact_radius = 0.0;  ///< a
  double force = 0.0;           ///< P = pi k A^mu kappa a^(2+mu), A the curvature (eqs. 2.4, 2.8)
  double contact_radius_by_approach = 0.0;
  double force_by_approach = 0.0;
};

/// @param strength  of the pair, pair_strength
/// @param approach  gamma of the two centres; <= 0: no contact, gives zeros
[[nodiscard]] PairContact pair_contact(const Law& law, const Pair& pair, double strength, double approach) noexcept;

/// Approach of a pair under a force, in closed form; 0 for no force.
[[nodiscard]] double pair_approach(const Law& law, const Pair& pair, double strength, double force) noexcept;

/// Work int P d(gamma) of a pair, in closed form.
[[nodiscard]] double pair_work(const Law& law, const Pair& pair, double strength, double approach) noexcept;

// --- A sphere at a rigid flat wall as one half of a pair of equal spheres (plastic/compression.hpp), S = kappa of its
// material.

/// None: the only regime goes on to the limit.
[[nodiscard]] inline Boundaries boundaries(const Law& /*law*/) { return {}; }

/// State of a contact at a wall, in the only regime, fully_plastic; zeros for x <= 0.
[[nodiscard]] ContactState state_in(const Law& law, Regime regime, double x) noexcept;

/// State of a contact at a wall, for x below the limit.
/// @throws std::domain_error for x >= 1 and NaN
[[nodiscard]] ContactState state_at(const Law& law, double x);

/// x under a force over kappa R^2, in closed form, for which a guess is of no use.
/// @throws std::domain_error for forces that are not below that at x = 1
[[nodiscard]] double approach_under(const Law& law, double force, double near = 0.0);

/// Work of one wall over kappa R^3, int P dx.
/// @throws std::domain_error as state_at
[[nodiscard]] double work_per_wall(const Law& law, double x);
[[nodiscard]] inline double work_in(const Law& law, Regime /*regime*/, double x) { return work_per_wall(law, x); }

}  // namespace monograin::similarity
