#include "compressible/contact_system.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "system/undefined.hpp"

namespace monograin::compressible {
namespace {

// In the order of Regime.
constexpr std::array<std::string_view, 4> k_regime_words{"open", "linear", "exponential", "unloading"};

// Guards, in the order in which they are applied.
enum Kind : int { k_made, k_transition, k_reload, k_lost, k_limit };

// Guards this share beyond the end of a ramp are watched too, and a wall this near to a place stands there.
constexpr double k_same_place = 1e-12;

// Share of a displacement that is rounding.
constexpr double k_rounding = 4.0 * std::numeric_limits<double>::epsilon();

bool reaches(double d, double place) noexcept { return d >= place * (1.0 - k_same_place); }

}  // namespace

ContactSystem::ContactSystem(ContactSettings settings, std::vector<ContactClass> classes)
    : settings_(std::move(settings)), classes_(std::move(classes)) {
  const double radius = settings_.initial_radius;
  const double force_unit = std::numbers::pi * radius * radius * settings_.yield_pressure;
  double reach = settings_.largest_displacement / radius;
  if (settings_.largest_force > 0.0) {
    reach = std::max(reach, displacement_under(settings_.law, settings_.largest_force / force_unit));
  }
  reach = reach > 0.0 ? std::min(reach, k_largest_displacement) : k_largest_displacement;
  memory_.resize(classes_.size());
  ramps_.resize(classes_.size());
  places_.resize(classes_.size());
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (!classes_[i].takes_force) continue;
    places_[i] = unknowns_.size();
    unknowns_.push_back({classes_[i].name, Unknown::Kind::differential, reach, true});
  }
  work_place_ = unknowns_.size();
  unknowns_.push_back({"work", Unknown::Kind::quadrature, loading_work(settings_.law, reach), false});

  for (const char* name : {"work", "stored_energy", "dissipation"}) observables_.push_back({name, "J", {}});
  for (const ContactClass& c : classes_) add_contact_columns(c.name, k_regime_words, observables_, false);
}

void ContactSystem::start(std::span<double> y) {
  std::ranges::fill(y, 0.0);
  memory_.assign(classes_.size(), Memory{});
  has_begun_ = false;
  clipped_ = 0;
  least_ratio_ = 1.0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const double gap = classes_[i].gap / settings_.initial_radius;
    ramps_[i] = {-gap, -gap, Control::displacement};
    memory_[i].resting = -gap;
    if (classes_[i].takes_force) y[places_[i]] = -gap;
  }
}

void ContactSystem::begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) {
  const double radius = settings_.initial_radius;
  for (std::size_t i = 0; i < ramps_.size(); ++i) {
    const bool takes_force = ramps[i].control == Control::force;
    const double unit = takes_force ? std::numbers::pi * radius * radius * settings_.yield_pressure : radius;
    const double stood = classes_[i].takes_force ? displacement_at(i, y[places_[i]]) : 0.0;
    ramps_[i] = {ramps[i].start / unit, ramps[i].end / unit, ramps[i].control};
    const double d = takes_force ? stood : ramps_[i].start;
    resolve_mode(i, d, log);
    if (!touches(i)) memory_[i].resting = d;
    if (!classes_[i].takes_force) continue;
    // The program prescribes the force; on a steep curve it would not come back from the place of its wall.
    y[places_[i]] = takes_force && touches(i) ? coordinate_under(i, std::max(ramps_[i].start, 0.0)) : coordinate(i, d);
  }
  has_begun_ = true;
  arm_guards();
}

/// Decides the regime of a contact at the start of a step.
void ContactSystem::resolve_mode(std::size_t i, double d, std::vector<Event>& log) {
  Memory& memory = memory_[i];
  const auto tell = [&](std::string_view event) { log.push_back({event, static_cast<int>(i)}); };
  if (!touches(i)) {
    const bool is_pressed = is_loaded(i) && ramps_[i].start > 0.0;
    if (direction(i) <= 0 && !is_pressed) return;
    if (!is_loaded(i) && d < opening(i)) return;
    make_contact(i);
    // A driven wall that touches the fresh particle is in contact from the start, without an event.
    if (has_begun_ || classes_[i].gap > 0.0) tell("contact-made");
    return;
  }
  if (direction(i) < 0) {
    if (memory.regime != Regime::unloading) turn_back(i, d, log);
    // From where a force has ended at nothing.
    if (touches(i) && (is_loaded(i) ? ramps_[i].start <= 0.0 : d <= opening(i))) {
      memory.regime = Regime::open;
      memory.resting = opening(i);
      tell("contact-lost");
    }
  } else if (direction(i) > 0) {
    // A boundary at which the last step ended is passed now.
    pass_boundaries(i, d, log);
    if (memory.regime != Regime::unloading && reaches(d, k_largest_displacement) &&
        goes_beyond(i, k_largest_displacement))
      throw DomainError({Limit::source_data_end, static_cast<int>(i), "displacement/R0", k_largest_displacement});
  }
}

int ContactSystem::direction(std::size_t i) const noexcept {
  return ramps_[i].end > ramps_[i].start ? 1 : ramps_[i].end < ramps_[i].start ? -1 : 0;
}

/// Displacement or force as the program says.
double ContactSystem::prescribed(std::size_t i, double xi) const noexcept {
  return std::lerp(ramps_[i].start, ramps_[i].end, xi);
}

/// Displacement at which a wall and the particle part, and meet.
double ContactSystem::opening(std::size_t i) const noexcept {
  return memory_[i].has_unloaded ? memory_[i].curve.separation() : 0.0;
}

/// Force that u is counted in.
double ContactSystem::unit_force(std::size_t i) const noexcept {
  return memory_[i].regime == Regime::unloading ? memory_[i].curve.force
                                                : force_in(settings_.law, Part::linear, settings_.law.transition);
}

/// Whether u is proportional to the force; otherwise it is the displacement.
bool ContactSystem::counts_force(std::size_t i) const noexcept {
  return is_loaded(i) && (memory_[i].regime == Regime::unloading || memory_[i].regime == Regime::exponential);
}

double ContactSystem::coordinate(std::size_t i, double d) const noexcept {
  return counts_force(i) ? unknowns_[places_[i]].scale * force_at(i, d) / unit_force(i) : d;
}

double ContactSystem::coordinate_under(std::size_t i, double force) const noexcept {
  return counts_force(i) ? unknowns_[places_[i]].scale * force / unit_force(i) : displacement_under_force(i, force);
}

/// Displacement that a coordinate stands for.
double ContactSystem::displacement_at(std::size_t i, double u) const noexcept {
  return counts_force(i) ? displacement_under_force(i, unit_force(i) * u / unknowns_[places_[i]].scale) : u;
}

double ContactSystem::displacement(std::size_t i, double xi, std::span<const double> y) const noexcept {
  return is_loaded(i) ? displacement_at(i, y[places_[i]]) : prescribed(i, xi);
}

double ContactSystem::displacement_under_force(std::size_t i, double force) const noexcept {
  const Memory& memory = memory_[i];
  switch (memory.regime) {
    case Regime::open:
      return memory.resting;
    case Regime::unloading:
      return unloading_displacement(memory.curve, force);
    case Regime::linear:
    case Regime::exponential:
      return displacement_under(settings_.law, force);
  }
  return k_nan;
}

/// Force on the present branch.
double ContactSystem::force_at(std::size_t i, double d) const noexcept {
  const Memory& memory = memory_[i];
  switch (memory.regime) {
    case Regime::open:
      return 0.0;
    case Regime::linear:
      return force_in(settings_.law, Part::linear, d);
    case Regime::exponential:
      return force_in(settings_.law, Part::exponential, d);
    case Regime::unloading:
      return unloading_force(memory.curve, d);
  }
  return k_nan;
}

double ContactSystem::force_of(std::size_t i, double xi, std::span<const double> y) const noexcept {
  if (is_loaded(i) && touches(i)) return state(i, y[places_[i]]).force;
  const double d = displacement(i, xi, y);
  const Memory& memory = memory_[i];
  // On a steep curve the rounding of a displacement shows: a wall that stands where it parts from the particle has, and
  // so has one beyond, which a ramp of hardly more than rounding may lead to before its end is found.
  const bool has_parted =
      memory.regime == Regime::unloading && d - memory.curve.separation() <= k_rounding * memory.curve.largest;
  // Of walls that meet the particle within rounding of one instant, and so together, one may still be short of it.
  const bool is_short = memory.regime == Regime::linear && d < 0.0;
  return has_parted || is_short ? 0.0 : force_at(i, d);
}

ContactSystem::State ContactSystem::state(std::size_t i, double u) const noexcept {
  const Memory& memory = memory_[i];
  switch (memory.regime) {
    case Regime::open:
      return {};
    case Regime::linear:
      return {force_at(i, u), settings_.law.stiffness, u};
    case Regime::exponential: {
      const double by_coordinate = unit_force(i) / unknowns_[places_[i]].scale;
      return {by_coordinate * u, by_coordinate, 1.0 / settings_.law.exponent};
    }
    case Regime::unloading: {
      const double by_coordinate = unit_force(i) / unknowns_[places_[i]].scale;
      const double distance = unloading_displacement(memory.curve, by_coordinate * u) - memory.curve.separation();
      return {by_coordinate * u, by_coordinate, distance / memory.curve.exponent};
    }
  }
  return {};
}

/// Rate of the work of one wall.
double ContactSystem::power(std::size_t i, double xi, std::span<const double> y) const noexcept {
  if (!touches(i)) return 0.0;
  const double speed = ramps_[i].end - ramps_[i].start;
  // F d' = F F'/(df/dd)
  return is_loaded(i) ? speed * state(i, y[places_[i]]).compliance : speed * force_at(i, prescribed(i, xi));
}

void ContactSystem::complete(double xi, std::span<double> y) {
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (!classes_[i].takes_force) continue;
    // The force of a wall is as exact as its displacement: the least error of a force that ends at nothing would be a
    // way to go, where the curve ends like a power.
    y[places_[i]] = is_loaded(i) ? coordinate_under(i, prescribed(i, xi)) : prescribed(i, xi);
  }
}

void ContactSystem::rates(double xi, std::span<const double> y, std::span<double> dy) {
  double sum = 0.0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    sum += classes_[i].multiplicity() * power(i, xi, y);
    if (!classes_[i].takes_force) continue;
    const double speed = ramps_[i].end - ramps_[i].start;
    double& rate = dy[places_[i]];
    if (is_loaded(i))
      rate = touches(i) ? speed / state(i, y[places_[i]]).by_coordinate : 0.0;
    else
      rate = speed;
  }
  dy[work_place_] = sum;
}

void ContactSystem::residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) {
  double sum = 0.0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    sum += classes_[i].multiplicity() * power(i, xi, y);
    if (!classes_[i].takes_force) continue;
    const double u = y[places_[i]];
    if (is_loaded(i) && touches(i)) {
      // In units of u, as the integrator weighs it.
      const State now = state(i, u);
      res[places_[i]] = (now.force - prescribed(i, xi)) / now.by_coordinate;
    } else {
      res[places_[i]] = u - (is_loaded(i) ? memory_[i].resting : prescribed(i, xi));
    }
  }
  res[work_place_] = dy[work_place_] - sum;
}

std::optional<double> ContactSystem::closed_quadrature(double xi, std::span<const double> y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const Memory& memory = memory_[i];
    if (!touches(i)) continue;
    const double d = displacement(i, xi, y);
    const Part part = memory.regime == Regime::linear ? Part::linear : Part::exponential;
    sum += classes_[i].multiplicity() *
           (memory.regime == Regime::unloading ? recoverable_work(memory.curve, d) : work_in(settings_.law, part, d));
  }
  return sum;
}

// --- transitions

void ContactSystem::make_contact(std::size_t i) {
  memory_[i].regime = memory_[i].has_unloaded ? Regime::unloading : Regime::linear;
  memory_[i].has_been_loaded = true;
}

/// Moves on from the ends of regimes that a rising wall has reached.
void ContactSystem::pass_boundaries(std::size_t i, double d, std::vector<Event>& log) {
  Memory& memory = memory_[i];
  if (memory.regime == Regime::unloading && reaches(d, memory.curve.largest)) {
    go_on_loading(i, memory.curve.largest);
    log.push_back({"reload", static_cast<int>(i)});
  }
  if (memory.regime == Regime::linear && reaches(d, settings_.law.transition)) {
    memory.regime = Regime::exponential;
    log.push_back({"transition", static_cast<int>(i)});
  }
}

/// Back on the loading law at the largest displacement so far.
void ContactSystem::go_on_loading(std::size_t i, double d) {
  memory_[i].has_unloaded = false;
  memory_[i].regime = reaches(d, settings_.law.transition) ? Regime::exponential : Regime::linear;
}

void ContactSystem::turn_back(std::size_t i, double d, std::vector<Event>& log) {
  Memory& memory = memory_[i];
  if (!(d > 0.0)) {  // pressed by nothing so far
    memory.regime = Regime::open;
    memory.resting = 0.0;
    return;
  }
  memory.curve = unloading_from(settings_.law, settings_.hertz_stiffness, settings_.unloading, d);
  memory.regime = Regime::unloading;
  memory.has_unloaded = true;
  log.push_back({"load-reversal", static_cast<int>(i)});
  if (memory.curve.is_clipped) ++clipped_;
}

void ContactSystem::add_guard(int kind, std::size_t i, int direction, std::string_view name, double place) {
  // A force is prescribed as a displacement is.
  guards_.push_back(
      {.kind = kind, .index = static_cast<int>(i), .direction = direction, .name = name, .is_exact = true});
  guard_places_.push_back(place);
}

/// Whether a rising wall ends beyond a place on its way.
bool ContactSystem::goes_beyond(std::size_t i, double place) const noexcept {
  const double end = is_loaded(i) ? displacement_under(settings_.law, ramps_[i].end) : ramps_[i].end;
  return end > place * (1.0 + k_same_place);
}

/// The guards that may fire before the end of the step.
void ContactSystem::arm_guards() {
  guards_.clear();
  guard_places_.clear();
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const Memory& memory = memory_[i];
    // What a rising step ends at is passed by the next one, if it goes on.
    const auto watch_rise = [&](int kind, std::string_view name, double place) {
      if (goes_beyond(i, place)) add_guard(kind, i, 1, name, place);
    };
    if (direction(i) < 0) {
      // A force that ends at nothing leaves the wall at the surface.
      const bool opens = is_loaded(i) ? ramps_[i].end < 0.0 : ramps_[i].end < opening(i);
      if (touches(i) && opens) add_guard(k_lost, i, -1, "contact-lost", opening(i));
      continue;
    }
    if (direction(i) == 0) continue;
    switch (memory.regime) {
      case Regime::open:
        if (!is_loaded(i) && ramps_[i].end > opening(i)) add_guard(k_made, i, 1, "contact-made", opening(i));
        break;
      case Regime::unloading:
        watch_rise(k_reload, "reload", memory.curve.largest);
        break;
      case Regime::linear:
        watch_rise(k_transition, "transition", settings_.law.transition);
        watch_rise(k_limit, "limit", k_largest_displacement);
        break;
      case Regime::exponential:
        watch_rise(k_limit, "limit", k_largest_displacement);
        break;
    }
  }
}

void ContactSystem::guard_values(double xi, std::span<const double> /*y*/, std::span<double> values) {
  for (std::size_t g = 0; g < guards_.size(); ++g) {
    const auto i = static_cast<std::size_t>(guards_[g].index);
    // The law is in closed form: where it is under a force follows from that force, free of an integrator's error.
    const double place = is_loaded(i) ? force_at(i, guard_places_[g]) : guard_places_[g];
    // Ramps are as short as contacts are shallow.
    values[g] = (prescribed(i, xi) - place) / std::max(std::abs(ramps_[i].start), std::abs(ramps_[i].end));
  }
}

std::optional<DomainEnd> ContactSystem::fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                             std::vector<Event>& log) {
  std::optional<DomainEnd> end;
  const auto end_at = [&](double place) {
    end = DomainEnd{log.back(), {Limit::source_data_end, log.back().contact_class, "displacement/R0", place}};
  };
  for (const std::size_t g : fired) {
    const Guard guard = guards_[g];
    const double place = guard_places_[g];
    const auto i = static_cast<std::size_t>(guard.index);
    Memory& memory = memory_[i];
    log.push_back({guard.name, guard.index});
    // A wall that goes on has passed what begins within rounding of here, or within one step of fixed length.
    const auto pass_on = [&](double from) {
      const double d =
          std::max(from, is_loaded(i) ? displacement_under(settings_.law, prescribed(i, xi)) : prescribed(i, xi));
      pass_boundaries(i, d, log);
      if (memory.regime == Regime::unloading || !reaches(d, k_largest_displacement)) return;
      if (!goes_beyond(i, k_largest_displacement)) return;
      log.push_back({"limit", guard.index});
      end_at(k_largest_displacement);
    };
    switch (guard.kind) {
      case k_made:
        make_contact(i);
        // A dent may be shallower than rounding of the place where the wall meets it.
        pass_on(place);
        break;
      case k_transition:
        memory.regime = Regime::exponential;
        break;
      case k_reload:
        go_on_loading(i, place);
        // The next part of the law may begin within rounding of the ramp.
        pass_on(place);
        break;
      case k_lost:
        memory.regime = Regime::open;
        memory.resting = place;
        break;
      default:
        end_at(place);
        break;
    }
    if (classes_[i].takes_force) y[places_[i]] = coordinate(i, place);
  }
  if (!end) arm_guards();
  return end;
}

// --- what is seen

/// Unloading from here: along the present curve, or that which would begin here.
UnloadingCurve ContactSystem::way_back(std::size_t i, double d) const noexcept {
  if (memory_[i].regime == Regime::unloading) return memory_[i].curve;
  return unloading_from(settings_.law, settings_.hertz_stiffness, settings_.unloading, d);
}

void ContactSystem::observe(double xi, std::span<const double> y, std::span<double> values) {
  const double length = settings_.initial_radius;
  const double force_unit = std::numbers::pi * length * length * settings_.yield_pressure;
  const double energy_unit = force_unit * length;
  double stored = 0.0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const double d = displacement(i, xi, y);
    if (!touches(i) || d <= opening(i)) continue;
    const UnloadingCurve curve = way_back(i, d);
    stored += classes_[i].multiplicity() * recoverable_work(curve, d);
    least_ratio_ = std::min(least_ratio_, slope_ratio(settings_.law, curve));
  }
  auto out = values.begin();
  *out++ = y[work_place_] * energy_unit;
  *out++ = stored * energy_unit;
  *out++ = (y[work_place_] - stored) * energy_unit;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const double d = displacement(i, xi, y);
    *out++ = d * length;
    *out++ = d * length;  // the apparent radius does not change
    *out++ = force_of(i, xi, y) * force_unit;
    *out++ = static_cast<double>(memory_[i].regime);
  }
}

double ContactSystem::quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) {
  const auto i = static_cast<std::size_t>(contact_class);
  const double length = settings_.initial_radius;
  switch (quantity) {
    case Quantity::force:
      return force_of(i, xi, y) * std::numbers::pi * length * length * settings_.yield_pressure;
    case Quantity::displacement:
      return displacement(i, xi, y) * length;
    case Quantity::apparent_radius:
      return length;
    default:
      throw std::logic_error("no such quantity at a wall of this model");
  }
}

double ContactSystem::controlled(Control control, int contact_class, double xi, std::span<const double> y) {
  if (control == Control::force) return quantity(Quantity::force, contact_class, xi, y);
  return displacement(static_cast<std::size_t>(contact_class), xi, y) * settings_.initial_radius;
}

bool ContactSystem::is_open(int contact_class) const noexcept {
  return !touches(static_cast<std::size_t>(contact_class));
}

std::vector<Diagnostic> ContactSystem::warnings() const {
  std::vector<Diagnostic> found = settings_.reservations;
  double loaded = 0.0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (memory_[i].has_been_loaded) loaded += classes_[i].multiplicity();
  }
  if (loaded > 2.0) {
    found.push_back({"the law was derived between two walls; contacts of one particle do not know of each other",
                     "loaded walls", loaded});
  }
  if (clipped_ > 0) {
    found.push_back(
        {"unloading would have ended before first touch, and ends there instead: so small a contact is "
         "stiffer than Hertz's",
         "such unloadings", static_cast<double>(clipped_)});
  }
  if (least_ratio_ < 1.0 - k_same_place) {
    found.push_back({"unloading is, or would be, less steep than loading: the cycle may give back more than it took",
                     "least slope over that of loading", least_ratio_});
  }
  return found;
}

}  // namespace monograin::compressible
