/// The entries of this folder's models in the catalogue.
#pragma once

#include "catalogue.hpp"

namespace monograin::plastic {

[[nodiscard]] ModelInfo similarity_info() noexcept;
[[nodiscard]] ModelInfo semimech_info() noexcept;
[[nodiscard]] ModelInfo hardening_info() noexcept;

}  // namespace monograin::plastic
