/// The map of where the model's pull-off can be trusted: test F.7 on contacts of flattened particles.
///
/// Source: Zunker and Kamrin (2024), Appendix F.2 (F.7, Fig. F.21). Lengths are in R0.
#pragma once

#include "mdr/adhesion_validity.hpp"
#include "system/adhesion_map.hpp"

namespace monograin::mdr {

extern const AdhesionMap k_adhesion_map;

/// Indenter that a flattened contact leaves when it unloads; for a contact that has not yielded, the elastic one.
[[nodiscard]] Indenter flattened_indenter(const FlattenedContact& contact);

/// r_peak/R0 of a flattened contact by the fit F.1.
[[nodiscard]] double flattened_peak_radius(const FlattenedContact& contact);

}  // namespace monograin::mdr
