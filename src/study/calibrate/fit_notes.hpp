/// Remarks on a fit that its user should know.
#pragma once

#include <string>
#include <vector>

#include "study/calibrate/calibration.hpp"

namespace monograin {

/// Notes parameters that the data do not determine, bounds that were reached, noise of another size, priors that are
/// contradicted, residuals that are no noise, trial runs that failed.
/// @param result  with all but its notes and warnings
[[nodiscard]] std::vector<std::string> notes_of(const Calibration& calibration, const CalibrationResult& result);

}  // namespace monograin
