/// Rates of the contacts of an MDR particle, and what drives its growth.
#pragma once

#include "mdr/particle.hpp"

namespace monograin::mdr {

// --- rates of one contact

/// d(delta_o)/dxi of a wall, towards the centre positive.
[[nodiscard]] double inward_rate(const Particle& p, std::size_t i, const Motion& motion) noexcept;
/// A number of order one with the sign of inward_rate(). With a prescribed force F, under which that rate has no bound,
/// R' = growth rate and F_R = derivative of the force by R at a resting wall:
///   under displacement control   inward_rate()/speed_scale()
///   under force control          (F' - F_R R')/(|F'| + |F_R R'|)
[[nodiscard]] double wall_rate(const Particle& p, std::size_t i, const Motion& motion) noexcept;
/// A number of order one with the sign of the overlap's rate, as wall_rate(); F_R is there that at a fixed overlap.
[[nodiscard]] double overlap_rate(const Particle& p, std::size_t i, const Motion& motion) noexcept;
/// Rate of the quantity that defines the largest overlap: the overlap itself, or the approach of the wall with
/// delta_max_rule = shifted.
[[nodiscard]] double primary_branch_rate(const Particle& p, std::size_t i, const Motion& motion) noexcept;
/// Rate at which the springs at the edge of a contact are pressed (+) or stretched (-), of order one.
[[nodiscard]] double edge_rate(const Particle& p, std::size_t i, const Motion& motion);
/// Rate of a contact's force, over its rate if the edge stuck and the overlap grew with speed_scale().
[[nodiscard]] double force_rate(const Particle& p, std::size_t i, const Motion& motion);
/// Rate of the largest overlap if this contact began to unload here, times the ratio of stiffnesses. If this rate is
/// positive, the contact would load again as soon as it unloads, and alternate without end: it stays on its loading
/// branch until the rate is negative.
[[nodiscard]] double rate_if_unloaded(Particle& p, std::size_t i, double xi, std::span<const double> y);

// --- growth

/// True if the rule lets the radius grow under this motion of the contacts.
[[nodiscard]] bool gate_is_open(const Particle& p, const Motion& motion);
/// Demand for growth over the sum of the magnitudes whose difference it is, of order one.
[[nodiscard]] double growth_drive(const Particle& p, const Motion& motion) noexcept;

/// True for a plastic contact under a prescribed force: at a given radius there is a largest force that it bears.
[[nodiscard]] bool has_greatest_force(const Particle& p, std::size_t i) noexcept;
/// Tangent stiffness of a contact over ContactLaw::plastic_stiffness(), that of a shallow plastic contact.
[[nodiscard]] double stiffness_over_initial(const Particle& p, std::size_t i) noexcept;

}  // namespace monograin::mdr
