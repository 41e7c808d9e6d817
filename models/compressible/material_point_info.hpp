/// The entry of model material-point in the catalogue, and what its keys mean to the law.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "catalogue.hpp"
#include "compressible/properties.hpp"

namespace monograin::compressible {

[[nodiscard]] ModelInfo material_point_info() noexcept;

/// @param material     values of the keys of `[material]`; keys that the yield model does not use may be absent
/// @param yield_model  vm, dpc or vmdc
[[nodiscard]] Parameters parameters_from(const std::map<std::string, double>& material, std::string_view yield_model);

/// Where the linear laws or the yield surface have no meaning before the first step.
[[nodiscard]] std::vector<Objection> start_objections(const Parameters& parameters);

}  // namespace monograin::compressible
