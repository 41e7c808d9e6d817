/// Tests whether the convex indenter of the model gives the right pull-off of a flattened, adhesive particle.
///
/// The surface of a strongly flattened particle is concave inside a ring of the radius r_peak, which the elliptic
/// indenter is not; and no yielding in tension is accounted for at the edge. Both are harmless while the critical
/// contact radius is large: a_c > r_peak and 2 a_c >= 15 r_Ip (F.7). The fit of r_peak was made to two walls and a
/// single particle. Source: Zunker and Kamrin (2024), Appendix F.
#pragma once

#include "mdr/adhesion.hpp"

namespace monograin::mdr {

/// r_peak/R0 = 1.75 x^(3/4), x = (delta_o,max - delta_Y)/R0 - 0.135; 0 for x <= 0, where the profile is convex (F.1).
/// NaN in gives NaN out.
/// @param displacement_over_radius  largest wall displacement over R0, 0 to 0.5 in the data
/// @param yield_overlap_ratio       delta_Y/R0 at first yield; infinity: never yields, gives 0
[[nodiscard]] double peak_radius_over_initial_radius(double displacement_over_radius,
                                                     double yield_overlap_ratio) noexcept;

/// Size of the plastic zone at the edge of an adhesive contact, r_Ip = E* dg/(pi (Y + p_c)^2) (F.18).
///
/// @param mean_pressure  p_c = F_free/(pi a^2) >= 0, the part of the pressure that is not due to adhesion; 0 leaves it
///                       out (F.17), which gives the larger zone
[[nodiscard]] double plastic_zone_size(double composite_modulus, double surface_energy, double yield_stress,
                                       double mean_pressure = 0.0) noexcept;

enum class AdhesionValidity {
  valid,
  peak_failure,     ///< the critical contact radius lies inside the ring: a_c <= r_peak
  yielding_failure  ///< yielding at the edge is not small-scale: 2 a_c < 15 r_Ip
};

/// Test F.7. If both conditions fail, the result is peak_failure.
/// @param critical_radius    a_c >= 0
/// @param peak_radius        r_peak >= 0; 0 never fails
/// @param plastic_zone_size  r_Ip >= 0
[[nodiscard]] AdhesionValidity adhesion_validity(double critical_radius, double peak_radius,
                                                 double plastic_zone_size) noexcept;

}  // namespace monograin::mdr
