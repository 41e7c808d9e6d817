/// Motions of scenarios that a test runs.
#pragma once

#include "exchange/motion.hpp"
#include "history/run.hpp"

namespace monograin {

[[nodiscard]] inline Motion motion_of_run(const CheckedScenario& scenario) {
  return motion_of(scenario, record_run(scenario).history);
}

}  // namespace monograin
