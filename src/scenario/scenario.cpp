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

/// @param overrides  that the tree has already, for the record
CheckedScenario parse_tree(const toml::table& root, std::string_view text, const std::string& origin,
                           std::vector<std::string> overrides, FaultList& faults, const FileTexts* files = nullptr) {
  CheckedScenario scenario = read_tree(root, origin, files, faults);
  faults.throw_if_any();
  scenario.name = name_of(origin);
  scenario.text = text;
  scenario.overrides = std::move(overrides);
  return scenario;
}

CheckedScenario override_and_parse(toml::table root, std::string_view text, const std::string& origin,
                                   const std::vector<std::string>& overrides, const FileTexts* files = nullptr) {
  FaultList faults;
  for (const std::string& override_text : overrides) apply_override(root, override_text, faults);
  return parse_tree(root, text, origin, overrides, faults, files);
}

}  // namespace

struct ScenarioTemplate::Document {
  std::string text;
  std::string key;  ///< of the scenario's table; empty: the whole text
  std::string origin;
  std::vector<std::string> overrides;
  toml::table root;
};

ScenarioTemplate::ScenarioTemplate(std::string_view text, const std::string& origin,
                                   std::vector<std::string> overrides) {
  toml::table root = parse_document(text, origin);
  FaultList faults;
  for (const std::string& override_text : overrides) apply_override(root, override_text, faults);
  faults.throw_if_any();
  document_.reset(new Document{std::string(text), {}, origin, std::move(overrides), std::move(root)});
}

ScenarioTemplate::ScenarioTemplate(std::string_view text, std::string_view key, const std::string& origin)
    : document_(new Document{std::string(text), std::string(key), origin, {}, parse_table(text, key, origin)}) {}

ScenarioTemplate::~ScenarioTemplate() = default;
ScenarioTemplate::ScenarioTemplate(ScenarioTemplate&&) noexcept = default;
ScenarioTemplate& ScenarioTemplate::operator=(ScenarioTemplate&&) noexcept = default;

CheckedScenario ScenarioTemplate::with(const std::vector<std::string>& overrides, std::span<const std::string> keys,
                                       std::span<const double> numbers) const {
  std::vector<std::string> all = document_->overrides;
  all.insert(all.end(), overrides.begin(), overrides.end());
  for (std::size_t k = 0; k < keys.size(); ++k) all.push_back(fmt::format("{}={}", keys[k], numbers[k]));
  try {
    toml::table copy = document_->root;
    FaultList faults;
    for (const std::string& text : overrides) apply_override(copy, text, faults);
    const std::size_t first = all.size() - keys.size();
    for (std::size_t k = 0; k < keys.size(); ++k) apply_number(copy, all[first + k], numbers[k], faults);
    return parse_tree(copy, document_->text, document_->origin, all, faults);
  } catch (const ScenarioError&) {
    // A copy does not know its places, so that faults are located in the text itself.
    const Document& from = *document_;
    return from.key.empty() ? parse_scenario(from.text, from.origin, all)
                            : parse_scenario_table(from.text, from.key, from.origin, all);
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
  return override_and_parse(parse_document(text, origin), text, origin, overrides);
}

CheckedScenario parse_recorded_scenario(std::string_view text, const std::string& origin,
                                        const std::vector<std::string>& overrides, const FileTexts& files) {
  return override_and_parse(parse_document(text, origin), text, origin, overrides, &files);
}

CheckedScenario parse_scenario_table(std::string_view text, std::string_view key, const std::string& origin,
                                     const std::vector<std::string>& overrides) {
  return override_and_parse(parse_table(text, key, origin), text, origin, overrides);
}

}  // namespace monograin
