/// What users are told of the contact law of this folder.
#pragma once

#include "catalogue.hpp"

namespace monograin::compressible {

[[nodiscard]] ModelInfo contact_info() noexcept;

}  // namespace monograin::compressible
