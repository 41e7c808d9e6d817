/// What a figure shows of recorded runs of a model without walls: its columns over the one that it is driven through.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "figure/chart.hpp"

namespace monograin::figure {

/// @param runs  folders, or paths of their history.csv
/// @return nothing where the first run's history is not of such a model
/// @throws FigureError when a file cannot be read, or another run is of another model
[[nodiscard]] std::optional<Chart> body_chart(const std::vector<std::filesystem::path>& runs);

}  // namespace monograin::figure
