#include "study/sweep/scenario_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scenario/document.hpp"
#include "scenario/words.hpp"

namespace monograin::sweep {
namespace {

namespace fs = std::filesystem;
using Kind = KeySpec::Kind;

/// Reports an unknown model, without which no key of a material is known.
[[nodiscard]] bool is_model_known(const toml::table& scenario, const fs::path& file, FaultList& faults) {
  const auto model = scenario["model"].value<std::string>();
  if (!model) return true;
  const auto [value, problem] = read_value(*key_at("model", scenario, {}).spec, *model, {});
  if (value) return true;
  faults.add(place_of(scenario["model"].node()->source(), SourceLocation{file.string()}),
             fmt::format("model = \"{}\": {}", shown(*model), problem));
  return false;
}

/// Reads a scenario that has a file of its own.
void read_file(VariedScenario& scenario, Reading& reading, const Section& root, const fs::path& folder) {
  const std::string name = root.text("scenario");
  if (name.empty()) return;
  const fs::path file = folder / name;
  auto [text, problem] = read_text_file(file, k_largest_text);
  if (!problem.empty()) {
    reading.faults.add(root.value_place("scenario"),
                       fmt::format("scenario = \"{}\": {} ({}); expected a scenario file, its path relative to the "
                                   "sweep's folder",
                                   shown(name), problem, on_one_line(file.string())));
    return;
  }
  try {
    scenario.tree = parse_document(text, file.string());
    if (scenario.models.empty() && !is_model_known(scenario.tree, file, reading.faults)) return;
    scenario.made.emplace(ScenarioSource{.text = text, .origin = file.string()});
  } catch (const ScenarioError& error) {
    for (const Fault& fault : error.faults()) reading.faults.add(fault.where, fault.message);
  }
  scenario.name = file.stem().string();
  scenario.folder = file.parent_path();
  scenario.file = {"scenario", name, std::move(text)};
}

[[nodiscard]] double radius_of(const toml::table& scenario) {
  const KeyAnswer radius = key_at("particle.radius", scenario, {});
  const toml::node* node = scenario.at_path("particle.radius").node();
  if (!radius.spec || node == nullptr) return 1.0;
  const auto text = node->value<std::string>();
  const auto [value, problem] = read_value(*radius.spec, text ? *text : shown(*node), {});
  return value ? value->number : 1.0;
}

}  // namespace

KeyAnswer VariedScenario::key(const std::string& path) const {
  KeyAnswer answer = key_at(path, tree, model());
  for (const std::string& varied : models) {
    KeyAnswer other = key_at(path, tree, varied);
    if (!other.spec) continue;
    if (answer.spec) {
      // A choice that one model accepts must not be refused because another lacks it.
      for (const std::string_view choice : other.spec->choices) {
        std::vector<std::string_view>& known = answer.spec->choices;
        if (std::ranges::find(known, choice) == known.end()) known.push_back(choice);
      }
    } else {
      answer = std::move(other);
    }
  }
  return answer;
}

std::optional<Factor> VariedScenario::factor(const std::string& path, const SourceLocation& where,
                                             FaultList& faults) const {
  KeyAnswer answer = key(path);
  // A pair is varied as the single number that may replace it.
  if (answer.spec && answer.spec->kind == Kind::pair) answer.spec->kind = Kind::quantity;
  if (answer.spec && !can_be_varied(answer.spec->kind)) {
    const bool is_table = answer.spec->kind == Kind::table;
    answer.problem = is_table ? fmt::format(
                                    "'{0}' is a table; expected the path of one of its keys in quotes, such as "
                                    "\"{0}.KEY\"",
                                    shown(path))
                              : fmt::format("'{}' has no single value that could be varied", shown(path));
  }
  if (!answer.problem.empty()) {
    faults.add(where, answer.problem);
    return std::nullopt;
  }
  return Factor{.key = path, .spec = std::move(*answer.spec), .where = where};
}

VariedScenario scenario_in(Reading& reading, const Section& root, const toml::table& tree, const NamedText& source) {
  VariedScenario scenario;
  if (const toml::array* models = tree["vary"]["model"]["values"].as_array()) {
    for (const toml::node& model : *models) scenario.models.push_back(model.value_or(std::string()));
  }
  const fs::path folder = source.file.parent_path();
  if (const toml::table* table = tree["scenario"].as_table()) {
    scenario.tree = *table;
    if (scenario.models.empty() && !is_model_known(*table, source.file, reading.faults)) return scenario;
    scenario.made.emplace(ScenarioSource{.text = source.text, .origin = source.file.string(), .table = "scenario"});
    scenario.name = source.file.stem().string();
    scenario.folder = folder;
  } else {
    read_file(scenario, reading, root, folder);
  }
  scenario.radius = radius_of(scenario.tree);
  return scenario;
}

}  // namespace monograin::sweep
