/// Programs of the stress test's scenes.
#pragma once

#include <cstddef>
#include <vector>

#include "stress_test/dice.hpp"
#include "stress_test/draw.hpp"
#include "verify/stress/draw/scene.hpp"

namespace monograin {

/// Draws displacements, forces, holds and withdrawals of walls, with and without conditions.
/// @param gap          in R0, at which the walls start
/// @param takes_rates  some ramps get a rate instead of a duration
/// @param may_detach   some steps withdraw the walls
[[nodiscard]] std::vector<StressStep> draw_program(Dice& dice, const StressScene& scene, const ProgramBounds& bounds,
                                                   std::size_t count, double gap, bool takes_rates, bool may_detach);

/// Converts the program that a model without walls has drawn.
[[nodiscard]] std::vector<StressStep> stress_steps(const std::vector<DrawnStep>& program);

}  // namespace monograin
