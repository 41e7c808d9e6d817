#include "contacts/centre/free_centre.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::contacts {
namespace {

// A wall whose gap (over R0) is below this may meet the centre early in the mode that begins: it is idle, not away.
constexpr double k_near = 1e-5;
// Determinant of the stiffness, over the cube of its largest diagonal element, above which the stiffnesses in all
// directions are comparable.
constexpr double k_comparable = 1e-3;
// The line search ends where the slope of the energy along the step has at most this share of its initial magnitude.
// The full step is also taken if the energy still falls faster at its end.
constexpr double k_descent = 0.9;

}  // namespace

FreeCentre::FreeCentre(std::span<const ContactClass> classes)
    : lines_(classes, true),
      loads_(lines_.size()),
      forces_(classes.size()),
      overlaps_(classes.size()),
      bears_(classes.size()) {
  for (const ContactClass& c : classes) counts_.push_back(c.multiplicity());
  to_clear_.reserve(classes.size());
}

/// Sums up the forces and stiffnesses of the contacts along their lines, with the centre at c.
void FreeCentre::sum_up(const CentreWalls& walls, std::span<const Role> roles, const Vector& c) {
  std::ranges::fill(loads_, Load{});
  const double distance = c.norm();
  double magnitudes = 0.0;
  prescribed_ = 0.0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    forces_[i] = 0.0;
    overlaps_[i] = -k_infinity;
    if (!acts(i)) continue;
    const double share = lines_.share_on_line(i);
    Load& line = loads_[lines_.line_of(i)];
    if (const auto prescribed = walls.prescribed_force(i)) {
      line.force += counts_[i] * *prescribed * share;
      prescribed_ += counts_[i] * std::abs(*prescribed);
      continue;
    }
    const double undisplaced = walls.overlap(i);
    overlaps_[i] = undisplaced + lines_.mean_normal(i).dot(c);
    if (roles[i] != Role::bearing || !(overlaps_[i] > 0.0)) continue;
    const auto [force, slope] = walls.force(i, overlaps_[i]);
    forces_[i] = force;
    line.force += counts_[i] * force * share;
    line.stiffness += counts_[i] * slope * share * share;
    magnitudes += counts_[i] * (force + slope * std::max({1.0, std::abs(undisplaced), distance}));
  }
  round_off_ = k_round_off * (magnitudes + prescribed_);
}

FreeCentre::Vector FreeCentre::net_force() const noexcept {
  Vector sum = Vector::Zero();
  for (std::size_t line = 0; line < loads_.size(); ++line) sum += loads_[line].force * lines_.line_direction(line);
  return sum;
}

/// Newton's step towards the balance if contacts of comparable stiffness bear in all directions; none otherwise.
std::optional<FreeCentre::Vector> FreeCentre::newton_step_if_held(const Vector& net) const {
  Matrix stiffness = Matrix::Zero();
  for (std::size_t line = 0; line < loads_.size(); ++line) {
    const Vector& direction = lines_.line_direction(line);
    if (loads_[line].stiffness > 0.0) stiffness += (loads_[line].stiffness * direction) * direction.transpose();
  }
  const double largest = stiffness.diagonal().maxCoeff();
  for (int k = free_directions(); k < 3; ++k) stiffness(k, k) = largest;
  Matrix inverse = Matrix::Zero();
  double determinant = 0.0;
  bool is_regular = false;
  stiffness.computeInverseAndDetWithCheck(inverse, determinant, is_regular, 0.0);
  // The determinant over the square of the trace, at most 9 largest^2, bounds the smallest eigenvalue from below.
  if (!(determinant > k_comparable * largest * largest * largest)) return std::nullopt;
  return -inverse * net;
}

/// Newton's step towards the balance along the directions of a basis.
FreeCentre::Vector FreeCentre::step(const Matrix& basis) const {
  return lines_.displacement_that_balances(
      basis, [this](std::size_t line) { return loads_[line].stiffness; },
      [this](std::size_t line) { return loads_[line].force; });
}

FreeCentre::Matrix FreeCentre::stiffest_directions() const {
  return lines_.stiffest_directions([this](std::size_t line) { return loads_[line].stiffness; });
}

/// Displacement of a centre under a push that no contact bears: to the nearest wall in its path, and as far into this
/// wall's contact as bears the push.
/// @throws DomainError if no wall is in the path
FreeCentre::Vector FreeCentre::flight(const CentreWalls& walls, std::span<const Role> roles, const Vector& push,
                                      const Vector& c) const {
  const double size = push.norm();
  const Vector path = -push / size;
  std::optional<std::size_t> nearest;
  double distance = k_infinity;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    const double cosine = lines_.mean_normal(i).dot(path);
    if (roles[i] != Role::bearing || walls.prescribed_force(i) || cosine <= k_no_direction) continue;
    const double gap = std::max(0.0, -(walls.overlap(i) + lines_.mean_normal(i).dot(c)));
    if (gap / cosine >= distance) continue;
    nearest = i;
    distance = gap / cosine;
  }
  if (!nearest) throw DomainError(Limit::centre_driven_away);
  const double cosine = lines_.mean_normal(*nearest).dot(path);
  const double overlap = walls.overlap_under(*nearest, size / (counts_[*nearest] * cosine));
  return (distance + overlap / cosine) * path;
}

/// Share of a step that leads to about the minimum of the energy along it. The energy is convex, so that its slope
/// grows along the step; bisection ends by that slope, where Boost's ends by the interval. The sums are then those of
/// the position reached.
double FreeCentre::share_of_step(const CentreWalls& walls, std::span<const Role> roles, const Vector& c,
                                 const Vector& step) {
  const double first = net_force().dot(step);
  const auto slope = [&](double share) {
    sum_up(walls, roles, c + share * step);
    return net_force().dot(step);
  };
  double now = slope(1.0);
  if (now <= -k_descent * first) return 1.0;
  double low = 0.0;
  double high = 1.0;
  double middle = 1.0;
  for (int k = 0; k < k_most_halvings && std::abs(now) > -k_descent * first; ++k) {
    middle = std::midpoint(low, high);
    now = slope(middle);
    (now > 0.0 ? high : low) = middle;
  }
  return middle;
}

/// Raises the stiffness of contacts that bear less than a force to their stiffness under it: at first touch they have
/// none. Contacts beyond the end of their branch, where the force may be constant, get their secant stiffness.
void FreeCentre::regularize_stiffness(const CentreWalls& walls, std::span<const Role> roles, double force) {
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (roles[i] != Role::bearing || !(overlaps_[i] > 0.0)) continue;
    double& stiffness = loads_[lines_.line_of(i)].stiffness;
    const double share = lines_.share_on_line(i);
    if (forces_[i] < force) {
      const double now = walls.force(i, overlaps_[i]).slope;
      const double under = walls.force(i, walls.overlap_under(i, force)).slope;
      stiffness += counts_[i] * std::max(0.0, under - now) * share * share;
    } else if (stiffness == 0.0) {
      stiffness += counts_[i] * forces_[i] / overlaps_[i] * share * share;
    }
  }
}

/// Position at which forces balance, by Newton's method with line search from c.
/// @throws DomainError if no balance is found, or prescribed forces drive the centre away
FreeCentre::Vector FreeCentre::balance(const CentreWalls& walls, std::span<const Role> roles, Vector c) {
  double last_length = k_infinity;
  sum_up(walls, roles, c);
  for (int k = 0; k < k_most_newton_steps; ++k) {
    const Vector net = net_force();
    regularize_stiffness(walls, roles, net.norm());
    Vector net_along_held = net;
    Vector newton_step = Vector::Zero();
    const auto fast_step = newton_step_if_held(net);
    is_held_ = fast_step.has_value();
    if (fast_step) {
      newton_step = *fast_step;
    } else {
      const Matrix basis = stiffest_directions();
      net_along_held = basis * (basis.transpose() * net);
      if (const Vector net_across = net - net_along_held;
          net_across.norm() > std::max(round_off_, k_no_net_force * prescribed_)) {
        c += flight(walls, roles, net_across, c);
        sum_up(walls, roles, c);
        continue;
      }
      newton_step = step(basis);
    }
    if (net_along_held.norm() <= round_off_) return c + newton_step;
    const double share = share_of_step(walls, roles, c, newton_step);
    c += share * newton_step;
    // Ends when the step is round-off of the position and no longer shrinks.
    const double size = share * newton_step.norm();
    if (size <= k_round_off * std::max(1.0, c.norm()) && size >= 0.5 * last_length) return c;
    last_length = size;
  }
  throw DomainError(Limit::no_solution, "the balance of forces on the free centre was not found");
}

/// True if, at the end of the last search, contacts bear in all directions and none of them is below resolution.
bool FreeCentre::is_held() const noexcept {
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (forces_[i] > 0.0 && !(forces_[i] > round_off_ && overlaps_[i] > k_bearing_overlap)) return false;
  }
  return is_held_;
}

/// Finds the contacts that bear in the last sum_up(). Overwrites the stiffnesses of loads_, as work space.
/// @param least_overlap  overlap above which a contact bears
/// @return basis of the directions in which contacts bear
FreeCentre::Matrix FreeCentre::held_directions(const CentreWalls& walls, double least_overlap) {
  for (Load& line : loads_) line.stiffness = 0.0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    const double least_force = least_overlap > 0.0 ? round_off_ : 0.0;
    bears_[i] = forces_[i] > least_force && overlaps_[i] > least_overlap;
    if (!bears_[i]) continue;
    const double share = lines_.share_on_line(i);
    loads_[lines_.line_of(i)].stiffness += counts_[i] * walls.force(i, overlaps_[i]).slope * share * share;
  }
  return stiffest_directions();
}

/// Moves the centre out of all walls that do not bear, except for one.
/// @return false, with c unchanged, if these walls leave no room
bool FreeCentre::clear_all_but(std::optional<std::size_t> ignored_wall, const CentreWalls& walls,
                               std::span<const Role> roles, Vector& c) {
  to_clear_.clear();
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (!acts(i) || roles[i] == Role::away || walls.prescribed_force(i) || i == ignored_wall) continue;
    if (bears_[i] || !(across_held(i) > k_no_direction)) continue;
    to_clear_.push_back({i, lines_.mean_normal(i), walls.overlap(i)});
  }
  Matrix free = Matrix::Zero();
  free.topLeftCorner(free_directions(), free_directions()).setIdentity();
  const auto overlaps = [](const Obstacle& wall, const Vector& at) { return !(wall.overlap(at) <= k_round_off); };
  return project_out_of(to_clear_, free - held_directions_ * held_directions_.transpose(), k_no_direction, overlaps, c);
}

/// Component of a mean normal across the directions in which contacts bear.
double FreeCentre::across_held(std::size_t i) const {
  return (lines_.mean_normal(i) - held_directions_ * (held_directions_.transpose() * lines_.mean_normal(i))).norm();
}

/// Completes a balanced position along loose directions, in which no contact bears: there the centre stays where the
/// mode began, or moves out of the path of walls that push it.
/// @param balanced  position that balances the forces
/// @param left_out  a wall that does not push
FreeCentre::Vector FreeCentre::with_loose_directions(const CentreWalls& walls, std::span<const Role> roles,
                                                     const Vector& rest, const Vector& balanced,
                                                     std::optional<std::size_t> ignored_wall) {
  for (const double least_overlap : {k_bearing_overlap, 0.0}) {
    held_directions_ = held_directions(walls, least_overlap);
    if (free_directions() == 0 || held_directions_.col(free_directions() - 1).squaredNorm() > 0.0) return balanced;
    Vector c = rest + held_directions_ * (held_directions_.transpose() * (balanced - rest));
    // Walls that leave no room bear, however small their overlap: the second round counts them.
    if (clear_all_but(ignored_wall, walls, roles, c) || least_overlap == 0.0) return c;
  }
  return balanced;
}

FreeCentre::Vector FreeCentre::equilibrium(const CentreWalls& walls, std::span<const Role> roles, const Vector& rest,
                                           const Vector& guess) {
  const Vector balanced = balance(walls, roles, guess);
  return is_held() ? balanced : with_loose_directions(walls, roles, rest, balanced, std::nullopt);
}

double FreeCentre::unpushed_overlap(std::size_t i, const CentreWalls& walls, std::span<const Role> roles,
                                    const Vector& rest, const Vector& c) {
  sum_up(walls, roles, c);
  return walls.overlap(i) + lines_.mean_normal(i).dot(with_loose_directions(walls, roles, rest, c, i));
}

void FreeCentre::find_roles(const CentreWalls& now, const CentreWalls& then, Vector& c, std::span<Role> roles) {
  const Vector rest = c;
  std::ranges::fill(roles, Role::bearing);
  c = with_loose_directions(then, roles, rest, balance(then, roles, rest), std::nullopt);
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    const bool bears_now =
        !now.prescribed_force(i) && now.overlap(i) + lines_.mean_normal(i).dot(rest) > k_bearing_overlap;
    if (bears_now || bears_[i] || across_held(i) <= k_no_direction) continue;
    const bool is_near = then.prescribed_force(i) || then.overlap(i) + lines_.mean_normal(i).dot(c) > -k_near;
    roles[i] = is_near ? Role::idle : Role::away;
  }
}

FreeCentre::Vector FreeCentre::velocity(const CentreWalls& walls, std::span<const Role> roles,
                                        std::span<const double> rates, const Vector& c) {
  sum_up(walls, roles, c);
  for (Load& line : loads_) line.force = 0.0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (!acts(i)) continue;
    double rate = 0.0;
    if (walls.prescribed_force(i))
      rate = rates[i];
    else if (forces_[i] > 0.0)
      rate = rates[i] * walls.force(i, overlaps_[i]).slope;
    loads_[lines_.line_of(i)].force += counts_[i] * rate * lines_.share_on_line(i);
  }
  return step(stiffest_directions());
}

}  // namespace monograin::contacts
