#include "monograin/models.hpp"

#include "catalogue.hpp"
#include "scenario/units.hpp"

namespace monograin {
namespace {

KeyInfo info_of(const QuantityKey& key) {
  return {std::string(key.name), std::string(key.meaning), si_unit(key.dimension), key.default_value};
}

KeyInfo info_of(const OptionKey& key) {
  KeyInfo info{std::string(key.name), std::string(key.meaning), {}, key.default_value};
  if (key.kind == OptionKey::Kind::quantity) info.unit = si_unit(key.dimension);
  if (key.kind == OptionKey::Kind::toggle)
    info.choices = {key.default_toggle ? "true" : "false", key.default_toggle ? "false" : "true"};
  if (key.kind == OptionKey::Kind::choice) info.choices.assign(key.choices.begin(), key.choices.end());
  return info;
}

std::vector<TermInfo> terms_of(std::span<const Term> terms) {
  std::vector<TermInfo> infos;
  for (const Term& term : terms) infos.push_back({std::string(term.name), std::string(term.meaning)});
  return infos;
}

ModelInfo info_of(const Model& model) {
  ModelInfo info{.name = std::string(model.name),
                 .summary = std::string(model.summary),
                 .references = reference_texts(model),
                 .source = std::string(model.source),
                 .material = {},
                 .options = {},
                 .configurations = {model.configurations.begin(), model.configurations.end()},
                 .regimes = terms_of(model.regimes),
                 .events = terms_of(model.events),
                 .domain = {model.domain.begin(), model.domain.end()}};
  for (const QuantityKey& key : model.material) info.material.push_back(info_of(key));
  for (const OptionKey& key : model.material_options) info.material.push_back(info_of(key));
  for (const OptionKey& key : model.options) info.options.push_back(info_of(key));
  return info;
}

}  // namespace

std::vector<ModelInfo> models() {
  std::vector<ModelInfo> infos;
  for (const Model& model : model_catalogue()) infos.push_back(info_of(model));
  return infos;
}

}  // namespace monograin
