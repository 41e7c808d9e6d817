// From a checked scenario to the hybrid system of its model.

#include <fmt/format.h>

#include <stdexcept>

#include "compressible/contact_system.hpp"
#include "compressible/material_point.hpp"
#include "compressible/material_point_info.hpp"
#include "elastic/hertz.hpp"
#include "elastic/nonlocal_system.hpp"
#include "hertz/law.hpp"
#include "mdr/system.hpp"
#include "packing/system.hpp"
#include "plastic/system.hpp"
#include "scene/choice.hpp"
#include "scene/compressible_law.hpp"
#include "scene/mdr_law.hpp"
#include "scene/nonlocal_model.hpp"
#include "scene/packing_law.hpp"
#include "scene/plastic_law.hpp"
#include "scene/scene.hpp"

namespace monograin {
namespace {

mdr::Settings common_settings(const Scenario& scenario, const Reach& reach) {
  mdr::Settings settings;
  settings.largest_displacement = reach.displacement;
  settings.largest_force = reach.force;
  settings.initial_radius = scenario.radius;
  settings.youngs_modulus = scenario.material.at("youngs_modulus");
  settings.poisson_ratio = scenario.material.at("poisson_ratio");
  settings.centre_is_free = scenario.loading.centre_is_free;
  return settings;
}

mdr::Settings hertz_settings(const Scenario& scenario, const Reach& reach) {
  mdr::Settings settings = common_settings(scenario, reach);
  settings.elastic_profile = mdr::ElasticProfile::parabola;
  settings.radius_rule = mdr::RadiusRule::fixed;
  return settings;
}

mdr::Settings mdr_settings(const Scenario& scenario, const Reach& reach) {
  using namespace mdr;
  Settings settings = common_settings(scenario, reach);
  settings.yield_stress = scenario.material.at("yield_stress");
  settings.surface_energy = scenario.material.at("surface_energy");
  settings.radius_rule =
      choice<RadiusRule>(scenario, "radius_rule",
                         {{"gated", RadiusRule::gated}, {"yielded", RadiusRule::yielded}, {"seed", RadiusRule::seed}});
  settings.elastic_profile = choice<ElasticProfile>(
      scenario, "elastic_profile", {{"ellipse", ElasticProfile::ellipse}, {"parabola", ElasticProfile::parabola}});
  settings.delta_max_rule =
      choice<DeltaMaxRule>(scenario, "delta_max_rule",
                           {{"running-maximum", DeltaMaxRule::running_maximum}, {"shifted", DeltaMaxRule::shifted}});
  settings.stops_at_cap_intersection = std::get<bool>(scenario.options.at("strict"));
  settings.pressure_curve = pressure_curve_of(scenario);
  return settings;
}

plastic::Settings plastic_settings(const Scenario& scenario, const Reach& reach) {
  using namespace plastic;
  const bool is_semimech = scenario.model == "semimech";
  Settings settings{.law = plastic_law_of(scenario),
                    .initial_radius = scenario.radius,
                    .strength = plastic_strength_of(scenario),
                    .largest_displacement = reach.displacement,
                    .largest_force = reach.force};
  settings.unloading = choice<Unloading>(scenario, "unloading", {{"none", Unloading::none}, {"mdr", Unloading::mdr}});
  if (settings.unloading == Unloading::mdr) {
    settings.poisson_ratio = scenario.material.at("poisson_ratio");
    settings.composite_modulus = composite_modulus(scenario.material.at("youngs_modulus"), settings.poisson_ratio);
  }
  if (is_semimech) {
    settings.out_of_range =
        outside_calibration(scenario.material.at("youngs_modulus"), scenario.material.at("poisson_ratio"),
                            settings.strength, std::get<SemimechLaw>(settings.law).configuration);
  }
  return settings;
}

nonlocal::Settings nonlocal_settings(const Scenario& scenario, const Reach& reach) {
  using namespace nonlocal;
  Settings settings{.model = nonlocal_model_of(scenario),
                    .initial_radius = scenario.radius,
                    .youngs_modulus = scenario.material.at("youngs_modulus"),
                    .centre = scenario.loading.centre_is_free ? Centre::free : Centre::fixed,
                    .largest_displacement = reach.displacement,
                    .largest_force = reach.force};
  settings.radius_rule = choice<RadiusRule>(scenario, "contact_radius_rule",
                                            {{"closed", RadiusRule::closed},
                                             {"integral", RadiusRule::integral},
                                             {"projected", RadiusRule::projected},
                                             {"none", RadiusRule::none}});
  return settings;
}

compressible::ContactSettings compressible_settings(const Scenario& scenario, const Reach& reach) {
  const CompressibleLaw law = compressible_law_of(scenario);
  return {.law = law.loading,
          .hertz_stiffness = law.hertz_stiffness,
          .unloading = law.unloading,
          .initial_radius = scenario.radius,
          .yield_pressure = scenario.material.at("yield_pressure"),
          .reservations = law.reservations,
          .largest_displacement = reach.displacement,
          .largest_force = reach.force};
}

/// @throws std::invalid_argument where the material has no meaning at the start: a fit tries such numbers too
compressible::MaterialPoint::Settings material_point_settings(const Scenario& scenario) {
  const auto parameters =
      compressible::parameters_from(scenario.material, std::get<std::string>(scenario.options.at("yield_model")));
  const std::vector<Objection> objections = compressible::start_objections(parameters);
  if (!objections.empty()) throw std::invalid_argument(objections.front().message);
  return {.parameters = parameters,
          .yield_pressure = scenario.material.at("yield_pressure"),
          .is_hydrostatic = scenario.loading.configuration == Loading::Configuration::hydrostatic};
}

}  // namespace

std::unique_ptr<HybridSystem> bind_model(const Scenario& scenario, std::vector<ContactClass> classes,
                                         const Reach& reach) {
  // With a free centre, a Hertz particle is an MDR particle that neither yields nor grows.
  if (scenario.model == "hertz" && !scenario.loading.centre_is_free) {
    const double modulus =
        composite_modulus(scenario.material.at("youngs_modulus"), scenario.material.at("poisson_ratio"));
    return std::make_unique<hertz::System>(hertz::WallLaw{modulus},
                                           contacts::Settings{scenario.radius, reach.displacement, reach.force},
                                           std::move(classes));
  }
  if (scenario.model == "hertz") {
    return std::make_unique<mdr::System>(hertz_settings(scenario, reach), std::move(classes));
  }
  if (scenario.model == "mdr") {
    return std::make_unique<mdr::System>(mdr_settings(scenario, reach), std::move(classes));
  }
  if (is_plastic(scenario.model)) {
    return std::make_unique<plastic::System>(plastic_settings(scenario, reach), std::move(classes));
  }
  if (scenario.model == "nonlocal") {
    return std::make_unique<nonlocal::System>(nonlocal_settings(scenario, reach), std::move(classes));
  }
  if (scenario.model == "compressible") {
    return std::make_unique<compressible::ContactSystem>(compressible_settings(scenario, reach), std::move(classes));
  }
  if (scenario.model == "packing") {
    const packing::Law law = packing_law_of(scenario);
    return std::make_unique<packing::System>(law, initial_packing_fraction_of(scenario, law));
  }
  if (scenario.model == "material-point") {
    return std::make_unique<compressible::MaterialPoint>(material_point_settings(scenario));
  }
  throw std::logic_error(fmt::format("model '{}' is in the catalogue but not bound", scenario.model));
}

std::vector<Channel> channels_without_walls(const Scenario& scenario) {
  if (scenario.model == "packing") {
    const double initial = initial_packing_fraction_of(scenario, packing_law_of(scenario));
    return {{"packing", {initial, initial, Control::packing_fraction}, scenario.loading.steps}};
  }
  using Configuration = Loading::Configuration;
  const Configuration configuration = scenario.loading.configuration;
  std::vector<Channel> channels{{"axial", {0.0, 0.0, Control::strain}, scenario.loading.steps}};
  if (configuration == Configuration::hydrostatic) return channels;
  const bool is_free = configuration == Configuration::simple || configuration == Configuration::triaxial;
  Channel lateral{"lateral", {0.0, 0.0, is_free ? Control::stress : Control::strain}, {}};
  for (const Step& step : scenario.loading.steps) {
    Step follows;  // takes as long as the axial one
    if (step.lateral) {
      follows.kind = step.lateral->kind;
      follows.target = step.lateral->target;
    }
    lateral.program.push_back(std::move(follows));
  }
  channels.push_back(std::move(lateral));
  return channels;
}

}  // namespace monograin
