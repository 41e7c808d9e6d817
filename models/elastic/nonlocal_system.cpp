#include "elastic/nonlocal_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "contacts/side_ahead.hpp"
#include "system/difficulty.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

// Kinds of guards. A guard's index is that of a class, of a pair, or -1.
enum Kind : int {
  k_made,
  k_lost,
  k_touched,
  k_left,
  k_impingement,
  k_stiffening,
  k_force_ends,
  k_radius,
  k_centre,
  k_limit
};

// Margin at which a run ends. It goes like the root of the distance from the limit: a run ends 1e-10 R0 before the
// limit.
constexpr double k_least_margin = 1e-5;
// Margin below which an integrator may find no further steps.
constexpr double k_hard_margin = 1e-3;
// Distance in xi ahead of an instant at which its mode is read.
constexpr double k_ahead = 1e-9;
// Distance in xi from the end of a force that bears a free centre at which an integrator stops.
constexpr double k_end_of_force = 1e-8;
// Gap at which a wall begins to move a free centre, over the touch tolerance: at the whole tolerance the centre would
// move before the wall arrives.
constexpr double k_begins = 1e-3;
// Gap up to which a wall counts as just lost, over the touch tolerance. A contact is lost at that tolerance; the rest
// allows for the error of that event.
constexpr double k_just_lost = 2.0;
constexpr double k_nowhere = std::numeric_limits<double>::infinity();
// Rate at which an integrated state is drawn back to the equations, per step of the program. Without it an accumulated
// error would grow with 1/margin towards the limit of applicability.
constexpr double k_pull = 20.0;

}  // namespace

double System::square_of(double power) { return std::pow(std::max(power, 0.0), 1.0 / k_force_power); }

void System::start(std::span<double> y) {
  std::ranges::fill(y, 0.0);
  std::ranges::fill(regimes_, Regime::open);
  std::ranges::fill(touches_, false);
  for (Pair& pair : pairs_) pair.has_impinged = false;
  has_begun_ = false;
  has_stiffened_ = false;
  least_margin_ = 1.0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const double gap = classes_[i].gap / settings_.initial_radius;
    ramps_[i] = {-gap, -gap, Control::displacement};
    y[i] = -gap;
  }
}

void System::begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) {
  const double length = settings_.initial_radius;
  for (std::size_t i = 0; i < ramps_.size(); ++i) {
    const bool was_loaded = is_loaded(i);
    const double unit = ramps[i].control == Control::force ? settings_.youngs_modulus * length * length : length;
    ramps_[i] = {ramps[i].start / unit, ramps[i].end / unit, ramps[i].control};
    if (was_loaded && !is_loaded(i)) y[i] = square_of(y[i]);
    if (!was_loaded && is_loaded(i)) y[i] = std::pow(std::max(y[i], 0.0), k_force_power);
  }
  for (std::size_t i = 0; i < ramps_.size(); ++i) {
    if (is_loaded(i) && prescribed(i, k_ahead) < 0.0) throw_pull(i);
  }
  // A force closes a gap at once; everything else is where it was.
  solve(0.0, y);
  evaluate(0.0, y);
  resolve_mode(0.0, log);
  mark_touching();
  has_begun_ = true;
  arm_guards();
  if (const auto end = limit_at_start(y)) throw CannotBegin(*end);
}

/// The limit at which a step begins, if the step leads beyond it: that limit's guard would not cross zero. Else none.
std::optional<DomainEnd> System::limit_at_start(std::span<const double> y) {
  for (const Guard& guard : guards_) {
    if (guard.kind < k_radius) continue;
    evaluate_closely(0.0, y);
    const double now = limit_value(guard, 0.0);
    if (now > 0.0) continue;
    std::vector<double> ahead(y.begin(), y.end());
    try {
      solve(k_ahead, ahead);
    } catch (const std::domain_error&) {
      return end_at(guard, 0.0, y);
    }
    evaluate_closely(k_ahead, ahead);
    if (limit_value(guard, k_ahead) < now) return end_at(guard, 0.0, y);
  }
  return std::nullopt;
}

/// Distance of the state of evaluate_closely() from a limit; negative beyond it.
double System::limit_value(const Guard& guard, double xi) {
  const auto index = static_cast<std::size_t>(std::max(0, guard.index));
  if (guard.kind == k_radius) {
    return greatest_approach_ ? 1.0 - now_[index].approach / *greatest_approach_ : widest_ - now_[index].contact_radius;
  }
  if (guard.kind == k_centre) return 1.0 - depth(index, xi);
  // Vanishes where the margin is k_least_margin, in whatever order the walls are eliminated.
  return contacts_.least_pivot(state_, k_least_margin);
}

/// End of the domain that the guard of a limit reports.
DomainEnd System::end_at(const Guard& guard, double xi, std::span<const double> y) {
  const Event event{guard.name, guard.index};
  if (guard.kind == k_radius) {
    return {event, {Limit::contact_as_wide_as_particle, guard.index, "contact radius/R0", widest_}};
  }
  if (guard.kind == k_centre) return {event, {Limit::wall_at_centre, guard.index, "displacement/R0", 1.0}};
  evaluate_closely(xi, y);
  double largest = 0.0;
  for (std::size_t i = 0; i < classes_.size(); ++i) largest = std::max(largest, depth(i, xi));
  return {event, {Limit::applicability, -1, "largest displacement/R0", largest}};
}

double System::prescribed(std::size_t i, double xi) const noexcept {
  return std::lerp(ramps_[i].start, ramps_[i].end, xi);
}

void System::throw_pull(std::size_t i) const {
  throw DomainError({.limit = Limit::wall_would_pull, .contact_class = static_cast<int>(i)});
}

/// Calls `ask`, and replaces its error where a prescribed force ends and would turn negative: the wall would have to
/// pull. Contacts leave the centre at the same instant, so that any trial may lack a state there, even a distant one.
void System::or_pull_that_follows(double xi, auto&& ask) const {
  try {
    ask();
  } catch (const std::domain_error&) {
    for (std::size_t i = 0; i < ramps_.size(); ++i) {
      if (is_loaded(i) && ramps_[i].end < 0.0 && square_under_force(i, xi) <= idle_) throw_pull(i);
    }
    throw;
  }
}

/// The xi at which a force falls to zero in this step; k_nowhere if it does not.
double System::end_of_force(std::size_t i) const noexcept {
  const Ramp& ramp = ramps_[i];
  return ramp.start > 0.0 && ramp.end <= 0.0 ? ramp.start / (ramp.start - ramp.end) : k_nowhere;
}

double System::square_under_force(std::size_t i, double xi) const {
  const double force = prescribed(i, xi);
  if (force < 0.0) throw_pull(i);
  return contacts_.law().signed_square_under(force / contacts_.composite_modulus());
}

/// Copies the unknowns to state_ as contacts_ expects them: s for classes under force control, too.
std::span<double> System::evaluate(double xi, std::span<const double> y) {
  std::ranges::copy(y.first(state_.size()), state_.begin());
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (is_loaded(i)) state_[i] = square_under_force(i, xi);
  }
  return state_;
}

/// Evaluates the unknowns in state_, and all contacts in that state in now_.
void System::evaluate_closely(double xi, std::span<const double> y) { contacts_.contacts(evaluate(xi, y), now_); }

void System::mark_closed() {
  for (std::size_t i = 0; i < classes_.size(); ++i) is_closed_[i] = regimes_[i] == Regime::elastic;
}

/// Copies state_ to y, as its power 3/2 where a force is prescribed.
void System::note(std::span<double> y) const {
  std::ranges::copy(state_, y.begin());
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (is_loaded(i)) y[i] = std::pow(state_[i], k_force_power);
  }
}

void System::complete(double xi, std::span<double> y) {
  // Recomputes the gaps, and the position of a free centre: their errors would close walls that only touch.
  evaluate(xi, y);
  mark_closed();
  search_.clear_centre(contacts_, ramps_, xi, is_closed_, state_);
  note(y);
}

void System::branch_reach(std::span<const double> y, std::span<double> reach) const {
  std::ranges::fill(reach, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const double square = is_loaded(i) ? square_of(y[i]) : y[i];
    reach[i] = contacts_.branch_reach(i, square);
    if (is_loaded(i)) reach[i] = std::pow(square + reach[i], k_force_power) - y[i];
  }
}

void System::solve(double xi, std::span<double> y) {
  evaluate(xi, y);
  // The path begins at y under force control, too: from another depth, the centre would move along another path.
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (is_loaded(i)) state_[i] = square_of(y[i]);
  }
  // A contact that is open in its regime may be loaded beyond an event still to be located. The states before know
  // nothing of it.
  bool is_own_mode = true;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    is_own_mode = is_own_mode && (regimes_[i] == Regime::elastic || state_[i] <= touch_);
  }
  or_pull_that_follows(xi, [&] { search_.solve(contacts_, ramps_, xi, state_, is_own_mode); });
  note(y);
}

/// Advances past the begin or the end of a force that contacts alone bear against a free centre. Their depth, and with
/// it the centre's position, goes like the force to the power 2/3: its rate is infinite at zero force.
double System::leave_singularity(double xi, std::span<double> y) {
  if (contacts_.free_count() == 0) return xi;
  evaluate(xi, y);
  const double ahead = std::min(xi + k_ahead, 1.0);
  double later = xi;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (!is_loaded(i)) continue;
    const double end = end_of_force(i);
    const bool begins = state_[i] <= touch_ && prescribed(i, ahead) > prescribed(i, xi);
    if (begins && support_.may_be_held(contacts_, ramps_, state_, k_just_lost * touch_)) later = ahead;
    if (end > xi && end - xi < 2.0 * k_end_of_force) later = end;
  }
  if (later == xi) return xi;
  const double energy = contacts_.energy(state_);
  try {
    search_.solve(contacts_, ramps_, later, evaluate(later, y));
  } catch (const std::domain_error&) {
    return xi;  // the next evaluation from here throws again
  }
  note(y);
  y[work_place_] += contacts_.energy(state_) - energy;
  return later;
}

void System::rates(double xi, std::span<const double> y, std::span<double> dy) {
  evaluate_closely(xi, y);
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    drawn_ramps_[i] = ramps_[i];
    if (!is_loaded(i)) drawn_ramps_[i].end += k_pull * (prescribed(i, xi) - now_[i].displacement);
  }
  or_pull_that_follows(xi, [&] { motion_.find(contacts_, drawn_ramps_, state_, rates_, {touch_, k_pull, touches_}); });
  std::ranges::copy(rates_, dy.begin());
  // dF/dxi of every contact, and of the walls under force control.
  const auto force_rate = [&](std::size_t i) {
    if (is_loaded(i)) return ramps_[i].end - ramps_[i].start;
    const ContactState c = now_[i];
    return c.stiffness > 0.0 ? c.stiffness * contacts_.law().at(state_[i]).approach_slope * rates_[i] : 0.0;
  };
  double power = 0.0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const ContactState c = now_[i];
    double speed = ramps_[i].end - ramps_[i].start;
    if (is_loaded(i)) {
      const double force_speed = speed;
      // Rate of s^(3/2), the unknown; no other rate depends on it.
      const LocalContact local = contacts_.law().at(std::max(state_[i], 1e-200));
      dy[i] = force_speed * k_force_power / (2.0 * contacts_.composite_modulus() * local.approach_slope);
      speed = c.stiffness > 0.0 ? force_speed / c.stiffness : 0.0;
      for (std::size_t h = 0; h < classes_.size(); ++h) {
        speed -= contacts_.coupling()(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(h)) * force_rate(h);
      }
      for (std::size_t k = 0; k < contacts_.free_count(); ++k) {
        speed -= arms_[i][static_cast<Eigen::Index>(k)] * rates_[classes_.size() + k];
      }
    }
    power += classes_[i].multiplicity() * c.force * speed;
  }
  dy[work_place_] = power;
}

void System::residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) {
  evaluate(xi, y);
  or_pull_that_follows(xi, [&] { nonlocal::residual(contacts_, ramps_, xi, state_, res.first(state_.size())); });
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (is_loaded(i)) res[i] = y[i] - std::pow(state_[i], k_force_power);
  }
  rates(xi, y, all_rates_);
  res[work_place_] = dy[work_place_] - all_rates_[work_place_];
  // The balance of forces does not determine the position of a centre that no contact supports.
  const std::size_t count = contacts_.free_count();
  if (count == 0) return;
  Eigen::Vector3d missing = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    missing[static_cast<Eigen::Index>(k)] = dy[classes_.size() + k] - all_rates_[classes_.size() + k];
  }
  mark_closed();
  motion_.let_unheld_centre_go(contacts_, ramps_, is_closed_, missing, res.subspan(classes_.size(), count));
}

std::optional<double> System::closed_quadrature(double xi, std::span<const double> y) {
  return contacts_.energy(evaluate(xi, y));
}

// --- transitions

/// Signed square of a class shortly after xi, as soon as it exceeds the touch tolerance on either side; 0 if it never
/// does, none if no state exists before that.
std::optional<double> System::square_ahead(std::size_t i, double xi) {
  std::vector<double> ahead = state_;
  return contacts::side_ahead(xi, touch_, [&](double later) {
    search_.solve(contacts_, ramps_, later, ahead);
    return ahead[i];
  });
}

/// Sets the regimes from the state of evaluate(). Touching walls belong to the side to which they go. At a fixed centre
/// the gap of an open wall is exact up to round-off: its guard fires when contact is made, which may be much later.
void System::resolve_mode(double xi, std::vector<Event>& log) {
  const bool are_exact = has_begun_ && contacts_.free_count() == 0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const bool was_open = regimes_[i] == Regime::open;
    if (are_exact && was_open && !is_loaded(i) && state_[i] <= touch_) continue;
    double square = state_[i];
    if (is_loaded(i)) {
      square = std::max(ramps_[i].start, ramps_[i].end);
    } else if (std::abs(square) <= k_just_lost * touch_) {
      square = square_ahead(i, xi).value_or(0.0);
    }
    const bool now_open = square == 0.0 ? was_open : square < 0.0;
    regimes_[i] = now_open ? Regime::open : Regime::elastic;
    // Walls that touch the fresh particle are in contact from the start, without an event.
    const bool is_first_touch = !has_begun_ && classes_[i].gap == 0.0;
    if (now_open != was_open && !is_first_touch) {
      log.push_back({now_open ? "contact-lost" : "contact-made", static_cast<int>(i)});
    }
  }
}

void System::add_guard(int kind, std::size_t index, int direction, std::string_view name) {
  guards_.push_back({kind, static_cast<int>(index), direction, name});
}

/// Marks the walls that touch in the state of evaluate(). A wall loses its mark once its gap exceeds idle_.
void System::mark_touching() {
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const bool is_off = regimes_[i] == Regime::open && state_[i] < -idle_;
    touches_[i] = regimes_[i] == Regime::elastic || state_[i] >= -k_begins * touch_ || (touches_[i] && !is_off);
  }
}

void System::arm_guards() {
  guards_.clear();
  const bool is_at_rest = std::ranges::all_of(ramps_, [](const Ramp& ramp) { return ramp.start == ramp.end; });
  if (is_at_rest) return;
  arm_contacts();
  if (contacts_.free_count() > 0) arm_carriers();
  arm_impingement();
  if (contacts_.free_count() > 0) arm_ends_of_forces();
  arm_limits();
}

/// Arms the guards of contacts made and lost at walls under displacement control.
void System::arm_contacts() {
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (is_loaded(i)) continue;
    if (regimes_[i] == Regime::open)
      add_guard(k_made, i, 1, "contact-made");
    else
      // The other contacts depend on this contact's force, whose second derivative is infinite where contact is lost.
      guards_.push_back({.kind = k_lost,
                         .index = static_cast<int>(i),
                         .direction = -1,
                         .name = "contact-lost",
                         .is_branch_end = true});
  }
}

/// Arms the guards of where an open wall begins and ceases to move a free centre.
void System::arm_carriers() {
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (is_loaded(i) || regimes_[i] != Regime::open) continue;
    guards_.push_back({.kind = touches_[i] ? k_left : k_touched,
                       .index = static_cast<int>(i),
                       .direction = touches_[i] ? -1 : 1,
                       .name = touches_[i] ? "wall-left" : "wall-touched",
                       .is_silent = true});
  }
}

/// Arms the guards of contacts that meet on the surface, each pair once.
void System::arm_impingement() {
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const bool both = regimes_[pairs_[p].first] == Regime::elastic && regimes_[pairs_[p].second] == Regime::elastic;
    if (both && !pairs_[p].has_impinged) add_guard(k_impingement, p, -1, "impingement");
  }
}

/// Arms the guards that stop an integrator next to the end of a force that bears a free centre.
void System::arm_ends_of_forces() {
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (!is_loaded(i) || end_of_force(i) == k_nowhere) continue;
    guards_.push_back({.kind = k_force_ends,
                       .index = static_cast<int>(i),
                       .direction = -1,
                       .name = "force-ends",
                       .is_silent = true,
                       .is_exact = true});
  }
}

/// Arms the guards of stiffening, and of the ends of the domain.
void System::arm_limits() {
  // The formulation stiffens before it reaches its limit, so that the limit needs no guard until then.
  const bool will_stiffen = !has_stiffened_ && contacts_.least_pivot(state_, k_stiff_margin) > 0.0;
  if (!has_stiffened_) guards_.push_back({k_stiffening, -1, -1, "stiffening"});
  const bool needs_radius = settings_.radius_rule != RadiusRule::none || settings_.model.terms == Terms::all;
  for (std::size_t i = 0; needs_radius && i < classes_.size(); ++i) {
    if (regimes_[i] == Regime::elastic) add_guard(k_radius, i, -1, "radius-limit");
  }
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (regimes_[i] == Regime::elastic) add_guard(k_centre, i, -1, "limit");
  }
  if (!will_stiffen) guards_.push_back({k_limit, -1, -1, "limit"});
}

/// Displacement of a wall towards the centre of the particle, wherever that is; over R0.
double System::depth(std::size_t i, double xi) {
  return (is_loaded(i) ? now_[i].displacement : prescribed(i, xi)) + shift(i, state_);
}

/// Contribution of the centre's displacement to depth().
double System::shift(std::size_t i, std::span<const double> y) const noexcept {
  double sum = 0.0;
  for (std::size_t k = 0; k < contacts_.free_count(); ++k) {
    sum += arms_[i][static_cast<Eigen::Index>(k)] * y[classes_.size() + k];
  }
  return sum;
}

/// Angle that two contacts leave free between their edges; 0 where they meet.
double System::angle_between_edges(const Pair& pair, double xi) {
  // Each class belongs to many pairs.
  const auto edge = [&](std::size_t i) {
    if (std::isnan(edge_angles_[i])) {
      const double radius = contacts_.deformed_radius(settings_.radius_rule, i, state_);
      edge_angles_[i] = edge_angle(radius, depth(i, xi));
    }
    return edge_angles_[i];
  };
  return pair.angle - edge(pair.first) - edge(pair.second);
}

void System::guard_values(double xi, std::span<const double> y, std::span<double> values) {
  evaluate_closely(xi, y);
  edge_angles_.assign(classes_.size(), k_nan);
  for (std::size_t g = 0; g < guards_.size(); ++g) {
    const auto index = static_cast<std::size_t>(std::max(0, guards_[g].index));
    switch (guards_[g].kind) {
      case k_made:
        values[g] = (state_[index] - touch_) / guard_unit_;
        break;
      case k_lost:
        values[g] = (state_[index] + touch_) / guard_unit_;
        break;
      case k_touched:
        values[g] = (state_[index] + k_begins * touch_) / guard_unit_;
        break;
      case k_left:
        values[g] = (state_[index] + idle_) / guard_unit_;
        break;
      case k_impingement:
        values[g] = angle_between_edges(pairs_[index], xi);
        break;
      case k_stiffening:
        values[g] = contacts_.least_pivot(state_, k_stiff_margin);  // zero where the margin is k_stiff_margin
        break;
      case k_force_ends:
        values[g] = end_of_force(index) - k_end_of_force - xi;
        break;
      default:
        values[g] = limit_value(guards_[g], xi);
        break;
    }
  }
}

std::optional<DomainEnd> System::fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                      std::vector<Event>& log) {
  evaluate_closely(xi, y);
  std::optional<DomainEnd> end;
  // A wall whose touch guard fires now carries no load yet; it may only move a free centre.
  const auto only_touches = [&](int wall) {
    return std::ranges::any_of(fired,
                               [&](std::size_t g) { return guards_[g].kind == k_touched && guards_[g].index == wall; });
  };
  for (const std::size_t g : fired) {
    const Guard guard = guards_[g];
    const auto index = static_cast<std::size_t>(std::max(0, guard.index));
    Event event{guard.name, guard.index};
    switch (guard.kind) {
      case k_made:
        if (only_touches(guard.index) || only_stands(index, xi, y)) continue;
        regimes_[index] = Regime::elastic;
        break;
      case k_lost:
        regimes_[index] = Regime::open;
        break;
      case k_impingement: {
        Pair& pair = pairs_[index];
        pair.has_impinged = true;
        event = {guard.name, static_cast<int>(pair.first),
                 pair.first == pair.second ? -1 : static_cast<int>(pair.second)};
        break;
      }
      case k_stiffening:
        has_stiffened_ = true;
        break;
      case k_touched:
      case k_left:
        touches_[index] = guard.kind == k_touched;
        continue;
      case k_force_ends:
        continue;
      default:
        end = end_at(guard, xi, y);
        break;
    }
    log.push_back(event);
  }
  if (end) return end;
  try {
    solve(xi, y);
    resolve_others(xi, fired, log);
    mark_touching();
  } catch (const std::domain_error&) {
    // Where there is no state, the next evaluation from here throws again.
  }
  arm_guards();
  return std::nullopt;
}

/// True if a wall whose contact seems to be made does not touch the surface yet, nor goes on to it. A wall that comes
/// to rest at the surface may be within an integrator's tolerance. False with a free centre, which such a wall moves.
bool System::only_stands(std::size_t i, double xi, std::span<const double> y) {
  if (contacts_.free_count() > 0) return false;
  std::vector<double> exact(y.begin(), y.end());
  try {
    solve(xi, exact);
  } catch (const std::domain_error&) {
    return false;  // the next evaluation from here throws again
  }
  return state_[i] <= touch_ && square_ahead(i, xi).value_or(touch_) <= 0.0;
}

/// Switches the regime of contacts that are on another side in the exact state than in the integrated one; their guards
/// would not cross any more. At a fixed centre, a wall at which the surface comes to rest carries nothing, as before it
/// was pressed.
void System::resolve_others(double xi, std::span<const std::size_t> fired, std::vector<Event>& log) {
  const bool is_fixed = contacts_.free_count() == 0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const bool was_open = regimes_[i] == Regime::open;
    const auto stands = [&] { return std::abs(state_[i]) <= touch_ && square_ahead(i, xi) == 0.0; };
    const bool is_elsewhere = was_open ? state_[i] > touch_ : state_[i] < -touch_ || (is_fixed && stands());
    const auto is_own = [&](std::size_t g) {
      return guards_[g].kind <= k_lost && guards_[g].index == static_cast<int>(i);
    };
    if (is_loaded(i) || !is_elsewhere || std::ranges::any_of(fired, is_own)) continue;
    regimes_[i] = was_open ? Regime::elastic : Regime::open;
    log.push_back({was_open ? "contact-made" : "contact-lost", static_cast<int>(i)});
  }
}

// --- queries

/// Uses the exact state, from which the wall continues: integration errors of opposite walls' forces would not balance.
double System::controlled(Control control, int contact_class, double xi, std::span<const double> y) {
  std::vector<double> exact(y.begin(), y.end());
  try {
    solve(xi, exact);
  } catch (const std::domain_error&) {
    std::ranges::copy(y, exact.begin());  // the next evaluation from here throws again
  }
  return quantity(control == Control::force ? Quantity::force : Quantity::displacement, contact_class, xi, exact);
}

bool System::is_open(int contact_class) const noexcept {
  return regimes_[static_cast<std::size_t>(contact_class)] == Regime::open;
}

std::optional<Difficulty> System::difficulty(double xi, std::span<const double> y) {
  if (is_shallow_) return Difficulty::below_resolution;  // the whole program is
  if (contacts_.margin(evaluate(xi, y)) < k_hard_margin) return Difficulty::near_applicability_limit;
  if (contacts_.free_count() == 0 || !is_held_softly(contacts_, ramps_, evaluate(xi, y), idle_)) return std::nullopt;
  return Difficulty::singular_balance;
}

}  // namespace monograin::nonlocal
