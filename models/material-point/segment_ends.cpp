#include "material-point/segment_ends.hpp"

namespace monograin::material_point {
namespace {

// Distance from the end of a segment, over the yield pressure, within which a state is beyond that end if the program
// moves it there: f is quadratic in the distance.
constexpr double k_arrived = 1e-9;

bool is_isochoric_end(const Phase& phase, bool towards_compression) noexcept {
  const Segment segment = phase.branch.segment;
  if (phase.parameters.model == YieldModel::vmdc) return true;
  const Segment other = neighbour(phase.parameters, segment, towards_compression);
  return segment == Segment::cap || other == Segment::cap;
}

bool moves_pressure_to_end(const Phase& phase, const Response& now, bool towards_compression) {
  const double rate = pressure_rate_at_end(phase, now, towards_compression);
  return towards_compression ? rate < 0.0 : rate > 0.0;
}

}  // namespace

double pressure_rate_at_end(const Phase& phase, const Response& now, bool towards_compression) {
  const Parameters& parameters = phase.parameters;
  const BoundaryConditions& conditions = phase.conditions;
  const bool is_corner = parameters.model == YieldModel::dpc && phase.branch.segment == Segment::shear &&
                         neighbour(parameters, phase.branch.segment, towards_compression) == Segment::cap;
  const double tangent =
      is_corner ? phase.branch.side * cap_constants(parameters, now.at).friction_slope.value : 0.0;  // -ds/dp
  const double axial = conditions.rate(Channel::axial);
  const double lateral = conditions.rate(Channel::lateral);
  if (conditions.are_stresses()) return (axial + 2.0 * lateral) / 3.0;
  if (conditions.is_stress(Channel::lateral)) return lateral / (1.0 + tangent / 3.0);
  if (conditions.is_stress(Channel::axial)) return axial / (1.0 - 2.0 * tangent / 3.0);
  return now.at.bulk_modulus.value * (axial + 2.0 * lateral);
}

bool has_passable_end(const Phase& phase, const Response& now, bool towards_compression) {
  if (!distance_to_end(phase.parameters, now.at, phase.branch.segment, towards_compression, now.p)) return false;
  return !is_isochoric_end(phase, towards_compression) || moves_pressure_to_end(phase, now, towards_compression);
}

bool stands_at_passed_end(const Phase& phase, const Response& now, bool towards_compression) {
  const auto distance = distance_to_end(phase.parameters, now.at, phase.branch.segment, towards_compression, now.p);
  if (!distance || *distance > k_arrived * now.at.yield_pressure.value) return false;
  return is_isochoric_end(phase, towards_compression) && moves_pressure_to_end(phase, now, towards_compression);
}

bool leads_out(const Phase& phase, const Response& now, bool towards_compression) {
  if (is_isochoric_end(phase, towards_compression)) return true;
  const PlasticFlow flow = plastic_flow(phase, now);
  if (!(flow.stiffness > 0.0)) return true;
  const double multiplier = flow.loading / flow.stiffness;
  const double of_end = -cap_constants(phase.parameters, now.at).transition_start.slope * flow.direction.phi;
  const double away = flow.elastic.p + multiplier * (flow.p_by_flow - of_end);
  return towards_compression ? away < 0.0 : away > 0.0;
}

Branch branch_beyond(const Phase& phase, const Response& now, bool towards_compression) {
  return {neighbour(phase.parameters, phase.branch.segment, towards_compression), now.s > 0.0 ? 1.0 : -1.0};
}

double side_of(const Phase& phase, const Response& now) {
  if (phase.branch.side * now.s > 0.0) return phase.branch.side;
  const double rate = elastic_rate(now.at, phase.conditions).s;
  return rate > 0.0 ? 1.0 : rate < 0.0 ? -1.0 : 0.0;
}

bool may_pass_apex(const Phase& phase, const Response& now) {
  if (phase.parameters.model != YieldModel::dpc || phase.branch.segment != Segment::shear || now.s == 0.0) return false;
  return !phase.conditions.are_strains() || phase.branch.side * elastic_rate(now.at, phase.conditions).s < 0.0;
}

}  // namespace monograin::material_point
