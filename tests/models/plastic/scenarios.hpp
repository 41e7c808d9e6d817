/// Scenarios of the plastic laws: a unit sphere, stresses in any unit.
#pragma once

#include <string>
#include <vector>

#include "support/test_run.hpp"

namespace monograin {

[[nodiscard]] inline CheckedScenario plastic_scenario(const std::string& model, Configuration configuration,
                                                      std::vector<Step> steps) {
  CheckedScenario scenario = hertz_scenario(configuration, std::move(steps));
  scenario.model = model;
  scenario.material.clear();
  scenario.options["unloading"] = std::string("none");
  return scenario;
}

[[nodiscard]] inline CheckedScenario semimech_scenario(Configuration configuration, double youngs_modulus,
                                                       double poisson_ratio, double yield_stress,
                                                       std::vector<Step> steps) {
  CheckedScenario scenario = plastic_scenario("semimech", configuration, std::move(steps));
  scenario.material = {
      {"youngs_modulus", youngs_modulus}, {"poisson_ratio", poisson_ratio}, {"yield_stress", yield_stress}};
  return scenario;
}

[[nodiscard]] inline CheckedScenario hardening_scenario(Configuration configuration, double strength, double exponent,
                                                        std::vector<Step> steps) {
  CheckedScenario scenario = plastic_scenario("hardening", configuration, std::move(steps));
  scenario.material = {{"strength", strength}, {"hardening_exponent", exponent}};
  scenario.options["minimum_condition"] = std::string("current");
  return scenario;
}

[[nodiscard]] inline CheckedScenario similarity_scenario(Configuration configuration, double strength, double exponent,
                                                         std::vector<Step> steps) {
  CheckedScenario scenario = plastic_scenario("similarity", configuration, std::move(steps));
  scenario.material = {{"strength", strength}, {"hardening_exponent", exponent}};
  scenario.options["curvature_correction"] = false;
  return scenario;
}

/// A scenario with elastic constants, and unloading by the indenter of model mdr.
[[nodiscard]] inline CheckedScenario unloading(CheckedScenario scenario, double youngs_modulus, double poisson_ratio) {
  scenario.material["youngs_modulus"] = youngs_modulus;
  scenario.material["poisson_ratio"] = poisson_ratio;
  return with(std::move(scenario), "unloading", "mdr");
}

}  // namespace monograin
