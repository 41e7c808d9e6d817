/// Scenarios of the compressible contact law: R0 = 1, and a yield pressure of 1/pi, so that forces are f and works are
/// W/(pi R0^3 sigma_y0).
#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "support/test_run.hpp"

namespace monograin {

struct CompressibleNumbers {
  double k = 2.0, delta_t = 0.15, a = 3.0;
  double stiffness_ratio = 50.0, nu0 = 0.25;
  double alpha = 1.2, beta = 2.0;
};

[[nodiscard]] inline CheckedScenario compressible_scenario(Configuration configuration,
                                                           const CompressibleNumbers& numbers,
                                                           std::vector<Step> steps) {
  CheckedScenario scenario = hertz_scenario(configuration, std::move(steps));
  scenario.model = "compressible";
  scenario.material = {
      {"stiffness_ratio", numbers.stiffness_ratio}, {"nu0", numbers.nu0}, {"yield_pressure", 1.0 / std::numbers::pi}};
  scenario.options = {{"k", numbers.k},         {"delta_t", numbers.delta_t}, {"a", numbers.a},
                      {"alpha", numbers.alpha}, {"beta", numbers.beta},       {"unloading_table", std::string()}};
  return scenario;
}

}  // namespace monograin
