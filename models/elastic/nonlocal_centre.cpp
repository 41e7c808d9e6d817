// How idle walls move a free centre.

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "elastic/nonlocal_contacts.hpp"
#include "reaction_cone.hpp"

namespace monograin::nonlocal {
namespace {

constexpr int k_refinements = 2;                                        // repeated clearances of one position
constexpr double k_no_approach = 1e-30;                                 // over R0; less is round-off of zero
constexpr double k_no_wall = -std::numeric_limits<double>::infinity();  // marks a wall that does not count
// Rate at which idle walls close gaps that are integration errors, per step of the program.
constexpr double k_closing = 20.0;
// In take_centre_to_targets(): distance of two positions that count as one, over the length of the path; shortest step.
constexpr double k_same_place = 1e-13;
constexpr double k_shortest = 1e-11;
constexpr double k_small_force = 1e-3;  // prescribed forces below this, over the largest, are balanced by themselves
constexpr double k_little = 1e-3;       // of the rest of a step: how far ahead forces are evaluated
constexpr double k_early = 1e-9;        // of a step: near its start, which walls touch is read here
// Shares of a step before its end at which touching walls are read, too. Too far from the end, a wall that has only
// just left goes unnoticed; too near, the remainder is round-off.
constexpr std::array k_late{1e-3, 1e-6, 1e-9};
constexpr int k_most_sinking_steps = 100;
constexpr double k_past_balance = 0.5;  // slope of the energy past its minimum on a step, over the slope at the start
constexpr int k_most_tries = 300;       // rejected steps of a path; after that many, differences are round-off
constexpr double k_cancelled = 1e-12;   // net prescribed force that counts as zero, over the sum of the forces

/// Largest rate at which an idle wall closes a gap that is an integration error. From `touch` to twice that gap the
/// bound grows to infinity, and beyond, the wall is free. A bound that ended abruptly would separate an implicit step
/// from its solution.
double closing(double signed_square, double touch) {
  const double gap = -signed_square;
  const double share = gap <= touch ? 1.0 : std::max(0.0, 2.0 - gap / touch);
  return k_closing * gap / share;
}

}  // namespace

/// Magnitude of the net prescribed force along the directions in which no contact supports the centre, however small
/// beside other forces; 0 if only round-off is left of it.
double Contacts::unborne_force() const {
  if (std::ranges::none_of(targets_, &Target::is_force)) return 0.0;
  const Eigen::Matrix3d projector = directions_of_nothing();
  Eigen::Vector3d push = Eigen::Vector3d::Zero();
  double sum = 0.0;
  for (std::size_t j = 0; j < class_count(); ++j) {
    const Eigen::Vector3d along = projector * arm_of(j);
    if (!targets_[j].is_force || along.norm() <= k_same_surroundings) continue;
    push += weights_[j] * targets_[j].value * along;
    sum += weights_[j] * targets_[j].value;
  }
  return push.norm() > k_cancelled * sum ? push.norm() : 0.0;
}

/// Gives stiffness to touching walls if a prescribed force begins in a direction in which no contact supports the
/// centre. Only these walls can bear such a force; they get the stiffness that they would have under it.
/// @param gap  up to which a wall counts as touching
/// @return true if there is such a force
bool Contacts::lend_stiffness(double gap, std::span<const double> y) {
  const double force = unborne_force();
  if (force == 0.0) return false;
  const double square = law_.signed_square_under(std::min(force / modulus_, law_.greatest_force()));
  for (std::size_t j = 0; j < class_count(); ++j) {
    if (!targets_[j].is_force && stiffness_[j] == 0.0 && y[j] >= -gap) stiffness_[j] = force / square;
  }
  return true;
}

/// Finds redundant walls: candidates that carry no force in any equilibrium, because no non-negative combination of
/// normals that includes theirs vanishes. The centre can then leave such a wall without approaching another one.
void Contacts::find_redundant_walls() {
  const std::size_t n = class_count();
  if (std::ranges::equal(may_bear_, sorted_)) return;
  std::ranges::copy(may_bear_, sorted_.begin());
  for (std::size_t j = 0; j < n; ++j) {
    is_redundant_[j] = false;
    if (!may_bear_[j] || free_count() == 0) continue;
    for (std::size_t h = 0; h < n; ++h) free_displacements_[h] = !may_bear_[h] ? k_no_wall : h == j ? 1.0 : 0.0;
    Eigen::Vector3d way = Eigen::Vector3d::Zero();
    is_redundant_[j] = clear_walls(n, Eigen::Matrix3d::Identity(), way, k_same_surroundings);
  }
}

bool Contacts::has_redundant_walls() const {
  return std::ranges::any_of(is_redundant_, [](char is) { return is != 0; });
}

/// Sorts the walls of may_bear_ into those that support a free centre (holds_) and redundant ones (is_redundant_). A
/// wall under force control never supports the centre.
void Contacts::find_holding_among(const auto& is_force) {
  find_redundant_walls();
  for (std::size_t j = 0; j < class_count(); ++j) holds_[j] = may_bear_[j] && !is_redundant_[j] && !is_force(j);
}

/// Classifies walls with a gap below `near`, and walls whose prescribed force starts from zero or ends there.
void Contacts::sort_near(std::span<const Ramp> ramps, std::span<const double> y, double near) {
  const auto is_force = [&](std::size_t j) { return ramps[j].control == Control::force; };
  for (std::size_t j = 0; j < class_count(); ++j) {
    may_bear_[j] = is_force(j) ? y[j] > 0.0 || ramps[j].end != ramps[j].start : y[j] >= -near;
  }
  find_holding_among(is_force);
}

/// Overwrites the classification of the walls (holds_, is_redundant_) and the targets.
bool Contacts::may_be_held(std::span<const Ramp> ramps, std::span<const double> y, double near) {
  sort_near(ramps, y, near);
  bool do_some_touch = false;
  for (std::size_t j = 0; j < class_count(); ++j) do_some_touch = do_some_touch || (holds_[j] && y[j] <= 0.0);
  if (!do_some_touch) return false;
  // Forces are evaluated a little later, because they may only begin here. They are not evaluated at the end of the
  // step, where the remaining ones may point in the opposite direction.
  evaluate(y);
  for (std::size_t j = 0; j < class_count(); ++j) {
    const bool is_force = ramps[j].control == Control::force;
    const double force = std::max(0.0, std::lerp(forces_[j], ramps[j].end, k_little));
    targets_[j] = {.is_force = is_force, .value = is_force ? force : 0.0};
  }
  return may_balance(targets_, y, near);
}

/// True if walls under displacement control with a gap below `near` can balance the prescribed forces. Small forces are
/// tested by themselves, because round-off of large ones would hide them; a decrease of the force on a loaded contact
/// may balance them, too.
bool Contacts::may_balance(std::span<const Target> targets, std::span<const double> y, double near) const {
  const auto push_of = [&](std::size_t j) -> Eigen::Vector3d { return weights_[j] * targets[j].value * arm_of(j); };
  double largest = 0.0;
  for (std::size_t j = 0; j < class_count(); ++j) {
    if (targets[j].is_force) largest = std::max(largest, push_of(j).norm());
  }
  std::vector<Eigen::Vector3d> others;
  std::vector<Eigen::Vector3d> giving_way;
  for (std::size_t j = 0; j < class_count(); ++j) {
    const Eigen::Vector3d arm = arm_of(j);
    if (targets[j].is_force || y[j] < -near || !(arm.norm() > k_same_surroundings)) continue;
    others.push_back(arm.normalized());
    if (y[j] > 0.0) giving_way.push_back(-others.back());
  }
  const auto can_be_borne = [&](bool is_small) {
    Eigen::Vector3d push = Eigen::Vector3d::Zero();
    double sum = 0.0;
    for (std::size_t j = 0; j < class_count(); ++j) {
      if (!targets[j].is_force || (push_of(j).norm() < k_small_force * largest) != is_small) continue;
      push += push_of(j);
      sum += weights_[j] * targets[j].value;
    }
    return push.norm() <= k_resolved * sum || in_reaction_cone(push, others);
  };
  if (!can_be_borne(false)) return false;
  others.insert(others.end(), giving_way.begin(), giving_way.end());
  return can_be_borne(true);
}

/// Projector on the directions in which a free centre can move without changing the contacts that support it.
Eigen::Matrix3d Contacts::unheld_directions() const {
  const auto free = static_cast<Eigen::Index>(free_count());
  Eigen::Matrix3d projector = Eigen::Matrix3d::Zero();
  projector.topLeftCorner(free, free).setIdentity();
  for (std::size_t j = 0; j < class_count(); ++j) {
    const Eigen::Vector3d along = projector * arm_of(j);
    if (holds_[j] && along.norm() > k_same_surroundings) projector -= along * along.transpose() / along.squaredNorm();
  }
  return projector;
}

/// Finds the contacts that support a free centre in a state (holds_): neither redundant walls, nor contacts so much
/// shallower than the deepest that they carry nothing. If no contact is loaded yet, walls with a gap up to `gap` count.
/// @return true if other walls under displacement control remain, which may move the centre
bool Contacts::find_holding(std::span<const double> y, double gap) {
  if (free_count() == 0) return false;
  const auto squares = y.first(class_count());
  const double deepest = *std::max_element(squares.begin(), squares.end());
  const double least = deepest > 0.0 ? k_unloaded * deepest : -gap;
  for (std::size_t j = 0; j < class_count(); ++j) {
    may_bear_[j] = targets_[j].is_force ? targets_[j].value > 0.0 : y[j] >= -std::abs(least);
  }
  find_holding_among([this](std::size_t j) { return targets_[j].is_force; });
  bool are_others = false;
  for (std::size_t j = 0; j < class_count(); ++j) {
    holds_[j] = holds_[j] && y[j] >= least;
    are_others = are_others || (!targets_[j].is_force && !holds_[j]);
  }
  return are_others;
}

/// True if prescribed forces act on the centre along the directions of the projector, in which only idle walls could
/// balance them. The balance of all forces would not distinguish a small one from zero beside large ones.
bool Contacts::leaves_forces(const Eigen::Matrix3d& projector, std::span<const double> y) {
  evaluate(y);
  Eigen::Vector3d push = Eigen::Vector3d::Zero();
  double sum = 0.0;
  for (std::size_t j = 0; j < class_count(); ++j) {
    sum += weights_[j] * forces_[j];
    if (targets_[j].is_force) push += weights_[j] * targets_[j].value * arm_of(j);
  }
  return (projector * push).norm() > k_resolved * sum;
}

/// Moves a free centre that loaded contacts constrain in some directions only. Idle walls move it in the others; their
/// stiffness vanishes, so that Newton steps are unbounded. The constrained part is solved by itself, and the centre
/// then moves out of the way of the idle walls where that changes no load. Where M is positive definite for every depth
/// between the two states, no other state that is no deeper is in equilibrium.
bool Contacts::let_others_go(std::span<double> y) {
  const std::size_t n = class_count();
  std::copy(targets_.begin(), targets_.end(), last_targets_.begin());
  for (std::size_t j = 0; j < n; ++j) {
    if (!holds_[j] && !targets_[j].is_force) targets_[j] = target(true, 0.0);
  }
  const Eigen::Matrix3d projector = unheld_directions();
  std::copy(y.begin(), y.end(), trial_.begin());
  const bool is_found =
      projector.trace() > 0.5 && newton(trial_, 0.0) && is_balanced(trial_) && !leaves_forces(projector, trial_);
  std::copy(last_targets_.begin(), last_targets_.end(), targets_.begin());
  if (!is_found) return false;

  for (std::size_t j = 0; j < n; ++j) {
    const bool may_go = !holds_[j] && !targets_[j].is_force;
    free_displacements_[j] = may_go ? targets_[j].value + lift_by_forces(j) : k_no_wall;
  }
  Eigen::Vector3d place = place_of(trial_);
  if (!clear_walls(n, projector, place)) return false;
  put(place, trial_);
  for (std::size_t j = 0; j < n; ++j) state_[j] = std::max(y[j], trial_[j]);
  if (!(least_pivot(state_) > 0.0)) return false;
  std::copy(trial_.begin(), trial_.end(), y.begin());
  return true;
}

bool Contacts::let_bystanders_go(std::span<const char> is_closed, std::span<double> y) {
  const std::size_t n = class_count();
  for (std::size_t j = 0; j < n; ++j) {
    may_bear_[j] = targets_[j].is_force ? targets_[j].value > 0.0 : is_closed[j] || y[j] > 0.0;
  }
  find_holding_among([this](std::size_t j) { return targets_[j].is_force; });
  if (!has_redundant_walls()) return false;
  forget();
  for (std::size_t j = 0; j < n; ++j) forces_[j] = is_redundant_[j] ? 0.0 : modulus_ * law_.at(y[j]).force;
  for (std::size_t j = 0; j < n; ++j) {
    const bool may_go = is_redundant_[j] && !targets_[j].is_force;
    free_displacements_[j] = may_go ? targets_[j].value + lift_by_forces(j) : k_no_wall;
  }
  Eigen::Vector3d place = place_of(y);
  if (!release_centre(unheld_directions(), place)) return false;
  put(place, y);
  return true;
}

void Contacts::let_unheld_centre_go(std::span<const Ramp> ramps, std::span<const char> is_closed,
                                    const Eigen::Vector3d& missing, std::span<double> balance) {
  std::copy(is_closed.begin(), is_closed.end(), may_bear_.begin());
  find_holding_among([&](std::size_t j) { return ramps[j].control == Control::force; });
  const Eigen::Matrix3d projector = unheld_directions();
  if (projector.trace() < 0.5) return;
  // Each row holds either a rate or a force: in short steps the far larger rates would hide the force in a mixed row.
  const auto count = static_cast<Eigen::Index>(free_count());
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

/// Adds to the rates the velocity that touching redundant walls give the centre. Gaps and overlaps that are integration
/// errors close gradually; closed at once, these contacts would open and close in turns.
void Contacts::take_along(std::span<const Ramp> ramps, std::span<const double> y, double touch,
                          std::span<const char> touches, std::span<double> dy) {
  const std::size_t n = class_count();
  const auto is_force = [&](std::size_t j) { return ramps[j].control == Control::force; };
  const auto takes_along = [&](std::size_t j) {
    return is_redundant_[j] && !is_force(j) && (touches.empty() || touches[j]);
  };
  for (std::size_t j = 0; j < n; ++j) {
    free_displacements_[j] = takes_along(j) ? entry(j, n) - closing(y[j], touch) : k_no_wall;
  }
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  if (!release_centre(unheld_directions(), velocity)) return;
  for (std::size_t j = 0; j < n; ++j) {
    const bool is_touching = free_displacements_[j] != k_no_wall;
    entry(j, n) = is_touching ? std::min(free_approach(j, velocity), 0.0) + closing(y[j], touch)
                              : entry(j, n) + arm_of(j).dot(velocity);
  }
  for (std::size_t k = 0; k < free_count(); ++k) dy[n + k] += velocity[at(k)];
}

/// Moves a state along the straight line of targets to targets_. The path matters, because a wall that makes contact
/// and leaves again keeps the centre where it has moved it. A step is accepted if the same walls touch all along it,
/// and if its halves lead to the same position.
/// @return false, with y unchanged, where further walls begin to bear on the path
bool Contacts::take_centre_to_targets(std::span<double> y) {
  const std::size_t n = class_count();
  std::copy(targets_.begin(), targets_.end(), way_end_.begin());
  find_start(way_end_, y, way_start_);
  double size = place_of(y).norm();
  for (std::size_t j = 0; j < n; ++j) {
    if (way_end_[j].is_force) continue;
    size = std::max({size, std::abs(way_start_[j].value), std::abs(way_end_[j].value)});
  }
  std::copy(y.begin(), y.end(), carried_.begin());
  const auto go_to = [&](double share, std::span<double> state) {
    set_targets_between(way_start_, way_end_, share);
    if (let_all_go(state)) return true;
    find_holding(state, k_touching * size);
    return let_others_go(state);
  };
  const auto touch_the_same = [&](std::span<const double> other) {
    for (std::size_t j = 0; j < n; ++j) {
      if ((at_once_[j] == 0.0) != (other[j] == 0.0)) return false;
    }
    return true;
  };
  const auto lead_to_one_place = [&] {
    return (place_of(at_once_) - place_of(by_halves_)).norm() <= k_same_place * size;
  };
  bool is_possible = true;
  double step = 1.0;
  double too_far = 1.0;  // end of the last step that was too long
  int tries = 0;
  for (double done = 0.0; is_possible && done < 1.0;) {
    const double next = std::min(1.0, done + step);
    for (auto* state : {&at_once_, &by_halves_, &early_, &late_}) std::ranges::copy(carried_, state->begin());
    const bool may_be_cut = step > k_shortest && tries < k_most_tries;
    // The test that rejects a step soonest comes first, because most steps are too long.
    const auto goes_on = [may_be_cut](bool is_same) { return is_same || !may_be_cut; };
    is_possible =
        go_to(next, at_once_) && go_to(std::lerp(done, next, k_early), early_) && goes_on(touch_the_same(early_)) &&
        go_to(std::midpoint(done, next), by_halves_) && go_to(next, by_halves_) && goes_on(lead_to_one_place()) &&
        std::ranges::all_of(k_late, [&](double late) { return go_to(std::lerp(done, next, 1.0 - late), late_); }) &&
        go_to(next, late_) && goes_on(touch_the_same(late_));
    if (may_be_cut && !is_possible) {
      is_possible = true;
      too_far = next;
      step *= 0.5;
      ++tries;
      continue;
    }
    if (!is_possible) break;
    std::ranges::copy(by_halves_, carried_.begin());
    done = next;
    // A rejected step contains a point where other walls begin to touch. The next steps close in on it, and pass it.
    step = done < too_far ? std::max(k_shortest, 0.5 * (too_far - done)) : 1.0 - done;
  }
  std::copy(way_end_.begin(), way_end_.end(), targets_.begin());
  if (is_possible) std::copy(carried_.begin(), carried_.end(), y.begin());
  return is_possible;
}

/// Finds the equilibrium from a guess whose errors exceed the overlaps: moves the centre in the direction in which the
/// particle's energy falls. As a function of the centre's position, the energy is convex wherever M is positive
/// definite, so that no guess is too far away.
/// @return false, with y unchanged, if the search does not reach balance, or if M is not positive definite with every
/// contact as deep as the deeper of y and the result
bool Contacts::sink_to_balance(std::span<double> y) {
  if (free_count() == 0) return false;
  std::copy(y.begin(), y.end(), state_.begin());
  double size = place_of(state_).norm();
  for (std::size_t j = 0; j < class_count(); ++j) {
    size = std::max({size, std::abs(y[j]), targets_[j].is_force ? 0.0 : std::abs(targets_[j].value)});
  }
  const auto net_at = [&](const Eigen::Vector3d& place) -> std::optional<Eigen::Vector3d> {
    std::ranges::copy(state_, trial_.begin());
    std::copy_n(place.begin(), free_count(), trial_.begin() + static_cast<std::ptrdiff_t>(class_count()));
    if (!newton(trial_, 0.0, true)) return std::nullopt;
    Eigen::Vector3d net = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < free_count(); ++k) net[at(k)] = net_force(k);
    return net;
  };
  Eigen::Vector3d place = place_of(state_);
  auto net = net_at(place);
  for (int step = 0; net && step < k_most_sinking_steps; ++step) {
    Eigen::Vector3d way = way_to_balance(*net);
    if (way.norm() <= k_resolved * size) break;
    way *= std::min(1.0, size / way.norm());
    const double power = way.dot(*net);
    // A step is halved if there is no state at its end, or if it goes too far past the balance.
    auto next = net_at(place + way);
    for (; !(next && way.dot(*next) <= -k_past_balance * power) && way.norm() > k_resolved * size;
         next = net_at(place + way)) {
      way *= 0.5;
    }
    place += way;
    net = next;
    std::ranges::copy(trial_, state_.begin());
  }
  if (!net || has_left_branch(trial_) || !is_balanced(trial_)) return false;
  for (std::size_t j = 0; j < class_count(); ++j) state_[j] = std::max(y[j], trial_[j]);
  if (!(least_pivot(state_) > 0.0)) return false;
  std::copy(trial_.begin(), trial_.end(), y.begin());
  return true;
}

void Contacts::clear_centre(std::span<const Ramp> ramps, double xi, std::span<const char> is_closed,
                            std::span<double> y) {
  set_targets(ramps, xi);
  if (let_all_go(y)) return;
  if (free_count() > 0)
    let_bystanders_go(is_closed, y);
  else
    close_gaps(is_closed, y);
}

/// Sets the gaps of open walls from their displacements and the forces on the others. A distant force may lift a wall's
/// contact by less than the integration error of its gap.
void Contacts::close_gaps(std::span<const char> is_closed, std::span<double> y) {
  evaluate(y);
  for (std::size_t j = 0; j < class_count(); ++j) {
    if (is_closed[j] || targets_[j].is_force) continue;
    const double approach = targets_[j].value + lift_by_forces(j);
    y[j] = approach > 0.0 ? law_.signed_square(approach) : approach;
  }
}

/// Moves the centre clear of all walls, so that no contact is loaded. No other state is in equilibrium then: its forces
/// balance, and the cleared centre has no overlap, hence sum_j F_j d_j <= 0 and sum_j F_j g_j <= sum_jh F_j G_jh F_h.
/// Wherever M is positive definite, the left side is the larger one.
/// @return false, with y unchanged, if a wall has a prescribed force, or if the walls leave no such position
bool Contacts::let_all_go(std::span<double> y) {
  const std::size_t n = class_count();
  for (std::size_t j = 0; j < n; ++j) {
    if (targets_[j].is_force && targets_[j].value != 0.0) return false;
    free_displacements_[j] = targets_[j].is_force ? k_no_wall : targets_[j].value;
  }
  Eigen::Vector3d place = place_of(y);
  if (!release_centre(Eigen::Matrix3d::Identity(), place)) return false;
  std::fill_n(y.begin(), n, 0.0);
  put(place, y);
  return true;
}

/// Sets the rates if no contact is loaded and none begins to be: the centre evades the walls that touch, and no others.
/// Gaps that are integration errors close gradually; if they did not count as touching, walls would leave in turns.
/// @return false, with dy unchanged, in all other cases
bool Contacts::let_go_on(std::span<const Ramp> ramps, std::span<const double> y, std::span<double> dy, double touch,
                         std::span<const char> touches) {
  const std::size_t n = class_count();
  if (free_count() == 0) return false;
  for (std::size_t j = 0; j < n; ++j) {
    const bool is_force = ramps[j].control == Control::force;
    const double slope = ramps[j].end - ramps[j].start;
    if (y[j] > 0.0 || (is_force && slope != 0.0)) return false;
    const bool is_off = !(touches.empty() || touches[j]);
    free_displacements_[j] = is_force || is_off ? k_no_wall : slope - closing(y[j], touch);
  }
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  if (!release_centre(Eigen::Matrix3d::Identity(), velocity)) return false;
  for (std::size_t j = 0; j < n; ++j) {
    const bool is_touching = free_displacements_[j] != k_no_wall;
    free_displacements_[j] = ramps[j].end - ramps[j].start;
    const double rate = free_approach(j, velocity);
    dy[j] = ramps[j].control == Control::force ? 0.0 : is_touching ? std::min(rate, closing(y[j], touch)) : rate;
  }
  std::copy_n(velocity.begin(), free_count(), dy.begin() + static_cast<std::ptrdiff_t>(n));
  return true;
}

/// Approach of a wall while no contact is loaded; exactly 0 if the wall touches up to round-off. The round-off is
/// relative to the distance of the centre, whatever the axes along which it moves.
double Contacts::free_approach(std::size_t index, const Eigen::Vector3d& centre, double rounding) const {
  const double displacement = free_displacements_[index];
  const Eigen::Vector3d arm = arm_of(index);
  const double sum = displacement + arm.dot(centre);
  const double size = std::abs(displacement) + arm.norm() * centre.norm();
  return std::abs(sum) <= std::max(rounding * size, k_no_approach) ? 0.0 : sum;
}

/// Moves the centre within the subspace of a projector to the nearest position where no wall of free_displacements_
/// overlaps the surface.
/// @return false, with the centre unchanged, if the walls leave no such position
bool Contacts::release_centre(const Eigen::Matrix3d& projector, Eigen::Vector3d& centre) const {
  const auto clear = [&] { return clear_walls(class_count(), projector, centre); };
  if (!clear()) return false;
  // Round-off of a long displacement leaves a small overlap, which a small displacement removes.
  for (int refinement = 0; refinement < k_refinements; ++refinement) {
    if (!clear()) break;
  }
  return true;
}

/// Moves a position like release_centre(), clear of the first `count` walls only. If the nearest position clear of the
/// earlier walls overlaps a wall, that wall touches the surface in the result, and the search goes on in its plane.
bool Contacts::clear_walls(std::size_t count, const Eigen::Matrix3d& projector, Eigen::Vector3d& place,
                           double rounding) const {
  Eigen::Vector3d now = place;
  for (std::size_t j = 0; j < count; ++j) {
    const double displacement = free_displacements_[j];
    if (displacement == k_no_wall || free_approach(j, now, rounding) <= 0.0) continue;
    const Eigen::Vector3d arm = arm_of(j);
    const Eigen::Vector3d along = projector * arm;
    const double share = along.squaredNorm();
    if (!(share > k_same_surroundings * k_same_surroundings)) return false;
    now = place - along * ((displacement + arm.dot(place)) / share);
    if (!clear_walls(j, projector - along * along.transpose() / share, now, rounding)) return false;
  }
  place = now;
  return true;
}

/// Approach that the forces on all walls add to that of a wall, sum_h G_jh F_h.
double Contacts::lift_by_forces(std::size_t index) const noexcept {
  double sum = 0.0;
  for (std::size_t h = 0; h < class_count(); ++h) sum += coupling_(at(index), at(h)) * forces_[h];
  return sum;
}

/// Writes the position of the centre to a state, and the gaps that the walls of free_displacements_ then have.
void Contacts::put(const Eigen::Vector3d& place, std::span<double> y) const {
  for (std::size_t j = 0; j < class_count(); ++j) {
    if (free_displacements_[j] != k_no_wall) y[j] = std::min(free_approach(j, place), 0.0);
  }
  std::copy_n(place.begin(), free_count(), y.begin() + static_cast<std::ptrdiff_t>(class_count()));
}

/// Displacement of the centre in a state.
Eigen::Vector3d Contacts::place_of(std::span<const double> y) const {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  std::copy_n(y.begin() + static_cast<std::ptrdiff_t>(class_count()), free_count(), place.begin());
  return place;
}

/// Mean normal of a class along the free directions.
Eigen::Vector3d Contacts::arm_of(std::size_t index) const {
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();
  arm.head(directions_.cols()) = arms_.row(at(index)).transpose();
  return arm;
}

}  // namespace monograin::nonlocal
