#include "nonlocal/centre.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

// Shares of a step before its end at which touching walls are read, too. Too far from the end, a wall that has only
// just left goes unnoticed; too near, the remainder is round-off.
constexpr std::array k_late{1e-3, 1e-6, 1e-9};

}  // namespace

CentreSearch::CentreSearch(const Contacts& contacts) : support_(contacts), newton_(contacts) {
  const std::size_t n = contacts.class_count();
  obstacles_.reserve(n);
  forces_.resize(n);
  for (auto* targets : {&starts_, &ends_, &targets_, &released_}) targets->resize(n);
  for (auto* state : {&trial_, &deepest_, &carried_, &at_once_, &by_halves_, &early_, &late_})
    state->resize(contacts.unknown_count());
}

bool CentreSearch::clear_all(const Contacts& contacts, std::span<const Target> targets, std::span<double> y) {
  obstacles_.clear();
  for (std::size_t j = 0; j < targets.size(); ++j) {
    if (targets[j].is_force && targets[j].value != 0.0) return false;
    if (!targets[j].is_force) obstacles_.push_back({j, contacts.mean_normal(j), targets[j].value});
  }
  Eigen::Vector3d centre = contacts.centre_of(y);
  if (!release_centre(obstacles_, Eigen::Matrix3d::Identity(), centre)) return false;
  std::fill_n(y.begin(), targets.size(), 0.0);
  put_centre(contacts, obstacles_, centre, y);
  return true;
}

void CentreSearch::clear_redundant(const Contacts& contacts, std::span<const Target> targets,
                                   std::span<const char> is_closed, std::span<double> y) {
  support_.sort(
      contacts,
      [&](std::size_t j) { return targets[j].is_force ? targets[j].value > 0.0 : is_closed[j] || y[j] > 0.0; },
      [&](std::size_t j) { return targets[j].is_force; });
  if (!support_.has_redundant_walls()) return;
  for (std::size_t j = 0; j < targets.size(); ++j) {
    forces_[j] = support_.is_redundant(j) ? 0.0 : contacts.composite_modulus() * contacts.law().at(y[j]).force;
  }
  obstacles_.clear();
  for (std::size_t j = 0; j < targets.size(); ++j) {
    if (!support_.is_redundant(j) || targets[j].is_force) continue;
    obstacles_.push_back({j, contacts.mean_normal(j), targets[j].value + contacts.lift_by_forces(j, forces_)});
  }
  Eigen::Vector3d centre = contacts.centre_of(y);
  if (release_centre(obstacles_, support_.unheld_directions(contacts), centre))
    put_centre(contacts, obstacles_, centre, y);
}

/// Finds the equilibrium at targets_ if the contacts that support_ has found hold the centre in some directions only.
/// The stiffness of idle walls vanishes, so that Newton steps are unbounded: the constrained part is solved by itself,
/// and the centre then evades the idle walls where that changes no load. Where M is positive definite for every depth
/// between the two states, no other state that is no deeper is in equilibrium.
/// @return false, with y unchanged, if there is no such state
bool CentreSearch::clear_idle(Contacts& contacts, std::span<double> y) {
  const std::size_t n = contacts.class_count();
  const auto is_idle = [&](std::size_t j) { return !support_.holds(j) && !targets_[j].is_force; };
  for (std::size_t j = 0; j < n; ++j) released_[j] = is_idle(j) ? target_of(contacts, true, 0.0) : targets_[j];
  const Eigen::Matrix3d projector = support_.unheld_directions(contacts);
  std::ranges::copy(y, trial_.begin());
  const bool is_found = projector.trace() > 0.5 && newton_.solve(contacts, {.targets = released_}, trial_) &&
                        is_balanced(contacts, released_, trial_);
  if (!is_found) return false;

  const Evaluation& at = contacts.evaluate(trial_);
  obstacles_.clear();
  for (std::size_t j = 0; j < n; ++j) {
    if (is_idle(j))
      obstacles_.push_back({j, contacts.mean_normal(j), targets_[j].value + contacts.lift_by_forces(j, at.forces)});
  }
  Eigen::Vector3d centre = contacts.centre_of(trial_);
  if (!clear_walls(obstacles_, projector, centre)) return false;
  put_centre(contacts, obstacles_, centre, trial_);
  for (std::size_t j = 0; j < n; ++j) deepest_[j] = std::max(y[j], trial_[j]);
  if (!(contacts.least_pivot(deepest_) > 0.0)) return false;
  std::ranges::copy(trial_, y.begin());
  return true;
}

/// Moves a state to a share of the path.
/// @param size  length to which distances on the path are compared
bool CentreSearch::go_to(Contacts& contacts, double share, double size, std::span<double> y) {
  set_targets_between(contacts, starts_, ends_, share, targets_);
  if (clear_all(contacts, targets_, y)) return true;
  static_cast<void>(support_.sort_loaded(contacts, targets_, y, k_touching * size));
  return clear_idle(contacts, y);
}

/// Goes from carried_ to by_halves_, and to the states by which the step is judged.
/// @param may_be_cut  false: accepts the step whatever these states are
bool CentreSearch::try_step(Contacts& contacts, double done, double next, double size, bool may_be_cut) {
  for (auto* state : {&at_once_, &by_halves_, &early_, &late_}) std::ranges::copy(carried_, state->begin());
  const auto reach = [&](double share, std::span<double> y) { return go_to(contacts, share, size, y); };
  const auto touch_the_same = [&](std::span<const double> other) {
    for (std::size_t j = 0; j < contacts.class_count(); ++j) {
      if ((at_once_[j] == 0.0) != (other[j] == 0.0)) return false;
    }
    return true;
  };
  const auto lead_to_one_position = [&] {
    return (contacts.centre_of(at_once_) - contacts.centre_of(by_halves_)).norm() <= k_same_value * size;
  };
  // The test that rejects a step soonest comes first, because most steps are too long.
  const auto goes_on = [may_be_cut](bool is_same) { return is_same || !may_be_cut; };
  return reach(next, at_once_) && reach(std::lerp(done, next, k_ahead), early_) && goes_on(touch_the_same(early_)) &&
         reach(std::midpoint(done, next), by_halves_) && reach(next, by_halves_) && goes_on(lead_to_one_position()) &&
         std::ranges::all_of(k_late, [&](double late) { return reach(std::lerp(done, next, 1.0 - late), late_); }) &&
         reach(next, late_) && goes_on(touch_the_same(late_));
}

bool CentreSearch::follow(Contacts& contacts, std::span<const Target> targets, std::span<double> y) {
  const bool others_remain = support_.sort_loaded(contacts, targets, y);
  if (!others_remain || support_.unheld_directions(contacts).trace() < 0.5) return false;
  std::ranges::copy(targets, ends_.begin());
  set_targets_of(contacts, y, ends_, starts_);
  double size = contacts.centre_of(y).norm();
  for (std::size_t j = 0; j < ends_.size(); ++j) {
    if (!ends_[j].is_force) size = std::max({size, std::abs(starts_[j].value), std::abs(ends_[j].value)});
  }
  std::ranges::copy(y, carried_.begin());
  double step = 1.0;
  double too_far = 1.0;  // end of the last step that was too long
  // To close in on where a wall begins or ceases to touch takes as many rejected steps as halvings. Where more of them
  // are rejected, differences are round-off.
  int tries = k_most_halvings * static_cast<int>(ends_.size() + 1);
  for (double done = 0.0; done < 1.0;) {
    const double next = std::min(1.0, done + step);
    const bool may_be_cut = step > k_same_value && tries > 0;
    if (!try_step(contacts, done, next, size, may_be_cut)) {
      if (!may_be_cut) return false;
      too_far = next;
      step *= 0.5;
      --tries;
      continue;
    }
    std::ranges::copy(by_halves_, carried_.begin());
    done = next;
    // A rejected step contains a point where other walls begin to touch. The next steps close in on it, and pass it.
    step = done < too_far ? std::max(k_same_value, 0.5 * (too_far - done)) : 1.0 - done;
  }
  std::ranges::copy(carried_, y.begin());
  return true;
}

}  // namespace monograin::nonlocal
