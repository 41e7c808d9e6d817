#include "scenario/language.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <numbers>
#include <utility>

#include "scenario/integrators.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"
#include "system/awaited_events.hpp"

namespace monograin {
namespace {

using std::string_view;
using Kind = KeySpec::Kind;

constexpr Range k_right_angle{
    .lower = 0.0, .upper = std::numbers::pi / 2.0, .lower_is_open = true, .upper_is_open = true};
constexpr double k_default_oblique_angle = 37.5 * std::numbers::pi / 180.0;

constexpr std::array<string_view, 2> k_centres{"fixed", "equilibrium"};
constexpr std::array<string_view, 2> k_ludwik_fits{"both", "exponent"};

// Replaces a model that is missing or misspelt, so that the loading is checked as far as no model is needed.
constexpr Model k_any_model{.configurations = k_configurations, .has_free_centre = true};

// Keys of steps of all models.
constexpr std::array<string_view, 8> k_step_keys{
    "displacement", "force", "detach", "strain", "stress", "lateral_strain", "lateral_stress", "packing_fraction"};
constexpr std::array<string_view, 6> k_loading_keys{"configuration", "centre", "angle",
                                                    "oblique_walls", "wall",   "steps"};

bool is_in(std::span<const string_view> words, string_view word) {
  return std::ranges::find(words, word) != words.end();
}

std::vector<string_view> words_of(std::span<const string_view> words) { return {words.begin(), words.end()}; }

std::vector<string_view> words_without(std::span<const string_view> words, std::span<const string_view> excluded) {
  std::vector<string_view> result;
  for (const string_view word : words) {
    if (!is_in(excluded, word)) result.push_back(word);
  }
  return result;
}

std::vector<string_view> model_names() {
  std::vector<string_view> names;
  for (const Model& model : model_catalogue()) names.push_back(model.name);
  return names;
}

// --- tables that do not depend on the model

std::vector<KeySpec> root_keys() {
  return {
      key_of(Kind::text, "title", "what the scenario is about", "\"die compaction\""),
      {.name = "model",
       .meaning = "contact law",
       .kind = Kind::choice,
       .is_required = true,
       .choices = model_names(),
       .example = "\"mdr\""},
      key_of(Kind::table, "particle", "the particle", "[particle]"),
      key_of(Kind::table, "material", "parameters of the contact law", "[material]"),
      key_of(Kind::table, "loading", "what the walls do", "[loading]"),
      key_of(Kind::table, "output", "what is recorded", "[output]"),
      key_of(Kind::table, "numerics", "how the equations are solved", "[numerics]"),
      key_of(Kind::table, "sensitivities", "numbers with respect to which the history is differentiated",
             "[sensitivities]"),
  };
}

std::vector<KeySpec> particle_keys() {
  return {{.name = "radius",
           .meaning = "initial radius R0",
           .kind = Kind::quantity,
           .is_required = true,
           .dimension = Dimension::length,
           .range = k_positive,
           .knows_initial_radius = false}};
}

std::vector<KeySpec> output_keys() {
  return {
      {.name = "points",
       .meaning = "rows for each step, at equal intervals of the part that was run; 0: the integrator's own steps",
       .kind = Kind::integer,
       .range = {.lower = 0.0, .upper = k_most_points},
       .default_value = 200.0},
      {.name = "times",
       .meaning = "record at these instants instead",
       .kind = Kind::instants,
       .dimension = Dimension::time,
       .range = k_not_negative,
       .example = "[0.1, 0.25]"},
  };
}

std::vector<KeySpec> sensitivity_keys() {
  return {
      required(key_of(Kind::texts, "keys", "numbers of the scenario, by their paths", "[\"material.yield_stress\"]"))};
}

std::vector<KeySpec> numerics_keys() {
  return {
      {.name = "integrator",
       .meaning = "method; auto picks the cheapest",
       .kind = Kind::choice,
       .choices = words_of(integrators::k_all),
       .default_value = integrators::k_auto,
       .renamed = {{integrators::k_former_forward_euler, integrators::k_forward_euler}}},
      {.name = "rtol",
       .meaning = "relative tolerance",
       .kind = Kind::quantity,
       .range = {.lower = 1e-14, .upper = 1e-1},
       .default_value = integrators::k_default_rtol,
       .example = "1e-8"},
      {.name = "atol",
       .meaning = "absolute tolerance, relative to the state's own scale",
       .kind = Kind::quantity,
       .range = {.lower = 0.0, .upper = 1e-1, .lower_is_open = true},
       .default_value = integrators::k_default_atol,
       .example = "1e-12"},
  };
}

std::vector<KeySpec> wall_keys() {
  return {
      required(key_of(Kind::identifier, "name", "unique name", "\"bottom\"")),
      {.name = "normal",
       .meaning = "direction from the particle's centre to the wall",
       .kind = Kind::direction,
       .is_required = true,
       .example = "[0, 0, 1]"},
      quantity_key({"gap", "distance from first touch at the start", Dimension::length, k_not_negative, 0.0}),
      {.name = "fixed", .meaning = "the wall does not move", .kind = Kind::toggle, .default_value = false},
      key_of(Kind::tables, "steps", "program of this wall alone", "[[loading.wall.steps]]"),
  };
}

// --- tables that depend on the model

KeySpec option_key(const OptionKey& option) {
  KeySpec spec{.name = option.name, .meaning = option.meaning};
  switch (option.kind) {
    case OptionKey::Kind::choice:
      spec.kind = Kind::choice;
      spec.choices = words_of(option.choices);
      spec.default_value = option.choices.front();
      break;
    case OptionKey::Kind::toggle:
      spec.kind = Kind::toggle;
      spec.default_value = option.default_toggle;
      break;
    case OptionKey::Kind::file:
      spec.kind = Kind::file;
      spec.example = "\"file.csv\"";
      spec.columns = option.columns;
      break;
    case OptionKey::Kind::quantity:
      spec.kind = Kind::quantity;
      spec.dimension = option.dimension;
      spec.range = option.range;
      if (option.default_value) spec.default_value = *option.default_value;
      break;
  }
  return spec;
}

std::vector<KeySpec> material_keys(const Model& model) {
  std::vector<KeySpec> keys;
  for (const OptionKey& option : model.material_options) keys.push_back(option_key(option));
  if (!model.presets.empty()) {
    KeySpec preset{.name = "preset", .meaning = "a material of the source's tables", .kind = Kind::choice};
    for (const Preset& material : model.presets) preset.choices.push_back(material.name);
    keys.push_back(std::move(preset));
  }
  for (const QuantityKey& key : model.material) {
    keys.push_back(quantity_key(key));
    // The preset may give the value; the reader checks what is missing then.
    if (!model.presets.empty()) keys.back().is_required = false;
  }
  if (model.power_law_of != nullptr) {
    keys.push_back(key_of(Kind::table, "ludwik",
                          "instead of strength and hardening_exponent: Ludwik's law, and the power law nearest to it",
                          "{ yield_stress = \"5 MPa\", strength = \"15.5 MPa\", exponent = 0.35 }"));
  }
  return keys;
}

std::vector<KeySpec> ludwik_keys() {
  return {
      quantity_key({"yield_stress", "stress at first yield", Dimension::stress, k_not_negative}),
      quantity_key({"strength", "K of sigma = Y + K eps_pl^(1/n)", Dimension::stress, k_not_negative}),
      {.name = "exponent",
       .meaning = "1/n of sigma = Y + K eps_pl^(1/n)",
       .kind = Kind::quantity,
       .is_required = true,
       .range = {.lower = 0.0, .upper = 1.0, .lower_is_open = true},
       .example = "0.35"},
      quantity_key({"eps_max", "largest strain of the fit", Dimension::none, k_positive, 1.0}),
      first_by_default(
          choice_key("fit", "what is fitted: both parameters, or the exponent with the strength Y + K", k_ludwik_fits)),
  };
}

KeySpec steps_key(string_view meaning) { return key_of(Kind::tables, "steps", meaning, "[[loading.steps]]"); }

KeySpec configuration_key(const Model& model, string_view meaning) {
  return {.name = "configuration",
          .meaning = meaning,
          .kind = Kind::choice,
          .is_required = true,
          .choices = words_of(model.configurations),
          .reserved = words_without(k_configurations, model.configurations),
          .reserved_where = fmt::format("for model '{}'", model.name)};
}

std::vector<KeySpec> loading_keys(const Model& model) {
  if (!model.has_walls()) {
    std::vector<KeySpec> keys{steps_key("what is prescribed, one step after another")};
    if (!model.configurations.empty()) keys.push_back(configuration_key(model, "which way the body is loaded"));
    return keys;
  }
  std::vector<string_view> centres{"fixed"};
  if (model.has_free_centre) centres.push_back("equilibrium");
  const std::string for_model = fmt::format("for model '{}'", model.name);
  return {
      configuration_key(model, "walls around the particle"),
      {.name = "centre",
       .meaning = "equilibrium: the centre moves so that the forces balance",
       .kind = Kind::choice,
       .choices = centres,
       .reserved = words_without(k_centres, centres),
       .reserved_where = for_model,
       .default_value = "fixed"},
      {.name = "angle",
       .meaning = "elevation of the normals of the oblique walls above the horizontal, in the y-z plane",
       .kind = Kind::quantity,
       .dimension = Dimension::angle,
       .range = k_right_angle,
       .default_value = k_default_oblique_angle,
       .only_with = "oblique-die"},
      {.name = "oblique_walls",
       .meaning = "number of oblique walls, 2 or 4",
       .kind = Kind::integer,
       .range = {.lower = 2.0, .upper = 4.0},
       .multiple_of = 2,
       .default_value = 2.0,
       .only_with = "oblique-die"},
      {.name = "wall",
       .meaning = "the walls, one by one",
       .kind = Kind::tables,
       .example = "[[loading.wall]]",
       .only_with = "walls"},
      steps_key("what the driven walls do, one step after another; walls of [[loading.wall]] may have steps of their "
                "own instead"),
  };
}

KeySpec event_key(const Model& model) {
  std::vector<string_view> events = events_to_wait_for(model.events);
  return {.name = "event",
          .meaning = "name of an event",
          .kind = Kind::choice,
          .choices = events,
          .example = model.has_walls() ? "\"contact-lost\"" : fmt::format("\"{}\"", events.front())};
}

std::vector<KeySpec> until_keys(const Model& model) {
  if (!model.has_walls()) {
    std::vector<KeySpec> keys;
    for (const QuantityKey& key : model.conditions) keys.push_back(quantity_key(key));
    keys.push_back(event_key(model));
    return keys;
  }
  std::vector<KeySpec> keys{
      key_of(Kind::text, "wall", "contact class or wall of the quantities beside it; without it that of the step",
             "\"axial\""),
      {.name = "force",
       .meaning = "force on the wall, compression positive",
       .kind = Kind::quantity,
       .dimension = Dimension::force},
      {.name = "displacement",
       .meaning = "displacement of the wall",
       .kind = Kind::quantity,
       .dimension = Dimension::length,
       .example = "\"0.4 R0\""},
      event_key(model),
  };
  if (!model.has_contact_area) return keys;
  const std::vector<KeySpec> of_area{
      {.name = "pressure", .meaning = "mean contact pressure", .kind = Kind::quantity, .dimension = Dimension::stress},
      quantity_key({"contact_radius", "contact radius", Dimension::length, k_not_negative, {}, true}),
      quantity_key({"apparent_radius", "apparent radius of the particle", Dimension::length, k_positive, {}, true}),
  };
  keys.insert(keys.end() - 1, of_area.begin(), of_area.end());
  return keys;
}

// --- steps

KeySpec duration_key(bool is_required) {
  return quantity_key({"duration", "how long the step takes", Dimension::time, k_positive, {}, !is_required});
}

KeySpec rate_key(Dimension dimension, bool is_required) {
  return quantity_key({"rate", "how fast the controlled quantity changes", dimension, k_positive, {}, !is_required});
}

KeySpec until_key(const Model& model) {
  const std::vector<KeySpec> conditions = until_keys(model);
  return {.name = "until",
          .meaning = "the step ends when the first of these is met",
          .kind = Kind::table,
          .may_be_empty = false,
          .example = fmt::format("{{ {} }}", model.has_walls() ? "force = \"0 N\"" : example_line(conditions.front()))};
}

StepForm ramp_form(Step::Kind kind, KeySpec target, Dimension rate, const Model& model) {
  const string_view key = target.name;
  return {kind, key, {std::move(target), duration_key(false), rate_key(rate, false), until_key(model)}, true, {}};
}

KeySpec target_key(const DriveKey& drive, bool is_required) {
  return {.name = drive.name,
          .meaning = drive.meaning,
          .kind = drive.may_take_lateral ? Kind::pair : Kind::quantity,
          .is_required = is_required,
          .dimension = drive.dimension,
          .range = drive.range,
          .example = std::string(drive.example)};
}

StepForm drive_form(const DriveKey& drive, const Model& model) {
  const Dimension rate = drive.dimension == Dimension::stress ? Dimension::stress_rate : Dimension::strain_rate;
  StepForm form = ramp_form(ramp_of(drive.control), target_key(drive, true), rate, model);
  for (const DriveKey& lateral : model.lateral_drives) form.keys.push_back(target_key(lateral, false));
  form.lateral = model.lateral_drives;
  return form;
}

KeySpec mark_key(string_view name, string_view meaning) {
  return {.name = name, .meaning = meaning, .kind = Kind::mark, .is_required = true, .example = "true"};
}

/// Column of a table of numbers.
KeySpec column_key(string_view name, string_view meaning, std::string example) {
  KeySpec key = required(key_of(Kind::column, name, meaning, std::move(example)));
  key.range = {.lower = 1.0, .upper = k_most_columns};
  return key;
}

/// Tables that may stand for a target: values over time from a file, or a sine.
CourseForm course_form(const KeySpec& target, string_view column) {
  const auto value_key = [&](string_view name, string_view meaning, Range range) {
    return KeySpec{.name = name,
                   .meaning = meaning,
                   .kind = Kind::quantity,
                   .is_required = true,
                   .dimension = target.dimension,
                   .range = range,
                   .example = target.example};
  };
  CourseForm form;
  form.table = {
      required(key_of(Kind::file, "table", "table of values over time; the value between two rows is linear in time",
                      "\"file.csv\"")),
      column_key("time", "column of times from the beginning of the step: its heading, or its number from 1",
                 "\"t[s]\""),
      column_key("value", "column of values: its heading, or its number from 1", fmt::format("\"{}\"", column)),
  };
  form.sine = {{.name = "sine",
                .meaning = "a sine that begins at its mean",
                .kind = Kind::table,
                .is_required = true,
                .may_be_empty = false,
                .example = "{ mean = ..., amplitude = ..., frequency = \"1 Hz\", cycles = 5 }"}};
  form.in_sine = {value_key("mean", "mean of the sine", {}),
                  value_key("amplitude", "distance from the mean to the extrema", k_positive),
                  quantity_key({"frequency", "cycles over time", Dimension::frequency, k_positive}),
                  {.name = "cycles",
                   .meaning = "number of cycles",
                   .kind = Kind::integer,
                   .is_required = true,
                   .range = {.lower = 1.0, .upper = k_most_steps},
                   .example = "5"}};
  for (const KeySpec& key : form.table) form.foreign_to_sine.push_back({key.name, "does not go with 'sine'"});
  return form;
}

StepForm wall_form(Step::Kind kind, KeySpec target, string_view column, Dimension rate, const Model& model) {
  CourseForm course = course_form(target, column);
  StepForm form = ramp_form(kind, std::move(target), rate, model);
  form.course = std::move(course);
  return form;
}

std::vector<StepForm> step_forms(const Model& model) {
  KeySpec displacement{.name = "displacement",
                       .meaning = "ramp to this displacement of the wall",
                       .kind = Kind::quantity,
                       .is_required = true,
                       .dimension = Dimension::length,
                       .example = "\"0.4 R0\"",
                       .may_be_table = true};
  KeySpec force{.name = "force",
                .meaning = "ramp to this force",
                .kind = Kind::quantity,
                .is_required = true,
                .dimension = Dimension::force,
                .example = "\"10 N\"",
                .may_be_table = true};
  KeySpec count{.name = "cycle",
                .meaning = "repeat the nested steps so many times",
                .kind = Kind::integer,
                .is_required = true,
                .range = {.lower = 1.0, .upper = k_most_steps},
                .example = "5"};
  KeySpec nested = required(key_of(Kind::tables, "steps", "the steps that are repeated", "[[loading.steps.steps]]"));
  std::vector<StepForm> forms;
  for (const DriveKey& drive : model.drives) forms.push_back(drive_form(drive, model));
  if (model.has_walls()) {
    forms.push_back(wall_form(Step::Kind::displacement, std::move(displacement), "x[mm]", Dimension::velocity, model));
    forms.push_back(wall_form(Step::Kind::force, std::move(force), "F[N]", Dimension::force_rate, model));
  }
  const string_view hold = model.has_walls() ? "keep the controlled quantity constant: the displacement or the force"
                                             : "keep what is prescribed";
  forms.push_back({Step::Kind::hold, "hold", {mark_key("hold", hold), duration_key(true), until_key(model)}});
  if (model.has_walls()) {
    forms.push_back(
        {Step::Kind::detach,
         "detach",
         {mark_key("detach", "withdraw the wall until contact is lost"), rate_key(Dimension::velocity, true)}});
  }
  forms.push_back({std::nullopt, "cycle", {std::move(count), std::move(nested)}});
  return forms;
}

// --- keys of other models

std::vector<ForeignKey> foreign_keys(std::span<const string_view> names, std::span<const KeySpec> own,
                                     const std::string& reason) {
  std::vector<ForeignKey> foreign;
  for (const string_view name : names) {
    if (find_key(own, name) == nullptr) foreign.push_back({name, reason});
  }
  return foreign;
}

/// Why keys that other models use do not belong here, and what this model uses.
std::string unused_by(const Model& model, std::span<const KeySpec> own) {
  std::vector<string_view> names;
  for (const KeySpec& key : own) {
    if (!is_in(names, key.name)) names.push_back(key.name);
  }
  return fmt::format("is not used by model '{}'; expected {}{}", model.name, names.size() > 1 ? "one of " : "",
                     listed(names));
}

std::vector<string_view> material_names_of_all_models() {
  std::vector<string_view> names{"ludwik", "preset"};
  for (const Model& model : model_catalogue()) {
    for (const OptionKey& option : model.material_options) names.push_back(option.name);
    for (const QuantityKey& key : model.material) {
      if (!is_in(names, key.name)) names.push_back(key.name);
    }
  }
  return names;
}

void add_model_tables(Language& language, string_view model) {
  std::vector<string_view> names = model_names();
  // Without a valid model, the options of all models are accepted.
  const bool is_known = is_in(names, model);
  for (const string_view name : names) {
    if (is_known && name != model) {
      language.foreign_tables.push_back({name, fmt::format("is the table of another model; this one is '{}'", model)});
    } else {
      language.root.push_back(key_of(Kind::table, name, "options of this model alone", fmt::format("[{}]", name)));
    }
  }
}

void add_loading(Language& language, const Model& model) {
  language.loading = loading_keys(model);
  language.wall = wall_keys();
  language.until = until_keys(model);
  language.steps = step_forms(model);
  std::vector<KeySpec> own_step_keys;
  for (const StepForm& form : language.steps) std::ranges::copy(form.keys, std::back_inserter(own_step_keys));

  language.foreign_step_keys = foreign_keys(k_step_keys, own_step_keys, unused_by(model, own_step_keys));
  if (model.has_walls()) {
    language.foreign_step_keys.push_back({"sine", "stands in a target: displacement = { sine = { ... } }"});
  }
  for (StepForm& form : language.steps) {
    form.foreign =
        foreign_keys(names_of(own_step_keys), form.keys, fmt::format("does not go with '{}' in one step", form.key));
    std::ranges::copy(language.foreign_step_keys, std::back_inserter(form.foreign));
  }
  const std::string unused_condition = unused_by(model, language.until);
  language.foreign_until_keys = foreign_keys(k_quantity_keys, language.until, unused_condition);
  if (!model.has_walls()) language.foreign_until_keys.push_back({"wall", unused_condition});
  language.foreign_loading = foreign_keys(k_loading_keys, language.loading, unused_by(model, language.loading));
}

void add_material_and_options(Language& language, const Model& model) {
  language.model = &model;
  language.material = material_keys(model);
  if (model.power_law_of != nullptr) language.ludwik = ludwik_keys();
  for (const OptionKey& option : model.options) language.options.push_back(option_key(option));
  language.foreign_material =
      foreign_keys(material_names_of_all_models(), language.material, unused_by(model, language.material));
}

void add_homes(Language& language) {
  const std::string at_top = "above the first table";
  const auto add = [&](std::span<const KeySpec> keys, const std::string& home) {
    for (const KeySpec& key : keys) {
      if (!reason_of(language.homes, key.name).empty()) continue;
      const bool is_own_table = key.kind == KeySpec::Kind::table && home == at_top;
      language.homes.push_back(
          {key.name, is_own_table ? fmt::format("is a table of its own: [{}]", key.name) : "belongs " + home});
    }
  };
  add(language.root, at_top);
  add(language.particle, "in [particle]");
  add(language.material, "in [material]");
  add(language.loading, "in [loading]");
  if (find_key(language.loading, "wall") != nullptr) add(language.wall, "in [[loading.wall]]");
  for (const StepForm& form : language.steps) add(form.keys, "in [[loading.steps]]");
  add(language.output, "in [output]");
  add(language.numerics, "in [numerics]");
  if (language.model != nullptr) add(language.options, fmt::format("in [{}]", language.model->name));
}

/// @param info  null: the model is not known
Language make_language(const Model* info) {
  Language language;
  language.root = root_keys();
  language.particle = particle_keys();
  language.output = output_keys();
  language.numerics = numerics_keys();
  language.sensitivities = sensitivity_keys();
  add_model_tables(language, info != nullptr ? info->name : string_view());
  if (info != nullptr) add_material_and_options(language, *info);
  if (info != nullptr && !info->has_walls()) {
    language.particle.clear();
    std::erase_if(language.root, [](const KeySpec& key) { return key.name == "particle"; });
    language.foreign_tables.push_back(
        {"particle", fmt::format("is not used by model '{}', which has no walls", info->name)});
  }
  add_loading(language, info != nullptr ? *info : k_any_model);
  add_homes(language);
  return language;
}

}  // namespace

const Language& language_of(string_view model) {
  // A sweep reads a scenario for each run, so that languages are made once and kept.
  static std::mutex mutex;
  static std::map<const Model*, Language> languages;
  const Model* info = find_model(model);
  const std::lock_guard lock(mutex);
  const auto known = languages.find(info);
  return known != languages.end() ? known->second : languages.emplace(info, make_language(info)).first->second;
}

KeySpec quantity_key(const QuantityKey& key) {
  KeySpec spec{.name = key.name,
               .meaning = key.meaning,
               .kind = Kind::quantity,
               .is_required = !key.default_value.has_value() && !key.is_optional,
               .dimension = key.dimension,
               .range = key.range};
  if (key.default_value) spec.default_value = *key.default_value;
  return spec;
}

std::string_view reason_of(std::span<const ForeignKey> foreign, string_view key) noexcept {
  const auto found = std::ranges::find(foreign, key, &ForeignKey::name);
  return found == foreign.end() ? string_view() : string_view(found->reason);
}

const KeySpec* find_key(std::span<const KeySpec> keys, string_view name) noexcept {
  const auto found = std::ranges::find(keys, name, &KeySpec::name);
  return found == keys.end() ? nullptr : &*found;
}

std::vector<string_view> names_of(std::span<const KeySpec> keys) {
  std::vector<string_view> names;
  for (const KeySpec& key : keys) names.push_back(key.name);
  return names;
}

}  // namespace monograin
