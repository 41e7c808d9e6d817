/// Catalogue entry of the contact law: keys, regimes, limits.
#pragma once

#include "catalogue.hpp"

namespace monograin::compressible {

[[nodiscard]] ModelInfo contact_info() noexcept;

}  // namespace monograin::compressible
