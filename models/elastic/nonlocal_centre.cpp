// Where walls take a free centre that they do not bear.

#include <algorithm>
#include <cmath>

#include "elastic/nonlocal_contacts.hpp"

namespace monograin::nonlocal {
namespace {

constexpr int k_refinements = 2;                                        // of a place clear of all walls
constexpr double k_no_wall = -std::numeric_limits<double>::infinity();  // displacement of one that does not count

}  // namespace

/// Whether walls touch a free centre beside contacts so much deeper that they bear nothing themselves.
bool Contacts::is_taken_along(std::span<const double> y) const {
  if (free_count() == 0) return false;
  const auto squares = y.first(class_count());
  const double deepest = *std::max_element(squares.begin(), squares.end());
  return std::any_of(squares.begin(), squares.end(), [&](double s) { return std::abs(s) < k_unloaded * deepest; });
}

/// Where contacts bear a free centre in some directions only, others may take it along in the rest without bearing: as
/// soft as they are shallow, so that no step towards the targets is short against that. The bearing ones are balanced
/// by themselves, and the centre goes out of the way of the others where that changes nothing for them. Where M is
/// positive definite with every contact as deep as in the one or the other state, no other state balances that is no
/// deeper.
bool Contacts::let_others_go(std::span<double> y) {
  const std::size_t n = class_count();
  const double deepest = *std::max_element(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(n));
  std::copy(targets_.begin(), targets_.end(), last_targets_.begin());
  const auto free = static_cast<Eigen::Index>(free_count());
  Eigen::Matrix3d projector = Eigen::Matrix3d::Zero();
  projector.topLeftCorner(free, free).setIdentity();
  for (std::size_t j = 0; j < n; ++j) {
    free_displacements_[j] = targets_[j].is_force ? k_no_wall : targets_[j].value;
    if (targets_[j].is_force || y[j] < k_unloaded * deepest) {
      if (!targets_[j].is_force) targets_[j] = target(true, 0.0);
      continue;
    }
    free_displacements_[j] = k_no_wall;
    const Eigen::Vector3d along = projector * arm_of(j);
    if (along.norm() > k_same_surroundings) projector -= along * along.transpose() / along.squaredNorm();
  }
  std::copy(y.begin(), y.end(), trial_.begin());
  const bool is_found = projector.trace() > 0.5 && newton(trial_, 0.0) && is_balanced(trial_);
  std::copy(last_targets_.begin(), last_targets_.end(), targets_.begin());
  if (!is_found) return false;

  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t h = 0; h < n; ++h) free_displacements_[j] += coupling_(at(j), at(h)) * forces_[h];
  }
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  std::copy(trial_.begin() + static_cast<std::ptrdiff_t>(n), trial_.end(), place.begin());
  if (!clear_walls(n, projector, place)) return false;
  for (std::size_t j = 0; j < n; ++j) {
    if (free_displacements_[j] != k_no_wall) trial_[j] = std::min(free_approach(j, place), 0.0);
    state_[j] = std::max(y[j], trial_[j]);
  }
  if (!(least_pivot(state_) > 0.0)) return false;
  std::copy_n(place.begin(), free_count(), trial_.begin() + static_cast<std::ptrdiff_t>(n));
  std::copy(trial_.begin(), trial_.end(), y.begin());
  return true;
}

/// No other state balances then: its forces would do no work on a way there, sum_j F_j d_j <= 0, but sum_j F_j g_j >
/// sum_jh F_j G_jh F_h wherever M is positive definite.
bool Contacts::let_go(std::span<const Ramp> ramps, double xi, std::span<double> y) {
  const std::size_t n = class_count();
  for (std::size_t j = 0; j < n; ++j) {
    const bool is_force = ramps[j].control == Control::force;
    const double value = std::lerp(ramps[j].start, ramps[j].end, xi);
    if (is_force && value != 0.0) return false;
    free_displacements_[j] = is_force ? k_no_wall : value;
  }
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  std::copy(y.begin() + static_cast<std::ptrdiff_t>(n), y.begin() + static_cast<std::ptrdiff_t>(unknown_count()),
            place.begin());
  if (!release_centre(place)) return false;
  for (std::size_t j = 0; j < n; ++j) {
    y[j] = free_displacements_[j] == k_no_wall ? 0.0 : std::min(free_approach(j, place), 0.0);
  }
  std::copy_n(place.begin(), free_count(), y.begin() + static_cast<std::ptrdiff_t>(n));
  return true;
}

/// Where nothing bears and nothing begins to, the centre goes out of the way of the walls that touch, and of no other.
bool Contacts::let_go_on(std::span<const Ramp> ramps, std::span<const double> y, std::span<double> dy) {
  const std::size_t n = class_count();
  if (free_count() == 0) return false;
  for (std::size_t j = 0; j < n; ++j) {
    const bool is_force = ramps[j].control == Control::force;
    const double slope = ramps[j].end - ramps[j].start;
    if (y[j] > 0.0 || (is_force && slope != 0.0)) return false;
    free_displacements_[j] = is_force || y[j] < 0.0 ? k_no_wall : slope;
  }
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  if (!release_centre(velocity)) return false;
  for (std::size_t j = 0; j < n; ++j) {
    const bool is_touching = free_displacements_[j] != k_no_wall;
    free_displacements_[j] = ramps[j].end - ramps[j].start;
    const double rate = free_approach(j, velocity);
    dy[j] = ramps[j].control == Control::force ? 0.0 : is_touching ? std::min(rate, 0.0) : rate;
  }
  std::copy_n(velocity.begin(), free_count(), dy.begin() + static_cast<std::ptrdiff_t>(n));
  return true;
}

/// Approach of a wall where nothing bears; exactly 0 where it touches but for rounding.
double Contacts::free_approach(std::size_t index, const Eigen::Vector3d& centre) const {
  const double displacement = free_displacements_[index];
  double sum = displacement;
  double size = std::abs(displacement);
  for (std::size_t k = 0; k < free_count(); ++k) {
    const double share = arms_(at(index), at(k)) * centre[at(k)];
    sum += share;
    size += std::abs(share);
  }
  return std::abs(sum) <= k_resolved * size ? 0.0 : sum;
}

/// Moves a centre to the nearest place where no wall of free_displacements_ is beyond the surface.
/// @return false, and the centre where it was, if the walls leave no such place
bool Contacts::release_centre(Eigen::Vector3d& centre) const {
  const auto clear = [&] { return clear_walls(class_count(), Eigen::Matrix3d::Identity(), centre); };
  if (!clear()) return false;
  // What rounding has left beyond the surface on a long way is little, and so is the way from there.
  for (int refinement = 0; refinement < k_refinements; ++refinement) {
    if (!clear()) break;
  }
  return true;
}

/// Moves the centre in a subspace, whose projector is given, to the nearest place clear of the first walls. One that
/// the nearest place clear of those before it is not clear of touches the surface in the end.
bool Contacts::clear_walls(std::size_t count, const Eigen::Matrix3d& projector, Eigen::Vector3d& place) const {
  Eigen::Vector3d now = place;
  for (std::size_t j = 0; j < count; ++j) {
    const double displacement = free_displacements_[j];
    if (displacement == k_no_wall || free_approach(j, now) <= 0.0) continue;
    const Eigen::Vector3d arm = arm_of(j);
    const Eigen::Vector3d along = projector * arm;
    const double share = along.squaredNorm();
    if (!(share > k_same_surroundings * k_same_surroundings)) return false;
    now = place - along * ((displacement + arm.dot(place)) / share);
    if (!clear_walls(j, projector - along * along.transpose() / share, now)) return false;
  }
  place = now;
  return true;
}

/// Mean normal of a class along the free directions.
Eigen::Vector3d Contacts::arm_of(std::size_t index) const {
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();
  arm.head(directions_.cols()) = arms_.row(at(index)).transpose();
  return arm;
}

}  // namespace monograin::nonlocal
