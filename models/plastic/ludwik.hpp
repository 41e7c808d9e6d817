/// Ludwik's hardening law, and the power law (Hollomon) nearest to it.
///
///   Ludwik:    sigma = Y + K eps_pl^(1/n),  eps = eps_pl + sigma/E;  sigma = E eps below Y
///   Hollomon:  sigma = kappa eps^mu,  mu = 1/m
///
/// Source, unless said otherwise: Shahin (2021), eqs. 2.1-2.3 and 3.1-3.3.
#pragma once

namespace monograin::plastic {

struct LudwikMaterial {
  double youngs_modulus = 0.0;  ///< E > 0; infinity: rigid-plastic
  double yield_stress = 0.0;    ///< Y >= 0
  double hardening = 0.0;       ///< K >= 0
  double exponent_inverse = 1;  ///< n >= 1
};

/// Which parameters of the power law are fitted: both, or the exponent alone with kappa = Y + K (equal stresses at a
/// plastic strain of 1).
enum class HollomonFit { both, exponent };

struct HollomonMaterial {
  double strength = 0.0;  ///< kappa
  double exponent = 0.0;  ///< mu
  /// Root of the mean square of the difference of the two stresses over the strain range.
  double residual = 0.0;
};

/// Stress at a plastic strain >= 0.
[[nodiscard]] double ludwik_stress(const LudwikMaterial& material, double plastic_strain) noexcept;

/// The power law with the least int_0^greatest (sigma - kappa eps^mu)^2 d(eps) over the total strain. The source gives
/// such pairs without saying how it found them; for its lead (K = 15.5 MPa, n = 2.857, E = 10 GPa, with Y = 5 MPa) it
/// has 20.5 MPa and 1/4.167, which the exponent alone meets for ranges of about 1, and both for 1.4 to 1.7.
/// @param greatest_strain  > 0
/// @throws std::invalid_argument for a material or a range out of the bounds above
/// @throws std::domain_error where the best exponent is not in [0, 1]
[[nodiscard]] HollomonMaterial fit_hollomon(const LudwikMaterial& material, double greatest_strain, HollomonFit fit);

}  // namespace monograin::plastic
