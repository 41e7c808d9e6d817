#include "contacts/centre/free_centre.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "system/limit.hpp"

namespace monograin::contacts {
namespace {

constexpr double k_round_off = 4.0 * std::numeric_limits<double>::epsilon();
// A wall that is not farther away than this may be touched and left within an instant.
constexpr double k_near = 1e-5;
// Smallest component of a mean normal that counts: stiffness goes with its square, and is round-off below this.
constexpr double k_no_direction = 1e-6;
// Components of unit vectors that are round-off.
constexpr double k_no_component = 1e-15;
// Stiffness over the greatest one, each scaled by its own contacts, that is round-off.
constexpr double k_no_stiffness = 1e-12;
// Stiffness over the greatest one that is comparable with it.
constexpr double k_comparable = 1e-3;
// Share of the prescribed forces that their balance may leave where nothing bears.
constexpr double k_cancelled = 1e-9;
constexpr int k_most_steps = 200;
// A step is long enough where it takes this much off the slope of the energy along it, and short enough where it does
// not lead as far up again.
constexpr double k_descent = 0.9;
constexpr int k_most_sections = 60;

}  // namespace

FreeCentre::FreeCentre(std::span<const ContactClass> classes)
    : forces_(classes.size()), overlaps_(classes.size()), gone_in_(classes.size()), bears_(classes.size()) {
  const auto count = static_cast<Eigen::Index>(classes.size());
  Eigen::Matrix3Xd means = Eigen::Matrix3Xd::Zero(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const ContactClass& c = classes[static_cast<std::size_t>(i)];
    for (const Eigen::Vector3d& normal : c.normals) means.col(i) += normal / c.multiplicity();
    counts_.push_back(c.multiplicity());
  }
  Eigen::ColPivHouseholderQR<Eigen::Matrix3Xd> qr(means);
  qr.setThreshold(k_no_direction);
  dimension_ = static_cast<int>(qr.rank());
  const Matrix q = qr.householderQ();
  directions_.leftCols(dimension_) = q.leftCols(dimension_);

  for (Eigen::Index i = 0; i < count; ++i) {
    Vector arm = directions_.transpose() * means.col(i);
    OnLine on{};
    if (const double size = arm.norm(); size > k_no_direction) {
      const Vector unit = arm / size;
      while (on.line < lines_.size()) {
        const Vector& other = lines_[on.line].direction;
        if ((unit - std::copysign(1.0, unit.dot(other)) * other).norm() <= k_no_direction) break;
        ++on.line;
      }
      if (on.line == lines_.size()) lines_.push_back({.direction = unit});
      on.along = std::copysign(size, unit.dot(lines_[on.line].direction));
      arm = on.along * lines_[on.line].direction;
    } else {
      arm.setZero();
    }
    arms_.push_back(arm);
    on_lines_.push_back(on);
  }
  to_clear_.reserve(classes.size());
}

/// Forces and stiffnesses of the contacts along their lines.
void FreeCentre::sum_up(const CentreWalls& walls, std::span<const Role> roles, const Vector& c) {
  for (Line& line : lines_) line.force = line.stiffness = 0.0;
  const double distance = c.norm();
  double magnitudes = 0.0;
  prescribed_ = 0.0;
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    forces_[i] = 0.0;
    overlaps_[i] = -std::numeric_limits<double>::infinity();
    if (!acts(i)) continue;
    const double along = on_lines_[i].along;
    Line& line = lines_[on_lines_[i].line];
    if (const auto prescribed = walls.prescribed_force(i)) {
      line.force += counts_[i] * *prescribed * along;
      prescribed_ += counts_[i] * std::abs(*prescribed);
      continue;
    }
    const double undisplaced = walls.overlap(i);
    overlaps_[i] = undisplaced + arms_[i].dot(c);
    if (roles[i] != Role::bearing || !(overlaps_[i] > 0.0)) continue;
    const auto [force, slope] = walls.force(i, overlaps_[i]);
    forces_[i] = force;
    line.force += counts_[i] * force * along;
    line.stiffness += counts_[i] * slope * along * along;
    magnitudes += counts_[i] * (force + slope * std::max({1.0, std::abs(undisplaced), distance}));
  }
  round_off_ = k_round_off * (magnitudes + prescribed_);
}

FreeCentre::Vector FreeCentre::net_force() const noexcept {
  Vector sum = Vector::Zero();
  for (const Line& line : lines_) sum += line.force * line.direction;
  return sum;
}

/// Along the line that is stiffest, across it along the one that is so there, and so on: in these directions the
/// forces of stiff contacts are nothing, not round-off, where only soft ones bear.
FreeCentre::Matrix FreeCentre::stiffest_directions() const {
  Matrix basis = Matrix::Zero();
  for (int k = 0; k < dimension_; ++k) {
    double most = 0.0;
    Vector next = Vector::Zero();
    for (const Line& line : lines_) {
      const Vector across = line.direction - basis * (basis.transpose() * line.direction);
      const double stiffness = line.stiffness * across.squaredNorm();
      if (stiffness <= most || across.norm() <= k_no_direction) continue;
      most = stiffness;
      next = across;
    }
    if (most == 0.0) break;
    next.normalize();
    basis.col(k) = (next - basis * (basis.transpose() * next)).normalized();
  }
  return basis;
}

/// Newton's step towards the balance where contacts of comparable stiffness bear in all directions; none elsewhere.
std::optional<FreeCentre::Vector> FreeCentre::step_of_all(const Vector& net) const {
  Matrix stiffness = Matrix::Zero();
  for (const Line& line : lines_) {
    if (line.stiffness > 0.0) stiffness += (line.stiffness * line.direction) * line.direction.transpose();
  }
  const double largest = stiffness.diagonal().maxCoeff();
  for (int k = dimension_; k < 3; ++k) stiffness(k, k) = largest;
  Matrix inverse;
  double determinant = 0.0;
  bool is_regular = false;
  stiffness.computeInverseAndDetWithCheck(inverse, determinant, is_regular, 0.0);
  // No eigenvalue is less than the determinant over the square of the trace.
  if (!(determinant > k_comparable * largest * largest * largest)) return std::nullopt;
  return -inverse * net;
}

/// Newton's step towards the balance along the directions of a basis.
FreeCentre::Vector FreeCentre::step(const Matrix& basis) const {
  Matrix stiffness = Matrix::Zero();
  Vector force = Vector::Zero();
  Vector magnitudes = Vector::Zero();
  for (const Line& line : lines_) {
    const Vector raw = basis.transpose() * line.direction;
    const Vector at = (raw.array().abs() > k_no_component).select(raw, 0.0);
    stiffness += line.stiffness * at * at.transpose();
    force += line.force * at;
    magnitudes += line.stiffness * at.cwiseAbs2();
  }
  const Vector scale = (magnitudes.array() > 0.0).select(magnitudes.array().rsqrt(), 0.0);
  const Vector load = scale.cwiseProduct(force);
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(scale.asDiagonal() * stiffness * scale.asDiagonal());
  const double least = k_no_stiffness * solver.eigenvalues().cwiseAbs().maxCoeff();
  Vector sum = Vector::Zero();
  for (int k = 0; k < 3; ++k) {
    if (solver.eigenvalues()[k] <= least) continue;
    const Vector direction = solver.eigenvectors().col(k);
    sum -= direction * (direction.dot(load) / solver.eigenvalues()[k]);
  }
  return basis * scale.cwiseProduct(sum);
}

/// Where nothing bears a push it takes the centre to the nearest wall in its path, so far in that this bears it.
FreeCentre::Vector FreeCentre::flight(const CentreWalls& walls, std::span<const Role> roles, const Vector& push,
                                      const Vector& c) const {
  const double size = push.norm();
  const Vector path = -push / size;
  std::optional<std::size_t> nearest;
  double distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    const double approach = arms_[i].dot(path);
    if (roles[i] != Role::bearing || walls.prescribed_force(i) || approach <= k_no_direction) continue;
    const double gap = std::max(0.0, -(walls.overlap(i) + arms_[i].dot(c)));
    if (gap / approach >= distance) continue;
    nearest = i;
    distance = gap / approach;
  }
  if (!nearest) throw DomainError(Limit::centre_driven_away);
  const double approach = arms_[*nearest].dot(path);
  const double overlap = walls.overlap_under(*nearest, size / (counts_[*nearest] * approach));
  return (distance + overlap / approach) * path;
}

/// How much of a step leads to where the energy along it no longer falls. The slope of a convex energy only grows.
double FreeCentre::share_of_step(const CentreWalls& walls, std::span<const Role> roles, const Vector& c,
                                 const Vector& step) {
  const double first = net_force().dot(step);
  const auto slope = [&](double share) {
    sum_up(walls, roles, c + share * step);
    return net_force().dot(step);
  };
  double low = 0.0;
  double high = 1.0;
  double now = slope(high);
  if (now <= -k_descent * first) return high;
  for (int k = 0; k < k_most_sections && std::abs(now) > -k_descent * first; ++k) {
    const double middle = std::midpoint(low, high);
    now = slope(middle);
    (now > 0.0 ? high : low) = middle;
  }
  return low > 0.0 ? low : high;
}

FreeCentre::Vector FreeCentre::balance(const CentreWalls& walls, std::span<const Role> roles, Vector c) {
  double last = std::numeric_limits<double>::infinity();
  for (int k = 0; k < k_most_steps; ++k) {
    sum_up(walls, roles, c);
    const Vector net = net_force();
    // A contact that bears less than is to be balanced is as stiff as under that: at first touch it has no stiffness.
    for (std::size_t i = 0; i < arms_.size(); ++i) {
      if (roles[i] != Role::bearing || !(overlaps_[i] > 0.0) || forces_[i] >= net.norm()) continue;
      const double along = on_lines_[i].along;
      const auto before = walls.force(i, overlaps_[i]).slope;
      const auto under = walls.force(i, walls.overlap_under(i, net.norm())).slope;
      lines_[on_lines_[i].line].stiffness += counts_[i] * std::max(0.0, under - before) * along * along;
    }
    Vector borne = net;
    Vector wanted = Vector::Zero();
    const auto quick = step_of_all(net);
    is_held_ = quick.has_value();
    if (quick) {
      wanted = *quick;
    } else {
      const Matrix basis = stiffest_directions();
      borne = basis * (basis.transpose() * net);
      if (const Vector left = net - borne; left.norm() > std::max(round_off_, k_cancelled * prescribed_)) {
        c += flight(walls, roles, left, c);
        continue;
      }
      wanted = step(basis);
    }
    if (borne.norm() <= round_off_) return c + wanted;
    const double share = share_of_step(walls, roles, c, wanted);
    c += share * wanted;
    // Round-off of the position is all that is left.
    const double size = share * wanted.norm();
    if (size <= k_round_off * std::max(1.0, c.norm()) && size >= 0.5 * last) return c;
    last = size;
  }
  throw DomainError(Limit::no_solution, "the balance of forces on the free centre was not found");
}

/// True if contacts bear in all directions, none of them below resolution, where the last search has ended.
bool FreeCentre::is_held() const noexcept {
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    if (forces_[i] > 0.0 && !(forces_[i] > round_off_ && overlaps_[i] > k_resolution)) return false;
  }
  return is_held_;
}

/// Finds the contacts that bear at the last sums.
/// @param least_overlap  of a contact that does
/// @return basis of the directions in which they do
FreeCentre::Matrix FreeCentre::held_directions(const CentreWalls& walls, double least_overlap) {
  for (Line& line : lines_) line.stiffness = 0.0;
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    const double least_force = least_overlap > 0.0 ? round_off_ : 0.0;
    bears_[i] = forces_[i] > least_force && overlaps_[i] > least_overlap;
    if (!bears_[i]) continue;
    const double along = on_lines_[i].along;
    lines_[on_lines_[i].line].stiffness += counts_[i] * walls.force(i, overlaps_[i]).slope * along * along;
  }
  return stiffest_directions();
}

/// Moves the centre by the least by which none of the walls overlaps.
/// @param along  projector on the directions in which it may move
/// @return false, and c as it was, if there is no such position
bool FreeCentre::clear(std::span<const std::size_t> walls, const Matrix& along, Vector& c) const {
  Vector now = c;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const std::size_t i = walls[k];
    const double overlap = gone_in_[i] + arms_[i].dot(now);
    if (overlap <= k_round_off) continue;
    const Vector path = along * arms_[i];
    const double share = path.squaredNorm();
    if (!(share > k_no_direction * k_no_direction)) return false;
    now = c - path * ((gone_in_[i] + arms_[i].dot(c)) / share);
    if (!clear(walls.first(k), along - path * path.transpose() / share, now)) return false;
  }
  c = now;
  return true;
}

/// Clears the walls that do not bear, but for one.
bool FreeCentre::clear_all_but(std::optional<std::size_t> left_out, const CentreWalls& walls,
                               std::span<const Role> roles, Vector& c) {
  to_clear_.clear();
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    if (!acts(i) || roles[i] == Role::away || walls.prescribed_force(i) || i == left_out) continue;
    gone_in_[i] = walls.overlap(i);
    if (!bears_[i] && across_held(i) > k_no_direction) to_clear_.push_back(i);
  }
  Matrix free = Matrix::Zero();
  free.topLeftCorner(dimension_, dimension_).setIdentity();
  return clear(to_clear_, free - held_directions_ * held_directions_.transpose(), c);
}

/// Component of a mean normal across the directions in which contacts bear.
double FreeCentre::across_held(std::size_t i) const {
  return (arms_[i] - held_directions_ * (held_directions_.transpose() * arms_[i])).norm();
}

/// Moves the centre along directions in which no contact bears to where it was when the mode began, and out of the path
/// of walls that push it.
/// @param left_out  a wall that does not
FreeCentre::Vector FreeCentre::with_loose_directions(const CentreWalls& walls, std::span<const Role> roles,
                                                     const Vector& rest, const Vector& balanced,
                                                     std::optional<std::size_t> left_out) {
  for (const double least_overlap : {k_resolution, 0.0}) {
    held_directions_ = held_directions(walls, least_overlap);
    if (dimension_ == 0 || held_directions_.col(dimension_ - 1).squaredNorm() > 0.0) return balanced;
    Vector c = rest + held_directions_ * (held_directions_.transpose() * (balanced - rest));
    // Walls that leave no room bear, however little.
    if (clear_all_but(left_out, walls, roles, c) || least_overlap == 0.0) return c;
  }
  return balanced;
}

FreeCentre::Vector FreeCentre::equilibrium(const CentreWalls& walls, std::span<const Role> roles, const Vector& rest,
                                           const Vector& guess) {
  const Vector balanced = balance(walls, roles, guess);
  return is_held() ? balanced : with_loose_directions(walls, roles, rest, balanced, std::nullopt);
}

double FreeCentre::unpushed_overlap(std::size_t i, const CentreWalls& walls, std::span<const Role> roles,
                                    const Vector& rest, const Vector& guess) {
  const Vector c = with_loose_directions(walls, roles, rest, balance(walls, roles, guess), i);
  return walls.overlap(i) + arms_[i].dot(c);
}

void FreeCentre::find_roles(const CentreWalls& now, const CentreWalls& then, Vector& c, std::span<Role> roles) {
  const Vector rest = c;
  std::ranges::fill(roles, Role::bearing);
  c = with_loose_directions(then, roles, rest, balance(then, roles, rest), std::nullopt);
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    const bool bears_now = !now.prescribed_force(i) && now.overlap(i) + arms_[i].dot(rest) > k_resolution;
    if (bears_now || bears_[i] || across_held(i) <= k_no_direction) continue;
    const bool is_near = then.prescribed_force(i) || then.overlap(i) + arms_[i].dot(c) > -k_near;
    roles[i] = is_near ? Role::idle : Role::away;
  }
}

FreeCentre::Vector FreeCentre::velocity(const CentreWalls& walls, std::span<const Role> roles,
                                        std::span<const double> rates, const Vector& c) {
  sum_up(walls, roles, c);
  for (Line& line : lines_) line.force = 0.0;
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    if (!acts(i)) continue;
    double rate = 0.0;
    if (walls.prescribed_force(i))
      rate = rates[i];
    else if (forces_[i] > 0.0)
      rate = rates[i] * walls.force(i, overlaps_[i]).slope;
    lines_[on_lines_[i].line].force += counts_[i] * rate * on_lines_[i].along;
  }
  return step(stiffest_directions());
}

}  // namespace monograin::contacts
