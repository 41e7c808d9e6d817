#include "material-point/plastic_flow.hpp"

#include <cmath>

#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::material_point {
namespace {

/// Derivative of the plastic strains by the multiplier.
PlasticStrains flow_direction(const Phase& phase, const Yield& yield) noexcept {
  return {is_compressible(phase.parameters.model) ? -yield.Psi_p : std::abs(yield.Psi_s), yield.Psi_s};
}

}  // namespace

double PlasticFlow::cosine() const noexcept {
  const double length = std::hypot(yield.f_p, yield.f_s) * std::hypot(elastic.p, elastic.s);
  return length > 0.0 ? loading / length : 0.0;
}

void PlasticFlow::require_unique() const {
  if (!(stiffness > 0.0)) {
    throw DomainError({Limit::loss_of_uniqueness, -1, "stiffness along the flow", stiffness});
  }
}

PlasticFlow plastic_flow(const Phase& phase, const Response& now) {
  return plastic_flow(phase, now, yield_on(phase.parameters, now.at, phase.branch, now.p, now.s));
}

PlasticFlow plastic_flow(const Phase& phase, const Response& now, const Yield& yield) {
  const Properties& at = now.at;
  PlasticFlow flow;
  flow.yield = yield;
  const Yield& y = flow.yield;
  const bool compressible = is_compressible(phase.parameters.model);
  flow.direction = flow_direction(phase, y);
  flow.elastic = elastic_rate(at, phase.conditions);
  flow.loading = y.f_p * flow.elastic.p + y.f_s * flow.elastic.s;
  // At fixed strains, densification reduces the elastic strain and stiffens the rest.
  const double bulk = at.bulk_modulus.value;
  const double shear = at.shear_modulus.value;
  const StressChange by_phi = stress_change(
      at, phase.conditions,
      {(compressible ? bulk : 0.0) + now.p * at.bulk_modulus.slope / bulk, now.s * at.shear_modulus.slope / shear}, 0.0,
      0.0);
  const StressChange by_deviatoric = stress_change(at, phase.conditions, {0.0, -3.0 * shear}, 0.0, 0.0);
  flow.gradient = {y.f_phi + y.f_p * by_phi.p + y.f_s * by_phi.s, y.f_p * by_deviatoric.p + y.f_s * by_deviatoric.s};
  flow.stiffness = -(flow.gradient.phi * flow.direction.phi + flow.gradient.deviatoric * flow.direction.deviatoric);
  flow.p_by_flow = by_phi.p * flow.direction.phi + by_deviatoric.p * flow.direction.deviatoric;
  return flow;
}

FlowEnergy flow_energy(const Phase& phase, const Response& now, const Yield& yield) noexcept {
  const PlasticStrains direction = flow_direction(phase, yield);
  const double volumetric = is_compressible(phase.parameters.model) ? -direction.phi : 0.0;
  const double unit = now.at.shear_strength.value * std::hypot(volumetric, direction.deviatoric);
  return {(now.p * volumetric + now.s * direction.deviatoric) / unit,
          dissipation(now.at, now.p, now.s, volumetric, direction.deviatoric, direction.phi) / unit};
}

bool continues(const Phase& phase, const Response& now) {
  const PlasticFlow flow = plastic_flow(phase, now);
  if (flow.elastic.is_zero()) return true;
  const double direction = flow.cosine();
  if (std::abs(direction) > k_same_value) return direction > 0.0;
  const auto out = way_out(phase.parameters, now.at, now.p, now.s, flow.elastic.p, flow.elastic.s);
  return out && out->t <= k_same_instant;
}

}  // namespace monograin::material_point
