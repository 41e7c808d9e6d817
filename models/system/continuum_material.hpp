/// Material of a model as finite elements take it.
#pragma once

#include <string>
#include <vector>

namespace monograin {

struct ModelInput;

/// A point of a flow curve.
struct FlowPoint {
  double plastic_strain = 0.0;  ///< logarithmic, from 0 on
  double stress = 0.0;          ///< true stress in uniaxial flow [Pa]
};

/// Isotropic material: elastic, and plastic by von Mises with isotropic hardening if it has a flow curve.
struct ContinuumMaterial {
  double youngs_modulus = 0.0;  ///< [Pa]
  double poisson_ratio = 0.0;
  std::vector<FlowPoint> flow{};           ///< strains increase from 0; the last stress holds beyond; empty: elastic
  std::vector<std::string> differences{};  ///< what the model has beside this material, a sentence each
};

/// Material with the keys youngs_modulus and poisson_ratio of a scenario; ideally plastic if it has yield_stress.
[[nodiscard]] ContinuumMaterial continuum_material(const ModelInput& input);

}  // namespace monograin
