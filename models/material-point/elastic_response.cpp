#include "material-point/elastic_response.hpp"

#include <algorithm>

#include "system/limit.hpp"

namespace monograin::material_point {

Response elastic_response(const Parameters& parameters, const BoundaryConditions& conditions, double xi,
                          const PlasticStrains& plastic) {
  Response now{.at = properties_at(parameters, plastic.phi)};
  if (!(now.at.poisson_ratio.value < 0.5)) {
    throw DomainError({Limit::poisson_half, -1, "Poisson's ratio", now.at.poisson_ratio.value});
  }
  const double bulk = now.at.bulk_modulus.value;
  const double shear = now.at.shear_modulus.value;
  const double swelling = is_compressible(parameters.model) ? -plastic.phi : 0.0;  // e_v^p
  const double flow = plastic.deviatoric;
  const double axial = conditions.value(Channel::axial, xi);
  const double lateral = conditions.value(Channel::lateral, xi);
  if (conditions.are_stresses()) {
    now.p = (axial + 2.0 * lateral) / 3.0;
    now.s = axial - lateral;
    const double volumetric = now.p / bulk + swelling;
    const double deviatoric = now.s / (3.0 * shear) + flow;
    now.axial_strain = volumetric / 3.0 + deviatoric;
    now.lateral_strain = volumetric / 3.0 - deviatoric / 2.0;
    return now;
  }
  if (conditions.is_stress(Channel::lateral)) {
    now.axial_strain = axial;
    now.lateral_strain = (lateral - (bulk - 2.0 * shear / 3.0) * axial + bulk * swelling - shear * flow) /
                         (2.0 * bulk + 2.0 * shear / 3.0);
  } else if (conditions.is_stress(Channel::axial)) {
    now.lateral_strain = lateral;
    now.axial_strain = (axial - (2.0 * bulk - 4.0 * shear / 3.0) * lateral + bulk * swelling + 2.0 * shear * flow) /
                       (bulk + 4.0 * shear / 3.0);
  } else {
    now.axial_strain = axial;
    now.lateral_strain = lateral;
  }
  now.s = 2.0 * shear * (now.axial_strain - now.lateral_strain) - 3.0 * shear * flow;
  // A prescribed stress determines p without its own round-off, which grows with the bulk modulus towards nu = 1/2.
  if (conditions.is_stress(Channel::lateral)) {
    now.p = lateral + now.s / 3.0;
  } else if (conditions.is_stress(Channel::axial)) {
    now.p = axial - 2.0 * now.s / 3.0;
  } else {
    now.p = bulk * (now.axial_strain + 2.0 * now.lateral_strain - swelling);
  }
  return now;
}

StressChange stress_change(const Properties& at, const BoundaryConditions& conditions, StressChange stiff, double axial,
                           double lateral) {
  if (conditions.are_stresses()) return {(axial + 2.0 * lateral) / 3.0, axial - lateral};
  const double bulk = at.bulk_modulus.value;
  const double shear = at.shear_modulus.value;
  if (conditions.is_stress(Channel::lateral)) {
    lateral =
        (lateral - stiff.p + stiff.s / 3.0 - (bulk - 2.0 * shear / 3.0) * axial) / (2.0 * bulk + 2.0 * shear / 3.0);
  } else if (conditions.is_stress(Channel::axial)) {
    axial = (axial - stiff.p - 2.0 * stiff.s / 3.0 - (2.0 * bulk - 4.0 * shear / 3.0) * lateral) /
            (bulk + 4.0 * shear / 3.0);
  }
  return {stiff.p + bulk * (axial + 2.0 * lateral), stiff.s + 2.0 * shear * (axial - lateral)};
}

StressChange elastic_rate(const Properties& at, const BoundaryConditions& conditions) {
  return stress_change(at, conditions, {}, conditions.rate(Channel::axial), conditions.rate(Channel::lateral));
}

double stress_of(Channel channel, const BoundaryConditions& conditions, double xi, const Response& now) {
  if (conditions.is_stress(channel)) return conditions.value(channel, xi);
  return channel == Channel::axial ? now.p + 2.0 * now.s / 3.0 : now.p - now.s / 3.0;
}

double stiffness_over_strength(const Properties& at) noexcept {
  return std::max(at.bulk_modulus.value, 3.0 * at.shear_modulus.value) / at.yield_pressure.value;
}

}  // namespace monograin::material_point
