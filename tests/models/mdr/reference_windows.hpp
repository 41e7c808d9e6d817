/// Reference data of adhesive contacts after unloading, and the surface energies for which the model is valid there.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "history/table.hpp"
#include "mdr/adhesion_validity.hpp"
#include "support/reference_case.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {

/// Nine columns of a file, with a value for every material and displacement; lengths over R0, energies over E R0.
struct ReferenceWindows {
  std::vector<double> modulus_over_yield, displacement, yielded, radius, contact_radius, height, peak_radius;
  std::vector<double> least, greatest;  ///< surface energy
};

/// @param control  under which the contacts are pulled off
inline ReferenceWindows reference_windows(Control control) {
  const Table table =
      read_csv(test_file(control == Control::force ? "models/mdr/reference/adhesion_validity_nu03_xi3.csv"
                                                   : "models/mdr/reference/adhesion_validity_nu03_xi1.csv"));
  return {.modulus_over_yield = table.column("E_over_Y"),
          .displacement = table.column("delta_o_max_over_R0"),
          .yielded = table.column("yielded"),
          .radius = table.column("R_over_R0"),
          .contact_radius = table.column("a_max_over_R0"),
          .height = table.column("A_over_R0"),
          .peak_radius = table.column("r_peak_over_R0"),
          .least = table.column("dg_min_over_ER0"),
          .greatest = table.column("dg_max_over_ER0")};
}

/// Surface energies for which a contact is valid, from least (excluded) to greatest; empty where least > greatest.
struct SurfaceEnergyWindow {
  double least = 0.0;     ///< a_c = r_peak; 0 without a ring, infinity where the ring reaches the half width b
  double greatest = 0.0;  ///< 2 a_c = 15 r_Ip (F.17); infinity where nothing yields
};

/// Both bounds in closed form: eq. 15 of an ellipse, a_c^3 + k a_c^2 - k b^2 = 0 with k proportional to dg, is linear
/// in dg at a given a_c, and quadratic at a given a_c/dg.
/// @param yield_stress  Y > 0 or infinity
/// @param peak_radius   r_peak >= 0
inline SurfaceEnergyWindow adhesion_window(const Indenter& indenter, double composite_modulus, double yield_stress,
                                           double peak_radius, Control control) {
  const double b = indenter.half_width;
  const double xi = control == Control::force ? 3.0 : 1.0;
  const double slope = 0.5 * indenter.height / b;
  // The critical radius depends on k = c dg; for the parabola its equation has no quadratic term.
  const double c = 0.5 * xi * xi * std::numbers::pi / (composite_modulus * slope * slope);

  const double rest = indenter.is_parabola() ? b * b : (b - peak_radius) * (b + peak_radius);
  const double least = rest > 0.0 ? peak_radius * peak_radius * peak_radius / (c * rest) : k_infinity;
  // a_c = zones dg
  const double zones = 0.5 * 15.0 * composite_modulus / (std::numbers::pi * yield_stress * yield_stress);
  const double cubic = zones * zones * (indenter.is_parabola() ? zones : zones + c);
  return {.least = least, .greatest = b * std::sqrt(c / cubic)};
}

}  // namespace monograin::mdr
