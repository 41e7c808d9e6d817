/// The packing law that a scenario asks for.
#pragma once

#include "packing/law.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// @throws std::invalid_argument where its parameters make no law
[[nodiscard]] packing::Law packing_law_of(const Scenario& scenario);

/// Packing fraction at the start.
[[nodiscard]] double initial_packing_fraction_of(const Scenario& scenario, const packing::Law& law);

}  // namespace monograin
