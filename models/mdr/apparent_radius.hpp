/// Growth of the apparent radius: the volume balance of all contacts, its rate, and the rules that open the gate.
///
/// Lengths in R0, stresses in any one unit; growth = (R - R0)/R0. While the radius grows, the volume V_geo of the
/// apparent sphere without the contact caps, less the elastically compressed volume V of the particle, stays constant:
///   V_geo,Q(R, delta_o) - V_Q(R, delta_o) = C
/// over the contacts Q that take part in the growth. Volumes are divided by 4 pi R0^3.
/// Source: Zunker and Kamrin (2024), eqs. (37) and (38) in the form that can be integrated.
#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "mdr/contact_branch.hpp"
#include "system/walls.hpp"

namespace monograin::mdr {

/// Rule that says which contacts make the apparent radius grow, and when.
enum class RadiusRule {
  gated,    ///< all touching contacts; only while a contact at its largest overlap is driven inwards
  yielded,  ///< yielded contacts at their largest overlap; only while one of them is driven inwards
  seed,     ///< all touching contacts; always (eq. 37 to the letter)
};

/// True if a contact in a regime takes part in the growth.
[[nodiscard]] inline bool takes_part(RadiusRule rule, Regime regime) noexcept {
  switch (rule) {
    case RadiusRule::gated:
    case RadiusRule::seed:
      return touches(regime);
    case RadiusRule::yielded:
      return regime == Regime::fully_plastic;
  }
  return false;
}

/// Motion of one contact that takes part in the growth.
struct ContactMotion {
  double inward_rate = 0.0;  ///< rate of its wall, inwards positive
  double least_rate = 0.0;   ///< a smaller inward_rate is round-off
  bool is_force_controlled = false;
  bool rises = false;  ///< a prescribed force grows
  bool is_on_primary_branch = false;
};
/// True if a contact that moves in this way opens the gate for growth.
[[nodiscard]] bool opens_gate(RadiusRule rule, const ContactMotion& motion) noexcept;

/// Part of one class of contacts in the volume balance.
struct VolumeTerm {
  double count;
  const Contact& contact;
  double approach;        ///< delta_o, displacement of the wall relative to the present centre
  double overlap;         ///< delta = approach + growth
  double rate_by_time;    ///< rate of the approach at fixed R
  double rate_by_growth;  ///< derivative of the approach by R; 0 where the displacement is prescribed
};

/// The volume balance and its partial derivatives at an instant.
struct VolumeBalance {
  double compression_of_all = 0.0;  ///< w summed over all contacts, not only those in Q
  double discriminant = 1.0;        ///< 1 - 4w over the contacts in Q; > 0 while the volume is defined
  double value = 0.0;               ///< V_geo,Q - V_Q
  double by_radius = 0.0;           ///< walls under force move so that their force stays
  double by_radius_at_rest = 0.0;   ///< by_radius where every wall stands still
  double by_time = 0.0;
  double time_scale = 0.0;  ///< sum of the magnitudes in by_time

  /// Volume of the particle over that of the undeformed one.
  [[nodiscard]] double volume_ratio() const noexcept;
  /// Share of the particle's surface that is free for growth between walls at rest, under force or displacement
  /// control. The model ends where it is used up.
  [[nodiscard]] double free_surface_at_rest(double growth) const noexcept {
    return by_radius_at_rest / ((1.0 + growth) * (1.0 + growth));
  }
};

/// Sums the volume balance up over the contacts in Q, n walls each.
///
/// Volumes over 4 pi R0^3, lengths over R0, g = growth, R = 1 + g, b = 1/(3 kappa) (docs/theory/mdr.md, from mdr-volume
/// to mdr-balance):
///   w     = (3/(4 pi)) b sum_Q n F (1 - delta_o)     compression by the virial's mean pressure
///   V/V0  = (1 + sqrt(1 - 4w))/2 = 1 - 2w/(1 + sqrt(1 - 4w))     larger root of v = 1 - w/v
///   value = g + g^2 + g^3/3 - sum_Q n delta^2 (3R - delta)/12 + (2/3) w/(1 + sqrt(1 - 4w))
/// add() returns d(value)/d(delta_o) = n (b (F' (1 - delta_o) - F)/(4 pi sqrt(1 - 4w)) - delta (2R - delta)/4).
class VolumeSum {
 public:
  /// @param virial_of_all  sum of force times distance from the centre over all contacts
  /// @param virial         that sum over the contacts in Q
  VolumeSum(double linear_compressibility, double virial_of_all, double virial) noexcept
      : w_(k_scale * linear_compressibility * virial) {
    sum_.discriminant = 1.0 - 4.0 * w_;
    root_of_discriminant_ = std::sqrt(sum_.discriminant);
    compliance_over_root_ = k_per_solid_angle * linear_compressibility / root_of_discriminant_;
    sum_.compression_of_all = k_scale * linear_compressibility * virial_of_all;
  }

  /// Adds a class of contacts in Q.
  /// @param radius  R = 1 + growth
  /// @return the derivative of the balance by the approach of its walls
  double add(const VolumeTerm& term, double radius) noexcept {
    const Contact& c = term.contact;
    const double distance = 1.0 - term.approach;
    caps_ += term.count * term.overlap * term.overlap * (3.0 * radius - term.overlap);
    overlaps_ += term.count * term.overlap;
    const double cap_rate = 0.25 * term.overlap * (2.0 * radius - term.overlap);
    const double volume_rate = compliance_over_root_ * (c.by_overlap * distance - c.force);
    const double by_approach = term.count * (volume_rate - cap_rate);
    sum_.by_time += by_approach * term.rate_by_time;
    sum_.time_scale += term.count * (std::abs(volume_rate) + std::abs(cap_rate)) * std::abs(term.rate_by_time);
    by_radius_ += term.count * compliance_over_root_ * (c.by_overlap + c.by_radius) * distance;
    by_radius_through_walls_ += by_approach * term.rate_by_growth;
    return by_approach;
  }

  /// The balance of all contacts that have been added.
  [[nodiscard]] const VolumeBalance& finish(double growth) noexcept {
    const double radius = 1.0 + growth;
    // Factors instead of divisors, which would be a good part of the cost of summing up.
    sum_.value = growth * (1.0 + growth * (1.0 + (1.0 / 3.0) * growth)) - (1.0 / 12.0) * caps_ +
                 (2.0 / 3.0) * w_ / (1.0 + root_of_discriminant_);
    sum_.by_radius_at_rest = by_radius_ + (radius * radius - 0.5 * radius * overlaps_);
    sum_.by_radius = sum_.by_radius_at_rest + by_radius_through_walls_;
    return sum_;
  }

 private:
  static constexpr double k_per_solid_angle = 0.25 * std::numbers::inv_pi;
  static constexpr double k_scale = 3.0 * k_per_solid_angle;

  double w_ = 0.0;  ///< over the contacts in Q
  double root_of_discriminant_ = 1.0;
  double compliance_over_root_ = 0.0;
  double caps_ = 0.0;                     ///< sum of n delta^2 (3R - delta)
  double overlaps_ = 0.0;                 ///< sum of n delta
  double by_radius_ = 0.0;                ///< derivative of -V by R at fixed walls
  double by_radius_through_walls_ = 0.0;  ///< derivative by R through walls under force, which move with it
  VolumeBalance sum_;
};

/// Demand for growth over the sum of the magnitudes whose difference it is: -1 where elastic volume loss rules, +1
/// where the caps do. The demand itself is no good root function: it starts at zero with every first touch, and near nu
/// = 0.5 returns to zero so soon that a root finder would take the return for the start.
/// @param demand           rate of the volume that growth has to take up
/// @param time_scale       VolumeBalance::time_scale
/// @param withdraws        walls of contacts in Q move out only
/// @param is_compressible  elastic volume vanishes last, with the square root of the overlap
[[nodiscard]] double growth_drive(double demand, double time_scale, bool withdraws, bool is_compressible) noexcept;

/// Two walls whose contact caps may meet; they may belong to one class.
struct CapPair {
  int first = 0;           ///< contact class
  int second = 0;          ///< contact class
  double half_sine = 0.0;  ///< sine of half the smallest angle between two of their normals
  bool have_met = false;   ///< caps have met and not parted since
};
/// All pairs of walls whose caps may meet. Caps on opposite sides meet only where the particle is squeezed to nothing.
[[nodiscard]] std::vector<CapPair> cap_pairs_of(std::span<const ContactClass> classes);
/// Half the angle that the cap of a contact covers on either side of its normal.
struct CapAngle {
  double sine = 0.0;
  double cosine = 1.0;
};
[[nodiscard]] CapAngle cap_angle(double overlap, double growth) noexcept;
/// Guard: >= 0 where the caps of two contacts intersect. Caps meet where their angles add up to that between the
/// normals. Half angles are compared by their sines: cosines would lose digits.
[[nodiscard]] inline double cap_guard(const CapPair& pair, const CapAngle& first, const CapAngle& second) noexcept {
  return first.sine * second.cosine + second.sine * first.cosine - pair.half_sine;
}

}  // namespace monograin::mdr
