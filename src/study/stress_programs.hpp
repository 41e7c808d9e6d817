/// Programs of the stress test's scenes.
#pragma once

#include <cstddef>
#include <vector>

#include "study/dice.hpp"
#include "study/stress_materials.hpp"
#include "study/stress_scene.hpp"

namespace monograin {

/// Of walls: displacements, forces, holds and withdrawals, with and without conditions.
/// @param gap  where the walls start
[[nodiscard]] std::vector<StressStep> draw_program(Dice& dice, const StressScene& scene, const StressBounds& bounds,
                                                   std::size_t count, double gap, bool takes_rates, bool may_detach);

/// Of a packing: packing fractions, strains and stresses.
[[nodiscard]] std::vector<StressStep> draw_packing_program(Dice& dice, const StressScene& scene,
                                                           const StressBounds& bounds, std::size_t count);

/// Of a material point: what its configuration lets the two directions do.
[[nodiscard]] std::vector<StressStep> draw_point_program(Dice& dice, const StressScene& scene,
                                                         const StressBounds& bounds, std::size_t count);

}  // namespace monograin
