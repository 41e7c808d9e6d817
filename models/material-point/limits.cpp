#include "material-point/limits.hpp"

#include <algorithm>
#include <cmath>

namespace monograin::material_point {
namespace {

// Least stiffness along the flow, over its usual size. Under prescribed strains the stiffness goes to zero like the
// root of the remaining path; under prescribed stresses, in proportion to it.
constexpr double k_least_stiffness = 1e-6;
// Largest rate of plastic strain over a step of the program. Towards a stress that only unbounded strain reaches, the
// strain grows like the logarithm of the remaining path, and the rate like its reciprocal; faster rates are round-off.
constexpr double k_fastest = 1e7;
// Distance of Poisson's ratio from 1/2, where the bulk modulus is infinite, at which a run ends.
constexpr double k_least_compressibility = 1e-6;
// Moduli over the yield pressure at which a run ends: round-off of strains is then a millionth of the strength.
constexpr double k_stiffest = 1e10;

double margin_of_uniqueness(const Phase& phase, const Response& now, const PlasticFlow& flow) {
  const Yield& y = flow.yield;
  if (phase.conditions.are_stresses()) {  // only hardening resists
    const double length = flow.direction.length();
    const double hardening = std::abs(y.f_phi) * length;
    if (!(hardening > 0.0)) return 0.0;
    const double share = flow.stiffness / hardening - k_least_stiffness;
    if (!(flow.loading > 0.0)) return share;
    return std::min(share, flow.stiffness / (flow.loading * length) - 1.0 / k_fastest);
  }
  const double bulk = is_compressible(phase.parameters.model) ? now.at.bulk_modulus.value : 0.0;
  const double elastic_stiffness = bulk * y.f_p * y.Psi_p + 3.0 * now.at.shear_modulus.value * y.f_s * y.Psi_s;
  return flow.stiffness / elastic_stiffness - k_least_stiffness;
}

}  // namespace

std::vector<Limit> limits_of(const Phase& phase) {
  const Parameters& parameters = phase.parameters;
  std::vector<Limit> list{Limit::loss_of_uniqueness};
  const bool is_frozen = parameters.model == YieldModel::vmdc && phase.branch.segment == Segment::shear;
  if (is_frozen) return list;
  if (parameters.xi1 != 0.0) list.push_back(Limit::poisson_half);
  if (parameters.xi != 0.0 || parameters.xi1 != 0.0) list.push_back(Limit::too_stiff);
  if (!is_compressible(parameters.model)) return list;
  list.push_back(Limit::pores_closed);
  list.push_back(Limit::cap_centre_at_zero_pressure);
  if (parameters.xi2 != 0.0) list.push_back(Limit::cap_axis_ratio_zero);
  return list;
}

LimitDistance distance_to(Limit limit, const Phase& phase, const Response& now) {
  const Properties& at = now.at;
  const double strength = at.yield_pressure.value;
  switch (limit) {
    case Limit::pores_closed:
      return {"density-limit", 1.0 - at.relative_density, "relative density", at.relative_density};
    case Limit::cap_centre_at_zero_pressure:
      return {"cap-centre-tensile", at.cap_centre.value / strength, "pi3 over the yield pressure",
              at.cap_centre.value / strength};
    case Limit::cap_axis_ratio_zero:
      return {"cap-axis-nonpositive", at.axis_ratio.value, "axis ratio", at.axis_ratio.value};
    case Limit::poisson_half:
      return {"poisson-half", 0.5 - at.poisson_ratio.value - k_least_compressibility, "Poisson's ratio",
              at.poisson_ratio.value};
    case Limit::too_stiff: {
      const double stiffness = stiffness_over_strength(at);
      return {"limit", 1.0 - stiffness / k_stiffest, "modulus over the yield pressure", stiffness};
    }
    default: {
      const PlasticFlow flow = plastic_flow(phase, now);
      return {"loss-of-uniqueness", margin_of_uniqueness(phase, now, flow), "stiffness along the flow", flow.stiffness};
    }
  }
}

DomainEnd domain_end(Limit limit, const Phase& phase, const Response& now) {
  const LimitDistance at = distance_to(limit, phase, now);
  return {{at.event}, {limit, -1, at.quantity, at.value}};
}

}  // namespace monograin::material_point
