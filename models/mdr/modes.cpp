// Modes of the MDR system: what transitions change, and how a mode is decided.

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mdr/guards.hpp"
#include "mdr/system.hpp"

namespace monograin::mdr {
namespace {

// Share of an unloading branch that is left when it counts as loaded to its end together with another event.
constexpr double k_passed = 1e-2;
// Under force a wall would go back by what is missing of its force, over the stiffness of a plastic contact, which is
// less by many orders.
constexpr double k_passed_by_force = 1e-6;
// Caps that have met and are this far from it have parted.
constexpr double k_parted = 1e-6;
// A free centre that has gone this far (over R0) within an instant has sprung.
constexpr double k_spring = 1e-9;

/// Takes the events of a contact out again, those from a place on.
void forget_events(std::size_t i, std::size_t from, std::vector<Event>& log) {
  const auto first = log.begin() + static_cast<std::ptrdiff_t>(std::min(from, log.size()));
  const auto is_its = [i](const Event& event) { return event.contact_class == static_cast<int>(i); };
  log.erase(std::remove_if(first, log.end(), is_its), log.end());
}

}  // namespace

// --- deciding a mode

bool System::gate_is_open(const Motion& now) const noexcept {
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    if (!is_member(branches_[i])) continue;
    // Beside stiff contacts the rate of what only touches has fewer digits.
    const double least = (is_idle_contact(i) ? k_at_rest : k_touch) * speed_scale();
    // What keeps up with its wall displaces nothing.
    const bool is_idle = !is_loaded(i) && std::abs(inward_rate(i, now)) <= least;
    if (settings_.radius_rule == RadiusRule::seed && !is_idle) return true;
    const bool is_driven = is_loaded(i) ? ramps_[i].end > ramps_[i].start : inward_rate(i, now) > least;
    if (branches_[i].is_on_primary_branch && is_driven) return true;
  }
  return false;
}

/// Whether the radius starts to grow, or goes on growing, at this instant.
bool System::wants_growth(double xi, std::span<double> y) {
  if (settings_.radius_rule == RadiusRule::fixed) return false;
  evaluate_cached(xi, y);
  const Motion now = motion(false);
  if (!gate_is_open(now)) return false;
  double drive = growth_drive(now);
  // A contact under force moves without bound at the instant at which it is made.
  bool is_singular = false;
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    is_singular = is_singular || (is_loaded(i) && is_member(branches_[i]) && ramps_[i].end > ramps_[i].start &&
                                  !(now_[i].contact.by_overlap > 0.0));
  }
  if (is_singular || std::abs(drive) <= k_touch) {
    // Balanced to round-off, or undefined: the sign just after decides.
    move_walls(xi + 1e-9, y);
    evaluate(xi + 1e-9, y);
    drive = growth_drive(motion(false));
    move_walls(xi, y);
    evaluate(xi, y);
  }
  return drive > 0.0;
}

/// Demand for growth over the magnitudes it is the difference of: -1 where elastic volume loss rules, +1 where the caps
/// do. The demand itself starts at zero with every first touch, and near nu = 0.5 comes back to zero within no time: as
/// a root function it would be taken to leave where it has already returned.
double System::growth_drive(const Motion& now) const noexcept {
  if (sums_.time_scale > 0.0) return now.demand / sums_.time_scale;
  if (now.demand != 0.0) return std::copysign(1.0, now.demand);
  // First touch, or the last one: of two things that vanish, the elastic volume (square root of the overlap) vanishes
  // last.
  bool goes_in = false;
  bool goes_out = false;
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    if (!is_member(branches_[i])) continue;
    const double rate = wall_rate(i, now);
    goes_in = goes_in || rate > 0.0;
    goes_out = goes_out || rate < 0.0;
  }
  const bool is_left = goes_out && !goes_in;
  return (law_.material.bulk_compliance > 0.0) == is_left ? 1.0 : -1.0;
}

/// Distance of an elastic contact from where it yields, over the overlap there, that counts as none. Contacts that
/// balance each other on a free centre yield together, and their overlaps agree to the rounding of lengths only.
double System::nearness_of_yield(std::size_t i) const noexcept {
  if (free_count_ == 0 || directions_[i].norm() < k_no_direction) return k_touch;
  return std::max(k_touch, std::min(k_together, k_resolution / law_.material.yield_overlap_ratio));
}

/// Fires the guards of one contact that are past already and moving on. Returns whether anything changed.
bool System::resolve_contact(std::size_t i, double xi, std::span<double> y, const Motion& now, std::vector<Event>& log,
                             std::vector<Event>& made) {
  const double r = y[k_radius];
  const double overlap = now_[i].overlap;
  const double of_wall = wall_rate(i, now);
  const double of_overlap = overlap_rate(i, now);
  // At the very start of growth its rate is zero, and about to be positive.
  const bool is_carried = is_growing_ && !is_loaded(i) && of_wall >= -k_touch;
  const bool moves_in = of_overlap > k_touch || is_carried;
  const bool moves_out = of_overlap < -k_touch && !is_carried;
  const bool is_shifted = law_.is_shifted();
  const bool retreats = !goes_on_[i] && (is_shifted ? of_wall < -k_touch : moves_out);
  const bool advances = is_shifted ? of_wall > k_touch : moves_in;
  // A force that is about to vanish, and was found to do so together with another event, presses no more.
  const bool is_vanishing = ramps_[i].end < ramps_[i].start && contact_guard(k_made, i, xi, overlap, r) < k_together;
  const bool is_pressed = is_loaded(i) && prescribed_force(i, xi) > 0.0 && !is_vanishing;
  // A dent opens and closes where its own depth says so, which moves with the radius too.
  const bool is_dent = branches_[i].regime == Regime::unloading || branches_[i].regime == Regime::separated;
  const double of_dent = is_dent && !is_loaded(i) ? edge_rate(i, r, now) : of_overlap;
  const bool closes = of_dent > k_touch || is_carried;
  const bool opens = of_dent < -k_touch && !is_carried;
  const auto event = [&](std::string_view name) { return Event{name, static_cast<int>(i)}; };
  const auto is_past = [&](int kind, double sign) { return sign * contact_guard(kind, i, xi, overlap, r) >= -k_touch; };
  const std::string_view why = xi == 0.0 ? "load-reversal" : "retreat";

  ContactBranch& memory = branches_[i];
  switch (memory.regime) {
    case Regime::open:
      if (is_left_[i] || !(moves_in || is_pressed) || !is_past(k_made, 1.0)) return false;
      branches_[i] = branches_[i].made();
      made.push_back(event("contact-made"));
      return true;
    case Regime::separated:
      if (is_left_[i] || !(closes || is_pressed) || !is_past(k_dent_touched, 1.0)) return false;
      branches_[i] = branches_[i].made();
      log.push_back(event("dent-touched"));
      return true;
    case Regime::elastic:
      if (is_idle_contact(i)) {
        if (!opens || !is_past(k_lost, -1.0)) return false;
        branches_[i] = branches_[i].lost(now_[i].displacement);
        log.push_back(event("contact-lost"));
        return true;
      }
      // Where its force is about to pull before a contact has borne any, there is no edge that could stick.
      if (memory.is_on_primary_branch && retreats && is_loaded(i) && !is_pressed && overlap < k_resolution) {
        branches_[i] = branches_[i].lost(now_[i].displacement);
        log.push_back(event("contact-lost"));
        return true;
      }
      if (memory.is_on_primary_branch && retreats) {
        start_unloading(i, r, why, log);
        return true;
      }
      if (memory.may_yield(law_) && moves_in && -contact_guard(k_yield, i, xi, overlap, r) <= nearness_of_yield(i)) {
        branches_[i] = branches_[i].yielded(law_, r);
        log.push_back(event("yield"));
        return true;
      }
      break;
    case Regime::fully_plastic:
      if (!retreats) return false;
      start_unloading(i, r, why, log);
      return true;
    case Regime::unloading:
      break;
  }
  if (memory.is_on_primary_branch) return false;
  if (advances && is_past(k_reload, 1.0)) {
    // What has turned at this instant rests where it is: from one look to the next the sign of its rate is another one.
    const double rate = primary_branch_rate(i, now);
    const double passed = contact_guard(k_reload, i, xi, overlap, r);
    if (!has_turned_[i] || rate > k_at_rest || passed > k_touch) {
      has_resumed_[i] = has_turned_[i];
      branches_[i] = branches_[i].reloaded();
      log.push_back(event("reload"));
      return true;
    }
    // Passed by rounding, the guard would not be met.
    if (passed > 0.0) {
      branches_[i] = branches_[i].with_largest(law_, r, now_[i].overlap);
      drop_evaluation();
    }
  }
  if (law_.adheres()) return resolve_edge(i, xi, y, now, is_carried, log);
  // No force presses a wall on what is left of its contact: whether that ends does not wait for the radius to grow.
  const bool is_let_go = is_loaded(i) && ramps_[i].start <= 0.0 && ramps_[i].end <= 0.0;
  if ((opens || is_let_go) && is_past(k_lost, -1.0)) {
    branches_[i] = branches_[i].lost(now_[i].displacement);
    log.push_back(event("contact-lost"));
    return true;
  }
  return false;
}

/// The same for the edge of an adhesive contact below its largest overlap.
bool System::resolve_edge(std::size_t i, double xi, std::span<double> y, const Motion& now, bool is_carried,
                          std::vector<Event>& log) {
  const double r = y[k_radius];
  const double rate = edge_rate(i, r, now);
  const bool moves_in = rate > k_at_rest || is_carried;
  const bool moves_out = rate < -k_at_rest && !is_carried;
  const double overlap = now_[i].overlap;
  const auto is_past = [&](int kind, double sign) { return sign * edge_guard(kind, i, xi, overlap, r) >= -k_touch; };
  // What has turned at this instant rests: from one look to the next the sign of its rate is another one.
  const bool rests = has_turned_[i] && std::abs(overlap_rate(i, now)) <= k_at_rest;
  ContactBranch& memory = branches_[i];
  switch (memory.edge.motion) {
    case Edge::following:
      if (!moves_out) return false;
      stick(i, log);
      return true;
    case Edge::sticking:
      if (rests) return false;
      if (moves_in && is_past(k_follow, 1.0)) {
        memory.edge.motion = Edge::following;
        log.push_back({"follow", static_cast<int>(i)});
        return true;
      }
      if (!moves_out || !is_past(k_peel, -1.0)) return false;
      start_peeling(i, r, y, log);
      return true;
    case Edge::peeling:
      // A force that is held where only a displacement could be has the edge run away.
      if (is_past(k_pull_off, -1.0) && (moves_out || is_loaded(i))) {
        separate(i, r, y, log);
        return true;
      }
      if (rate < 0.0 && !is_carried) return false;
      stick(i, log);
      has_turned_[i] = true;
      return true;
  }
  return false;
}

/// Ends the run when no consistent mode exists. Drops the cached evaluation, so that the last row shows the regimes
/// that were tried last.
void System::throw_unsettled() {
  drop_evaluation();
  throw DomainError(Limit::no_consistent_regimes);
}

/// Centre and walls where they belong in the present mode. Where a contact has pulled off, a free centre springs to
/// another equilibrium, and the other contacts go there along their own branches: back from their largest overlap, on
/// beyond it, their edges stretched or pressed.
void System::balance_anew(double xi, std::span<double> y, std::vector<Event>& log, std::vector<Event>& made) {
  if (free_count_ == 0 || !law_.adheres()) {
    complete(xi, y);
    return;
  }
  evaluate(xi, y);
  for (std::size_t i = 0; i < now_.size(); ++i) overlaps_before_[i] = now_[i].overlap;
  branches_before_ = branches_;
  const std::size_t logged_before = log.size();
  const std::size_t made_before = made.size();
  for (std::size_t round = 0;; ++round) {
    if (round == most_rounds()) throw_unsettled();
    std::ranges::copy(y, trial_.begin());
    bool has_arrived = true;
    try {
      complete(xi, y);
    } catch (const std::domain_error&) {
      // Its present branch does not lead a contact so far: as far as it does, and on from there.
      std::ranges::copy(trial_, y.begin());
      if (!approach_balance(xi, y)) throw;
      has_arrived = false;
    }
    evaluate(xi, y);
    const double r = y[k_radius];
    bool has_changed = false;
    for (std::size_t i = 0; i < branches_.size(); ++i) {
      const double gone = now_[i].overlap - overlaps_before_[i];
      if (is_loaded(i)) continue;
      // What was led in on the way there, to touch, to yield or to reload, may be led back again: each time it is seen
      // anew how far it has come from where it was.
      const ContactBranch& before = branches_before_[i];
      const ContactBranch last = branches_[i];
      const bool has_entered =
          last.is_on_primary_branch && (!before.is_on_primary_branch || last.regime != before.regime);
      if (has_entered) {
        branches_[i] = before;
        evaluate_contact(i, now_[i].displacement, r);
        forget_events(i, logged_before, log);
        forget_events(i, made_before, made);
      }
      if (std::abs(gone) <= k_spring) {
        has_changed = has_changed || has_entered;
        continue;
      }
      // What turns back turns where it came from.
      const bool turns = gone < 0.0 && branches_[i].touches() && branches_[i].edge.follows();
      if (turns) evaluate_contact(i, overlaps_before_[i] - r, r);
      now_[i].rate_by_time = gone;
      now_[i].rate_by_growth = 0.0;
      // A dent may be touched and passed at once: looked at in between it would have no force.
      for (std::size_t change = 0; resolve_contact(i, xi, y, Motion{}, log, made); ++change) {
        if (change == most_rounds()) throw_unsettled();
        has_changed = has_changed || !has_entered;
      }
      const bool is_as_last =
          branches_[i].regime == last.regime && branches_[i].is_on_primary_branch == last.is_on_primary_branch;
      has_changed = has_changed || (has_entered && !is_as_last);
    }
    if (!has_changed && !has_arrived) throw_unsettled();
    if (!has_changed) break;
  }
  drop_evaluation();  // what turns was looked at where it came from
}

/// Decides the mode: branch of every contact and growth depend on each other, so assume, look, correct, and repeat.
/// @param growth  what a growth guard has just decided; none: the sign of the demand decides
/// @param has_jumped  the force of a contact has jumped, and its wall has not given way yet: the balance is frozen as
/// it
///                    is now, and when the wall gives way the radius follows it, if need be back by a little
void System::resolve_mode(double xi, std::span<double> y, std::optional<bool> growth, std::vector<Event>& log,
                          bool has_jumped) {
  const bool was_growing = is_growing_;
  drop_evaluation();
  std::vector<Event> made;
  goes_on_.assign(branches_.size(), false);
  has_resumed_.assign(branches_.size(), false);
  if (!has_jumped) balance_anew(xi, y, log, made);
  held_radius_ = y[k_radius];
  const std::vector<double> first_state(y.begin(), y.end());
  const std::vector<ContactBranch> first_branches = branches_;
  const std::size_t first_logged = log.size();
  const std::size_t first_made = made.size();
  bool runs_away = false;
  for (std::size_t round = 0;; ++round) {
    // What turns at its largest overlap, and once it has turned goes on beyond that, goes on as it does in the middle
    // of a step, where its rate is rounding when it turns.
    if (round == most_rounds() && !runs_away && has_resumed_ != goes_on_) {
      std::ranges::copy(first_state, y.begin());
      branches_ = first_branches;
      log.resize(first_logged);
      made.resize(first_made);
      growth.reset();
      goes_on_ = has_resumed_;
      round = 0;
    }
    // Where it would run away in a mode that has been tried, the radius goes to and fro with a contact.
    if (round == most_rounds() && runs_away) throw DomainError(Limit::free_surface_used_up);
    if (round == most_rounds()) throw_unsettled();
    is_growing_ = growth ? *growth : wants_growth(xi, y);
    evaluate_cached(xi, y);
    const std::size_t events_before = log.size();
    if (leave_behind(xi, y, log)) {
      // What it leaves has drawn the centre along in the search for the balance.
      if (!has_jumped) complete(xi, y);
      drop_evaluation();
      growth.reset();
      continue;
    }
    const Motion now = motion(is_growing_);
    runs_away = runs_away || (is_growing_ && free_surface(now, y[k_radius]) < k_least_slope);
    bool has_changed = false;
    std::vector<std::size_t> just_loaded;
    for (std::size_t i = 0; i < branches_.size(); ++i) {
      const bool was_open = !branches_[i].touches();
      has_changed = resolve_contact(i, xi, y, now, log, made) || has_changed;
      if (was_open && is_loaded(i) && branches_[i].touches()) just_loaded.push_back(i);
    }
    if (!has_changed) {
      // Several edges that peel at once may not hold the centre from the start: past already, the guard of that would
      // not be met.
      const auto weakest = weakest_contact();
      if (free_count_ == 0 || !weakest) break;
      if (centre_stiffness_guard(y[k_radius]) >= 0.0) break;
      separate(*weakest, y[k_radius], y, log);
    }
    drop_evaluation();
    // No guard is met by a wall that a force presses on from the start.
    for (const std::size_t i : just_loaded) meet_balanced(i, true, y[k_radius], made);
    // Where a contact has pulled off, the others have to balance anew.
    if (!has_jumped && law_.adheres()) balance_anew(xi, y, log, made);
    if (!has_jumped && !law_.adheres()) move_walls(xi, y);
    // A contact that has just been made carries no force yet and leaves the growth guard's decision standing.
    if (log.size() > events_before) growth.reset();
  }
  check_support();
  if (is_growing_ != was_growing) log.push_back({is_growing_ ? "growth-on" : "growth-off"});
  log.insert(log.end(), made.begin(), made.end());

  evaluate_cached(xi, y);
  frozen_balance_ = is_growing_ ? sums_.balance : 0.0;
  // Past already, its guard would not be met.
  if (is_growing_ &&
      std::min(free_surface(motion(true), y[k_radius]), free_surface_at_rest(y[k_radius])) < k_least_slope) {
    throw DomainError(Limit::free_surface_used_up);
  }
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    if (has_greatest_force(i) && stiffness_left(i) < k_last_stiffness)
      throw DomainError({Limit::greatest_force, static_cast<int>(i), "stiffness left", stiffness_left(i)});
  }
  hold_centre(y);
  arm_guards(xi, y);
}

std::optional<DomainEnd> System::fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                      std::vector<Event>& log) {
  evaluate_cached(xi, y);
  const double r = y[k_radius];
  const Motion now = motion(is_growing_);
  std::optional<bool> growth;
  bool others_fired = false;
  bool has_jumped = false;
  std::optional<DomainEnd> end;
  for (std::size_t i = 0; i < branches_.size(); ++i) edges_before_[i] = branches_[i].edge.motion;
  has_turned_.assign(branches_.size(), false);
  is_left_.assign(branches_.size(), false);
  for (const std::size_t g : fired) {
    const Guard guard = guards_[g];
    const auto i = static_cast<std::size_t>(std::max(0, guard.index));
    const Event event{guard.name, guard.index};
    const bool is_making = guard.kind == k_made || guard.kind == k_dent_touched;
    const bool is_losing = guard.kind == k_lost;
    // Closed or opened already, together with the contact it balances.
    if ((is_making && branches_[i].touches()) || (is_losing && !branches_[i].touches())) continue;
    // What only takes the centre along has nothing to unload from, nor to yield by.
    if ((guard.kind == k_retreat || guard.kind == k_yield) && is_idle_contact(i)) continue;
    // Another guard of the same edge has changed it at this instant, or its contact is back at its largest overlap,
    // where edges only follow.
    const bool is_of_edge = guard.kind == k_peel || guard.kind == k_follow || guard.kind == k_turn;
    // Asked of the guards of edges alone: that of intersecting caps carries the number of their pair, not of a wall.
    const auto has_edge = [this](const ContactBranch& memory) {
      return memory.touches() && !memory.is_on_primary_branch;
    };
    if (is_of_edge && (!has_edge(branches_[i]) || edges_before_[i] != branches_[i].edge.motion)) continue;
    // Nor is a branch at its end that is as short as what counts as zero.
    if (guard.kind == k_reload && branches_[i].regime == Regime::unloading) {
      const double passed = is_loaded(i) ? k_passed_by_force : k_passed;
      if (unloading_fraction(branches_[i].shape(law_, r, now_[i].overlap), now_[i].overlap) > passed) continue;
    }
    // Beside stiff contacts the rate of what turns with them has fewer digits.
    const auto rests = [&] {
      return edge_rate(i, r, now) >= -k_at_rest || std::abs(overlap_rate(i, now)) <= k_at_rest;
    };
    if (guard.kind == k_peel && rests()) {
      const Frame at = branches_[i].frame(law_, r, now_[i].overlap);
      branches_[i].edge = branches_[i].edge.set_back(at.indenter, rounding_of_edge(i, r) * at.by_overlap);
      continue;
    }
    if (guard.kind == k_follow && edge_rate(i, r, now) <= k_at_rest) continue;
    switch (guard.kind) {
      case k_yield:
        branches_[i] = branches_[i].yielded(law_, r);
        has_jumped = has_jumped || is_loaded(i);
        break;
      case k_reload:
        branches_[i] = branches_[i].reloaded();
        break;
      case k_made:
      case k_dent_touched:
        branches_[i] = branches_[i].made();
        break;
      case k_lost:
        branches_[i] = branches_[i].lost(now_[i].displacement);
        break;
      case k_retreat:
        start_unloading(i, r, guard.name, log);
        others_fired = true;
        continue;
      case k_turn:
        // Through infinity: what holds the centre gives way, and no edge has turned.
        if (const auto weakest = weakest_contact(); weakest && free_count_ > 0 && least_centre_stiffness() < k_at_fold)
          separate(*weakest, r, y, log);
        else
          stick(i, log);
        has_turned_[i] = true;
        others_fired = true;
        continue;
      case k_peel:
        start_peeling(i, r, y, log);
        others_fired = true;
        continue;
      case k_pull_off:
        if (branches_[i].edge.peels()) separate(i, r, y, log);
        others_fired = true;
        continue;
      case k_unstable:
        // Unless another contact has pulled off at this instant.
        if (const auto weakest = weakest_contact()) separate(*weakest, r, y, log);
        others_fired = true;
        continue;
      case k_softened:
        end = DomainEnd{
            event,
            {Limit::centre_softening, -1, "their stiffness over that of shallow contacts", least_centre_stiffness()}};
        continue;
      case k_follow:
        branches_[i].edge.motion = Edge::following;
        break;
      case k_greatest_tension:
      case k_least_tension:
      case k_tension_falls:
      case k_tension_rises:
        if (is_extremum(guard.kind, i, now)) log.push_back(event);
        continue;
      case k_growth_on:
      case k_growth_off:
        growth = guard.kind == k_growth_on;
        continue;  // resolve_mode() logs it
      case k_caps:
        if (const auto limit = meet_caps(cap_pairs_[i], r, log)) end = limit;
        continue;
      case k_singular:
      case k_covered:
        end = DomainEnd{event, {Limit::free_surface_used_up, -1, "growth slope D_eff/(4 pi R^2)", k_least_slope}};
        continue;
      case k_greatest_force:
        end = DomainEnd{event, {Limit::greatest_force, guard.index, "stiffness left", stiffness_left(i)}};
        continue;
      case k_volume:
        end = DomainEnd{event, {Limit::half_volume, -1, "V/V0", 0.5}};
        continue;
      default:
        end = centre_reached(guard.index);
        continue;
    }
    others_fired = true;
    log.push_back(event);
    if (is_making || is_losing) meet_balanced(i, is_making, r, log);
  }
  if (end) {
    if (log.empty() || log.back().name != end->event.name) log.push_back(end->event);
    return end;
  }
  if (std::ranges::all_of(fired, [this](std::size_t g) { return guards_[g].is_mark; })) {
    arm_guards(xi, y);
    return std::nullopt;
  }
  resolve_mode(xi, y, others_fired ? std::nullopt : growth, log, has_jumped);
  return meet_caps_at_once(xi, y, log);
}

/// The caps of two contacts intersect: here the source's model ends.
/// @return the reason to stop, if that was asked for
std::optional<DomainEnd> System::meet_caps(CapPair& pair, double r, std::vector<Event>& log) {
  pair.have_met = true;
  if (!caps_have_met_) radius_at_caps_ = 1.0 + r;
  caps_have_met_ = true;
  const Event caps{"caps-intersect", pair.first, pair.first == pair.second ? -1 : pair.second};
  log.push_back(caps);
  if (!settings_.stops_at_cap_intersection) return std::nullopt;
  return DomainEnd{caps, {Limit::caps_intersect, -1, "R/R0", 1.0 + r}};
}

/// A contact may be made within the cap of another one, which no guard meets.
std::optional<DomainEnd> System::meet_caps_at_once(double xi, std::span<const double> y, std::vector<Event>& log) {
  evaluate_cached(xi, y);
  const double r = y[k_radius];
  std::optional<DomainEnd> end;
  for (CapPair& pair : cap_pairs_) {
    const bool both_touch = branches_[static_cast<std::size_t>(pair.first)].touches() &&
                            branches_[static_cast<std::size_t>(pair.second)].touches();
    const double guard = both_touch ? cap_guard(pair, r) : -1.0;
    if (guard < -k_parted) pair.have_met = false;
    if (guard < -k_touch || pair.have_met) continue;
    if (const auto limit = meet_caps(pair, r, log)) end = limit;
  }
  return end;
}

DomainEnd System::centre_reached(int contact_class) {
  return {{"limit", contact_class}, {Limit::wall_at_centre, contact_class, "distance/R0", k_least_distance}};
}

/// A wall that stands at the limit already, and goes on from there, which no guard meets.
std::optional<DomainEnd> System::reach_centre_at_once(double xi, std::span<const double> y) {
  evaluate_cached(xi, y);
  for (std::size_t i = 0; i < now_.size(); ++i) {
    if (1.0 - now_[i].displacement > k_least_distance) continue;
    if (wall_rate(i, motion(is_growing_)) > k_at_rest) return centre_reached(static_cast<int>(i));
  }
  return std::nullopt;
}

}  // namespace monograin::mdr
