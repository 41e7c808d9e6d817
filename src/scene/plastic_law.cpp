#include "scene/plastic_law.hpp"

namespace monograin {
namespace {

/// Walls of other sets are each for themselves, in the one law that allows them.
plastic::Configuration configuration_of(const Scenario& scenario) {
  switch (scenario.loading.configuration) {
    case Loading::Configuration::die:
      return plastic::Configuration::die;
    case Loading::Configuration::hydrostatic:
      return plastic::Configuration::hydrostatic;
    default:
      return plastic::Configuration::simple;
  }
}

}  // namespace

plastic::Law plastic_law_of(const Scenario& scenario) {
  const auto& material = scenario.material;
  if (scenario.model == "semimech") {
    return plastic::make_semimech(
        plastic::make_semimech_material(material.at("youngs_modulus"), material.at("poisson_ratio"),
                                        material.at("yield_stress")),
        configuration_of(scenario));
  }
  const double exponent = material.at("hardening_exponent");
  if (scenario.model == "hardening") {
    const bool is_ideal = std::get<std::string>(scenario.options.at("minimum_condition")) == "ideal";
    return plastic::make_hardening(exponent, configuration_of(scenario),
                                   is_ideal ? plastic::MinimumCondition::ideal : plastic::MinimumCondition::current);
  }
  const bool is_corrected = std::get<bool>(scenario.options.at("curvature_correction"));
  return plastic::make_similarity(
      exponent, is_corrected ? plastic::SimilarityRadius::corrected : plastic::SimilarityRadius::parabolic);
}

}  // namespace monograin
