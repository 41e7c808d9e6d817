/// Stress test of model `material-point`: draws scenes, and checks their histories.
#pragma once

#include <cstddef>
#include <vector>

#include "stress/checks.hpp"
#include "stress/draw.hpp"

namespace monograin::compressible {

/// Draws a material around the sets of the source's Tables 4 to 6.
[[nodiscard]] ProgramBounds draw_material_point(Dice& dice, DrawnMaterial& drawn);
[[nodiscard]] std::vector<DrawnStep> draw_material_point_program(Dice& dice, const DrawnMaterial& drawn,
                                                                 const ProgramBounds& bounds, std::size_t count);
void check_material_point(const CheckedRun& run, std::vector<Violation>& found);

}  // namespace monograin::compressible
