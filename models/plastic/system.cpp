#include "plastic/system.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "system/difficulty.hpp"
#include "system/undefined.hpp"

namespace monograin::plastic {
namespace {

using std::numbers::pi;

// In the order of Regime.
constexpr std::array<std::string_view, 9> k_regime_words{
    "open",      "elastic",   "elastic-plastic", "fully-plastic", "low-compressibility", "elastic-volumetric",
    "undefined", "unloading", "separated"};

// Nearer to the place where a branch begins, over its length, the force is taken as linear in u.
constexpr double k_nearest_touch = 1e-100;
constexpr double k_nearest_opening = 1e-7;
constexpr double k_opening_power = 1.5;
// Share of a ramp that takes no time: integrators do not step so far.
constexpr double k_instant = 1e-13;
// Share of a prescribed value that is rounding.
constexpr double k_rounding = 16.0 * std::numeric_limits<double>::epsilon();
// Depth over R0 below which a contact is rounding.
constexpr double k_least_depth = 1e-12;
// Contacts shallower than this over R0 have no digits left where a ramp takes the wall there.
constexpr double k_least_typical = 1e-7;

double signed_power(double x, double exponent) noexcept { return std::copysign(std::pow(std::abs(x), exponent), x); }

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
    // A depth that follows from a force has digits, however shallow.
    const double least = settings_.largest_displacement > 0.0 ? k_least_typical : 0.0;
    const double typical = std::max(first, least);
    unknowns_.push_back({classes_[i].name, Unknown::Kind::differential, std::pow(typical, first_power(law)), true});
  }
  work_place_ = unknowns_.size();
  // Beyond where the law is fitted work grows by orders, and a condition may end a program long before its targets.
  const double typical_end = std::min(reach, calibrated_end(law));
  unknowns_.push_back({"work", Unknown::Kind::quadrature, work_per_wall(law, typical_end), false});

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
  std::vector<double> begins(ramps_.size());
  for (std::size_t i = 0; i < ramps_.size(); ++i) {
    const double unit = ramps[i].control == Control::force ? settings_.strength * length * length : length;
    const double stood = classes_[i].takes_force ? displacement_at(i, y[places_[i]]) : 0.0;
    const Ramp last = std::exchange(ramps_[i], {ramps[i].start / unit, ramps[i].end / unit, ramps[i].control});
    if (is_lateral(i)) continue;
    if (directions_[i] == 0 && last.control == ramps_[i].control) ramps_[i].start = last.end;
    // Where a wall has left its dent, the rounding of its units must not press it in again.
    const bool stands_at_dent = std::abs(ramps_[i].start - origin(i)) <= k_rounding * origin(i);
    if (memory_[i].regime == Regime::separated && !is_loaded(i) && stands_at_dent) ramps_[i].start = origin(i);
    const double x = is_loaded(i) ? stood : ramps_[i].start;
    directions_[i] = direction_of_ramp(i, x);
    // A wall that goes nowhere stays, for as long as the program says: from the end of such a ramp a force might have
    // it go back. A force is the prescribed one, however stiff the contact.
    if (directions_[i] == 0 && !is_loaded(i)) ramps_[i].end = ramps_[i].start;
    begins[i] = x;
    // A step that cannot begin is shown where it would have, in its own coordinates.
    if (classes_[i].takes_force) y[places_[i]] = coordinate(i, x);
  }
  for (std::size_t i = 0; i < ramps_.size(); ++i) {
    if (is_lateral(i)) continue;
    double x = begins[i];
    if (touches(memory_[i].regime)) {
      // A wall that has only touched leaves no dent.
      const bool has_pressed = x > (is_loaded(i) ? 0.0 : k_least_depth);
      if (direction(i) < 0 && memory_[i].is_on_primary_branch && has_pressed) {
        // By the law: with an integrator's error in it, the force that it had would not bring the wall back to there.
        if (is_loaded(i)) x = displacement_under_force(i, ramps_[i].start, x);
        // Where the law has no branch for that, the run ends in this state.
        if (classes_[i].takes_force) y[places_[i]] = coordinate(i, x);
        turn_back(i, x, log);
      }
      // From there, and where a force ends at nothing or has so far to go below that it does so at once.
      const bool is_left = memory_[i].is_on_primary_branch ? !has_pressed
                           : is_loaded(i)                  ? prescribed(i, k_instant) <= 0.0
                                                           : x <= origin(i);
      if (direction(i) < 0 && is_left) {
        if (!memory_[i].is_on_primary_branch) {
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
  resolve_lateral();
  arm_guards(0.0, y);
}

/// A ramp that rounding has left between two equal values goes nowhere. A force under which a wall stands has the
/// rounding of its place, too, and a place where a force has left it, however long ago, has that of the force and of
/// its coordinate.
int System::direction_of_ramp(std::size_t i, double x) const {
  const double way = ramps_[i].end - ramps_[i].start;
  double size = std::max(std::abs(ramps_[i].start), std::abs(ramps_[i].end));
  if (is_loaded(i)) {
    size += contact(i, x).stiffness * x;
  } else if (classes_[i].takes_force && touches(memory_[i].regime)) {
    const Contact now = contact(i, x);
    if (now.stiffness > 0.0) size += now.force / now.stiffness + std::abs(x);
  }
  if (std::abs(way) <= k_rounding * size) return 0;
  return way > 0.0 ? 1 : -1;
}

/// Whether a contact that comes in is at its largest displacement, or nearer to it than a ramp can tell.
bool System::is_reloaded(std::size_t i, double x) const {
  const Memory& memory = memory_[i];
  if (direction(i) <= 0 || memory.is_on_primary_branch) return false;
  if (is_loaded(i)) return x >= memory.largest || prescribed(i, k_instant) >= memory.largest_force;
  return x >= memory.largest - k_instant * (ramps_[i].end - ramps_[i].start);
}

/// Displacement or force as the program says.
double System::prescribed(std::size_t i, double xi) const noexcept {
  return std::lerp(ramps_[i].start, ramps_[i].end, xi);
}

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
  return is_loaded(i) ? displacement_at(i, y[places_[i]]) : prescribed(i, xi);
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
  if (presses(i) && c.contact_radius > 0.0) {
    c.force = prescribed(i, xi);
    c.pressure = c.force / (pi * c.contact_radius * c.contact_radius);
  }
  return c;
}

System::Contact System::seen_on_indenter(const mdr::Contact& c) noexcept {
  const double area = pi * c.contact_radius * c.contact_radius;
  return {c.force, c.by_overlap, c.contact_radius, area > 0.0 ? c.force / area : 0.0};
}

/// A contact at a displacement of its wall.
System::Contact System::contact(std::size_t i, double x) const {
  const Memory& memory = memory_[i];
  if (is_lateral(i)) return lateral_contact(i, x);
  if (!touches(memory.regime) || x <= origin(i)) return {};
  if (memory.regime == Regime::unloading) {
    return seen_on_indenter(mdr::unloading_contact(memory.indenter, modulus_, x));
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

/// A contact at a distance from where the force of its present branch begins, over the chart's length: where that is a
/// small share of the displacement, the displacement has not its digits.
System::Contact System::contact_at_distance(std::size_t i, double distance) const {
  const Memory& memory = memory_[i];
  if (memory.regime != Regime::unloading) return contact(i, chart(i).origin + chart(i).length * distance);
  return seen_on_indenter(mdr::recompressed_contact(memory.indenter, modulus_, distance));
}

/// Force and its derivatives at a coordinate of a touching contact; odd in u, so that a trial step below zero stays
/// smooth.
System::Slope System::slope(std::size_t i, double u) const {
  const auto [origin, length, unit, power] = chart(i);
  const double nearest = is_on_indenter(i) ? k_nearest_opening : k_nearest_touch;
  const double distance = std::pow(std::abs(u) / unit, 1.0 / power);  // over the length
  const double by_displacement = stretch(i, length * distance);       // du/dx
  if (distance <= nearest) {
    const double by_coordinate = contact_at_distance(i, nearest).force / (unit * std::pow(nearest, power));
    return {by_coordinate * u, by_coordinate, by_coordinate * by_displacement};
  }
  const Contact c = contact_at_distance(i, distance);
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
  const double control = prescribed(i, xi);
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
    y[places_[i]] = coordinate(i, is_loaded(i) ? displacement_under_force(i, prescribed(i, xi), now) : now);
  }
}

void System::rates(double xi, std::span<const double> y, std::span<double> dy) {
  double total = 0.0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (is_lateral(i)) continue;
    const double speed = ramps_[i].end - ramps_[i].start;
    const Slope now = presses(i) ? slope(i, y[places_[i]]) : Slope{};
    total += power(i, xi, now);
    if (!classes_[i].takes_force) continue;
    if (is_loaded(i))
      dy[places_[i]] = now.by_coordinate > 0.0 ? speed / now.by_coordinate : 0.0;
    else
      dy[places_[i]] = speed;
  }
  dy[work_place_] = total;
}

/// Rate of the work of the walls of a class; where they press under a force, with the slope of that.
double System::power(std::size_t i, double xi, const Slope& now) const {
  const double rate = classes_[i].multiplicity() * (ramps_[i].end - ramps_[i].start);
  if (!is_loaded(i)) return rate * contact(i, prescribed(i, xi)).force;
  return now.by_displacement > 0.0 ? rate * prescribed(i, xi) / now.by_displacement : 0.0;
}

void System::residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) {
  double total = 0.0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (is_lateral(i)) continue;
    const double u = classes_[i].takes_force ? y[places_[i]] : 0.0;
    const double place = classes_[i].takes_force && is_known(i) ? known_coordinate(i, xi, y) : u;
    const Slope now = presses(i) ? slope(i, place) : Slope{};
    total += power(i, xi, now);
    if (!classes_[i].takes_force) continue;
    // In units of u, as the integrator weighs it.
    res[places_[i]] = is_known(i) ? u - place : (now.force - prescribed(i, xi)) / now.by_coordinate;
  }
  res[work_place_] = dy[work_place_] - total;
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

}  // namespace monograin::plastic
