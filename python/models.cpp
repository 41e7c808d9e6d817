// The catalogue of models as dictionaries, the JSON Schema of scenarios, and the default scenario.

#include "catalogue.hpp"

#include <pybind11/stl.h>

#include "bindings.hpp"
#include "scenario/scenario.hpp"
#include "scenario/schema.hpp"
#include "scenario/units.hpp"

namespace monograin::python {
namespace {

using namespace py::literals;

py::object default_of(const std::optional<double>& value) {
  return value ? py::object(py::float_(*value)) : py::none();
}

py::dict as_python(const QuantityKey& key) {
  return py::dict("name"_a = key.name, "meaning"_a = key.meaning, "kind"_a = "quantity",
                  "unit"_a = si_unit(key.dimension), "lower"_a = key.range.lower, "upper"_a = key.range.upper,
                  "lower_is_open"_a = key.range.lower_is_open, "upper_is_open"_a = key.range.upper_is_open,
                  "default"_a = default_of(key.default_value), "choices"_a = py::tuple(),
                  "is_required"_a = !key.default_value && !key.is_optional);
}

py::dict as_python(const OptionKey& key) {
  py::dict made = as_python(QuantityKey{.name = key.name,
                                        .meaning = key.meaning,
                                        .dimension = key.dimension,
                                        .range = key.range,
                                        .default_value = key.default_value,
                                        .is_optional = true});
  switch (key.kind) {
    case OptionKey::Kind::quantity:
      return made;
    case OptionKey::Kind::choice:
      made["kind"] = "choice";
      made["choices"] = py::tuple(py::cast(std::vector<std::string_view>(key.choices.begin(), key.choices.end())));
      made["default"] = key.choices.front();
      break;
    case OptionKey::Kind::toggle:
      made["kind"] = "toggle";
      made["default"] = key.default_toggle;
      break;
    case OptionKey::Kind::file:
      made["kind"] = "file";
      break;
  }
  made["unit"] = "";
  return made;
}

py::dict as_python(const DriveKey& key) {
  return as_python(QuantityKey{
      .name = key.name, .meaning = key.meaning, .dimension = key.dimension, .range = key.range, .is_optional = true});
}

template <class Key>
py::list keys_of(std::span<const Key> keys) {
  py::list list;
  for (const Key& key : keys) list.append(as_python(key));
  return list;
}

py::dict terms_of(std::span<const Term> terms) {
  py::dict made;
  for (const Term& term : terms) made[py::str(std::string(term.name))] = term.meaning;
  return made;
}

std::vector<std::string_view> texts_of(std::span<const std::string_view> texts) { return {texts.begin(), texts.end()}; }

py::dict as_python(const Model& model) {
  py::list presets;
  for (const Preset& preset : model.presets) presets.append(py::make_tuple(preset.name, preset.source));
  py::list material = keys_of(model.material_options);
  for (const py::handle key : keys_of(model.material)) material.append(key);
  py::list steps = keys_of(model.drives);
  for (const py::handle key : keys_of(model.lateral_drives)) steps.append(key);
  return py::dict("name"_a = model.name, "summary"_a = model.summary, "references"_a = reference_texts(model),
                  "source"_a = model.source, "material"_a = material, "options"_a = keys_of(model.options),
                  "presets"_a = presets, "steps"_a = steps, "configurations"_a = texts_of(model.configurations),
                  "has_free_centre"_a = model.has_free_centre, "has_walls"_a = model.has_walls(),
                  "has_profile"_a = model.has_profile, "regimes"_a = terms_of(model.regimes),
                  "events"_a = terms_of(model.events), "validity"_a = texts_of(model.domain));
}

}  // namespace

void add_models(py::module_& module) {
  module.def("models", [] {
    py::list models;
    for (const Model& model : model_catalogue()) models.append(as_python(model));
    return models;
  });
  module.def("schema", &scenario_schema);
  module.def("default_scenario", [] { return std::string(default_scenario_text()); });
}

}  // namespace monograin::python
