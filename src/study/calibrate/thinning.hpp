/// Thinning of data for a search that only has to come near its minimum.
#pragma once

#include <cstddef>

#include "study/calibrate/calibration.hpp"

namespace monograin {

/// The calibration with about `rows` rows of its data: the turning points of x, and others evenly between them. Noise
/// of x does not add to the path.
/// @param rows  less than the number of rows
[[nodiscard]] Calibration thinned(const Calibration& calibration, std::size_t rows);

}  // namespace monograin
