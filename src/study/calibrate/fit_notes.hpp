/// Notes on a fit for its user.
#pragma once

#include <string>
#include <vector>

#include "study/calibrate/calibration.hpp"

namespace monograin {

/// Notes on parameters that the data do not determine, bounds that were reached, noise of another size than given,
/// priors that the data contradict, residuals that are not independent, and trial runs that failed.
/// @param result  complete but for its notes and warnings
[[nodiscard]] std::vector<std::string> notes_of(const Calibration& calibration, const CalibrationResult& result);

}  // namespace monograin
