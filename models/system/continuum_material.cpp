#include "system/continuum_material.hpp"

#include "system/model_input.hpp"

namespace monograin {

ContinuumMaterial continuum_material(const ModelInput& input) {
  ContinuumMaterial material{.youngs_modulus = input.material("youngs_modulus"),
                             .poisson_ratio = input.material("poisson_ratio")};
  if (const auto yield_stress = input.optional_material("yield_stress")) material.flow = {{0.0, *yield_stress}};
  return material;
}

}  // namespace monograin
