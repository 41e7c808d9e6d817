#include "mdr/rates.hpp"

#include <algorithm>
#include <cmath>

#include "mdr/guards.hpp"
#include "mdr/idle.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {

namespace {

/// Rate of a prescribed force less the force that growth takes away, over the sum of their magnitudes.
double loaded_rate(const Particle& p, double loading, double by_radius, double growth_rate) noexcept {
  const double taken = by_radius * growth_rate;
  const double scale = std::abs(loading) + std::abs(taken);
  if (scale > 0.0) return (loading - taken) / scale;
  // At the very start of growth the rate of the radius is zero, and about to become positive.
  return p.mode.is_growing && by_radius > 0.0 ? -1.0 : 0.0;
}

}  // namespace

double inward_rate(const Particle& p, std::size_t i, const Motion& motion) noexcept {
  const double rate_by_centre = p.is_force_controlled(i) ? 0.0 : p.centre().mean_normal(i).dot(motion.centre);
  return p.contact(i).rate_by_time + p.contact(i).rate_by_growth * motion.growth_rate + rate_by_centre;
}

double wall_rate(const Particle& p, std::size_t i, const Motion& motion) noexcept {
  if (!p.is_force_controlled(i)) return inward_rate(p, i, motion) / p.speed_scale();
  const Contact& c = p.contact(i).contact;
  return loaded_rate(p, p.drive(i).rate(), c.by_overlap + c.by_radius, motion.growth_rate);
}

double overlap_rate(const Particle& p, std::size_t i, const Motion& motion) noexcept {
  if (!p.is_force_controlled(i)) return (inward_rate(p, i, motion) + motion.growth_rate) / p.speed_scale();
  return loaded_rate(p, p.drive(i).rate(), p.contact(i).contact.by_radius, motion.growth_rate);
}

double primary_branch_rate(const Particle& p, std::size_t i, const Motion& motion) noexcept {
  return p.law().is_shifted() ? wall_rate(p, i, motion) : overlap_rate(p, i, motion);
}

double edge_rate(const Particle& p, std::size_t i, const Motion& motion) {
  const Instant& now = p.contact(i);
  double overlap_by_xi = inward_rate(p, i, motion) + motion.growth_rate;
  // The rate of a force-controlled contact that is just being made has no bound: the sign of the force's rate decides,
  // however small that is, and growth does not count.
  const bool is_being_made = p.is_force_controlled(i) && !(now.contact.by_overlap > 0.0);
  if (is_being_made) overlap_by_xi = p.drive(i).rate();
  if (is_being_made || motion.growth_rate == 0.0) {
    // If a free centre keeps up with the wall, the difference of their speeds is round-off, of either sign.
    const double round_off =
        p.is_force_controlled(i) ? 0.0 : k_zero_guard * (std::abs(now.rate_by_time) + motion.centre.norm());
    return overlap_by_xi > round_off ? 1.0 : overlap_by_xi < -round_off ? -1.0 : 0.0;
  }
  return p.branch(i).press_rate(p.law(), p.at().growth, now.overlap, now.contact.contact_radius, overlap_by_xi,
                                motion.growth_rate);
}

double force_rate(const Particle& p, std::size_t i, const Motion& motion) {
  const Contact& c = p.contact(i).contact;
  const double scale = p.branch(i).reference_stiffness(p.law(), p.at().growth, c) * p.speed_scale();
  const double rate =
      c.by_overlap * (inward_rate(p, i, motion) + motion.growth_rate) + c.by_radius * motion.growth_rate;
  return scale > 0.0 ? rate / scale : 0.0;
}

double rate_if_unloaded(Particle& p, std::size_t i, double xi, std::span<const double> y) {
  const ContactBranch before = p.branch(i);
  p.set_branch(i, before.unloaded(p.law(), y[k_growth], p.contact(i).overlap));
  p.evaluate(xi, y);
  const double stiffer = std::max(1.0, p.contact(i).contact.by_overlap / p.law().plastic_stiffness());
  const double rate = stiffer * primary_branch_rate(p, i, p.motion(p.mode.is_growing));
  p.set_branch(i, before);
  p.evaluate(xi, y);
  return rate;
}

// --- growth

bool gate_is_open(const Particle& p, const Motion& motion) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.takes_part(i)) continue;
    // Next to stiff contacts the rate of an idle contact loses digits.
    const ContactMotion drive{.inward_rate = inward_rate(p, i, motion),
                              .least_rate = (is_idle(p, i) ? k_just_turned : k_zero_guard) * p.speed_scale(),
                              .is_force_controlled = p.is_force_controlled(i),
                              .rises = p.drive(i).rate() > 0.0,
                              .is_on_primary_branch = p.branch(i).is_on_primary_branch};
    if (opens_gate(p.setup().settings.radius_rule, drive)) return true;
  }
  return false;
}

double growth_drive(const Particle& p, const Motion& motion) noexcept {
  const double scale = p.at().volume.time_scale;
  bool goes_in = false;
  bool goes_out = false;
  const bool is_undecided = !(scale > 0.0) && motion.demand == 0.0;
  for (std::size_t i = 0; is_undecided && i < p.size(); ++i) {
    if (!p.takes_part(i)) continue;
    const double rate = wall_rate(p, i, motion);
    goes_in = goes_in || rate > 0.0;
    goes_out = goes_out || rate < 0.0;
  }
  return growth_drive(motion.demand, scale, goes_out && !goes_in, p.law().material.linear_compressibility > 0.0);
}

bool has_greatest_force(const Particle& p, std::size_t i) noexcept {
  return p.is_force_controlled(i) && p.branch(i).regime == Regime::fully_plastic;
}

double stiffness_over_initial(const Particle& p, std::size_t i) noexcept {
  return p.contact(i).contact.by_overlap / p.law().plastic_stiffness();
}

}  // namespace monograin::mdr
