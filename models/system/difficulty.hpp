/// What makes the equations of a model hard to integrate.
#pragma once

#include <string_view>

namespace monograin {

/// What an integrator that gives up has met. The model asks for it at the state where that happened.
enum class Difficulty {
  below_resolution,          ///< the deepest contact of the program is round-off
  stiff_material,            ///< stresses are small differences of strains
  hardly_unique,             ///< plastic strain is hardly determined
  singular_balance,          ///< only idle contacts constrain the free centre
  near_applicability_limit,  ///< the stiffness magnifies tolerated errors
  soft_centre                ///< the tangent stiffness of the free centre nearly vanishes
};

/// The message for a difficulty, and what to do; no full stop.
[[nodiscard]] std::string_view advice(Difficulty difficulty) noexcept;

}  // namespace monograin
