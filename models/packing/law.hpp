/// Compaction of a packing of soft discs: stress against packing fraction, from jamming to no pores left.
///
/// Stress and strain are positive in compression. The strain is that of the packing since it jammed, ln(h_c/h), for
/// which sigma_e = M_eff e. Stresses and moduli in Pa.
///
///   M_eff    modulus of the packing: eq. 7 with the porosity laws of eqs. 8, 9
///   m        M_eff/(c1 K Z Phi), strain of the particles over that of the packing
///   sigma_e  M_eff (ln Phi + c2)/(1 + s m), eq. 6; s = +1: published coupling, s = -1: consistent coupling
///   sigma    (1 - f_p) sigma_e + f_p sigma_p, eq. 10; the elastic and the plastic packing have one set of exponents,
///            so that sigma_p = sigma_y + sigma_e H/(E + H) exactly, without any 0/0 for H = 0
///
/// Equations are those of Nezamabadi et al. (2022); 6, 13 and 22 corrected in sign (as printed they are negative where
/// the packing is compressed).
#pragma once

#include <optional>

namespace monograin::packing {

enum class Coupling {
  published,  ///< eq. 6 as printed, to which the published parameters were fitted
  consistent  ///< eqs. 18-20 with one sign convention: the particles' shrinking adds to the packing's strain
};

/// Bilinear von Mises plasticity of the particles.
struct Plasticity {
  double yield_stress = 0.0;       ///< sigma_y [Pa], > 0
  double hardening_modulus = 0.0;  ///< H = d sigma_y/d eps_p [Pa], >= 0
};

/// Parameters of the law; the defaults are the published values.
struct Parameters {
  double youngs_modulus = 10e6;          ///< E [Pa], > 0
  double poisson_ratio = 0.45;           ///< nu, in (-1, 0.5)
  std::optional<Plasticity> plasticity;  ///< none: the particles stay elastic
  double stretch_exponent = 1.2;         ///< f_E, >= f_G
  double shear_exponent = 0.2;           ///< f_G, > 0
  double critical_porosity = 0.201;      ///< p_c, in (0, 1)
  double coupling_factor = 1.0;          ///< c1, > 0
  double strain_offset = 0.23;           ///< c2, > 0
  double plastic_growth = 2.5;           ///< alpha, > 0
  double jamming_fraction = 0.8;         ///< Phi_c, in (0, 1)
  double coordination_at_jamming = 4.0;  ///< Z_c, > 0; not given by the source: isostatic frictionless discs
  double coordination_at_reference = 6;  ///< Z_1, >= Z_c; not given by the source
  double reference_fraction = 1.0;       ///< Phi_1, in (Phi_c, 1]; not given by the source
  Coupling coupling = Coupling::published;
  /// Puts p_c = 1 - Phi_c and c2 = -ln Phi_c, so that modulus and stress begin at zero where the packing jams.
  bool has_continuous_jamming = false;
};

/// The law: its parameters, and the constants that follow from them.
struct Law {
  Parameters given;
  double shear_modulus = 0.0;   ///< G [Pa]
  double bulk_modulus = 0.0;    ///< K = lambda + G [Pa], of plane strain
  double modulus_at_one = 0.0;  ///< M = lambda + 2 G [Pa]: M_eff at Phi = 1
  double rigidity = 0.0;        ///< Phi at which M_eff is zero, 1 - p_c
  double zero_stress = 0.0;     ///< Phi at which eq. 6 is zero, exp(-c2)
  double sign = 1.0;            ///< s
  double hardening_share = 0;   ///< h = H/(E + H); 1 for an elastic packing
  /// Phi_J, from which on the packing bears stress: the largest of Phi_c, 1 - p_c and exp(-c2). With the published
  /// values these three differ.
  double jamming = 0.0;
  /// Largest Phi that has a state: 1, or the Phi where M_eff = c1 K Z Phi and the consistent coupling divides by zero,
  /// which may be Phi_J itself.
  double end = 1.0;
};

/// @throws std::invalid_argument naming the parameter that is out of its range; or if Phi_J is within 1e-5 of 1
[[nodiscard]] Law make_law(const Parameters& parameters);

/// Z(Phi), eq. 17. @throws std::domain_error below Phi_c
[[nodiscard]] double coordination_number(const Law& law, double packing_fraction);

/// Pieces of eq. 11, which clips f_p at 1. Each piece by itself continues smoothly beyond the point where they meet.
enum class Piece { either, growing, full };

/// f_p(Phi), eq. 11, between 0 and 1; 0 for an elastic packing.
[[nodiscard]] double plastic_fraction(const Law& law, double packing_fraction, Piece piece = Piece::either) noexcept;

/// Phi at which f_p reaches 1; may lie beyond 1, or below Phi_J. Infinite for an elastic packing.
[[nodiscard]] double full_plasticity(const Law& law) noexcept;

/// State of a jammed packing by the closed form.
struct State {
  double modulus = 0.0;          ///< M_eff [Pa]
  double strain = 0.0;           ///< e = sigma_e/M_eff (eq. 5), its limit where both are zero
  double particle_strain = 0.0;  ///< v = m e
  double stress_elastic = 0.0;   ///< sigma_e [Pa]
  double stress = 0.0;           ///< sigma [Pa]
};

/// State of a jammed packing by the closed form.
/// @param packing_fraction  Phi >= Phi_J; may be a little above 1
/// @throws std::domain_error below Phi_J, and where a denominator of eqs. 6 or 7 vanishes
[[nodiscard]] State state(const Law& law, double packing_fraction);

/// ln Phi + c2, the strain of packing and particles together: e + s v with the particles' v = m e.
[[nodiscard]] double total_strain(const Law& law, double packing_fraction) noexcept;

/// M_eff(Phi) (eq. 7) [Pa]. @throws std::domain_error above the critical porosity, and where eq. 7 has no denominator
[[nodiscard]] double effective_modulus(const Law& law, double packing_fraction);

/// sigma for a given sigma_e (eq. 10) [Pa].
[[nodiscard]] double total_stress(const Law& law, double packing_fraction, double stress_elastic,
                                  Piece piece = Piece::either) noexcept;

/// sigma_e for a given sigma [Pa].
[[nodiscard]] double stress_elastic_at(const Law& law, double packing_fraction, double stress) noexcept;

/// d sigma/d sigma_e at a given packing fraction.
[[nodiscard]] double total_stress_slope(const Law& law, double packing_fraction, Piece piece = Piece::either) noexcept;

/// Derivatives with respect to Phi of a jammed packing.
struct Slopes {
  double strain = 0.0;
  double particle_strain = 0.0;     ///< v' = s (1/Phi - e'), in a form without cancellation
  double stress_elastic = 0.0;      ///< [Pa]
  double stress = 0.0;              ///< [Pa]; beyond full plasticity the one-sided value
  double at_given_particles = 0.0;  ///< of the stress, with the particles' strain v held constant [Pa]
};

/// Derivatives of the solution of eq. 21 that has the strain e = sigma_e/M at Phi. In terms of e, and with the sign of
/// the coupling, the equation reads
///   (1 + s m) e' = 1/Phi - s m (M'/M - Z'/Z - 1/Phi) e
/// Solutions for e converge as m grows. Solutions for sigma_e diverge with M, which may grow by many orders from
/// jamming on. Infinite at Phi_c, and where M_eff begins.
/// @throws std::domain_error as state()
[[nodiscard]] Slopes slopes(const Law& law, double packing_fraction, double strain, Piece piece = Piece::either);

/// Quantity that may be prescribed instead of Phi.
enum class Measure { strain, stress_elastic, stress };

[[nodiscard]] double measured(const Law& law, Measure measure, double packing_fraction);

/// First interval of packing fractions from jamming on over which a measure grows. Neither strain nor stress need grow
/// up to Phi = 1: the modulus may grow faster than the stress, and the plastic fraction faster than both.
struct Branch {
  Measure measure = Measure::strain;
  double begin = 0.0;     ///< Phi; above Phi_J where the measure falls at first (consistent coupling)
  double end = 1.0;       ///< Phi
  double least = 0.0;     ///< measure at the beginning
  double greatest = 0.0;  ///< measure at the end
};

[[nodiscard]] Branch growing_branch(const Law& law, Measure measure);

/// Phi above which the plastic packing bears less stress than the elastic one: sigma_e = sigma_y (1 + H/E). Just above
/// jamming the plastic packing bears more. Infinite if it never bears less.
[[nodiscard]] double softening(const Law& law);

/// Phi on a branch at which the measure has this value, to round-off.
/// @throws std::domain_error where the value is not on the branch
[[nodiscard]] double packing_fraction_at(const Law& law, const Branch& branch, double value);

}  // namespace monograin::packing
