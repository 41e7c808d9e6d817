/// The view that a model has of a checked scenario, and of a material of its tables.
#pragma once

#include <string>

#include "scenario/scenario.hpp"
#include "system/model.hpp"

namespace monograin {

/// Input of the model. It refers to the scenario, which has to outlive it.
[[nodiscard]] ModelInput model_input(const CheckedScenario& scenario);

/// Reason why a preset cannot run on its own, with the model's default options: the keys that it does not give, or the
/// first objection to its values. Empty if it can.
[[nodiscard]] std::string shortfall_of(const Preset& preset, const Model& model);

}  // namespace monograin
