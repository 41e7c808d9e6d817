/// Tests whether the convex indenter of the model gives the right pull-off of a flattened, adhesive particle.
///
/// The surface of a strongly flattened particle is concave inside a ring of the radius r_peak, which the elliptic
/// indenter is not; and no yielding in tension is accounted for at the edge. Both are harmless while the critical
/// contact radius is large: a_c > r_peak and 2 a_c >= 15 r_Ip (F.7). The fits were made to two walls and a single
/// particle. Of the fits, a run uses F.1 alone; F.2 and F.3 are there in the form that corrects their misprints.
/// Source: Zunker and Kamrin (2024), Appendices F.1 to F.3.
#pragma once

#include "mdr/adhesion.hpp"

namespace monograin::mdr {

// The fits; NaN in gives NaN out. Arguments are the largest wall displacement over R0, 0 to 0.5 in the data, and
// delta_Y/R0, the overlap ratio at first yield (infinity: never yields, all fits are 0).

/// r_peak/R0 = 1.75 x^(3/4), x = (delta_o,max - delta_Y)/R0 - 0.135; 0 for x <= 0, where the profile is convex (F.1).
[[nodiscard]] double peak_radius_over_initial_radius(double displacement_over_radius,
                                                     double yield_overlap_ratio) noexcept;

/// r_peak/a_max = 1.1 x^(1/3), x = (delta_o,max - delta_Y)/R0 - 0.15; 0 for x <= 0.
///
/// F.2 with the shift of the figure that it was read from (F.19b), not the 0.135 of the text: only so does it agree
/// with F.1, to 2 % at E/Y = 200 from displacements of 0.3 R0 on.
[[nodiscard]] double peak_radius_over_contact_radius(double displacement_over_radius,
                                                     double yield_overlap_ratio) noexcept;

/// Xi/R0, how far the middle lies below the ring: (E/Y)^-1.175 (0.1025 - (0.1025/0.18^2) (x - 0.18)^2),
/// x = (delta_o,max - delta_Y)/R0 - 0.15; 0 outside 0 < x < 0.36.
///
/// F.3 with 0.18 squared in the denominator and its range on x: as printed it would begin with 0.084 instead of 0.
/// @param modulus_over_yield  E/Y (not E*/Y), > 0
[[nodiscard]] double peak_depth_over_initial_radius(double displacement_over_radius, double yield_overlap_ratio,
                                                    double modulus_over_yield) noexcept;

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
