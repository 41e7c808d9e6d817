#include "monograin/scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "api/checked.hpp"
#include "api/untrapped.hpp"
#include "scenario/document.hpp"
#include "scenario/faults.hpp"
#include "scenario/overrides.hpp"
#include "scenario/text_file.hpp"
#include "scene/scene.hpp"

namespace monograin {

namespace {

/// Path of a `key=value` text.
std::string_view path_of(std::string_view text) { return text.substr(0, text.find('=')); }

/// True if one path is within the other, or if a range of entries may make it so ("wall[2-5].gap", "wall[3].gap").
bool may_meet(std::string_view a, std::string_view b) {
  const auto is_within = [](std::string_view inner, std::string_view outer) {
    return inner.starts_with(outer) &&
           (inner.size() == outer.size() || inner[outer.size()] == '.' || inner[outer.size()] == '[');
  };
  const auto has_range = [](std::string_view path) {
    const std::size_t index = path.find('[');
    return index != path.npos && path.find('-', index) != path.npos;
  };
  const auto array = [](std::string_view path) { return path.substr(0, path.find('[')); };
  const bool share_a_range = (has_range(a) || has_range(b)) && array(a) == array(b);
  return share_a_range || is_within(a, b) || is_within(b, a);
}

}  // namespace

CheckedScenario checked(const Scenario& scenario) {
  if (!scenario.files()) return parse_scenario(scenario.text(), scenario.origin(), scenario.overrides());
  return parse_recorded_scenario(scenario.text(), scenario.origin(), scenario.overrides(), *scenario.files());
}

Scenario Scenario::parse(std::string text, std::string origin, std::vector<std::string> overrides,
                         std::optional<std::map<std::string, std::string>> files) {
  Scenario scenario;
  scenario.text_ = std::move(text);
  scenario.origin_ = std::move(origin);
  scenario.overrides_ = std::move(overrides);
  scenario.files_ = std::move(files);
  return scenario;
}

void set_override(std::vector<std::string>& overrides, std::string text) {
  for (auto earlier = overrides.rbegin(); earlier != overrides.rend(); ++earlier) {
    if (path_of(*earlier) == path_of(text)) {
      *earlier = std::move(text);
      return;
    }
    if (may_meet(path_of(*earlier), path_of(text))) break;
  }
  overrides.push_back(std::move(text));
}

Scenario& Scenario::set_value(std::string_view key, std::string_view value) {
  set_override(overrides_, fmt::format("{}={}", key, value));
  return *this;
}

// fmt prints the shortest text that reads back as the same number. Without a fraction that is an integer in TOML, which
// every key of a number accepts.
Scenario& Scenario::set(std::string_view key, double value) { return set_value(key, fmt::format("{}", value)); }
Scenario& Scenario::set(std::string_view key, bool value) { return set_value(key, value ? "true" : "false"); }
Scenario& Scenario::set(std::string_view key, std::string_view text) { return set_value(key, in_quotes(text)); }

Scenario& Scenario::set(std::string_view key, std::span<const double> values) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(fmt::format("{}", value));
  return set_value(key, fmt::format("[{}]", fmt::join(texts, ", ")));
}

Scenario& Scenario::set(std::string_view key, std::span<const std::string> texts) {
  std::vector<std::string> quoted;
  for (const std::string& text : texts) quoted.push_back(in_quotes(text));
  return set_value(key, fmt::format("[{}]", fmt::join(quoted, ", ")));
}

std::vector<Fault> Scenario::validate() const {
  const Untrapped untrapped;
  try {
    // make_scene() checks walls and their programs.
    static_cast<void>(make_scene(checked(*this)));
    return {};
  } catch (const ScenarioError& error) {
    return error.faults();
  }
}

std::vector<Parameter> Scenario::parameters() const {
  const Untrapped untrapped;
  std::vector<Parameter> parameters;
  for (const DerivedParameter& parameter : derived_parameters(checked(*this))) {
    parameters.push_back({std::string(parameter.name), parameter.value, std::string(parameter.unit)});
  }
  return parameters;
}

Scenario read_scenario(const std::filesystem::path& file) {
  auto [text, name] = read_named_text(file, "a scenario file");
  return Scenario::parse(std::move(text), name.string());
}

}  // namespace monograin
