#include "study/calibrate/scenario_section.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "scenario/edit.hpp"
#include "scenario/words.hpp"

namespace monograin::calibration {

namespace fs = std::filesystem;

CheckedScenario NamedScenario::with(const std::vector<std::string>& overrides) const {
  return document.empty() ? read_scenario(file, overrides)
                          : parse_scenario_table(document, "scenario", file, overrides);
}

std::shared_ptr<const ScenarioTemplate> NamedScenario::variants(const std::vector<std::string>& overrides) const {
  ScenarioSource source{.text = document.empty() ? text : document, .origin = file};
  if (!document.empty()) source.table = "scenario";
  return std::make_shared<const ScenarioTemplate>(std::move(source), overrides);
}

std::optional<NamedScenario> scenario_in(Reading& reading, const Section& root, bool is_table, const std::string& text,
                                         const std::string& file) {
  if (!root.has("scenario")) return {};
  NamedScenario found{.file = file, .document = is_table ? text : std::string()};
  if (!is_table) {
    const std::string name = root.text("scenario");
    if (name.empty()) return {};
    const fs::path path = fs::path(file).parent_path() / name;
    if (!fs::is_regular_file(path)) {
      reading.faults.add(
          root.value_place("scenario"),
          fmt::format("scenario = \"{}\": there is no such file ({}); expected a path relative to this file",
                      shown(name), on_one_line(path.string())));
      return {};
    }
    found.file = path.string();
  }
  try {
    found.checked = found.with({});
    found.text = is_table ? text_of_table(text, "scenario", file) : found.checked.text;
  } catch (const ScenarioError& error) {
    for (const Fault& fault : error.faults()) reading.faults.add(fault.where, fault.message);
    return {};
  }
  return found;
}

}  // namespace monograin::calibration
