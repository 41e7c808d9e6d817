// What the contacts of the MDR system sum up to: volume balance, power, balance of forces; and Newton's method on them.

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>

#include "elastic/hertz.hpp"
#include "mdr/system.hpp"

namespace monograin::mdr {
namespace {

// Divisions by these would be a good part of what summing up takes.
constexpr double k_per_solid_angle = 0.25 * std::numbers::inv_pi;
constexpr double k_third = 1.0 / 3.0;
constexpr double k_twelfth = 1.0 / 12.0;

constexpr double k_round_off = std::numeric_limits<double>::epsilon();
constexpr int k_newton_limit = 60;
constexpr int k_most_halvings = 40;
// How far, over R0, no contact is to lead the centre at once that is as soft as rounding.
constexpr double k_out_of_bounds = 1.0;
// How many times as long as the last one a step is at most.
constexpr double k_most_growth = 64.0;
// How far, over R0, an equilibrium that does not hold the centre is from where its contacts begin to; and by how much
// farther each look on the way lies.
constexpr double k_nearest_saddle = 1e-13;
constexpr double k_farthest_saddle = 1e-2;
constexpr double k_longer = 1.25;
constexpr int k_most_sections = 40;
// Step of the growing radius after which the next one is rounding, where all that depends on it is smooth.
constexpr double k_last_step = 1e-10;
// Steps that are rounding, where they do not become shorter.
constexpr double k_rounding_step = 1e-12;
// Components of unit vectors that are rounding.
constexpr double k_no_component = 1e-15;

/// Looks between two places for one where a function is above zero, towards where it is largest, by golden sections.
/// @param best  in: a place between them where it is larger than at both; out: the best one found
/// @return the function there
template <class Function>
double look_for_hold(double a, double b, double& best, Function&& function) {
  const double section = 2.0 - std::numbers::phi;
  double largest = function(best);
  for (int k = 0; k < k_most_sections && largest <= 0.0; ++k) {
    const double to = std::abs(b - best) > std::abs(best - a) ? b : a;
    const double trial = best + section * (to - best);
    const double there = function(trial);
    const double worse = there > largest ? best : trial;
    if (there > largest) {
      best = trial;
      largest = there;
    }
    ((worse - best) * (b - a) > 0.0 ? b : a) = worse;
  }
  return largest;
}

// Stiffness over the greatest one that is rounding.
constexpr double k_no_stiffness = 1e-12;

}  // namespace

/// Volume balance, power and force balance of what evaluate() found. Equations (37) and (38) in the form that can be
/// integrated.
void System::sum_up(double xi, double r) {
  const double radius = 1.0 + r;
  if (free_count_ > 0) {
    sums_.by_centre.setZero();
    for (Line& line : lines_) {
      line = {.direction = line.direction, .last_stiffness = line.last_stiffness};
    }
  }
  double virial_of_all = 0.0;
  double virial = 0.0;  // of the members of the growth set
  for (std::size_t i = 0; i < now_.size(); ++i) {
    const double one = counts_[i] * now_[i].contact.force * (1.0 - now_[i].displacement);
    virial_of_all += one;
    if (is_member(branches_[i])) virial += one;
  }
  const double scale = 3.0 * k_per_solid_angle * law_.material.bulk_compliance;
  const double w = scale * virial;
  const double under_root = 1.0 - 4.0 * w;
  const double root = std::sqrt(under_root);
  const double weight = k_per_solid_angle * law_.material.bulk_compliance / root;

  // Sums of their own: what is written to contacts might else be written to those in sums_.
  double power = 0.0;
  double work_of_forces = 0.0;
  double caps = 0.0;
  double overlaps = 0.0;
  double by_time = 0.0;
  double time_scale = 0.0;
  double by_radius = 0.0;
  double of_walls = 0.0;  // part of by_radius
  for (std::size_t i = 0; i < now_.size(); ++i) {
    Instant& now = now_[i];
    const bool is_under_force = is_loaded(i);
    const double speed = ramps_[i].end - ramps_[i].start;
    now.rate_by_time = is_under_force ? 0.0 : speed;
    now.rate_by_growth = 0.0;
    if (is_under_force) set_rates_under_force(i, r);
    if (!branches_[i].touches()) continue;
    const Contact& c = now.contact;
    const double count = counts_[i];
    if (is_under_force) {
      power -= count * now.position * speed;
      work_of_forces += count * prescribed_force(i, xi) * now.position;
    } else if (bears_[i]) {
      power += count * c.force * speed;
    }
    if (free_count_ > 0) push_line(i, r);
    if (!is_member(branches_[i])) continue;
    const double distance = 1.0 - now.displacement;
    caps += count * now.overlap * now.overlap * (3.0 * radius - now.overlap);
    overlaps += count * now.overlap;
    const double cap_rate = 0.25 * now.overlap * (2.0 * radius - now.overlap);
    const double volume_rate = weight * (c.by_overlap * distance - c.force);
    const double by_displacement = count * (volume_rate - cap_rate);
    by_time += by_displacement * now.rate_by_time;
    time_scale += count * (std::abs(volume_rate) + std::abs(cap_rate)) * std::abs(now.rate_by_time);
    by_radius += count * weight * (c.by_overlap + c.by_radius) * distance;
    of_walls += by_displacement * now.rate_by_growth;
    if (free_count_ > 0 && !is_under_force) sums_.by_centre += by_displacement * directions_[i];
  }
  sums_.energy.reset();
  sums_.relative_compression = scale * virial_of_all;
  sums_.under_root = under_root;
  sums_.power = power;
  sums_.force_work = work_of_forces;
  sums_.by_time = by_time;
  sums_.time_scale = time_scale;
  sums_.balance = r * (1.0 + r * (1.0 + k_third * r)) - k_twelfth * caps + 2.0 * k_third * w / (1.0 + root);
  sums_.by_radius_at_rest = by_radius + (radius * radius - 0.5 * radius * overlaps);
  sums_.by_radius = sums_.by_radius_at_rest + of_walls;
  if (free_count_ == 0) return;
  // At first touch all stiffnesses vanish together.
  const bool is_first_touch = std::ranges::all_of(lines_, [](const Line& line) { return line.stiffness == 0.0; });
  sums_.force.setZero();
  sums_.stiffness.setZero();
  for (Line& line : lines_) {
    if (is_first_touch) line.stiffness = line.tangent_stiffness / law_.least_stiffness();
    sums_.force += line.force * line.direction;
    sums_.stiffness += line.stiffness * line.direction * line.direction.transpose();
  }
}

/// What a touching contact does to a free centre along its line.
void System::push_line(std::size_t i, double r) {
  const double count = counts_[i];
  const double stiffness = branches_[i].tangent_stiffness(law_, now_[i].contact);
  const double along = on_lines_[i].along;
  const double speed = ramps_[i].end - ramps_[i].start;
  const Contact& c = now_[i].contact;
  Line& line = lines_[on_lines_[i].line];
  if (!is_slight(i)) {
    line.force += count * c.force * along;
    line.force_by_time += count * (is_loaded(i) ? speed : stiffness * speed) * along;
  }
  if (!is_loaded(i)) {
    double by_radius = c.by_radius;
    if (branches_[i].regime == Regime::unloading && branches_[i].edge.follows() && c.by_overlap < stiffness) {
      // Where a dent begins moves with the radius, however little presses it.
      const Contact pressed = branches_[i].stiff_contact(law_, r, now_[i].overlap, now_[i].contact);
      by_radius = stiffness * (pressed.by_radius / pressed.by_overlap);
    }
    line.force_by_radius += count * (stiffness + by_radius) * along;
    line.stiffness += count * c.by_overlap * along * along;
    line.tangent_stiffness += count * stiffness * along * along;
  }
}

/// Walls that align are on one line, and act on the centre along that only.
void System::find_lines() {
  for (Small& direction : directions_) {
    const double size = direction.norm();
    if (!(size > k_no_direction)) {
      on_lines_.push_back({});
      continue;
    }
    const Small unit = direction / size;
    std::size_t line = 0;
    while (line < lines_.size()) {
      const Small& other = lines_[line].direction;
      if ((unit - std::copysign(1.0, unit.dot(other)) * other).norm() <= k_no_direction) break;
      ++line;
    }
    if (line == lines_.size()) lines_.push_back({.direction = unit});
    const double along = std::copysign(size, unit.dot(lines_[line].direction));
    direction = along * lines_[line].direction;
    on_lines_.push_back({line, along});
  }
  if (lines_.empty()) lines_.emplace_back();  // of those that do not act along any
}

/// Along the line that holds the centre most, across it along the one that does so most there, and so on: in these
/// directions what stiff contacts do is nothing, not rounding, where only soft ones hold it.
System::SmallMatrix System::stiffest_directions(double Line::*stiffness) const {
  SmallMatrix basis = SmallMatrix::Zero();
  for (int k = 0; k < free_count_; ++k) {
    double most = 0.0;
    Small next = Small::Zero();
    for (const Line& line : lines_) {
      const Small across = line.direction - basis * (basis.transpose() * line.direction);
      const double hold = std::abs(line.*stiffness) * across.squaredNorm();
      if (hold <= most || across.norm() <= k_no_direction) continue;
      most = hold;
      next = across;
    }
    if (most == 0.0) break;
    next.normalize();
    basis.col(k) = (next - basis * (basis.transpose() * next)).normalized();
  }
  return basis;
}

/// Of the direction of a line, without rounding.
System::Small System::components(const SmallMatrix& basis, const Line& line) {
  const Small raw = basis.transpose() * line.direction;
  return (raw.array().abs() > k_no_component).select(raw, 0.0);
}

/// Displacement of the centre that changes the net force by `-force`; none along directions that no contact holds.
System::Small System::balance_step(double Line::*stiffness, double Line::*force) const {
  if (lines_.size() == 1) {
    const Line& only = lines_.front();
    return only.*stiffness == 0.0 ? Small::Zero() : Small(-(only.*force) / only.*stiffness * only.direction);
  }
  const SmallMatrix basis = stiffest_directions(stiffness);
  SmallMatrix sum = SmallMatrix::Zero();
  Small push = Small::Zero();
  Small magnitudes = Small::Zero();
  for (const Line& line : lines_) {
    const Small at = components(basis, line);
    sum += line.*stiffness * at * at.transpose();
    push += line.*force * at;
    magnitudes += std::abs(line.*stiffness) * at.cwiseAbs2();
  }
  const Small scale = (magnitudes.array() > 0.0).select(magnitudes.array().rsqrt(), 0.0);
  const Eigen::SelfAdjointEigenSolver<SmallMatrix> solver(scale.asDiagonal() * sum * scale.asDiagonal());
  const double threshold = 1e-12 * solver.eigenvalues().cwiseAbs().maxCoeff();
  Small step = Small::Zero();
  for (int k = 0; k < 3; ++k) {
    if (std::abs(solver.eigenvalues()[k]) <= threshold) continue;
    const Small direction = scale.cwiseProduct(solver.eigenvectors().col(k));
    step -= direction * (direction.dot(push) / solver.eigenvalues()[k]);
  }
  return basis * step;
}

System::Motion System::motion(bool growing) const {
  if (free_count_ == 0) {
    return {.demand = -sums_.by_time,
            .slope = sums_.by_radius,
            .growth = growing ? -sums_.by_time / sums_.by_radius : 0.0,
            .centre = Small::Zero()};
  }
  const Small by_time = balance_step(&Line::tangent_stiffness, &Line::force_by_time);
  const Small by_radius = balance_step(&Line::tangent_stiffness, &Line::force_by_radius);
  Motion result{.demand = -sums_.by_time - sums_.by_centre.dot(by_time),
                .slope = sums_.by_radius + sums_.by_centre.dot(by_radius),
                .growth = 0.0,
                .centre = by_time};
  if (growing) {
    result.growth = result.demand / result.slope;
    result.centre += result.growth * by_radius;
  }
  return result;
}

System::Motion System::growing_motion() const {
  Motion result = motion(true);
  if (!(result.slope > 0.0)) throw DomainError(Limit::free_surface_used_up);
  return result;
}

/// d(delta_o)/dxi of a wall, towards the centre positive.
double System::inward_rate(std::size_t i, const Motion& motion) const noexcept {
  const double carried = is_loaded(i) ? 0.0 : directions_[i].dot(motion.centre);
  return now_[i].rate_by_time + now_[i].rate_by_growth * motion.growth + carried;
}

double System::magnitude_of_forces() const noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < now_.size(); ++i) sum += counts_[i] * std::abs(now_[i].contact.force);
  return sum;
}

/// What is left of forces on the centre that balance, of their own rounding and of that of overlaps: contacts that only
/// touch it are too soft to bear that without going to and fro. Walls under force bear theirs as exactly as they stand.
/// Overlaps are rounded as what they are differences of: lengths of the order of R0, the way that the centre has gone,
/// or that of a wall towards it.
double System::rounding_of_forces() const noexcept {
  double sum = magnitude_of_forces();
  for (std::size_t i = 0; i < now_.size(); ++i) {
    const double length = std::max(longest_, std::abs(now_[i].position));
    sum += counts_[i] * branches_[i].unpeeled_stiffness(law_, evaluated_radius_, now_[i].contact) * length;
  }
  return 4.0 * k_round_off * sum;
}

/// Overlap of a contact that only touches a free centre: rounding of lengths, and what the rounding of others presses
/// it in by, which may bear much more and be much stiffer.
double System::shallow() const noexcept {
  return std::max(k_resolution, elastic_overlap(ElasticProfile::parabola, law_.material.composite_modulus, 1.0,
                                                rounding_of_forces()));
}

/// True if an overlap is below the resolution; cheaper than comparing it with shallow().
bool System::is_shallow(double overlap) const noexcept {
  return overlap < k_resolution || hertz_force(law_.material.composite_modulus, 1.0, overlap) < rounding_of_forces();
}

/// A contact whose edge peels and that has been led beyond pull-off: before it comes there, its stiffness falls without
/// bound, and the centre is held no more.
std::optional<std::size_t> System::contact_beyond_pull_off(double r) {
  for (std::size_t i = 0; i < now_.size(); ++i) {
    if (!branches_[i].edge.peels() || is_loaded(i) || directions_[i].norm() < k_no_direction) continue;
    const Frame at = branches_[i].frame(law_, r, now_[i].overlap);
    if (at.displacement < branches_[i].pull_off(law_, at.indenter).by_displacement.displacement_1d) return i;
  }
  return std::nullopt;
}

/// To the balance of forces at a given radius. On the way there the volume need not be defined: where the radius has
/// grown, walls that the centre gives way to would press it by as much.
void System::move_centre(double xi, std::span<double> y) {
  find_balance(xi, y);
  check_hold();
  keep_evaluation(xi, y);
}

/// Beyond its greatest force a plastic contact that gives way bears less: where several do, one of them may go in while
/// the others unload, and the centre has other places beside the one where all go in.
/// @throws std::domain_error there
void System::check_hold() const {
  const auto softens = [](const Instant& now) { return now.contact.by_overlap < 0.0; };
  if (free_count_ == 0 || weakest_contact() || std::ranges::none_of(now_, softens)) return;
  const Small stiffnesses = Eigen::SelfAdjointEigenSolver<SmallMatrix>(sums_.stiffness).eigenvalues();
  if (stiffnesses.minCoeff() < -k_no_stiffness * stiffnesses.cwiseAbs().maxCoeff()) {
    throw DomainError(Limit::centre_softening);
  }
}

/// Newton on the balance of forces at a given radius; the force grows with the overlap, so damping is all it needs.
void System::find_balance(double xi, std::span<double> y) {
  evaluate_forces(xi, y);
  const bool is_only_one = !weakest_contact();
  double way = std::numeric_limits<double>::infinity();
  double step_size = std::numeric_limits<double>::infinity();
  bool has_gone_back = false;
  for (int iteration = 0; iteration < k_newton_limit; ++iteration) {
    const double error = sums_.force.norm();
    if (error == 0.0) return;
    // Below what is rounding there is nothing to damp: a contact that only touches would stay where it is.
    const double noise = rounding_of_forces();
    Small step = balance_step(&Line::stiffness, &Line::force);
    // Contacts that are shallower than rounding are so soft that their tangents lead out of all bounds.
    if (step.norm() > k_out_of_bounds) step = balance_step(&Line::tangent_stiffness, &Line::force);
    if (step.norm() == 0.0) {
      if (error <= noise) return;
      throw DomainError(Limit::centre_not_held);
    }
    if (step.norm() >= 0.5 * step_size) {
      if (step.norm() < k_rounding_step) return;
      // Soft contacts that are met from afar may be led back to where they only touch by as much, once.
      if (error <= noise && std::exchange(has_gone_back, true)) return;
    }
    step_size = step.norm();
    // Where the last step had to be cut short, as next to a fold, there is no need to begin far beyond that again.
    if (k_most_growth * way < step_size) step *= k_most_growth * way / step_size;
    Small before = Small::Zero();
    for (int k = 0; k < free_count_; ++k) before[k] = y[centre_place(k)];
    for (Line& line : lines_) line.last_stiffness = line.stiffness;
    for (int halving = 0; halving < k_most_halvings; ++halving) {
      for (int k = 0; k < free_count_; ++k) y[centre_place(k)] = before[k] + step[k];
      try {
        evaluate_forces(xi, y);
        if (sums_.force.norm() < std::max(error, noise) || step.norm() < k_round_off) break;
        // Stiff contacts may bear more on a way along which soft ones balance: the way that is left says more. Where an
        // edge peels there are other equilibria, to which that might lead.
        if (is_only_one && balance_step(&Line::last_stiffness, &Line::force).norm() < 0.5 * step_size) break;
      } catch (const std::domain_error&) {
        // A trial may lead out of a branch; a state that is nearer lies in it, or there is none.
        if (step.norm() < k_round_off || halving + 1 == k_most_halvings) throw;
      }
      step *= 0.5;
    }
    way = step.norm();
    if (way < 2.0 * k_round_off) break;
  }
  // Where edges peel, the search may also end beyond a fold, where the force is least.
  const double rounding = rounding_of_forces() + k_no_force * magnitude_of_forces();
  if (is_only_one ? way < 2.0 * k_round_off : sums_.force.norm() <= rounding) return;
  if (std::abs(least_centre_stiffness()) < k_at_fold) throw DomainError(Limit::centre_fold);
  throw DomainError(Limit::no_solution, "the balance of forces on the free centre was not found");
}

/// Next to a fold there is, beside the equilibrium that holds the centre, another one that does not, to which a search
/// from afar may lead, and others beyond pull-off. Between them the contacts hold the centre neither way; the
/// equilibrium sought is about as far beyond that place.
/// @param is_balanced  whether y is such an equilibrium, and not merely where a search has got stuck
/// @return whether it has found the equilibrium sought
bool System::leave_saddle(double xi, std::span<double> y, bool is_balanced) {
  evaluate_cached(xi, y);
  const auto is_sought = [&] { return least_centre_stiffness() >= 0.0 && !contact_beyond_pull_off(y[k_radius]); };
  if (is_balanced && is_sought()) return true;
  const std::optional<std::size_t> beyond = contact_beyond_pull_off(y[k_radius]);
  // Of what each of them would hold: what only touches is no stiffer at first than rounding, but would be pressed on
  // the way.
  const Small weakest = (beyond ? directions_[*beyond] : centre_stiffness().direction).normalized();
  Small saddle = Small::Zero();
  for (int k = 0; k < free_count_; ++k) saddle[k] = y[centre_place(k)];
  const auto go = [&](double way) {
    for (int k = 0; k < free_count_; ++k) y[centre_place(k)] = saddle[k] + way * weakest[k];
    evaluate(xi, y);
  };
  // How firmly the centre is held there, along that direction.
  const auto hold = [&](double way) {
    go(way);
    return contact_beyond_pull_off(y[k_radius]) ? -std::numeric_limits<double>::infinity()
                                                : weakest.dot(sums_.stiffness * weakest);
  };
  std::optional<double> firmest;
  for (const double side : {1.0, -1.0}) {
    try {
      double last = 0.0;
      double way = side * k_nearest_saddle;
      double before = hold(last);
      double now = hold(way);
      while (now <= 0.0 && std::abs(way) < k_farthest_saddle) {
        const double next = k_longer * way;
        const double after = hold(next);
        // Where the centre is held on a short part of the way only, that may lie between.
        if (now > before && now > after) {
          now = look_for_hold(last, next, way, hold);
          if (!firmest) firmest = way;
        }
        if (now > 0.0) break;
        last = std::exchange(way, next);
        before = std::exchange(now, after);
      }
      if (now <= 0.0) continue;
      // From where a search has got stuck, or from beyond pull-off, it may also be farther.
      constexpr std::array<double, 5> k_places{2.0, 1.0, 4.0, 8.0, 16.0};
      for (const double place : std::span(k_places).first(is_balanced && !beyond ? 2 : k_places.size())) {
        try {
          go(place * way);
          move_centre(xi, y);
          evaluate(xi, y);
          if (is_sought()) return true;
        } catch (const std::domain_error&) {
          continue;  // the search leads astray from there
        }
      }
    } catch (const std::domain_error&) {
      continue;  // no branch leads there
    }
  }
  if (!is_balanced) return false;
  // Any balance short of pull-off shows that they hold it no more.
  go(beyond && firmest ? *firmest : 0.0);
  if (beyond && firmest) move_centre(xi, y);
  evaluate(xi, y);
  if (contact_beyond_pull_off(y[k_radius])) throw DomainError(Limit::centre_fold);
  return false;
}

/// Moves the centre towards the balance of forces, as far as the present branches of the contacts lead.
/// @return false where they do not lead anywhere
bool System::approach_balance(double xi, std::span<double> y) {
  evaluate(xi, y);
  Small step = balance_step(&Line::stiffness, &Line::force);
  Small before = Small::Zero();
  for (int k = 0; k < free_count_; ++k) before[k] = y[centre_place(k)];
  for (; step.norm() > k_round_off; step *= 0.5) {
    for (int k = 0; k < free_count_; ++k) y[centre_place(k)] = before[k] + step[k];
    try {
      evaluate(xi, y);
      return true;
    } catch (const std::domain_error&) {
      continue;
    }
  }
  return false;
}

/// Projector on the directions in which no touching contact holds the centre.
System::SmallMatrix System::unheld_directions() {
  for (Line& line : lines_) line.held = 0.0;
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    const double along = on_lines_[i].along;
    if (branches_[i].touches() && !is_loaded(i)) lines_[on_lines_[i].line].held += along * along;
  }
  SmallMatrix unheld = SmallMatrix::Zero();
  for (int k = 0; k < free_count_; ++k) unheld(k, k) = 1.0;
  const SmallMatrix basis = stiffest_directions(&Line::held);
  return unheld - basis * basis.transpose();
}

/// Where nothing holds the centre it stays where it is; and a contact that no others balance bears nothing: what the
/// search for the balance leaves of its force is another one at every instant, and does no work.
void System::hold_centre(std::span<const double> y) {
  if (free_count_ == 0) return;
  for (int k = 0; k < free_count_; ++k) held_centre_[k] = y[centre_place(k)];
  unheld_ = unheld_directions();
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    const bool may_pull = !branches_[i].edge.follows();
    bears_[i] = directions_[i].norm() < k_no_direction || is_supported(i) || (may_pull && is_supported(i, -1.0));
  }
  drop_evaluation();
}

double System::balance_residual(double xi, std::span<const double> y) {
  evaluate(xi, y);
  return is_growing_ ? sums_.balance - frozen_balance_ : 0.0;
}

/// Newton on the volume balance together with the balance of forces.
void System::grow(double xi, std::span<double> y) {
  double below = -std::numeric_limits<double>::infinity();
  double above = std::numeric_limits<double>::infinity();
  double step_size = std::numeric_limits<double>::infinity();
  // Quadratic convergence: below this the next step is rounding, unless square roots are still settling, of the force
  // of what touches a free centre or of an edge next to pull-off.
  const bool peels = std::ranges::any_of(branches_, [](const ContactBranch& memory) { return memory.edge.peels(); });
  const double last_step = free_count_ == 0 && !peels ? k_last_step : 2.0 * k_round_off;
  for (int iteration = 0; iteration < k_newton_limit; ++iteration) {
    move_walls(xi, y);
    evaluate(xi, y);
    double slope = sums_.by_radius;
    double defect = sums_.balance - frozen_balance_;
    Small to_balance = Small::Zero();
    Small by_radius = Small::Zero();
    if (free_count_ > 0) {
      to_balance = balance_step(&Line::stiffness, &Line::force);
      by_radius = balance_step(&Line::tangent_stiffness, &Line::force_by_radius);
      slope += sums_.by_centre.dot(by_radius);
      defect += sums_.by_centre.dot(to_balance);
    }
    if (!(slope > 0.0)) throw DomainError(Limit::free_surface_used_up);
    double step = std::clamp(-defect / slope, -0.1, 0.1);
    // The balance rises with the radius, but has a kink where a wall under force pulls off: a step over that, and one
    // back, may lead to and fro without end. What has been seen on either side bounds the next place.
    if (free_count_ == 0) {
      (defect < 0.0 ? below : above) = y[k_radius];
      const double next = y[k_radius] + step;
      const bool is_bounded = std::isfinite(above - below);
      if (std::abs(step) >= std::max(last_step, k_rounding_step) && is_bounded && (next <= below || next >= above)) {
        step = std::midpoint(below, above) - y[k_radius];
      }
    }
    y[k_radius] += step;
    const Small centre_step = to_balance + step * by_radius;
    for (int k = 0; k < free_count_; ++k) y[centre_place(k)] += centre_step[k];
    const double size = std::max(std::abs(step), centre_step.norm());
    if (size < last_step) return;
    // A centre that soft contacts hold goes to and fro by more than that.
    const bool is_balanced = std::abs(step) < k_rounding_step && sums_.force.norm() <= rounding_of_forces();
    if (size >= 0.5 * step_size && (size < k_rounding_step || is_balanced)) return;
    step_size = size;
  }
  throw DomainError(Limit::free_surface_used_up);
}

}  // namespace monograin::mdr
