#include "nonlocal/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "system/difficulty.hpp"
#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

// Steps on the path to a state that Newton's method does not find at once, rejected ones included.
constexpr int k_most_steps = 1000;
constexpr int k_most_round_offs = 20;  // times that the path's end balances but for forces of round-off

/// True if the net force is no larger than the resolution of s makes it. Idle contacts are no deeper than round-off,
/// and their forces need not balance.
bool is_balanced_but_for_round_off(Contacts& contacts, std::span<const double> y) {
  const Evaluation& at = contacts.evaluate(y);
  double widest = 0.0;
  for (std::size_t j = 0; j < contacts.class_count(); ++j) widest = std::max(widest, std::abs(y[j]));
  const double round_off = k_round_off * widest;
  double unresolved = 0.0;
  for (std::size_t j = 0; j < contacts.class_count(); ++j) {
    unresolved += contacts.weight(j) *
                  (contacts.composite_modulus() * contacts.law().at(round_off).force + at.stiffness[j] * round_off);
  }
  return !(contacts.net_force(at.forces).array().abs() > unresolved).any();
}

}  // namespace

EquilibriumSearch::EquilibriumSearch(const Contacts& contacts) : centre_(contacts), newton_(contacts) {
  for (auto* targets : {&targets_, &starts_, &between_}) targets->resize(contacts.class_count());
  for (auto* state : {&trial_, &state_}) state->resize(contacts.unknown_count());
}

void EquilibriumSearch::solve(Contacts& contacts, std::span<const Ramp> ramps, double xi, std::span<double> y,
                              bool is_own_mode) {
  set_targets(contacts, ramps, xi, targets_);
  // Idle walls may move the centre to several positions, of which Newton's method does not choose the nearest.
  if (is_own_mode && centre_.follow(contacts, targets_, y)) return;
  if (balance_from(contacts, y, 1.0)) return;
  if (const double factor = shrinkage(contacts, y); factor < 1.0 && balance_from(contacts, y, factor)) return;
  if (centre_.clear_all(contacts, targets_, y)) return;
  try {
    approach_in_steps(contacts, y);
  } catch (const std::domain_error&) {
    if (!descend_to_balance(contacts, y)) throw;
  }
}

/// Largest prescribed displacement over that of the state y: where walls withdraw together, overlaps and the path of
/// the centre are almost in proportion to it.
double EquilibriumSearch::shrinkage(Contacts& contacts, std::span<const double> y) {
  set_targets_of(contacts, y, targets_, starts_);
  double end = 0.0;
  double start = 0.0;
  for (std::size_t j = 0; j < targets_.size(); ++j) {
    if (targets_[j].is_force) continue;
    end = std::max(end, targets_[j].value);
    start = std::max(start, starts_[j].value);
  }
  return start > 0.0 ? std::min(1.0, end / start) : 1.0;
}

/// Finds the equilibrium by Newton's method from the state y times a factor.
/// @return false, with y unchanged, if this leads to no state on the branch
bool EquilibriumSearch::balance_from(Contacts& contacts, std::span<double> y, double factor) {
  std::ranges::transform(y, trial_.begin(), [factor](double one) { return factor * one; });
  if (!newton_.solve(contacts, {.targets = targets_}, trial_) || has_left_branch(contacts, targets_, trial_) ||
      !is_balanced(contacts, targets_, trial_))
    return false;
  std::ranges::copy(trial_, y.begin());
  return true;
}

void EquilibriumSearch::clear_centre(Contacts& contacts, std::span<const Ramp> ramps, double xi,
                                     std::span<const char> is_closed, std::span<double> y) {
  set_targets(contacts, ramps, xi, targets_);
  if (centre_.clear_all(contacts, targets_, y)) return;
  if (contacts.free_count() > 0)
    centre_.clear_redundant(contacts, targets_, is_closed, y);
  else
    close_gaps(contacts, is_closed, y);
}

/// Sets the gaps of open walls from their displacements and the forces on the others. A distant force may lift a wall's
/// contact by less than the integration error of its gap.
void EquilibriumSearch::close_gaps(Contacts& contacts, std::span<const char> is_closed, std::span<double> y) const {
  const Evaluation& at = contacts.evaluate(y);
  for (std::size_t j = 0; j < targets_.size(); ++j) {
    if (is_closed[j] || targets_[j].is_force) continue;
    const double approach = targets_[j].value + contacts.lift_by_forces(j, at.forces);
    y[j] = approach > 0.0 ? contacts.law().signed_square(approach) : approach;
  }
}

/// Follows the straight line from the displacements, forces and imbalance of the state y to the targets. From a point
/// to a near one, Newton's method contracts only on the branch of the first.
void EquilibriumSearch::approach_in_steps(Contacts& contacts, std::span<double> y) {
  if (!(contacts.least_pivot(y) > 0.0)) throw DomainError(Limit::applicability);
  std::ranges::copy(y, state_.begin());
  set_targets_of(contacts, y, targets_, starts_);
  const Eigen::Vector3d imbalance = contacts.net_force(contacts.evaluate(y).forces);

  double done = 0.0;
  double step = 0.5;
  int round_offs = 0;
  for (int steps = 1; done < 1.0; ++steps) {
    const double next = std::min(1.0, done + step);
    set_targets_between(contacts, starts_, targets_, next, between_);
    std::ranges::copy(state_, trial_.begin());
    // Only the end has to be in balance.
    const Goal goal{.targets = between_, .is_to_balance = next == 1.0, .imbalance = (1.0 - next) * imbalance};
    const bool is_on_branch = newton_.solve(contacts, goal, trial_) && !has_left_branch(contacts, between_, trial_);
    if (is_on_branch && (next < 1.0 || is_balanced(contacts, between_, trial_))) {
      std::ranges::copy(trial_, state_.begin());
      done = next;
      step *= 2.0;
      continue;
    }
    step *= 0.5;
    // A path that also accepts short steps now and then may still not arrive.
    const bool may_go_on = step > k_same_instant && steps < k_most_steps;
    if (is_on_branch && is_balanced_but_for_round_off(contacts, trial_) &&
        (++round_offs == k_most_round_offs || !may_go_on)) {
      std::ranges::copy(trial_, state_.begin());
      break;
    }
    if (!may_go_on) throw_no_state(contacts, is_on_branch, done);
  }
  std::ranges::copy(state_, y.begin());
}

/// Throws the reason why a path in steps ends in state_.
/// @param done  share of the path up to there
void EquilibriumSearch::throw_no_state(Contacts& contacts, bool is_on_branch, double done) const {
  if (is_on_branch || !may_balance(contacts, targets_, state_)) throw DomainError(Limit::centre_driven_away);
  const double widest =
      std::ranges::max_element(contacts.evaluate(state_).local, {}, &LocalContact::contact_radius)->contact_radius;
  const double margin = contacts.margin(state_);
  // The path ends at the limit of applicability, or where the contacts open, as near as a search resolves these.
  if (margin < k_hard_margin) throw DomainError({Limit::applicability, -1, "margin", margin});
  if (widest * widest < k_resolution) throw DomainError(Limit::centre_not_held);
  throw DomainError(Limit::no_solution, "no equilibrium on the branch of the unloaded state beyond " +
                                            std::to_string(100.0 * done) +
                                            " % of the path to the prescribed displacements and forces, where the "
                                            "largest contact radius over R is " +
                                            std::to_string(widest));
}

/// Finds the equilibrium from a guess whose errors exceed the overlaps: moves the centre in the direction in which the
/// particle's energy falls. As a function of the centre's position, the energy is convex wherever M is positive
/// definite, so that no guess is too far away.
/// @return false, with y unchanged, if the search does not reach balance, or if M is not positive definite with every
/// contact as deep as the deeper of y and the result
bool EquilibriumSearch::descend_to_balance(Contacts& contacts, std::span<double> y) {
  if (contacts.free_count() == 0) return false;
  std::ranges::copy(y, state_.begin());
  double size = contacts.centre_of(state_).norm();
  for (std::size_t j = 0; j < targets_.size(); ++j) {
    size = std::max({size, std::abs(y[j]), targets_[j].is_force ? 0.0 : std::abs(targets_[j].value)});
  }
  const auto net_at = [&](const Eigen::Vector3d& position) -> std::optional<Eigen::Vector3d> {
    std::ranges::copy(state_, trial_.begin());
    contacts.set_centre(position, trial_);
    if (!newton_.solve(contacts, {.targets = targets_, .holds_centre = true}, trial_)) return std::nullopt;
    return newton_.net_force(contacts);
  };
  Eigen::Vector3d position = contacts.centre_of(state_);
  auto net = net_at(position);
  for (int step = 0; net && step < k_most_newton_steps; ++step) {
    Eigen::Vector3d move = newton_.step_to_balance(contacts, *net);
    if (move.norm() <= k_round_off * size) break;
    move *= std::min(1.0, size / move.norm());
    const double power = move.dot(*net);
    // A step is halved if there is no state at its end, or if it goes too far past the balance: the energy rises there
    // half as steeply as it falls at the start.
    auto next = net_at(position + move);
    for (; !(next && move.dot(*next) <= -0.5 * power) && move.norm() > k_round_off * size;
         next = net_at(position + move)) {
      move *= 0.5;
    }
    position += move;
    net = next;
    std::ranges::copy(trial_, state_.begin());
  }
  if (!net || has_left_branch(contacts, targets_, trial_) || !is_balanced(contacts, targets_, trial_)) return false;
  for (std::size_t j = 0; j < targets_.size(); ++j) state_[j] = std::max(y[j], trial_[j]);
  if (!(contacts.least_pivot(state_) > 0.0)) return false;
  std::ranges::copy(trial_, y.begin());
  return true;
}

}  // namespace monograin::nonlocal
