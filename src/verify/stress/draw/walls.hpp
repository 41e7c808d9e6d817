/// Walls of the stress test's scenes: all around, opposite each other, at right angles, nearly parallel.
#pragma once

#include <array>
#include <vector>

#include "stress_test/dice.hpp"

namespace monograin {

/// Draws the normals of a rectangular cell: four walls in a plane, or six. In some scenes one side is open.
[[nodiscard]] std::vector<std::array<double, 3>> draw_cell(Dice& dice);

/// Draws the normals of two to six walls, every two of them at least `least_angle` [rad] apart.
[[nodiscard]] std::vector<std::array<double, 3>> draw_normals(Dice& dice, double least_angle);

}  // namespace monograin
