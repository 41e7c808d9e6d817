#include "scenario/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "scenario/curve_file.hpp"
#include "scenario/language.hpp"
#include "scenario/loading_reader.hpp"
#include "scenario/section.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

/// The model whose language the file is checked against: the one it names, or a near one that it misspells.
std::string model_to_check_against(const toml::table& root) {
  const std::string word = root["model"].value_or(std::string());
  const auto reserved = reserved_models();
  if (find_model(word) != nullptr || std::ranges::find(reserved, word) != reserved.end()) return word;
  std::vector<std::string_view> names;
  for (const ModelInfo& model : model_catalogue()) names.push_back(model.name);
  const std::string_view nearest = nearest_word(word, names);
  return nearest.empty() ? word : std::string(nearest);
}

void read_particle(Reading& reading, const Section& root, const Language& language, Scenario& scenario) {
  const Section particle(reading, root.table("particle", "[particle]"), language.particle);
  if (const auto radius = particle.number("radius")) {
    scenario.radius = *radius;
    reading.initial_radius = *radius;
  }
}

void read_material(Reading& reading, const Section& root, const Language& language, Scenario& scenario) {
  const Section material(reading, root.table("material", "[material]"), language.material, language.foreign_material);
  for (const KeySpec& spec : language.material) {
    if (const auto value = material.number(spec.name)) scenario.material.emplace(spec.name, *value);
  }
}

OptionValue option_value(const Section& options, const KeySpec& spec) {
  if (spec.kind == KeySpec::Kind::toggle) return options.toggle(spec.name).value_or(false);
  return options.text(spec.name);
}

/// The curve in the file that an option names, if it names one.
void read_curve_of(Reading& reading, const Section& options, const KeySpec& spec, const std::filesystem::path& folder,
                   Scenario& scenario) {
  const std::string file = options.text(spec.name);
  if (file.empty()) return;
  const std::string naming = fmt::format("{} = \"{}\"", spec.name, shown(file));
  scenario.curves.emplace(spec.name, read_curve(folder / file, options.value_place(spec.name), naming, reading.faults));
}

void read_options(Reading& reading, const Section& root, const Language& language, const std::string& origin,
                  Scenario& scenario) {
  const std::string name(language.model->name);
  const Section options(reading, root.table(name, "[" + name + "]"), language.options);
  const std::filesystem::path folder = std::filesystem::path(origin).parent_path();
  for (const KeySpec& spec : language.options) {
    scenario.options.emplace(spec.name, option_value(options, spec));
    if (spec.kind == KeySpec::Kind::file) read_curve_of(reading, options, spec, folder, scenario);
  }
}

void read_output(Reading& reading, const Section& root, const Language& language, Scenario& scenario) {
  const Section output(reading, root.table("output", "[output]"), language.output);
  scenario.output.points = static_cast<int>(output.number("points").value_or(0.0));
  scenario.output.times = output.numbers("times");
}

void read_numerics(Reading& reading, const Section& root, const Language& language, Scenario& scenario) {
  const Section numerics(reading, root.table("numerics", "[numerics]"), language.numerics);
  scenario.numerics.integrator = numerics.text("integrator");
  scenario.numerics.rtol = numerics.number("rtol").value_or(0.0);
  scenario.numerics.atol = numerics.number("atol").value_or(0.0);
}

}  // namespace

Scenario read_tree(const toml::table& tree, const std::string& origin, FaultList& faults) {
  const Language language = language_of(model_to_check_against(tree));
  Reading reading{faults};
  const Section root(reading, {&tree, {origin}, "the scenario"}, language.root, language.foreign_tables);

  Scenario scenario;
  scenario.title = root.text("title");
  scenario.model = root.text("model");
  read_particle(reading, root, language, scenario);
  if (language.model != nullptr) {
    read_material(reading, root, language, scenario);
    read_options(reading, root, language, origin, scenario);
  }
  if (!language.loading.empty()) {
    scenario.loading = read_loading(reading, root.table("loading", "[loading]"), language);
  }
  read_output(reading, root, language, scenario);
  read_numerics(reading, root, language, scenario);
  return scenario;
}

}  // namespace monograin
