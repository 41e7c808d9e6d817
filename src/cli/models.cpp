// `monograin models`, `monograin cite`, `monograin units` and `monograin schema`.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "catalogue.hpp"
#include "cli/commands.hpp"
#include "cli/terminal.hpp"
#include "history/run.hpp"
#include "scenario/model_input.hpp"
#include "scenario/scenario.hpp"
#include "scenario/schema.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"
#include "scene/scene.hpp"

namespace monograin {
namespace {

struct ModelsOptions {
  std::string name;
  std::string file;
  std::optional<std::string> scene{};
};

std::string to_text(const Range& range) {
  return fmt::format("{}{}, {}{}", range.lower_is_open || std::isinf(range.lower) ? '(' : '[', range.lower, range.upper,
                     range.upper_is_open || std::isinf(range.upper) ? ')' : ']');
}

void print_list() {
  for (const Model& model : model_catalogue()) print_data("{:<16}{}\n", model.name, model.summary);
}

/// Prints the name of a key or a term and what it means.
void print_key(std::string_view name, const std::string& meaning) {
  constexpr std::size_t k_column = 27;
  print_data("{}", list_entry(fmt::format("  {}", name), k_column, meaning));
}

void print_terms(std::string_view title, std::span<const Term> terms) {
  print_data("\n{}\n", title);
  for (const Term& term : terms) print_key(term.name, std::string(term.meaning));
}

template <class Key>
void print_quantity(const Key& key, const std::string& note) {
  print_key(key.name, fmt::format("{} [{}], in {}; {}", key.meaning, si_unit(key.dimension), to_text(key.range), note));
}

void print_steps(const Model& model) {
  const auto print_keys = [](std::span<const DriveKey> keys) {
    for (const DriveKey& key : keys) {
      print_key(key.name, fmt::format("{} [{}], for example {}", key.meaning, si_unit(key.dimension), key.example));
    }
  };
  print_data("\nsteps\n");
  print_keys(model.drives);
  print_keys(model.lateral_drives);
}

void print_options(std::span<const OptionKey> options) {
  for (const OptionKey& key : options) {
    switch (key.kind) {
      case OptionKey::Kind::choice:
        print_key(key.name, fmt::format("{}; one of {} (default {})", key.meaning, fmt::join(key.choices, ", "),
                                        key.choices.front()));
        break;
      case OptionKey::Kind::toggle:
        print_key(key.name, fmt::format("{}; true or false (default {})", key.meaning, key.default_toggle));
        break;
      case OptionKey::Kind::file:
        print_key(key.name, fmt::format("{}; a file (default none)", key.meaning));
        break;
      case OptionKey::Kind::quantity:
        print_quantity(key, key.default_value ? fmt::format("default {}", *key.default_value) : "optional");
        break;
    }
  }
}

void print_model(const Model& model) {
  const auto print_head = [](std::string_view what, std::string_view text) {
    print_data("{}", list_entry(fmt::format("{}:", what), what.size() + 2, text));
  };
  print_head(model.name, model.summary);
  for (const std::string& reference : reference_texts(model)) print_head("reference", reference);
  if (!model.source.empty()) print_head("source", model.source);
  print_data("\n[material]\n");
  print_options(model.material_options);
  if (!model.presets.empty()) {
    print_key("preset", "a material of the source's tables; keys beside it win. One of");
    for (const Preset& preset : model.presets) {
      const std::string shortfall = shortfall_of(preset, model);
      constexpr std::size_t k_column = 29;
      print_data("{}", list_entry("", k_column,
                                  fmt::format("\"{}\", {}{}", preset.name, preset.source,
                                              shortfall.empty() ? "" : "; " + shortfall)));
    }
  }
  for (const QuantityKey& key : model.material) {
    const std::string default_text = key.default_value ? fmt::format("default {}", *key.default_value)
                                     : key.is_optional ? "optional"
                                                       : "required";
    print_quantity(key, default_text);
  }
  if (model.power_law_of != nullptr) {
    print_key("ludwik",
              "instead of strength and hardening_exponent: { yield_stress, strength, exponent = 1/n, eps_max = 1, "
              "fit = \"both\" or \"exponent\" }");
  }
  if (!model.options.empty()) print_data("\n[{}]\n", model.name);
  print_options(model.options);
  if (!model.has_walls()) print_steps(model);
  if (!model.configurations.empty()) print_data("\nconfigurations: {}\n", fmt::join(model.configurations, ", "));
  if (model.has_walls()) print_data("centre: fixed{}\n", model.has_free_centre ? ", equilibrium" : "");
  std::vector<std::string_view> others;
  if (model.lammps_law != nullptr) others.push_back("LAMMPS (monograin export lammps)");
  if (model.continuum_material != nullptr) others.push_back("CalculiX (monograin continuum)");
  if (!others.empty()) print_data("other programs: {}\n", fmt::join(others, ", "));
  print_terms("regimes", model.regimes);
  print_terms("events", model.events);
  print_data("\nvalidity\n");
  for (const std::string_view line : model.domain) print_data("{}", list_entry("  -", 4, line));
}

/// Prints the constants derived from a scenario's material and particle.
void print_parameters(const CheckedScenario& scenario) {
  for (const auto& [name, value, unit, symbol] : derived_parameters(scenario)) {
    print_data("{:<27} {} {}{}\n", name, value, unit, symbol.empty() ? "" : fmt::format("  {}", symbol));
  }
}

/// Prints the references of the named models, or of all models if none is named: each once, in the order of the keys.
int run_cite(const std::vector<std::string>& names) {
  // The program itself is to be cited with the sources of any law, in the version that has computed with them.
  Citation own = references::k_monograin;
  const std::string title = fmt::format("{}, version {}", own.title, version());
  own.title = title;
  std::map<std::string_view, const Citation*> entries{{own.key, &own}};
  const auto add = [&entries](const Model& model) {
    for (const Citation* reference : model.references) entries.emplace(reference->key, reference);
  };
  for (const std::string& name : names) add(model_named(name));
  if (names.empty()) {
    for (const Model& model : model_catalogue()) add(model);
  }
  std::string text;
  for (const auto& [key, entry] : entries) text.append(text.empty() ? "" : "\n").append(bibtex(*entry));
  print_data("{}", text);
  return k_success;
}

/// Prints the units of every dimension, that of a bare number first.
int run_units() {
  print_data("{:<17}{:<11}{}\n", "dimension", "bare in", "units");
  for (const DimensionInfo& info : dimensions()) {
    if (info.units.empty()) continue;
    std::vector<std::string_view> symbols;
    for (const Unit& unit : info.units) {
      if (!unit.symbol.starts_with("μ")) symbols.push_back(unit.symbol);  // the Greek letter looks like the micro sign
    }
    if (!info.relative.empty()) symbols.push_back(info.relative);
    const std::string_view noun = info.noun.substr(info.noun.find(' ') + 1);
    print_data("{:<17}{:<11}{}\n", noun, info.si, fmt::join(symbols, ", "));
  }
  return k_success;
}

int run_models(const ModelsOptions& options) {
  if (options.scene) return show_laws_for(*options.scene);
  const Model* model = options.name.empty() ? nullptr : &model_named(options.name);
  if (options.file.empty()) {
    if (model == nullptr)
      print_list();
    else
      print_model(*model);
    return k_success;
  }
  const CheckedScenario scenario = read_scenario(options.file, {}, FileKind::any);
  if (model != nullptr && scenario.model != model->name) {
    throw UsageError(fmt::format("{}: its model is '{}', not '{}'", options.file, scenario.model, model->name));
  }
  print_parameters(scenario);
  return k_success;
}

}  // namespace

CLI::Validator is_no_nan() {
  return {[](std::string& text) {
            double value = 0.0;
            return CLI::detail::lexical_cast(text, value) && std::isnan(value) ? text + " is no number" : std::string();
          },
          ""};
}

const Model& model_named(const std::string& name) {
  if (const Model* model = find_model(name); model != nullptr) return *model;
  std::vector<std::string_view> names;
  for (const Model& known : model_catalogue()) names.push_back(known.name);
  throw UsageError(fmt::format("there is no model '{}'{}; available: {}", shown(name), did_you_mean(name, names),
                               fmt::join(names, ", ")));
}

void add_models_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<ModelsOptions>();
  CLI::App* command = app.add_subcommand("models", "List models, or describe one: keys, regimes, events, validity");
  command->add_option("NAME", options->name, "Model to describe");
  command->add_option("--parameters", options->file, "Print the derived parameters of this scenario instead")
      ->type_name("FILE");
  command
      ->add_option("--for", options->scene,
                   "Scenario to run under every law of contact: which can, how far off finite elements")
      ->type_name("FILE")
      ->excludes("NAME")
      ->excludes("--parameters");
  command->footer("Example: monograin models mdr");
  command->callback([options, &action] { action = [options] { return run_models(*options); }; });
}

void add_cite_command(CLI::App& app, Action& action) {
  auto names = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand("cite", "Print the references of models, and of the program, as BibTeX");
  command->add_option("NAME", *names, "Models; all of them if none is named");
  command->footer("Example: monograin cite mdr > mdr.bib");
  command->callback([names, &action] { action = [names] { return run_cite(*names); }; });
}

void add_units_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("units", "Print the units understood, by dimension");
  command->footer("Example: monograin units");
  command->callback([&action] { action = run_units; });
}

void add_schema_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("schema", "Print a JSON Schema of scenario files, for editors");
  command->footer("Example: monograin schema > monograin.schema.json");
  command->callback([&action] {
    action = [] {
      print_data("{}\n", scenario_schema());
      return static_cast<int>(k_success);
    };
  });
}

}  // namespace monograin
