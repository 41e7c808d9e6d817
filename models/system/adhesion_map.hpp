/// Validity of a model's pull-off: for which materials, after how much flattening, it can be trusted.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "system/walls.hpp"

namespace monograin {

/// Contact of a particle that is pressed between two walls without adhesion, from a run with R0 = 1 m and E = 1 Pa.
struct FlattenedContact {
  double modulus_over_yield = 0.0;  ///< E/Y of the material; the run used at most AdhesionMap::stiffest_run
  double poisson_ratio = 0.0;
  double displacement = 0.0;     ///< displacement of each wall, delta_o,max/R0
  double apparent_radius = 0.0;  ///< R/R0
  double overlap = 0.0;          ///< delta/R0
  double contact_radius = 0.0;   ///< a/R0
  bool has_yielded = false;
};

/// Data and rule from which the atlas draws the map of valid pull-offs.
struct AdhesionMap {
  std::string_view scenario;  ///< text of the scenario that flattens the particle: R0 = 1 m, E = 1 Pa, one step
  double stiffest_run = 0.0;  ///< E/Y above which radii equal those of a rigid-plastic particle
  std::string_view yielded;   ///< name of the regime of a contact that has yielded
  std::span<const std::string_view> classes;  ///< names of the classes of materials in the legend, "valid" first
  /// Finds the class of a material, as an index into `classes`.
  /// @param contact       the flattened contact
  /// @param modulus       E* R0/dg, with the surface energy dg
  /// @param yield_stress  Y R0/dg
  /// @param control       controlled quantity at pull-off
  std::size_t (*classify)(const FlattenedContact& contact, double modulus, double yield_stress,
                          Control control) = nullptr;
};

}  // namespace monograin
