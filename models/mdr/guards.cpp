#include "mdr/guards.hpp"

#include <algorithm>
#include <cmath>

#include "mdr/centre_search.hpp"
#include "mdr/idle.hpp"
#include "mdr/rates.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {
namespace {

// Round-off of an overlap: a program that returns exactly to the old maximum does not pass it.
constexpr double k_same_overlap = 2e-15;
// The square root in the volume ends at 1 - 4w = 0. The guard fires this much before, so that difference quotients of
// implicit integrators do not reach beyond.
constexpr double k_least_volume = 1e-6;

/// True if the overlaps, and with them forces, caps and volume, all grow or all shrink over the rest of the step.
bool goes_one_way(const Particle& p, const Motion& now) {
  if (p.mode.is_growing || p.centre().is_free()) return false;
  bool goes_in = false;
  bool goes_out = false;
  for (std::size_t i = 0; i < p.size(); ++i) {
    // The compression goes with force times lever, F (1 - delta_o). With a force in proportion to the overlap
    // delta_o + growth, that rises as long as 2 delta_o < 1 - growth.
    if (p.is_force_controlled(i) || 2.0 * std::max(p.drive(i).start(), p.drive(i).end()) > 1.0 - p.at().growth)
      return false;
    const double rate = overlap_rate(p, i, now);
    goes_in = goes_in || rate > 0.0;
    goes_out = goes_out || rate < 0.0;
  }
  return !(goes_in && goes_out);
}

}  // namespace

double contact_guard(const Particle& p, int kind, std::size_t i, double xi, double overlap) {
  // Under force a contact lasts as long as the force presses; a program that returns exactly to zero does not open it.
  if (p.is_force_controlled(i) && (kind == k_made || kind == k_dent_touched || kind == k_lost)) {
    const double scale = p.drive(i).size();
    return scale > 0.0 ? p.drive(i).value(xi) / scale + (kind == k_lost ? k_same_overlap : 0.0) : 0.0;
  }
  const double growth = p.at().growth;
  const ContactBranch& branch = p.branch(i);
  switch (kind) {
    case k_yield:
      // The round-off of other forces may press an idle contact to its yield overlap.
      return branch.yield_guard(p.law(), growth, overlap, is_idle(p, i) ? resolution(p) : 0.0);
    case k_reload:
      return overlap - branch.largest_overlap(p.law(), growth) - k_same_overlap;
    case k_lost:
      return branch.opening_guard(p.law(), growth, is_idle(p, i) ? overlap + resolution(p) : overlap);
    case k_dent_touched:
      return branch.opening_guard(p.law(), growth, overlap);
  }
  // k_made: with a free centre the guard is negative at a touch. Otherwise a wall that the centre leaves and meets
  // again at once would not cross zero.
  return p.centre().is_free() ? overlap - k_same_overlap : overlap;
}

double edge_guard(const Particle& p, int kind, std::size_t i, double xi, double overlap) {
  const ContactBranch& branch = p.branch(i);
  const Image now = branch.image(p.law(), p.at().growth, overlap);
  if (kind == k_pull_off) {
    const PullOff& limits = branch.pull_off(p.law(), now.indenter);
    return p.is_force_controlled(i) ? pull_off_guard(limits, p.drive(i).value(xi)) : pull_off_guard(limits, now);
  }
  // An edge of zero radius has no springs: the sign of the prescribed force decides whether it follows or peels.
  if (branch.edge.radius == 0.0 && p.is_force_controlled(i)) {
    return contact_guard(p, kind == k_peel ? k_lost : k_made, i, xi, overlap);
  }
  return kind == k_peel ? peel_guard(branch.edge, now, p.law().adhesion())
                        : follow_guard(branch.edge, now, p.law().adhesion());
}

double edge_round_off(const Particle& p, std::size_t i) {
  const Image at = p.branch(i).image(p.law(), p.at().growth, p.contact(i).overlap);
  return k_same_overlap + profile_round_off(at.indenter, p.branch(i).edge.radius) / at.by_overlap;
}

void GuardSet::arm(Particle& p, ContactCaps& caps, double xi, std::span<const double> y) {
  list_.clear();
  p.at_state(xi, y);
  const Motion now = p.motion(p.mode.is_growing);
  for (std::size_t i = 0; i < p.size(); ++i) arm_contact(p, i, now);
  const auto is_plastic = [](const ContactBranch& branch) { return branch.regime == Regime::fully_plastic; };
  if (may_peel_off(p)) {
    list_.push_back({.kind = k_unstable, .index = -1, .direction = -1, .name = "pull-off", .is_branch_end = true});
  } else if (p.centre().is_free() && std::ranges::any_of(p.branches(), is_plastic)) {
    list_.push_back({.kind = k_softened, .index = -1, .direction = -1, .name = "limit", .is_branch_end = true});
  }
  arm_growth(p, now);
  caps.set_angles(p);
  caps.set_largest_angles(p);
  has_cap_guards_ = false;
  for (std::size_t k = 0; k < caps.pairs().size(); ++k) {
    // Caps that have just met may be a round-off short of zero, and would meet again at once.
    const bool may_meet = !caps.pairs()[k].have_met && caps.both_touch(p, k) && caps.may_meet(k);
    if (may_meet && caps.guard(k) < -k_zero_guard) {
      list_.push_back({k_caps, static_cast<int>(k), 1, "caps-intersect"});
      has_cap_guards_ = true;
    }
  }
  if (p.law().material.linear_compressibility > 0.0) list_.push_back({k_volume, -1, -1, "volume-limit"});
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_force_controlled(i) || 1.0 - p.drive(i).end() < 2.0 * contacts::k_least_distance || p.centre().is_free()) {
      list_.push_back({k_centre_reached, static_cast<int>(i), -1, "limit"});
    }
  }
  if (goes_one_way(p, now)) {
    for (Guard& guard : list_) guard.is_monotone = guard.kind != k_growth_on;
  }
}

void GuardSet::arm_growth(const Particle& p, const Motion& now) {
  if (p.mode.is_growing) {
    list_.push_back({k_growth_off, -1, -1, "growth-off"});
    list_.push_back({k_singular, -1, -1, "singular-growth"});
    // Without force-controlled walls this guard equals k_singular.
    if (p.setup().takes_forces) list_.push_back({k_covered, -1, -1, "singular-growth"});
  } else if (gate_is_open(p, now)) {
    list_.push_back({k_growth_on, -1, 1, "growth-on"});
    // The share of a contact in the demand for growth may change sign just before the contact is lost.
    for (Guard& guard : list_) guard.is_branch_end = guard.is_branch_end || guard.kind == k_lost;
  }
}

GuardSet::Course GuardSet::course_of(const Particle& p, std::size_t i, const Motion& now) {
  const double rate = overlap_rate(p, i, now);
  const bool is_free = !p.is_force_controlled(i) && p.centre().acts(i);
  const bool may_turn = p.mode.is_growing || is_free;
  return {.is_free = is_free,
          .may_turn = may_turn,
          .may_come_in = rate > 0.0 || may_turn,
          .may_go_out = rate < 0.0 || may_turn};
}

/// Lists a guard, unless it depends on a linear overlap or a prescribed force that does not reach it in this step.
void GuardSet::add_if_reached(const Particle& p, std::size_t i, const Course& course, int kind, int direction,
                              std::string_view name) {
  const bool is_linear = !course.may_turn && !p.is_force_controlled(i);  // overlap linear in xi, radius held
  const bool is_by_force = p.is_force_controlled(i) && (kind == k_made || kind == k_dent_touched || kind == k_lost);
  const double last_overlap = p.drive(i).end() + p.at().growth;
  const bool is_known = is_linear || is_by_force;
  if (is_known && direction * contact_guard(p, kind, i, 1.0, last_overlap) < -k_together) return;
  list_.push_back({kind, static_cast<int>(i), direction, name});
}

void GuardSet::arm_contact(const Particle& p, std::size_t i, const Motion& now) {
  const ContactBranch& branch = p.branch(i);
  const Course course = course_of(p, i, now);
  if (!branch.touches()) return arm_touch(p, i, course);
  if (branch.regime == Regime::elastic && course.may_come_in && branch.may_yield(p.law())) {
    add_if_reached(p, i, course, k_yield, 1, "yield");
  }
  if (has_greatest_force(p, i)) {
    list_.push_back({.kind = k_greatest_force,
                     .index = static_cast<int>(i),
                     .direction = -1,
                     .name = "limit",
                     .is_branch_end = true});
  }
  if (branch.is_on_primary_branch) return arm_primary_branch(p, i, now, course);
  if (course.may_come_in) add_if_reached(p, i, course, k_reload, 1, "reload");
  if (p.law().adheres()) {
    arm_edge(p, i, course);
    arm_tension(p, i, now, course);
  } else if (course.may_go_out) {
    add_if_reached(p, i, course, k_lost, -1, "contact-lost");
  }
}

/// Lists the guard of an open contact, which may touch the fresh surface or its dent.
void GuardSet::arm_touch(const Particle& p, std::size_t i, const Course& course) {
  if (!course.may_come_in) return;
  const bool is_dent = p.branch(i).regime == Regime::separated;
  add_if_reached(p, i, course, is_dent ? k_dent_touched : k_made, 1, is_dent ? "dent-touched" : "contact-made");
}

/// Lists the guards of a contact on the primary loading branch: it may turn back, or a free centre may leave it.
void GuardSet::arm_primary_branch(const Particle& p, std::size_t i, const Motion& now, const Course& course) {
  const int index = static_cast<int>(i);
  const bool is_shifted = p.law().is_shifted();
  const bool wall_retreats = p.is_force_controlled(i) || (wall_rate(p, i, now) < 0.0 && !is_shifted);
  const bool may_retreat = course.is_free || (course.may_turn && wall_retreats);
  if (may_retreat) list_.push_back({k_retreat, index, -1, "retreat"});
  const bool is_elastic = p.branch(i).regime == Regime::elastic;
  if (course.is_free && is_elastic) list_.push_back({k_lost, index, -1, "contact-lost"});
}

void GuardSet::arm_edge(const Particle& p, std::size_t i, const Course& course) {
  const ContactBranch& branch = p.branch(i);
  const int index = static_cast<int>(i);
  switch (branch.edge.motion) {
    case Edge::following:
      if (course.may_turn) list_.push_back({k_turn, index, -1, "stick"});
      break;
    case Edge::sticking: {
      // If the overlap cannot turn, an edge that has stuck since the largest overlap follows again with the reload.
      const double at_largest = edge_guard(p, k_follow, i, 0.0, branch.largest_overlap(p.law(), p.at().growth));
      if (course.may_come_in && (course.may_turn || at_largest > k_together))
        list_.push_back({k_follow, index, 1, "follow"});
      if (course.may_go_out) list_.push_back({k_peel, index, -1, "peel"});
      break;
    }
    case Edge::peeling:
      if (course.may_go_out) {
        list_.push_back(
            {.kind = k_pull_off, .index = index, .direction = -1, .name = "pull-off", .is_branch_end = true});
      }
      if (course.may_turn) list_.push_back({k_turn, index, 1, "stick"});
      break;
  }
}

/// Lists the guards of the next extremum of a tensile force: greatest and least force alternate. A prescribed force has
/// no extremum within a step, nor has the force of a sticking edge where only its own wall moves.
void GuardSet::arm_tension(const Particle& p, std::size_t i, const Motion& now, const Course& course) {
  const bool peels_alone = p.branch(i).edge.peels() && course.may_go_out;
  if (p.branch(i).edge.follows() || p.is_force_controlled(i) || !(course.may_turn || peels_alone)) return;
  const auto add = [&](int kind, int direction) {
    list_.push_back({.kind = kind,
                     .index = static_cast<int>(i),
                     .direction = direction,
                     .name = "force-extremum",
                     .is_mark = true});
  };
  const bool is_tensile = p.contact(i).contact.force < 0.0;
  const double rate = force_rate(p, i, now);
  if (!is_tensile || rate < -0.5 * k_at_rest) return add(k_greatest_tension, 1);
  if (!course.may_turn) return;
  if (rate > 0.5 * k_at_rest) return add(k_least_tension, -1);
  // A force at rest passes no extremum when it begins to change: these two guards only show which one comes next.
  add(k_tension_falls, 1);
  add(k_tension_rises, -1);
}

namespace {

/// Guard of an extremum of a force; it does not fire because a contact no longer pulls.
double tension_guard(const Particle& p, int kind, std::size_t i, const Motion& now) {
  const double rate = force_rate(p, i, now);
  const bool pulls = p.contact(i).contact.force < 0.0;
  switch (kind) {
    case k_greatest_tension:
      return (pulls ? rate : -std::abs(rate)) - k_at_rest;
    case k_least_tension:
      return (pulls ? rate : std::abs(rate)) + k_at_rest;
    case k_tension_falls:
      return rate - k_at_rest;
  }
  return rate + k_at_rest;  // k_tension_rises
}

double retreat_guard(Particle& p, std::size_t i, double xi, std::span<const double> y, const Motion& now) {
  if (p.mode.loads_on[i]) return rate_if_unloaded(p, i, xi, y);
  // The rate of an idle contact next to a moving centre is round-off, of either sign.
  return is_idle(p, i) ? 1.0 : primary_branch_rate(p, i, now) + 2.0 * k_zero_guard;
}

double lost_guard(const Particle& p, std::size_t i, double xi) {
  const double guard = contact_guard(p, k_lost, i, xi, p.contact(i).overlap);
  // On the primary branch, only elastic contacts beside a free centre have this guard. Such a contact, and an idle one,
  // may have an overlap of almost zero all the time, and would then be lost together with any other one. Division by
  // the resolution keeps the guard's value away from zero.
  return p.branch(i).is_on_primary_branch || is_idle(p, i) ? guard / k_resolution : guard;
}

double guard_value(Particle& p, const ContactCaps& caps, const Guard& guard, double xi, std::span<const double> y,
                   const Motion& now) {
  const std::size_t i = guard.list_index();
  switch (static_cast<GuardKind>(guard.kind)) {
    case k_growth_on:
    case k_growth_off:
      return growth_drive(p, now);
    case k_unstable:
      return centre_stiffness_guard(p);
    case k_softened:
      return is_any_softened(p) ? centre_stiffness(p).value - k_margin_of_fold : 1.0;
    case k_singular:
      return now.free_surface(p.at().growth) - k_least_slope;
    case k_covered:
      return p.at().volume.free_surface_at_rest(p.at().growth) - k_least_slope;
    case k_greatest_force:
      return stiffness_over_initial(p, i) - k_last_stiffness;
    case k_volume:
      return 1.0 - 4.0 * p.at().volume.compression_of_all - k_least_volume;
    case k_caps:
      return caps.guard(i);
    case k_centre_reached:
      return 1.0 - p.contact(i).approach - contacts::k_least_distance;
    case k_retreat:
      return retreat_guard(p, i, xi, y, now);
    case k_turn:
      return edge_rate(p, i, now);
    case k_lost:
      return lost_guard(p, i, xi);
    case k_greatest_tension:
    case k_least_tension:
    case k_tension_falls:
    case k_tension_rises:
      return tension_guard(p, guard.kind, i, now);
    case k_follow:
      return edge_guard(p, k_follow, i, xi, p.contact(i).overlap - edge_round_off(p, i));
    case k_peel:
    case k_pull_off:
      return edge_guard(p, guard.kind, i, xi, p.contact(i).overlap);
    case k_yield:
    case k_reload:
    case k_made:
    case k_dent_touched:
      return contact_guard(p, guard.kind, i, xi, p.contact(i).overlap);
  }
  return k_nan;
}

}  // namespace

void GuardSet::values(Particle& p, ContactCaps& caps, double xi, std::span<const double> y,
                      std::span<double> values) const {
  p.at_state(xi, y);
  const Motion now = p.motion(p.mode.is_growing);
  if (has_cap_guards_) caps.set_angles(p);
  for (std::size_t g = 0; g < list_.size(); ++g) values[g] = guard_value(p, caps, list_[g], xi, y, now);
}

}  // namespace monograin::mdr
