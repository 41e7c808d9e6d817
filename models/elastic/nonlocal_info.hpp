/// The entry of model `nonlocal` in the catalogue.
#pragma once

#include "catalogue.hpp"

namespace monograin::nonlocal {

[[nodiscard]] ModelInfo nonlocal_info() noexcept;

}  // namespace monograin::nonlocal
