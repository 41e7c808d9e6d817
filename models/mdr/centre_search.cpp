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

/// Round-off of the centre's stiffness next to a fold, where it goes with the root of the distance: beyond the fold
/// there is no state, or one in which the contacts hold the centre no more.
double round_off_of(const Particle& p, const CentreStiffness& softest) {
  double softening = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.branch(i).edge.peels() || p.is_loaded(i)) continue;
    const double along = std::abs(p.centre().direction(i).dot(softest.direction));
    const Frame at = p.branch(i).frame(p.law(), p.at().r, p.contact(i).overlap);
    const double of_one = peeling_softening(at, p.law().material.composite_modulus, p.law().surface_energy,
                                            p.contact(i).contact.contact_radius);
    softening += p.count(i) * std::abs(of_one) * along * along * along;
  }
  return std::sqrt(2.0 * softening * softest.direction.norm() * p.force_rounding());
}

/// Newton on the balance of forces at a given radius; the force grows with the overlap, so damping is all it needs.
void find_balance(Particle& p, double xi, std::span<double> y) {
  const int count = p.centre().count();
  p.evaluate_forces(xi, y);
  const bool is_only_one = !weakest_contact(p);
  double path = std::numeric_limits<double>::infinity();
  double step_size = std::numeric_limits<double>::infinity();
  bool has_gone_back = false;
  for (int iteration = 0; iteration < k_newton_limit; ++iteration) {
    const double error = p.centre().force().norm();
    if (error == 0.0) return;
    // Below round-off there is nothing to damp: a contact that only touches would stay where it is.
    const double noise = p.force_rounding();
    CentreVector step = p.centre().step();
    // Contacts below the resolution are so soft that their tangents lead out of all bounds.
    if (step.norm() > k_out_of_bounds) step = p.centre().tangent_step();
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
    if (k_most_growth * path < step_size) step *= k_most_growth * path / step_size;
    const CentreVector before = centre_of(y, count);
    p.centre().keep_stiffness();
    for (int halving = 0; halving < k_most_halvings; ++halving) {
      set_centre(y, count, before + step);
      try {
        p.evaluate_forces(xi, y);
        if (p.centre().force().norm() < std::max(error, noise) || step.norm() < k_round_off) break;
        // Stiff contacts may bear more on a path along which soft ones balance: the step that is left says more. Where
        // an edge peels there are other equilibria, to which that might lead.
        if (is_only_one && p.centre().step_of_kept().norm() < 0.5 * step_size) break;
      } catch (const std::domain_error&) {
        // A trial may lead out of a branch; a state that is nearer lies in it, or there is none.
        if (step.norm() < k_round_off || halving + 1 == k_most_halvings) throw;
      }
      step *= 0.5;
    }
    path = step.norm();
    if (path < 2.0 * k_round_off) break;
  }
  // Where edges peel, the search may also end beyond a fold, where the force is least.
  const double rounding = p.force_rounding() + k_no_force * p.magnitude_of_forces();
  if (is_only_one ? path < 2.0 * k_round_off : p.centre().force().norm() <= rounding) return;
  if (std::abs(centre_stiffness(p).value) < k_at_fold) throw DomainError(Limit::centre_fold);
  throw DomainError(Limit::no_solution, "the balance of forces on the free centre was not found");
}

}  // namespace

std::optional<std::size_t> weakest_contact(const Particle& p) noexcept {
  std::optional<std::size_t> weakest;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.branch(i).edge.peels() || p.is_loaded(i) || !p.centre().acts(i)) continue;
    if (!weakest || p.drive(i).rate() < p.drive(*weakest).rate()) weakest = i;
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
  if (!p.centre().is_free() || weakest_contact(p) || std::ranges::none_of(p.at().contacts, softens)) return;
  const CentreVector stiffnesses = Eigen::SelfAdjointEigenSolver<CentreMatrix>(p.centre().stiffness()).eigenvalues();
  if (stiffnesses.minCoeff() < -k_no_stiffness * stiffnesses.cwiseAbs().maxCoeff()) {
    throw DomainError(Limit::centre_softening);
  }
}

void move_centre(Particle& p, double xi, std::span<double> y) {
  find_balance(p, xi, y);
  check_softening(p);
  p.accept_volume(xi, y);
}

bool leave_saddle(Particle& p, double xi, std::span<double> y, bool is_balanced) {
  const int count = p.centre().count();
  p.evaluated(xi, y);
  const auto is_sought = [&] { return centre_stiffness(p).value >= 0.0 && !contact_beyond_pull_off(p); };
  if (is_balanced && is_sought()) return true;
  const std::optional<std::size_t> beyond = contact_beyond_pull_off(p);
  // The direction counts every contact at what it would hold: an idle one is no stiffer at first than round-off, but
  // would be pressed on the path.
  const CentreVector weakest = (beyond ? p.centre().direction(*beyond) : centre_stiffness(p).direction).normalized();
  const CentreVector saddle = centre_of(y, count);
  const auto go = [&](double distance) {
    set_centre(y, count, saddle + distance * weakest);
    p.evaluate(xi, y);
  };
  // Stiffness of the centre there, along that direction.
  const auto stiffness_at = [&](double distance) {
    go(distance);
    return contact_beyond_pull_off(p) ? -std::numeric_limits<double>::infinity()
                                      : weakest.dot(p.centre().stiffness() * weakest);
  };
  std::optional<double> stiffest;
  for (const double side : {1.0, -1.0}) {
    try {
      double last = 0.0;
      double distance = side * k_nearest_saddle;
      double before = stiffness_at(last);
      double now = stiffness_at(distance);
      while (now <= 0.0 && std::abs(distance) < k_farthest_saddle) {
        const double next = k_longer * distance;
        const double after = stiffness_at(next);
        // Where the centre is held on a short part of the path only, that may lie between.
        if (now > before && now > after) {
          now = search_maximum(last, next, distance, stiffness_at);
          if (!stiffest) stiffest = distance;
        }
        if (now > 0.0) break;
        last = std::exchange(distance, next);
        before = std::exchange(now, after);
      }
      if (now <= 0.0) continue;
      // From where a search has got stuck, or from beyond pull-off, it may also be farther.
      constexpr std::array<double, 5> k_multiples{2.0, 1.0, 4.0, 8.0, 16.0};
      for (const double multiple : std::span(k_multiples).first(is_balanced && !beyond ? 2 : k_multiples.size())) {
        try {
          go(multiple * distance);
          move_centre(p, xi, y);
          p.evaluate(xi, y);
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
  go(beyond && stiffest ? *stiffest : 0.0);
  if (beyond && stiffest) move_centre(p, xi, y);
  p.evaluate(xi, y);
  if (contact_beyond_pull_off(p)) throw DomainError(Limit::centre_fold);
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
