#include "nonlocal/support.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "contacts/centre/reaction_cone.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

constexpr double k_little = 1e-3;        // of the rest of a step: how far ahead forces are evaluated
constexpr double k_no_approach = 1e-30;  // over R0; less is round-off of zero

bool pushes_centre(const Contacts& contacts, std::size_t j) {
  return contacts.mean_normal(j).norm() > k_same_direction;
}

}  // namespace

bool may_balance(const Contacts& contacts, std::span<const Target> targets, std::span<const double> y, double near) {
  Eigen::Vector3d push = Eigen::Vector3d::Zero();
  double sum = 0.0;
  std::vector<Eigen::Vector3d> others;
  for (std::size_t j = 0; j < targets.size(); ++j) {
    const Eigen::Vector3d& mean_normal = contacts.mean_normal(j);
    if (targets[j].is_force) {
      push += contacts.weight(j) * targets[j].value * mean_normal;
      sum += contacts.weight(j) * targets[j].value;
    } else if (y[j] >= -near && pushes_centre(contacts, j)) {
      others.push_back(mean_normal.normalized());
    }
  }
  return push.norm() <= k_round_off * sum || in_reaction_cone(push, others);
}

bool is_held_softly(const Contacts& contacts, std::span<const Ramp> ramps, std::span<const double> y, double s) {
  const Eigen::Index count = as_index(contacts.free_count());
  Eigen::MatrixXd reach = Eigen::MatrixXd::Zero(count, count);
  Eigen::MatrixXd hold = reach;
  for (std::size_t j = 0; j < contacts.class_count(); ++j) {
    if (y[j] < -s) continue;
    const auto mean_normal = contacts.mean_normal(j).head(count);
    const Eigen::MatrixXd along = contacts.weight(j) * mean_normal * mean_normal.transpose();
    reach += along;
    // A wall under a force follows the centre.
    if (y[j] > s && !ramps[j].is_force_controlled()) hold += along;
  }
  const auto rank = [](const Eigen::MatrixXd& matrix) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
    return (solver.eigenvalues().array() > k_same_direction).count();
  };
  return rank(hold) < rank(reach);
}

void CentreSupport::find_redundant(const Contacts& contacts) {
  if (std::ranges::all_of(walls_, [](const Wall& wall) { return wall.may_bear == wall.did_bear; })) return;
  normals_.clear();
  for (std::size_t j = 0; j < walls_.size(); ++j) {
    walls_[j].did_bear = walls_[j].may_bear;
    if (walls_[j].may_bear && pushes_centre(contacts, j)) normals_.push_back(contacts.mean_normal(j).normalized());
  }
  for (std::size_t j = 0; j < walls_.size(); ++j) {
    walls_[j].is_redundant =
        walls_[j].may_bear && pushes_centre(contacts, j) && !in_reaction_cone(contacts.mean_normal(j), normals_);
  }
}

void CentreSupport::sort_near(const Contacts& contacts, std::span<const Ramp> ramps, std::span<const double> y,
                              double near) {
  const auto is_force = [&](std::size_t j) { return ramps[j].is_force_controlled(); };
  sort(
      contacts,
      [&](std::size_t j) { return is_force(j) ? y[j] > 0.0 || ramps[j].end != ramps[j].start : y[j] >= -near; },
      is_force);
}

bool CentreSupport::sort_loaded(const Contacts& contacts, std::span<const Target> targets, std::span<const double> y,
                                double gap) {
  if (contacts.free_count() == 0) return false;
  const auto squares = y.first(walls_.size());
  const double deepest = *std::max_element(squares.begin(), squares.end());
  const double least = deepest > 0.0 ? k_unloaded * deepest : -gap;
  sort(
      contacts, [&](std::size_t j) { return targets[j].is_force ? targets[j].value > 0.0 : y[j] >= -std::abs(least); },
      [&](std::size_t j) { return targets[j].is_force; });
  bool are_others = false;
  for (std::size_t j = 0; j < walls_.size(); ++j) {
    walls_[j].holds = walls_[j].holds && y[j] >= least;
    are_others = are_others || (!targets[j].is_force && !walls_[j].holds);
  }
  return are_others;
}

bool CentreSupport::may_be_held(Contacts& contacts, std::span<const Ramp> ramps, std::span<const double> y,
                                double near) {
  sort_near(contacts, ramps, y, near);
  bool do_some_touch = false;
  for (std::size_t j = 0; j < walls_.size(); ++j) do_some_touch = do_some_touch || (walls_[j].holds && y[j] <= 0.0);
  if (!do_some_touch) return false;
  // Forces are evaluated a little later, because they may only begin here. They are not evaluated at the end of the
  // step, where the remaining ones may point in the opposite direction.
  const Evaluation& at = contacts.evaluate(y);
  std::vector<Target> later(walls_.size());
  for (std::size_t j = 0; j < walls_.size(); ++j) {
    const bool is_force = ramps[j].is_force_controlled();
    const double force = std::max(0.0, std::lerp(at.forces[j], ramps[j].end, k_little));
    later[j] = {.is_force = is_force, .value = is_force ? force : 0.0};
  }
  return may_balance(contacts, later, y, near);
}

Eigen::Matrix3d CentreSupport::unheld_directions(const Contacts& contacts) const {
  const auto free = as_index(contacts.free_count());
  Eigen::Matrix3d projector = Eigen::Matrix3d::Zero();
  projector.topLeftCorner(free, free).setIdentity();
  for (std::size_t j = 0; j < walls_.size(); ++j) {
    const Eigen::Vector3d along = projector * contacts.mean_normal(j);
    if (walls_[j].holds && along.norm() > k_same_direction)
      projector -= along * along.transpose() / along.squaredNorm();
  }
  return projector;
}

double free_approach(const contacts::Obstacle& wall, const Eigen::Vector3d& centre) {
  const double sum = wall.overlap(centre);
  const double size = std::abs(wall.overlap_at_origin) + wall.mean_normal.norm() * centre.norm();
  return std::abs(sum) <= std::max(k_round_off * size, k_no_approach) ? 0.0 : sum;
}

bool clear_walls(std::span<const contacts::Obstacle> walls, const Eigen::Matrix3d& projector, Eigen::Vector3d& centre) {
  const auto overlaps = [](const contacts::Obstacle& wall, const Eigen::Vector3d& at) {
    return !(free_approach(wall, at) <= 0.0);
  };
  return contacts::project_out_of(walls, projector, k_same_direction, overlaps, centre);
}

bool release_centre(std::span<const contacts::Obstacle> walls, const Eigen::Matrix3d& projector,
                    Eigen::Vector3d& centre) {
  if (!clear_walls(walls, projector, centre)) return false;
  // Two refinements remove the round-off of the first position.
  for (int refinement = 0; refinement < 2; ++refinement) {
    if (!clear_walls(walls, projector, centre)) break;
  }
  return true;
}

void put_centre(const Contacts& contacts, std::span<const contacts::Obstacle> walls, const Eigen::Vector3d& centre,
                std::span<double> y) {
  for (const contacts::Obstacle& wall : walls) y[wall.index] = std::min(free_approach(wall, centre), 0.0);
  contacts.set_centre(centre, y);
}

}  // namespace monograin::nonlocal
