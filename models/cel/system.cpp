#include "cel/system.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "contacts/side_ahead.hpp"

namespace monograin::cel {
namespace {

using std::string_view;
using std::numbers::pi;

enum RegimeWord { k_open, k_elastic, k_plastic, k_unloaded };
constexpr std::array<string_view, 4> k_regime_words{"open", "elastic", "plastic", "unloaded"};

/// Elastic displacement, over the program's depth, that is round-off; more than the tolerance of a located guard.
constexpr double k_touch = 4e-13;
/// Elastic displacement, over the program's depth, of a contact that may be idle and only carry a free centre along: no
/// integrator is exact enough to show that such a contact bears.
constexpr double k_idle_touch = 1e-8;
/// Distance of the yield function from zero up to which a contact may flow.
constexpr double k_at_yield = 1e-9;
/// Value of the yield function at which its guard fires; more than round-off of a contact that just stopped flowing.
constexpr double k_beyond_yield = 1e-12;
/// Least rate of the yield function at which a contact at yield begins to flow.
constexpr double k_least_rate = 1e-13;
/// Relative difference of the rates of dents that is round-off.
constexpr double k_alike = 1e-6;
/// Margin to a fold (Particle::rates()) at which a run ends: the stiffness is infinite at the fold.
constexpr double k_least_margin = 1e-5;
/// Margin to a fold below which the equations are hard to integrate.
constexpr double k_hard_margin = 1e-3;
/// Rate, per step coordinate, at which an integrated state is drawn back to the equations: its errors would otherwise
/// add up. Next to the beginning of flow, where contacts may be very shallow, the rate is k_first_pull over the
/// distance from there: times the length of a first step it is below one, so that correctors converge. k_nearest_flow
/// keeps the rate smooth for the shortest steps.
constexpr double k_pull = 20.0;
constexpr double k_first_pull = 0.5;
constexpr double k_nearest_flow = 1e-9;
/// Largest coverage to which the law is fitted: half the contact area over pi R0^2, which is 2 for the whole surface.
constexpr double k_most_coverage = 1.7;
/// Fitted range of the law.
constexpr double k_least_modulus_over_yield = 6.25;
constexpr double k_deepest = 0.5;

/// True if a program goes on in the same direction, to within round-off, as where a step is cut in two.
bool goes_on(const Eigen::ArrayX2d& before, const Eigen::ArrayX2d& after) {
  constexpr double k_alike_directions = 1e-9;
  const double a = before.abs().maxCoeff();
  const double b = after.abs().maxCoeff();
  if (a == 0.0 || b == 0.0) return a == b;
  return (before / a - after / b).abs().maxCoeff() <= k_alike_directions;
}

}  // namespace

System::System(const Settings& settings, std::vector<ContactClass> classes)
    : settings_(settings),
      classes_(std::move(classes)),
      particle_(Material(settings.yield_stress / settings.youngs_modulus, settings.poisson_ratio),
                settings.poisson_ratio, classes_, settings.centre_is_free),
      columns_(true, true, k_regime_words, classes_, settings.centre_is_free,
               std::array<Observable, 2>{{{"core_strain", "-", {}}, {"coverage", "-", {}}}}) {
  const double elastic = std::pow(0.75 * settings_.reach.force / (force_unit() * particle_.material().Es), 2.0 / 3.0);
  depth_ = std::max(settings_.reach.displacement / settings_.initial_radius, elastic);
  depth_ = depth_ > 0.0 ? std::min(depth_, 1.0) : 1.0;

  const auto differential = Unknown::Kind::differential;
  for (const ContactClass& c : classes_)
    unknowns_.push_back({.name = c.name, .kind = differential, .scale = depth_, .is_implicitly_algebraic = true});
  for (std::size_t i = 0; i < classes_.size(); ++i)
    unknowns_.push_back({.name = "dent", .kind = differential, .scale = std::sqrt(depth_)});
  for (std::size_t d = 0; d < particle_.layout().directions(); ++d)
    unknowns_.push_back({.name = contacts::k_centre_unknowns[d],
                         .kind = differential,
                         .scale = depth_,
                         .is_implicitly_algebraic = true,
                         .may_rest = true});
  while (unknowns_.size() < particle_.layout().size()) unknowns_.push_back({.name = "core", .kind = differential});
  work_place_ = unknowns_.size();
  // Scale of the work: that of elastic contacts or of contacts that flow, whichever is less.
  const double work = depth_ * depth_ * std::min(std::sqrt(depth_), particle_.material().Y);
  unknowns_.push_back({.name = "work", .kind = Unknown::Kind::quadrature, .scale = work});
  rates_.resize(unknowns_.size());
  last_.resize(unknowns_.size());
  trial_.resize(unknowns_.size());
  state_.resize(unknowns_.size());
}

double System::force_unit() const noexcept {
  return settings_.youngs_modulus * settings_.initial_radius * settings_.initial_radius;
}

bool System::is_solvable_here() const noexcept { return is_solvable() || !particle_.any_flows(); }

bool System::is_at_rest() const noexcept {
  return std::ranges::all_of(particle_.classes(), [](const ClassState& c) { return c.drive.rate() == 0.0; });
}

void System::start(std::span<double> y) {
  const Layout& layout = particle_.layout();
  std::ranges::fill(y, 0.0);
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const double gap = classes_[i].gap / settings_.initial_radius;
    y[layout.coordinate(i)] = -gap;
    y[layout.dent(i)] = particle_.material().a_Y;
    ClassState& c = particle_.at(i);
    c.flows = c.gives_way = c.touches = false;
    hold(i, -gap);
  }
  particle_.forget();
  has_begun_ = false;
  deepest_ = 0.0;
}

// --- the state at an instant

void System::evaluate(std::span<const double> y) {
  if (particle_.evaluate(y)) forget_rates();
}

/// Evaluates the rates of all unknowns, into rates_.
/// @return the margin to a fold
double System::evaluate_rates(double xi, std::span<const double> y) {
  evaluate(y);
  if (xi == rates_at_) return margin_;
  const double pull = xi > flow_begin_ ? std::max(k_pull, k_first_pull / (xi - flow_begin_ + k_nearest_flow)) : k_pull;
  margin_ = particle_.rates(rates_, xi, pull);
  rates_at_ = xi;
  return margin_;
}

void System::complete(double xi, std::span<double> y) {
  particle_.prescribe(xi, y);
  if (!is_solvable_here()) return;
  // Begins with the last solution: its dents and core are without the round-off of integrators, and it is a better
  // guess than y, in which the unknowns rest.
  std::ranges::copy(y, trial_.begin());
  std::copy_n(last_.begin(), work_place_, y.begin());
  try {
    solve(xi, y);
  } catch (const std::domain_error&) {
    std::ranges::copy(trial_, y.begin());
    solve(xi, y);
  }
}

void System::solve(double xi, std::span<double> y) {
  forget_rates();
  particle_.solve(xi, y);
  std::ranges::copy(y, last_.begin());
}

void System::rates(double xi, std::span<const double> y, std::span<double> dy) {
  evaluate_rates(xi, y);
  if (particle_.any_flows())
    std::ranges::copy(rates_, dy.begin());
  else
    std::ranges::fill(dy, 0.0);
  dy[work_place_] = particle_.power();
}

void System::residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) {
  if (!particle_.any_flows()) {
    std::ranges::copy(dy, res.begin());
    std::ranges::copy(y, state_.begin());
    complete(xi, state_);
    evaluate_rates(xi, state_);
  } else {
    const Layout& layout = particle_.layout();
    evaluate(y);
    particle_.residual(xi, res);
    for (std::size_t i = 0; i < classes_.size(); ++i) {
      if (!particle_.at(i).flows) res[layout.dent(i)] = dy[layout.dent(i)];
    }
    std::ranges::copy(dy, state_.begin());
    particle_.let_core_flow(state_);
    for (std::size_t j = layout.core(); j < layout.size(); ++j) res[j] = dy[j] - state_[j];
    evaluate_rates(xi, y);
  }
  res[work_place_] = dy[work_place_] - particle_.power();
}

/// In elastic motion the work equals the stored energy, up to a constant.
std::optional<double> System::closed_quadrature(double /*xi*/, std::span<const double> y) {
  if (particle_.any_flows()) return std::nullopt;
  evaluate(y);
  return particle_.stored_energy() + particle_.spring_energy();
}

// --- the program

/// Lets a wall rest at a displacement over R0.
void System::hold(std::size_t i, double displacement) {
  particle_.at(i).takes_force = false;
  particle_.at(i).drive = contacts::WallDrive({displacement, displacement, Control::displacement}, 1.0);
}

/// Lets a wall move with the surface and bear no force.
void System::give_way(std::size_t i, std::span<double> y) {
  ClassState& c = particle_.at(i);
  c.takes_force = c.gives_way = true;
  c.drive = contacts::WallDrive({0.0, 0.0, Control::force}, 1.0);
  y[particle_.layout().coordinate(i)] = 0.0;
  particle_.forget();
}

/// Takes up the ramp of a step; the state is evaluated.
void System::take_up(std::size_t i, const Ramp& ramp, std::span<double> y) {
  ClassState& c = particle_.at(i);
  const bool takes_force = ramp.control == Control::force && (ramp.start > 0.0 || ramp.end > 0.0);
  double& coordinate = y[particle_.layout().coordinate(i)];
  c.gives_way = ramp.control == Control::force && !takes_force;
  if (c.gives_way) {
    if (c.takes_force || c.contact.u >= -slack(i))
      give_way(i, y);
    else
      hold(i, c.displacement);
    return;
  }
  if (takes_force != c.takes_force) coordinate = takes_force ? c.contact.F : c.contact.u;
  c.takes_force = takes_force;
  c.drive = contacts::WallDrive(ramp, takes_force ? force_unit() : settings_.initial_radius);
}

/// Rates that the program prescribes: of displacements in the first column, of forces in the second.
Eigen::ArrayX2d System::velocities() const {
  Eigen::ArrayX2d rates = Eigen::ArrayX2d::Zero(static_cast<Eigen::Index>(classes_.size()), 2);
  Eigen::Index i = 0;
  for (const ClassState& c : particle_.classes()) rates(i++, c.takes_force ? 1 : 0) = c.drive.rate();
  return rates;
}

void System::begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) {
  evaluate(y);
  const Eigen::ArrayX2d before = velocities();
  for (std::size_t i = 0; i < ramps.size(); ++i) take_up(i, ramps[i], y);
  particle_.forget();
  if (!goes_on(before, velocities())) particle_.rest_centre(y);
  solve(0.0, y);
  decide_mode(0.0, y, log, {});
  // Contacts that begin to flow may be up to k_at_yield off their yield function: this puts them on it.
  solve(0.0, y);
  has_begun_ = true;
  arm_guards();
  if (const auto end = limit_here(0.0, y)) throw CannotBegin(*end);
}

/// Reason to stop if the state is at a limit or beyond: after a contact stops flowing, the elastic path may not exist.
std::optional<DomainEnd> System::limit_here(double xi, std::span<const double> y) {
  if (guards_.empty()) return std::nullopt;
  const double margin = evaluate_rates(xi, y);
  for (const Guard& guard : guards_) {
    if (guard.kind >= k_fold && limit_value(guard, margin) <= 0.0) return end_at(guard, xi);
  }
  return std::nullopt;
}

// --- modes

/// Elastic displacement of a contact at the first trial instant ahead at which it is clearly open or closed, or else 0.
double System::displacement_ahead(std::size_t i, double xi, std::span<const double> y) const {
  Particle ahead = particle_;
  const auto at = [&](double later) {
    std::vector<double> state(y.begin(), y.end());
    for (std::size_t j = 0; j < work_place_; ++j) state[j] += (later - xi) * rates_[j];
    ahead.solve(later, state);
    return state[particle_.layout().coordinate(i)];
  };
  return contacts::side_ahead(xi, k_touch * depth_, at).value_or(0.0);
}

/// Elastic displacement (over R0) up to which a contact is neither clearly open nor clearly closed.
double System::slack(std::size_t i) const noexcept {
  const bool may_carry = particle_.layout().directions() > 0 && particle_.at(i).touches;
  return (may_carry ? k_idle_touch : k_touch) * depth_;
}

/// Decides whether a contact touches from here on: by its elastic displacement or, if that is within slack(), by the
/// displacement a little later.
void System::decide_touch(std::size_t i, double xi, std::span<const double> y, std::vector<Event>& log) {
  ClassState& c = particle_.at(i);
  const bool touches = c.takes_force                      ? c.contact.F > 0.0 || c.drive.rate() > 0.0
                       : std::abs(c.contact.u) > slack(i) ? c.contact.u > 0.0
                                                          : displacement_ahead(i, xi, y) > 0.0;
  if (touches == c.touches) return;
  c.touches = touches;
  // Walls that touch the fresh particle are in contact from the start, without an event.
  if (has_begun_ || classes_[i].gap > 0.0)
    log.push_back({touches ? "contact-made" : "contact-lost", static_cast<int>(i)});
}

/// Finds the largest set of contacts that can flow together. Takes in all contacts at yield whose yield function would
/// rise if they did not flow, and drops contacts whose dents would then shrink: first those that would shrink fastest,
/// equal ones together, and for good, so that the order of the walls does not matter.
void System::decide_flow(double xi, std::span<const double> y) {
  for (ClassState& c : particle_.classes()) c.flows = false;
  forget_rates();
  for (bool has_changed = true; has_changed;) {
    evaluate_rates(xi, y);
    double worst = 0.0;
    for (std::size_t i = 0; i < particle_.size(); ++i) {
      if (particle_.at(i).flows) worst = std::min(worst, particle_.dent_rate(i));
    }
    has_changed = worst < 0.0;
    for (std::size_t i = 0; i < particle_.size(); ++i) {
      ClassState& c = particle_.at(i);
      if (worst < 0.0) {
        if (c.flows && particle_.dent_rate(i) <= worst * (1.0 - k_alike)) c.flows = c.may_flow = false;
      } else if (!c.flows && c.may_flow && c.touches && c.f > -k_at_yield && particle_.yield_rate(i) > k_least_rate) {
        c.flows = has_changed = true;
      }
    }
    if (has_changed) forget_rates();
  }
}

/// Decides which contacts touch and which flow from here on.
/// @param fired  guards that have just fired
void System::decide_mode(double xi, std::span<const double> y, std::vector<Event>& log,
                         std::span<const std::size_t> fired) {
  evaluate_rates(xi, y);
  const auto has_fired = [&](int kind, std::size_t i) {
    return std::ranges::any_of(
        fired, [&](std::size_t g) { return guards_[g].kind == kind && guards_[g].index == static_cast<int>(i); });
  };
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (!has_fired(k_made, i) && !has_fired(k_lost, i)) decide_touch(i, xi, y, log);
  }
  if (is_at_rest()) return;
  std::vector<char> flowed;
  for (const ClassState& c : particle_.classes()) flowed.push_back(c.flows);
  // A dent that has just come to rest does not grow at this instant.
  for (std::size_t i = 0; i < classes_.size(); ++i) particle_.at(i).may_flow = !has_fired(k_reversal, i);
  decide_flow(xi, y);
  flow_begin_ = xi;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const bool flows = particle_.at(i).flows;
    if (flows != (flowed[i] != 0)) log.push_back({flows ? "yield" : "load-reversal", static_cast<int>(i)});
  }
}

void System::arm_guards() {
  guards_.clear();
  if (is_at_rest()) return;
  const auto add = [this](int kind, int index, int direction, string_view name) {
    guards_.push_back({.kind = kind, .index = index, .direction = direction, .name = name});
  };
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const int index = static_cast<int>(i);
    const ClassState& c = particle_.at(i);
    if (!c.takes_force) {
      add(c.touches ? k_lost : k_made, index, c.touches ? -1 : 1, c.touches ? "contact-lost" : "contact-made");
      guards_.back().is_silent = c.gives_way;
    } else if (c.drive.end() < 0.0) {
      add(k_lost, index, -1, "contact-lost");
      guards_.back().is_exact = guards_.back().is_monotone = true;
    }
    if (!c.touches) continue;
    add(c.flows ? k_reversal : k_yield, index, c.flows ? -1 : 1, c.flows ? "load-reversal" : "yield");
  }
  add(k_fold, -1, -1, "limit");
  add(k_coverage, -1, -1, "limit");
}

void System::guard_values(double xi, std::span<const double> y, std::span<double> values) {
  const double margin = evaluate_rates(xi, y);
  for (std::size_t g = 0; g < guards_.size(); ++g) {
    const auto i = static_cast<std::size_t>(std::max(0, guards_[g].index));
    const ClassState& c = particle_.at(i);
    switch (guards_[g].kind) {
      case k_made:
        values[g] = (c.contact.u - slack(i)) / depth_;
        break;
      case k_lost:
        values[g] = c.takes_force ? c.drive.value(xi) / c.drive.size() : (c.contact.u + slack(i)) / depth_;
        break;
      case k_yield:
        values[g] = c.f - k_beyond_yield;
        break;
      case k_reversal: {
        const double rate = particle_.dent_rate(i);
        values[g] = rate / (std::abs(rate) + std::abs(c.drive.rate()) + depth_);
        break;
      }
      default:
        values[g] = limit_value(guards_[g], margin);
        break;
    }
  }
}

/// Distance of the state from a limit; zero or less where it is met.
double System::limit_value(const Guard& guard, double margin) const noexcept {
  if (guard.kind == k_fold) return margin - k_least_margin;
  return k_most_coverage - particle_.coverage();
}

DomainEnd System::end_at(const Guard& guard, double xi) const {
  const Event event{guard.name, guard.index};
  if (guard.kind == k_coverage) return {event, {Limit::surface_covered, -1, "coverage", particle_.coverage()}};
  double largest = 0.0;
  for (const ClassState& c : particle_.classes()) largest = std::max(largest, displacement(c, xi));
  return {event, {Limit::applicability, -1, "largest displacement/R0", largest}};
}

std::optional<DomainEnd> System::fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                      std::vector<Event>& log) {
  evaluate(y);
  for (const std::size_t g : fired) {
    const Guard& guard = guards_[g];
    if (guard.kind >= k_fold) {
      log.push_back({guard.name, guard.index});
      return end_at(guard, xi);
    }
    const auto i = static_cast<std::size_t>(guard.index);
    if (guard.kind > k_lost) continue;
    ClassState& c = particle_.at(i);
    c.touches = guard.kind == k_made && !c.gives_way;
    if (!guard.is_silent) log.push_back({guard.name, guard.index});
    // A wall that gives way moves with the surface that it has met; a force-controlled wall that would pull gives way.
    if (c.takes_force || c.gives_way) give_way(i, y);
  }
  solve(xi, y);
  decide_mode(xi, y, log, fired);
  arm_guards();
  const auto end = limit_here(xi, y);
  if (end) log.push_back(end->event);
  return end;
}

// --- observables

/// Displacement of a wall over R0, at the state that was evaluated.
double System::displacement(const ClassState& c, double xi) {
  return c.takes_force ? c.displacement : c.drive.value(xi);
}

/// Numbers of a contact in a row, at the state that was evaluated.
contacts::VisibleContact System::visible(std::size_t i, double xi, std::span<const double> y) const {
  const ClassState& c = particle_.at(i);
  const double length = settings_.initial_radius;
  const double d = displacement(c, xi);
  const int closed = c.flows ? k_plastic : c.dent.zeta > particle_.material().a_Y ? k_unloaded : k_elastic;
  return {.displacement = d * length,
          .overlap = (d + particle_.carried(i, y)) * length,
          .force = c.contact.F * force_unit(),
          .contact_radius = std::sqrt(c.contact.area) * length,
          .pressure = c.contact.area > 0.0 ? c.contact.F / (pi * c.contact.area) * settings_.youngs_modulus : 0.0,
          .regime = static_cast<double>(c.touches ? closed : k_open)};
}

void System::observe(double xi, std::span<const double> y, std::span<double> values) {
  evaluate(y);
  const double length = settings_.initial_radius;
  contacts::Energies energies = contacts::k_no_energies;
  if (has_energies()) {
    const double energy_unit = force_unit() * length;
    energies = {y[work_place_] * energy_unit, particle_.stored_energy() * energy_unit};
  }
  columns_.write(
      energies, classes_.size(),
      [&](std::size_t i) {
        const contacts::VisibleContact shown = visible(i, xi, y);
        deepest_ = std::max(deepest_, shown.overlap / length);
        return shown;
      },
      values, std::array{particle_.core_of(y).e, particle_.coverage()});
  if (settings_.centre_is_free) {
    const Eigen::Vector3d centre = particle_.layout().centre_of(y);
    contacts::write_centre_columns(particle_.lines().in_space(centre) * length, values);
  }
}

double System::quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) {
  evaluate(y);
  const auto i = static_cast<std::size_t>(contact_class);
  return quantity_of(contacts::wall_of(visible(i, xi, y), settings_.initial_radius), quantity);
}

double System::controlled(Control control, int contact_class, double xi, std::span<const double> y) {
  return quantity(control == Control::force ? Quantity::force : Quantity::displacement, contact_class, xi, y);
}

std::vector<Diagnostic> System::warnings() const {
  std::vector<Diagnostic> found;
  const double softness = settings_.youngs_modulus / settings_.yield_stress;
  if (softness < k_least_modulus_over_yield)
    found.push_back({"E/Y is below 6.25, the softest material that the law is fitted to", "E/Y", softness});
  if (deepest_ > k_deepest)
    found.push_back({"a wall goes beyond half the radius, where the law is not fitted", "overlap/R0", deepest_});
  return found;
}

std::optional<Difficulty> System::difficulty(double xi, std::span<const double> y) {
  if (evaluate_rates(xi, y) < k_hard_margin) return Difficulty::near_applicability_limit;
  // An idle wall, which only carries a loose particle along, bears no more than the weak spring does.
  constexpr double k_ways = 10.0;
  const double least = k_ways * Particle::k_weak_spring * depth_;
  for (std::size_t i = 0; i < classes_.size() && particle_.layout().directions() > 0; ++i) {
    if (particle_.at(i).touches && particle_.at(i).contact.F < least) return Difficulty::singular_balance;
  }
  return std::nullopt;
}

}  // namespace monograin::cel
