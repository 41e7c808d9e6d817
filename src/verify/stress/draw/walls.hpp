/// Walls of the stress test's scenes: all around, opposite each other, at right angles, nearly parallel.
#pragma once

#include <array>
#include <vector>

#include "stress/dice.hpp"

namespace monograin {

/// Normals of a cell at right angles, around one plane or all around, in some scenes with a side left open.
[[nodiscard]] std::vector<std::array<double, 3>> draw_cell(Dice& dice);

/// Normals of two to six walls, no two of them nearer than an angle.
[[nodiscard]] std::vector<std::array<double, 3>> draw_normals(Dice& dice, double least_angle);

}  // namespace monograin
