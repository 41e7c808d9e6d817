// Which guards of the MDR system are alive, and their values.

#include "mdr/guards.hpp"

#include <algorithm>
#include <cmath>

#include "mdr/system.hpp"

namespace monograin::mdr {
namespace {

// A program that returns exactly to the old maximum does not pass it, whichever way its overlap is rounded.
constexpr double k_same_overlap = 2e-15;
// The volume's square root ends at 1 - 4w = 0; stop before an implicit code's difference quotients reach over that
// edge.
constexpr double k_least_volume = 1e-6;

}  // namespace

double System::contact_guard(int kind, std::size_t i, double xi, double overlap, double r) {
  // Under force a contact lasts as long as the force presses; a program that returns exactly to zero does not leave it.
  if (is_loaded(i) && (kind == k_made || kind == k_dent_touched || kind == k_lost)) {
    const double scale = std::max(std::abs(ramps_[i].start), std::abs(ramps_[i].end));
    return scale > 0.0 ? prescribed_force(i, xi) / scale + (kind == k_lost ? k_same_overlap : 0.0) : 0.0;
  }
  const ContactBranch& branch = branches_[i];
  switch (kind) {
    case k_yield:
      // What only touches may be as deep as that by the rounding of others.
      return branch.yield_guard(law_, r, overlap, is_idle_contact(i) ? shallow() : 0.0);
    case k_reload:
      return overlap - branch.largest_overlap(law_, r) - k_same_overlap;
    case k_lost:
      return branch.opening_guard(law_, r, is_idle_contact(i) ? overlap + shallow() : overlap);
    case k_dent_touched:
      return branch.opening_guard(law_, r, overlap);
    default:
      // A wall that a free centre leaves at a touch, and comes back to at once, would not be seen to have been left.
      return free_count_ > 0 ? overlap - k_same_overlap : overlap;
  }
}

/// Distances from the states in which the edge of an adhesive contact changes, over what tears it.
double System::edge_guard(int kind, std::size_t i, double xi, double overlap, double r) {
  const ContactBranch& branch = branches_[i];
  const Frame now = branch.frame(law_, r, overlap);
  if (kind == k_pull_off) {
    const PullOff& limits = branch.pull_off(law_, now.indenter);
    return is_loaded(i) ? pull_off_guard(limits, prescribed_force(i, xi)) : pull_off_guard(limits, now);
  }
  // Without springs a force leads it either way by its sign alone.
  if (branch.edge.radius == 0.0 && is_loaded(i)) {
    return contact_guard(kind == k_peel ? k_lost : k_made, i, xi, overlap, r);
  }
  return kind == k_peel ? peel_guard(branch.edge, now, law_.adhesion())
                        : follow_guard(branch.edge, now, law_.adhesion());
}

/// Overlap by which an edge that sticks may seem to be where it would follow. One that has just come to stick leaves
/// with the square of the way, and rounding does not bring it back.
double System::rounding_of_edge(std::size_t i, double r) {
  const Frame at = branches_[i].frame(law_, r, now_[i].overlap);
  return k_same_overlap + profile_rounding(at.indenter, branches_[i].edge.radius) / at.by_overlap;
}

double System::cap_guard(const CapPair& pair, double r) const {
  // A cap of overlap d covers an angle a on either side of its normal with sin(a/2)^2 = d/(2 R). Caps meet where their
  // angles add up to that between the normals; half of each, because the cosines of small angles have no digits left.
  // An idle contact has no cap; a round-off overlap of 1e-12 R0 would give one 1e-6 R0 wide.
  const double scale = 0.5 / (1.0 + r);
  const auto square = [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    return is_idle_contact(at) ? 0.0 : std::clamp(now_[at].overlap * scale, 0.0, 1.0);
  };
  const double first = square(pair.first);
  const double second = square(pair.second);
  return std::sqrt(first * (1.0 - second)) + std::sqrt(second * (1.0 - first)) - pair.half_sine;
}

/// Lists the guards that can fire before the step ends.
void System::arm_guards(double xi, std::span<const double> y) {
  guards_.clear();
  evaluate_cached(xi, y);
  const double r = y[k_radius];
  const Motion now = motion(is_growing_);
  for (std::size_t i = 0; i < branches_.size(); ++i) arm_contact_guards(i, r, now);
  const auto is_plastic = [](const ContactBranch& memory) { return memory.regime == Regime::fully_plastic; };
  if (free_count_ > 0 && weakest_contact()) {
    guards_.push_back({.kind = k_unstable, .index = -1, .direction = -1, .name = "pull-off", .is_branch_end = true});
  } else if (free_count_ > 0 && std::ranges::any_of(branches_, is_plastic)) {
    guards_.push_back({.kind = k_softened, .index = -1, .direction = -1, .name = "limit", .is_branch_end = true});
  }

  if (is_growing_) {
    guards_.push_back({k_growth_off, -1, -1, "growth-off"});
    guards_.push_back({k_singular, -1, -1, "singular-growth"});
    // Under displacement control the two are one.
    if (takes_forces_) guards_.push_back({k_covered, -1, -1, "singular-growth"});
  } else if (settings_.radius_rule != RadiusRule::fixed && gate_is_open(now)) {
    guards_.push_back({k_growth_on, -1, 1, "growth-on"});
    // The share of a contact in the demand for growth may change sign just before it is lost.
    for (Guard& guard : guards_) guard.is_branch_end = guard.is_branch_end || guard.kind == k_lost;
  }
  for (std::size_t p = 0; p < cap_pairs_.size(); ++p) {
    const auto first = static_cast<std::size_t>(cap_pairs_[p].first);
    const auto second = static_cast<std::size_t>(cap_pairs_[p].second);
    const bool both_touch = branches_[first].touches() && branches_[second].touches();
    // Caps that have just met change no mode; met a rounding error short of zero, they would meet again at once.
    if (both_touch && !cap_pairs_[p].have_met && cap_guard(cap_pairs_[p], r) < -k_touch) {
      guards_.push_back({k_caps, static_cast<int>(p), 1, "caps-intersect"});
    }
  }
  if (settings_.radius_rule != RadiusRule::fixed && law_.material.bulk_compliance > 0.0) {
    guards_.push_back({k_volume, -1, -1, "volume-limit"});
  }
  for (std::size_t i = 0; i < ramps_.size(); ++i) {
    if (is_loaded(i) || 1.0 - ramps_[i].end < 2.0 * k_least_distance || free_count_ > 0) {
      guards_.push_back({k_centre_reached, static_cast<int>(i), -1, "limit"});
    }
  }
  if (goes_one_way(r, now)) {
    for (Guard& guard : guards_) guard.is_monotone = guard.kind != k_growth_on;
  }
}

/// Whether the overlaps, and with them forces, caps and volume, all grow or all shrink over the rest of the step.
bool System::goes_one_way(double r, const Motion& now) const {
  if (is_growing_ || free_count_ > 0) return false;
  bool goes_in = false;
  bool goes_out = false;
  for (std::size_t i = 0; i < ramps_.size(); ++i) {
    // What a deeper contact has in force it may lose in the lever with which that acts on the volume.
    if (is_loaded(i) || 2.0 * std::max(ramps_[i].start, ramps_[i].end) > 1.0 - r) return false;
    const double rate = overlap_rate(i, now);
    goes_in = goes_in || rate > 0.0;
    goes_out = goes_out || rate < 0.0;
  }
  return !(goes_in && goes_out);
}

void System::arm_contact_guards(std::size_t i, double r, const Motion& now) {
  const ContactBranch& memory = branches_[i];
  const int index = static_cast<int>(i);
  const bool is_free = !is_loaded(i) && free_count_ > 0 && directions_[i].norm() > k_no_direction;
  const bool may_turn = is_growing_ || is_free;            // in mid-step
  const bool is_predictable = !may_turn && !is_loaded(i);  // overlap linear in xi, radius held
  const double last_overlap = ramps_[i].end + r;

  const auto add = [&](int kind, int direction, std::string_view name) {
    // What a linear overlap, or a prescribed force, does not reach by the end of the step needs no watching.
    const bool is_by_force = is_loaded(i) && (kind == k_made || kind == k_dent_touched || kind == k_lost);
    if ((is_predictable || is_by_force) && direction * contact_guard(kind, i, 1.0, last_overlap, r) < -1e-9) return;
    guards_.push_back({kind, index, direction, name});
  };
  const double rate = overlap_rate(i, now);
  const bool may_come_in = rate > 0.0 || may_turn;
  const bool may_go_out = rate < 0.0 || may_turn;
  switch (memory.regime) {
    case Regime::open:
      if (may_come_in) add(k_made, 1, "contact-made");
      return;
    case Regime::separated:
      if (may_come_in) add(k_dent_touched, 1, "dent-touched");
      return;
    case Regime::elastic:
    case Regime::fully_plastic:
    case Regime::unloading:
      break;
  }
  if (memory.regime == Regime::elastic && may_come_in && memory.may_yield(law_)) add(k_yield, 1, "yield");
  if (has_greatest_force(i)) {
    guards_.push_back(
        {.kind = k_greatest_force, .index = index, .direction = -1, .name = "limit", .is_branch_end = true});
  }
  if (memory.is_on_primary_branch) {
    const bool is_shifted = law_.is_shifted();
    const bool may_retreat = is_free || (may_turn && (is_loaded(i) || (wall_rate(i, now) < 0.0 && !is_shifted)));
    if (may_retreat) guards_.push_back({k_retreat, index, -1, "retreat"});
    if (is_free && memory.regime == Regime::elastic) guards_.push_back({k_lost, index, -1, "contact-lost"});
    return;
  }
  if (may_come_in) add(k_reload, 1, "reload");
  if (law_.adheres()) {
    watch_edge(i, r, may_come_in, may_go_out, may_turn);
    watch_tension(i, now, may_go_out, may_turn);
  } else if (may_go_out) {
    add(k_lost, -1, "contact-lost");
  }
}

void System::watch_edge(std::size_t i, double r, bool may_come_in, bool may_go_out, bool may_turn) {
  const ContactBranch& memory = branches_[i];
  const int index = static_cast<int>(i);
  switch (memory.edge.motion) {
    case Edge::following:
      if (may_turn) guards_.push_back({k_turn, index, -1, "stick"});
      break;
    case Edge::sticking: {
      // An edge that sticks since the largest overlap follows again when that is passed.
      const double at_largest = edge_guard(k_follow, i, 0.0, memory.largest_overlap(law_, r), r);
      if (may_come_in && (may_turn || at_largest > 1e-9)) guards_.push_back({k_follow, index, 1, "follow"});
      if (may_go_out) guards_.push_back({k_peel, index, -1, "peel"});
      break;
    }
    case Edge::peeling:
      if (may_go_out) {
        guards_.push_back(
            {.kind = k_pull_off, .index = index, .direction = -1, .name = "pull-off", .is_branch_end = true});
      }
      if (may_turn) guards_.push_back({k_turn, index, 1, "stick"});
      break;
  }
}

/// Rate of a contact's force with xi, over what the walls' motion makes of the force of an edge that sticks.
double System::force_rate(std::size_t i, const Motion& now) const noexcept {
  const Contact& c = now_[i].contact;
  const double scale = branches_[i].unpeeled_stiffness(law_, evaluated_radius_, now_[i].contact) * speed_scale();
  const double rate = c.by_overlap * (inward_rate(i, now) + now.growth) + c.by_radius * now.growth;
  return scale > 0.0 ? rate / scale : 0.0;
}

/// Lists the guards of the extrema of a tensile force, in turns: after a least force comes a greatest. A prescribed
/// force has none within a step, nor has an edge that sticks where only the own wall moves.
void System::watch_tension(std::size_t i, const Motion& now, bool may_go_out, bool may_turn) {
  const bool peels_alone = branches_[i].edge.peels() && may_go_out;
  if (branches_[i].edge.follows() || is_loaded(i) || !(may_turn || peels_alone)) return;
  const auto add = [&](int kind, int direction) {
    guards_.push_back({.kind = kind,
                       .index = static_cast<int>(i),
                       .direction = direction,
                       .name = "force-extremum",
                       .is_mark = true});
  };
  const bool is_tensile = now_[i].contact.force < 0.0;
  const double rate = force_rate(i, now);
  if (!is_tensile || rate < -0.5 * k_steady_force) return add(k_greatest_tension, 1);
  if (!may_turn) return;
  if (rate > 0.5 * k_steady_force) return add(k_least_tension, -1);
  // A force at rest is at no extremum where it begins to move.
  add(k_tension_falls, 1);
  add(k_tension_rises, -1);
}

/// Whether the force of a contact that pulls goes through an extremum where the guard has fired. One that presses has
/// come back from that with a rate.
bool System::is_extremum(int kind, std::size_t i, const Motion& now) const noexcept {
  if (branches_[i].edge.motion != edges_before_[i] || !branches_[i].touches() || !(now_[i].contact.force < 0.0))
    return false;
  return kind == k_greatest_tension || (kind == k_least_tension && force_rate(i, now) > -2.0 * k_steady_force);
}

void System::guard_values(double xi, std::span<const double> y, std::span<double> values) {
  evaluate_cached(xi, y);
  const double r = y[k_radius];
  const Motion now = motion(is_growing_);
  for (std::size_t g = 0; g < guards_.size(); ++g) {
    const auto i = static_cast<std::size_t>(std::max(0, guards_[g].index));
    switch (guards_[g].kind) {
      case k_growth_on:
      case k_growth_off:
        values[g] = growth_drive(now);
        break;
      case k_unstable:
        values[g] = centre_stiffness_guard(r);
        break;
      case k_softened:
        values[g] = is_any_softened() ? least_centre_stiffness() - k_least_centre_stiffness : 1.0;
        break;
      case k_singular:
        values[g] = free_surface(now, r) - k_least_slope;
        break;
      case k_covered:
        values[g] = free_surface_at_rest(r) - k_least_slope;
        break;
      case k_greatest_force:
        values[g] = stiffness_left(i) - k_last_stiffness;
        break;
      case k_volume:
        values[g] = 1.0 - 4.0 * sums_.relative_compression - k_least_volume;
        break;
      case k_caps:
        values[g] = cap_guard(cap_pairs_[i], r);
        break;
      case k_centre_reached:
        values[g] = 1.0 - now_[i].displacement - k_least_distance;
        break;
      case k_retreat:
        if (goes_on_[i]) {
          values[g] = rate_if_turned(i, xi, y);
          break;
        }
        values[g] = primary_branch_rate(i, now);
        // What rests beside a centre that moves has rates of either sign.
        values[g] += 2.0 * k_touch;
        if (is_idle_contact(i)) values[g] = 1.0;
        break;
      case k_turn:
        values[g] = edge_rate(i, r, now);
        break;
      case k_lost:
        values[g] = contact_guard(k_lost, i, xi, now_[i].overlap, r);
        // What only touches is always near to that, and not lost together with others.
        if (branches_[i].is_on_primary_branch || is_idle_contact(i)) values[g] /= k_resolution;
        break;
      case k_greatest_tension: {
        const double rate = force_rate(i, now);
        values[g] = (now_[i].contact.force < 0.0 ? rate : -std::abs(rate)) - k_steady_force;
        break;
      }
      case k_least_tension: {
        const double rate = force_rate(i, now);
        values[g] = (now_[i].contact.force < 0.0 ? rate : std::abs(rate)) + k_steady_force;
        break;
      }
      case k_tension_falls:
        values[g] = force_rate(i, now) - k_steady_force;
        break;
      case k_tension_rises:
        values[g] = force_rate(i, now) + k_steady_force;
        break;
      case k_follow:
        values[g] = edge_guard(k_follow, i, xi, now_[i].overlap - rounding_of_edge(i, r), r);
        break;
      case k_peel:
      case k_pull_off:
        values[g] = edge_guard(guards_[g].kind, i, xi, now_[i].overlap, r);
        break;
      default:
        values[g] = contact_guard(guards_[g].kind, i, xi, now_[i].overlap, r);
        break;
    }
  }
}

}  // namespace monograin::mdr
