/// Causes that make the equations of a model hard to integrate.
#pragma once

#include <string>

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

/// Margin to a limit of the equations, 1 far from it and 0 at it, below which integrators may fail: errors grow with
/// its reciprocal.
inline constexpr double k_hard_margin = 1e-3;
/// Bulk modulus over the yield pressure from which on integrators may fail.
inline constexpr double k_stiff_modulus = 1e5;

/// The message for a difficulty: the cause, and what the user can do. No full stop at the end.
[[nodiscard]] std::string advice(Difficulty difficulty);

}  // namespace monograin
