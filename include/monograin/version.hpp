/// Version of the library.
#pragma once

#include <string_view>

namespace monograin {

/// Version of the library, e.g. "0.1.0".
[[nodiscard]] std::string_view version() noexcept;

}  // namespace monograin
