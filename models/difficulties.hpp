/// Difficulties that several models have.
#pragma once

#include <string_view>

namespace monograin {

/// Of a program whose deepest contact is made of rounding.
inline constexpr std::string_view k_closes_nothing =
    "the program closes no contact by more than 1e-12 of the particle's radius, which is rounding; expected a deeper "
    "one, or integrator = \"direct\"";

}  // namespace monograin
