/// The view that a model has of a checked scenario.
#pragma once

#include "scenario/scenario.hpp"
#include "system/model.hpp"

namespace monograin {

/// Input of the model. It refers to the scenario, which has to outlive it.
[[nodiscard]] ModelInput model_input(const CheckedScenario& scenario);

}  // namespace monograin
