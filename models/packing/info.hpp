/// What the catalogue says of the packing.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "catalogue.hpp"
#include "packing/law.hpp"

namespace monograin::packing {

[[nodiscard]] ModelInfo packing_info() noexcept;

/// Regimes as the history names them, in the order of Regime.
[[nodiscard]] std::span<const std::string_view> regime_words() noexcept;

/// Parameters of a law from the values of the keys in `[material]` and `[packing]`, which have all but the hardening
/// modulus; without that the particles are elastic.
/// @param value       of a key's name
/// @param coupling    published or consistent
[[nodiscard]] Parameters parameters_from(const std::function<std::optional<double>(const char*)>& value,
                                         std::string_view coupling, bool has_continuous_jamming);

}  // namespace monograin::packing
