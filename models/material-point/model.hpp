/// Model `material-point`, and its parameters from the keys of a scenario.
#pragma once

#include <vector>

#include "material-point/properties.hpp"
#include "system/model.hpp"

namespace monograin::material_point {

[[nodiscard]] Model model() noexcept;

/// Parameters of the material from a scenario's keys. Keys that the yield model does not use may be absent.
[[nodiscard]] Parameters parameters_of(const ModelInput& input);

/// Objections to a material whose linear laws or yield surface have no meaning before the first step.
[[nodiscard]] std::vector<Objection> start_objections(const Parameters& parameters);

}  // namespace monograin::material_point
