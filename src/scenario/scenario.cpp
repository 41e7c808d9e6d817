#include "scenario/scenario.hpp"

#include <fmt/format.h>

#include <utility>

#include "scenario/document.hpp"
#include "scenario/faults.hpp"
#include "scenario/key_path.hpp"
#include "scenario/overrides.hpp"
#include "scenario/reader.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

std::string read_file(const std::filesystem::path& file, FileKind kind) {
  // A text beyond the limit is refused by the parser.
  auto [text, problem] = read_text_file(file, k_largest_text, kind);
  if (problem.empty()) return std::move(text);
  throw_fault({name_of_file(file, kind).string()}, problem + "; expected a scenario file");
}

std::string name_of(const std::string& origin) {
  const std::string stem = std::filesystem::path(origin).stem().string();
  return stem.empty() ? "scenario" : stem;
}

/// The table of that name, its places kept.
toml::table parse_table(std::string_view text, std::string_view key, const std::string& origin) {
  toml::table document = parse_document(text, origin);
  toml::table* const table = document[key].as_table();
  if (table == nullptr) throw_fault({origin}, fmt::format("there is no table [{}]; expected a scenario there", key));
  return std::move(*table);
}

/// The tree of a source, with overrides in it.
toml::table tree_of(const ScenarioSource& source, const std::vector<std::string>& overrides, FaultList& faults) {
  toml::table root = source.table.empty() ? parse_document(source.text, source.origin)
                                          : parse_table(source.text, source.table, source.origin);
  for (const std::string& override_text : overrides) apply_override(root, override_text, faults);
  return root;
}

/// @param overrides  that the tree has already, for the record
CheckedScenario check_tree(const toml::table& root, const ScenarioSource& source, std::vector<std::string> overrides,
                           FaultList& faults) {
  CheckedScenario scenario = read_tree(root, source.origin, source.files ? &*source.files : nullptr, faults);
  faults.throw_if_any();
  scenario.name = name_of(source.origin);
  scenario.text = source.text;
  if (!scenario.sensitivities.empty()) scenario.variants = std::make_shared<ScenarioTemplate>(source, overrides);
  scenario.overrides = std::move(overrides);
  return scenario;
}

CheckedScenario parse_source(const ScenarioSource& source, const std::vector<std::string>& overrides) {
  FaultList faults;
  const toml::table root = tree_of(source, overrides, faults);
  return check_tree(root, source, overrides, faults);
}

}  // namespace

struct ScenarioTemplate::Document {
  ScenarioSource source;
  std::vector<std::string> overrides;
  toml::table root;
};

ScenarioTemplate::ScenarioTemplate(ScenarioSource source, std::vector<std::string> overrides) {
  FaultList faults;
  toml::table root = tree_of(source, overrides, faults);
  faults.throw_if_any();
  document_.reset(new Document{std::move(source), std::move(overrides), std::move(root)});
}

ScenarioTemplate::~ScenarioTemplate() = default;
ScenarioTemplate::ScenarioTemplate(ScenarioTemplate&&) noexcept = default;
ScenarioTemplate& ScenarioTemplate::operator=(ScenarioTemplate&&) noexcept = default;

CheckedScenario ScenarioTemplate::with(const std::vector<std::string>& overrides, std::span<const std::string> keys,
                                       std::span<const double> numbers) const {
  const ScenarioSource& source = document_->source;
  std::vector<std::string> all = document_->overrides;
  all.insert(all.end(), overrides.begin(), overrides.end());
  for (std::size_t k = 0; k < keys.size(); ++k) all.push_back(fmt::format("{}={}", keys[k], numbers[k]));
  try {
    toml::table copy = document_->root;
    FaultList faults;
    for (const std::string& text : overrides) apply_override(copy, text, faults);
    const std::size_t first = all.size() - keys.size();
    for (std::size_t k = 0; k < keys.size(); ++k) apply_number(copy, all[first + k], numbers[k], faults);
    return check_tree(copy, source, all, faults);
  } catch (const ScenarioError&) {
    return parse_source(source, all);  // a copy does not know its places
  }
}

std::string ScenarioTemplate::problem_of_number(const std::string& key) const {
  using Kind = KeySpec::Kind;
  const toml::table& root = document_->root;
  const KeyAnswer answer = key_at(key, root, root["model"].value_or(std::string()));
  if (!answer.spec) return answer.problem;
  const Kind kind = answer.spec->kind;
  if (kind == Kind::quantity || kind == Kind::integer || kind == Kind::pair) return {};
  return fmt::format("'{}' takes no number", shown(key));
}

std::optional<Control> control_of(Step::Kind kind) noexcept {
  switch (kind) {
    case Step::Kind::displacement:
      return Control::displacement;
    case Step::Kind::force:
      return Control::force;
    case Step::Kind::strain:
      return Control::strain;
    case Step::Kind::stress:
      return Control::stress;
    case Step::Kind::packing_fraction:
      return Control::packing_fraction;
    case Step::Kind::hold:
    case Step::Kind::detach:
      break;
  }
  return std::nullopt;
}

Step::Kind ramp_of(Control control) noexcept {
  switch (control) {
    case Control::displacement:
      return Step::Kind::displacement;
    case Control::force:
      return Step::Kind::force;
    case Control::strain:
      return Step::Kind::strain;
    case Control::stress:
      return Step::Kind::stress;
    case Control::packing_fraction:
      return Step::Kind::packing_fraction;
  }
  return Step::Kind::hold;
}

CheckedScenario read_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                              FileKind kind) {
  return parse_scenario(read_file(file, kind), name_of_file(file, kind).string(), overrides);
}

CheckedScenario parse_scenario(std::string_view text, const std::string& origin,
                               const std::vector<std::string>& overrides) {
  return parse_source({.text = std::string(text), .origin = origin}, overrides);
}

CheckedScenario parse_recorded_scenario(std::string_view text, const std::string& origin,
                                        const std::vector<std::string>& overrides, const FileTexts& files) {
  return parse_source({.text = std::string(text), .origin = origin, .files = files}, overrides);
}

CheckedScenario parse_scenario_table(std::string_view text, std::string_view key, const std::string& origin,
                                     const std::vector<std::string>& overrides) {
  return parse_source({.text = std::string(text), .origin = origin, .table = std::string(key)}, overrides);
}

}  // namespace monograin
