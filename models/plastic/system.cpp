#include "plastic/system.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "difficulties.hpp"
#include "undefined.hpp"

namespace monograin::plastic {
namespace {

using std::numbers::pi;

// In the order of Regime.
constexpr std::array<std::string_view, 9> k_regime_words{
    "open",      "elastic",   "elastic-plastic", "fully-plastic", "low-compressibility", "elastic-volumetric",
    "undefined", "unloading", "separated"};

// Guards.
enum Kind : int { k_made, k_touched, k_boundary, k_lateral_boundary, k_impingement, k_reload, k_lost, k_limit };

// Nearer to the place where a branch begins, over its length, the force is taken as linear in u.
constexpr double k_nearest_touch = 1e-100;
constexpr double k_nearest_opening = 1e-7;
// Guards a rounding error beyond the end of a ramp are watched too.
constexpr double k_reach_margin = 1e-9;
constexpr double k_opening_power = 1.5;
// Share of a ramp that takes no time: integrators do not step so far.
constexpr double k_instant = 1e-13;
// Share of a prescribed value that is rounding.
constexpr double k_rounding = 4.0 * std::numeric_limits<double>::epsilon();
// Depth over R0 below which a contact is rounding.
constexpr double k_least_depth = 1e-12;
// Contacts shallower than this over R0 have no digits left where a ramp takes the wall there.
constexpr double k_least_typical = 1e-7;

double signed_power(double x, double exponent) noexcept { return std::copysign(std::pow(std::abs(x), exponent), x); }

bool touches(Regime regime) noexcept { return regime != Regime::open && regime != Regime::separated; }

bool is_die(const Law& law) noexcept {
  if (const auto* semimech = std::get_if<SemimechLaw>(&law)) return semimech->configuration == Configuration::die;
  if (const auto* hardening = std::get_if<HardeningLaw>(&law)) return hardening->configuration == Configuration::die;
  return false;
}

}  // namespace

System::System(Settings settings, std::vector<ContactClass> classes)
    : settings_(std::move(settings)),
      modulus_(settings_.composite_modulus / settings_.strength),
      classes_(std::move(classes)),
      boundaries_(boundaries(settings_.law)),
      impingement_(impingement(settings_.law)) {
  const Law& law = settings_.law;
  const std::size_t count = classes_.size();
  memory_.resize(count);
  ramps_.resize(count);
  directions_.resize(count);
  places_.resize(count);
  for (const ContactClass& c : classes_) is_lateral_.push_back(is_die(law) && std::abs(c.normals.front().z()) < 0.5);
  first_primary_ = static_cast<std::size_t>(std::ranges::find(is_lateral_, false) - is_lateral_.begin());
  if (const auto* semimech = std::get_if<SemimechLaw>(&law); semimech != nullptr && is_die(law)) {
    lateral_law_ = make_lateral(*semimech);
    lateral_boundaries_ = boundaries(*semimech, *lateral_law_);
  }

  const double length = settings_.initial_radius;
  double reach = settings_.largest_displacement / length;
  if (settings_.largest_force > 0.0) {
    try {
      reach = std::max(reach, approach_under(law, settings_.largest_force / (settings_.strength * length * length)));
    } catch (const std::domain_error&) {
      reach = limit(law);  // the run will stop there
    }
  }
  is_shallow_ = reach > 0.0 && reach <= k_least_depth;
  // Far from the limit, where the pressure of an enclosed particle is infinite.
  reach = reach > 0.0 ? std::min(reach, 0.9 * limit(law)) : 0.5 * limit(law);
  for (std::size_t i = 0; i < count; ++i) {
    if (!classes_[i].takes_force) continue;
    places_[i] = unknowns_.size();
    // Where there is a yield point, what lies before it counts too.
    const double first = boundaries_.empty() || !begins_elastic(law) ? reach : std::min(reach, boundaries_[0].approach);
    const double typical = std::max(first, k_least_typical);
    unknowns_.push_back({classes_[i].name, Unknown::Kind::differential, std::pow(typical, first_power(law)), true});
  }
  work_place_ = unknowns_.size();
  unknowns_.push_back({"work", Unknown::Kind::quadrature, work_per_wall(law, reach), false});

  observables_.push_back({"work", "J", {}});
  if (settings_.unloading != Unloading::none) {
    observables_.push_back({"stored_energy", "J", {}});
    observables_.push_back({"dissipation", "J", {}});
  }
  for (const ContactClass& c : classes_) add_contact_columns(c.name, k_regime_words, observables_);
  for (const OutOfRange& out : settings_.out_of_range) {
    range_messages_.push_back(std::string(out.quantity) + " is outside " + text(out.lower) + " to " + text(out.upper) +
                              ", over which the source fitted the law");
  }
}

void System::start(std::span<double> y) {
  std::ranges::fill(y, 0.0);
  memory_.assign(classes_.size(), Memory{});
  has_begun_ = false;
  farthest_ = 0.0;
  energies_ = {};
  has_lateral_gap_ = false;
  overshooting_.reset();
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const double gap = classes_[i].gap / settings_.initial_radius;
    ramps_[i] = {-gap, -gap, Control::displacement};
    directions_[i] = 0;
    memory_[i].resting = -gap;
    if (classes_[i].takes_force) y[places_[i]] = coordinate(i, -gap);
  }
}

void System::begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) {
  const double length = settings_.initial_radius;
  for (std::size_t i = 0; i < ramps_.size(); ++i) {
    const double unit = ramps[i].control == Control::force ? settings_.strength * length * length : length;
    const double stood = classes_[i].takes_force ? displacement_at(i, y[places_[i]]) : 0.0;
    ramps_[i] = {ramps[i].start / unit, ramps[i].end / unit, ramps[i].control};
    if (is_lateral(i)) continue;
    double x = is_loaded(i) ? stood : ramps_[i].start;
    directions_[i] = direction_of_ramp(i, x);
    if (touches(memory_[i].regime)) {
      // A wall that has only touched leaves no dent.
      const bool has_pressed = x > (is_loaded(i) ? 0.0 : k_least_depth);
      if (direction(i) < 0 && memory_[i].is_virgin && has_pressed) turn_back(i, x, log);
      // From there, and where a force ends at nothing or has so far to go below that it does so at once.
      const bool is_left = memory_[i].is_virgin ? !has_pressed
                           : is_loaded(i)       ? told(i, k_instant) <= 0.0
                                                : x <= origin(i);
      if (direction(i) < 0 && is_left) {
        if (!memory_[i].is_virgin) {
          y[work_place_] -= classes_[i].multiplicity() * stored_energy(i, x);
          if (is_loaded(i)) x = origin(i);
        }
        lose_contact(i);
        log.push_back({"contact-lost", static_cast<int>(i)});
      }
    } else {
      meet_walls(i, x, log);
    }
    if (touches(memory_[i].regime) && is_reloaded(i, x)) resume_loading(i, x, log);
    const double now = touches(memory_[i].regime) ? std::max(x, origin(i)) : x;
    if (classes_[i].takes_force) y[places_[i]] = coordinate(i, is_loaded(i) ? now : x);
  }
  has_begun_ = true;
  settle_lateral();
  watch(0.0, y);
}

/// A ramp that rounding has left between two equal values goes nowhere. A force under which a wall stands has the
/// rounding of its place, too.
int System::direction_of_ramp(std::size_t i, double x) const {
  const double way = ramps_[i].end - ramps_[i].start;
  double size = std::max(std::abs(ramps_[i].start), std::abs(ramps_[i].end));
  if (is_loaded(i)) size = std::max(size, contact(i, x).stiffness * x);
  if (std::abs(way) <= k_rounding * size) return 0;
  return way > 0.0 ? 1 : -1;
}

/// Whether a contact that comes in is at its largest displacement, or nearer to it than a ramp can tell.
bool System::is_reloaded(std::size_t i, double x) const {
  const Memory& memory = memory_[i];
  if (direction(i) <= 0 || memory.is_virgin) return false;
  if (is_loaded(i)) return x >= memory.largest || told(i, k_instant) >= contact(i, memory.largest).force;
  return x >= memory.largest - k_instant * (ramps_[i].end - ramps_[i].start);
}

/// Displacement or force as the program says.
double System::told(std::size_t i, double xi) const noexcept { return std::lerp(ramps_[i].start, ramps_[i].end, xi); }

bool System::is_on_indenter(std::size_t i) const noexcept {
  return memory_[i].regime == Regime::unloading || memory_[i].regime == Regime::separated;
}

/// Displacement at which the force of the present branch begins.
double System::origin(std::size_t i) const noexcept {
  return is_on_indenter(i) ? memory_[i].indenter.overlap_max - memory_[i].indenter.recovery : 0.0;
}

/// How the coordinate of a wall goes with the distance from there.
System::Chart System::chart(std::size_t i) const noexcept {
  if (!is_loaded(i)) return {};
  if (!is_on_indenter(i)) return {.power = first_power(settings_.law)};
  return {origin(i), memory_[i].indenter.recovery, unknowns_[places_[i]].scale, k_opening_power};
}

/// du/dx at a distance from the origin.
double System::stretch(std::size_t i, double distance) const noexcept {
  const auto [origin, length, unit, power] = chart(i);
  return unit * power * std::pow(distance / length, power - 1.0) / length;
}

double System::coordinate(std::size_t i, double x) const noexcept {
  const auto [origin, length, unit, power] = chart(i);
  return unit * signed_power((x - origin) / length, power);
}

/// Displacement that a coordinate stands for.
double System::displacement_at(std::size_t i, double u) const noexcept {
  const auto [origin, length, unit, power] = chart(i);
  return origin + length * signed_power(u / unit, 1.0 / power);
}

double System::displacement(std::size_t i, double xi, std::span<const double> y) const noexcept {
  return is_loaded(i) ? displacement_at(i, y[places_[i]]) : told(i, xi);
}

double System::displacement_under_force(std::size_t i, double force, double near) const {
  switch (memory_[i].regime) {
    case Regime::open:
    case Regime::separated:
      return memory_[i].resting;
    case Regime::unloading:
      return mdr::unloading_overlap(memory_[i].indenter, std::max(force, 0.0));
    default:
      return approach_under(settings_.law, std::max(force, 0.0), near);
  }
}

/// A contact at an instant. A prescribed force is what it is: next to a filled cell, where the force rises without
/// bound, it does not follow from the displacement to any use.
System::Contact System::seen(std::size_t i, double xi, std::span<const double> y) const {
  Contact c = contact(i, displacement(is_lateral(i) ? first_primary_ : i, xi, y));
  if (is_loaded(i) && touches(memory_[i].regime) && c.contact_radius > 0.0) {
    c.force = told(i, xi);
    c.pressure = c.force / (pi * c.contact_radius * c.contact_radius);
  }
  return c;
}

/// A contact at a displacement of its wall.
System::Contact System::contact(std::size_t i, double x) const {
  const Memory& memory = memory_[i];
  if (is_lateral(i)) return lateral_contact(i, x);
  if (!touches(memory.regime) || x <= origin(i)) return {};
  if (memory.regime == Regime::unloading) {
    const mdr::Contact c = mdr::unloading_contact(memory.indenter, modulus_, x);
    const double area = pi * c.contact_radius * c.contact_radius;
    return {c.force, c.by_overlap, c.contact_radius, area > 0.0 ? c.force / area : 0.0};
  }
  const ContactState c = state_in(settings_.law, memory.regime, x);
  return {c.force, c.force_by_approach, c.contact_radius, c.pressure};
}

/// A lateral contact at a displacement of the axial walls.
System::Contact System::lateral_contact(std::size_t i, double x) const {
  const Regime regime = memory_[i].regime;
  if (regime == Regime::open || (x <= 0.0 && regime != Regime::undefined)) return {};
  if (regime == Regime::undefined) return {k_nan, k_nan, k_nan, k_nan};
  const ContactState c = lateral_state_in(std::get<SemimechLaw>(settings_.law), *lateral_law_, regime, x);
  return {c.force, c.force_by_approach, c.contact_radius, c.pressure};
}

/// Force and its derivatives at a coordinate of a touching contact; odd in u, so that a trial step below zero stays
/// smooth.
System::Slope System::slope(std::size_t i, double u) const {
  const auto [origin, length, unit, power] = chart(i);
  const double nearest = is_on_indenter(i) ? k_nearest_opening : k_nearest_touch;
  const double distance = std::pow(std::abs(u) / unit, 1.0 / power);  // over the length
  const double by_displacement = stretch(i, length * distance);       // du/dx
  if (distance <= nearest) {
    const double by_coordinate = contact(i, origin + length * nearest).force / (unit * std::pow(nearest, power));
    return {by_coordinate * u, by_coordinate, by_coordinate * by_displacement};
  }
  const Contact c = contact(i, origin + length * distance);
  return {std::copysign(c.force, u), c.stiffness / by_displacement, c.stiffness};
}

/// Whether the place of a wall needs no integration: it is prescribed, rests, or follows from the force, in closed form
/// or, next to where its pressure becomes infinite, where an integrator's error would lead beyond.
bool System::is_known(std::size_t i) const noexcept {
  const Regime regime = memory_[i].regime;
  return !is_loaded(i) || is_on_indenter(i) || !touches(regime) || regime == Regime::low_compressibility;
}

/// Coordinate of such a wall.
double System::known_coordinate(std::size_t i, double xi, std::span<const double> y) const {
  const double control = told(i, xi);
  if (!is_loaded(i)) return control;
  if (memory_[i].regime != Regime::unloading) {
    return coordinate(i, displacement_under_force(i, control, displacement(i, xi, y)));
  }
  const Chart own = chart(i);
  return own.unit * std::pow(mdr::recompressed_share(memory_[i].indenter, std::max(control, 0.0)), own.power);
}

void System::complete(double xi, std::span<double> y) {
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (!classes_[i].takes_force) continue;
    if (is_known(i)) y[places_[i]] = known_coordinate(i, xi, y);
  }
}

void System::solve(double xi, std::span<double> y) {
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (!classes_[i].takes_force) continue;
    const double now = displacement(i, xi, y);
    y[places_[i]] = coordinate(i, is_loaded(i) ? displacement_under_force(i, told(i, xi), now) : now);
  }
}

void System::rates(double xi, std::span<const double> y, std::span<double> dy) {
  double power = 0.0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (is_lateral(i)) continue;
    const double speed = ramps_[i].end - ramps_[i].start;
    if (is_loaded(i)) {
      const Slope now = touches(memory_[i].regime) ? slope(i, y[places_[i]]) : Slope{};
      dy[places_[i]] = now.by_coordinate > 0.0 ? speed / now.by_coordinate : 0.0;
      power += power_under_force(i, xi, now);
    } else {
      if (classes_[i].takes_force) dy[places_[i]] = speed;
      power += classes_[i].multiplicity() * contact(i, told(i, xi)).force * speed;
    }
  }
  dy[work_place_] = power;
}

/// Rate of the work of walls under a force.
double System::power_under_force(std::size_t i, double xi, const Slope& now) const {
  if (!(now.by_displacement > 0.0)) return 0.0;
  const double speed = (ramps_[i].end - ramps_[i].start) / now.by_displacement;
  return classes_[i].multiplicity() * told(i, xi) * speed;
}

void System::residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) {
  double power = 0.0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (is_lateral(i)) continue;
    const bool presses = is_loaded(i) && touches(memory_[i].regime);
    const double u = classes_[i].takes_force ? y[places_[i]] : 0.0;
    const double place = classes_[i].takes_force && is_known(i) ? known_coordinate(i, xi, y) : u;
    const Slope now = presses ? slope(i, place) : Slope{};
    power += is_loaded(i)
                 ? power_under_force(i, xi, now)
                 : classes_[i].multiplicity() * contact(i, told(i, xi)).force * (ramps_[i].end - ramps_[i].start);
    if (!classes_[i].takes_force) continue;
    // In units of u, as the integrator weighs it.
    res[places_[i]] = is_known(i) ? u - place : (now.force - told(i, xi)) / now.by_coordinate;
  }
  res[work_place_] = dy[work_place_] - power;
}

std::optional<double> System::closed_quadrature(double xi, std::span<const double> y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (is_lateral(i) || !touches(memory_[i].regime)) continue;
    const double x = displacement(i, xi, y);
    if (x <= origin(i)) continue;
    const double one = memory_[i].regime == Regime::unloading ? mdr::unloading_energy(memory_[i].indenter, x)
                                                              : work_in(settings_.law, memory_[i].regime, x);
    sum += classes_[i].multiplicity() * one;
  }
  return sum;
}

// --- transitions

/// An open contact at the start of a step: closes where its wall stands at the surface and comes in, or is pressed on.
void System::meet_walls(std::size_t i, double x, std::vector<Event>& log) {
  Memory& memory = memory_[i];
  if (direction(i) <= 0 && !(is_loaded(i) && ramps_[i].start > 0.0)) return;
  if (!is_loaded(i) && x < origin(i)) return;
  const bool was_separated = memory.regime == Regime::separated;
  memory.regime = was_separated ? Regime::unloading : first_regime(settings_.law);
  // A driven wall that touches the fresh particle is in contact from the start, without an event.
  const bool is_first_touch = !has_begun_ && classes_[i].gap == 0.0;
  if (!is_first_touch) log.push_back({was_separated ? "dent-touched" : "contact-made", static_cast<int>(i)});
}

void System::turn_back(std::size_t i, double x, std::vector<Event>& log) {
  Memory& memory = memory_[i];
  if (settings_.unloading == Unloading::none) {
    throw std::domain_error("the walls of class '" + classes_[i].name + "' would go back at gamma/2R = " + text(x) +
                            ", for which the law has no branch; unloading = \"mdr\" adds one");
  }
  if (memory.regime != Regime::elastic) {
    memory.indenter = indenter_at(i, x);
    memory.regime = Regime::unloading;
    if (memory.indenter.recovery > x) {
      const double ratio = memory.indenter.recovery / x;
      overshooting_ = std::max(overshooting_.value_or(ratio), ratio);
    }
  }
  memory.is_virgin = false;
  memory.largest = x;
  log.push_back({"load-reversal", static_cast<int>(i)});
}

void System::lose_contact(std::size_t i) {
  Memory& memory = memory_[i];
  memory.resting = origin(i);
  memory.regime = memory.regime == Regime::unloading ? Regime::separated : Regime::open;
}

/// Loading goes on from the largest displacement - at x, a rounding error later, which may lie beyond what comes next.
void System::resume_loading(std::size_t i, double x, std::vector<Event>& log) {
  const auto pass = [&](const Boundaries& ends, std::size_t of_class) {
    for (std::size_t& next = memory_[of_class].next; next < ends.size(); ++next) {
      // The last end of a law is for its guard.
      const bool is_last = &ends == &boundaries_ && ends[next].beyond == Regime::undefined;
      if (is_last || x < ends[next].approach) return;
      if (!ends[next].event.empty()) log.push_back({ends[next].event, static_cast<int>(of_class)});
    }
  };
  Memory& memory = memory_[i];
  memory.is_virgin = true;
  log.push_back({"reload", static_cast<int>(i)});
  pass(boundaries_, i);
  memory.regime = memory.next == 0 ? first_regime(settings_.law) : boundaries_[memory.next - 1].beyond;
  if (impingement_ && !memory.has_impinged && x >= *impingement_) {
    memory.has_impinged = true;
    log.push_back({"impingement", static_cast<int>(i)});
  }
  for (std::size_t lateral = 0; i == first_primary_ && lateral < memory_.size(); ++lateral) {
    if (is_lateral(lateral)) pass(lateral_boundaries_, lateral);
  }
}

/// Elastic indenter that the contact would leave if it were unloaded from this displacement.
mdr::UnloadingShape System::indenter_at(std::size_t i, double x) const {
  const ContactState now = state_in(settings_.law, memory_[i].regime, x);
  return mdr::unloading_shape_of(modulus_, settings_.poisson_ratio, 1.0, x, now.contact_radius, now.pressure);
}

/// Lateral contacts follow the axial ones while those are loaded, and while nothing has yielded.
void System::settle_lateral() {
  const Regime primary = memory_[first_primary_].regime;
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    if (!is_lateral(i)) continue;
    Memory& memory = memory_[i];
    if (primary == Regime::open)
      memory.regime = Regime::open;
    else if (!lateral_law_ || primary == Regime::unloading || primary == Regime::separated)
      memory.regime = Regime::undefined;
    else
      memory.regime = memory.next == 0 ? Regime::elastic : lateral_boundaries_[memory.next - 1].beyond;
    has_lateral_gap_ = has_lateral_gap_ || memory.regime == Regime::undefined;
  }
}

void System::add_guard(int kind, std::size_t i, int direction, std::string_view name, double place) {
  guards_.push_back({.kind = kind,
                     .index = static_cast<int>(i),
                     .direction = direction,
                     .name = name,
                     .is_told = !is_loaded(is_lateral(i) ? first_primary_ : i)});
  guard_places_.push_back(place);
}

/// The guards that may fire before the end of the step.
void System::watch(double xi, std::span<const double> y) {
  guards_.clear();
  guard_places_.clear();
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    if (is_lateral(i)) continue;
    double target = ramps_[i].end;
    if (is_loaded(i)) {
      try {
        target = displacement_under_force(i, ramps_[i].end);
      } catch (const std::domain_error&) {
        target = std::numeric_limits<double>::infinity();
      }
    }
    watch_primary(i, displacement(i, xi, y), target);
  }
}

void System::watch_primary(std::size_t i, double x, double target) {
  const Memory& memory = memory_[i];
  const double margin = k_reach_margin * std::max(std::abs(target), std::abs(x));
  const auto is_ahead = [&](double place) { return place <= target + margin; };
  if (direction(i) < 0) {
    // A force that ends at nothing leaves the wall at the surface.
    if (touches(memory.regime) && (is_loaded(i) ? ramps_[i].end < 0.0 : target <= origin(i) + margin)) {
      add_guard(k_lost, i, -1, "contact-lost", origin(i));
    }
    return;
  }
  if (direction(i) == 0) return;
  if (memory.regime == Regime::open || memory.regime == Regime::separated) {
    if (is_loaded(i) || !is_ahead(origin(i))) return;
    if (memory.regime == Regime::open)
      add_guard(k_made, i, 1, "contact-made", origin(i));
    else
      add_guard(k_touched, i, 1, "dent-touched", origin(i));
    return;
  }
  if (!memory.is_virgin) {
    if (is_ahead(memory.largest)) add_guard(k_reload, i, 1, "reload", memory.largest);
    return;
  }
  if (memory.next < boundaries_.size() && is_ahead(boundaries_[memory.next].approach)) {
    const Boundary& boundary = boundaries_[memory.next];
    add_guard(k_boundary, i, 1, boundary.event, boundary.approach);
  }
  if (impingement_ && !memory.has_impinged && is_ahead(*impingement_)) {
    add_guard(k_impingement, i, 1, "impingement", *impingement_);
  }
  // Where the pressure becomes infinite, the boundary before it ends the run.
  const bool ends_before = !boundaries_.empty() && boundaries_.back().beyond == Regime::undefined;
  if (!ends_before && is_ahead(limit(settings_.law))) add_guard(k_limit, i, 1, "limit", limit(settings_.law));
  if (i != first_primary_) return;
  for (std::size_t lateral = 0; lateral < memory_.size(); ++lateral) {
    if (!is_lateral(lateral) || memory_[lateral].next >= lateral_boundaries_.size()) continue;
    const Boundary& boundary = lateral_boundaries_[memory_[lateral].next];
    if (is_ahead(boundary.approach)) add_guard(k_lateral_boundary, lateral, 1, boundary.event, boundary.approach);
  }
}

void System::guard_values(double xi, std::span<const double> y, std::span<double> values) {
  for (std::size_t g = 0; g < guards_.size(); ++g) {
    const auto own = static_cast<std::size_t>(guards_[g].index);
    const std::size_t i = is_lateral(own) ? first_primary_ : own;
    if (guards_[g].kind == k_lost && is_loaded(i)) {
      values[g] = told(i, xi) / ramps_[i].start;
      continue;
    }
    // Ramps are as short as contacts are shallow.
    const double scale = is_loaded(i) ? guard_places_[g] : std::max(std::abs(ramps_[i].start), std::abs(ramps_[i].end));
    // To the last digit what a force gives: it may end where it was before.
    const double near = displacement(i, xi, y);
    const double x = is_loaded(i) && is_known(i) ? displacement_under_force(i, told(i, xi), near) : near;
    values[g] = (x - guard_places_[g]) / scale;
  }
}

std::optional<DomainEnd> System::fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                      std::vector<Event>& log) {
  std::optional<DomainEnd> end;
  for (const std::size_t g : fired) {
    const Guard guard = guards_[g];
    const auto i = static_cast<std::size_t>(guard.index);
    Memory& memory = memory_[i];
    double x = displacement(is_lateral(i) ? first_primary_ : i, xi, y);
    if (!is_lateral(i)) farthest_ = std::max(farthest_, x);
    const Event event{guard.name, guard.index};
    if (!guard.name.empty() && guard.kind != k_reload) log.push_back(event);
    switch (guard.kind) {
      case k_made:
        memory.regime = first_regime(settings_.law);
        break;
      case k_touched:
        memory.regime = Regime::unloading;
        if (is_reloaded(i, x)) resume_loading(i, x, log);
        break;
      case k_boundary:
        if (boundaries_[memory.next].beyond == Regime::undefined) {
          end = DomainEnd{event, {"the particle fills its cell, where its pressure would be infinite", "gamma/2R", x}};
          break;
        }
        memory.regime = boundaries_[memory.next++].beyond;
        break;
      case k_lateral_boundary:
        ++memory.next;
        break;
      case k_impingement:
        memory.has_impinged = true;
        break;
      case k_reload:
        resume_loading(i, x, log);
        break;
      case k_lost:
        x = origin(i);
        lose_contact(i);
        break;
      default:
        end = DomainEnd{event, {"the walls meet", "gamma/2R", x}};
        break;
    }
    if (classes_[i].takes_force) y[places_[i]] = coordinate(i, x);
  }
  if (end) return end;
  settle_lateral();
  watch(xi, y);
  return std::nullopt;
}

// --- what is seen

double System::stored_energy(std::size_t i, double x) const {
  const Memory& memory = memory_[i];
  if (!touches(memory.regime) || x <= origin(i)) return 0.0;
  if (memory.regime == Regime::unloading) return mdr::unloading_energy(memory.indenter, x);
  if (memory.regime == Regime::elastic) return work_per_wall(settings_.law, x);
  return mdr::plastic_energy(indenter_at(i, x));
}

void System::observe(double xi, std::span<const double> y, std::span<double> values) {
  const double length = settings_.initial_radius;
  const double force_unit = settings_.strength * length * length;
  const double energy_unit = force_unit * length;
  auto out = values.begin();
  *out++ = y[work_place_] * energy_unit;
  if (settings_.unloading != Unloading::none) {
    double stored = 0.0;
    for (std::size_t i = 0; i < memory_.size(); ++i) {
      if (!is_lateral(i)) stored += classes_[i].multiplicity() * stored_energy(i, displacement(i, xi, y));
    }
    energies_.see(y[work_place_], stored);
    *out++ = stored * energy_unit;
    *out++ = (y[work_place_] - stored) * energy_unit;
  }
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    const double x = displacement(is_lateral(i) ? first_primary_ : i, xi, y);
    const Contact c = seen(i, xi, y);
    if (!is_lateral(i)) farthest_ = std::max(farthest_, x);
    *out++ = displacement(i, xi, y) * length;
    double overlap = x;
    if (is_lateral(i)) {
      // The approach that a lateral contact behaves as if it had.
      const Regime regime = memory_[i].regime;
      const bool is_in_small_range = regime == Regime::elastic || regime == Regime::elastic_plastic;
      overlap = regime == Regime::open ? 0.0
                : is_in_small_range    ? (x > 0.0 ? lateral_approach(*lateral_law_, x).value : 0.0)
                                       : k_nan;
    }
    *out++ = overlap * length;
    *out++ = c.force * force_unit;
    *out++ = c.contact_radius * length;
    *out++ = c.pressure * settings_.strength;
    *out++ = static_cast<double>(memory_[i].regime);
  }
}

double System::quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) {
  const auto i = static_cast<std::size_t>(contact_class);
  const Contact c = seen(i, xi, y);
  const double length = settings_.initial_radius;
  switch (quantity) {
    case Quantity::force:
      return c.force * settings_.strength * length * length;
    case Quantity::displacement:
      return displacement(i, xi, y) * length;
    case Quantity::pressure:
      return c.pressure * settings_.strength;
    case Quantity::contact_radius:
      return c.contact_radius * length;
    case Quantity::apparent_radius:
      return length;
    default:
      throw std::logic_error("no such quantity at a wall");
  }
}

double System::controlled(Control control, int contact_class, double xi, std::span<const double> y) {
  if (control == Control::force) return quantity(Quantity::force, contact_class, xi, y);
  // A ramp of displacement begins where the force of the last one has taken the wall, without an integrator's error.
  const auto i = static_cast<std::size_t>(contact_class);
  const double x = displacement(i, xi, y);
  const bool follows = is_loaded(i) && touches(memory_[i].regime);
  return (follows ? displacement_under_force(i, told(i, xi), x) : x) * settings_.initial_radius;
}

bool System::is_open(int contact_class) const noexcept {
  return !touches(memory_[static_cast<std::size_t>(contact_class)].regime);
}

/// Of the whole program: every contact is as shallow when it is made.
std::string_view System::difficulty(double /*xi*/, std::span<const double> /*y*/) {
  return is_shallow_ ? k_closes_nothing : std::string_view();
}

std::vector<Finding> System::warnings() const {
  std::vector<Finding> result;
  for (std::size_t k = 0; k < range_messages_.size(); ++k) {
    result.push_back({range_messages_[k], settings_.out_of_range[k].quantity, settings_.out_of_range[k].value});
  }
  if (farthest_ > calibrated_end(settings_.law)) {
    result.push_back({"the walls have gone farther than the source compares the law with its calculations",
                      "largest gamma/2R", farthest_});
  }
  if (has_lateral_gap_) {
    result.push_back({"the source has no law for lateral contacts in all of the range; their columns are empty there",
                      "largest gamma/2R", farthest_});
  }
  if (lateral_law_) {
    const double lambda = std::get<SemimechLaw>(settings_.law).material.modulus_over_yield;
    if (lambda < k_least_lateral_modulus_over_yield || lambda > k_greatest_lateral_modulus_over_yield) {
      result.push_back({"outside the range over which the lateral contacts were fitted, 163.08 to 4954.4",
                        "E/((1-nu^2) Y)", lambda});
    }
  }
  if (overshooting_) {
    result.push_back(
        {"a contact recovers more than it was compressed: so small a contact is not plastic enough for "
         "unloading = \"mdr\"",
         "recovery over displacement", *overshooting_});
  }
  if (const auto made = energies_.finding(
          "unloading = \"mdr\" creates energy: the contact is not plastic enough for it, or the particle is compressed "
          "as a whole")) {
    result.push_back(*made);
  }
  return result;
}

}  // namespace monograin::plastic
