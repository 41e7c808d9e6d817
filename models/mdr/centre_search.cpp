#include "mdr/centre_search.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "mdr/guards.hpp"
#include "system/limit.hpp"

namespace monograin::mdr {
namespace {

constexpr double k_round_off = std::numeric_limits<double>::epsilon();
constexpr int k_newton_limit = 60;
constexpr int k_most_halvings = 40;
// How far, over R0, no contact is to lead the centre at once that is as soft as round-off.
constexpr double k_out_of_bounds = 1.0;
// How many times as long as the last one a step is at most.
constexpr double k_most_growth = 64.0;
// How far, over R0, an equilibrium that does not hold the centre is from where its contacts begin to; and by how much
// farther each trial lies.
constexpr double k_nearest_saddle = 1e-13;
constexpr double k_farthest_saddle = 1e-2;
constexpr double k_longer = 1.25;
constexpr int k_most_sections = 40;
// Steps that are round-off, where they do not become shorter.
constexpr double k_rounding_step = 1e-12;
// Stiffness over the greatest one that is round-off.
constexpr double k_no_stiffness = 1e-12;
// Contacts whose stiffness falls alike at a fold, over the sum of what falls: it is known to the root of round-off.
constexpr double k_alike = 1e-6;

/// Searches between two points for one where a function is above zero, towards where it is largest, by golden sections.
/// @param best  in: a point between them where it is larger than at both; out: the best one found
/// @return the function value
template <class Function>
double search_maximum(double a, double b, double& best, Function&& function) {
  const double section = 2.0 - std::numbers::phi;
  double largest = function(best);
  for (int k = 0; k < k_most_sections && largest <= 0.0; ++k) {
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

/// A contact whose edge peels and that has been led beyond pull-off: before it comes there, its stiffness falls without
/// bound, and the centre is held no more.
std::optional<std::size_t> contact_beyond_pull_off(const Particle& p) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    const ContactBranch& branch = p.branch(i);
    if (!branch.edge.peels() || p.is_loaded(i) || !p.centre().acts(i)) continue;
    const Frame at = branch.frame(p.law(), p.at().r, p.contact(i).overlap);
    if (at.displacement < branch.pull_off(p.law(), at.indenter).by_displacement.displacement_1d) return i;
  }
  return std::nullopt;
}

/// How much the stiffness of a contact whose edge peels falls, over the displacement of the centre along a direction:
/// of its share in the stiffness along that direction, positive where that displacement opens the contact.
double softening_along(const Particle& p, std::size_t i, const CentreVector& direction) {
  const double along = p.centre().direction(i).dot(direction);
  const Frame at = p.branch(i).frame(p.law(), p.at().r, p.contact(i).overlap);
  return -p.count(i) * along * along * along *
         peeling_softening(at, p.law().material.composite_modulus, p.law().surface_energy,
                           p.contact(i).contact.contact_radius);
}

/// An edge that peels under a wall that the centre does not lead along.
bool peels(const Particle& p, std::size_t i) { return p.branch(i).edge.peels() && !p.is_loaded(i); }

/// Round-off of the centre's stiffness next to a fold, where it goes with the root of the distance: beyond the fold
/// there is no state, or one in which the contacts hold the centre no more.
double round_off_of(const Particle& p, const CentreStiffness& softest) {
  double softening = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (peels(p, i)) softening += std::abs(softening_along(p, i, softest.direction));
  }
  return std::sqrt(2.0 * softening * softest.direction.norm() * p.force_rounding());
}

/// Which of two contacts that nothing else tells apart is the first, by their normals: the order of walls in a file
/// says nothing.
bool comes_first(const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
  for (Eigen::Index k = 0; k < one.size(); ++k) {
    if (std::abs(one[k] - other[k]) > k_alike) return one[k] < other[k];
  }
  return false;
}

/// Newton's method on the balance of forces at a given radius; the force grows with the overlap, so damping is all it
/// needs.
class BalanceSearch {
 public:
  BalanceSearch(Particle& p, double xi, std::span<double> y) : p_(p), xi_(xi), y_(y), count_(p.centre().count()) {
    p_.evaluate_forces(xi, y);
    is_only_one_ = !may_peel_off(p);
  }

  /// @throws std::domain_error where no balance is found
  void run() {
    for (int iteration = 0; iteration < k_newton_limit && !is_stuck(); ++iteration) {
      error_ = p_.centre().force().norm();
      if (error_ == 0.0) return;
      noise_ = p_.force_rounding();
      const CentreVector step = newton_step();
      if (has_arrived(step.norm())) return;
      step_size_ = step.norm();
      go_along(shortened(step));
    }
    require_balance();
  }

 private:
  /// No part of the last step brought the centre nearer to balance.
  [[nodiscard]] bool is_stuck() const noexcept { return path_ < 2.0 * k_round_off; }

  [[nodiscard]] CentreVector newton_step() const {
    const CentreVector step = p_.centre().step();
    // Contacts below the resolution are so soft that their tangents lead out of all bounds.
    return step.norm() > k_out_of_bounds ? p_.centre().tangent_step() : step;
  }

  /// True if a step of that length is round-off.
  /// @throws std::domain_error for no step where forces are not balanced
  [[nodiscard]] bool has_arrived(double length) {
    if (length == 0.0) {
      if (error_ <= noise_) return true;
      throw DomainError(Limit::centre_not_held);
    }
    if (!(length >= 0.5 * step_size_)) return false;
    if (length < k_rounding_step) return true;
    // Soft contacts that are met from afar may be led back to where they only touch by as much, once.
    return error_ <= noise_ && std::exchange(has_gone_back_, true);
  }

  /// Where the last step had to be cut short, as next to a fold, there is no need to begin far beyond that again.
  [[nodiscard]] CentreVector shortened(const CentreVector& step) const {
    if (!(k_most_growth * path_ < step_size_)) return step;
    return step * (k_most_growth * path_ / step_size_);
  }

  /// Line search: halves the step until it leads nearer to balance. A trial may lead out of a branch; a state that is
  /// nearer lies in it, or there is none.
  void go_along(CentreVector step) {
    const CentreVector before = centre_of(y_, count_);
    p_.centre().keep_stiffness();
    for (int halving = 0; halving < k_most_halvings; ++halving) {
      set_centre(y_, count_, before + step);
      try {
        p_.evaluate_forces(xi_, y_);
        if (is_nearer(step.norm())) break;
      } catch (const std::domain_error&) {
        if (step.norm() < k_round_off || halving + 1 == k_most_halvings) throw;
      }
      step *= 0.5;
    }
    path_ = step.norm();
  }

  /// True if a trial at the end of a step of that length is accepted.
  [[nodiscard]] bool is_nearer(double length) const {
    // Below round-off there is nothing to damp: a contact that only touches would stay where it is.
    if (p_.centre().force().norm() < std::max(error_, noise_) || length < k_round_off) return true;
    // Stiff contacts may bear more on a path along which soft ones balance: the step that is left says more. Where an
    // edge peels there are other equilibria, to which that might lead.
    return is_only_one_ && p_.centre().step_of_kept().norm() < 0.5 * step_size_;
  }

  /// Where edges peel, the search may also end beyond a fold, where the force is least.
  void require_balance() {
    const double rounding = p_.force_rounding() + k_no_force * p_.magnitude_of_forces();
    if (is_only_one_ ? is_stuck() : p_.centre().force().norm() <= rounding) return;
    if (std::abs(centre_stiffness(p_).value) < k_at_fold) throw DomainError(Limit::centre_fold);
    throw DomainError(Limit::no_solution, "the balance of forces on the free centre was not found");
  }

  Particle& p_;
  double xi_;
  std::span<double> y_;
  int count_;
  bool is_only_one_ = false;                                    ///< no edge peels: there are no other equilibria
  double error_ = 0.0;                                          ///< net force where the present step begins
  double noise_ = 0.0;                                          ///< round-off of it
  double step_size_ = std::numeric_limits<double>::infinity();  ///< of the last step as Newton's method had it
  double path_ = std::numeric_limits<double>::infinity();       ///< what was gone of it
  bool has_gone_back_ = false;
};

}  // namespace

bool may_peel_off(const Particle& p) noexcept {
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (peels(p, i) && p.centre().acts(i)) return true;
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
    if (!peels(p, i) || !p.centre().acts(i)) continue;
    softenings[i] = softening_along(p, i, softest);
    sum += softenings[i];
    size += std::abs(softenings[i]);
  }
  // The centre may leave to either side where contacts on both are alike.
  const double side = std::abs(sum) > k_alike * size ? std::copysign(1.0, sum) : 0.0;
  const auto gives_way_before = [&](std::size_t i, std::size_t j) {
    const double softer = side * (softenings[i] - softenings[j]);
    if (std::abs(softer) > k_alike * size) return softer > 0.0;
    if (p.drive(i).rate() != p.drive(j).rate()) return p.drive(i).rate() < p.drive(j).rate();
    return comes_first(p.centre().in_space(p.centre().direction(i)), p.centre().in_space(p.centre().direction(j)));
  };
  std::optional<std::size_t> weakest;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!peels(p, i) || !p.centre().acts(i)) continue;
    if (!weakest || gives_way_before(i, *weakest)) weakest = i;
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
    if (!branch.touches() || p.is_loaded(i)) return std::pair(0.0, 0.0);
    const Contact& now = p.contact(i).contact;
    const double count = p.count(i) * along * along;
    const double tangent = branch.tangent_stiffness(p.law(), now);
    // Two contacts that are alike lose their stiffness together where they peel or soften, and with it the sum of what
    // they are.
    const double at_first = branch.regime == Regime::fully_plastic ? p.law().plastic_stiffness() : tangent;
    return std::pair(count * tangent, count * std::max(branch.unpeeled_stiffness(p.law(), p.at().r, now), at_first));
  });
}

double centre_stiffness_guard(Particle& p) {
  const CentreStiffness softest = centre_stiffness(p);
  const double rounding = std::min(round_off_of(p, softest), k_at_fold);
  return softest.value - std::max(k_least_centre_stiffness, rounding);
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
  p.accept_volume(xi, y);
}

namespace {

/// True for the equilibrium that is sought: contacts short of pull-off hold the centre.
bool holds_centre(Particle& p) { return centre_stiffness(p).value >= 0.0 && !contact_beyond_pull_off(p); }

/// Line through a state that does not hold the centre, along which its contacts begin to hold it.
class SaddleExit {
 public:
  /// @param y            the state, which is evaluated
  /// @param is_balanced  whether it is an equilibrium, and not merely where a search has got stuck
  SaddleExit(Particle& p, double xi, std::span<double> y, bool is_balanced)
      : p_(p),
        xi_(xi),
        y_(y),
        is_balanced_(is_balanced),
        saddle_(centre_of(y, p.centre().count())),
        beyond_(contact_beyond_pull_off(p)),
        direction_((beyond_ ? p.centre().direction(*beyond_) : centre_stiffness(p).direction).normalized()) {}

  /// Finds the nearest place on a side where the contacts hold the centre.
  /// @return its distance from the saddle; none if it is farther than a saddle may be
  /// @throws std::domain_error where no branch leads there
  [[nodiscard]] std::optional<double> held_distance(double side) {
    double last = 0.0;
    double distance = side * k_nearest_saddle;
    double before = stiffness_at(last);
    double now = stiffness_at(distance);
    while (now <= 0.0 && std::abs(distance) < k_farthest_saddle) {
      const double next = k_longer * distance;
      const double after = stiffness_at(next);
      // Where the centre is held on a short part of the path only, that may lie between.
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

  /// Searches for the equilibrium from about as far beyond the place where contacts begin to hold the centre; where a
  /// search has got stuck, or a contact is beyond pull-off, also from farther.
  /// @return whether it is found, and y is there
  [[nodiscard]] bool finds_equilibrium_beyond(double held) {
    constexpr std::array<double, 5> k_multiples{2.0, 1.0, 4.0, 8.0, 16.0};
    for (const double multiple : std::span(k_multiples).first(is_balanced_ && !beyond_ ? 2 : k_multiples.size())) {
      try {
        go(multiple * held);
        move_centre(p_, xi_, y_);
        p_.evaluate(xi_, y_);
        if (holds_centre(p_)) return true;
      } catch (const std::domain_error&) {
        continue;  // the search leads astray from there
      }
    }
    return false;
  }

  /// Goes to an equilibrium that does not hold the centre: any one short of pull-off shows that contacts hold it no
  /// more.
  /// @throws std::domain_error where there is none short of pull-off
  void return_to_balance() {
    const bool is_elsewhere = beyond_ && stiffest_;
    go(is_elsewhere ? *stiffest_ : 0.0);
    if (is_elsewhere) move_centre(p_, xi_, y_);
    p_.evaluate(xi_, y_);
    if (contact_beyond_pull_off(p_)) throw DomainError(Limit::centre_fold);
  }

 private:
  void go(double distance) {
    set_centre(y_, p_.centre().count(), saddle_ + distance * direction_);
    p_.evaluate(xi_, y_);
  }

  /// Stiffness of the centre along the line.
  [[nodiscard]] double stiffness_at(double distance) {
    go(distance);
    return contact_beyond_pull_off(p_) ? -std::numeric_limits<double>::infinity()
                                       : direction_.dot(p_.centre().stiffness() * direction_);
  }

  Particle& p_;
  double xi_;
  std::span<double> y_;
  bool is_balanced_;
  CentreVector saddle_;
  std::optional<std::size_t> beyond_;  ///< contact that has been led beyond pull-off
  /// The softest one. It counts every contact at what it would hold: an idle one is no stiffer at first than round-off,
  /// but would be pressed on the path.
  CentreVector direction_;
  std::optional<double> stiffest_;  ///< distance of the first maximum of the stiffness
};

}  // namespace

bool leave_saddle(Particle& p, double xi, std::span<double> y, bool is_balanced) {
  p.evaluated(xi, y);
  if (is_balanced && holds_centre(p)) return true;
  SaddleExit line(p, xi, y, is_balanced);
  for (const double side : {1.0, -1.0}) {
    try {
      const std::optional<double> held = line.held_distance(side);
      if (held && line.finds_equilibrium_beyond(*held)) return true;
    } catch (const std::domain_error&) {
      continue;  // no branch leads there
    }
  }
  if (is_balanced) line.return_to_balance();
  return false;
}

bool approach_balance(Particle& p, double xi, std::span<double> y) {
  const int count = p.centre().count();
  p.evaluate(xi, y);
  CentreVector step = p.centre().step();
  const CentreVector before = centre_of(y, count);
  for (; step.norm() > k_round_off; step *= 0.5) {
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
