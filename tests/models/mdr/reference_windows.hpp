/// Reference data of adhesive contacts after unloading, and the surface energies for which the model is valid there.
#pragma once

#include <string>
#include <vector>

#include "history/table.hpp"
#include "support/reference_case.hpp"
#include "system/walls.hpp"

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

}  // namespace monograin::mdr
