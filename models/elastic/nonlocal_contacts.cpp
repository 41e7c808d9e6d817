#include "elastic/nonlocal_contacts.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "elastic/hertz.hpp"
#include "system/limit.hpp"

namespace monograin::nonlocal {
namespace {

constexpr int k_newton_limit = 100;    // contraction by half reaches rounding in 52
constexpr double k_contraction = 0.5;  // of Newton's corrections; less is a guess too far away
constexpr int k_first_touch_steps = 20;
constexpr double k_stagnation = 1e-9;   // rounding grows with 1/margin near the limit
constexpr double k_balance = 1e-9;      // net force over the sum of forces
constexpr double k_least_hold = 1e-12;  // of the centre in a direction, over the greatest
constexpr double k_least_step = 1e-13;  // of the way to a state that is not found at once
constexpr int k_most_steps = 1000;      // on that way, tried ones included
constexpr int k_most_roundings = 20;    // times that its end is found with forces of rounding left over
// Of where walls begin to push each other off, and of how deep contacts are: what the branch is followed by at once.
constexpr double k_share_of_rivalry = 0.25;
constexpr double k_share_of_depth = 0.5;

// How fast an error of the balance is drawn back where a force shrinks, over how fast that does.
constexpr double k_hurry = 2.0;

// Margin, and contact radius over R, of a path of states that ends at the limit of applicability, or where the contacts
// open: as near as a search comes to either.
constexpr double k_no_margin = 5e-4;
constexpr double k_no_contact = 5e-7;

double require_poisson_ratio(double nu) {
  if (nu >= 0.0 && nu <= 0.5) return nu;
  throw std::invalid_argument("Poisson's ratio must be in [0, 0.5], but is " + std::to_string(nu));
}

/// Orthonormal basis of what the mean normals span; the axes where that is everything.
Eigen::Matrix3Xd basis_of(const Eigen::Matrix3Xd& normals, double least) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(normals, Eigen::ComputeThinU);
  const auto rank = (svd.singularValues().array() > least).count();
  if (rank == 3) return Eigen::Matrix3d::Identity();
  return svd.matrixU().leftCols(rank);
}

}  // namespace

Contacts::Contacts(const Formulation& model, std::span<const ContactClass> classes, Centre centre)
    : poisson_ratio_(require_poisson_ratio(model.poisson_ratio)),
      law_(model.terms),
      modulus_(monograin::composite_modulus(1.0, poisson_ratio_)) {
  const std::size_t n = classes.size();
  for (const ContactClass& c : classes) weights_.push_back(c.multiplicity());
  const std::vector<Wall> walls = walls_of(classes);
  const Eigen::MatrixXd influence = influence_of(model.influence, poisson_ratio_, walls, classes);
  coupling_ = coupling_of(influence, walls, classes);
  neighbours_ = neighbours_of(poisson_ratio_, walls, n);
  rivalry_ = rivalry_of(influence, modulus_, walls, n);
  has_modes_of_walls_ = is_any_lifted(influence);
  std::vector<std::size_t> class_of;
  for (const Wall& wall : walls) class_of.push_back(wall.contact_class);
  // With positive couplings the critical mode is positive (Perron), hence one of the classes.
  modes_ = Modes(influence, class_of, !has_modes_of_walls_);

  const Eigen::Matrix3Xd mean_normals = mean_normals_of(classes);
  directions_ = centre == Centre::free ? basis_of(mean_normals, k_same_surroundings) : Eigen::Matrix3Xd(3, 0);
  arms_ = mean_normals.transpose() * directions_;
  reserve_working_memory();
}

/// Nothing is allocated after this.
void Contacts::reserve_working_memory() {
  const std::size_t n = class_count();
  stride_ = n + 1 + free_count();
  matrix_.resize(n * stride_);
  now_.resize(n);
  for (auto* values : {&forces_, &stiffness_, &seen_, &free_displacements_}) values->resize(n);
  for (auto* marks : {&may_bear_, &sorted_, &is_redundant_, &holds_}) marks->resize(n);
  for (auto* targets : {&targets_, &first_targets_, &last_targets_, &way_start_, &way_end_}) targets->resize(n);
  for (auto* state : {&trial_, &state_, &unit_rates_, &carried_, &at_once_, &by_halves_, &early_, &late_})
    state->resize(unknown_count());
  unit_ramps_.resize(n);
  forget();
}

Contacts::Target Contacts::target(bool is_force, double value) const {
  if (!std::isfinite(value)) throw std::domain_error("a wall is prescribed a value that is not finite");
  return {is_force, value, is_force ? law_.signed_square_under(value / modulus_) : 0.0};
}

/// The targets of an instant of a step of the program.
void Contacts::set_targets(std::span<const Ramp> ramps, double xi) {
  for (std::size_t j = 0; j < class_count(); ++j) {
    targets_[j] = target(ramps[j].control == Control::force, std::lerp(ramps[j].start, ramps[j].end, xi));
  }
}

/// Of what the ends prescribe, where a state is.
void Contacts::find_start(std::span<const Target> ends, std::span<const double> y, std::span<Target> starts) {
  evaluate(y);
  for (std::size_t j = 0; j < class_count(); ++j) {
    const bool is_force = ends[j].is_force;
    starts[j] = {is_force, is_force ? forces_[j] : now_[j].approach - lift(j, y), y[j]};
  }
}

/// On the straight way from the one to the other.
void Contacts::set_targets_between(std::span<const Target> starts, std::span<const Target> ends, double share) {
  for (std::size_t j = 0; j < class_count(); ++j) {
    targets_[j] = share == 1.0 ? ends[j] : target(ends[j].is_force, std::lerp(starts[j].value, ends[j].value, share));
  }
}

/// Contacts, forces and stiffnesses of a state.
void Contacts::evaluate(std::span<const double> y) {
  const auto squares = y.first(class_count());
  if (std::ranges::equal(squares, seen_)) return;
  forget();
  for (std::size_t j = 0; j < class_count(); ++j) {
    now_[j] = law_.at(y[j]);
    forces_[j] = modulus_ * now_[j].force;
    stiffness_[j] = 2.0 * modulus_ * now_[j].contact_radius;
  }
  std::ranges::copy(squares, seen_.begin());
}

/// What was looked at is about to be changed.
void Contacts::forget() noexcept { seen_[0] = std::numeric_limits<double>::quiet_NaN(); }

/// What the displacement of the centre and the forces on other walls add to the approach of a wall.
double Contacts::lift(std::size_t index, std::span<const double> y) const noexcept {
  const std::size_t n = class_count();
  double sum = lift_by_forces(index);
  for (std::size_t k = 0; k < free_count(); ++k) sum += arms_(at(index), at(k)) * y[n + k];
  return sum;
}

double Contacts::net_force(std::size_t direction) const noexcept {
  double sum = 0.0;
  for (std::size_t j = 0; j < class_count(); ++j) sum += weights_[j] * forces_[j] * arms_(at(j), at(direction));
  return sum;
}

/// Solves (1 - G dF/dg) x = right-hand sides. The pivots are those of M: scaled by the roots of dF/dg the two are one
/// matrix. So none has to be searched for, and one that is not positive is beyond the limit.
bool Contacts::eliminate() noexcept {
  const std::size_t n = class_count();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t h = 0; h < n; ++h) entry(i, h) = -coupling_(at(i), at(h)) * stiffness_[h];
    entry(i, i) += 1.0;
    for (std::size_t k = 0; k < free_count(); ++k) entry(i, n + 1 + k) = arms_(at(i), at(k));
  }
  for (std::size_t p = 0; p < n; ++p) {
    double* const pivot_row = &entry(p, 0);
    if (!(pivot_row[p] > 0.0)) return false;
    const double inverse = 1.0 / pivot_row[p];
    for (std::size_t c = p + 1; c < stride_; ++c) pivot_row[c] *= inverse;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == p) continue;
      double* const row = &entry(i, 0);
      const double factor = row[p];
      for (std::size_t c = p + 1; c < stride_; ++c) row[c] -= factor * pivot_row[c];
    }
  }
  return true;
}

/// At first touch all stiffnesses vanish together; equal ones give the motion of equal contacts. For move_centre()
/// only.
void Contacts::regularise_first_touch(double stiffness, const auto& is_touching) {
  if (std::any_of(stiffness_.begin(), stiffness_.end(), [](double value) { return value != 0.0; })) return;
  for (std::size_t j = 0; j < class_count(); ++j) {
    if (is_touching(j)) stiffness_[j] = stiffness;
  }
}

/// The way of the centre on which a net force vanishes to first order. Directions that no contact holds stay.
Eigen::Vector3d Contacts::way_to_balance(const Eigen::Vector3d& net_force) {
  const std::size_t n = class_count();
  Eigen::Matrix3d hold = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < free_count(); ++k) {
    for (std::size_t l = 0; l < free_count(); ++l) {
      for (std::size_t j = 0; j < n; ++j) {
        hold(at(k), at(l)) += weights_[j] * arms_(at(j), at(k)) * stiffness_[j] * entry(j, n + 1 + l);
      }
    }
  }
  // It is symmetric but where stiffnesses have been lent; directions that no contact holds are those of either side.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(0.5 * (hold + hold.transpose()));
  const double least = k_least_hold * solver.eigenvalues().cwiseAbs().maxCoeff();
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d direction = solver.eigenvectors().col(k);
    if (std::abs(solver.eigenvalues()[k]) > least)
      way -= direction * (direction.dot(net_force) / solver.eigenvalues()[k]);
  }
  return way;
}

/// Displaces the centre by that way, and lets the approaches follow.
void Contacts::move_centre(const Eigen::Vector3d& net_force, std::span<double> centre) {
  const std::size_t n = class_count();
  const Eigen::Vector3d step = way_to_balance(net_force);
  for (std::size_t k = 0; k < free_count(); ++k) {
    centre[k] += step[at(k)];
    for (std::size_t j = 0; j < n; ++j) entry(j, n) += entry(j, n + 1 + k) * step[at(k)];
  }
}

/// Projector on the directions in which no contact holds the centre, the stiffest taken first: beside a stiff one, the
/// directions of the matrix of all do not tell one that has just begun from nothing.
Eigen::Matrix3d Contacts::directions_of_nothing() const {
  Eigen::Matrix3d projector = Eigen::Matrix3d::Identity();
  double stiffest = 0.0;
  for (std::size_t count = 0; count < free_count(); ++count) {
    double hold = 0.0;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    for (std::size_t j = 0; j < class_count(); ++j) {
      const Eigen::Vector3d along = projector * arm_of(j);
      const double own = weights_[j] * stiffness_[j] * along.squaredNorm();
      if (!(own > hold)) continue;
      hold = own;
      direction = along.normalized();
    }
    stiffest = std::max(stiffest, hold);
    if (!(hold > k_least_hold * stiffest)) break;
    projector -= direction * direction.transpose();
  }
  return projector;
}

/// Newton's method towards the targets, with a part of the imbalance left. Gives up where its corrections do not
/// contract, or M is not positive definite: the other branches are beyond such a state.
bool Contacts::newton(std::span<double> y, double imbalance, bool do_hold_centre) {
  const std::size_t n = class_count();
  const bool is_free = free_count() > 0 && !do_hold_centre;
  // From first touch a free centre has to find out which contacts bear it, in as many steps as that takes.
  // On the way in steps nobody asks for balance, and the contacts are those of the state before.
  const bool is_to_balance = imbalance == 0.0;
  double farthest = 0.0;
  double stiffness = 1.0;  // of what only touches: that of contacts under the greatest force
  double deepest = 0.0;
  for (const Target& goal : targets_) {
    if (is_to_balance && !goal.is_force) farthest = std::max(farthest, std::abs(goal.value));
    if (!goal.is_force || !(goal.signed_square > deepest)) continue;
    deepest = goal.signed_square;
    stiffness = goal.value / deepest;
  }
  bool is_first_touch = is_free;
  for (std::size_t j = 0; j < n; ++j) {
    // How deep a contact is under a force does not say what bears that.
    if (!targets_[j].is_force && y[j] > k_unloaded * farthest) is_first_touch = false;
  }
  // Later, a wall that nothing opposes takes it along: the force s^(3/2) that the first step gives that wall is undone
  // by steps of 2/3, 2/9 ... of it.
  int free_steps = is_first_touch ? k_first_touch_steps : is_free && is_to_balance ? 2 : 1;
  double last = 0.0;
  forget();
  for (int iteration = 0; iteration < k_newton_limit; ++iteration) {
    for (std::size_t j = 0; j < n; ++j) {
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
    for (std::size_t j = 0; j < n; ++j) {
      entry(j, n) = targets_[j].is_force ? 0.0 : targets_[j].value + lift(j, y) - now_[j].approach;
    }
    const bool may_lend = iteration == 0 && is_free && is_to_balance && !is_first_touch;
    if (may_lend && lend_stiffness(k_touching * farthest, y)) free_steps = k_first_touch_steps;
    if (!eliminate()) return false;
    double correction = 0.0;
    if (is_free) {
      const auto is_touching = [&](std::size_t j) {
        return !targets_[j].is_force && targets_[j].value + arm_of(j).dot(place_of(y)) >= -deepest;
      };
      regularise_first_touch(stiffness, is_touching);
      const auto net = [&] {
        Eigen::Vector3d sum = -imbalance * imbalance_;
        for (std::size_t k = 0; k < free_count(); ++k) {
          sum[at(k)] += net_force(k);
          for (std::size_t j = 0; j < n; ++j)
            sum[at(k)] += weights_[j] * arms_(at(j), at(k)) * stiffness_[j] * entry(j, n);
        }
        return sum;
      };
      double borne = 0.0;
      for (std::size_t j = 0; j < n; ++j) borne += weights_[j] * forces_[j];
      const Eigen::Vector3d unbalanced = net();
      const double left = (directions_of_nothing() * unbalanced).norm();
      move_centre(unbalanced, y.subspan(n));
      // Where the first contacts do not hold it, others that touch may, as stiff as at first.
      if (is_first_touch && iteration < free_steps && left > k_balance * borne) {
        const Eigen::Vector3d rest = net();
        for (std::size_t j = 0; j < n; ++j) {
          if (stiffness_[j] == 0.0 && is_touching(j)) stiffness_[j] = stiffness;
        }
        move_centre(rest, y.subspan(n));
      }
    }
    double scale = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      if (targets_[j].is_force) continue;
      const double step = entry(j, n) / now_[j].approach_slope;
      y[j] += step;
      correction = std::max(correction, std::abs(step));
      scale = std::max(scale, std::abs(y[j]));
    }
    // What is left is at most a further contraction of this correction.
    const double contraction = iteration > 0 ? std::min(correction / last, 1.0) : 1.0;
    if (correction * contraction <= k_resolved * scale) return true;
    // Contacts that are shallow against the way of the centre are what rounding of that leaves.
    if (iteration >= free_steps && contraction > k_contraction) {
      double length = 0.0;
      for (std::size_t j = 0; j < n; ++j) {
        if (!targets_[j].is_force) length = std::max({length, std::abs(targets_[j].value), std::abs(lift(j, y))});
      }
      return correction <= std::max(k_stagnation * scale, k_resolved * length);
    }
    last = correction;
  }
  return false;
}

/// Whether a state found by Newton's method is off the branch in modes that the method does not see: those of single
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

/// Contacts of a centre that only goes along are no deeper than rounding: what the resolved displacement makes of their
/// forces need not balance.
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
  // Of the places to which others may take a centre along, Newton's method knows no nearest one.
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

/// From a state, which is the solution for some displacements, forces and imbalance, along a straight line to the
/// targets. Newton's method contracts from one point to the next, if they are near, only on the branch of the first.
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
    // Short steps that succeed now and then do not arrive either.
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

void Contacts::rates(std::span<const Ramp> ramps, std::span<const double> y, std::span<double> dy, double touch,
                     double pull, std::span<const char> touches) {
  const std::size_t n = class_count();
  if (let_go_on(ramps, y, dy, touch, touches)) return;
  evaluate(y);
  const auto is_force = [&](std::size_t j) { return ramps[j].control == Control::force; };
  const auto slope = [&](std::size_t j) { return ramps[j].end - ramps[j].start; };
  forget();
  // What bystanders bear is error: two of them would hold the centre in their corner.
  if (free_count() > 0) sort_near(ramps, y, 2.0 * touch);
  for (std::size_t j = 0; j < n; ++j) {
    if (is_force(j) || (free_count() > 0 && is_redundant_[j])) stiffness_[j] = 0.0;
  }
  for (std::size_t j = 0; j < n; ++j) {
    entry(j, n) = is_force(j) ? 0.0 : slope(j);
    for (std::size_t h = 0; h < n; ++h) {
      if (is_force(h)) entry(j, n) += coupling_(at(j), at(h)) * slope(h);
    }
  }
  if (!eliminate()) {
    throw DomainError({Limit::applicability, -1, "margin", margin(y)});
  }
  if (free_count() > 0) {
    regularise_first_touch(
        1.0, [&](std::size_t j) { return !is_force(j) && y[j] == 0.0 && entry(j, n) >= 0.0 && !is_redundant_[j]; });
    const auto force_rate = [&](std::size_t j) { return is_force(j) ? slope(j) : stiffness_[j] * entry(j, n); };
    Eigen::Vector3d net = Eigen::Vector3d::Zero();
    double pressing = 0.0;
    double near = touch;
    const Eigen::Matrix3d unheld = unheld_directions();
    // Contacts that bear a centre against a force end with it, if no error of that balance is left.
    bool is_forced = false;
    // Where one shrinks, an error of the balance would outlast it, and open the contact that bears it.
    double hurry = pull;
    for (std::size_t j = 0; j < n; ++j) {
      is_forced = is_forced || (is_force(j) && y[j] > touch);
      if (is_force(j) && forces_[j] > 0.0) hurry = std::max(hurry, -k_hurry * slope(j) / forces_[j]);
    }
    Eigen::Vector3d error = Eigen::Vector3d::Zero();
    for (std::size_t j = 0; j < n; ++j) {
      if (is_forced && !is_redundant_[j]) error += weights_[j] * forces_[j] * arm_of(j);
      net += weights_[j] * force_rate(j) * arm_of(j);
      // What walls under displacements leave is rounding of all that they would change; where none is to change, that
      // of the forces.
      pressing += weights_[j] * (std::abs(force_rate(j)) + pull * forces_[j]);
      // Forces that contacts bear already, or that do not shrink, do not say how near those are that may bear the
      // others.
      const bool is_borne = is_force(j) && (unheld * arm_of(j)).norm() <= k_same_surroundings;
      near = std::max(near, is_force(j) && slope(j) < 0.0 && !is_borne ? y[j] : k_unloaded * y[j]);
    }
    const auto centre = dy.subspan(n);
    std::ranges::fill(centre, 0.0);
    move_centre(net + hurry * error, centre);
    // So much of an error says nothing of what drives the centre where no contact holds it.
    const double left = (directions_of_nothing() * (net + pull * error)).norm();
    if (has_redundant_walls()) take_along(ramps, y, touch, touches, dy);
    // Walls that just touch hold the centre at once, if they can bear; and those that are as near as a force is deep,
    // as errors take them off just before it ends.
    if (left > k_balance * pressing && !may_be_held(ramps, y, near)) throw DomainError(Limit::centre_driven_away);
  }
  for (std::size_t j = 0; j < n; ++j) {
    dy[j] = entry(j, n) / now_[j].approach_slope;
    if (is_force(j)) {
      const double by_square = 2.0 * modulus_ * now_[j].contact_radius * now_[j].approach_slope;
      dy[j] = slope(j) == 0.0 ? 0.0 : slope(j) / by_square;
    }
  }
}

void Contacts::residual(std::span<const Ramp> ramps, double xi, std::span<const double> y, std::span<double> residual) {
  const std::size_t n = class_count();
  evaluate(y);
  for (std::size_t j = 0; j < n; ++j) {
    const Target goal = target(ramps[j].control == Control::force, std::lerp(ramps[j].start, ramps[j].end, xi));
    residual[j] = goal.is_force ? y[j] - goal.signed_square : now_[j].approach - goal.value - lift(j, y);
  }
  for (std::size_t k = 0; k < free_count(); ++k) residual[n + k] = net_force(k);
}

void Contacts::jacobian(std::span<const Ramp> ramps, std::span<const double> y, Eigen::MatrixXd& jacobian) {
  const std::size_t n = class_count();
  evaluate(y);
  jacobian.setZero(at(unknown_count()), at(unknown_count()));
  for (std::size_t j = 0; j < n; ++j) {
    const double force_slope = stiffness_[j] * now_[j].approach_slope;
    for (std::size_t k = 0; k < free_count(); ++k)
      jacobian(at(n + k), at(j)) = weights_[j] * arms_(at(j), at(k)) * force_slope;
    for (std::size_t i = 0; i < n; ++i) {
      if (ramps[i].control == Control::displacement) jacobian(at(i), at(j)) = -coupling_(at(i), at(j)) * force_slope;
    }
    if (ramps[j].control == Control::force) {
      jacobian(at(j), at(j)) = 1.0;
    } else {
      jacobian(at(j), at(j)) += now_[j].approach_slope;
      for (std::size_t k = 0; k < free_count(); ++k) jacobian(at(j), at(n + k)) = -arms_(at(j), at(k));
    }
  }
}

double Contacts::margin(std::span<const double> y) {
  evaluate(y);
  return modes_.margin(stiffness_);
}

double Contacts::least_pivot(std::span<const double> y, double shift) {
  evaluate(y);
  return modes_.least_pivot(stiffness_, shift);
}

double Contacts::branch_reach(std::size_t index, double signed_square) const noexcept {
  return std::max(k_share_of_rivalry * rivalry_[index], k_share_of_depth * std::abs(signed_square));
}

bool Contacts::is_held_softly(std::span<const Ramp> ramps, std::span<const double> y, double s) {
  evaluate(y);
  const Eigen::Index count = directions_.cols();
  Eigen::MatrixXd reach = Eigen::MatrixXd::Zero(count, count);
  Eigen::MatrixXd hold = reach;
  for (std::size_t j = 0; j < class_count(); ++j) {
    if (y[j] < -s) continue;
    const Eigen::MatrixXd along = weights_[j] * arms_.row(at(j)).transpose() * arms_.row(at(j));
    reach += along;
    // A wall under a force follows the centre.
    if (y[j] > s && ramps[j].control == Control::displacement) hold += along;
  }
  const auto rank = [](const Eigen::MatrixXd& matrix) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
    return (solver.eigenvalues().array() > k_same_surroundings).count();
  };
  return rank(hold) < rank(reach);
}

void Contacts::contacts(std::span<const double> y, std::span<ContactState> states) {
  evaluate(y);
  for (std::size_t j = 0; j < class_count(); ++j) {
    states[j] = {.displacement = now_[j].approach - lift(j, y),
                 .approach = now_[j].approach,
                 .signed_square = y[j],
                 .contact_radius = now_[j].contact_radius,
                 .force = forces_[j],
                 .stiffness = stiffness_[j]};
  }
}

double Contacts::deformed_radius(RadiusRule rule, std::size_t index, std::span<const double> y) {
  evaluate(y);
  const double a = now_[index].contact_radius;
  if (a == 0.0 || rule == RadiusRule::none) return a;
  double sum = a + forces_[index] * local_radius_influence(poisson_ratio_, a);
  const RadiusInfluence influence(rule, poisson_ratio_, a);
  for (const Neighbours& alike : neighbours_[index]) {
    const double force = forces_[alike.contact_class];
    if (force > 0.0) sum += alike.count * force * influence(alike.angle, alike.quotient);
  }
  return sum;
}

double Contacts::energy(std::span<const double> y) {
  evaluate(y);
  double sum = 0.0;
  for (std::size_t j = 0; j < class_count(); ++j) {
    double approach = 0.0;
    for (std::size_t h = 0; h < class_count(); ++h) approach += coupling_(at(j), at(h)) * forces_[h];
    sum += weights_[j] * (modulus_ * law_.energy(y[j]) - 0.5 * forces_[j] * approach);
  }
  return sum;
}

void Contacts::stiffness(std::span<const double> y, Eigen::MatrixXd& stiffness) {
  const std::size_t n = class_count();
  stiffness.resize(at(n), at(n));
  for (std::size_t h = 0; h < n; ++h) {
    for (std::size_t j = 0; j < n; ++j) unit_ramps_[j] = {.start = 0.0, .end = j == h ? 1.0 : 0.0};
    rates(unit_ramps_, y, unit_rates_);
    for (std::size_t j = 0; j < n; ++j) {
      const double by_approach = 2.0 * modulus_ * now_[j].contact_radius;
      stiffness(at(j), at(h)) = by_approach * now_[j].approach_slope * unit_rates_[j];
    }
  }
}

}  // namespace monograin::nonlocal
