#include "mdr/mode_search.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mdr/adhesion_validity.hpp"
#include "mdr/centre_search.hpp"
#include "mdr/equilibrium.hpp"
#include "mdr/guards.hpp"
#include "mdr/idle.hpp"
#include "mdr/rates.hpp"
#include "mdr/support.hpp"
#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {
namespace {

// A reload guard that fires together with another event counts if no more than this share of the unloading branch is
// left to its end.
constexpr double k_passed = 1e-2;
// Share of the unloading branch for a wall under force control. It is smaller than k_passed, because the wall would go
// back by the missing force over the stiffness of a plastic contact, many orders below that of the unloading branch.
constexpr double k_passed_by_force = 1e-6;
// Change of an overlap at one instant (over R0) beyond which the free centre has snapped to another equilibrium.
constexpr double k_snapped = 1e-9;

/// Erases the events of contact i from the log, from index `from` on.
void forget_events(std::size_t i, std::size_t from, std::vector<Event>& log) {
  const auto first = log.begin() + static_cast<std::ptrdiff_t>(std::min(from, log.size()));
  const auto is_its = [i](const Event& event) { return event.contact_class == static_cast<int>(i); };
  log.erase(std::remove_if(first, log.end(), is_its), log.end());
}

Event event_of(std::string_view name, std::size_t i) { return {name, static_cast<int>(i)}; }

const PullOff& pull_off_of(const Particle& p, std::size_t i) {
  const ContactBranch& branch = p.branch(i);
  return branch.pull_off(p.law(), branch.image(p.law(), p.at().growth, p.contact(i).overlap).indenter);
}

/// Tests whether the model predicts the pull-off of a contact that begins to unload (F.7): the model's indenter is
/// convex and does not yield in tension.
/// @return the warning if it does not
std::optional<Diagnostic> check_adhesion(const Particle& p, std::size_t i) {
  const Material& material = p.law().material;
  const Control control = p.is_force_controlled(i) ? Control::force : Control::displacement;
  const double critical = pull_off_of(p, i).under(control).contact_radius;
  const double peak = peak_radius_over_initial_radius(p.contact(i).approach, material.yield_overlap_ratio);
  const double zone = plastic_zone_size(material.composite_modulus, p.law().surface_energy, material.yield_stress);
  switch (adhesion_validity(critical, peak, zone)) {
    case AdhesionValidity::valid:
      break;
    case AdhesionValidity::peak_failure:
      return Diagnostic{"pull-off is not predicted well: the contact's middle is dented beyond its critical radius",
                        "critical radius over that of the ring", critical / peak};
    case AdhesionValidity::yielding_failure:
      return Diagnostic{
          "pull-off is not predicted well: yielding at the contact's edge is not small-scale (15 and more)",
          "critical diameter over the plastic zone", 2.0 * critical / zone};
  }
  return std::nullopt;
}

/// Distance of an elastic contact from its yield overlap, over that overlap, at which the contact counts as yielding.
/// Contacts that balance each other on a free centre yield together; their overlaps agree to the round-off of lengths.
double nearness_of_yield(const Particle& p, std::size_t i) noexcept {
  if (!p.centre().acts(i)) return k_zero_guard;
  return std::max(k_zero_guard, std::min(k_together, k_resolution / p.law().material.yield_overlap_ratio));
}

}  // namespace

DomainEnd centre_reached(int contact_class) {
  return {{"limit", contact_class}, {Limit::wall_at_centre, contact_class, "distance/R0", contacts::k_least_distance}};
}

void ModeSearch::begin(const Particle& particle) {
  p_ = particle;
  has_turned_.assign(p_.size(), false);
  loads_again_.assign(p_.size(), false);
  is_left_.assign(p_.size(), false);
  edges_before_.resize(p_.size());
  for (std::size_t i = 0; i < p_.size(); ++i) edges_before_[i] = p_.branch(i).edge.motion;
  decided_growth_.reset();
  has_yielded_under_force_ = false;
  validity_.reset();
}

void ModeSearch::touch_under_force(std::size_t i, double xi, std::span<double> y, std::vector<Event>& log) {
  carry_to_support(p_, xi, y, log);
  balance_touch(p_, i, true, log);
}

// --- guards that have fired

std::optional<DomainEnd> ModeSearch::apply(std::span<const Guard> fired, double xi, std::span<double> y,
                                           ContactCaps& caps, std::vector<Event>& log) {
  p_.at_state(xi, y);
  const Motion now = p_.motion(p_.mode.is_growing);
  bool others_fired = false;
  std::optional<DomainEnd> end;
  for (const Guard& guard : fired) {
    if (is_void(guard, now)) continue;
    if (const auto limit = end_of(guard, caps, log))
      end = limit;
    else
      others_fired = apply_transition(guard, y, now, log) || others_fired;
  }
  if (others_fired) decided_growth_.reset();
  if (end && (log.empty() || log.back().name != end->event.name)) log.push_back(end->event);
  return end;
}

bool ModeSearch::separate_pulling_walls(double xi, std::span<double> y, std::vector<Event>& log) {
  p_.at_state(xi, y);
  const CentreVector softest = centre_stiffness(p_).direction.normalized();
  bool any = false;
  for (std::size_t i = 0; i < p_.size(); ++i) {
    if (!p_.is_force_controlled(i) || !p_.branch(i).touches() || !(p_.drive(i).value(xi) < 0.0)) continue;
    if (!(std::abs(p_.centre().mean_normal(i).dot(softest)) > k_no_direction)) continue;
    separate(i, y, log);
    any = true;
  }
  return any;
}

/// True for a guard that has fired without a transition to apply: another transition at this instant has made it void,
/// or round-off has fired it.
bool ModeSearch::is_void(const Guard& guard, const Motion& now) const {
  // The guard of intersecting caps carries the number of their pair, not of a contact class.
  if (guard.kind == k_caps) return false;
  const std::size_t i = guard.list_index();
  const ContactBranch& branch = p_.branch(i);
  const auto has_another_edge = [&] {
    // Another guard has changed this edge at this instant, or the contact is back on its primary branch.
    return !branch.touches() || branch.is_on_primary_branch || edges_before_[i] != branch.edge.motion;
  };
  switch (guard.kind) {
    case k_made:
    case k_dent_touched:
      return branch.touches();  // balance_touch() has closed it together with another contact
    case k_lost:
      return !branch.touches();
    case k_retreat:
    case k_yield:
      return is_idle(p_, i);  // carries no load that could fall or yield
    case k_peel:
    case k_turn:
      return has_another_edge();
    case k_follow:
      return has_another_edge() || edge_rate(p_, i, now) <= k_just_turned;
    case k_reload: {
      // On a branch as short as the guard's tolerance, the guard fires far from the end of the branch: no reload there.
      if (branch.regime != Regime::unloading) return false;
      const double overlap = p_.contact(i).overlap;
      const double passed = p_.is_force_controlled(i) ? k_passed_by_force : k_passed;
      return unloading_fraction(branch.shape(p_.law(), p_.at().growth, overlap), overlap) > passed;
    }
  }
  return false;
}

/// Applies the transition of a guard, and logs it; resolve() logs those of the growth.
/// @return whether contacts have changed, so that the growth has to be decided anew
bool ModeSearch::apply_transition(const Guard& guard, std::span<double> y, const Motion& now, std::vector<Event>& log) {
  const std::size_t i = guard.list_index();
  const Event event{guard.name, guard.index};
  switch (static_cast<GuardKind>(guard.kind)) {
    case k_growth_on:
    case k_growth_off:
      decided_growth_ = guard.kind == k_growth_on;
      return false;
    case k_greatest_tension:
    case k_least_tension:
    case k_tension_falls:
    case k_tension_rises:
      if (is_extremum(guard, now)) log.push_back(event);
      return false;
    case k_softened:
    case k_caps:
    case k_singular:
    case k_covered:
    case k_greatest_force:
    case k_volume:
    case k_centre_reached:
      return false;  // end_of()
    case k_yield:
      p_.set_branch(i, p_.branch(i).yielded(p_.law(), p_.at().growth));
      has_yielded_under_force_ = has_yielded_under_force_ || p_.is_force_controlled(i);
      log.push_back(event);
      break;
    case k_reload:
      p_.set_branch(i, p_.branch(i).reloaded());
      log.push_back(event);
      break;
    case k_made:
    case k_dent_touched:
      p_.set_branch(i, p_.branch(i).made());
      log.push_back(event);
      balance_touch(p_, i, true, log);
      break;
    case k_lost:
      p_.lose(i);
      log.push_back(event);
      balance_touch(p_, i, false, log);
      break;
    case k_follow:
      p_.set_branch(i, p_.branch(i).with_edge({}));
      log.push_back(event);
      break;
    case k_retreat:
      start_unloading(i, guard.name, log);
      break;
    case k_turn:
      // At a fold the rate passes through infinity: the centre loses its support, and the edge has not reversed.
      if (may_peel_off(p_) && centre_stiffness(p_).value < k_at_fold)
        separate(*weakest_contact(p_), y, log);
      else
        stick(i, log);
      has_turned_[i] = true;
      break;
    case k_peel:
      return peel_or_set_back(i, y, now, log);
    case k_pull_off:
      if (p_.branch(i).edge.peels()) separate(i, y, log);
      break;
    case k_unstable:
      // No contact is left to separate if the peeling one has already pulled off at this instant.
      if (const auto weakest = weakest_contact(p_)) separate(*weakest, y, log);
      break;
  }
  return true;
}

/// Tears the springs at a sticking edge, unless round-off has fired the guard: a contact that moves together with much
/// stiffer ones has a rate of few digits, and a rate below k_just_turned is no motion. Such an edge has just turned and
/// leaves the verge of peeling with the square of its displacement; it is set back, or its guard would fire again.
/// @return whether the springs tear
bool ModeSearch::peel_or_set_back(std::size_t i, std::span<double> y, const Motion& now, std::vector<Event>& log) {
  if (edge_rate(p_, i, now) < -k_just_turned && std::abs(overlap_rate(p_, i, now)) > k_just_turned) {
    start_peeling(i, y, log);
    return true;
  }
  const Image at = p_.branch(i).image(p_.law(), p_.at().growth, p_.contact(i).overlap);
  const double round_off = edge_round_off(p_, i) * at.by_overlap;
  p_.set_branch(i, p_.branch(i).with_edge(p_.branch(i).edge.set_back(at.indenter, round_off)));
  return false;
}

/// The reason to stop at the guard of a limit; none at other guards, and for caps that may intersect.
std::optional<DomainEnd> ModeSearch::end_of(const Guard& guard, ContactCaps& caps, std::vector<Event>& log) {
  const Event event{guard.name, guard.index};
  const std::size_t i = guard.list_index();
  switch (guard.kind) {
    case k_softened:
      return DomainEnd{
          event, {Limit::centre_softening, -1, "tangent stiffness over the initial one", centre_stiffness(p_).value}};
    case k_caps:
      return caps.meet(i, p_.at().growth, log);
    case k_singular:
    case k_covered:
      return DomainEnd{event,
                       {Limit::free_surface_used_up, -1, "free surface over the particle's surface", k_least_slope}};
    case k_greatest_force:
      return DomainEnd{event,
                       {Limit::greatest_force, guard.index, "tangent stiffness over the initial one",
                        stiffness_over_initial(p_, i)}};
    case k_volume:
      return DomainEnd{event, {Limit::half_volume, -1, "V/V0", 0.5}};
    case k_centre_reached:
      return centre_reached(guard.index);
  }
  return std::nullopt;
}

/// True if the force of a contact that pulls passes through an extremum where the guard has fired. The guard also fires
/// when a contact that has pressed begins to pull; its force then has a finite rate, and is at no extremum.
bool ModeSearch::is_extremum(const Guard& guard, const Motion& now) const {
  const std::size_t i = guard.list_index();
  const ContactBranch& branch = p_.branch(i);
  if (branch.edge.motion != edges_before_[i] || !branch.touches() || !(p_.contact(i).contact.force < 0.0)) return false;
  return guard.kind == k_greatest_tension ||
         (guard.kind == k_least_tension && force_rate(p_, i, now) > -2.0 * k_at_rest);
}

// --- deciding a mode

void ModeSearch::resolve(double xi, std::span<double> y, std::vector<Event>& log) {
  const bool was_growing = p_.mode.is_growing;
  made_.clear();
  radius_diverges_ = false;
  p_.mode.loads_on.assign(p_.size(), false);
  loads_again_.assign(p_.size(), false);
  if (!has_yielded_under_force_) balance_anew(xi, y, log);
  p_.mode.held_growth = y[k_growth];
  const std::vector<double> first_state(y.begin(), y.end());
  const std::vector<ContactBranch> first_branches = p_.branches();
  const std::size_t first_logged = log.size();
  const std::size_t first_made = made_.size();
  while (!settles(xi, y, log)) {
    // Growth that would run away in one of the modes alternates with the branch of a contact.
    if (radius_diverges_) throw DomainError(Limit::free_surface_used_up);
    // Contacts that start to unload at their largest overlap, and would then load beyond it, alternate without end.
    // Searches again from the first state and keeps them on the loading branch. This ends, because loads_again_ only
    // grows: if it has not grown since the last restart, the contacts alternate although they are kept loading.
    if (loads_again_ == p_.mode.loads_on) throw DomainError(Limit::no_consistent_regimes);
    std::ranges::copy(first_state, y.begin());
    p_.set_branches(first_branches);
    log.resize(first_logged);
    made_.resize(first_made);
    decided_growth_.reset();
    p_.mode.loads_on = loads_again_;
  }
  check_support(p_);
  if (p_.mode.is_growing != was_growing) log.push_back({p_.mode.is_growing ? "growth-on" : "growth-off"});
  log.insert(log.end(), made_.begin(), made_.end());
  freeze_mode(xi, y);
}

/// Corrects the mode until it is consistent.
/// @return false if it is not after most_rounds() corrections
bool ModeSearch::settles(double xi, std::span<double> y, std::vector<Event>& log) {
  for (std::size_t round = 0; round < most_rounds(); ++round) {
    if (!correct_once(xi, y, log)) return true;
  }
  return false;
}

/// Corrects the mode where the rates contradict it: a contact that unloads in it, for example, but is pressed further.
/// @return false if the mode is consistent
bool ModeSearch::correct_once(double xi, std::span<double> y, std::vector<Event>& log) {
  p_.mode.is_growing = decided_growth_ ? *decided_growth_ : wants_growth(xi, y);
  p_.at_state(xi, y);
  const std::size_t events_before = log.size();
  if (lose_idle_contacts(p_, xi, y, is_left_, log)) {
    // The lost contacts have pulled the centre in the balance of forces, which is solved again without them.
    if (!has_yielded_under_force_) complete(p_, xi, y);
    decided_growth_.reset();
    return true;
  }
  const Motion now = p_.motion(p_.mode.is_growing);
  radius_diverges_ = radius_diverges_ || (p_.mode.is_growing && now.free_surface(y[k_growth]) < k_least_slope);
  bool has_changed = false;
  std::vector<std::size_t> just_loaded;
  for (std::size_t i = 0; i < p_.size(); ++i) {
    const bool was_open = !p_.branch(i).touches();
    has_changed = resolve_contact(i, xi, y, now, log) || has_changed;
    if (was_open && p_.is_force_controlled(i) && p_.branch(i).touches()) just_loaded.push_back(i);
  }
  if (!has_changed) {
    // Several edges that peel at once may fail to hold the centre from the start: the guard of the centre's stiffness
    // is then past zero and cannot fire.
    if (!may_peel_off(p_) || centre_stiffness_guard(p_) >= 0.0) return false;
    separate(*weakest_contact(p_), y, log);
  }
  // A wall that a force presses from the start fires no guard, so the walls that balance it close here.
  for (const std::size_t i : just_loaded) touch_under_force(i, xi, y, made_);
  // If a contact has pulled off, the others find a new balance.
  if (!has_yielded_under_force_ && p_.law().adheres()) balance_anew(xi, y, log);
  if (!has_yielded_under_force_ && !p_.law().adheres()) move_walls(p_, xi, y);
  // A contact that has just been made carries no force yet and leaves the growth guard's decision standing.
  if (log.size() > events_before) decided_growth_.reset();
  return true;
}

/// Freezes what stays constant in the mode that was found.
void ModeSearch::freeze_mode(double xi, std::span<double> y) {
  const Evaluation& at = p_.at_state(xi, y);
  p_.mode.frozen_balance = p_.mode.is_growing ? at.volume.value : 0.0;
  // The guard of the free surface cannot fire if it is past zero already.
  if (p_.mode.is_growing && std::min(p_.motion(true).free_surface(y[k_growth]),
                                     at.volume.free_surface_at_rest(y[k_growth])) < k_least_slope) {
    throw DomainError(Limit::free_surface_used_up);
  }
  for (std::size_t i = 0; i < p_.size(); ++i) {
    if (has_greatest_force(p_, i) && stiffness_over_initial(p_, i) < k_last_stiffness)
      throw DomainError({Limit::greatest_force, static_cast<int>(i), "tangent stiffness over the initial one",
                         stiffness_over_initial(p_, i)});
  }
  if (!p_.centre().is_free()) return;
  p_.mode.held_centre = centre_of(y, p_.centre().free_directions());
  p_.mode.unconstrained = unconstrained_directions(p_);
}

/// True if the radius starts to grow, or goes on growing, at this instant.
bool ModeSearch::wants_growth(double xi, std::span<double> y) {
  p_.at_state(xi, y);
  const Motion now = p_.motion(false);
  if (!gate_is_open(p_, now)) return false;
  double drive = growth_drive(p_, now);
  // The rate of a force-controlled contact is infinite at the instant at which it is made.
  bool is_singular = false;
  for (std::size_t i = 0; i < p_.size(); ++i) {
    is_singular = is_singular || (p_.is_force_controlled(i) && p_.takes_part(i) && p_.drive(i).rate() > 0.0 &&
                                  !(p_.contact(i).contact.by_overlap > 0.0));
  }
  if (is_singular || std::abs(drive) <= k_zero_guard) {
    // The demand is zero to within round-off, or undefined: its sign just after this instant decides.
    move_walls(p_, xi + k_ahead, y);
    p_.evaluate(xi + k_ahead, y);
    drive = growth_drive(p_, p_.motion(false));
    move_walls(p_, xi, y);
    p_.evaluate(xi, y);
  }
  return drive > 0.0;
}

/// Moves centre and walls to equilibrium in the present mode. When a contact has pulled off, a free centre snaps to
/// another equilibrium. The other contacts follow along their own branches: back from their largest overlap, on beyond
/// it, their edges stretched or pressed.
/// @throws std::domain_error if the branches lead to no equilibrium
void ModeSearch::balance_anew(double xi, std::span<double> y, std::vector<Event>& log) {
  if (!p_.centre().is_free() || !p_.law().adheres()) {
    complete(p_, xi, y);
    return;
  }
  p_.evaluate(xi, y);
  snap_ = {.branches = p_.branches(), .log_size_before = log.size(), .made_size_before = made_.size()};
  for (std::size_t i = 0; i < p_.size(); ++i) snap_.overlaps.push_back(p_.contact(i).overlap);
  for (std::size_t round = 0; round < most_rounds(); ++round) {
    const std::vector<double> trial(y.begin(), y.end());
    bool has_arrived = true;
    try {
      complete(p_, xi, y);
    } catch (const std::domain_error&) {
      // The branch of some contact ends before the equilibrium: goes as far as the branches lead, changes them there,
      // and tries again.
      std::ranges::copy(trial, y.begin());
      if (!approach_balance(p_, xi, y)) throw;
      has_arrived = false;
    }
    p_.evaluate(xi, y);
    bool has_changed = false;
    for (std::size_t i = 0; i < p_.size(); ++i) has_changed = follow_snap(i, xi, y, log) || has_changed;
    if (has_changed) continue;
    if (has_arrived) return;
    break;
  }
  throw DomainError(Limit::no_consistent_regimes);
}

/// Leads a contact along its branches to the overlap that the snap of a free centre gives it.
/// @return whether its branch differs from the one at the end of the last round
bool ModeSearch::follow_snap(std::size_t i, double xi, std::span<double> y, std::vector<Event>& log) {
  if (p_.is_force_controlled(i)) return false;
  const double growth = y[k_growth];
  const double change = p_.contact(i).overlap - snap_.overlaps[i];
  // An earlier round may have closed, yielded or reloaded this contact, and a later round may lead it back. Such a
  // contact therefore begins each round on its branch before the snap, and has to arrive where it was last.
  const ContactBranch& before = snap_.branches[i];
  const ContactBranch last = p_.branch(i);
  const bool has_entered = last.is_on_primary_branch && (!before.is_on_primary_branch || last.regime != before.regime);
  if (has_entered) {
    p_.set_branch(i, before);
    p_.evaluate_contact(i, p_.contact(i).approach, growth);
    forget_events(i, snap_.log_size_before, log);
    forget_events(i, snap_.made_size_before, made_);
  }
  if (std::abs(change) <= k_snapped) return has_entered;
  // A contact that unloads in the snap turns at the overlap that it had before.
  const bool turns = change < 0.0 && p_.branch(i).touches() && p_.branch(i).edge.follows();
  if (turns) p_.evaluate_contact(i, snap_.overlaps[i] - growth, growth);
  p_.assume_rate(i, change);
  // One snap may take a contact through several transitions: it may touch its dent and pass its largest overlap.
  std::size_t changes = 0;
  while (resolve_contact(i, xi, y, Motion{}, log)) {
    if (++changes > most_rounds()) throw DomainError(Limit::no_consistent_regimes);
  }
  const bool is_as_last =
      p_.branch(i).regime == last.regime && p_.branch(i).is_on_primary_branch == last.is_on_primary_branch;
  return has_entered ? !is_as_last : changes > 0;
}

// --- contacts whose guards are past already and moving on

ModeSearch::Tendency ModeSearch::tendency(std::size_t i, double xi, const Motion& now) const {
  const ContactBranch& branch = p_.branch(i);
  const bool is_by_force = p_.is_force_controlled(i);
  const double rate_of_wall = wall_rate(p_, i, now);
  const double rate_of_overlap = overlap_rate(p_, i, now);
  Tendency result;
  // At the very start of growth the rate of the radius is zero, and about to become positive.
  result.is_pressed_by_growth = p_.mode.is_growing && !is_by_force && rate_of_wall >= -k_zero_guard;
  result.moves_in = rate_of_overlap > k_zero_guard || result.is_pressed_by_growth;
  const bool moves_out = rate_of_overlap < -k_zero_guard && !result.is_pressed_by_growth;
  const bool is_shifted = p_.law().is_shifted();
  result.retreats = !p_.mode.loads_on[i] && (is_shifted ? rate_of_wall < -k_zero_guard : moves_out);
  result.advances = is_shifted ? rate_of_wall > k_zero_guard : result.moves_in;
  // A falling force that vanishes together with another event, within the tolerance of that, no longer presses.
  const bool is_vanishing =
      p_.drive(i).rate() < 0.0 && contact_guard(p_, k_made, i, xi, p_.contact(i).overlap) < k_together;
  result.is_pressed = is_by_force && p_.drive(i).value(xi) > 0.0 && !is_vanishing;
  // A dent opens and closes at its own depth, which changes with the radius too.
  const bool is_dent = branch.regime == Regime::unloading || branch.regime == Regime::separated;
  const double rate_of_dent = is_dent && !is_by_force ? edge_rate(p_, i, now) : rate_of_overlap;
  result.closes = rate_of_dent > k_zero_guard || result.is_pressed_by_growth;
  result.opens = rate_of_dent < -k_zero_guard && !result.is_pressed_by_growth;
  return result;
}

/// Corrects the branch of a contact whose guard is past zero and moving on.
/// @return whether anything changed
bool ModeSearch::resolve_contact(std::size_t i, double xi, std::span<double> y, const Motion& now,
                                 std::vector<Event>& log) {
  const Tendency tends = tendency(i, xi, now);
  const double overlap = p_.contact(i).overlap;
  const auto closes_at = [&](GuardKind kind) { return contact_guard(p_, kind, i, xi, overlap) >= -k_zero_guard; };
  const std::string_view why = xi == 0.0 ? "load-reversal" : "retreat";
  switch (p_.branch(i).regime) {
    case Regime::open:
    case Regime::separated: {
      const bool is_dent = p_.branch(i).regime == Regime::separated;
      const bool comes_in = tends.is_pressed || (is_dent ? tends.closes : tends.moves_in);
      if (is_left_[i] || !comes_in || !closes_at(is_dent ? k_dent_touched : k_made)) return false;
      p_.set_branch(i, p_.branch(i).made());
      (is_dent ? log : made_).push_back(event_of(is_dent ? "dent-touched" : "contact-made", i));
      return true;
    }
    case Regime::elastic:
      if (resolve_elastic(i, xi, tends, log)) return true;
      if (is_idle(p_, i)) return false;
      break;
    case Regime::fully_plastic:
      if (!tends.retreats) return false;
      start_unloading(i, why, log);
      return true;
    case Regime::unloading:
      break;
  }
  return !p_.branch(i).is_on_primary_branch && resolve_below_largest(i, xi, y, now, tends, log);
}

bool ModeSearch::resolve_elastic(std::size_t i, double xi, const Tendency& tends, std::vector<Event>& log) {
  const ContactBranch& branch = p_.branch(i);
  const double overlap = p_.contact(i).overlap;
  const bool retreats = branch.is_on_primary_branch && tends.retreats;
  const bool idle = is_idle(p_, i);
  const bool is_past_opening = idle && tends.opens && contact_guard(p_, k_lost, i, xi, overlap) <= k_zero_guard;
  // A prescribed force that begins to pull before the contact has carried any load finds no edge that could stick.
  const bool is_unborne = !idle && retreats && p_.is_force_controlled(i) && !tends.is_pressed && overlap < k_resolution;
  if (is_past_opening || is_unborne) {
    p_.lose(i);
    log.push_back(event_of("contact-lost", i));
    return true;
  }
  if (idle) return false;
  if (retreats) {
    start_unloading(i, xi == 0.0 ? "load-reversal" : "retreat", log);
    return true;
  }
  if (branch.may_yield(p_.law()) && tends.moves_in &&
      -contact_guard(p_, k_yield, i, xi, overlap) <= nearness_of_yield(p_, i)) {
    p_.set_branch(i, branch.yielded(p_.law(), p_.at().growth));
    log.push_back(event_of("yield", i));
    return true;
  }
  return false;
}

bool ModeSearch::resolve_below_largest(std::size_t i, double xi, std::span<double> y, const Motion& now,
                                       const Tendency& tends, std::vector<Event>& log) {
  const double overlap = p_.contact(i).overlap;
  const double passed = tends.advances ? contact_guard(p_, k_reload, i, xi, overlap) : -1.0;
  if (passed >= -k_zero_guard) {
    // The rate of a contact that has turned at this instant is round-off, of either sign: the contact does not reload.
    if (!has_turned_[i] || primary_branch_rate(p_, i, now) > k_just_turned || passed > k_zero_guard) {
      loads_again_[i] = has_turned_[i];
      p_.set_branch(i, p_.branch(i).reloaded());
      log.push_back(event_of("reload", i));
      return true;
    }
    // The reload guard cannot fire if the overlap is past the largest one by round-off.
    if (passed > 0.0) p_.set_branch(i, p_.branch(i).with_largest(p_.law(), p_.at().growth, overlap));
  }
  if (p_.law().adheres()) return resolve_edge(i, xi, y, now, tends.is_pressed_by_growth, log);
  // A contact that no force presses during the whole step may end at once; it does not wait for growth to open it.
  const bool is_unloaded = p_.is_force_controlled(i) && p_.drive(i).start() <= 0.0 && p_.drive(i).end() <= 0.0;
  if ((tends.opens || is_unloaded) && contact_guard(p_, k_lost, i, xi, overlap) <= k_zero_guard) {
    p_.lose(i);
    log.push_back(event_of("contact-lost", i));
    return true;
  }
  return false;
}

/// Corrects the edge of an adhesive contact below its largest overlap.
/// @return whether anything changed
bool ModeSearch::resolve_edge(std::size_t i, double xi, std::span<double> y, const Motion& now,
                              bool is_pressed_by_growth, std::vector<Event>& log) {
  const double rate = edge_rate(p_, i, now);
  const bool moves_in = rate > k_just_turned || is_pressed_by_growth;
  const bool moves_out = rate < -k_just_turned && !is_pressed_by_growth;
  const double overlap = p_.contact(i).overlap;
  const auto is_past = [&](GuardKind kind, double sign) {
    return sign * edge_guard(p_, kind, i, xi, overlap) >= -k_zero_guard;
  };
  // The rate of a contact that has turned at this instant is round-off, of either sign: its edge is at rest.
  const bool is_at_rest = has_turned_[i] && std::abs(overlap_rate(p_, i, now)) <= k_just_turned;
  switch (p_.branch(i).edge.motion) {
    case Edge::following:
      if (!moves_out) return false;
      stick(i, log);
      return true;
    case Edge::sticking:
      if (is_at_rest) return false;
      if (moves_in && is_past(k_follow, 1.0)) {
        p_.set_branch(i, p_.branch(i).with_edge({}));
        log.push_back(event_of("follow", i));
        return true;
      }
      if (!moves_out || !is_past(k_peel, -1.0)) return false;
      start_peeling(i, y, log);
      return true;
    case Edge::peeling:
      // Beyond pull-off, where only displacement control could hold an edge, a constant force too makes it run away.
      if (is_past(k_pull_off, -1.0) && (moves_out || p_.is_force_controlled(i))) {
        separate(i, y, log);
        return true;
      }
      if (rate < 0.0 && !is_pressed_by_growth) return false;
      stick(i, log);
      has_turned_[i] = true;
      return true;
  }
  return false;
}

// --- transitions

void ModeSearch::start_unloading(std::size_t i, std::string_view why, std::vector<Event>& log) {
  p_.set_branch(i, p_.branch(i).unloaded(p_.law(), p_.at().growth, p_.contact(i).overlap));
  has_turned_[i] = true;
  log.push_back(event_of(why, i));
  if (!p_.law().adheres()) return;
  stick(i, log);
  if (!validity_) validity_ = check_adhesion(p_, i);
}

void ModeSearch::stick(std::size_t i, std::vector<Event>& log) {
  p_.set_branch(i, p_.branch(i).with_edge({Edge::sticking, p_.contact(i).contact.contact_radius}));
  log.push_back(event_of("stick", i));
}

/// Tears the springs at a sticking edge: the edge then recedes in equilibrium, or pulls off at once if it lies within
/// the critical radius.
void ModeSearch::start_peeling(std::size_t i, std::span<double> y, std::vector<Event>& log) {
  const Control control = p_.is_force_controlled(i) ? Control::force : Control::displacement;
  const std::optional<AdhesiveEdge> peeling = p_.branch(i).edge.torn(pull_off_of(p_, i).under(control));
  if (!peeling) {
    separate(i, y, log);
    return;
  }
  p_.set_branch(i, p_.branch(i).with_edge(*peeling));
  log.push_back(event_of("peel", i));
}

/// Opens a contact whose edge is no longer stable (pull-off).
void ModeSearch::separate(std::size_t i, std::span<double> y, std::vector<Event>& log) {
  const AdhesiveEdge& edge = p_.branch(i).edge;
  const bool is_touch = edge.sticks() && edge.radius == 0.0;
  if (p_.is_force_controlled(i)) {
    const Instant& now = p_.contact(i);
    // y counts the work less force times displacement, a term that an open contact no longer has: adds it to keep the
    // work done so far, y[k_work] += n (F delta_w + max(0, -U)). If the contact stores negative energy U, the load has
    // to supply at least that in the snap.
    const double supplied = std::max(0.0, -p_.energy(i, PlasticPart::recoverable));
    y[k_work] += p_.count(i) * (now.contact.force * now.wall_displacement + supplied);
  }
  p_.set_branch(i, p_.branch(i).with_edge({}));
  p_.lose(i);
  log.push_back(event_of(is_touch ? "contact-lost" : "pull-off", i));
  if (!p_.centre().is_free()) return;
  // A free centre snaps away from the opened contact, which relieves the edges that peel elsewhere.
  for (std::size_t j = 0; j < p_.size(); ++j) {
    if (p_.branch(j).edge.peels() && !p_.is_force_controlled(j)) stick(j, log);
  }
}

}  // namespace monograin::mdr
