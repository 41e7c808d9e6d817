/// Programs of the stress test's scenes.
#pragma once

#include <cstddef>
#include <vector>

#include "stress/dice.hpp"
#include "stress/draw.hpp"
#include "verify/stress/draw/scene.hpp"

namespace monograin {

/// Displacements, forces, holds and withdrawals of walls, with and without conditions.
/// @param gap  where the walls start
[[nodiscard]] std::vector<StressStep> draw_program(Dice& dice, const StressScene& scene, const ProgramBounds& bounds,
                                                   std::size_t count, double gap, bool takes_rates, bool may_detach);

/// Steps of a model without walls, as its own drawing has them.
[[nodiscard]] std::vector<StressStep> stress_steps(const std::vector<DrawnStep>& program);

}  // namespace monograin
