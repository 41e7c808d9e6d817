/// Scenarios as Python holds them.
#pragma once

#include "monograin/scenario.hpp"
#include "scenario/scenario.hpp"

namespace monograin::python {

/// A scenario that was checked when it was made, and never changes.
struct SoundScenario {
  Scenario source;
  CheckedScenario checked;
  double parse_time = 0.0;  ///< [s]
};

}  // namespace monograin::python
