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

constexpr double k_least_hold = 1e-12;  // stiffness that supports the centre in a direction, over the greatest
// Bounds of a step along the branch: shares of the s at which walls push each other off, and of how deep contacts are.
constexpr double k_share_of_rivalry = 0.25;
constexpr double k_share_of_depth = 0.5;

// Decay rate of a balance error where a prescribed force shrinks, over the relative rate of that force.
constexpr double k_hurry = 2.0;

bool takes_force(const Ramp& ramp) noexcept { return ramp.control == Control::force; }

double slope_of(const Ramp& ramp) noexcept { return ramp.end - ramp.start; }

double require_poisson_ratio(double nu) {
  if (nu >= 0.0 && nu <= 0.5) return nu;
  throw std::invalid_argument("Poisson's ratio must be in [0, 0.5], but is " + std::to_string(nu));
}

/// Orthonormal basis of the span of the mean normals; the coordinate axes if they span all directions.
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
  has_modes_of_walls_ = has_negative_coupling(influence);
  std::vector<std::size_t> class_of;
  for (const Wall& wall : walls) class_of.push_back(wall.contact_class);
  // With positive couplings the critical mode is positive (Perron), hence one of the classes.
  modes_ = Modes(influence, class_of, !has_modes_of_walls_);

  const Eigen::Matrix3Xd mean_normals = mean_normals_of(classes);
  directions_ = centre == Centre::free ? basis_of(mean_normals, k_same_surroundings) : Eigen::Matrix3Xd(3, 0);
  arms_ = mean_normals.transpose() * directions_;
  reserve_working_memory();
}

/// Allocates all working memory; nothing is allocated after this.
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

/// Evaluates contacts, forces and stiffnesses of a state, or reuses the cached evaluation if it is for the same state.
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

/// Drops the cached evaluation, whose values are about to be changed.
void Contacts::forget() noexcept { seen_[0] = std::numeric_limits<double>::quiet_NaN(); }

/// Approach that the displacement of the centre and the forces on all walls add to that of a wall.
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

/// Solves (1 - G dF/dg) x = right-hand sides. The pivots are those of M, because scaling by the roots of dF/dg makes
/// the two matrices one. No pivot has to be searched for, and one that is not positive is beyond the limit.
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

/// True where all stiffnesses vanish together, as at first touch. Callers of move_centre() then substitute equal ones,
/// under which the centre moves as between equal contacts.
bool Contacts::carries_no_load() const noexcept {
  return std::ranges::all_of(stiffness_, [](double stiffness) { return stiffness == 0.0; });
}

/// Displacement of the centre that cancels a net force to first order. Directions that no contact supports stay.
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
  // The matrix is symmetric unless stiffnesses have been lent. Its unsupported directions are the same from both sides.
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

/// Displaces the centre so that a net force vanishes to first order, and updates the approaches.
void Contacts::move_centre(const Eigen::Vector3d& net_force, std::span<double> centre) {
  const std::size_t n = class_count();
  const Eigen::Vector3d step = way_to_balance(net_force);
  for (std::size_t k = 0; k < free_count(); ++k) {
    centre[k] += step[at(k)];
    for (std::size_t j = 0; j < n; ++j) entry(j, n) += entry(j, n + 1 + k) * step[at(k)];
  }
}

/// Projector on the directions in which no contact supports the centre. Removes the direction of the stiffest contact
/// first: beside it, the eigenvalues of the full matrix do not distinguish a contact that has just begun from none.
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

void Contacts::rates(std::span<const Ramp> ramps, std::span<const double> y, std::span<double> dy, double touch,
                     double pull, std::span<const char> touches) {
  const std::size_t n = class_count();
  if (let_go_on(ramps, y, dy, touch, touches)) return;
  evaluate(y);
  forget();
  // Loads of redundant walls are integration errors: two such walls would hold the centre in their corner.
  if (free_count() > 0) sort_near(ramps, y, 2.0 * touch);
  for (std::size_t j = 0; j < n; ++j) {
    if (takes_force(ramps[j]) || (free_count() > 0 && is_redundant_[j])) stiffness_[j] = 0.0;
  }
  set_approach_rates_of_walls(ramps);
  if (!eliminate()) {
    throw DomainError({Limit::applicability, -1, "margin", margin(y)});
  }
  if (free_count() > 0) let_centre_follow(ramps, y, dy, touch, pull, touches);
  for (std::size_t j = 0; j < n; ++j) {
    dy[j] = entry(j, n) / now_[j].approach_slope;
    if (takes_force(ramps[j])) {
      const double by_square = 2.0 * modulus_ * now_[j].contact_radius * now_[j].approach_slope;
      dy[j] = slope_of(ramps[j]) == 0.0 ? 0.0 : slope_of(ramps[j]) / by_square;
    }
  }
}

/// Sets the right-hand sides of the rates: approach rates by walls and prescribed forces before the contacts respond.
void Contacts::set_approach_rates_of_walls(std::span<const Ramp> ramps) {
  const std::size_t n = class_count();
  for (std::size_t j = 0; j < n; ++j) {
    entry(j, n) = takes_force(ramps[j]) ? 0.0 : slope_of(ramps[j]);
    for (std::size_t h = 0; h < n; ++h) {
      if (takes_force(ramps[h])) entry(j, n) += coupling_(at(j), at(h)) * slope_of(ramps[h]);
    }
  }
}

/// Adds the rates of a free centre: forces stay balanced, and touching walls move the centre where no contact supports
/// it.
/// @throws std::domain_error where nothing supports it against prescribed forces
void Contacts::let_centre_follow(std::span<const Ramp> ramps, std::span<const double> y, std::span<double> dy,
                                 double touch, double pull, std::span<const char> touches) {
  const std::size_t n = class_count();
  const bool is_first_touch = carries_no_load();
  for (std::size_t j = 0; is_first_touch && j < n; ++j) {
    const bool is_touching = !takes_force(ramps[j]) && y[j] == 0.0 && entry(j, n) >= 0.0;
    if (is_touching && !is_redundant_[j]) stiffness_[j] = 1.0;
  }
  const Eigen::Vector3d error = error_against_forces(ramps, y, touch);
  Eigen::Vector3d net = Eigen::Vector3d::Zero();
  double pressing = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    const double force_rate = takes_force(ramps[j]) ? slope_of(ramps[j]) : stiffness_[j] * entry(j, n);
    net += weights_[j] * force_rate * arm_of(j);
    // The tolerance is relative to all force rates that walls would cause, and to the forces where no rate is to
    // change.
    pressing += weights_[j] * (std::abs(force_rate) + pull * forces_[j]);
  }
  const auto centre = dy.subspan(n);
  std::ranges::fill(centre, 0.0);
  move_centre(net + error_decay(ramps, pull) * error, centre);
  // Only `pull` times the error counts. A faster decay of the error does not drive a centre that no contact supports.
  const double left = (directions_of_nothing() * (net + pull * error)).norm();
  if (has_redundant_walls()) take_along(ramps, y, touch, touches, dy);
  if (left > k_balance * pressing && !may_be_held(ramps, y, reach_of_support(ramps, y, touch))) {
    throw DomainError(Limit::centre_driven_away);
  }
}

/// Net force on the centre that is integration error. Nonzero only if contacts bear the centre against a prescribed
/// force: they end together with that force only if no error is left.
Eigen::Vector3d Contacts::error_against_forces(std::span<const Ramp> ramps, std::span<const double> y,
                                               double touch) const {
  Eigen::Vector3d error = Eigen::Vector3d::Zero();
  bool is_forced = false;
  for (std::size_t j = 0; j < class_count(); ++j) is_forced = is_forced || (takes_force(ramps[j]) && y[j] > touch);
  for (std::size_t j = 0; is_forced && j < class_count(); ++j) {
    if (!is_redundant_[j]) error += weights_[j] * forces_[j] * arm_of(j);
  }
  return error;
}

/// Decay rate of the error of error_against_forces(), at least `least`. Where a force shrinks, an error of the balance
/// would outlast it and open the contact that bears it.
double Contacts::error_decay(std::span<const Ramp> ramps, double least) const noexcept {
  double decay = least;
  for (std::size_t j = 0; j < class_count(); ++j) {
    const bool is_borne = takes_force(ramps[j]) && forces_[j] > 0.0;
    if (is_borne) decay = std::max(decay, -k_hurry * slope_of(ramps[j]) / forces_[j]);
  }
  return decay;
}

/// Gap up to which walls may bear forces that no contact bears. Touching walls support the centre at once, if they can
/// bear. Where a force ends, walls as near as its contact is deep count, too: errors separate them just before.
double Contacts::reach_of_support(std::span<const Ramp> ramps, std::span<const double> y, double touch) const {
  const Eigen::Matrix3d unheld = unheld_directions();
  double near = touch;
  for (std::size_t j = 0; j < class_count(); ++j) {
    // A force that contacts bear already, or that does not shrink, says nothing about the gaps of walls that may bear
    // others.
    const bool is_shrinking = takes_force(ramps[j]) && slope_of(ramps[j]) < 0.0;
    const bool says_so = is_shrinking && (unheld * arm_of(j)).norm() > k_same_surroundings;
    near = std::max(near, says_so ? y[j] : k_unloaded * y[j]);
  }
  return near;
}

void Contacts::residual(std::span<const Ramp> ramps, double xi, std::span<const double> y, std::span<double> residual) {
  const std::size_t n = class_count();
  evaluate(y);
  for (std::size_t j = 0; j < n; ++j) {
    const Target goal = target(takes_force(ramps[j]), std::lerp(ramps[j].start, ramps[j].end, xi));
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
    if (takes_force(ramps[j])) {
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
