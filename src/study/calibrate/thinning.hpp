/// Fewer rows of many, for a search that only has to come near its minimum.
#pragma once

#include <cstddef>

#include "study/calibrate/calibration.hpp"

namespace monograin {

/// The calibration with about `rows` rows of its data: those in which x turns and others evenly between them, without
/// the noise of x on the path.
/// @param rows  fewer than there are
[[nodiscard]] Calibration thinned(const Calibration& calibration, std::size_t rows);

}  // namespace monograin
