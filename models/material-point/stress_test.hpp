/// Stress test of model `material-point`: draws scenes, and checks their histories.
#pragma once

#include <cstddef>
#include <vector>

#include "stress_test/checks.hpp"
#include "stress_test/draw.hpp"

namespace monograin::material_point {

/// Draws a material around the sets of the source's Tables 4 to 6.
[[nodiscard]] ProgramBounds draw(Dice& dice, DrawnMaterial& drawn);
[[nodiscard]] std::vector<DrawnStep> draw_program(Dice& dice, const DrawnMaterial& drawn, const ProgramBounds& bounds,
                                                  std::size_t count);
void check(const CheckedRun& run, std::vector<Violation>& found);

}  // namespace monograin::material_point
