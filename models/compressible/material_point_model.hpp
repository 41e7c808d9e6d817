/// Model `material-point`, and what its keys mean to the law.
#pragma once

#include <vector>

#include "compressible/properties.hpp"
#include "system/model.hpp"

namespace monograin::compressible {

[[nodiscard]] Model material_point_model() noexcept;

/// Keys that the yield model does not use may be absent.
[[nodiscard]] Parameters parameters_of(const ModelInput& input);

/// Where the linear laws or the yield surface have no meaning before the first step.
[[nodiscard]] std::vector<Objection> start_objections(const Parameters& parameters);

}  // namespace monograin::compressible
