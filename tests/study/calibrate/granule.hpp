/// Scenario of a granule for calibrations.
#pragma once

namespace monograin {

/// A granule that is loaded, held, unloaded, loaded farther and unloaded: its program takes one row a second.
inline constexpr const char* k_granule = R"(model = "mdr"
[particle]
radius = "0.4 mm"
[material]
youngs_modulus = "2 GPa"
poisson_ratio = 0.3
yield_stress = "60 MPa"
[loading]
configuration = "simple"
steps = [
  { displacement = "0.15 R0", duration = 60 }, { hold = true, duration = 60 }, { force = "2 N", duration = 60 },
  { displacement = "0.2 R0", duration = 60 }, { force = "0.5 N", duration = 60 }]
[output]
points = 60
)";

}  // namespace monograin
