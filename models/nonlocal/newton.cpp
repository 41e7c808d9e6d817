#include "nonlocal/newton.hpp"

#include <algorithm>
#include <cmath>

#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

constexpr int k_first_touch_steps = 20;
constexpr double k_stagnation = 1e-9;  // relative correction that is round-off, which grows with 1/margin

/// Magnitude of the net prescribed force along the directions in which no contact supports the centre, however small
/// beside other forces; 0 if only round-off is left of it. Contacts under force control support nothing.
double unborne_force(const Contacts& contacts, std::span<const Target> targets, std::span<const double> stiffness) {
  if (std::ranges::none_of(targets, &Target::is_force)) return 0.0;
  const Eigen::Matrix3d projector =
      directions_of_nothing(contacts, [&](std::size_t j) { return targets[j].is_force ? 0.0 : stiffness[j]; });
  Eigen::Vector3d push = Eigen::Vector3d::Zero();
  double sum = 0.0;
  for (std::size_t j = 0; j < targets.size(); ++j) {
    const Eigen::Vector3d along = projector * contacts.mean_normal(j);
    if (!targets[j].is_force || along.norm() <= k_same_direction) continue;
    push += contacts.weight(j) * targets[j].value * along;
    sum += contacts.weight(j) * targets[j].value;
  }
  return push.norm() > k_same_value * sum ? push.norm() : 0.0;
}

}  // namespace

bool has_left_branch(Contacts& contacts, std::span<const Target> targets, std::span<const double> y) {
  const bool has_unseen_modes = contacts.has_modes_of_walls() || std::ranges::any_of(targets, &Target::is_force);
  return has_unseen_modes && !(contacts.least_pivot(y) > 0.0);
}

bool is_balanced(Contacts& contacts, std::span<const Target> targets, std::span<const double> y) {
  if (contacts.free_count() == 0) return true;
  const Evaluation& at = contacts.evaluate(y);
  double sum = 0.0;
  for (std::size_t j = 0; j < targets.size(); ++j) sum += contacts.weight(j) * at.forces[j];
  if ((contacts.net_force(at.forces).array().abs() > k_no_net_force * sum).any()) return false;
  return unborne_force(contacts, targets, at.stiffness) == 0.0;
}

/// Collects what a search knows before its first correction.
Newton::Search Newton::begin(const Contacts& contacts, const Goal& goal, std::span<const double> y) {
  Search search{.moves_centre = contacts.free_count() > 0 && !goal.holds_centre};
  for (const Target& target : goal.targets) {
    if (goal.is_to_balance && !target.is_force) search.farthest = std::max(search.farthest, std::abs(target.value));
    if (!target.is_force || !(target.signed_square > search.deepest)) continue;
    search.deepest = target.signed_square;
    search.touch_stiffness = target.value / search.deepest;
  }
  search.is_first_touch = search.moves_centre;
  for (std::size_t j = 0; j < goal.targets.size(); ++j) {
    // The depth of a contact under a force does not show which contacts will support the centre.
    if (!goal.targets[j].is_force && y[j] > k_unloaded * search.farthest) search.is_first_touch = false;
  }
  // After first touch, a wall that nothing opposes moves the centre. The first correction gives that wall a force
  // s^(3/2), which the next ones undo by 2/3, 2/9 ... of it; the ratio 2/3 would fail the test of contraction.
  if (search.moves_centre && goal.is_to_balance) search.free_steps = 2;
  if (search.is_first_touch) search.free_steps = k_first_touch_steps;
  return search;
}

/// Evaluates contacts, forces and stiffnesses of a trial, and the misfits of their approaches. A contact under a force
/// takes the depth of that force; its wall follows the surface, so that its stiffness is 0.
/// @return false for a contact beyond the end of the law
bool Newton::evaluate(const Contacts& contacts, const Goal& goal, std::span<double> y) {
  for (std::size_t j = 0; j < goal.targets.size(); ++j) {
    if (goal.targets[j].is_force) {
      y[j] = goal.targets[j].signed_square;
      at_.forces[j] = goal.targets[j].value;
      at_.stiffness[j] = 0.0;
      at_.local[j].approach_slope = 1.0;
      continue;
    }
    if (!(y[j] < contacts.law().end())) return false;
    at_.set(j, contacts.law(), contacts.composite_modulus(), y[j]);
  }
  for (std::size_t j = 0; j < goal.targets.size(); ++j) {
    tangent_.approach(j) = goal.targets[j].is_force
                               ? 0.0
                               : goal.targets[j].value + contacts.lift(j, at_.forces, y) - at_.local[j].approach;
  }
  return true;
}

/// Gives stiffness to touching walls if a prescribed force begins in a direction in which no contact supports the
/// centre. Only these walls can bear such a force; they get the stiffness that they would have under it.
/// @param gap  up to which a wall counts as touching
/// @return true if there is such a force
bool Newton::regularize_stiffness(const Contacts& contacts, const Goal& goal, double gap, std::span<const double> y) {
  const double force = unborne_force(contacts, goal.targets, at_.stiffness);
  if (force == 0.0) return false;
  const LocalLaw& law = contacts.law();
  const double square = law.signed_square_under(std::min(force / contacts.composite_modulus(), law.greatest_force()));
  for (std::size_t j = 0; j < goal.targets.size(); ++j) {
    if (!goal.targets[j].is_force && at_.stiffness[j] == 0.0 && y[j] >= -gap) at_.stiffness[j] = force / square;
  }
  return true;
}

/// Net force on the centre after the corrections of the approaches, to first order, less the imbalance that may remain.
Eigen::Vector3d Newton::corrected_net_force(const Contacts& contacts, const Goal& goal) {
  Eigen::Vector3d sum = -goal.imbalance + net_force(contacts);
  for (std::size_t j = 0; j < goal.targets.size(); ++j)
    sum += contacts.weight(j) * contacts.mean_normal(j) * at_.stiffness[j] * tangent_.approach(j);
  return sum;
}

/// Gives touching walls without stiffness that of contacts under the greatest force.
void Newton::stiffen_touching(const Contacts& contacts, const Goal& goal, const Search& search,
                              std::span<const double> y) {
  for (std::size_t j = 0; j < goal.targets.size(); ++j) {
    if (goal.targets[j].is_force || at_.stiffness[j] != 0.0) continue;
    if (goal.targets[j].value + contacts.mean_normal(j).dot(contacts.centre_of(y)) >= -search.deepest)
      at_.stiffness[j] = search.touch_stiffness;
  }
}

/// Corrects the position of a free centre so that the forces balance to first order.
/// @param may_find_more  true if further touching walls may support the centre where the contacts do not
void Newton::balance_centre(const Contacts& contacts, const Goal& goal, const Search& search, bool may_find_more,
                            std::span<double> y) {
  const auto centre = y.subspan(contacts.class_count());
  if (carries_no_load(at_.stiffness)) stiffen_touching(contacts, goal, search, y);
  const Eigen::Vector3d unbalanced = corrected_net_force(contacts, goal);
  tangent_.move_centre(contacts, at_.stiffness, unbalanced, centre);
  if (!may_find_more) return;
  double borne = 0.0;
  for (std::size_t j = 0; j < contacts.class_count(); ++j) borne += contacts.weight(j) * at_.forces[j];
  const Eigen::Matrix3d projector = directions_of_nothing(contacts, [this](std::size_t j) { return at_.stiffness[j]; });
  if (!((projector * unbalanced).norm() > k_no_net_force * borne)) return;
  const Eigen::Vector3d rest = corrected_net_force(contacts, goal);
  stiffen_touching(contacts, goal, search, y);
  tangent_.move_centre(contacts, at_.stiffness, rest, centre);
}

/// Corrects the signed squares by the corrections found for the approaches.
Newton::Correction Newton::correct_squares(const Goal& goal, std::span<double> y) {
  Correction correction;
  for (std::size_t j = 0; j < goal.targets.size(); ++j) {
    if (goal.targets[j].is_force) continue;
    const double step = tangent_.approach(j) / at_.local[j].approach_slope;
    y[j] += step;
    correction.largest = std::max(correction.largest, std::abs(step));
    correction.scale = std::max(correction.scale, std::abs(y[j]));
  }
  return correction;
}

/// True for a correction that does not contract because it is round-off. Contacts that are shallow against the path of
/// the centre carry the round-off of that path.
bool Newton::is_round_off(const Contacts& contacts, const Goal& goal, const Correction& correction,
                          std::span<const double> y) const {
  double length = 0.0;
  for (std::size_t j = 0; j < goal.targets.size(); ++j) {
    if (goal.targets[j].is_force) continue;
    length = std::max({length, std::abs(goal.targets[j].value), std::abs(contacts.lift(j, at_.forces, y))});
  }
  return correction.largest <= std::max(k_stagnation * correction.scale, k_round_off * length);
}

bool Newton::solve(const Contacts& contacts, const Goal& goal, std::span<double> y) {
  Search search = begin(contacts, goal, y);
  const bool may_lend = search.moves_centre && goal.is_to_balance && !search.is_first_touch;
  double last = 0.0;
  for (int iteration = 0; iteration < k_most_newton_steps; ++iteration) {
    if (!evaluate(contacts, goal, y)) return false;
    if (iteration == 0 && may_lend && regularize_stiffness(contacts, goal, k_touching * search.farthest, y)) {
      search.free_steps = k_first_touch_steps;
    }
    if (!tangent_.eliminate(contacts, at_.stiffness)) return false;
    const bool is_free_step = iteration < search.free_steps;
    if (search.moves_centre) balance_centre(contacts, goal, search, search.is_first_touch && is_free_step, y);
    const Correction correction = correct_squares(goal, y);
    // The remaining error is at most one further contraction of this correction.
    const double contraction = iteration > 0 ? std::min(correction.largest / last, 1.0) : 1.0;
    if (correction.largest * contraction <= k_round_off * correction.scale) return true;
    // Where a correction is not half of the last one, the guess is too far away.
    if (!is_free_step && contraction > 0.5) return is_round_off(contacts, goal, correction, y);
    last = correction.largest;
  }
  return false;
}

}  // namespace monograin::nonlocal
