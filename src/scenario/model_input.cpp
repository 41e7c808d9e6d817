#include "scenario/model_input.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "catalogue.hpp"

namespace monograin {
namespace {

std::string_view configuration_word(Loading::Configuration configuration) {
  switch (configuration) {
    case Loading::Configuration::simple:
      return "simple";
    case Loading::Configuration::die:
      return "die";
    case Loading::Configuration::hydrostatic:
      return "hydrostatic";
    case Loading::Configuration::oblique_die:
      return "oblique-die";
    case Loading::Configuration::walls:
      return "walls";
    case Loading::Configuration::triaxial:
      return "triaxial";
    case Loading::Configuration::strain_path:
      return "strain-path";
  }
  return {};
}

PlannedStep planned(const Step& step) {
  PlannedStep result{.may_end_early = !step.until.empty()};
  if (const auto control = control_of(step.kind)) result.first = {*control, step.target};
  if (step.lateral) result.lateral = {*control_of(step.lateral->kind), step.lateral->target};
  return result;
}

}  // namespace

ModelInput model_input(const CheckedScenario& scenario) {
  const Model& model = *find_model(scenario.model);
  ModelInput input{.radius = scenario.radius,
                   .values = scenario.material,
                   .options = scenario.options,
                   .curves = scenario.curves,
                   .centre_is_free = scenario.loading.centre_is_free,
                   .integrator = scenario.numerics.integrator};
  if (!model.configurations.empty()) input.configuration = configuration_word(scenario.loading.configuration);
  if (!model.has_walls()) std::ranges::transform(scenario.loading.steps, std::back_inserter(input.program), planned);
  return input;
}

}  // namespace monograin
