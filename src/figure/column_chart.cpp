#include "figure/column_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

#include "figure/figure.hpp"
#include "figure/page.hpp"
#include "figure/run_curves.hpp"
#include "history/table.hpp"
#include "history/table_file.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"

namespace monograin::figure {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view k_history = "history.csv";
constexpr std::array k_results_files{k_csv_results, k_hdf5_results};
/// Columns of a sweep's results before and after those of its keys.
constexpr std::string_view k_before_keys = "run";
constexpr std::string_view k_after_keys = "status";

[[nodiscard]] bool is_bare(std::string_view unit) { return unit.empty() || unit == "-"; }

/// Index of a column that a file must have. @param may_hold_words  true for a key of a sweep
[[nodiscard]] std::size_t column_in(const Table& table, const std::string& name, const fs::path& file,
                                    bool may_hold_words) {
  if (const auto found = table.find(name)) {
    if (may_hold_words || !table.columns()[*found].holds_words()) return *found;
    throw FigureError(fmt::format("{}: column '{}' holds words; expected numbers", file.string(), shown(name)));
  }
  std::vector<std::string_view> names;
  for (const Column& column : table.columns()) names.push_back(column.name);
  const std::string suggestion = did_you_mean(name, names);
  throw FigureError(fmt::format("{}: has no column '{}'{}", file.string(), shown(name),
                                suggestion.empty() ? "; expected one of " + on_one_line(listed(names)) : suggestion));
}

/// One unit of a dimension in SI, or the problem.
[[nodiscard]] ParsedQuantity parsed_unit(const std::string& unit, Dimension dimension, const Table& table) {
  if (dimension == Dimension::none) return {{}, "the column is shown in its own unit only"};
  return parse_quantity("1 " + unit, dimension, table.header_number("R0"));
}

/// The dimension of which a column's unit is the SI unit.
[[nodiscard]] Dimension dimension_of(std::string_view unit) {
  const auto found = std::ranges::find(dimensions(), unit, &DimensionInfo::si);
  return found == dimensions().end() ? Dimension::none : found->dimension;
}

[[nodiscard]] ColumnAxis axis_of(const Column& column, const std::string& unit, const Table& table) {
  ColumnAxis axis{.unit = is_bare(column.unit) ? std::string() : column.unit, .dimension = dimension_of(column.unit)};
  if (unit.empty() || unit == column.unit) return axis;
  const auto [factor, problem, symbol] = parsed_unit(unit, axis.dimension, table);
  if (!factor) throw FigureError(fmt::format("unit '{}' for '{}': {}", shown(unit), column.heading(), problem));
  axis.unit = unit;
  axis.factor = *factor;
  return axis;
}

[[nodiscard]] ChartAxis shown_axis(const Column& column, const ColumnAxis& axis) {
  const std::string name = verbatim_text(column.name);
  ChartAxis shown{.label = axis.unit.empty() ? name : fmt::format("{} [{}]", name, verbatim_text(axis.unit))};
  if (!column.holds_words()) return shown;
  shown.lowest = 0.5;
  shown.highest = static_cast<double>(column.labels.size()) + 0.5;
  for (const std::string& label : column.labels) shown.names.push_back(short_text(label));
  return shown;
}

/// Values of a column in the units of its axis; words are numbered from 1.
[[nodiscard]] std::vector<double> values_of(const Table& table, std::size_t column, const ColumnAxis& axis) {
  std::vector<double> values;
  const double first = table.columns()[column].holds_words() ? 1.0 : 0.0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    values.push_back(table.at(row, column) / axis.factor + first);
  }
  return values;
}

struct Pair {
  std::string x;
  std::string y;
};

/// Indices of the columns of a sweep's keys.
[[nodiscard]] std::vector<std::size_t> keys_of(const Table& results) {
  std::vector<std::size_t> keys;
  for (std::size_t k = 0; k < results.columns().size() && results.columns()[k].name != k_after_keys; ++k) {
    if (results.columns()[k].name != k_before_keys) keys.push_back(k);
  }
  return keys;
}

/// A key that tells the points of a sweep apart.
struct TellingKey {
  std::size_t column;
  std::set<double> values;
};

/// The key after that of the abscissa that has few values, each of them in several runs on average.
[[nodiscard]] std::optional<TellingKey> telling_key(const Table& results, std::size_t x) {
  constexpr std::size_t k_most_values = 6;
  std::vector<std::size_t> keys = keys_of(results);
  if (const auto own = std::ranges::find(keys, x); own != keys.end()) std::rotate(keys.begin(), own, keys.end());
  for (const std::size_t key : keys) {
    if (key == x) continue;
    std::set<double> values;
    for (std::size_t row = 0; row < results.row_count() && values.size() <= k_most_values; ++row) {
      values.insert(results.at(row, key));
    }
    const std::size_t count = values.size();
    if (count > 1 && count <= k_most_values && 2 * count <= results.row_count()) return {{key, std::move(values)}};
  }
  return std::nullopt;
}

/// Points of a sweep; those with the same value of the telling key are a series.
/// @param all  all points; with a legend they remain one series
[[nodiscard]] std::vector<ChartSeries> points_of_sweep(const Table& results, std::size_t x, ChartSeries all) {
  all.style = ChartSeries::Style::points;
  const auto key = all.legend.empty() ? telling_key(results, x) : std::nullopt;
  if (!key) return {std::move(all)};
  const Column& column = results.columns()[key->column];
  const std::string name = column.name.substr(column.name.rfind('.') + 1);
  std::vector<ChartSeries> series;
  for (const double value : key->values) {
    const std::string shown = column.holds_words()
                                  ? column.labels[static_cast<std::size_t>(value)]
                                  : number_with_unit(value, is_bare(column.unit) ? std::string() : column.unit);
    ChartSeries& own = series.emplace_back(ChartSeries{
        .legend = verbatim_text(fmt::format("{} = {}", name, shown)), .style = all.style, .colour = series.size()});
    for (std::size_t row = 0; row < results.row_count(); ++row) {
      if (results.at(row, key->column) != value) continue;
      own.x.push_back(all.x[row]);
      own.y.push_back(all.y[row]);
    }
  }
  return series;
}

/// The columns of the panels for a sweep: each key beside the largest value of the first force.
[[nodiscard]] std::vector<Pair> panels_of_sweep(const Table& results, const ColumnChoice& choice) {
  const auto& columns = results.columns();
  const auto is_largest_force = [](const Column& column) {
    return column.name.starts_with("max.") && column.name.ends_with(".force");
  };
  const auto largest = std::ranges::find_if(columns, is_largest_force);
  const std::string y = !choice.y.empty() ? choice.y : largest != columns.end() ? largest->name : columns.back().name;
  if (!choice.x.empty()) return {{choice.x, y}};
  std::vector<Pair> panels;
  for (const std::size_t key : keys_of(results)) panels.push_back({columns[key].name, y});
  return panels;
}

[[nodiscard]] std::vector<Pair> panels_of(const Table& table, const ColumnChoice& choice, const fs::path& path) {
  if (is_sweep(path)) return panels_of_sweep(table, choice);
  Pair pair{choice.x, choice.y};
  if (!pair.x.empty() && !pair.y.empty()) return {pair};
  const auto driven = driven_class(table);
  if (!driven) throw FigureError(fmt::format("{}: has no contacts; give both columns", path.string()));
  if (pair.x.empty()) pair.x = *driven + ".displacement";
  if (pair.y.empty()) pair.y = *driven + ".force";
  return {pair};
}

/// True if an event belongs to what a column shows: to its contact, or to the particle.
[[nodiscard]] bool belongs_to(const Table& events, std::size_t row, std::string_view column) {
  const auto of_class = events.find("class");
  if (!of_class || !events.columns()[*of_class].holds_words() || column.find('.') == std::string_view::npos)
    return true;
  const std::vector<std::string> classes = classes_of_event(events.word(row, *of_class));
  return std::ranges::any_of(classes,
                             [&](const std::string& name) { return name.empty() || column.starts_with(name + "."); });
}

void add_events(ChartPanel& panel, const Table& events, const Pair& pair, const ColumnAxis& x_axis,
                const ColumnAxis& y_axis) {
  const auto name = events.find("event");
  const auto x = events.find(pair.x);
  const auto y = events.find(pair.y);
  if (!name || !x || !y || !events.columns()[*name].holds_words()) return;
  const std::vector<double> along = values_of(events, *x, x_axis);
  const std::vector<double> up = values_of(events, *y, y_axis);
  for (std::size_t row = 0; row < events.row_count(); ++row) {
    if (belongs_to(events, row, pair.y)) add_event(panel.series, events.word(row, *name), along[row], up[row]);
  }
}

}  // namespace

void add_event(std::vector<ChartSeries>& series, std::string_view event, double x, double y) {
  if (is_of_program(event)) return;
  auto found = std::ranges::find(series, event, &ChartSeries::legend);
  if (found == series.end()) {
    found = series.insert(series.end(), {.legend = std::string(event), .style = ChartSeries::Style::events});
  }
  found->x.push_back(x);
  found->y.push_back(y);
}

bool is_sweep(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) {
    return std::ranges::find(k_results_files, path.filename()) != k_results_files.end();
  }
  return recorded_table(path).filename() != k_history;
}

fs::path recorded_table(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return path;
  const auto is_there = [&](std::string_view name) { return fs::exists(path / name, ignored); };
  const auto results = std::ranges::find_if(k_results_files, is_there);
  return path / (results == k_results_files.end() || is_there(k_history) ? k_history : *results);
}

ColumnChart column_chart(const std::vector<fs::path>& paths, const ColumnChoice& choice) {
  ColumnChart figure;
  std::vector<Pair> pairs;
  for (const fs::path& path : paths) {
    const fs::path file = recorded_table(path);
    const Table table = read_table(file);
    std::ranges::move(references_of(table), std::back_inserter(figure.chart.references));
    const bool is_first = pairs.empty();
    if (is_first) pairs = panels_of(table, choice, path);
    const fs::path folder = folder_of(file);
    const Table events = is_sweep(path) ? Table{} : read_events(folder);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const std::size_t x = column_in(table, pairs[k].x, file, is_sweep(path));
      const std::size_t y = column_in(table, pairs[k].y, file, false);
      // Later runs are drawn in the units of the first.
      const ColumnAxis x_axis = axis_of(table.columns()[x], is_first ? "" : figure.x.unit, table);
      const ColumnAxis y_axis = axis_of(table.columns()[y], is_first ? choice.unit : figure.y.unit, table);
      if (is_first) {
        figure.chart.panels.push_back(
            {.x = shown_axis(table.columns()[x], x_axis), .y = shown_axis(table.columns()[y], y_axis)});
        figure.chart.panels.back().y.keeps_unit = !choice.unit.empty();
        figure.x = x_axis;
        figure.y = y_axis;
      } else if (shown_axis(table.columns()[x], x_axis).names != figure.chart.panels[k].x.names) {
        throw FigureError(fmt::format("{}: column '{}' has other words", file.string(), pairs[k].x));
      }
      ChartSeries curve{.legend = paths.size() > 1 ? verbatim_text(folder.filename().string()) : std::string(),
                        .x = values_of(table, x, x_axis),
                        .y = values_of(table, y, y_axis)};
      auto series = is_sweep(path) ? points_of_sweep(table, x, std::move(curve)) : std::vector{std::move(curve)};
      std::ranges::move(series, std::back_inserter(figure.chart.panels[k].series));
      add_events(figure.chart.panels[k], events, pairs[k], x_axis, y_axis);
    }
  }
  return figure;
}

void add_points(ColumnChart& figure, const MeasuredPoints& points) {
  const auto in_axis = [](const MeasuredPoints::Axis& measured, const ColumnAxis& axis) {
    double factor = 1.0;
    const bool are_bare = is_bare(measured.unit) && axis.unit.empty();
    if (!are_bare && measured.unit != axis.unit) {
      const auto si = parsed_unit(measured.unit, axis.dimension, Table{}).value;
      if (!si) {
        throw FigureError(fmt::format("measured column '{}' {}; expected a unit of an axis {}", shown(measured.name),
                                      measured.unit.empty() ? "has no unit" : "is in " + shown(measured.unit),
                                      axis.unit.empty() ? "of numbers" : "in " + axis.unit));
      }
      factor = *si / axis.factor;
    }
    std::vector<double> values = measured.values;
    for (double& value : values) value *= factor;
    return values;
  };
  const ChartSeries series{.legend = points.legend,
                           .style = ChartSeries::Style::points,
                           .x = in_axis(points.x, figure.x),
                           .y = in_axis(points.y, figure.y)};
  for (ChartPanel& panel : figure.chart.panels) panel.series.push_back(series);
}

}  // namespace monograin::figure
