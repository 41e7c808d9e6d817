/// Materials and options of the stress test's scenes, from the whole admissible space of every model and from its
/// edges.
#pragma once

#include "study/dice.hpp"
#include "study/stress_scene.hpp"

namespace monograin {

/// What the programs of a scene are made of.
struct StressBounds {
  double deepest = 0.45;  ///< most displacement of an ordinary step in R0; or strain, or packing fraction
  double force = 1.0;     ///< that a wall bears there, about, in S R0^2; or stress in S
  double tension = 0.0;   ///< of the order of pull-off, in S R0^2
  bool only_loads = false;
  double start = 0.0;  ///< packing fraction at the start
};

/// Draws a model for a scene, its configuration, material and options.
[[nodiscard]] StressBounds draw_material(Dice& dice, StressScene& scene);

}  // namespace monograin
