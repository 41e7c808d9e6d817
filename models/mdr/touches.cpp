// Touches of a free centre: which walls meet it together, which it leaves, and what holds it.

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mdr/guards.hpp"
#include "mdr/system.hpp"
#include "reaction_cone.hpp"

namespace monograin::mdr {
namespace {

// Share of a push that its balance may leave.
constexpr double k_balanced = 1e-10;
// Of the way on which a push takes a free centre, what counts as away from a wall.
constexpr double k_left_behind = 1e-6;
constexpr int k_most_steps = 200;
// Stiffness, over that of the direction that is held most, of one that no contact holds.
constexpr double k_not_held = 1e-12;

/// What measures the centre's way by the overlaps of contacts of these normals: between walls that are nearly opposite
/// it is far longer than they are. Blind to directions in which no contact holds the centre.
Eigen::Matrix3d measure_by_overlaps(std::span<const Eigen::Vector3d> normals, std::span<const double> weights) {
  Eigen::Matrix3d held = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < normals.size(); ++k) held += weights[k] * normals[k] * normals[k].transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> directions(held);
  const double least = k_not_held * directions.eigenvalues().maxCoeff();
  const Eigen::Vector3d lengths =
      directions.eigenvalues().unaryExpr([=](double value) { return value > least ? 1.0 / std::sqrt(value) : 0.0; });
  return lengths.asDiagonal() * directions.eigenvectors().transpose();
}

/// Overlaps to which contacts of these normals, whose forces go with their overlaps to the 3/2, come under a push, over
/// the way that they take, up to a factor: Newton on the least of a convex energy.
std::vector<double> overlaps_under_push(const Eigen::Vector3d& push, std::span<const Eigen::Vector3d> normals,
                                        std::vector<double> weights) {
  for (const double most = std::ranges::max(weights); double& weight : weights) weight /= most;
  const Eigen::Matrix3d measure = measure_by_overlaps(normals, weights);
  const Eigen::Vector3d load = (measure * push).normalized();
  std::vector<Eigen::Vector3d> measured;
  for (const Eigen::Vector3d& normal : normals) measured.emplace_back(measure * normal);
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  const auto energy = [&](const Eigen::Vector3d& at) {
    double sum = load.dot(at);
    for (std::size_t k = 0; k < measured.size(); ++k)
      sum += 0.4 * weights[k] * std::pow(std::max(0.0, measured[k].dot(at)), 2.5);
    return sum;
  };
  for (int iteration = 0; iteration < k_most_steps; ++iteration) {
    Eigen::Vector3d slope = load;
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < measured.size(); ++k) {
      const double root = std::sqrt(std::max(0.0, measured[k].dot(way)));
      slope += weights[k] * root * root * root * measured[k];
      stiffness += 1.5 * weights[k] * root * measured[k] * measured[k].transpose();
    }
    if (slope.norm() < k_balanced) break;
    // Where nothing is pressed as yet there is no stiffness.
    stiffness.diagonal().array() += slope.norm();
    Eigen::Vector3d step = -stiffness.ldlt().solve(slope);
    const double before = energy(way);
    while (energy(way + step) >= before && step.norm() > k_balanced * way.norm()) step *= 0.5;
    way += step;
  }
  std::vector<double> overlaps;
  for (const Eigen::Vector3d& normal : measured) overlaps.push_back(normal.dot(way) / way.norm());
  return overlaps;
}

}  // namespace

/// Where the centre is free, a contact along its directions is carried by others only: the nearest ones close with it
/// until they balance it, if they can, and those open with it that the rest does not balance.
void System::meet_balanced(std::size_t i, bool is_made, double r, std::vector<Event>& log) {
  if (free_count_ == 0 || directions_[i].norm() < k_no_direction || law_.adheres()) return;
  // Walls that cannot balance it have not met the particle with it, however near they are.
  if (is_made && !may_be_backed(i, r)) return;
  while (!is_made || !is_supported(i)) {
    std::optional<std::size_t> next;
    double nearest = k_together;
    bool next_is_dent = false;
    for (std::size_t j = 0; j < branches_.size(); ++j) {
      if (j == i || is_loaded(j) || directions_[j].norm() < k_no_direction) continue;
      if (branches_[j].touches() == is_made) continue;
      const double distance =
          is_made ? way_to_touch(j, r) : std::abs(contact_guard(k_lost, j, 0.0, now_[j].overlap, r));
      if (distance > nearest || (!is_made && is_supported(j))) continue;
      next = j;
      nearest = distance;
      next_is_dent = branches_[j].regime == Regime::separated;
    }
    if (!next) return;
    if (is_made)
      branches_[*next] = branches_[*next].made();
    else
      branches_[*next] = branches_[*next].lost(now_[*next].displacement);
    log.push_back(
        {is_made ? (next_is_dent ? "dent-touched" : "contact-made") : "contact-lost", static_cast<int>(*next)});
  }
}

/// How far a wall is from touching the fresh particle or its dent.
double System::way_to_touch(std::size_t i, double r) {
  const int kind = branches_[i].regime == Regime::separated ? k_dent_touched : k_made;
  return std::abs(contact_guard(kind, i, 0.0, now_[i].overlap, r));
}

/// Whether contacts that touch, or are about to, can balance a push of one on the free centre.
bool System::may_be_backed(std::size_t i, double r) {
  std::vector<Small> others;
  for (std::size_t j = 0; j < branches_.size(); ++j) {
    if (j == i || directions_[j].norm() < k_no_direction) continue;
    if (!branches_[j].touches() && (is_loaded(j) || way_to_touch(j, r) > k_together)) continue;
    others.push_back(directions_[j].normalized());
  }
  return in_reaction_cone(directions_[i], others);
}

/// True for an idle contact: the wall touches a particle with a free centre and carries no load. Its overlap and the
/// rate of that are round-off; it leaves no dent, and is lost when the gap exceeds the resolution.
bool System::is_idle_contact(std::size_t i) const {
  if (free_count_ == 0 || is_loaded(i) || !(directions_[i].norm() > k_no_direction)) return false;
  const ContactBranch& branch = branches_[i];
  const bool may_be_idle = branch.regime == Regime::elastic ? branch.is_on_primary_branch || !law_.adheres()
                                                            : branch.regime == Regime::unloading && !law_.adheres();
  return may_be_idle && is_shallow(now_[i].overlap - branch.touching_overlap(law_, evaluated_radius_));
}

/// Loses the walls that only touch a free centre and that the others drive it away from faster than they follow: a
/// touch can drive the centre out of its way, but not draw it along, as nothing pulls. Where walls close in on it from
/// opposite sides there is no way out, and they are about to bear, as are those that a force presses it against: then
/// only those are asked that no other contact opposes.
/// @return whether there are any
bool System::leave_behind(double xi, std::span<const double> y, std::vector<Event>& log) {
  std::vector<Drive> drives;
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    if (is_idle_contact(i)) drives.push_back({i});
  }
  if (drives.empty()) return false;
  std::vector<Drive> unopposed = drives;
  std::erase_if(unopposed, [this](const Drive& drive) { return is_supported(drive.contact); });
  std::optional<Small> velocity;
  if (touches_have_to_bear(xi)) {
    if (leave_what_is_not_pressed(drives, xi, log)) return true;
  } else {
    velocity = velocity_of(drives, xi, y);
  }
  if (!velocity && !unopposed.empty()) {
    drives = unopposed;
    velocity = velocity_of(drives, xi, y);
  }
  if (!velocity) return false;
  // Beside stiff contacts these rates have fewer digits; what leaves more slowly is lost when it has gone.
  const double least = -k_at_rest * (1.0 + velocity->norm());
  bool has_left = false;
  for (const Drive& drive : drives) {
    const std::size_t i = drive.contact;
    if (!(drive.rate + directions_[i].dot(*velocity) < least)) continue;
    branches_[i] = branches_[i].lost(now_[i].displacement);
    log.push_back({"contact-lost", static_cast<int>(i)});
    has_left = true;
  }
  return has_left;
}

/// Loses the walls that only touch a free centre and that it leaves where forces begin to press it: contacts give way
/// with the force to the 2/3, beside which walls stand still at first. Which of them will bear cannot be decided one by
/// one, nor where those to be left still pull in the search for the balance.
/// @return whether there are any
bool System::leave_what_is_not_pressed(std::span<const Drive> drives, double xi, std::vector<Event>& log) {
  branches_before_ = branches_;
  for (const Drive& drive : drives)
    branches_[drive.contact] = branches_[drive.contact].lost(now_[drive.contact].displacement);
  const SmallMatrix along = unheld_directions();
  branches_ = branches_before_;
  const double least = k_no_force * largest_prescribed_force();
  const Small push = along * prescribed_push(1.0);
  if (push.norm() <= least) return false;
  // Forces begin with a step: once contacts have given way to one, however small, walls may have caught up.
  if (xi > 0.0 || (along * prescribed_push(xi)).norm() > rounding_of_forces()) return false;
  std::vector<Small> normals;
  for (const Drive& drive : drives) normals.emplace_back(along * directions_[drive.contact]);
  std::vector<Small> units;
  for (const Small& normal : normals) {
    if (normal.norm() > k_no_direction) units.push_back(normal.normalized());
  }
  if (!in_reaction_cone(push, units)) return false;
  std::vector<double> weights;
  for (const Drive& drive : drives)
    weights.push_back(counts_[drive.contact] *
                      branches_[drive.contact].tangent_stiffness(law_, now_[drive.contact].contact));
  const std::vector<double> overlaps = overlaps_under_push(push, normals, weights);
  bool has_left = false;
  for (std::size_t k = 0; k < drives.size(); ++k) {
    const std::size_t i = drives[k].contact;
    if (!(overlaps[k] < -k_left_behind)) continue;
    branches_[i] = branches_[i].lost(now_[i].displacement);
    is_left_[i] = true;
    log.push_back({"contact-lost", static_cast<int>(i)});
    has_left = true;
  }
  return has_left;
}

/// Whether forces press a free centre against walls that only touch it as yet: those that bear already cannot balance
/// them by themselves, now or at the end of the step.
bool System::touches_have_to_bear(double xi) const {
  std::vector<Small> bearing;
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    if (!branches_[i].touches() || is_loaded(i) || is_idle_contact(i) || directions_[i].norm() < k_no_direction)
      continue;
    bearing.push_back(directions_[i].normalized());
    if (!branches_[i].edge.follows()) bearing.emplace_back(-directions_[i].normalized());
  }
  const double least = k_no_force * largest_prescribed_force();
  const auto is_borne = [&](const Small& push) { return push.norm() <= least || in_reaction_cone(push, bearing); };
  return !is_borne(prescribed_push(xi)) || !is_borne(prescribed_push(1.0));
}

/// Sum of the prescribed forces on a free centre.
System::Small System::prescribed_push(double xi) const noexcept {
  Small sum = Small::Zero();
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    if (!is_loaded(i) || !branches_[i].touches()) continue;
    sum += counts_[i] * prescribed_force(i, xi) * directions_[i];
  }
  return sum;
}

/// The largest of them within the step.
double System::largest_prescribed_force() const noexcept {
  double largest = 0.0;
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    if (branches_[i].touches()) largest = std::max(largest, largest_force(i));
  }
  return largest;
}

/// Of a wall and its images within the step; zero where none is prescribed.
double System::largest_force(std::size_t i) const noexcept {
  return is_loaded(i) ? counts_[i] * std::max(std::abs(ramps_[i].start), std::abs(ramps_[i].end)) : 0.0;
}

/// Finds the forces that are rounding beside the others within the step.
void System::find_slight_forces() {
  double largest = 0.0;
  for (std::size_t i = 0; i < branches_.size(); ++i) largest = std::max(largest, largest_force(i));
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    const bool is_free = free_count_ > 0 && directions_[i].norm() > k_no_direction;
    may_be_slight_[i] = is_free && largest_force(i) > 0.0 && largest_force(i) <= k_no_force * largest;
  }
}

/// Whether a force is as small and nothing bears it: a wall that only touches would be left for it, and come back.
bool System::is_slight(std::size_t i) { return may_be_slight_[i] && !is_supported(i); }

/// Velocity of the centre that such walls add to what it has without them, if they leave it a way out; and the rates of
/// their overlaps without it.
std::optional<System::Small> System::velocity_of(std::span<Drive> drives, double xi, std::span<const double> y) {
  branches_before_ = branches_;
  for (const Drive& drive : drives)
    branches_[drive.contact] = branches_[drive.contact].lost(now_[drive.contact].displacement);
  evaluate(xi, y);
  const Motion now = motion(is_growing_);
  for (Drive& drive : drives) drive.rate = overlap_rate(drive.contact, now);
  Small velocity = Small::Zero();
  const bool is_free = drive_out(drives, unheld_directions(), velocity);
  branches_ = branches_before_;
  evaluate(xi, y);
  return is_free ? std::optional(velocity) : std::nullopt;
}

/// Adds to a velocity of the centre the least by which none of the walls goes into the particle. One that the least for
/// those before it lets in keeps up with the centre in the end.
/// @param along  projector on the directions in which nothing else holds the centre
/// @return false, and the velocity as it was, if there is none
bool System::drive_out(std::span<const Drive> drives, const SmallMatrix& along, Small& velocity) const {
  Small now = velocity;
  for (std::size_t k = 0; k < drives.size(); ++k) {
    const Small& normal = directions_[drives[k].contact];
    const double rate = drives[k].rate + normal.dot(now);
    if (rate <= k_touch * (1.0 + now.norm())) continue;
    const Small way = along * normal;
    const double share = way.squaredNorm();
    if (!(share > k_no_direction * k_no_direction)) return false;
    now = velocity - way * ((drives[k].rate + normal.dot(velocity)) / share);
    if (!drive_out(drives.first(k), along - way * way.transpose() / share, now)) return false;
  }
  velocity = now;
  return true;
}

/// Whether the other touching contacts can balance a push of one of them on the free centre, or a pull where the side
/// is -1; those whose edges do not follow pull, too.
bool System::is_supported(std::size_t i, double side) {
  backing_.clear();
  for (std::size_t j = 0; j < branches_.size(); ++j) {
    if (j == i || !branches_[j].touches() || directions_[j].norm() < k_no_direction) continue;
    backing_.push_back(directions_[j].normalized());
    if (!branches_[j].edge.follows()) backing_.emplace_back(-directions_[j].normalized());
  }
  return in_reaction_cone(side * directions_[i], backing_);
}

/// A wall that pushes a particle which nothing holds from the other side has no equilibrium, unless others adhere; nor
/// have forces that do not balance where no wall stands against them.
/// @throws std::domain_error there
void System::check_support() {
  if (free_count_ == 0) return;
  const double least = k_touch * speed_scale();
  for (std::size_t i = 0; !law_.adheres() && i < branches_.size(); ++i) {
    const bool pushes = branches_[i].touches() && !is_loaded(i) && ramps_[i].end - ramps_[i].start > least;
    if (pushes && directions_[i].norm() > k_no_direction && !is_supported(i)) {
      throw DomainError(Limit::centre_not_held,
                        "no contact holds the free centre of the particle against a wall that pushes it");
    }
  }
  const double largest = largest_prescribed_force();
  if (largest == 0.0) return;
  const SmallMatrix unheld = unheld_directions();
  const double left = std::max((unheld * prescribed_push(0.0)).norm(), (unheld * prescribed_push(1.0)).norm());
  if (left > k_no_force * largest) {
    throw DomainError(Limit::centre_driven_away);
  }
}

}  // namespace monograin::mdr
