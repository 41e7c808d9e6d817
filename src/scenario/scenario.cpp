#include "scenario/scenario.hpp"

#include <fmt/format.h>

#include <utility>

#include "scenario/document.hpp"
#include "scenario/faults.hpp"
#include "scenario/overrides.hpp"
#include "scenario/reader.hpp"
#include "scenario/text_file.hpp"

namespace monograin {
namespace {

std::string read_file(const std::filesystem::path& file) {
  // A text beyond the limit is refused by the parser.
  auto [text, problem] = read_text_file(file, k_largest_text);
  if (problem.empty()) return std::move(text);
  throw_fault({file.string()}, problem + "; expected a scenario file");
}

std::string name_of(const std::string& origin) {
  const std::string stem = std::filesystem::path(origin).stem().string();
  return stem.empty() ? "scenario" : stem;
}

Scenario parse_tree(toml::table& root, std::string_view text, const std::string& origin,
                    const std::vector<std::string>& overrides) {
  FaultList faults;
  for (const std::string& override_text : overrides) apply_override(root, override_text, faults);
  Scenario scenario = read_tree(root, origin, faults);
  faults.throw_if_any();
  scenario.name = name_of(origin);
  scenario.text = text;
  scenario.overrides = overrides;
  return scenario;
}

}  // namespace

Scenario read_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_scenario(read_file(file), file.string(), overrides);
}

Scenario parse_scenario(std::string_view text, const std::string& origin, const std::vector<std::string>& overrides) {
  toml::table root = parse_document(text, origin);
  return parse_tree(root, text, origin, overrides);
}

Scenario parse_scenario_table(std::string_view text, std::string_view key, const std::string& origin,
                              const std::vector<std::string>& overrides) {
  toml::table document = parse_document(text, origin);
  toml::table* const table = document[key].as_table();
  if (table == nullptr) throw_fault({origin}, fmt::format("there is no table [{}]; expected a scenario there", key));
  return parse_tree(*table, text, origin, overrides);
}

}  // namespace monograin
