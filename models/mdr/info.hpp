/// The entries of this folder's models in the catalogue; a Hertz particle is one that neither yields nor grows.
#pragma once

#include "catalogue.hpp"

namespace monograin::mdr {

[[nodiscard]] ModelInfo hertz_info() noexcept;
[[nodiscard]] ModelInfo mdr_info() noexcept;

}  // namespace monograin::mdr
