// Contacts that support a free centre, and idle contacts that it leaves.

#include "mdr/support.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "contacts/centre/obstacles.hpp"
#include "contacts/centre/reaction_cone.hpp"
#include "mdr/equilibrium.hpp"
#include "mdr/guards.hpp"
#include "mdr/idle.hpp"
#include "mdr/rates.hpp"
#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {
namespace {

/// Wall of an idle contact: it can push a free centre, but not pull it.
struct IdleWall {
  std::size_t contact = 0;
  double rate = 0.0;  ///< rate of its overlap if no idle wall pushes the centre
};

/// Matrix that scales a displacement of the centre to the size of the overlaps it causes in contacts of these normals.
/// Between nearly opposite walls a displacement is far longer than overlaps. Unconstrained directions become zero.
Eigen::Matrix3d measure_by_overlaps(std::span<const Eigen::Vector3d> normals, std::span<const double> weights) {
  Eigen::Matrix3d held = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < normals.size(); ++k) held += weights[k] * normals[k] * normals[k].transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> directions(held);
  const double least = k_no_stiffness * directions.eigenvalues().maxCoeff();
  const Eigen::Vector3d lengths =
      directions.eigenvalues().unaryExpr([=](double value) { return value > least ? 1.0 / std::sqrt(value) : 0.0; });
  return lengths.asDiagonal() * directions.eigenvectors().transpose();
}

/// Overlaps that a push on the centre causes in contacts of these normals, over the displacement of the centre as
/// measure_by_overlaps() scales it; negative for gaps. Each force is the weight times overlap^(3/2). Newton's method
/// minimises the convex energy.
std::vector<double> overlaps_under_push(const Eigen::Vector3d& push, std::span<const Eigen::Vector3d> normals,
                                        std::vector<double> weights) {
  for (const double most = std::ranges::max(weights); double& weight : weights) weight /= most;
  const Eigen::Matrix3d measure = measure_by_overlaps(normals, weights);
  const Eigen::Vector3d load = (measure * push).normalized();
  std::vector<Eigen::Vector3d> measured;
  for (const Eigen::Vector3d& normal : normals) measured.emplace_back(measure * normal);
  Eigen::Vector3d path = Eigen::Vector3d::Zero();
  const auto energy = [&](const Eigen::Vector3d& at) {
    double sum = load.dot(at);
    for (std::size_t k = 0; k < measured.size(); ++k)
      sum += 0.4 * weights[k] * std::pow(std::max(0.0, measured[k].dot(at)), 2.5);
    return sum;
  };
  for (int iteration = 0; iteration < k_most_newton_steps; ++iteration) {
    Eigen::Vector3d slope = load;
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < measured.size(); ++k) {
      const double root = std::sqrt(std::max(0.0, measured[k].dot(path)));
      slope += weights[k] * root * root * root * measured[k];
      stiffness += 1.5 * weights[k] * root * measured[k] * measured[k].transpose();
    }
    if (slope.norm() < k_no_net_force) break;
    // Without overlaps there is no stiffness; adding the size of the slope keeps the step finite.
    stiffness.diagonal().array() += slope.norm();
    Eigen::Vector3d step = -stiffness.ldlt().solve(slope);
    const double before = energy(path);
    while (energy(path + step) >= before && step.norm() > k_no_net_force * path.norm()) step *= 0.5;
    path += step;
  }
  std::vector<double> overlaps;
  for (const Eigen::Vector3d& normal : measured) overlaps.push_back(normal.dot(path) / path.norm());
  return overlaps;
}

/// Distance of a wall from touching the fresh particle or its dent, in the unit of its guard.
double distance_to_touch(const Particle& p, std::size_t i) {
  const int kind = p.branch(i).regime == Regime::separated ? k_dent_touched : k_made;
  return std::abs(contact_guard(p, kind, i, 0.0, p.contact(i).overlap));
}

/// Event of a wall that meets the fresh particle or its dent.
const char* touch_event(const Particle& p, std::size_t i) {
  return p.branch(i).regime == Regime::separated ? "dent-touched" : "contact-made";
}

/// True if contacts that touch, or are within k_together of it, can balance a push of contact i on the free centre.
bool may_be_supported(const Particle& p, std::size_t i) {
  std::vector<CentreVector> others;
  for (std::size_t j = 0; j < p.size(); ++j) {
    if (j == i || !p.centre().acts(j)) continue;
    if (!p.branch(j).touches() && (p.is_force_controlled(j) || distance_to_touch(p, j) > k_together)) continue;
    others.push_back(p.centre().mean_normal(j).normalized());
  }
  return in_reaction_cone(p.centre().mean_normal(i), others);
}

/// The contact that closes or opens together with contact i: among those within the integration error (k_together) of
/// doing so, the nearest. A contact that the others support does not open.
std::optional<std::size_t> nearest_partner(const Particle& p, std::size_t i, bool is_made) {
  std::optional<std::size_t> next;
  double nearest = k_together;
  for (std::size_t j = 0; j < p.size(); ++j) {
    if (j == i || p.is_force_controlled(j) || !p.centre().acts(j) || p.branch(j).touches() == is_made) continue;
    const double distance =
        is_made ? distance_to_touch(p, j) : std::abs(contact_guard(p, k_lost, j, 0.0, p.contact(j).overlap));
    if (distance > nearest || (!is_made && is_supported(p, j))) continue;
    next = j;
    nearest = distance;
  }
  return next;
}

/// True if prescribed forces press a free centre against idle contacts: the loaded contacts alone cannot balance these
/// forces now, or cannot at the end of the step.
bool idle_contacts_have_to_bear(const Particle& p, double xi) {
  std::vector<CentreVector> bearing;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.branch(i).touches() || p.is_force_controlled(i) || is_idle(p, i) || !p.centre().acts(i)) continue;
    bearing.push_back(p.centre().mean_normal(i).normalized());
    if (!p.branch(i).edge.follows()) bearing.emplace_back(-p.centre().mean_normal(i).normalized());
  }
  const double least = k_no_net_force * largest_prescribed_force(p);
  const auto is_borne = [&](const CentreVector& push) {
    return push.norm() <= least || in_reaction_cone(push, bearing);
  };
  return !is_borne(prescribed_push(p, xi)) || !is_borne(prescribed_push(p, 1.0));
}

/// Velocity that idle walls add to the centre, on top of its velocity without them; none if they block the centre. Sets
/// the rate of each wall's overlap without that addition.
std::optional<CentreVector> velocity_of(Particle& p, std::span<IdleWall> walls, double xi, std::span<const double> y) {
  const std::vector<ContactBranch> before = p.branches();
  for (const IdleWall& wall : walls) p.lose(wall.contact);
  p.evaluate(xi, y);
  const Motion now = p.motion(p.mode.is_growing);
  for (IdleWall& wall : walls) wall.rate = overlap_rate(p, wall.contact, now);
  std::vector<contacts::Obstacle> moving;
  for (const IdleWall& wall : walls) moving.push_back({wall.contact, p.centre().mean_normal(wall.contact), wall.rate});
  const auto enters = [](const contacts::Obstacle& wall, const CentreVector& velocity) {
    return !(wall.overlap(velocity) <= k_zero_guard * (1.0 + velocity.norm()));
  };
  CentreVector velocity = CentreVector::Zero();
  const bool is_free = contacts::project_out_of(moving, unconstrained_directions(p), k_no_direction, enters, velocity);
  p.set_branches(before);
  p.evaluate(xi, y);
  return is_free ? std::optional(velocity) : std::nullopt;
}

/// Loses the idle contacts that the centre leaves when prescribed forces begin to press it. Contacts give way with the
/// force to the 2/3, infinitely fast at first, so the motion of walls is negligible. One energy minimum decides for all
/// contacts together; in the usual search for the balance, contacts about to be lost would still pull.
/// @return whether any contact was lost
bool lose_unpressed(Particle& p, std::span<const IdleWall> walls, double xi, std::vector<bool>& is_left,
                    std::vector<Event>& log) {
  const std::vector<ContactBranch> before = p.branches();
  for (const IdleWall& wall : walls) p.lose(wall.contact);
  const CentreMatrix along = unconstrained_directions(p);
  p.set_branches(before);
  const double least = k_no_net_force * largest_prescribed_force(p);
  const CentreVector push = along * prescribed_push(p, 1.0);
  if (push.norm() <= least) return false;
  // Holds only where forces begin, at the start of a step: after any force, walls may have caught up with the centre.
  if (xi > 0.0 || (along * prescribed_push(p, xi)).norm() > p.force_round_off()) return false;
  std::vector<CentreVector> normals;
  for (const IdleWall& wall : walls) normals.emplace_back(along * p.centre().mean_normal(wall.contact));
  std::vector<CentreVector> units;
  for (const CentreVector& normal : normals) {
    if (normal.norm() > k_no_direction) units.push_back(normal.normalized());
  }
  if (!in_reaction_cone(push, units)) return false;
  std::vector<double> weights;
  for (const IdleWall& wall : walls)
    weights.push_back(p.count(wall.contact) *
                      p.branch(wall.contact).regularized_stiffness(p.law(), p.contact(wall.contact).contact));
  const std::vector<double> overlaps = overlaps_under_push(push, normals, weights);
  bool has_left = false;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const std::size_t i = walls[k].contact;
    if (!(overlaps[k] < -k_no_direction)) continue;
    p.lose(i);
    is_left[i] = true;
    log.push_back({"contact-lost", static_cast<int>(i)});
    has_left = true;
  }
  return has_left;
}

}  // namespace

bool is_supported(const Particle& p, std::size_t i) {
  std::vector<CentreVector> others;
  for (std::size_t j = 0; j < p.size(); ++j) {
    if (j == i || !p.branch(j).touches() || !p.centre().acts(j)) continue;
    others.push_back(p.centre().mean_normal(j).normalized());
    if (!p.branch(j).edge.follows()) others.emplace_back(-p.centre().mean_normal(j).normalized());
  }
  return in_reaction_cone(p.centre().mean_normal(i), others);
}

CentreMatrix unconstrained_directions(Particle& p) {
  return p.centre().unconstrained([&](std::size_t i) { return p.branch(i).touches() && !p.is_force_controlled(i); });
}

CentreVector prescribed_push(const Particle& p, double xi) noexcept {
  CentreVector sum = CentreVector::Zero();
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.is_force_controlled(i) || !p.branch(i).touches()) continue;
    sum += p.count(i) * p.drive(i).value(xi) * p.centre().mean_normal(i);
  }
  return sum;
}

double largest_prescribed_force(const Particle& p) noexcept {
  double largest = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.branch(i).touches() && p.is_force_controlled(i)) largest = std::max(largest, p.count(i) * p.drive(i).size());
  }
  return largest;
}

void check_support(Particle& p) {
  if (!p.centre().is_free()) return;
  const double largest = largest_prescribed_force(p);
  if (largest == 0.0) return;
  const CentreMatrix unconstrained = unconstrained_directions(p);
  const double left =
      std::max((unconstrained * prescribed_push(p, 0.0)).norm(), (unconstrained * prescribed_push(p, 1.0)).norm());
  if (left > std::max(k_no_net_force * largest, p.force_round_off())) throw DomainError(Limit::centre_driven_away);
}

void carry_to_support(Particle& p, double xi, std::span<double> y, std::vector<Event>& log) {
  if (!p.centre().is_free() || xi > 0.0) return;
  move_walls(p, xi, y);
  p.evaluate(xi, y);
  const CentreVector push = prescribed_push(p, 1.0);
  if (push.norm() <= k_no_net_force * largest_prescribed_force(p)) return;
  const double round_off = p.force_round_off();
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.branch(i).touches() && std::abs(p.contact(i).contact.force) > round_off) return;
  }
  std::vector<contacts::Obstacle> walls;
  std::vector<char> touched;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_force_controlled(i) || !p.centre().acts(i)) continue;
    const ContactBranch& branch = p.branch(i);
    walls.push_back(
        {i, p.centre().mean_normal(i), p.contact(i).overlap - branch.touching_overlap(p.law(), p.at().growth)});
    touched.push_back(branch.touches());
  }
  // Overlaps are those at the present position of the centre.
  std::vector<char> touches = touched;
  const auto moved = contacts::carried_to_support(push, walls, touches, CentreVector::Zero());
  if (!moved || touches == touched) return;
  const int count = p.centre().free_directions();
  set_centre(y, count, centre_of(y, count) + *moved);
  p.evaluate(xi, y);
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const std::size_t i = walls[k].index;
    if (touches[k] == touched[k]) continue;
    if (touches[k]) {
      log.push_back({touch_event(p, i), static_cast<int>(i)});
      p.set_branch(i, p.branch(i).made());
    } else {
      log.push_back({"contact-lost", static_cast<int>(i)});
      p.lose(i);
    }
  }
}

void balance_touch(Particle& p, std::size_t i, bool is_made, std::vector<Event>& log) {
  if (!p.centre().acts(i) || p.law().adheres()) return;
  // Walls that cannot balance contact i do not close with it, however near they are.
  if (is_made && !may_be_supported(p, i)) return;
  while (!is_made || !is_supported(p, i)) {
    const std::optional<std::size_t> next = nearest_partner(p, i, is_made);
    if (!next) return;
    log.push_back({is_made ? touch_event(p, *next) : "contact-lost", static_cast<int>(*next)});
    if (is_made) {
      p.set_branch(*next, p.branch(*next).made());
    } else {
      p.lose(*next);
    }
  }
}

bool lose_idle_contacts(Particle& p, double xi, std::span<const double> y, std::vector<bool>& is_left,
                        std::vector<Event>& log) {
  std::vector<IdleWall> walls;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (is_idle(p, i)) walls.push_back({i});
  }
  if (walls.empty()) return false;
  std::vector<IdleWall> unopposed = walls;
  std::erase_if(unopposed, [&](const IdleWall& wall) { return is_supported(p, wall.contact); });
  std::optional<CentreVector> velocity;
  // Under a force that presses the centre against idle contacts, one energy minimum decides which of them it leaves;
  // the velocities below hold only for contacts that stay idle.
  if (idle_contacts_have_to_bear(p, xi)) {
    if (lose_unpressed(p, walls, xi, is_left, log)) return true;
  } else {
    velocity = velocity_of(p, walls, xi, y);
  }
  if (!velocity && !unopposed.empty()) {
    walls = unopposed;
    velocity = velocity_of(p, walls, xi, y);
  }
  if (!velocity) return false;
  // Next to stiff contacts these rates lose digits. A contact that opens more slowly is lost later, by its guard.
  const double least = -k_just_turned * (1.0 + velocity->norm());
  bool has_left = false;
  for (const IdleWall& wall : walls) {
    const std::size_t i = wall.contact;
    if (!(wall.rate + p.centre().mean_normal(i).dot(*velocity) < least)) continue;
    p.lose(i);
    log.push_back({"contact-lost", static_cast<int>(i)});
    has_left = true;
  }
  return has_left;
}

}  // namespace monograin::mdr
