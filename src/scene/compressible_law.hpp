/// The contact law of a compressible particle that a scenario asks for.
#pragma once

#include <vector>

#include "compressible/contact_law.hpp"
#include "scenario/scenario.hpp"
#include "system/hybrid_system.hpp"

namespace monograin {

struct CompressibleLaw {
  compressible::LoadingLaw loading;
  double hertz_stiffness = 1.0;  ///< k_H
  compressible::UnloadingRule unloading;
  std::vector<Diagnostic> reservations;  ///< what the user should know of it
};

/// @throws std::invalid_argument for a material that the source has no law for
[[nodiscard]] CompressibleLaw compressible_law_of(const Scenario& scenario);

}  // namespace monograin
