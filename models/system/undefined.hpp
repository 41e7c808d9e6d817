/// Value of an undefined quantity.
#pragma once

#include <limits>

namespace monograin {

/// Quiet NaN: marks a quantity that is undefined, such as the pressure of an open contact.
inline constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace monograin
