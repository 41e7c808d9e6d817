// `monograin models --for`: the scene of a scenario under every law.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "catalogue.hpp"
#include "cli/commands.hpp"
#include "cli/data_folder.hpp"
#include "cli/terminal.hpp"
#include "figure/markdown.hpp"
#include "history/run.hpp"
#include "scenario/document.hpp"
#include "scenario/language.hpp"
#include "study/atlas/atlas.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr std::size_t k_shown_faults = 3;
constexpr double k_least_coverage_of_band = 0.5;  ///< share of a band from which on an error stands for it

/// The figure that holds every law against finite elements, and its tables by configuration.
constexpr const char* k_comparison = "laws-fe";
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> k_fe_tables{
    {{"simple", "By strain: two walls"}, {"die", "By strain: die"}, {"hydrostatic", "By strain: six walls at once"}}};

/// Outcome of a scene under one law.
struct Trial {
  std::string outcome;  ///< "runs", "stops", "fails" or "cannot"
  std::string remark;   ///< why it does not run to the end; or its first warning
  double depth = 0.0;   ///< largest displacement of a wall, over R0
};

/// The scenario with another law: without the tables and the numbers of the material that this law does not know.
[[nodiscard]] std::string text_for(toml::table scenario, const Model& model) {
  scenario.insert_or_assign("model", model.name);
  scenario.erase("sensitivities");
  for (const Model& other : model_catalogue()) {
    if (other.name != model.name) scenario.erase(other.name);
  }
  if (toml::table* numerics = scenario["numerics"].as_table()) numerics->erase("integrator");
  if (toml::table* material = scenario["material"].as_table()) {
    const std::vector<KeySpec>& known = language_of(model.name).material;
    std::vector<std::string> unknown;
    for (const auto& [key, value] : *material) {
      if (find_key(known, key.str()) == nullptr) unknown.emplace_back(key.str());
    }
    for (const std::string& key : unknown) material->erase(key);
  }
  std::ostringstream text;
  text << scenario;
  return text.str();
}

[[nodiscard]] double depth_of(const Run& run) {
  double depth = 0.0;
  const Table& history = run.record.history;
  for (const Column& column : history.columns()) {
    if (!column.name.ends_with(".displacement")) continue;
    for (const double value : history.column(column.name)) depth = std::fmax(depth, value / run.scenario.radius);
  }
  return depth;
}

[[nodiscard]] Trial try_law(const toml::table& scenario, const std::string& file, const Model& model) {
  try {
    const Run run = run_scenario(parse_scenario(text_for(scenario, model), file));
    const std::vector<std::string>& warnings = run.record.warnings;
    Trial trial{
        .outcome = "runs", .remark = warnings.empty() ? "" : "warning: " + warnings.front(), .depth = depth_of(run)};
    if (run.record.status == RunStatus::complete) return trial;
    trial.outcome = run.record.status == RunStatus::stopped ? "stops" : "fails";
    trial.remark = run.record.message;
    return trial;
  } catch (const ScenarioError& error) {
    std::set<std::string> faults;  // without what was expected: the law is tried, not the file mended
    for (const Fault& fault : error.faults()) faults.insert(fault.message.substr(0, fault.message.find("; expected")));
    std::vector<std::string> shown(faults.begin(), faults.end());
    if (shown.size() > k_shown_faults) shown.resize(k_shown_faults);
    return {.outcome = "cannot", .remark = fmt::format("{}", fmt::join(shown, "; "))};
  }
}

/// Largest deviation of a law's force from finite elements in the bands of displacement that the scene passes, as text;
/// a hyphen where there are no such results.
[[nodiscard]] std::string distance_of(const ComparisonTable& table, std::string_view law, double depth) {
  for (const ComparisonRow& row : table.rows) {
    const std::size_t colon = row.label.rfind(": ");
    const bool is_main = row.quantity.empty() || row.quantity == "axial force";
    if (!is_main || colon == std::string::npos || row.label.substr(colon + 2) != law) continue;
    double largest = 0.0;
    double end = 0.0;
    for (const BranchComparison& line : row.lines) {
      if (end > 0.0 && end >= depth) break;
      if (!(line.coverage >= k_least_coverage_of_band)) continue;
      largest = std::fmax(largest, line.largest);
      end = line.reversal;
    }
    if (!(end > 0.0)) continue;
    return fmt::format("{:.1f} % to {:g} R0, {}", 100.0 * largest, end, row.label.substr(0, colon));
  }
  return "-";
}

/// The table of a configuration in the comparison with finite elements; none for other walls.
[[nodiscard]] std::optional<ComparisonTable> fe_table_of(std::string_view configuration) {
  const auto known = std::ranges::find(k_fe_tables, configuration, [](const auto& table) { return table.first; });
  if (known == k_fe_tables.end()) return std::nullopt;
  const std::filesystem::path definitions = find_data({"plots"}).path("plots");
  for (const AtlasFigure& figure : make_atlas(definitions, {k_comparison})) {
    for (const ComparisonTable& table : figure.tables) {
      if (table.title == known->second) return table;
    }
  }
  return std::nullopt;
}

}  // namespace

int show_laws_for(const std::string& file) {
  const CheckedScenario own = read_scenario(file, {}, FileKind::any);
  if (!find_model(own.model)->has_walls()) {
    throw UsageError(
        fmt::format("{}: model '{}' has no walls; laws of contact are compared on walls", file, own.model));
  }
  const toml::table scenario = parse_document(own.text, file);
  const std::string configuration = scenario["loading"]["configuration"].value_or("");
  const auto table = fe_table_of(configuration);
  constexpr std::size_t k_column = 14;  // of the remarks
  std::vector<MarkdownRow> rows{{"law", "scene", "force off finite elements"}};
  std::string remarks;
  for (const Model& model : model_catalogue()) {
    if (!model.has_walls()) continue;
    const Trial trial = try_law(scenario, file, model);
    const bool has_distance = table && trial.outcome != "cannot";
    rows.push_back(
        {std::string(model.name), trial.outcome, has_distance ? distance_of(*table, model.name, trial.depth) : "-"});
    if (!trial.remark.empty()) remarks += list_entry(model.name, k_column, trial.remark);
  }
  std::string text;
  append_markdown(text, rows);
  text += fmt::format("\n{}\n", remarks);
  text += list_entry(
      "", 0,
      table
          ? "\"Force off finite elements\": largest deviation of the force of the walls that drive, loading the named "
            "material in this configuration, in the bands of displacement that the scene passes. The material of "
            "the scene may be nearer, or farther off: monograin continuum computes that."
          : "There are no stored finite-element results for these walls; monograin continuum may compute them.");
  print_data("{}", text);
  return k_success;
}

}  // namespace monograin
