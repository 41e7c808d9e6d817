#include "study/atlas/atlas.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "catalogue.hpp"
#include "history/profile.hpp"
#include "history/run.hpp"
#include "scenario/text_file.hpp"
#include "scenario/words.hpp"
#include "study/atlas/adhesion_panels.hpp"
#include "study/atlas/definition.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;
using Values = std::vector<double>;

constexpr std::size_t k_parameter_values = 201;

[[nodiscard]] std::vector<fs::path> chosen_files(const fs::path& folder, const std::vector<std::string>& names) {
  const std::vector<fs::path> files = toml_files(folder, "definition", "--plots");
  if (names.empty()) return files;
  std::vector<std::string> known;
  for (const fs::path& file : files) known.push_back(file.stem().string());
  const std::vector<std::string_view> words(known.begin(), known.end());
  std::vector<fs::path> chosen;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(known, name);
    if (found == known.end()) {
      throw std::runtime_error(fmt::format("{} has no definition '{}'{}; it has {}", folder.string(), name,
                                           did_you_mean(name, words), listed(words)));
    }
    chosen.push_back(files[static_cast<std::size_t>(found - known.begin())]);
  }
  return chosen;
}

// --- values of formulas

/// Values of the names in a formula: columns of a table, t, numbers of the table's header (R0, E, nu, Y,
/// surface_energy), numbers that follow from these (Es, V0, pi), and parameters that a model derives from its scenario.
class Scope {
 public:
  explicit Scope(const Table* table, std::vector<DerivedParameter> derived = {}, Values parameter = {})
      : table_(table), derived_(std::move(derived)), parameter_(std::move(parameter)) {}

  [[nodiscard]] std::optional<Values> operator()(std::string_view name) const {
    if (name == "t" && !parameter_.empty()) return parameter_;
    if (name == "pi") return Values{std::numbers::pi};
    if (const auto column = find_column(name); column && parameter_.empty()) {
      if (table_->columns()[*column].holds_words()) return std::nullopt;
      return table_->column(name);
    }
    const auto value = symbol(name);
    return value ? std::optional(Values{*value}) : std::nullopt;
  }

  /// Names that could have been meant, for a message about an unknown name.
  [[nodiscard]] std::string hint(std::string_view unknown) const {
    std::vector<std::string_view> names{"pi"};
    if (!parameter_.empty()) names.emplace_back("t");
    for (const std::string_view name : {"R0", "E", "nu", "Y", "surface_energy", "Es", "V0"}) {
      if (symbol(name)) names.push_back(name);
    }
    for (const DerivedParameter& parameter : derived_) names.push_back(parameter.name);
    if (table_ != nullptr && parameter_.empty()) {
      for (const Column& column : table_->columns()) {
        if (!column.holds_words()) names.push_back(column.name);
      }
    }
    if (unknown.empty()) return {};
    const std::string suggestion = did_you_mean(unknown, names);
    return suggestion.empty() ? "; there are " + listed(names) : suggestion;
  }

 private:
  [[nodiscard]] std::optional<std::size_t> find_column(std::string_view name) const {
    return table_ == nullptr ? std::nullopt : table_->find(name);
  }

  [[nodiscard]] std::optional<double> header_number(std::string_view name) const {
    return table_ == nullptr ? std::nullopt : table_->header_number(name);
  }

  [[nodiscard]] std::optional<double> symbol(std::string_view name) const {
    if (name == "Es") {
      const auto modulus = header_number("E");
      const auto ratio = header_number("nu");
      if (modulus && ratio) return *modulus / (1.0 - *ratio * *ratio);
    } else if (name == "V0") {
      if (const auto radius = header_number("R0")) return 4.0 / 3.0 * std::numbers::pi * std::pow(*radius, 3);
    }
    if (const auto number = header_number(name)) return number;
    const auto found = std::ranges::find(derived_, name, &DerivedParameter::name);
    return found == derived_.end() ? std::nullopt : std::optional(found->value);
  }

  const Table* table_;
  std::vector<DerivedParameter> derived_;
  Values parameter_;
};

[[nodiscard]] Values evaluated(const PlacedExpression& formula, const Scope& scope, FaultList& faults) {
  try {
    return formula.expression.evaluate(std::cref(scope));
  } catch (const ExpressionError& error) {
    SourceLocation where = formula.where;
    where.column += error.offset();
    faults.add(where, fmt::format("{}{}", error.what(), scope.hint(error.unknown_name())));
    return {};
  }
}

/// Evaluates two formulas over the rows of a table. A formula without a column has one value, which holds for all rows.
[[nodiscard]] XyCurve curve_of(const PlacedExpression& x, const PlacedExpression& y, const Scope& scope,
                               FaultList& faults) {
  XyCurve curve{evaluated(x, scope, faults), evaluated(y, scope, faults)};
  const std::size_t rows = std::max(curve.x.size(), curve.y.size());
  if (curve.x.size() == 1) curve.x.assign(rows, curve.x.front());
  if (curve.y.size() == 1) curve.y.assign(rows, curve.y.front());
  if (curve.x.size() != curve.y.size()) curve = {};  // one of the formulas is at fault
  return curve;
}

[[nodiscard]] XyCurve chosen_rows(const XyCurve& curve, RowChoice rows) {
  switch (rows) {
    case RowChoice::all:
      return curve;
    case RowChoice::load:
      return first_loading(curve);
    case RowChoice::unload:
      break;
  }
  XyCurve chosen;
  for (const XyCurve& unloading : unloadings(curve)) {
    if (!chosen.x.empty()) {  // the line breaks between two unloadings
      chosen.x.push_back(k_nan);
      chosen.y.push_back(k_nan);
    }
    chosen.x.insert(chosen.x.end(), unloading.x.begin(), unloading.x.end());
    chosen.y.insert(chosen.y.end(), unloading.y.begin(), unloading.y.end());
  }
  return chosen;
}

[[nodiscard]] Values parameter_values(const CurveSpec::Parameter& parameter) {
  Values values;
  for (std::size_t k = 0; k < k_parameter_values; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(k_parameter_values - 1);
    values.push_back(std::lerp(parameter.from, parameter.to, share));
  }
  return values;
}

/// Derived parameters as columns, with a row for each scenario; nan if a scenario lacks a parameter of the first one.
[[nodiscard]] Table derived_table(std::span<const CheckedScenario> scenarios) {
  std::vector<Column> columns;
  for (const DerivedParameter& parameter : derived_parameters(scenarios.front())) {
    columns.push_back({.name = std::string(parameter.name), .unit = std::string(parameter.unit)});
  }
  Table table(std::move(columns));
  for (const CheckedScenario& scenario : scenarios) {
    const auto derived = derived_parameters(scenario);
    Values row;
    for (const Column& column : table.columns()) {
      const auto found = std::ranges::find(derived, column.name, &DerivedParameter::name);
      row.push_back(found == derived.end() ? k_nan : found->value);
    }
    table.append(row);
  }
  return table;
}

// --- definitions

class FigureMaker {
 public:
  FigureMaker(const Definition& definition, FaultList& faults) : definition_(definition), faults_(faults) {}

  [[nodiscard]] AtlasFigure make() {
    made_ = {.name = definition_.name,
             .title = definition_.title,
             .source = definition_.source,
             .format = definition_.format};
    if (definition_.adhesion_map) {
      made_.chart.panels = adhesion_panels(adhesion_maps(*definition_.adhesion_map));
      for (const Model& model : model_catalogue()) {
        if (model.adhesion_map != nullptr) cite(model);
      }
    }
    for (const PanelSpec& panel : definition_.panels) made_.chart.panels.push_back(chart_panel(panel));
    for (const TableSpec& table : definition_.tables) made_.tables.push_back(comparison_table(table));
    for (const ValueTableSpec& table : definition_.value_tables) made_.value_tables.push_back(value_table(table));
    return std::move(made_);
  }

 private:
  void cite(const Model& model) {
    for (std::string& text : reference_texts(model)) made_.chart.references.push_back(std::move(text));
  }

  [[nodiscard]] figure::ChartPanel chart_panel(const PanelSpec& spec) {
    figure::ChartPanel panel{.x = spec.x, .y = spec.y, .note = spec.note, .range = spec.fitted};
    for (const CurveSpec& curve : spec.curves) append_curves(curve, panel);
    for (const PointsSpec& points : spec.points) panel.series.push_back(chart_points(points));
    return panel;
  }

  void append_curves(const CurveSpec& spec, figure::ChartPanel& panel) {
    for (const CheckedScenario& scenario : spec.scenarios) cite(*find_model(scenario.model));
    std::vector<XyCurve> curves = curves_of(spec);
    // Runs that give a single number each make one curve of these numbers.
    const bool is_one = curves.size() > 1 && std::ranges::all_of(curves, [](const auto& c) { return c.x.size() == 1; });
    if (is_one) {
      XyCurve joined;
      for (const XyCurve& curve : curves) {
        joined.x.push_back(curve.x.front());
        joined.y.push_back(curve.y.front());
      }
      curves = {std::move(joined)};
    }
    for (std::size_t k = 0; k < curves.size(); ++k) {
      XyCurve curve = chosen_rows(curves[k], spec.rows);
      panel.series.push_back({.legend = spec.legends[std::min(k, spec.legends.size() - 1)],
                              .style = spec.styles[std::min(k, spec.styles.size() - 1)],
                              .colour = spec.colour,
                              .x = std::move(curve.x),
                              .y = std::move(curve.y),
                              .is_error = !spec.references.empty()});
    }
  }

  /// One curve for each run, or for each sweep; one for a formula without a run.
  [[nodiscard]] std::vector<XyCurve> curves_of(const CurveSpec& spec) {
    const Values parameter = spec.parameter ? parameter_values(*spec.parameter) : Values{};
    std::vector<XyCurve> curves;
    if (spec.sweep > 0) {
      for (std::size_t first = 0; first < spec.scenarios.size(); first += spec.sweep) {
        const Table table = derived_table(std::span(spec.scenarios).subspan(first, spec.sweep));
        curves.push_back(curve_of(spec.x, spec.y, Scope(&table), faults_));
      }
      return curves;
    }
    const auto curve_from = [&](const CheckedScenario& scenario) {
      const Table& table = spec.profile_at          ? profiles_of(scenario, *spec.profile_at)
                           : !spec.at_event.empty() ? states_at(scenario, spec.at_event)
                                                    : run_of(scenario).history;
      return curve_of(spec.x, spec.y, Scope(&table, derived_parameters(scenario), parameter), faults_);
    };
    for (const CheckedScenario& scenario : spec.scenarios) curves.push_back(curve_from(scenario));
    for (std::size_t k = 0; k < spec.references.size(); ++k) {
      const Values reference = curve_from(spec.references[k]).y;
      Values& y = curves[k].y;
      if (y.size() != reference.size()) {
        faults_.add(spec.y.where, fmt::format("{} rows, and {} in the run that they are held against; expected as many",
                                              y.size(), reference.size()));
        continue;
      }
      for (std::size_t row = 0; row < y.size(); ++row) y[row] = std::abs(y[row] - reference[row]);
    }
    if (spec.scenarios.empty()) curves.push_back(curve_of(spec.x, spec.y, Scope(nullptr, {}, parameter), faults_));
    return curves;
  }

  /// Runs a scenario; panels with other columns of a run share its record.
  [[nodiscard]] const RunRecord& run_of(const CheckedScenario& scenario) {
    const auto [entry, is_new] = runs_.try_emplace(scenario_digest(scenario));
    RunRecord& record = entry->second;
    if (!is_new) return record;
    record = run_scenario(scenario).record;
    if (record.status != RunStatus::complete) {
      made_.stops.push_back(fmt::format("{}: {}: {}", scenario.name, to_string(record.status), record.message));
      made_.status = std::max(made_.status, record.status);
    }
    return record;
  }

  /// The states just after the events with a name.
  [[nodiscard]] const Table& states_at(const CheckedScenario& scenario, const std::string& event) {
    const auto [entry, is_new] = tables_.try_emplace(fmt::format("{} at {}", scenario_digest(scenario), event));
    if (!is_new) return entry->second;
    const RunRecord& record = run_of(scenario);
    const std::size_t name = *record.events.find("event");
    entry->second = Table(record.events.columns());
    entry->second.header = record.history.header;
    for (std::size_t row = 0; row < record.events.row_count(); ++row) {
      if (record.events.word(row, name) == event) entry->second.append(record.events.row(row));
    }
    return entry->second;
  }

  /// Pressure and surface under the contacts of the first class.
  [[nodiscard]] const Table& profiles_of(const CheckedScenario& scenario, double time) {
    const auto [entry, is_new] = tables_.try_emplace(fmt::format("{} at {}", scenario_digest(scenario), time));
    if (!is_new) return entry->second;
    const Table all = contact_profiles(scenario, time);
    entry->second = Table(all.columns());
    entry->second.header = all.header;
    for (std::size_t row = 0; row < all.row_count(); ++row) {
      if (all.at(row, 0) == 0.0) entry->second.append(all.row(row));
    }
    return entry->second;
  }

  /// The rows of a file that a definition selects.
  [[nodiscard]] XyCurve points_of(const PointsSpec& spec) {
    const Scope scope(&spec.table);
    XyCurve all = curve_of(spec.x, spec.y, scope, faults_);
    if (!spec.where) return all;
    const Values kept = evaluated(*spec.where, scope, faults_);
    XyCurve chosen;
    for (std::size_t row = 0; row < std::min(all.x.size(), kept.size()); ++row) {
      if (kept[row] != 0.0) continue;
      chosen.x.push_back(all.x[row]);
      chosen.y.push_back(all.y[row]);
    }
    if (chosen.x.empty() && !kept.empty()) faults_.add(spec.where->where, "'where' is zero in no row of the file");
    return chosen;
  }

  [[nodiscard]] figure::ChartSeries chart_points(const PointsSpec& spec) {
    const XyCurve curve = chosen_rows(points_of(spec), spec.rows);
    figure::ChartSeries series{
        .legend = spec.legend, .style = figure::ChartSeries::Style::points, .colour = spec.colour};
    for (std::size_t row = 0; row < curve.x.size(); row += spec.every) {
      series.x.push_back(curve.x[row]);
      series.y.push_back(curve.y[row]);
    }
    return series;
  }

  [[nodiscard]] ComparisonTable comparison_table(const TableSpec& spec) {
    ComparisonTable table{.title = spec.title, .has_bands = !spec.bands.empty()};
    for (const ComparisonSpec& row : spec.rows) {
      const XyCurve reference = points_of(row.points);
      const std::vector<XyCurve> curves = curves_of(row.curve);
      for (std::size_t k = 0; k < curves.size(); ++k) {
        if (reference.x.empty() || curves[k].x.empty()) continue;
        const std::string label = row.curve.variants.empty() ? row.label : row.label + ": " + row.curve.variants[k];
        try {
          auto lines = table.has_bands ? compare_bands(reference, curves[k], spec.bands, least_of(row, k))
                                       : compare_branches(reference, curves[k]);
          table.rows.push_back({label, std::move(lines), row.quantity, row.measures});
        } catch (const std::runtime_error& error) {
          faults_.add(row.curve.y.where, fmt::format("{}: {}", label, error.what()));
        }
      }
    }
    // One line of the table contains all quantities of a label.
    std::map<std::string, std::size_t> order;
    for (const ComparisonRow& row : table.rows) order.try_emplace(row.label, order.size());
    std::ranges::stable_sort(table.rows, {}, [&](const ComparisonRow& row) { return order.at(row.label); });
    return table;
  }

  /// Magnitude of the reference below which the loading is not measured.
  [[nodiscard]] double least_of(const ComparisonSpec& row, std::size_t curve) {
    if (!row.least) return 0.0;
    if (row.curve.scenarios.size() <= curve) return 0.0;
    const CheckedScenario& scenario = row.curve.scenarios[curve];
    const Scope scope(&run_of(scenario).history, derived_parameters(scenario));
    const Values values = evaluated(*row.least, scope, faults_);
    return values.empty() ? 0.0 : values.front();
  }

  [[nodiscard]] ValueTable value_table(const ValueTableSpec& spec) {
    ValueTable table{.title = spec.title};
    for (const ValueSpec& row : spec.rows) {
      const Values value = evaluated(row.value, Scope(nullptr, derived_parameters(*row.scenario)), faults_);
      if (value.empty()) continue;
      table.rows.push_back({row.label, value.front(), row.printed, {}, row.remark});
      if (!row.reference) continue;
      const Values rows = points_of(*row.reference).y;
      if (rows.empty()) continue;
      const double count = static_cast<double>(rows.size());
      table.rows.back().reference = std::accumulate(rows.begin(), rows.end(), 0.0) / count;
    }
    return table;
  }

  const Definition& definition_;
  FaultList& faults_;
  AtlasFigure made_;
  std::map<std::string, RunRecord> runs_;
  std::map<std::string, Table> tables_;  ///< profiles, and states at events
};

/// Adds the faults of an error to other faults.
void collect(const ScenarioError& error, FaultList& faults) {
  for (const Fault& fault : error.faults()) faults.add(fault.where, fault.message);
}

[[nodiscard]] std::vector<Definition> read_definitions(const std::vector<fs::path>& files) {
  FaultList faults;
  std::vector<Definition> definitions;
  for (const fs::path& file : files) {
    try {
      definitions.push_back(read_definition(file, faults));
    } catch (const ScenarioError& error) {
      collect(error, faults);
    }
  }
  faults.throw_if_any();
  return definitions;
}

}  // namespace

std::vector<AtlasEntry> list_atlas(const fs::path& definitions) {
  std::vector<AtlasEntry> entries;
  for (const Definition& definition : read_definitions(toml_files(definitions, "definition", "--plots"))) {
    entries.push_back({definition.name, definition.title});
  }
  return entries;
}

std::vector<AtlasFigure> make_atlas(const fs::path& folder, const std::vector<std::string>& names,
                                    const std::function<void(std::size_t, std::size_t)>& progress) {
  FaultList faults;
  std::vector<AtlasFigure> figures;
  const std::vector<Definition> definitions = read_definitions(chosen_files(folder, names));
  for (const Definition& definition : definitions) {
    figures.push_back(FigureMaker(definition, faults).make());
    if (progress) progress(figures.size(), definitions.size());
  }
  faults.throw_if_any();
  return figures;
}

}  // namespace monograin
