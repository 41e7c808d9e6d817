/// Charts of recorded runs of a model without walls: its quantities over the quantity through which it is driven.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "figure/chart.hpp"

namespace monograin::figure {

/// Chart of one or more runs of a model without walls.
/// @param runs  folders, or paths of their history.csv
/// @return nothing if the first run's history is not of such a model
/// @throws FigureError when a file cannot be read, or another run is of another model
[[nodiscard]] std::optional<Chart> body_chart(const std::vector<std::filesystem::path>& runs);

}  // namespace monograin::figure
