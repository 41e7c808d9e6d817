#include "material-point/system.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "material-point/limits.hpp"
#include "material-point/return_mapping.hpp"
#include "material-point/segment_ends.hpp"
#include "system/resolution.hpp"

namespace monograin::material_point {
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

// Share of the strength below which a negative work or dissipation of the flow is round-off.
constexpr double k_negligible_work = 1e-9;

/// Indices of the unknowns.
enum UnknownIndex : std::size_t { k_phi, k_deviatoric, k_path };

enum GuardKind { yielding, end_of_segment, apex, domain_end_guard };

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

PlasticStrains plastic_strains(std::span<const double> y) { return {y[k_phi], y[k_deviatoric]}; }

}  // namespace

// The flow of von Mises keeps its direction (d(phi) = |d(g^p)|), and so does flow without deviator.
System::System(const Settings& settings)
    : yield_pressure_(settings.yield_pressure),
      phase_{.parameters = settings.parameters,
             .has_straight_flow = settings.parameters.model == YieldModel::vm || settings.is_hydrostatic} {
  for (const char* name : {"strain_axial", "strain_lateral"}) observables_.push_back({name, "-", {}});
  for (const char* name : {"p", "s", "q", "stress_axial", "stress_lateral"}) observables_.push_back({name, "Pa", {}});
  for (const char* name : {"relative_density", "plastic_strain_volumetric", "plastic_strain_deviatoric", "phi"}) {
    observables_.push_back({name, "-", {}});
  }
  observables_.push_back({"youngs_modulus", "Pa", {}});
  observables_.push_back({"yield_function", "-", {}});
  observables_.push_back({"regime", "", k_regime_names});
}

std::span<const Unknown> System::unknowns() const noexcept { return k_unknowns; }

/// Usual plastic strain over the elastic strain at yield, within bounds; a stiff material has smaller elastic strains.
double System::error_gain() const noexcept {
  const Properties at = properties_at(phase_.parameters, 0.0);
  const double elastic_strain = at.yield_pressure.value / (3.0 * at.shear_modulus.value);
  return std::clamp(k_unknowns[k_deviatoric].scale / elastic_strain, k_usual_gain, k_most_gain);
}

void System::start(std::span<double> y) { std::ranges::fill(y, 0.0); }

Response System::response(double xi, std::span<const double> y) const {
  return material_point::response(phase_, xi, plastic_strains(y));
}

PlasticFlow System::flow(double xi, std::span<const double> y) const { return plastic_flow(phase_, response(xi, y)); }

// The integrated path contains the length of the flow. The multiplier alone goes like the reciprocal of the gradient of
// f, and carries the round-off and the errors of the stress.
void System::rates(double xi, std::span<const double> y, std::span<double> dy) {
  std::ranges::fill(dy, 0.0);
  if (!phase_.is_plastic) return;
  const PlasticFlow now = flow(xi, y);
  if (now.loading == 0.0) return;
  now.require_unique();
  const double multiplier = now.loading / now.stiffness;
  dy[k_phi] = multiplier * now.direction.phi;
  dy[k_deviatoric] = multiplier * now.direction.deviatoric;
  dy[k_path] = multiplier * now.direction.length();
}

void System::residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) {
  if (!phase_.is_plastic) {
    std::ranges::copy(dy, res.begin());
    return;
  }
  const PlasticFlow now = flow(xi, y);
  now.require_unique();
  const double multiplier = dy[k_path] / now.direction.length();
  res[k_phi] = dy[k_phi] - multiplier * now.direction.phi;
  res[k_deviatoric] = dy[k_deviatoric] - multiplier * now.direction.deviatoric;
  res[k_path] = now.yield.f;
}

void System::complete(double xi, std::span<double> y) {
  if (!phase_.is_plastic) return;
  const PlasticStrains found = returned_to_surface(phase_, xi, plastic_strains(y));
  y[k_phi] = found.phi;
  y[k_deviatoric] = found.deviatoric;
}

/// In an elastic phase, restores the plastic strains with which it began. In a solvable plastic phase, moves a guess to
/// the line through them, from which it may be off by round-off.
void System::solve(double xi, std::span<double> y) {
  PlasticStrains along;
  if (phase_.is_plastic) {
    const PlasticStrains flow_now = flow(xi, y).direction;
    const double phi = y[k_phi] - at_start_.phi;
    const double deviatoric = y[k_deviatoric] - at_start_.deviatoric;
    const double share = (phi * flow_now.phi + deviatoric * flow_now.deviatoric) /
                         (flow_now.phi * flow_now.phi + flow_now.deviatoric * flow_now.deviatoric);
    along = {share * flow_now.phi, share * flow_now.deviatoric};
  }
  y[k_phi] = at_start_.phi + along.phi;
  y[k_deviatoric] = at_start_.deviatoric + along.deviatoric;
  complete(xi, y);
}

// --- modes

void System::begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) {
  phase_.conditions = BoundaryConditions(ramps, yield_pressure_);
  at_start_ = plastic_strains(y);
  const Response now = response(0.0, y);
  if (phase_.is_plastic) phase_.branch.side = side_of(phase_, now);
  if (phase_.is_plastic && continues(phase_, now)) {
    go_on_plastic(now, log);
    return;
  }
  if (phase_.is_plastic) log.push_back({"plastic-off"});
  phase_.is_plastic = false;
  arm_elastic(0.0, now);
  if (guards_.empty() || elastic_end_.xi > k_same_instant) return;
  // The last step ended on the surface, and this step leads out of it.
  log.push_back({"yield"});
  turn_plastic(now);
  go_on_plastic(now, log);
}

void System::go_on_plastic(const Response& now, std::vector<Event>& log) {
  pass_ends(now, log);
  if (!elastic_rate(now.at, phase_.conditions).is_zero() &&
      distance_to(Limit::loss_of_uniqueness, phase_, now).margin <= 0.0)
    throw CannotBegin(domain_end(Limit::loss_of_uniqueness, phase_, now));
  arm_plastic(now);
}

void System::turn_plastic(const Response& now) {
  phase_.is_plastic = true;
  phase_.branch = elastic_end_.branch;
  phase_.branch.side = side_of(phase_, now);
}

/// Enters the next segment if the state lies at the end of its segment and the program passes that end.
void System::pass_ends(const Response& now, std::vector<Event>& log) {
  for (const bool towards_compression : {false, true}) {
    if (!stands_at_passed_end(phase_, now, towards_compression)) continue;
    phase_.branch = branch_beyond(phase_, now, towards_compression);
    log.push_back({"segment-change"});
    return;
  }
}

// --- guards

void System::arm_elastic(double xi, const Response& now) {
  guards_.clear();
  const StressChange rate = elastic_rate(now.at, phase_.conditions);
  const auto out = way_out(phase_.parameters, now.at, now.p, now.s, rate.p, rate.s);
  if (!out || xi + out->t > 1.0) return;
  elastic_end_ = {xi + out->t, out->branch};
  guards_.push_back({yielding, 0, 1, "yield"});
}

void System::arm_plastic(const Response& now) {
  guards_.clear();
  for (const bool towards_compression : {false, true}) {
    if (!has_passable_end(phase_, now, towards_compression)) continue;
    guards_.push_back({end_of_segment, towards_compression ? 1 : 0, -1, "segment-change"});
  }
  if (may_pass_apex(phase_, now)) guards_.push_back({apex, 0, -1, "segment-change"});
  for (const Limit limit : limits_of(phase_)) {
    guards_.push_back({domain_end_guard, static_cast<int>(limit), -1, distance_to(limit, phase_, now).event});
  }
}

void System::guard_values(double xi, std::span<const double> y, std::span<double> values) {
  if (guards_.empty()) return;
  if (!phase_.is_plastic) {
    values[0] = xi - elastic_end_.xi;
    return;
  }
  const Response now = response(xi, y);
  for (std::size_t g = 0; g < guards_.size(); ++g) {
    const Guard& guard = guards_[g];
    switch (static_cast<GuardKind>(guard.kind)) {
      case yielding:
        break;
      case end_of_segment:
        values[g] = *distance_to_end(phase_.parameters, now.at, phase_.branch.segment, guard.index == 1, now.p) /
                    now.at.yield_pressure.value;
        break;
      case apex:
        values[g] = phase_.branch.side * now.s / now.at.yield_pressure.value;
        break;
      case domain_end_guard:
        values[g] = distance_to(static_cast<Limit>(guard.index), phase_, now).margin;
        break;
    }
  }
}

std::optional<DomainEnd> System::fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                      std::vector<Event>& log) {
  at_start_ = plastic_strains(y);
  const Response now = response(xi, y);
  for (const std::size_t g : fired) {
    const Guard& guard = guards_[g];
    if (guard.kind != domain_end_guard) continue;
    log.push_back({guard.name});
    return domain_end(static_cast<Limit>(guard.index), phase_, now);
  }
  for (const std::size_t g : fired) {
    const Guard& guard = guards_[g];
    if (guard.kind == end_of_segment && !leads_out(phase_, now, guard.index == 1)) continue;
    log.push_back({guard.name});
    switch (static_cast<GuardKind>(guard.kind)) {
      case yielding:
        turn_plastic(now);
        pass_ends(now, log);
        if (distance_to(Limit::loss_of_uniqueness, phase_, now).margin <= 0.0) {
          const DomainEnd end = domain_end(Limit::loss_of_uniqueness, phase_, now);
          log.push_back(end.event);
          return end;
        }
        break;
      case end_of_segment:
        phase_.branch = branch_beyond(phase_, now, guard.index == 1);
        break;
      case apex:
        phase_.branch.side = -phase_.branch.side;
        break;
      case domain_end_guard:
        break;
    }
  }
  arm_plastic(now);
  return std::nullopt;
}

// --- output

void System::observe(double xi, std::span<const double> y, std::span<double> values) {
  const Response now = response(xi, y);
  const double unit = yield_pressure_;
  const bool compressible = is_compressible(phase_.parameters.model);
  double f = 0.0;
  if (phase_.is_plastic) {
    const Yield yield = yield_on(phase_.parameters, now.at, phase_.branch, now.p, now.s);
    f = yield.f;
    const FlowEnergy energy = flow_energy(phase_, now, yield);
    least_.work = std::min(least_.work, energy.work);
    least_.dissipation = std::min(least_.dissipation, energy.dissipation);
  } else {
    f = yield_function(phase_.parameters, now.at, now.p, now.s);
  }
  const double all[] = {
      now.axial_strain,
      now.lateral_strain,
      unit * now.p,
      unit * now.s,
      unit * std::abs(now.s),
      unit * stress_of(Channel::axial, phase_.conditions, xi, now),
      unit * stress_of(Channel::lateral, phase_.conditions, xi, now),
      compressible ? now.at.relative_density : k_nan,
      compressible ? 0.0 - y[k_phi] : 0.0,  // not -0
      y[k_deviatoric],
      y[k_phi],
      unit * now.at.youngs_modulus.value,
      f,
      static_cast<double>(phase_.is_plastic ? regime_of(phase_.branch.segment) : elastic),
  };
  std::ranges::copy(all, values.begin());
}

std::optional<Difficulty> System::difficulty(double xi, std::span<const double> y) {
  const Response now = response(xi, y);
  if (phase_.is_plastic && distance_to(Limit::loss_of_uniqueness, phase_, now).margin < k_hard_margin)
    return Difficulty::hardly_unique;
  if (now.at.bulk_modulus.value < k_stiff_modulus * now.at.yield_pressure.value) return std::nullopt;
  return Difficulty::stiff_material;
}

std::vector<Diagnostic> System::warnings() const {
  std::vector<Diagnostic> found;
  if (least_.work < -k_negligible_work) {
    found.push_back({"flow that is not associated (dpc) does negative plastic work: it lives on the elastic energy",
                     "least work rate over the strength", least_.work});
  } else if (least_.dissipation < -k_negligible_work) {
    found.push_back(
        {"the growing moduli store more than the plastic work: the material creates energy, and a closed "
         "cycle gives back more than it took; expected a stiffer material, or moduli that grow less",
         "least dissipation rate over the strength", least_.dissipation});
  }
  return found;
}

double System::quantity(Quantity quantity, int, double xi, std::span<const double> y) {
  const Response now = response(xi, y);
  switch (quantity) {
    case Quantity::stress_axial:
      return yield_pressure_ * stress_of(Channel::axial, phase_.conditions, xi, now);
    case Quantity::stress_lateral:
      return yield_pressure_ * stress_of(Channel::lateral, phase_.conditions, xi, now);
    case Quantity::relative_density:
      // Von Mises plasticity has no density. Conditions are above 0, so that none is ever met.
      return is_compressible(phase_.parameters.model) ? now.at.relative_density : 0.0;
    default:
      break;
  }
  throw std::logic_error("a material point has no walls to ask for this");
}

double System::controlled(Control control, int channel, double xi, std::span<const double> y) {
  const bool is_axial = channel == static_cast<int>(Channel::axial);
  if (control == Control::stress) {
    return quantity(is_axial ? Quantity::stress_axial : Quantity::stress_lateral, channel, xi, y);
  }
  const Response now = response(xi, y);
  return is_axial ? now.axial_strain : now.lateral_strain;
}

}  // namespace monograin::material_point
