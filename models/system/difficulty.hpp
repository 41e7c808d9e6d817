/// Causes that make the equations of a model hard to integrate.
#pragma once

#include <string_view>

namespace monograin {

/// Why an integrator has given up. The model finds the cause from the state at which the integrator stopped.
enum class Difficulty {
  below_resolution,          ///< the deepest contact of the program is round-off
  stiff_material,            ///< stresses are small differences of strains
  hardly_unique,             ///< plastic strain is hardly determined
  singular_balance,          ///< only idle contacts constrain the free centre
  near_applicability_limit,  ///< the stiffness magnifies tolerated errors
  soft_centre                ///< the tangent stiffness of the free centre nearly vanishes
};

/// The message for a difficulty: the cause, and what the user can do. No full stop at the end.
[[nodiscard]] std::string_view advice(Difficulty difficulty) noexcept;

}  // namespace monograin
