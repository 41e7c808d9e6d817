/// The tables [free] and [prior] of a calibration file. For readers of TOML files: includes the library.
#pragma once

#include <string>
#include <vector>

#include "scenario/section.hpp"
#include "study/calibrate/calibration.hpp"

namespace monograin::calibration {

/// The scenario whose numbers are free, with the text into which fitted numbers are put.
struct ScenarioText {
  const CheckedScenario& checked;
  const std::string& text;
  const std::string& file;
};

/// The free parameters in the file's order. Reports missing bounds, and numbers that the scenario cannot take.
[[nodiscard]] std::vector<FreeParameter> free_in(Reading& reading, const Section& root, const ScenarioText& scenario);

/// Adds the priors of `[prior]` to the parameters; a uniform distribution tightens their bounds.
void read_priors(Reading& reading, const Section& root, const CheckedScenario& scenario,
                 std::vector<FreeParameter>& free);

}  // namespace monograin::calibration
