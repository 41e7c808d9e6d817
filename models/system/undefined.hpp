/// The value of what is not defined.
#pragma once

#include <limits>

namespace monograin {

inline constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace monograin
