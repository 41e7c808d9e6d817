/// Stress test of model `packing`: draws scenes, and checks their histories.
#pragma once

#include <cstddef>
#include <vector>

#include "stress_test/checks.hpp"
#include "stress_test/draw.hpp"

namespace monograin::packing {

/// Draws a material, starting from the published set. The generator repeats a draw that is not admissible.
[[nodiscard]] ProgramBounds draw(Dice& dice, DrawnMaterial& drawn);
[[nodiscard]] std::vector<DrawnStep> draw_program(Dice& dice, const DrawnMaterial& drawn, const ProgramBounds& bounds,
                                                  std::size_t count);
void check(const CheckedRun& run, std::vector<Violation>& found);

}  // namespace monograin::packing
