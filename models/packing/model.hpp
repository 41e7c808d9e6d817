/// Model `packing`.
#pragma once

#include <span>
#include <string_view>

#include "packing/law.hpp"
#include "system/model.hpp"

namespace monograin::packing {

[[nodiscard]] Model model() noexcept;

/// Regimes as the history names them, in the order of Regime.
[[nodiscard]] std::span<const std::string_view> regime_words() noexcept;

/// The law that a scenario asks for. @throws std::invalid_argument where its parameters make no law
[[nodiscard]] Law law_of(const ModelInput& input);

/// Packing fraction at the start: the key initial_packing_fraction, or Phi_J without it.
[[nodiscard]] double initial_packing_fraction(const ModelInput& input, const Law& law);

/// Options that a drawn scene may set to other words than the default.
[[nodiscard]] std::span<const OptionKey> options() noexcept;

}  // namespace monograin::packing
