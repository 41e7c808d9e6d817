/// Materials of the source's tables, by the names of the keys in `[material]`.
#pragma once

#include <span>

#include "system/keys.hpp"

namespace monograin::material_point {

/// Rows of Tables 4 and 6 (whole materials) and of Table 5 (their stiffness ratio only). A model takes from them the
/// keys that it has.
/// Source: Edmans and Sinka (n.d.). Values are those at the reference density, 0.4 or 0.7.
[[nodiscard]] std::span<const Preset> presets() noexcept;

}  // namespace monograin::material_point
