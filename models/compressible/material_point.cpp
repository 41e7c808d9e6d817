#include "compressible/material_point.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

namespace monograin::compressible {
namespace {

using std::string_view;

// The path starts from zero in every plastic phase, but has no more digits than the strains that f is made of. That
// holds for phi, too, which in tension may start from zero beside large strains.
constexpr std::array k_unknowns{
    Unknown{.name = "phi", .scale = 0.1, .sum_scale = 1.0},
    Unknown{.name = "plastic_strain_deviatoric", .scale = 0.1, .sum_scale = 1.0},
    Unknown{"plastic_path", Unknown::Kind::quadrature, 1.0},
};
// Bounds of the error gain, of plastic strains over elastic ones, which determine the stress: its value in a usual
// material, and the value beyond which integrators would follow round-off.
constexpr double k_usual_gain = 10.0;
constexpr double k_most_gain = 1e3;

// Distance from the end of an elastic phase that counts as none (step coordinates).
constexpr double k_round_off = 1e-13;
// Cosine between the normal of the yield surface and the elastic rate of stress below which the two are perpendicular.
constexpr double k_neutral = 1e-12;
// Distance from the end of a segment, over the yield pressure, within which a state is beyond that end if the program
// moves it there: f is quadratic in the distance.
constexpr double k_arrived = 1e-9;
// Least stiffness along the flow, over its usual size. Under prescribed strains the stiffness goes to zero like the
// root of the remaining path; under prescribed stresses, in proportion to it.
constexpr double k_least_stiffness = 1e-6;
// Stiffness along the flow, over its usual size, below which integrators may fail: round-off of the stress is larger in
// the plastic strain by its reciprocal.
constexpr double k_hardly_unique = 1e-3;
// Largest rate of plastic strain over a step of the program. Towards a stress that only unbounded strain reaches, the
// strain grows like the logarithm of the remaining path, and the rate like its reciprocal; faster rates are round-off.
constexpr double k_fastest = 1e7;
// Distance of Poisson's ratio from 1/2, where the bulk modulus is infinite, at which a run ends.
constexpr double k_least_compressibility = 1e-6;
// Bulk modulus over the yield pressure from which on integrators may fail.
constexpr double k_stiff = 1e5;
// Moduli over the yield pressure at which a run ends: round-off of strains is then a millionth of the strength.
constexpr double k_stiffest = 1e10;
// Share of the strength below which a negative work of the flow is round-off.
constexpr double k_negligible_work = 1e-9;

enum Regime { elastic, plastic_tension, plastic_shear, plastic_transition, plastic_cap };
constexpr std::array<string_view, 5> k_regime_names{"elastic", "plastic-tension", "plastic-shear", "plastic-transition",
                                                    "plastic-cap"};

Regime regime_of(Segment segment) {
  switch (segment) {
    case Segment::tension:
      return plastic_tension;
    case Segment::shear:
      return plastic_shear;
    case Segment::transition:
      return plastic_transition;
    case Segment::cap:
      return plastic_cap;
  }
  return elastic;
}

}  // namespace

MaterialPoint::MaterialPoint(const Settings& settings) : settings_(settings) {
  for (const char* name : {"strain_axial", "strain_lateral"}) observables_.push_back({name, "-", {}});
  for (const char* name : {"p", "s", "q", "stress_axial", "stress_lateral"}) observables_.push_back({name, "Pa", {}});
  for (const char* name : {"relative_density", "plastic_strain_volumetric", "plastic_strain_deviatoric", "phi"}) {
    observables_.push_back({name, "-", {}});
  }
  observables_.push_back({"youngs_modulus", "Pa", {}});
  observables_.push_back({"yield_function", "-", {}});
  observables_.push_back({"regime", "", k_regime_names});
}

std::span<const Unknown> MaterialPoint::unknowns() const noexcept { return k_unknowns; }

/// Usual plastic strain over the elastic strain at yield, within bounds; a stiff material has smaller elastic strains.
double MaterialPoint::error_gain() const noexcept {
  const Properties at = properties_at(settings_.parameters, 0.0);
  const double elastic_strain = at.yield_pressure.value / (3.0 * at.shear_modulus.value);
  return std::clamp(k_unknowns[k_deviatoric].scale / elastic_strain, k_usual_gain, k_most_gain);
}

// The flow of von Mises keeps its direction (d(phi) = |d(g^p)|), and so does flow without deviator: along that line f =
// 0 is one equation.
bool MaterialPoint::is_solvable() const noexcept {
  return settings_.parameters.model == YieldModel::vm || settings_.is_hydrostatic;
}

void MaterialPoint::start(std::span<double> y) { std::ranges::fill(y, 0.0); }

// --- elastic response

bool MaterialPoint::is_stress(std::size_t channel) const noexcept { return ramps_[channel].control == Control::stress; }

double MaterialPoint::prescribed(std::size_t channel, double xi) const noexcept {
  return std::lerp(ramps_[channel].start, ramps_[channel].end, xi);
}

double MaterialPoint::prescribed_rate(std::size_t channel) const noexcept {
  return ramps_[channel].end - ramps_[channel].start;
}

/// Stress and strain: p = K (e_v - e_v^p), s = 3G (g - g^p). Prescribed stresses determine strains that are not
/// prescribed.
MaterialPoint::Response MaterialPoint::response(double xi, std::span<const double> y) const {
  Response now{.at = properties_at(settings_.parameters, y[k_phi])};
  if (!(now.at.poisson_ratio.value < 0.5)) {
    throw DomainError({Limit::poisson_half, -1, "Poisson's ratio", now.at.poisson_ratio.value});
  }
  const double bulk = now.at.bulk_modulus.value;
  const double shear = now.at.shear_modulus.value;
  const double swelling = is_compressible(settings_.parameters.model) ? -y[k_phi] : 0.0;  // e_v^p
  const double flow = y[k_deviatoric];
  const double axial = prescribed(k_axial, xi);
  const double lateral = prescribed(k_lateral, xi);
  if (is_stress(k_axial) && is_stress(k_lateral)) {
    now.p = (axial + 2.0 * lateral) / 3.0;
    now.s = axial - lateral;
    const double volumetric = now.p / bulk + swelling;
    const double deviatoric = now.s / (3.0 * shear) + flow;
    now.axial_strain = volumetric / 3.0 + deviatoric;
    now.lateral_strain = volumetric / 3.0 - deviatoric / 2.0;
    return now;
  }
  if (is_stress(k_lateral)) {
    now.axial_strain = axial;
    now.lateral_strain = (lateral - (bulk - 2.0 * shear / 3.0) * axial + bulk * swelling - shear * flow) /
                         (2.0 * bulk + 2.0 * shear / 3.0);
  } else if (is_stress(k_axial)) {
    now.lateral_strain = lateral;
    now.axial_strain = (axial - (2.0 * bulk - 4.0 * shear / 3.0) * lateral + bulk * swelling + 2.0 * shear * flow) /
                       (bulk + 4.0 * shear / 3.0);
  } else {
    now.axial_strain = axial;
    now.lateral_strain = lateral;
  }
  now.s = 2.0 * shear * (now.axial_strain - now.lateral_strain) - 3.0 * shear * flow;
  // A prescribed stress determines p without its own round-off, which grows with the bulk modulus towards nu = 1/2.
  if (is_stress(k_lateral)) {
    now.p = lateral + now.s / 3.0;
  } else if (is_stress(k_axial)) {
    now.p = axial - 2.0 * now.s / 3.0;
  } else {
    now.p = bulk * (now.axial_strain + 2.0 * now.lateral_strain - swelling);
  }
  return now;
}

/// Change of stress for a change of the prescribed quantities. `stiff` is a further change, which the moduli and the
/// plastic strains would cause at fixed strains.
MaterialPoint::Increment MaterialPoint::stress_change(const Properties& at, Increment stiff, double axial,
                                                      double lateral) const {
  if (is_stress(k_axial) && is_stress(k_lateral)) return {(axial + 2.0 * lateral) / 3.0, axial - lateral};
  const double bulk = at.bulk_modulus.value;
  const double shear = at.shear_modulus.value;
  if (is_stress(k_lateral)) {
    lateral =
        (lateral - stiff.p + stiff.s / 3.0 - (bulk - 2.0 * shear / 3.0) * axial) / (2.0 * bulk + 2.0 * shear / 3.0);
  } else if (is_stress(k_axial)) {
    axial = (axial - stiff.p - 2.0 * stiff.s / 3.0 - (2.0 * bulk - 4.0 * shear / 3.0) * lateral) /
            (bulk + 4.0 * shear / 3.0);
  }
  return {stiff.p + bulk * (axial + 2.0 * lateral), stiff.s + 2.0 * shear * (axial - lateral)};
}

double MaterialPoint::stiffness_over_strength(const Properties& at) noexcept {
  return std::max(at.bulk_modulus.value, 3.0 * at.shear_modulus.value) / at.yield_pressure.value;
}

MaterialPoint::Increment MaterialPoint::elastic_rate(const Properties& at) const {
  return stress_change(at, {}, prescribed_rate(k_axial), prescribed_rate(k_lateral));
}

// --- plastic flow

MaterialPoint::Flow MaterialPoint::flow(const Response& now) const {
  return flow(now, yield_on(settings_.parameters, now.at, branch_, now.p, now.s));
}

/// Consistency: N - D l' = 0 is the derivative of f = 0 (section 2, with total moduli).
MaterialPoint::Flow MaterialPoint::flow(const Response& now, const Yield& yield) const {
  const Properties& at = now.at;
  Flow flow;
  flow.yield = yield;
  const Yield& y = flow.yield;
  const bool compressible = is_compressible(settings_.parameters.model);
  flow.phi = compressible ? -y.g_p : std::abs(y.g_s);
  flow.deviatoric = y.g_s;
  flow.elastic = elastic_rate(at);
  flow.loading = y.f_p * flow.elastic.p + y.f_s * flow.elastic.s;
  // At fixed strains, densification reduces the elastic strain and stiffens the rest.
  const double bulk = at.bulk_modulus.value;
  const double shear = at.shear_modulus.value;
  const Increment by_phi = stress_change(
      at, {(compressible ? bulk : 0.0) + now.p * at.bulk_modulus.slope / bulk, now.s * at.shear_modulus.slope / shear},
      0.0, 0.0);
  const Increment by_deviatoric = stress_change(at, {0.0, -3.0 * shear}, 0.0, 0.0);
  flow.f_by_phi = y.f_phi + y.f_p * by_phi.p + y.f_s * by_phi.s;
  flow.f_by_deviatoric = y.f_p * by_deviatoric.p + y.f_s * by_deviatoric.s;
  flow.stiffness = -(flow.f_by_phi * flow.phi + flow.f_by_deviatoric * flow.deviatoric);
  flow.p_by_flow = by_phi.p * flow.phi + by_deviatoric.p * flow.deviatoric;
  return flow;
}

/// Cosine of the angle between the surface's normal and the elastic rate of stress; 0 if nothing is prescribed to move.
double MaterialPoint::cosine(const Flow& flow) noexcept {
  const double length = std::hypot(flow.yield.f_p, flow.yield.f_s) * std::hypot(flow.elastic.p, flow.elastic.s);
  return length > 0.0 ? flow.loading / length : 0.0;
}

void MaterialPoint::require_unique(const Flow& flow) {
  if (!(flow.stiffness > 0.0)) {
    throw DomainError({Limit::loss_of_uniqueness, -1, "stiffness along the flow", flow.stiffness});
  }
}

/// Plastic strain per unit of the multiplier. The integrated path contains this factor: the multiplier alone goes like
/// the reciprocal of the gradient of f, and carries the round-off and the errors of the stress.
double MaterialPoint::length(const Flow& flow) noexcept { return std::hypot(flow.phi, flow.deviatoric); }

void MaterialPoint::rates(double xi, std::span<const double> y, std::span<double> dy) {
  std::ranges::fill(dy, 0.0);
  if (!is_plastic_) return;
  const Flow now = flow(response(xi, y));
  if (now.loading == 0.0) return;
  require_unique(now);
  const double multiplier = now.loading / now.stiffness;
  dy[k_phi] = multiplier * now.phi;
  dy[k_deviatoric] = multiplier * now.deviatoric;
  dy[k_path] = multiplier * length(now);
}

void MaterialPoint::residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) {
  if (!is_plastic_) {
    std::ranges::copy(dy, res.begin());
    return;
  }
  const Flow now = flow(response(xi, y));
  require_unique(now);
  const double multiplier = dy[k_path] / length(now);
  res[k_phi] = dy[k_phi] - multiplier * now.phi;
  res[k_deviatoric] = dy[k_deviatoric] - multiplier * now.deviatoric;
  res[k_path] = now.yield.f;
}

/// In an elastic phase, restores the plastic strains with which it began. In a solvable plastic phase, moves a guess to
/// the line through them, from which it may be off by round-off.
void MaterialPoint::solve(double xi, std::span<double> y) {
  double along_phi = 0.0;
  double along_deviatoric = 0.0;
  if (is_plastic_) {
    const Flow now = flow(response(xi, y));
    const double phi = y[k_phi] - held_phi_;
    const double deviatoric = y[k_deviatoric] - held_deviatoric_;
    const double share =
        (phi * now.phi + deviatoric * now.deviatoric) / (now.phi * now.phi + now.deviatoric * now.deviatoric);
    along_phi = share * now.phi;
    along_deviatoric = share * now.deviatoric;
  }
  y[k_phi] = held_phi_ + along_phi;
  y[k_deviatoric] = held_deviatoric_ + along_deviatoric;
  complete(xi, y);
}

/// Stores the plastic strains from which solve() starts in the phase that begins.
void MaterialPoint::hold(std::span<const double> y) noexcept {
  held_phi_ = y[k_phi];
  held_deviatoric_ = y[k_deviatoric];
}

std::optional<double> MaterialPoint::closed_quadrature(double, std::span<const double>) { return std::nullopt; }

// --- modes

void MaterialPoint::begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) {
  for (std::size_t channel = 0; channel < ramps_.size(); ++channel) {
    Ramp& ramp = ramps_[channel];
    ramp = ramps[std::min(channel, ramps.size() - 1)];
    if (ramp.control != Control::stress) continue;
    ramp.start /= settings_.yield_pressure;
    ramp.end /= settings_.yield_pressure;
  }
  hold(y);
  const Response now = response(0.0, y);
  if (is_plastic_) choose_side(now);
  if (is_plastic_ && goes_on_yielding(now)) {
    go_on_plastic(now, log);
    return;
  }
  if (is_plastic_) log.push_back({"plastic-off"});
  is_plastic_ = false;
  watch_elastic(0.0, now);
  if (guards_.empty() || exit_ > k_round_off) return;
  // The last step ended on the surface, and this step leads out of it.
  log.push_back({"yield"});
  turn_plastic(exit_branch_, now);
  go_on_plastic(now, log);
}

void MaterialPoint::go_on_plastic(const Response& now, std::vector<Event>& log) {
  pass_ends(now, log);
  const Flow flow_now = flow(now);
  const bool stands_still = flow_now.elastic.p == 0.0 && flow_now.elastic.s == 0.0;
  if (!stands_still && margin(Limit::loss_of_uniqueness, now) <= 0.0)
    throw CannotBegin(domain_end(Limit::loss_of_uniqueness, now));
  watch_plastic(now);
}

/// True if plastic flow continues over a corner of the program: if the program stands still, if it leads outwards, or
/// if it leaves along the tangent of a curved surface.
bool MaterialPoint::goes_on_yielding(const Response& now) const {
  const Flow flow_now = flow(now);
  if (flow_now.elastic.p == 0.0 && flow_now.elastic.s == 0.0) return true;
  const double direction = cosine(flow_now);
  if (std::abs(direction) > k_neutral) return direction > 0.0;
  const auto out = way_out(settings_.parameters, now.at, now.p, now.s, flow_now.elastic.p, flow_now.elastic.s);
  return out && out->t <= k_round_off;
}

void MaterialPoint::turn_plastic(Branch branch, const Response& now) {
  is_plastic_ = true;
  branch_ = branch;
  choose_side(now);
}

/// Chooses the sign of s where s is zero to within error: that of its elastic rate, or 0 if s stays.
void MaterialPoint::choose_side(const Response& now) {
  if (branch_.side * now.s > 0.0) return;
  const double rate = elastic_rate(now.at).s;
  branch_.side = rate > 0.0 ? 1.0 : rate < 0.0 ? -1.0 : 0.0;
}

/// Enters the next segment if the state lies at the end of its segment and the program passes that end.
void MaterialPoint::pass_ends(const Response& now, std::vector<Event>& log) {
  for (const bool towards_compression : {false, true}) {
    const auto distance = distance_to_end(settings_.parameters, now.at, branch_.segment, towards_compression, now.p);
    if (!distance || *distance > k_arrived * now.at.yield_pressure.value) continue;
    if (!is_isochoric_end(branch_.segment, towards_compression)) continue;
    const double rate = pressure_rate_at_end(now, towards_compression);
    if (towards_compression ? rate >= 0.0 : rate <= 0.0) continue;
    enter_neighbour(now, towards_compression);
    log.push_back({"segment-change"});
    return;
  }
}

/// Changes to the next segment. On the caps s may have changed its sign.
void MaterialPoint::enter_neighbour(const Response& now, bool towards_compression) {
  branch_.segment = neighbour(settings_.parameters, branch_.segment, towards_compression);
  branch_.side = now.s > 0.0 ? 1.0 : -1.0;
}

bool MaterialPoint::is_isochoric_end(Segment segment, bool towards_compression) const noexcept {
  if (settings_.parameters.model == YieldModel::vmdc) return true;
  const Segment other = neighbour(settings_.parameters, segment, towards_compression);
  return segment == Segment::cap || other == Segment::cap;
}

/// True if the flow takes the state out through an end of its segment. Where an arc joins a shear line, the flow is the
/// same on both, and a state that has just crossed may return by round-off alone.
bool MaterialPoint::leads_out(bool towards_compression, const Response& now) const {
  if (is_isochoric_end(branch_.segment, towards_compression)) return true;
  const Flow flow_now = flow(now);
  if (!(flow_now.stiffness > 0.0)) return true;
  const double multiplier = flow_now.loading / flow_now.stiffness;
  const double of_end = -cap_constants(settings_.parameters, now.at).transition_start.slope * flow_now.phi;
  const double away = flow_now.elastic.p + multiplier * (flow_now.p_by_flow - of_end);
  return towards_compression ? away < 0.0 : away > 0.0;
}

/// True if s may change its sign. Under prescribed strains, the flow's share in the rate of s is proportional to s.
/// Then s passes zero only if the program drives it there; otherwise it decays into an integrator's error.
bool MaterialPoint::passes_apex(const Response& now) const {
  if (now.s == 0.0) return false;
  const bool follows_strains = !is_stress(k_axial) && !is_stress(k_lateral);
  return !follows_strains || branch_.side * elastic_rate(now.at).s < 0.0;
}

/// Rate of the pressure at an isochoric end, where phi is stationary and s follows p along the tangent.
double MaterialPoint::pressure_rate_at_end(const Response& now, bool towards_compression) const {
  const Parameters& parameters = settings_.parameters;
  const bool is_corner = parameters.model == YieldModel::dpc && branch_.segment == Segment::shear &&
                         neighbour(parameters, branch_.segment, towards_compression) == Segment::cap;
  const double tangent =
      is_corner ? branch_.side * cap_constants(parameters, now.at).friction_slope.value : 0.0;  // -ds/dp
  const double axial = prescribed_rate(k_axial);
  const double lateral = prescribed_rate(k_lateral);
  if (is_stress(k_axial) && is_stress(k_lateral)) return (axial + 2.0 * lateral) / 3.0;
  if (is_stress(k_lateral)) return lateral / (1.0 + tangent / 3.0);
  if (is_stress(k_axial)) return axial / (1.0 - 2.0 * tangent / 3.0);
  return now.at.bulk_modulus.value * (axial + 2.0 * lateral);
}

// --- guards

void MaterialPoint::watch_elastic(double xi, const Response& now) {
  guards_.clear();
  const Increment rate = elastic_rate(now.at);
  const auto out = way_out(settings_.parameters, now.at, now.p, now.s, rate.p, rate.s);
  if (!out || xi + out->t > 1.0) return;
  exit_ = xi + out->t;
  exit_branch_ = out->branch;
  guards_.push_back({yielding, 0, 1, "yield"});
}

void MaterialPoint::watch_plastic(const Response& now) {
  guards_.clear();
  const Parameters& parameters = settings_.parameters;
  for (const bool towards_compression : {false, true}) {
    if (!distance_to_end(parameters, now.at, branch_.segment, towards_compression, now.p)) continue;
    if (is_isochoric_end(branch_.segment, towards_compression)) {
      const double rate = pressure_rate_at_end(now, towards_compression);
      if (towards_compression ? rate >= 0.0 : rate <= 0.0) continue;
    }
    guards_.push_back({end_of_segment, towards_compression ? 1 : 0, -1, "segment-change"});
  }
  if (parameters.model == YieldModel::dpc && branch_.segment == Segment::shear && passes_apex(now)) {
    guards_.push_back({apex, 0, -1, "segment-change"});
  }
  const auto watch = [&](Limit limit, string_view name) {
    guards_.push_back({domain_end_guard, static_cast<int>(limit), -1, name});
  };
  watch(Limit::loss_of_uniqueness, "loss-of-uniqueness");
  const bool is_frozen = parameters.model == YieldModel::vmdc && branch_.segment == Segment::shear;
  if (is_frozen) return;
  if (parameters.xi1 != 0.0) watch(Limit::poisson_half, "poisson-half");
  if (parameters.xi != 0.0 || parameters.xi1 != 0.0) watch(Limit::too_stiff, "limit");
  if (!is_compressible(parameters.model)) return;
  watch(Limit::pores_closed, "density-limit");
  watch(Limit::cap_centre_at_zero_pressure, "cap-centre-tensile");
  if (parameters.xi2 != 0.0) watch(Limit::cap_axis_ratio_zero, "cap-axis-nonpositive");
}

void MaterialPoint::guard_values(double xi, std::span<const double> y, std::span<double> values) {
  if (guards_.empty()) return;
  if (!is_plastic_) {
    values[0] = xi - exit_;
    return;
  }
  const Response now = response(xi, y);
  for (std::size_t g = 0; g < guards_.size(); ++g) {
    switch (static_cast<GuardKind>(guards_[g].kind)) {
      case yielding:
        break;
      case end_of_segment:
        values[g] = *distance_to_end(settings_.parameters, now.at, branch_.segment, guards_[g].index == 1, now.p) /
                    now.at.yield_pressure.value;
        break;
      case apex:
        values[g] = branch_.side * now.s / now.at.yield_pressure.value;
        break;
      case domain_end_guard:
        values[g] = margin(static_cast<Limit>(guards_[g].index), now);
        break;
    }
  }
}

/// Distance of the state from a limit of the equations' domain; negative beyond it.
double MaterialPoint::margin(Limit limit, const Response& now) const {
  switch (limit) {
    case Limit::pores_closed:
      return 1.0 - now.at.relative_density;
    case Limit::cap_centre_at_zero_pressure:
      return now.at.cap_centre.value / now.at.yield_pressure.value;
    case Limit::cap_axis_ratio_zero:
      return now.at.axis_ratio.value;
    case Limit::poisson_half:
      return 0.5 - now.at.poisson_ratio.value - k_least_compressibility;
    case Limit::too_stiff:
      return 1.0 - stiffness_over_strength(now.at) / k_stiffest;
    default:
      break;
  }
  const Flow flow_now = flow(now);
  const Yield& y = flow_now.yield;
  if (is_stress(k_axial) && is_stress(k_lateral)) {  // only hardening resists
    const double length = std::hypot(flow_now.phi, flow_now.deviatoric);
    const double hardening = std::abs(y.f_phi) * length;
    if (!(hardening > 0.0)) return 0.0;
    const double share = flow_now.stiffness / hardening - k_least_stiffness;
    if (!(flow_now.loading > 0.0)) return share;
    return std::min(share, flow_now.stiffness / (flow_now.loading * length) - 1.0 / k_fastest);
  }
  const double bulk = is_compressible(settings_.parameters.model) ? now.at.bulk_modulus.value : 0.0;
  const double elastic_stiffness = bulk * y.f_p * y.g_p + 3.0 * now.at.shear_modulus.value * y.f_s * y.g_s;
  return flow_now.stiffness / elastic_stiffness - k_least_stiffness;
}

DomainEnd MaterialPoint::domain_end(Limit limit, const Response& now) const {
  const auto at = [limit](std::string_view event, std::string_view quantity, double value) {
    return DomainEnd{{event}, {limit, -1, quantity, value}};
  };
  switch (limit) {
    case Limit::pores_closed:
      return at("density-limit", "relative density", now.at.relative_density);
    case Limit::cap_centre_at_zero_pressure:
      return at("cap-centre-tensile", "pi3 over the yield pressure",
                now.at.cap_centre.value / now.at.yield_pressure.value);
    case Limit::cap_axis_ratio_zero:
      return at("cap-axis-nonpositive", "axis ratio", now.at.axis_ratio.value);
    case Limit::poisson_half:
      return at("poisson-half", "Poisson's ratio", now.at.poisson_ratio.value);
    case Limit::too_stiff:
      return at("limit", "modulus over the yield pressure", stiffness_over_strength(now.at));
    default:
      return at("loss-of-uniqueness", "stiffness along the flow", flow(now).stiffness);
  }
}

std::optional<DomainEnd> MaterialPoint::fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                             std::vector<Event>& log) {
  hold(y);
  const Response now = response(xi, y);
  for (const std::size_t g : fired) {
    const Guard& guard = guards_[g];
    if (guard.kind != domain_end_guard) continue;
    log.push_back({guard.name});
    return domain_end(static_cast<Limit>(guard.index), now);
  }
  for (const std::size_t g : fired) {
    const Guard& guard = guards_[g];
    if (guard.kind == end_of_segment && !leads_out(guard.index == 1, now)) continue;
    log.push_back({guard.name});
    switch (static_cast<GuardKind>(guard.kind)) {
      case yielding:
        turn_plastic(exit_branch_, now);
        pass_ends(now, log);
        if (margin(Limit::loss_of_uniqueness, now) <= 0.0) {
          log.push_back({"loss-of-uniqueness"});
          return domain_end(Limit::loss_of_uniqueness, now);
        }
        break;
      case end_of_segment:
        enter_neighbour(now, guard.index == 1);
        break;
      case apex:
        branch_.side = -branch_.side;
        break;
      case domain_end_guard:
        break;
    }
  }
  watch_plastic(now);
  return std::nullopt;
}

// --- output

/// Work rate of the flow, over the strength and the magnitude of the flow's strains.
double MaterialPoint::flow_work(const Properties& at, const Yield& yield, double p, double s) noexcept {
  return (p * yield.g_p + s * yield.g_s) / (at.shear_strength.value * std::hypot(yield.g_p, yield.g_s));
}

/// Stress of a channel; a prescribed one without the round-off of p and s.
double MaterialPoint::stress(std::size_t channel, double xi, const Response& now) const noexcept {
  if (is_stress(channel)) return prescribed(channel, xi);
  return channel == k_axial ? now.p + 2.0 * now.s / 3.0 : now.p - now.s / 3.0;
}

void MaterialPoint::observe(double xi, std::span<const double> y, std::span<double> values) {
  const Response now = response(xi, y);
  const double unit = settings_.yield_pressure;
  const bool compressible = is_compressible(settings_.parameters.model);
  double f = 0.0;
  if (is_plastic_) {
    const Yield yield = yield_on(settings_.parameters, now.at, branch_, now.p, now.s);
    f = yield.f;
    if (compressible) least_work_ = std::min(least_work_, flow_work(now.at, yield, now.p, now.s));
  } else {
    f = yield_function(settings_.parameters, now.at, now.p, now.s);
  }
  const double all[] = {
      now.axial_strain,
      now.lateral_strain,
      unit * now.p,
      unit * now.s,
      unit * std::abs(now.s),
      unit * stress(k_axial, xi, now),
      unit * stress(k_lateral, xi, now),
      now.at.relative_density,
      compressible ? 0.0 - y[k_phi] : 0.0,  // not -0
      y[k_deviatoric],
      y[k_phi],
      unit * now.at.youngs_modulus.value,
      f,
      static_cast<double>(is_plastic_ ? regime_of(branch_.segment) : elastic),
  };
  std::ranges::copy(all, values.begin());
}

std::optional<Difficulty> MaterialPoint::difficulty(double xi, std::span<const double> y) {
  const Response now = response(xi, y);
  if (is_plastic_ && margin(Limit::loss_of_uniqueness, now) < k_hardly_unique) return Difficulty::hardly_unique;
  if (now.at.bulk_modulus.value < k_stiff * now.at.yield_pressure.value) return std::nullopt;
  return Difficulty::stiff_material;
}

std::vector<Diagnostic> MaterialPoint::warnings() const {
  if (least_work_ > -k_negligible_work) return {};
  return {{"flow that is not associated (dpc) does negative plastic work: it lives on the elastic energy",
           "least work rate over the strength", least_work_}};
}

double MaterialPoint::quantity(Quantity quantity, int, double xi, std::span<const double> y) {
  const Response now = response(xi, y);
  switch (quantity) {
    case Quantity::stress_axial:
      return settings_.yield_pressure * stress(k_axial, xi, now);
    case Quantity::stress_lateral:
      return settings_.yield_pressure * stress(k_lateral, xi, now);
    case Quantity::relative_density:
      return now.at.relative_density;
    default:
      break;
  }
  throw std::logic_error("a material point has no walls to ask for this");
}

double MaterialPoint::controlled(Control control, int channel, double xi, std::span<const double> y) {
  const bool is_axial = channel == static_cast<int>(k_axial);
  if (control == Control::stress) {
    return quantity(is_axial ? Quantity::stress_axial : Quantity::stress_lateral, channel, xi, y);
  }
  const Response now = response(xi, y);
  return is_axial ? now.axial_strain : now.lateral_strain;
}

}  // namespace monograin::compressible
