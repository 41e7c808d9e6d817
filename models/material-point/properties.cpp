#include "material-point/properties.hpp"

#include <cmath>

namespace monograin::material_point {

Properties properties_at(const Parameters& m, double phi) noexcept {
  Properties at;
  // In von Mises plasticity the density stays and phi itself is the argument (section 2, below eq. 3).
  const bool densifies = is_compressible(m.model);
  // expm1 gives the growth: a difference of densities would lose digits of a small phi, which exponents multiply.
  const double growth = densifies ? m.relative_density * std::expm1(phi) : 0.0;
  at.relative_density = densifies ? m.relative_density * std::exp(phi) : m.relative_density;
  const double x = densifies ? (m.relative_density - m.reference_density) + growth : phi;
  const double dx = densifies ? at.relative_density : 1.0;
  const auto exponential = [&](double initial, double rate) {
    const double value = initial * std::exp(rate * x);
    return Evolving{value, rate * value * dx};
  };
  at.yield_pressure = exponential(1.0, m.eta);
  at.youngs_modulus = exponential(m.stiffness_ratio, m.xi);
  at.shear_strength = exponential(m.shear_ratio, densifies ? m.zeta : m.eta);
  at.tensile_strength = exponential(m.tensile_ratio, m.omega);
  at.poisson_ratio = {m.nu0 + m.xi1 * x, m.xi1 * dx};
  at.axis_ratio = {m.eps0 + m.xi2 * x, m.xi2 * dx};

  const double modulus = at.youngs_modulus.value;
  const double nu = at.poisson_ratio.value;
  const double bulk = modulus / (3.0 * (1.0 - 2.0 * nu));
  const double shear = modulus / (2.0 * (1.0 + nu));
  at.bulk_modulus = {bulk, bulk * (m.xi + 2.0 * m.xi1 / (1.0 - 2.0 * nu)) * dx};
  at.shear_modulus = {shear, shear * (m.xi - m.xi1 / (1.0 + nu)) * dx};

  const auto& [strength, strength_slope] = at.shear_strength;
  at.cap_centre = {at.yield_pressure.value - at.axis_ratio.value * strength,
                   at.yield_pressure.slope - at.axis_ratio.slope * strength - at.axis_ratio.value * strength_slope};
  return at;
}

double stored_energy(const Properties& properties, double p, double s) noexcept {
  return p * p / (2.0 * properties.bulk_modulus.value) + s * s / (6.0 * properties.shear_modulus.value);
}

double dissipation(const Properties& properties, double p, double s, double volumetric, double deviatoric,
                   double phi) noexcept {
  const auto& [bulk, bulk_slope] = properties.bulk_modulus;
  const auto& [shear, shear_slope] = properties.shear_modulus;
  const double coupling = p * p * bulk_slope / (2.0 * bulk * bulk) + s * s * shear_slope / (6.0 * shear * shear);
  return p * volumetric + s * deviatoric - phi * coupling;
}

}  // namespace monograin::material_point
