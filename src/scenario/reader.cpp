#include "scenario/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>

#include "scenario/curve_file.hpp"
#include "scenario/key_path.hpp"
#include "scenario/language.hpp"
#include "scenario/loading_reader.hpp"
#include "scenario/plain_paths.hpp"
#include "scenario/rules.hpp"
#include "scenario/section.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

/// Name of the model whose language checks the file: the named one, or the one that the name misspells.
std::string model_to_check_against(const toml::table& root) {
  const std::string word = root["model"].value_or(std::string());
  if (find_model(word) != nullptr) return word;
  std::vector<std::string_view> names;
  for (const Model& model : model_catalogue()) names.push_back(model.name);
  const std::string_view nearest = nearest_word(word, names);
  return nearest.empty() ? word : std::string(nearest);
}

void read_particle(Reading& reading, const Section& root, const Language& language, CheckedScenario& scenario) {
  if (language.particle.empty()) return;
  const Section particle(reading, root.table("particle", "[particle]"), language.particle);
  if (const auto radius = particle.number("radius")) {
    scenario.radius = *radius;
    reading.initial_radius = *radius;
  }
}

/// Reads a table `ludwik`: the power law nearest to it gives strength and hardening_exponent.
void read_ludwik(Reading& reading, const Section& material, const Language& language, CheckedScenario& scenario) {
  const std::size_t faults_before = reading.faults.size();
  const Section section(reading, material.table("ludwik", "ludwik"), language.ludwik);
  for (const char* key : {"strength", "hardening_exponent"}) {
    if (material.has(key)) {
      reading.faults.add(
          material.key_place(key),
          fmt::format("key '{}' does not go with 'ludwik', which stands for it; expected one of them", key));
    }
  }
  const auto modulus = material.number("youngs_modulus");
  const auto yield_stress = section.number("yield_stress");
  const auto strength = section.number("strength");
  const auto exponent = section.number("exponent");
  const auto eps_max = section.number("eps_max");
  if (reading.faults.size() > faults_before || !yield_stress || !strength || !exponent || !eps_max) return;
  try {
    const PowerLaw power_law = language.model->power_law_of({.youngs_modulus = modulus.value_or(k_infinity),
                                                             .yield_stress = *yield_stress,
                                                             .strength = *strength,
                                                             .exponent = *exponent,
                                                             .largest_strain = *eps_max,
                                                             .fits_both = section.text("fit") == "both"});
    scenario.material.emplace("strength", power_law.strength);
    scenario.material.emplace("hardening_exponent", power_law.exponent);
    if (!modulus) {
      scenario.doubts.emplace_back(
          "ludwik without youngs_modulus: the power law is fitted for a rigid-plastic material (E infinite); a modulus "
          "that is added, as for unloading, changes the loading curve, too");
    }
  } catch (const std::logic_error& error) {  // objections of the fit
    reading.faults.add(material.value_place("ludwik"), fmt::format("ludwik: {}", error.what()));
  }
}

std::optional<OptionValue> option_value(const Section& options, const KeySpec& spec) {
  if (spec.kind == KeySpec::Kind::toggle) return options.toggle(spec.name).value_or(false);
  if (spec.kind == KeySpec::Kind::quantity) return options.number(spec.name);
  return options.text(spec.name);
}

/// Takes the values of a named preset for keys that are not given, and reports keys that are still missing.
void read_preset(Reading& reading, const Section& material, const Language& language, CheckedScenario& scenario) {
  const auto presets = language.model->presets;
  const std::string name = material.text("preset");
  if (const auto preset = std::ranges::find(presets, name, &Preset::name); preset != presets.end()) {
    for (const auto& [key, value] : preset->values) {
      const KeySpec* spec = find_key(language.material, key);
      if (spec == nullptr || material.has_or_misspells(key)) continue;
      scenario.material.insert_or_assign(std::string(key), value);
      if (spec->dimension != Dimension::none) reading.has_units = true;  // the value is in SI units
    }
  }
  if (name.empty() && material.has_or_misspells("preset")) return;
  for (const QuantityKey& key : language.model->material) {
    const bool is_needed = !key.default_value && !key.is_optional;
    if (!is_needed || scenario.material.contains(std::string(key.name)) || material.has_or_misspells(key.name))
      continue;
    reading.faults.add(
        material.place(),
        name.empty() ? fmt::format("key '{}' is missing in [material]; expected for example {}, or {}", key.name,
                                   example_line(*find_key(language.material, key.name)),
                                   example_line(*find_key(language.material, "preset")))
                     : fmt::format("key '{}' is missing in [material], and preset '{}' does not have it; expected for "
                                   "example {}",
                                   key.name, name, example_line(*find_key(language.material, key.name))));
  }
}

void read_material(Reading& reading, const Section& root, const Language& language, CheckedScenario& scenario) {
  reading.is_of_material = true;
  const Section material(reading, root.table("material", "[material]"), language.material, language.foreign_material);
  reading.is_of_material = false;
  for (const QuantityKey& key : language.model->material) {
    if (const auto value = material.number(key.name)) scenario.material.emplace(key.name, *value);
  }
  for (const OptionKey& option : language.model->material_options) {
    if (auto value = option_value(material, *find_key(language.material, option.name))) {
      scenario.options.emplace(option.name, std::move(*value));
    }
  }
  if (!language.model->presets.empty()) read_preset(reading, material, language, scenario);
  if (language.ludwik.empty()) return;
  if (material.has_or_misspells("ludwik")) return read_ludwik(reading, material, language, scenario);
  for (const char* key : {"strength", "hardening_exponent"}) {
    if (material.has_or_misspells(key)) continue;
    reading.faults.add(material.place(),
                       fmt::format("key '{}' is missing in [material]; expected for example {}, or ludwik = {{ ... }}",
                                   key, example_line(*find_key(language.material, key))));
  }
}

/// Reads the curve in the file that an option names, if it names one.
void read_curve_of(Reading& reading, const Section& options, const KeySpec& spec, CheckedScenario& scenario) {
  const std::string name = options.text(spec.name);
  if (name.empty()) return;
  const std::string naming = fmt::format("{} = \"{}\"", spec.name, shown(name));
  const SourceLocation place = options.value_place(spec.name);
  scenario.curves.emplace(spec.name,
                          take_curve(text_of_file(reading, name, k_largest_table), (reading.folder / name).string(),
                                     spec.columns, place, naming, reading.faults));
}

void read_options(Reading& reading, const Section& root, const Language& language, CheckedScenario& scenario) {
  const std::string name(language.model->name);
  const Section options(reading, root.table(name, "[" + name + "]"), language.options);
  for (const KeySpec& spec : language.options) {
    if (auto value = option_value(options, spec)) scenario.options.emplace(spec.name, std::move(*value));
    if (spec.kind == KeySpec::Kind::file) read_curve_of(reading, options, spec, scenario);
  }
}

void read_output(Reading& reading, const Section& root, const Language& language, CheckedScenario& scenario) {
  const Section output(reading, root.table("output", "[output]"), language.output);
  scenario.output.times = output.numbers("times");
  // The default number of points applies only without times.
  const bool has_points = scenario.output.times.empty() || output.has("points");
  scenario.output.points = has_points ? static_cast<int>(output.number("points").value_or(0.0)) : 0;
  std::size_t steps = count_steps(scenario.loading.steps);
  for (const WallSpec& wall : scenario.loading.walls) steps = std::max(steps, count_steps(wall.steps));
  const double rows = static_cast<double>(scenario.output.points) * static_cast<double>(steps);
  if (rows > k_most_rows && !output.has("times")) {
    reading.faults.add(
        output.value_place("points"),
        fmt::format("points = {} in each of {} steps are {:.3g} rows; expected at most {:.0f} million: take fewer "
                    "points, or name the instants with 'times'",
                    scenario.output.points, steps, rows, k_most_rows / 1e6));
  }
}

void read_numerics(Reading& reading, const Section& root, const Language& language, CheckedScenario& scenario) {
  const Section numerics(reading, root.table("numerics", "[numerics]"), language.numerics);
  scenario.numerics.integrator = numerics.text("integrator");
  scenario.numerics.integrator_place = numerics.value_place("integrator");
  scenario.numerics.rtol = numerics.number("rtol").value_or(0.0);
  scenario.numerics.atol = numerics.number("atol").value_or(0.0);
}

struct ReadQuantity {
  std::optional<SensitivityKey> found;
  std::string problem;
};

/// The number at a path, in SI; or the problem, if no history can be differentiated by it.
ReadQuantity quantity_at(const std::string& path, const toml::table& tree, const CheckedScenario& scenario) {
  const KeyAnswer answer = key_at(path, tree, scenario.model);
  if (!answer.spec) return {{}, answer.problem};
  const KeySpec& spec = *answer.spec;
  if (spec.kind != KeySpec::Kind::quantity) return {{}, fmt::format("'{}' is no quantity", shown(path))};
  const auto radius = scenario.radius > 0.0 ? std::optional(scenario.radius) : std::nullopt;
  std::optional<double> number;
  for (const std::string& plain : plain_paths(path)) {
    const toml::node* node = tree.at_path(plain).node();
    if (node == nullptr || node->is_table()) return {{}, fmt::format("the scenario does not give '{}'", shown(plain))};
    const auto text = node->value<std::string>();
    const std::optional<double> value =
        text ? parse_quantity(*text, spec.dimension, radius).value : node->value<double>();
    if (number && value != number) return {{}, fmt::format("'{}' names different numbers", shown(path))};
    number = value;
  }
  if (number && *number == 0.0) return {{}, fmt::format("'{}' is 0, which gives its step no size", shown(path))};
  const std::string_view si = dimension_info(spec.dimension).si;
  return {SensitivityKey{path, si.empty() ? "-" : std::string(si), number.value_or(0.0)}, {}};
}

void read_sensitivities(Reading& reading, const Section& root, const toml::table& tree, const Language& language,
                        CheckedScenario& scenario) {
  if (!root.has("sensitivities")) return;
  const Section section(reading, root.table("sensitivities", "[sensitivities]"), language.sensitivities);
  const std::vector<std::string> paths = section.texts("keys");
  for (std::size_t i = 0; i < paths.size(); ++i) {
    auto [found, problem] = quantity_at(paths[i], tree, scenario);
    const auto is_same = [&](const SensitivityKey& other) { return other.key == paths[i]; };
    if (std::ranges::any_of(scenario.sensitivities, is_same)) problem = fmt::format("'{}' is there twice", paths[i]);
    if (!problem.empty()) {
      reading.faults.add(section.value_place("keys", i),
                         problem +
                             "; expected the path of a number that the scenario gives, for example "
                             "\"material.yield_stress\"");
    } else {
      scenario.sensitivities.push_back(std::move(*found));
    }
  }
}

}  // namespace

CheckedScenario read_tree(const toml::table& tree, const std::string& origin, const FileTexts* files,
                          FaultList& faults) {
  const Language& language = language_of(model_to_check_against(tree));
  Reading reading{.faults = faults,
                  .homes = language.homes,
                  .folder = std::filesystem::path(origin).parent_path(),
                  .recorded = files};
  const SourceLocation top{origin};
  const Section root(reading, {&tree, top, "the scenario"}, language.root, language.foreign_tables);

  CheckedScenario scenario;
  scenario.title = root.text("title");
  scenario.model = root.text("model");
  read_particle(reading, root, language, scenario);
  if (language.model != nullptr) {
    read_material(reading, root, language, scenario);
    read_options(reading, root, language, scenario);
  }
  if (!language.loading.empty()) {
    scenario.loading = read_loading(reading, root.table("loading", "[loading]"), language);
  }
  const std::size_t faults_so_far = reading.faults.size();
  read_output(reading, root, language, scenario);
  read_numerics(reading, root, language, scenario);
  if (faults_so_far == 0) read_sensitivities(reading, root, tree, language, scenario);
  if (language.model != nullptr && faults_so_far == 0) check_rules(reading, tree, origin, language, scenario);
  std::ranges::move(reading.doubtful_paths, std::back_inserter(scenario.doubts));
  // Without any unit, the file may be meant in units of its own, with a modulus of one.
  if (reading.has_units) std::ranges::move(reading.doubtful_scales, std::back_inserter(scenario.doubts));
  return scenario;
}

}  // namespace monograin
