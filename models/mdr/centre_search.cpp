#include "mdr/centre_search.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "mdr/guards.hpp"
#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {
namespace {

// Length of a step, over the accepted part of the last one, at most.
constexpr double k_most_growth = 64.0;
// Trials for the state where contacts begin to hold the centre: nearest and farthest distance from the saddle (over
// R0), and the ratio of one distance to the one before.
constexpr double k_nearest_saddle = 1e-13;
constexpr double k_farthest_saddle = 1e-2;
constexpr double k_longer = 1.25;
// Softenings at a fold are equal if they differ by less than this share of their sum. The place of the centre there is
// accurate to the root of the integration error.
constexpr double k_alike = 1e-2;

/// Searches between a and b for a point where the function is positive, by golden sections towards its maximum. Ends at
/// the first positive value; Boost's brent_find_minima() would go on to the maximum.
/// @param best  in: a point between a and b with a larger value than both; out: the point with the largest value found
/// @return the function value at best
template <class Function>
double search_maximum(double a, double b, double& best, Function&& function) {
  const double section = 2.0 - std::numbers::phi;
  double largest = function(best);
  for (int k = 0; k < k_most_halvings && largest <= 0.0; ++k) {
    const double to = std::abs(b - best) > std::abs(best - a) ? b : a;
    const double trial = best + section * (to - best);
    const double value = function(trial);
    const double worse = value > largest ? best : trial;
    if (value > largest) {
      best = trial;
      largest = value;
    }
    ((worse - best) * (b - a) > 0.0 ? b : a) = worse;
  }
  return largest;
}

/// True for a contact whose peeling edge supports a free centre: its wall is under displacement control, and it acts on
/// the centre.
bool supports_by_peeling(const Particle& p, std::size_t i) {
  return p.branch(i).edge.peels() && !p.is_force_controlled(i) && p.centre().acts(i);
}

/// First contact whose peeling edge is beyond pull-off, if any. Towards pull-off its stiffness falls without bound, so
/// the centre is no longer held even before.
std::optional<std::size_t> contact_beyond_pull_off(const Particle& p) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!supports_by_peeling(p, i)) continue;
    const ContactBranch& branch = p.branch(i);
    const Image at = branch.image(p.law(), p.at().growth, p.contact(i).overlap);
    if (at.displacement_1d < branch.pull_off(p.law(), at.indenter).by_displacement.displacement_1d) return i;
  }
  return std::nullopt;
}

/// Rate at which a peeling contact's share in the stiffness along a direction falls, as the centre moves along that
/// direction. Positive if the displacement opens the contact.
double softening_along(const Particle& p, std::size_t i, const CentreVector& direction) {
  const double along = p.centre().mean_normal(i).dot(direction);
  const Image at = p.branch(i).image(p.law(), p.at().growth, p.contact(i).overlap);
  return -p.count(i) * along * along * along *
         peeling_softening(at, p.law().adhesion(), p.contact(i).contact.contact_radius);
}

/// Round-off of the centre's stiffness next to a fold, where the stiffness goes with the root of the distance from it.
/// Beyond the fold there is no state, or only one in which the contacts do not hold the centre.
double round_off_of(const Particle& p, const CentreStiffness& softest) {
  double softening = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (supports_by_peeling(p, i)) softening += std::abs(softening_along(p, i, softest.direction));
  }
  return std::sqrt(2.0 * softening * softest.direction.norm() * p.force_round_off());
}

/// Orders two contacts that are otherwise equal by their normals, so that the result does not depend on the order of
/// the walls in a scenario.
bool comes_first(const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
  for (Eigen::Index k = 0; k < one.size(); ++k) {
    if (std::abs(one[k] - other[k]) > k_same_direction) return one[k] < other[k];
  }
  return false;
}

/// Damped Newton's method for the balance of forces on the centre at a given radius. Damping suffices where forces grow
/// with the overlap; where edges peel, see leave_saddle().
class BalanceSearch {
 public:
  BalanceSearch(Particle& p, double xi, std::span<double> y)
      : p_(p), xi_(xi), y_(y), count_(p.centre().free_directions()) {
    p_.try_state(xi, y);
    is_only_one_ = !may_peel_off(p);
  }

  /// @throws std::domain_error where no balance is found
  void run() {
    for (int iteration = 0; iteration < k_most_newton_steps && !is_stuck(); ++iteration) {
      error_ = p_.centre().force().norm();
      if (error_ == 0.0) return;
      noise_ = p_.force_round_off();
      const CentreVector step = newton_step();
      if (has_arrived(step.norm())) return;
      step_size_ = step.norm();
      go_along(shortened(step));
    }
    require_balance();
  }

 private:
  /// True if no part of the last step brought the centre nearer to balance.
  [[nodiscard]] bool is_stuck() const noexcept { return path_ < 2.0 * k_epsilon; }

  [[nodiscard]] CentreVector newton_step() const {
    const CentreVector step = p_.centre().step();
    // Contacts below the resolution are so soft that the step may be longer than R0; regularized stiffnesses have a
    // least value.
    return step.norm() > 1.0 ? p_.centre().regularized_step() : step;
  }

  /// True if a Newton step of that length is round-off, so that the search has converged.
  /// @throws std::domain_error for a step of zero while forces do not balance: no contact holds the centre
  [[nodiscard]] bool has_arrived(double length) {
    if (length == 0.0) {
      if (error_ <= noise_) return true;
      throw DomainError(Limit::centre_not_held);
    }
    if (!(length >= 0.5 * step_size_)) return false;
    // A step that is not much shorter than the last one, and below the resolution, is round-off.
    if (length < k_resolution) return true;
    // Soft contacts reached from afar may need one more step of that length, back to where they are idle.
    return error_ <= noise_ && std::exchange(has_gone_back_, true);
  }

  /// Limits a step if the last one had to be cut short, as next to a fold: the full step would be cut short again.
  [[nodiscard]] CentreVector shortened(const CentreVector& step) const {
    if (!(k_most_growth * path_ < step_size_)) return step;
    return step * (k_most_growth * path_ / step_size_);
  }

  /// Line search: halves the step until it leads nearer to balance and stays on the branches of all contacts.
  /// @throws std::domain_error if even the shortest trial leaves a branch
  void go_along(CentreVector step) {
    const CentreVector before = centre_of(y_, count_);
    p_.centre().keep_stiffness();
    for (int halving = 0; halving < k_most_halvings; ++halving) {
      set_centre(y_, count_, before + step);
      try {
        p_.try_state(xi_, y_);
        if (is_nearer(step.norm())) break;
      } catch (const std::domain_error&) {
        if (step.norm() < k_epsilon || halving + 1 == k_most_halvings) throw;
      }
      step *= 0.5;
    }
    path_ = step.norm();
  }

  /// True if a trial at the end of a step of that length is accepted.
  [[nodiscard]] bool is_nearer(double length) const {
    // A net force below round-off needs no damping, which would keep an idle contact from moving.
    if (p_.centre().force().norm() < std::max(error_, noise_) || length < k_epsilon) return true;
    // While soft contacts come to balance, stiff ones may raise the net force: the length of the step that remains is
    // the better measure. With a peeling edge, it might lead to another equilibrium.
    return is_only_one_ && p_.centre().step_with_last_stiffness().norm() < 0.5 * step_size_;
  }

  /// Checks the end of the search. A unique equilibrium is reached to round-off when the search is stuck. Where edges
  /// peel, the search may also end beyond a fold, at a minimum of the net force.
  /// @throws std::domain_error if forces do not balance
  void require_balance() {
    const double round_off = p_.force_round_off() + k_no_net_force * p_.magnitude_of_forces();
    if (is_only_one_ ? is_stuck() : p_.centre().force().norm() <= round_off) return;
    if (std::abs(centre_stiffness(p_).value) < k_at_fold) throw DomainError(Limit::centre_fold);
    throw DomainError(Limit::no_solution, "the balance of forces on the free centre was not found");
  }

  Particle& p_;
  double xi_;
  std::span<double> y_;
  int count_;
  bool is_only_one_ = false;       ///< no edge peels: the equilibrium is unique
  double error_ = 0.0;             ///< net force where the present step begins
  double noise_ = 0.0;             ///< round-off of the net force
  double step_size_ = k_infinity;  ///< length of the last full Newton step
  double path_ = k_infinity;       ///< length of its accepted part
  bool has_gone_back_ = false;
};

}  // namespace

bool may_peel_off(const Particle& p) noexcept {
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (supports_by_peeling(p, i)) return true;
  }
  return false;
}

std::optional<std::size_t> weakest_contact(Particle& p) {
  if (!may_peel_off(p)) return std::nullopt;
  const CentreVector softest = centre_stiffness(p).direction;
  std::vector<double> softenings(p.size(), 0.0);
  double sum = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!supports_by_peeling(p, i)) continue;
    softenings[i] = softening_along(p, i, softest);
    sum += softenings[i];
    size += std::abs(softenings[i]);
  }
  // 0 if contacts on both sides soften alike: the centre may then leave to either side, away from one of those that
  // soften most.
  const double side = std::abs(sum) > k_alike * size ? std::copysign(1.0, sum) : 0.0;
  const auto gives_way_before = [&](std::size_t i, std::size_t j) {
    const double softer =
        side != 0.0 ? side * (softenings[i] - softenings[j]) : std::abs(softenings[i]) - std::abs(softenings[j]);
    if (std::abs(softer) > k_alike * size) return softer > 0.0;
    if (p.drive(i).rate() != p.drive(j).rate()) return p.drive(i).rate() < p.drive(j).rate();
    return comes_first(p.centre().in_space(p.centre().mean_normal(i)), p.centre().in_space(p.centre().mean_normal(j)));
  };
  std::optional<std::size_t> weakest;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (supports_by_peeling(p, i) && (!weakest || gives_way_before(i, *weakest))) weakest = i;
  }
  return weakest;
}

bool is_any_softened(const Particle& p) noexcept {
  constexpr double k_softened_share = 0.1;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const bool is_plastic = p.branch(i).regime == Regime::fully_plastic;
    if (is_plastic && p.contact(i).contact.by_overlap < k_softened_share * p.law().plastic_stiffness()) return true;
  }
  return false;
}

CentreStiffness centre_stiffness(Particle& p) {
  return p.centre().softest([&](std::size_t i, double along) {
    const ContactBranch& branch = p.branch(i);
    if (!branch.touches() || p.is_force_controlled(i)) return std::pair(0.0, 0.0);
    const Contact& now = p.contact(i).contact;
    const double count = p.count(i) * along * along;
    const double present = branch.regularized_stiffness(p.law(), now);
    // The reference is the stiffness without peeling or softening. Equal contacts lose their stiffness together, which
    // would not show relative to the sum of their present stiffnesses.
    const double at_first = branch.regime == Regime::fully_plastic ? p.law().plastic_stiffness() : present;
    return std::pair(count * present,
                     count * std::max(branch.reference_stiffness(p.law(), p.at().growth, now), at_first));
  });
}

double centre_stiffness_guard(Particle& p) {
  const CentreStiffness softest = centre_stiffness(p);
  const double round_off = std::min(round_off_of(p, softest), k_at_fold);
  return softest.value - std::max(k_margin_of_fold, round_off);
}

void check_softening(const Particle& p) {
  const auto softens = [](const Instant& now) { return now.contact.by_overlap < 0.0; };
  if (!p.centre().is_free() || may_peel_off(p) || std::ranges::none_of(p.at().contacts, softens)) return;
  const CentreVector stiffnesses = Eigen::SelfAdjointEigenSolver<CentreMatrix>(p.centre().stiffness()).eigenvalues();
  if (stiffnesses.minCoeff() < -k_no_stiffness * stiffnesses.cwiseAbs().maxCoeff()) {
    throw DomainError(Limit::centre_softening);
  }
}

void move_centre(Particle& p, double xi, std::span<double> y) {
  BalanceSearch(p, xi, y).run();
  check_softening(p);
  p.keep_trial(xi, y);
}

namespace {

/// True if the contacts hold the centre and none is beyond pull-off, as in the stable equilibrium.
bool holds_centre(Particle& p) { return centre_stiffness(p).value >= 0.0 && !contact_beyond_pull_off(p); }

/// Search along a line through a state that does not hold the centre (a saddle), for states where its contacts do.
class SaddleExit {
 public:
  /// @param y            the state, which is evaluated
  /// @param is_balanced  true: the state is an equilibrium; false: a search for the balance got stuck there
  SaddleExit(Particle& p, double xi, std::span<double> y, bool is_balanced)
      : p_(p),
        xi_(xi),
        y_(y),
        is_balanced_(is_balanced),
        saddle_(centre_of(y, p.centre().free_directions())),
        beyond_(contact_beyond_pull_off(p)),
        direction_((beyond_ ? p.centre().mean_normal(*beyond_) : centre_stiffness(p).direction).normalized()) {}

  /// Finds the nearest state on one side of the saddle where the contacts hold the centre.
  /// @param side  1 or -1
  /// @return its signed distance from the saddle (over R0); none within k_farthest_saddle
  /// @throws std::domain_error if the branch of a contact ends before
  [[nodiscard]] std::optional<double> held_distance(double side) {
    double last = 0.0;
    double distance = side * k_nearest_saddle;
    double before = stiffness_at(last);
    double now = stiffness_at(distance);
    while (now <= 0.0 && std::abs(distance) < k_farthest_saddle) {
      const double next = k_longer * distance;
      const double after = stiffness_at(next);
      // The stretch on which the centre is held may be short and lie between two trials.
      if (now > before && now > after) {
        now = search_maximum(last, next, distance, [this](double trial) { return stiffness_at(trial); });
        if (!stiffest_) stiffest_ = distance;
      }
      if (now > 0.0) break;
      last = std::exchange(distance, next);
      before = std::exchange(now, after);
    }
    if (now <= 0.0) return std::nullopt;
    return distance;
  }

  /// Searches for the stable equilibrium, which lies about as far beyond the state where contacts begin to hold the
  /// centre. If a search got stuck or a contact is beyond pull-off, also begins from farther states.
  /// @param held  distance of the state where contacts begin to hold the centre
  /// @return true if y is at the stable equilibrium
  [[nodiscard]] bool finds_equilibrium_beyond(double held) {
    constexpr std::array<double, 5> k_multiples{2.0, 1.0, 4.0, 8.0, 16.0};
    for (const double multiple : std::span(k_multiples).first(is_balanced_ && !beyond_ ? 2 : k_multiples.size())) {
      try {
        go(multiple * held);
        move_centre(p_, xi_, y_);
        p_.evaluate(xi_, y_);
        if (holds_centre(p_)) return true;
      } catch (const std::domain_error&) {
        continue;  // no balance is found from there
      }
    }
    return false;
  }

  /// Goes back to an equilibrium that does not hold the centre. Any one short of pull-off serves: the guard of the
  /// centre's stiffness fires there.
  /// @throws std::domain_error if the equilibrium is beyond pull-off
  void return_to_balance() {
    const bool is_elsewhere = beyond_ && stiffest_;
    go(is_elsewhere ? *stiffest_ : 0.0);
    if (is_elsewhere) move_centre(p_, xi_, y_);
    p_.evaluate(xi_, y_);
    if (contact_beyond_pull_off(p_)) throw DomainError(Limit::centre_fold);
  }

 private:
  void go(double distance) {
    set_centre(y_, p_.centre().free_directions(), saddle_ + distance * direction_);
    p_.evaluate(xi_, y_);
  }

  /// Stiffness of the centre along the line.
  [[nodiscard]] double stiffness_at(double distance) {
    go(distance);
    return contact_beyond_pull_off(p_) ? -k_infinity : direction_.dot(p_.centre().stiffness() * direction_);
  }

  Particle& p_;
  double xi_;
  std::span<double> y_;
  bool is_balanced_;
  CentreVector saddle_;
  std::optional<std::size_t> beyond_;  ///< contact that has been led beyond pull-off
  /// Normal of the contact beyond pull-off, or else the softest direction. The softest direction counts idle contacts
  /// with their least stiffness: their own is round-off, but the line would press them.
  CentreVector direction_;
  std::optional<double> stiffest_;  ///< distance of the first maximum of the stiffness along the line
};

}  // namespace

bool leave_saddle(Particle& p, double xi, std::span<double> y, bool is_balanced) {
  p.at_state(xi, y);
  if (is_balanced && holds_centre(p)) return true;
  SaddleExit line(p, xi, y, is_balanced);
  for (const double side : {1.0, -1.0}) {
    try {
      const std::optional<double> held = line.held_distance(side);
      if (held && line.finds_equilibrium_beyond(*held)) return true;
    } catch (const std::domain_error&) {
      continue;  // the branch of a contact ends on that side
    }
  }
  if (is_balanced) line.return_to_balance();
  return false;
}

bool approach_balance(Particle& p, double xi, std::span<double> y) {
  const int count = p.centre().free_directions();
  p.evaluate(xi, y);
  CentreVector step = p.centre().step();
  const CentreVector before = centre_of(y, count);
  for (; step.norm() > k_epsilon; step *= 0.5) {
    set_centre(y, count, before + step);
    try {
      p.evaluate(xi, y);
      return true;
    } catch (const std::domain_error&) {
      continue;
    }
  }
  return false;
}

}  // namespace monograin::mdr
