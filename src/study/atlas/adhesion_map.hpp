/// Phase diagrams of adhesion: the materials and the flattening for which the model's pull-off is valid.
///
/// Source: Zunker and Kamrin (2024), Appendix F.2 (F.7, Fig. F.21), which leaves Poisson's ratio and xi open. Poisson's
/// ratio enters through the growth of the apparent radius. Lengths are in R0.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "system/adhesion_map.hpp"

namespace monograin {

/// Presses a particle between two walls with the engine, by the scenario of the model that offers the map.
///
/// @param modulus_over_yield  E/Y > 0, finite (not E*/Y)
/// @param poisson_ratio       in (-1, 0.5]
/// @param displacements       delta_o,max/R0, ascending, > 0
/// @return one contact for each displacement
/// @throws std::invalid_argument for arguments out of range; std::runtime_error if the run ends early, because the
/// model does not reach that far
[[nodiscard]] std::vector<FlattenedContact> flatten(double modulus_over_yield, double poisson_ratio,
                                                    std::span<const double> displacements);

/// Axes and cases of the diagrams. Both axes are logarithmic with the same step, so that materials of the same E/Y lie
/// on diagonals and share one run.
struct AdhesionMapSettings {
  double least_modulus = 1e2;               ///< E* R0/dg of the first column, > 0
  double least_yield_stress = 1e1;          ///< Y R0/dg of the first row, > 0
  double decades = 8.0;                     ///< of both axes, > 0
  std::size_t points = 200;                 ///< on each axis, >= 2
  double poisson_ratio = 0.3;               ///< in (-1, 0.5]
  Control control = Control::displacement;  ///< at pull-off: xi = 1 under displacement, 3 under force control
  std::vector<double> displacements{0.1, 0.2, 0.3, 0.4, 0.5};  ///< delta_o,max/R0, ascending: one diagram each
};

/// One diagram (one panel of Fig. F.21).
struct AdhesionDiagram {
  double displacement = 0.0;                  ///< delta_o,max/R0
  std::span<const std::string_view> legends;  ///< of the classes
  std::vector<double> modulus;                ///< E* R0/dg of the columns
  std::vector<double> yield_stress;           ///< Y R0/dg of the rows
  std::vector<std::size_t> classes;           ///< row by row, as indices into the legends

  [[nodiscard]] std::size_t at(std::size_t row, std::size_t column) const {
    return classes[row * modulus.size() + column];
  }
};

/// Classes of all points of all diagrams.
/// @throws std::invalid_argument for settings out of range; errors of flatten
[[nodiscard]] std::vector<AdhesionDiagram> adhesion_maps(const AdhesionMapSettings& settings);

}  // namespace monograin
