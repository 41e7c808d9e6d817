/// Parameters of a compressible plastic material and how they change as it densifies.
///
/// Stresses are in units of the hydrostatic yield pressure at the reference density; signs are tension positive. The
/// state variable phi is minus the volumetric plastic strain (Drucker-Prager cap, von Mises double cap) or the
/// accumulated deviatoric plastic strain (von Mises).
/// Source: Edmans and Sinka (n.d.), sections 2 and 3.
#pragma once

namespace monograin::material_point {

enum class YieldModel {
  vm,   ///< von Mises
  dpc,  ///< Drucker-Prager cap
  vmdc  ///< von Mises double cap
};

/// General parameters of the source (eqs. 4, 5), at the reference density, and the relative density at the start.
struct Parameters {
  YieldModel model = YieldModel::vmdc;
  double stiffness_ratio = 100.0;  ///< Young's modulus, > 0
  double nu0 = 0.3;                ///< Poisson's ratio, > -1, < 1/2
  double shear_ratio = 1.0;        ///< Gamma0, greatest shear strength, > 0
  double tensile_ratio = 0.01;     ///< Lambda0, hydrostatic tensile strength, > 0
  double eps0 = 0.7;               ///< half-axis of the cap along p over that along q
  double eta = 0.0;                ///< growth of the yield pressure with relative density
  double xi = 0.0;                 ///< growth of Young's modulus
  double zeta = 0.0;               ///< growth of the shear strength
  double omega = 0.0;              ///< growth of the tensile strength
  double xi1 = 0.0;                ///< growth of Poisson's ratio, linear
  double xi2 = 0.0;                ///< growth of the cap's axis ratio, linear
  double reference_density = 0.7;  ///< relative density to which the values above belong, > 0
  double relative_density = 0.7;   ///< at the start, > 0, < 1; no effect in von Mises plasticity
  double transition_width = 0.0;   ///< pi8, size of the arc between shear line and cap (dpc only), >= 0
};

/// A quantity and its derivative by the state variable phi.
struct Evolving {
  double value = 0.0;
  double slope = 0.0;
};

/// The material at one state of densification.
struct Properties {
  double relative_density = 0.0;  ///< without load (eq. 3a); no meaning in von Mises plasticity
  Evolving youngs_modulus;
  Evolving poisson_ratio;
  Evolving bulk_modulus;
  Evolving shear_modulus;
  Evolving yield_pressure;    ///< sigma_y = pi4
  Evolving shear_strength;    ///< Gamma
  Evolving tensile_strength;  ///< Lambda
  Evolving axis_ratio;        ///< eps = pi7
  Evolving cap_centre;        ///< pi3: the cap's ellipse is centred on p = -pi3
};

/// Properties after the state variable has become phi (eqs. 3 to 5; Table 3 with eps = (pi4 - pi3)/pi2, corrected).
///
/// Total moduli: they multiply the whole elastic strain. Defined for every phi; callers have to check where an axis
/// ratio, a modulus or the cap's centre loses its meaning.
[[nodiscard]] Properties properties_at(const Parameters& parameters, double phi) noexcept;

/// True if plastic flow changes the volume, so that phi is minus the volumetric plastic strain.
[[nodiscard]] constexpr bool is_compressible(YieldModel model) noexcept { return model != YieldModel::vm; }

/// Elastic energy per volume, in units of the yield pressure: p^2/(2K) + s^2/(6G).
/// @param p  mean stress, tension positive
/// @param s  axial minus lateral stress
[[nodiscard]] double stored_energy(const Properties& properties, double p, double s) noexcept;

/// Dissipation per volume, over the same increment as the strains: p de_v + s dg minus the part that stiffening stores.
///
/// With total moduli part of the plastic work stays in the material as it stiffens: phi' (p^2 K'/(2 K^2) + s^2 G'/(6
/// G^2)).
/// @param volumetric  plastic volumetric strain increment
/// @param deviatoric  plastic deviatoric strain increment, 2/3 of axial minus lateral
/// @param phi         increment of the state variable
[[nodiscard]] double dissipation(const Properties& properties, double p, double s, double volumetric, double deviatoric,
                                 double phi) noexcept;

}  // namespace monograin::material_point
