/// Return mapping: brings the plastic strains of a material point back to the yield surface.
#pragma once

#include "material-point/plastic_flow.hpp"

namespace monograin::material_point {

/// Brings the plastic strains to f = 0 along the flow. Where that does not arrive, or runs along the surface, takes the
/// shortest path, because both strains may carry an integrator's errors. Under prescribed stresses, f does not depend
/// on g^p, and near a critical state the flow hardly changes phi: there only the shortest path is tried.
/// @throws std::domain_error if no plastic strains near the guess lie on the surface
[[nodiscard]] PlasticStrains returned_to_surface(const Phase& phase, double xi, const PlasticStrains& guess);

}  // namespace monograin::material_point
