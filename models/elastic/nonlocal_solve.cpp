// How the contacts of a nonlocal elastic sphere find their state: Newton's method, and a path in steps where it fails.

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "elastic/nonlocal_contacts.hpp"
#include "system/limit.hpp"

namespace monograin::nonlocal {
namespace {

constexpr int k_newton_limit = 100;    // contraction by half reaches round-off in 52
constexpr double k_contraction = 0.5;  // largest ratio of Newton's corrections; beyond it the guess is too far away
constexpr int k_first_touch_steps = 20;
constexpr double k_stagnation = 1e-9;   // relative correction that is round-off, which grows with 1/margin
constexpr double k_least_step = 1e-13;  // of the path to a state that Newton's method does not find at once
constexpr int k_most_steps = 1000;      // on that path, rejected ones included
constexpr int k_most_roundings = 20;    // times that the path's end balances but for forces of round-off

// Smallest margin, and smallest contact radius over R, that a search along a path resolves: the path ends at the limit
// of applicability, or where the contacts open.
constexpr double k_no_margin = 5e-4;
constexpr double k_no_contact = 5e-7;

}  // namespace

Contacts::Target Contacts::target(bool is_force, double value) const {
  if (!std::isfinite(value)) throw std::domain_error("a wall is prescribed a value that is not finite");
  return {is_force, value, is_force ? law_.signed_square_under(value / modulus_) : 0.0};
}

/// Sets the targets at an instant of a step of the program.
void Contacts::set_targets(std::span<const Ramp> ramps, double xi) {
  for (std::size_t j = 0; j < class_count(); ++j) {
    targets_[j] = target(ramps[j].control == Control::force, std::lerp(ramps[j].start, ramps[j].end, xi));
  }
}

/// Finds the targets of which the state y is the solution, with the controls of `ends`.
void Contacts::find_start(std::span<const Target> ends, std::span<const double> y, std::span<Target> starts) {
  evaluate(y);
  for (std::size_t j = 0; j < class_count(); ++j) {
    const bool is_force = ends[j].is_force;
    starts[j] = {is_force, is_force ? forces_[j] : now_[j].approach - lift(j, y), y[j]};
  }
}

/// Sets targets on the straight line from starts to ends.
void Contacts::set_targets_between(std::span<const Target> starts, std::span<const Target> ends, double share) {
  for (std::size_t j = 0; j < class_count(); ++j) {
    targets_[j] = share == 1.0 ? ends[j] : target(ends[j].is_force, std::lerp(starts[j].value, ends[j].value, share));
  }
}

/// Collects what a search knows before its first correction.
/// @param imbalance  share of imbalance_ that may remain
Contacts::Search Contacts::begin_search(std::span<const double> y, double imbalance, bool moves_centre) const {
  Search search{.imbalance = imbalance, .moves_centre = moves_centre};
  for (const Target& goal : targets_) {
    if (search.is_to_balance() && !goal.is_force) search.farthest = std::max(search.farthest, std::abs(goal.value));
    if (!goal.is_force || !(goal.signed_square > search.deepest)) continue;
    search.deepest = goal.signed_square;
    search.touch_stiffness = goal.value / search.deepest;
  }
  search.is_first_touch = moves_centre;
  for (std::size_t j = 0; j < class_count(); ++j) {
    // The depth of a contact under a force does not show which contacts will support the centre.
    if (!targets_[j].is_force && y[j] > k_unloaded * search.farthest) search.is_first_touch = false;
  }
  // After first touch, a wall that nothing opposes moves the centre. The first correction gives that wall a force
  // s^(3/2), which the next ones undo by 2/3, 2/9 ... of it; the ratio 2/3 would fail the test of contraction.
  if (moves_centre && search.is_to_balance()) search.free_steps = 2;
  if (search.is_first_touch) search.free_steps = k_first_touch_steps;
  return search;
}

/// Evaluates contacts, forces and stiffnesses of a trial. A contact under a force takes the depth of that force and
/// gives way: its stiffness is 0.
/// @return false for a contact beyond the end of the law
bool Contacts::evaluate_trial(std::span<double> y) {
  for (std::size_t j = 0; j < class_count(); ++j) {
    const Target& goal = targets_[j];
    if (goal.is_force) {
      y[j] = goal.signed_square;
      forces_[j] = goal.value;
      stiffness_[j] = 0.0;
      now_[j].approach_slope = 1.0;
      continue;
    }
    if (!(y[j] < law_.end())) return false;
    now_[j] = law_.at(y[j]);
    forces_[j] = modulus_ * now_[j].force;
    stiffness_[j] = 2.0 * modulus_ * now_[j].contact_radius;
  }
  return true;
}

/// Sets the right-hand sides of the corrections: the misfit of each approach.
void Contacts::set_misfits(std::span<const double> y) {
  const std::size_t n = class_count();
  for (std::size_t j = 0; j < n; ++j) {
    entry(j, n) = targets_[j].is_force ? 0.0 : targets_[j].value + lift(j, y) - now_[j].approach;
  }
}

/// Net force on the centre after the corrections of the approaches, to first order, less the imbalance that may remain.
Eigen::Vector3d Contacts::corrected_net_force(double imbalance) {
  const std::size_t n = class_count();
  Eigen::Vector3d sum = -imbalance * imbalance_;
  for (std::size_t k = 0; k < free_count(); ++k) {
    sum[at(k)] += net_force(k);
    for (std::size_t j = 0; j < n; ++j) sum[at(k)] += weights_[j] * arms_(at(j), at(k)) * stiffness_[j] * entry(j, n);
  }
  return sum;
}

/// Gives touching walls without stiffness that of contacts under the greatest force.
void Contacts::stiffen_touching(const Search& search, std::span<const double> y) {
  for (std::size_t j = 0; j < class_count(); ++j) {
    if (targets_[j].is_force || stiffness_[j] != 0.0) continue;
    if (targets_[j].value + arm_of(j).dot(place_of(y)) >= -search.deepest) stiffness_[j] = search.touch_stiffness;
  }
}

/// Corrects the position of a free centre so that the forces balance to first order.
/// @param may_find_more  true if further touching walls may support the centre where the contacts do not
void Contacts::balance_centre(const Search& search, bool may_find_more, std::span<double> y) {
  const auto centre = y.subspan(class_count());
  if (carries_no_load()) stiffen_touching(search, y);
  const Eigen::Vector3d unbalanced = corrected_net_force(search.imbalance);
  move_centre(unbalanced, centre);
  if (!may_find_more) return;
  double borne = 0.0;
  for (std::size_t j = 0; j < class_count(); ++j) borne += weights_[j] * forces_[j];
  if (!((directions_of_nothing() * unbalanced).norm() > k_balance * borne)) return;
  const Eigen::Vector3d rest = corrected_net_force(search.imbalance);
  stiffen_touching(search, y);
  move_centre(rest, centre);
}

/// Corrects the signed squares by the corrections found for the approaches.
Contacts::Correction Contacts::correct_squares(std::span<double> y) {
  const std::size_t n = class_count();
  Correction correction;
  for (std::size_t j = 0; j < n; ++j) {
    if (targets_[j].is_force) continue;
    const double step = entry(j, n) / now_[j].approach_slope;
    y[j] += step;
    correction.largest = std::max(correction.largest, std::abs(step));
    correction.scale = std::max(correction.scale, std::abs(y[j]));
  }
  return correction;
}

/// True for a correction that does not contract because it is round-off. Contacts that are shallow against the path of
/// the centre carry the round-off of that path.
bool Contacts::is_rounding(const Correction& correction, std::span<const double> y) const {
  double length = 0.0;
  for (std::size_t j = 0; j < class_count(); ++j) {
    if (!targets_[j].is_force) length = std::max({length, std::abs(targets_[j].value), std::abs(lift(j, y))});
  }
  return correction.largest <= std::max(k_stagnation * correction.scale, k_resolved * length);
}

/// Newton's method towards the targets, with a part of the imbalance left. Gives up if its corrections do not contract,
/// or if M is not positive definite: other branches lie beyond such a state.
bool Contacts::newton(std::span<double> y, double imbalance, bool do_hold_centre) {
  Search search = begin_search(y, imbalance, free_count() > 0 && !do_hold_centre);
  const bool may_lend = search.moves_centre && search.is_to_balance() && !search.is_first_touch;
  double last = 0.0;
  forget();
  for (int iteration = 0; iteration < k_newton_limit; ++iteration) {
    if (!evaluate_trial(y)) return false;
    set_misfits(y);
    if (iteration == 0 && may_lend && lend_stiffness(k_touching * search.farthest, y)) {
      search.free_steps = k_first_touch_steps;
    }
    if (!eliminate()) return false;
    const bool is_free_step = iteration < search.free_steps;
    if (search.moves_centre) balance_centre(search, search.is_first_touch && is_free_step, y);
    const Correction correction = correct_squares(y);
    // The remaining error is at most one further contraction of this correction.
    const double contraction = iteration > 0 ? std::min(correction.largest / last, 1.0) : 1.0;
    if (correction.largest * contraction <= k_resolved * correction.scale) return true;
    if (!is_free_step && contraction > k_contraction) return is_rounding(correction, y);
    last = correction.largest;
  }
  return false;
}

/// True if a state found by Newton's method is off the branch in modes that the method does not see: those of single
/// walls, and of contacts under force control.
bool Contacts::has_left_branch(std::span<const double> y) {
  const bool has_unseen_modes = has_modes_of_walls_ || std::any_of(targets_.begin(), targets_.end(),
                                                                   [](const Target& goal) { return goal.is_force; });
  return has_unseen_modes && !(least_pivot(y) > 0.0);
}

bool Contacts::is_balanced(std::span<const double> y) {
  if (free_count() == 0) return true;
  evaluate(y);
  double sum = 0.0;
  for (std::size_t j = 0; j < class_count(); ++j) sum += weights_[j] * forces_[j];
  for (std::size_t k = 0; k < free_count(); ++k) {
    if (std::abs(net_force(k)) > k_balance * sum) return false;
  }
  forget();
  for (std::size_t j = 0; j < class_count(); ++j) {
    if (targets_[j].is_force) stiffness_[j] = 0.0;
  }
  return unborne_force() == 0.0;
}

/// True if the net force is no larger than the resolution of s makes it. Idle contacts are no deeper than round-off,
/// and their forces need not balance.
bool Contacts::is_balanced_but_for_rounding(std::span<const double> y) {
  evaluate(y);
  double widest = 0.0;
  for (std::size_t j = 0; j < class_count(); ++j) widest = std::max(widest, std::abs(y[j]));
  const double rounding = k_resolved * widest;
  double unresolved = 0.0;
  for (std::size_t j = 0; j < class_count(); ++j) {
    unresolved += weights_[j] * (modulus_ * law_.at(rounding).force + stiffness_[j] * rounding);
  }
  for (std::size_t k = 0; k < free_count(); ++k) {
    if (std::abs(net_force(k)) > unresolved) return false;
  }
  return true;
}

void Contacts::solve(std::span<const Ramp> ramps, double xi, std::span<double> y, bool is_own_mode) {
  set_targets(ramps, xi);
  // Idle walls may move the centre to several positions, of which Newton's method does not choose the nearest.
  if (is_own_mode && find_holding(y) && take_centre_to_targets(y)) return;
  std::copy(y.begin(), y.end(), trial_.begin());
  for (std::size_t j = 0; j < class_count(); ++j) {
    if (targets_[j].is_force) trial_[j] = targets_[j].signed_square;
  }
  if (newton(trial_, 0.0) && !has_left_branch(trial_) && is_balanced(trial_)) {
    std::copy(trial_.begin(), trial_.end(), y.begin());
  } else if (!let_all_go(y)) {
    try {
      approach_in_steps(y);
    } catch (const std::domain_error&) {
      std::copy(last_targets_.begin(), last_targets_.end(), targets_.begin());
      if (!sink_to_balance(y)) throw;
    }
  }
}

/// Follows the straight line from the displacements, forces and imbalance of the state y to the targets. From a point
/// to a near one, Newton's method contracts only on the branch of the first.
void Contacts::approach_in_steps(std::span<double> y) {
  const double pivot = least_pivot(y);
  if (!(pivot > 0.0)) {
    throw DomainError({Limit::applicability, -1, "pivot", pivot});
  }
  std::copy(y.begin(), y.end(), state_.begin());
  std::copy(targets_.begin(), targets_.end(), last_targets_.begin());
  find_start(last_targets_, y, first_targets_);
  for (std::size_t k = 0; k < free_count(); ++k) imbalance_[at(k)] = net_force(k);

  double done = 0.0;
  double step = 0.5;
  int roundings = 0;
  for (int steps = 1; done < 1.0; ++steps) {
    const double next = std::min(1.0, done + step);
    set_targets_between(first_targets_, last_targets_, next);
    std::copy(state_.begin(), state_.end(), trial_.begin());
    // Only the end has to be in balance.
    const bool is_on_branch = newton(trial_, 1.0 - next) && !has_left_branch(trial_);
    if (is_on_branch && (next < 1.0 || is_balanced(trial_))) {
      std::copy(trial_.begin(), trial_.end(), state_.begin());
      done = next;
      step *= 2.0;
      continue;
    }
    step *= 0.5;
    // A path that also accepts short steps now and then may still not arrive.
    const bool may_go_on = step > k_least_step && steps < k_most_steps;
    if (is_on_branch && is_balanced_but_for_rounding(trial_) && (++roundings == k_most_roundings || !may_go_on)) {
      std::copy(trial_.begin(), trial_.end(), state_.begin());
      break;
    }
    if (may_go_on) continue;
    if (is_on_branch || !may_balance(last_targets_, state_)) throw DomainError(Limit::centre_driven_away);
    evaluate(state_);
    const auto widest = std::max_element(
        now_.begin(), now_.end(), [](const auto& a, const auto& b) { return a.contact_radius < b.contact_radius; });
    if (margin(state_) < k_no_margin) throw DomainError({Limit::applicability, -1, "margin", margin(state_)});
    if (widest->contact_radius < k_no_contact) throw DomainError(Limit::centre_not_held);
    throw DomainError(Limit::no_solution,
                      "no equilibrium on the branch of the unloaded state beyond " + std::to_string(100.0 * done) +
                          " % of the path to the prescribed displacements and forces, where the largest contact "
                          "radius over R is " +
                          std::to_string(widest->contact_radius));
  }
  std::copy(state_.begin(), state_.end(), y.begin());
}

}  // namespace monograin::nonlocal
