#include "cel/system.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "system/resolution.hpp"

namespace monograin::cel {
namespace {

using std::string_view;

enum RegimeWord { k_open, k_elastic, k_plastic, k_unloaded };
constexpr std::array<string_view, 4> k_regime_words{"open", "elastic", "plastic", "unloaded"};

/// Fitted range of the law.
// E/Y of the softest and the stiffest material that the law is fitted to.
constexpr double k_least_modulus_over_yield = 6.25;
constexpr double k_largest_modulus_over_yield = 200.0;
constexpr double k_deepest = 0.5;
/// Stored energy, over the work, below which it is negative by more than round-off.
constexpr double k_least_stored = -1e-6;

/// Particle of a scene, with lengths over R0 and stresses over E.
Particle particle_of(const ModelInput& input, std::span<const ContactClass> classes, const Reach& reach) {
  const double modulus = input.material("youngs_modulus");
  const double poisson_ratio = input.material("poisson_ratio");
  const Material material(input.material("yield_stress") / modulus, poisson_ratio);
  const double force_unit = modulus * input.radius * input.radius;
  const double elastic = std::pow(0.75 * reach.force / (force_unit * material.Es), 2.0 / 3.0);
  const double depth = std::max(reach.displacement / input.radius, elastic);
  return {material, poisson_ratio, classes, input.centre_is_free, depth > 0.0 ? std::min(depth, 1.0) : 1.0};
}

/// Unknowns of a particle, then the work of the walls.
std::vector<Unknown> unknowns_of(const Particle& p, std::span<const ContactClass> classes) {
  const auto differential = Unknown::Kind::differential;
  const double depth = p.depth();
  std::vector<Unknown> unknowns;
  for (const ContactClass& c : classes)
    unknowns.push_back({.name = c.name, .kind = differential, .scale = depth, .is_algebraic_in_residual = true});
  for (std::size_t i = 0; i < classes.size(); ++i)
    unknowns.push_back({.name = "dent", .kind = differential, .scale = std::sqrt(depth)});
  for (std::size_t k = 0; k < p.layout().directions; ++k)
    unknowns.push_back({.name = contacts::k_centre_unknowns[k],
                        .kind = differential,
                        .scale = depth,
                        .is_algebraic_in_residual = true,
                        .may_be_undetermined = true});
  while (unknowns.size() < p.layout().size()) unknowns.push_back({.name = "core", .kind = differential});
  // Scale of the work: that of elastic contacts or of contacts that flow, whichever is less.
  const double work = depth * depth * std::min(std::sqrt(depth), p.material().Y);
  unknowns.push_back({.name = "work", .kind = Unknown::Kind::quadrature, .scale = work});
  return unknowns;
}

/// Rates that the program prescribes, over the largest: of displacements in the first column, of forces in the second.
Eigen::ArrayX2d direction_of(const Particle& p) {
  Eigen::ArrayX2d rates = Eigen::ArrayX2d::Zero(p.size(), 2);
  for (std::size_t i = 0; i < p.size(); ++i)
    rates(i, p.classes[i].is_force_controlled() ? 1 : 0) = p.classes[i].drive.rate();
  if (!p.is_at_rest()) rates /= rates.abs().maxCoeff();
  return rates;
}

}  // namespace

System::System(const ModelInput& input, std::vector<ContactClass> classes, const Reach& reach)
    : length_(input.radius),
      modulus_(input.material("youngs_modulus")),
      force_unit_(modulus_ * length_ * length_),
      modulus_over_yield_(modulus_ / input.material("yield_stress")),
      centre_is_free_(input.centre_is_free),
      classes_(std::move(classes)),
      particle_(particle_of(input, classes_, reach)),
      unknowns_(unknowns_of(particle_, classes_)),
      columns_({.free_centre = centre_is_free_}, k_regime_words, classes_,
               std::array<Observable, 2>{{{"core_strain", "-", {}}, {"coverage", "-", {}}}}),
      work_slot_(particle_.layout().size()),
      last_(unknowns_.size()),
      trial_(unknowns_.size()),
      state_(unknowns_.size()) {}

void System::start(std::span<double> y) {
  std::ranges::fill(y, 0.0);
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    y[i] = -classes_[i].gap / length_;
    y[particle_.layout().dent(i)] = particle_.material().a_Y;
    ClassState& c = particle_.classes[i];
    c.flows = c.is_released = c.touches = false;
    c.hold(y[i]);
  }
  has_begun_ = false;
  deepest_ = least_stored_ = 0.0;
}

// --- the forms of the equations

void System::complete(double xi, std::span<double> y) {
  particle_.prescribe(xi, y);
  if (!is_solvable_here()) return;
  // Begins with the last solution: its dents and core are without the round-off of integrators, and it is a better
  // guess than y, in which the unknowns rest.
  std::ranges::copy(y, trial_.begin());
  std::copy_n(last_.begin(), work_slot_, y.begin());
  try {
    solve(xi, y);
  } catch (const std::domain_error&) {
    std::ranges::copy(trial_, y.begin());
    solve(xi, y);
  }
}

void System::solve(double xi, std::span<double> y) {
  newton_.solve(particle_, xi, y);
  std::ranges::copy(y, last_.begin());
}

void System::rates(double xi, std::span<const double> y, std::span<double> dy) {
  motion_.evaluate(particle_, xi, y);
  if (particle_.any_flows())
    std::ranges::copy(motion_.drawn_rates(), dy.begin());
  else
    std::ranges::fill(dy, 0.0);
  dy[work_slot_] = motion_.power();
}

void System::residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) {
  if (!particle_.any_flows()) {
    std::ranges::copy(dy, res.begin());
    std::ranges::copy(y, state_.begin());
    complete(xi, state_);
    motion_.evaluate(particle_, xi, state_);
  } else {
    const Layout& layout = particle_.layout();
    particle_.evaluate(y);
    particle_.residual(xi, res);
    for (std::size_t i = 0; i < classes_.size(); ++i) {
      if (!particle_.classes[i].flows) res[layout.dent(i)] = dy[layout.dent(i)];
    }
    std::ranges::copy(dy, state_.begin());
    particle_.write_core_rates(state_);
    for (std::size_t j = layout.core(); j < layout.size(); ++j) res[j] = dy[j] - state_[j];
    motion_.evaluate(particle_, xi, y);
  }
  res[work_slot_] = dy[work_slot_] - motion_.power();
}

/// In elastic motion the work equals the stored energy, up to a constant.
std::optional<double> System::closed_quadrature(double xi, std::span<const double> y) {
  if (particle_.any_flows()) return std::nullopt;
  particle_.evaluate(y);
  return particle_.stored_energy() + particle_.centre.energy(xi, particle_.position());
}

// --- program and mode

/// Sets the ramp of a wall for a step; the state is evaluated.
void System::set_ramp(std::size_t i, const Ramp& ramp, std::span<double> y) {
  ClassState& c = particle_.classes[i];
  const bool is_by_force = ramp.control == Control::force;
  const bool presses_by_force = is_by_force && (ramp.start > 0.0 || ramp.end > 0.0);
  c.is_released = is_by_force && !presses_by_force;
  if (c.is_released) {
    if (c.is_force_controlled() || c.contact.u >= -particle_.slack(i))
      particle_.release_wall(i, y);
    else
      c.hold(c.displacement);
    return;
  }
  if (presses_by_force != c.is_force_controlled()) y[i] = presses_by_force ? c.contact.F : c.contact.u;
  c.drive = contacts::WallDrive(ramp, presses_by_force ? force_unit_ : length_);
}

void System::begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) {
  particle_.evaluate(y);
  const Eigen::ArrayX2d before = direction_of(particle_);
  for (std::size_t i = 0; i < ramps.size(); ++i) set_ramp(i, ramps[i], y);
  // If the new step continues in the direction of the last one, the spring keeps its rest position.
  const double turn = (direction_of(particle_) - before).abs().maxCoeff();
  if (turn > k_same_direction || particle_.centre.follows()) particle_.centre.rest_at(particle_.layout().centre_of(y));
  solve(0.0, y);
  const std::size_t first = log.size();
  decide_mode(particle_, motion_, 0.0, y, {}, log);
  leave_idle_walls(0.0, y, first, log);
  // Walls that touch the fresh particle are in contact from the start, without an event.
  if (!has_begun_) {
    std::erase_if(log, [this](const Event& e) {
      return e.name == "contact-made" && classes_[static_cast<std::size_t>(e.contact_class)].gap == 0.0;
    });
  }
  has_begun_ = true;
  particle_.follow_walls(0.0);
  // Contacts that begin to flow may be slightly off their yield function: this puts them on it.
  solve(0.0, y);
  if (const auto end = arm_guards(0.0, y)) throw CannotBegin(*end);
}

/// Arms the guards of a new mode.
/// @return reason to stop if the state is at a limit or beyond: after a contact stops flowing, the elastic path may not
/// exist
std::optional<DomainEnd> System::arm_guards(double xi, std::span<const double> y) {
  guards_.arm(particle_);
  if (guards_.list().empty()) return std::nullopt;
  motion_.evaluate(particle_, xi, y);
  return guards_.limit_met(particle_, motion_, xi);
}

void System::guard_values(double xi, std::span<const double> y, std::span<double> values) {
  motion_.evaluate(particle_, xi, y);
  guards_.values(particle_, motion_, xi, values);
}

std::optional<DomainEnd> System::fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                      std::vector<Event>& log) {
  particle_.evaluate(y);
  std::vector<Guard> guards;
  const std::size_t first = log.size();
  for (const std::size_t g : fired) {
    const Guard& guard = guards.emplace_back(guards_.list()[g]);
    if (is_limit(guard)) {
      log.push_back({guard.name});
      return end_at(guard, particle_, xi);
    }
    if (guard.kind != k_made && guard.kind != k_lost) continue;
    const std::size_t i = guard.list_index();
    ClassState& c = particle_.classes[i];
    // decide_mode() decides about the others. A guard that is only within the integrator's tolerance fires as well.
    if (!c.is_force_controlled() && !c.is_released) continue;
    c.touches = false;
    if (!guard.is_silent) log.push_back({guard.name, guard.index});
    // A released wall moves with the surface that it has met; a force-controlled wall that would pull is released.
    particle_.release_wall(i, y);
  }
  solve(xi, y);
  decide_mode(particle_, motion_, xi, y, guards, log);
  leave_idle_walls(xi, y, first, log);
  particle_.follow_walls(xi);
  const auto end = arm_guards(xi, y);
  if (end) log.push_back(end->event);
  return end;
}

/// Opens the contacts that no wall presses any more, once another one is lost.
/// @param first  of the events of this instant
void System::leave_idle_walls(double xi, std::span<double> y, std::size_t first, std::vector<Event>& log) {
  const auto is_lost = [](const Event& event) { return event.name == "contact-lost"; };
  if (std::none_of(log.begin() + static_cast<std::ptrdiff_t>(first), log.end(), is_lost)) return;
  particle_.evaluate(y);
  const std::optional<std::vector<std::size_t>> opened = particle_.leave_walls(y);
  if (!opened) return;
  for (const std::size_t i : *opened) log.push_back({"contact-lost", static_cast<int>(i)});
  solve(xi, y);
}

// --- observables

/// Numbers of a contact in a row, at the state that was evaluated.
contacts::VisibleContact System::visible(std::size_t i, double xi) const {
  const ClassState& c = particle_.classes[i];
  const double d = c.position(xi);
  // The weak spring of the centre leaves a small force in an open contact, which is no load.
  const double load = c.touches ? c.contact.F : 0.0;
  const double radius = c.touches ? std::sqrt(c.contact.area) : 0.0;
  const double area = std::numbers::pi * radius * radius;
  const int closed = c.flows ? k_plastic : c.dent.zeta > particle_.material().a_Y ? k_unloaded : k_elastic;
  return {.displacement = d * length_,
          .overlap = (d + particle_.approach_by_centre(i)) * length_,
          .force = load * force_unit_,
          .contact_radius = radius * length_,
          .pressure = area > 0.0 ? load / area * modulus_ : 0.0,
          .regime = static_cast<double>(c.touches ? closed : k_open)};
}

void System::observe(double xi, std::span<const double> y, std::span<double> values) {
  particle_.evaluate(y);
  contacts::Energies energies = contacts::k_no_energies;
  if (has_energies()) {
    const double energy_unit = force_unit_ * length_;
    energies = {y[work_slot_] * energy_unit, particle_.stored_energy() * energy_unit};
    if (y[work_slot_] > 0.0) least_stored_ = std::min(least_stored_, particle_.stored_energy() / y[work_slot_]);
  }
  const auto shown = [&](std::size_t i) {
    const contacts::VisibleContact contact = visible(i, xi);
    deepest_ = std::max(deepest_, contact.overlap / length_);
    return contact;
  };
  columns_.write(energies, classes_.size(), shown, values,
                 std::array{particle_.load().core.e, particle_.coverage().Om});
  if (centre_is_free_) {
    contacts::write_centre_columns(particle_.centre.lines().in_space(particle_.position()) * length_, values);
  }
}

double System::quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) {
  particle_.evaluate(y);
  const auto i = static_cast<std::size_t>(contact_class);
  return quantity_of(contacts::wall_of(visible(i, xi), length_), quantity);
}

double System::controlled(Control control, int contact_class, double xi, std::span<const double> y) {
  return quantity(control == Control::force ? Quantity::force : Quantity::displacement, contact_class, xi, y);
}

std::vector<Diagnostic> System::warnings() const {
  std::vector<Diagnostic> found;
  if (modulus_over_yield_ < k_least_modulus_over_yield)
    found.push_back({"E/Y is below 6.25, the softest material that the law is fitted to", "E/Y", modulus_over_yield_});
  if (modulus_over_yield_ > k_largest_modulus_over_yield)
    found.push_back({"E/Y is above 200, the stiffest material that the law is fitted to", "E/Y", modulus_over_yield_});
  if (deepest_ > k_deepest)
    found.push_back({"a wall goes beyond half the radius, where the law is not fitted", "overlap/R0", deepest_});
  if (least_stored_ < k_least_stored) {
    found.push_back(
        {"the stored energy is negative: contacts so wide act on each other more than on themselves, for which the law "
         "is not made",
         "least stored energy/work", least_stored_});
  }
  return found;
}

std::optional<Difficulty> System::difficulty(double xi, std::span<const double> y) {
  if (motion_.evaluate(particle_, xi, y) < k_hard_margin) return Difficulty::near_applicability_limit;
  const bool may_be_loose = particle_.layout().directions > 0;
  const auto is_loose = [this](const ClassState& c) { return c.touches && particle_.is_idle(c); };
  if (may_be_loose && std::ranges::any_of(particle_.classes, is_loose)) return Difficulty::singular_balance;
  return std::nullopt;
}

}  // namespace monograin::cel
