/// How a model tells for which materials its pull-off can be trusted, after how much flattening.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "system/walls.hpp"

namespace monograin {

/// A contact of a particle pressed between two walls without adhesion, as a run with R0 = 1 m and E = 1 Pa shows it.
struct FlattenedContact {
  double modulus_over_yield = 0.0;  ///< E/Y of the material, which may be above that of the run
  double poisson_ratio = 0.0;
  double displacement = 0.0;     ///< of each wall, delta_o,max/R0
  double apparent_radius = 0.0;  ///< R/R0
  double overlap = 0.0;          ///< delta/R0
  double contact_radius = 0.0;   ///< a/R0
  bool has_yielded = false;
};

struct AdhesionMap {
  std::string_view scenario;  ///< text of the scenario that flattens the particle: R0 = 1 m, E = 1 Pa, one step
  double stiffest_run = 0.0;  ///< E/Y above which radii are those of a rigid-plastic particle
  std::string_view yielded;   ///< regime of a contact that has yielded
  std::span<const std::string_view> classes;  ///< of materials, as a legend names them; the first one: valid
  /// Finds the class of a material, as an index into `classes`.
  /// @param modulus       E* R0/dg
  /// @param yield_stress  Y R0/dg
  /// @param control       at pull-off
  std::size_t (*classify)(const FlattenedContact& contact, double modulus, double yield_stress,
                          Control control) = nullptr;
};

}  // namespace monograin
