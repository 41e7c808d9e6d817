#include "scenario/scenario.hpp"

#include <fmt/format.h>

#include <utility>

#include "scenario/document.hpp"
#include "scenario/faults.hpp"
#include "scenario/overrides.hpp"
#include "scenario/reader.hpp"

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

Scenario parse_tree(toml::table& root, std::string_view text, const std::string& origin,
                    const std::vector<std::string>& overrides, const FileTexts* files = nullptr) {
  FaultList faults;
  for (const std::string& override_text : overrides) apply_override(root, override_text, faults);
  Scenario scenario = read_tree(root, origin, files, faults);
  faults.throw_if_any();
  scenario.name = name_of(origin);
  scenario.text = text;
  scenario.overrides = overrides;
  return scenario;
}

}  // namespace

struct ScenarioTemplate::Document {
  std::string text;
  std::string key;  ///< of the scenario's table; empty: the whole text
  std::string origin;
  toml::table root;
};

ScenarioTemplate::ScenarioTemplate(std::string_view text, const std::string& origin)
    : document_(new Document{std::string(text), {}, origin, parse_document(text, origin)}) {}

ScenarioTemplate::ScenarioTemplate(std::string_view text, std::string_view key, const std::string& origin)
    : document_(new Document{std::string(text), std::string(key), origin, parse_table(text, key, origin)}) {}

ScenarioTemplate::~ScenarioTemplate() = default;
ScenarioTemplate::ScenarioTemplate(ScenarioTemplate&&) noexcept = default;
ScenarioTemplate& ScenarioTemplate::operator=(ScenarioTemplate&&) noexcept = default;

Scenario ScenarioTemplate::with(const std::vector<std::string>& overrides) const {
  const auto& [text, key, origin, root] = *document_;
  try {
    toml::table copy = root;
    return parse_tree(copy, text, origin, overrides);
  } catch (const ScenarioError&) {
    // A copy does not know its places, so that faults are located in the text itself.
    return key.empty() ? parse_scenario(text, origin, overrides) : parse_scenario_table(text, key, origin, overrides);
  }
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

Scenario read_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides, FileKind kind) {
  return parse_scenario(read_file(file, kind), name_of_file(file, kind).string(), overrides);
}

Scenario parse_scenario(std::string_view text, const std::string& origin, const std::vector<std::string>& overrides) {
  toml::table root = parse_document(text, origin);
  return parse_tree(root, text, origin, overrides);
}

Scenario parse_recorded_scenario(std::string_view text, const std::string& origin,
                                 const std::vector<std::string>& overrides, const FileTexts& files) {
  toml::table root = parse_document(text, origin);
  return parse_tree(root, text, origin, overrides, &files);
}

Scenario parse_scenario_table(std::string_view text, std::string_view key, const std::string& origin,
                              const std::vector<std::string>& overrides) {
  toml::table root = parse_table(text, key, origin);
  return parse_tree(root, text, origin, overrides);
}

}  // namespace monograin
