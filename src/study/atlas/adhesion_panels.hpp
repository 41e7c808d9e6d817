/// The phase diagrams of adhesion as panels of a figure.
#pragma once

#include <vector>

#include "figure/chart.hpp"
#include "study/atlas/adhesion_map.hpp"

namespace monograin {

/// One panel for each diagram: Y R0/dg over E* R0/dg, both logarithmic, with an area for each class.
[[nodiscard]] std::vector<figure::ChartPanel> adhesion_panels(const std::vector<AdhesionDiagram>& diagrams);

}  // namespace monograin
