#include "nonlocal/rates.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "system/equations.hpp"
#include "system/limit.hpp"

namespace monograin::nonlocal {
namespace {

// Decay rate of a balance error where a prescribed force shrinks, over the relative rate of that force.
constexpr double k_decay_over_force_rate = 2.0;

/// Largest rate at which an idle wall closes a gap that is an integration error. From `touch` to twice that gap the
/// bound grows to infinity, and beyond, the wall is free. A bound that ended abruptly would separate an implicit step
/// from its solution.
double closing(double signed_square, double touch) {
  const double gap = -signed_square;
  const double share = gap <= touch ? 1.0 : std::max(0.0, 2.0 - gap / touch);
  return k_stabilization * gap / share;
}

/// Decay rate of the error of error_against_forces(), at least `least`. Where a force shrinks, an error of the balance
/// would outlast it and open the contact that bears it.
double error_decay(std::span<const Ramp> ramps, std::span<const double> forces, double least) noexcept {
  double decay = least;
  for (std::size_t j = 0; j < ramps.size(); ++j) {
    const bool is_borne = ramps[j].is_force_controlled() && forces[j] > 0.0;
    if (is_borne) decay = std::max(decay, -k_decay_over_force_rate * ramps[j].rate() / forces[j]);
  }
  return decay;
}

}  // namespace

Rates::Rates(const Contacts& contacts) : tangent_(contacts), support_(contacts), stiffness_(contacts.class_count()) {
  obstacles_.reserve(contacts.class_count());
}

void Rates::find(Contacts& contacts, std::span<const Ramp> ramps, std::span<const double> y, std::span<double> dy,
                 const Tolerances& tolerances) {
  const std::size_t n = contacts.class_count();
  if (find_unloaded(contacts, {ramps, y, {}, tolerances}, dy)) return;
  const Evaluation& at = contacts.evaluate(y);
  // Loads of redundant walls are integration errors: two such walls would hold the centre in their corner.
  const bool is_free = contacts.free_count() > 0;
  if (is_free) support_.sort_near(contacts, ramps, y, 2.0 * tolerances.touch);
  for (std::size_t j = 0; j < n; ++j) {
    const bool gives_way = ramps[j].is_force_controlled() || (is_free && support_.is_redundant(j));
    stiffness_[j] = gives_way ? 0.0 : at.stiffness[j];
  }
  set_approach_rates_of_walls(contacts, ramps);
  if (!tangent_.eliminate(contacts, stiffness_)) {
    throw DomainError({Limit::applicability, -1, "margin", contacts.margin(y)});
  }
  if (is_free) let_centre_follow(contacts, {ramps, y, at.forces, tolerances}, dy);
  for (std::size_t j = 0; j < n; ++j) {
    dy[j] = tangent_.approach(j) / at.local[j].approach_slope;
    if (ramps[j].is_force_controlled()) {
      const double by_square = at.stiffness[j] * at.local[j].approach_slope;
      dy[j] = ramps[j].rate() == 0.0 ? 0.0 : ramps[j].rate() / by_square;
    }
  }
}

/// Sets the rates if no contact is loaded and none begins to be: the centre evades the walls that touch, and no others.
/// Gaps that are integration errors close gradually; if they did not count as touching, walls would leave in turns.
/// @return false, with dy unchanged, in all other cases
bool Rates::find_unloaded(const Contacts& contacts, const State& now, std::span<double> dy) {
  const std::size_t n = contacts.class_count();
  if (contacts.free_count() == 0) return false;
  obstacles_.clear();
  for (std::size_t j = 0; j < n; ++j) {
    if (now.y[j] > 0.0 || (now.ramps[j].is_force_controlled() && now.ramps[j].rate() != 0.0)) return false;
    const double rate = now.ramps[j].rate() - closing(now.y[j], now.tolerances.touch);
    if (!now.ramps[j].is_force_controlled() && now.tolerances.may_push(j) && std::isfinite(rate))
      obstacles_.push_back({j, contacts.mean_normal(j), rate});
  }
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  if (!release_centre(obstacles_, Eigen::Matrix3d::Identity(), velocity)) return false;
  for (std::size_t j = 0; j < n; ++j) {
    dy[j] = now.ramps[j].is_force_controlled()
                ? 0.0
                : free_approach({j, contacts.mean_normal(j), now.ramps[j].rate()}, velocity);
  }
  for (const contacts::Obstacle& wall : obstacles_)
    dy[wall.index] = std::min(dy[wall.index], closing(now.y[wall.index], now.tolerances.touch));
  contacts.set_centre(velocity, dy);
  return true;
}

/// Sets the right-hand sides of the rates: approach rates by walls and prescribed forces before the contacts respond.
void Rates::set_approach_rates_of_walls(const Contacts& contacts, std::span<const Ramp> ramps) {
  for (std::size_t j = 0; j < ramps.size(); ++j) {
    double& rate = tangent_.approach(j);
    rate = ramps[j].is_force_controlled() ? 0.0 : ramps[j].rate();
    for (std::size_t h = 0; h < ramps.size(); ++h) {
      if (ramps[h].is_force_controlled()) rate += contacts.coupling()(as_index(j), as_index(h)) * ramps[h].rate();
    }
  }
}

/// Adds the rates of a free centre: forces stay balanced, and touching walls move the centre where no contact supports
/// it.
/// @throws std::domain_error where nothing supports it against prescribed forces
void Rates::let_centre_follow(Contacts& contacts, const State& now, std::span<double> dy) {
  const std::size_t n = contacts.class_count();
  const bool is_first_touch = carries_no_load(stiffness_);
  for (std::size_t j = 0; is_first_touch && j < n; ++j) {
    const bool is_touching = !now.ramps[j].is_force_controlled() && now.y[j] == 0.0 && tangent_.approach(j) >= 0.0;
    if (is_touching && !support_.is_redundant(j)) stiffness_[j] = 1.0;
  }
  const Eigen::Vector3d error = error_against_forces(contacts, now);
  Eigen::Vector3d net = Eigen::Vector3d::Zero();
  double pressing = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    const double force_rate =
        now.ramps[j].is_force_controlled() ? now.ramps[j].rate() : stiffness_[j] * tangent_.approach(j);
    net += contacts.weight(j) * force_rate * contacts.mean_normal(j);
    // The tolerance is relative to all force rates that walls would cause, and to the forces where no rate is to
    // change.
    pressing += contacts.weight(j) * (std::abs(force_rate) + now.tolerances.pull * now.forces[j]);
  }
  const auto centre = dy.subspan(n);
  std::ranges::fill(centre, 0.0);
  const double decay = error_decay(now.ramps, now.forces, now.tolerances.pull);
  tangent_.move_centre(contacts, stiffness_, net + decay * error, centre);
  // Only `pull` times the error counts. A faster decay of the error does not drive a centre that no contact supports.
  const Eigen::Matrix3d projector = directions_of_nothing(contacts, [this](std::size_t j) { return stiffness_[j]; });
  const double left = (projector * (net + now.tolerances.pull * error)).norm();
  if (support_.has_redundant_walls()) let_idle_walls_push(contacts, now, dy);
  if (left > k_no_net_force * pressing &&
      !support_.may_be_held(contacts, now.ramps, now.y, reach_of_support(contacts, now))) {
    throw DomainError(Limit::centre_driven_away);
  }
}

/// Net force on the centre that is integration error. Nonzero only if contacts bear the centre against a prescribed
/// force: they end together with that force only if no error is left.
Eigen::Vector3d Rates::error_against_forces(const Contacts& contacts, const State& now) const {
  Eigen::Vector3d error = Eigen::Vector3d::Zero();
  bool is_forced = false;
  for (std::size_t j = 0; j < now.ramps.size(); ++j)
    is_forced = is_forced || (now.ramps[j].is_force_controlled() && now.y[j] > now.tolerances.touch);
  for (std::size_t j = 0; is_forced && j < now.ramps.size(); ++j) {
    if (!support_.is_redundant(j)) error += contacts.weight(j) * now.forces[j] * contacts.mean_normal(j);
  }
  return error;
}

/// Largest gap at which an open wall counts as a support of the centre: the touch tolerance; while a prescribed force
/// falls to zero, the depth of its contact, because errors open the other walls just before the end.
double Rates::reach_of_support(const Contacts& contacts, const State& now) const {
  const Eigen::Matrix3d unheld = support_.unheld_directions(contacts);
  double near = now.tolerances.touch;
  for (std::size_t j = 0; j < now.ramps.size(); ++j) {
    // A force that contacts bear already, or that does not shrink, says nothing about the gaps of walls that may bear
    // others.
    const bool is_shrinking = now.ramps[j].is_force_controlled() && now.ramps[j].rate() < 0.0;
    const bool says_so = is_shrinking && (unheld * contacts.mean_normal(j)).norm() > k_same_direction;
    near = std::max(near, says_so ? now.y[j] : k_unloaded * now.y[j]);
  }
  return near;
}

/// Adds to the rates the velocity that touching redundant walls give the centre. Gaps and overlaps that are integration
/// errors close gradually; closed at once, these contacts would open and close in turns.
void Rates::let_idle_walls_push(const Contacts& contacts, const State& now, std::span<double> dy) {
  const std::size_t n = contacts.class_count();
  obstacles_.clear();
  for (std::size_t j = 0; j < n; ++j) {
    const double rate = tangent_.approach(j) - closing(now.y[j], now.tolerances.touch);
    const bool pushes = support_.is_redundant(j) && !now.ramps[j].is_force_controlled() && now.tolerances.may_push(j);
    if (pushes && std::isfinite(rate)) obstacles_.push_back({j, contacts.mean_normal(j), rate});
  }
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  if (!release_centre(obstacles_, support_.unheld_directions(contacts), velocity)) return;
  auto next = obstacles_.begin();
  for (std::size_t j = 0; j < n; ++j) {
    double& rate = tangent_.approach(j);
    if (next != obstacles_.end() && next->index == j)
      rate = std::min(free_approach(*next++, velocity), 0.0) + closing(now.y[j], now.tolerances.touch);
    else
      rate += contacts.mean_normal(j).dot(velocity);
  }
  for (std::size_t k = 0; k < contacts.free_count(); ++k) dy[n + k] += velocity[as_index(k)];
}

void Rates::let_unheld_centre_go(const Contacts& contacts, std::span<const Ramp> ramps, std::span<const char> is_closed,
                                 const Eigen::Vector3d& missing, std::span<double> balance) {
  support_.sort(
      contacts, [&](std::size_t j) { return is_closed[j]; },
      [&](std::size_t j) { return ramps[j].is_force_controlled(); });
  const Eigen::Matrix3d projector = support_.unheld_directions(contacts);
  if (projector.trace() < 0.5) return;
  // Each row holds either a rate or a force: in short steps the far larger rates would hide the force in a mixed row.
  const Eigen::Index count = as_index(contacts.free_count());
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;
  const Eigen::SelfAdjointEigenSolver<Square> solver(Square(projector.topLeftCorner(count, count)));
  Eigen::Vector3d net = Eigen::Vector3d::Zero();
  std::copy(balance.begin(), balance.end(), net.begin());
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto direction = solver.eigenvectors().col(k);
    const Eigen::Vector3d& says = solver.eigenvalues()[k] > 0.5 ? missing : net;
    balance[static_cast<std::size_t>(k)] = direction.dot(says.head(count));
  }
}

}  // namespace monograin::nonlocal
