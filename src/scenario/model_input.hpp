/// A checked scenario as its model sees it.
#pragma once

#include "scenario/scenario.hpp"
#include "system/model.hpp"

namespace monograin {

/// Refers to the scenario, which has to outlive it.
[[nodiscard]] ModelInput model_input(const CheckedScenario& scenario);

}  // namespace monograin
