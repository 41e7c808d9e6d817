#include "scenario/model_input.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "catalogue.hpp"
#include "scenario/language.hpp"

namespace monograin {
namespace {

PlannedStep planned(const Step& step) {
  PlannedStep result{.may_end_early = !step.until.empty()};
  if (const auto control = control_of(step.kind)) result.first = {*control, step.target};
  if (step.lateral) result.lateral = {*control_of(step.lateral->kind), step.lateral->target};
  return result;
}

/// Value of an option that a scenario does not give; none for a quantity without default.
std::optional<OptionValue> default_of(const OptionKey& option) {
  switch (option.kind) {
    case OptionKey::Kind::choice:
      return std::string(option.choices.front());
    case OptionKey::Kind::toggle:
      return option.default_toggle;
    case OptionKey::Kind::file:
      return std::string();
    case OptionKey::Kind::quantity:
      break;
  }
  return option.default_value ? std::optional<OptionValue>(*option.default_value) : std::nullopt;
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
  if (!model.configurations.empty()) {
    input.configuration = k_configurations[static_cast<std::size_t>(scenario.loading.configuration)];
  }
  if (!model.has_walls()) std::ranges::transform(scenario.loading.steps, std::back_inserter(input.program), planned);
  return input;
}

std::string shortfall_of(const Preset& preset, const Model& model) {
  std::map<std::string, double> values;
  std::vector<std::string_view> missing;
  for (const QuantityKey& key : model.material) {
    const auto given = std::ranges::find(preset.values, key.name, &Preset::Value::key);
    if (given != preset.values.end()) {
      values.emplace(key.name, given->value);
    } else if (key.default_value) {
      values.emplace(key.name, *key.default_value);
    } else if (!key.is_optional) {
      missing.push_back(key.name);
    }
  }
  if (!missing.empty()) return fmt::format("needs {} beside it", fmt::join(missing, ", "));
  if (model.objections == nullptr) return {};
  std::map<std::string, OptionValue> options;
  for (const auto keys : {model.material_options, model.options}) {
    for (const OptionKey& option : keys) {
      if (const auto value = default_of(option)) options.emplace(option.name, *value);
    }
  }
  const std::vector<Objection> objections = model.objections({.values = values, .options = options, .curves = {}});
  return objections.empty() ? std::string() : "refused on its own: " + objections.front().message;
}

}  // namespace monograin
