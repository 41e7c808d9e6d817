/// Elastic law of a material point under its boundary conditions.
///
/// The law is linear for given moduli, so that strains and stresses follow from the plastic strains in closed form:
/// p = K (e_v - e_v^p), s = 3G (g - g^p). Tension is positive; stresses are in yield pressures.
/// Source: Edmans and Sinka (n.d.), section 2, with total moduli.
#pragma once

#include <cmath>

#include "material-point/boundary_conditions.hpp"
#include "material-point/properties.hpp"

namespace monograin::material_point {

/// Plastic strains, or a direction or a step in them.
struct PlasticStrains {
  double phi = 0.0;         ///< state variable of the material
  double deviatoric = 0.0;  ///< g^p, 2/3 of axial minus lateral

  [[nodiscard]] double length() const noexcept { return std::hypot(phi, deviatoric); }
};

/// Change, or rate, of mean stress p and signed deviatoric stress s.
struct StressChange {
  double p = 0.0;
  double s = 0.0;

  [[nodiscard]] bool is_zero() const noexcept { return p == 0.0 && s == 0.0; }
};

/// Material, stress and strain at an instant.
struct Response {
  Properties at;
  double p = 0.0;
  double s = 0.0;
  double axial_strain = 0.0;
  double lateral_strain = 0.0;
};

/// Stress and strain that belong to given plastic strains. Prescribed stresses determine strains that are not
/// prescribed.
/// @throws DomainError where Poisson's ratio is not below 1/2
[[nodiscard]] Response elastic_response(const Parameters& parameters, const BoundaryConditions& conditions, double xi,
                                        const PlasticStrains& plastic);

/// Change of stress for a change of the prescribed quantities.
/// @param stiff  further change, which the moduli and the plastic strains would cause at fixed strains
[[nodiscard]] StressChange stress_change(const Properties& at, const BoundaryConditions& conditions, StressChange stiff,
                                         double axial, double lateral);

/// Rate of stress per step of the program, without plastic flow.
[[nodiscard]] StressChange elastic_rate(const Properties& at, const BoundaryConditions& conditions);

/// Stress of a channel; a prescribed one without the round-off of p and s.
[[nodiscard]] double stress_of(Channel channel, const BoundaryConditions& conditions, double xi, const Response& now);

/// Largest modulus over the yield pressure: the reciprocal of the elastic strains.
[[nodiscard]] double stiffness_over_strength(const Properties& at) noexcept;

}  // namespace monograin::material_point
