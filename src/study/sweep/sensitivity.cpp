#include "study/sweep/sensitivity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "figure/chart.hpp"
#include "figure/gnuplot.hpp"
#include "figure/page.hpp"
#include "history/run.hpp"
#include "history/table_file.hpp"
#include "scenario/text_file.hpp"
#include "scenario/words.hpp"
#include "study/formula/expression.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

[[nodiscard]] bool is_morris(const Sweep& sweep) { return sweep.design == "morris"; }

/// Values of a formula, one for each run. A constant is the same in every run.
[[nodiscard]] std::vector<double> values_of(const std::string& formula, const Table& results) {
  std::vector<std::string_view> names;
  for (const Column& column : results.columns()) {
    if (!column.holds_words()) names.push_back(column.name);
  }
  try {
    std::vector<double> values =
        Expression(formula).evaluate([&](std::string_view name) -> std::optional<std::vector<double>> {
          if (std::ranges::find(names, name) == names.end()) return std::nullopt;
          return results.column(name);
        });
    if (values.size() == 1) values.resize(results.row_count(), values.front());
    return values;
  } catch (const ExpressionError& error) {
    throw std::runtime_error(
        fmt::format("results: '{}': {}{}", formula, error.what(), did_you_mean(error.unknown_name(), names)));
  }
}

[[nodiscard]] std::string with_interval(const Estimate& estimate) {
  // Adding 0.0 turns a negative zero into a positive one.
  const auto rounded = [](double value) { return std::round(value * 1e3) / 1e3 + 0.0; };
  return fmt::format("{:.3f} [{:.3f}, {:.3f}]", rounded(estimate.value), rounded(estimate.lower),
                     rounded(estimate.upper));
}

/// The last part of the factor's key, if no other factor has the same; else the whole key.
[[nodiscard]] std::string short_name(const Sweep& sweep, std::size_t factor) {
  const auto last_part = [](const std::string& key) { return key.substr(key.rfind('.') + 1); };
  const std::string name = last_part(sweep.factors[factor].key);
  const auto same =
      std::ranges::count_if(sweep.factors, [&](const SweepFactor& other) { return last_part(other.key) == name; });
  return same > 1 ? sweep.factors[factor].key : name;
}

using Style = figure::ChartSeries::Style;

[[nodiscard]] std::string interval_text(const ResultSensitivity& found) {
  return fmt::format("{:g} % intervals", 100.0 * found.confidence);
}

/// The formula of a result, as a note of its panel.
[[nodiscard]] std::string note_of(const ResultSensitivity& found) {
  constexpr std::size_t k_longest = 50;  // in letters as small as can be read
  return figure::short_text(found.result, k_longest);
}

/// Panel of first-order and total indices, each with its interval; a colour for each factor.
[[nodiscard]] figure::ChartPanel index_panel(const Sweep& sweep, const ResultSensitivity& found) {
  figure::ChartPanel panel{.x = {.label = "Index; bars: " + interval_text(found),
                                 .lowest = 0.5,
                                 .highest = 2.5,
                                 .names = {"first order", "total"}},
                           .y = {.label = "Share of the variance"},
                           .note = note_of(found)};
  const std::size_t count = sweep.factors.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::string legend = figure::verbatim_text(short_name(sweep, k));
    const double offset = 0.7 * ((static_cast<double>(k) + 0.5) / static_cast<double>(count) - 0.5);
    const double first = 1.0 + offset;
    const double second = 2.0 + offset;
    const Estimate& own = found.sobol.first[k];
    const Estimate& total = found.sobol.total[k];
    panel.series.push_back(
        {.legend = legend, .style = Style::points, .colour = k, .x = {first, second}, .y = {own.value, total.value}});
    for (const auto& [x, estimate] : {std::pair(first, own), std::pair(second, total)}) {
      panel.series.push_back({.style = Style::solid, .colour = k, .x = {x, x}, .y = {estimate.lower, estimate.upper}});
    }
  }
  return panel;
}

[[nodiscard]] figure::ChartPanel effect_panel(const Sweep& sweep, const ResultSensitivity& found) {
  const std::string unit = found.unit.empty() ? "" : fmt::format(" [{}]", figure::verbatim_text(found.unit));
  figure::ChartPanel panel{.x = {.label = "Mean size of effects, " + interval_text(found) + unit, .lowest = 0.0},
                           .y = {.label = "Their standard deviation" + unit, .lowest = 0.0},
                           .note = note_of(found)};
  for (std::size_t k = 0; k < sweep.factors.size(); ++k) {
    const auto& [size, lower, upper] = found.morris.mean_size[k];
    const double spread = found.morris.spread[k];
    panel.series.push_back({.legend = figure::verbatim_text(short_name(sweep, k)),
                            .style = Style::points,
                            .colour = k,
                            .x = {size},
                            .y = {spread}});
    panel.series.push_back({.style = Style::solid, .colour = k, .x = {lower, upper}, .y = {spread, spread}});
  }
  return panel;
}

/// Sensitivities as a table with a row for each result and factor.
[[nodiscard]] Table sensitivity_table(const Sweep& sweep, const std::vector<ResultSensitivity>& found) {
  std::vector<std::string> results;
  std::vector<std::string> keys;
  for (const ResultSensitivity& result : found) results.push_back(result.result);
  for (const SweepFactor& factor : sweep.factors) keys.push_back(factor.key);
  std::vector<Column> columns{{"result", "", results}, {"key", "", keys}};
  for (const std::string_view name :
       is_morris(sweep) ? std::vector{"mean_size", "mean_size_lower", "mean_size_upper", "mean", "standard_deviation"}
                        : std::vector{"first", "first_lower", "first_upper", "total", "total_lower", "total_upper"}) {
    columns.push_back({std::string(name), is_morris(sweep) ? "" : "-", {}});
  }
  Table table(std::move(columns));
  table.header = {{"program", fmt::format("monograin {}", version())},
                  {"sweep", sweep.name},
                  {"sweep_digest", sweep.digest},
                  {"design", sweep.design}};
  table.header.emplace_back("confidence of the intervals", fmt::format("{}", found.front().confidence));
  for (std::size_t r = 0; r < found.size(); ++r) {
    table.header.emplace_back("samples of " + found[r].result, fmt::format("{}", found[r].samples()));
    for (std::size_t k = 0; k < sweep.factors.size(); ++k) {
      std::vector<double> row{static_cast<double>(r), static_cast<double>(k)};
      const auto add = [&row](const Estimate& estimate) {
        row.insert(row.end(), {estimate.value, estimate.lower, estimate.upper});
      };
      if (is_morris(sweep)) {
        add(found[r].morris.mean_size[k]);
        row.insert(row.end(), {found[r].morris.mean[k], found[r].morris.spread[k]});
      } else {
        add(found[r].sobol.first[k]);
        add(found[r].sobol.total[k]);
      }
      table.append(row);
    }
  }
  return table;
}

/// Number of samples in the sweep's design.
[[nodiscard]] std::size_t sample_count(const Sweep& sweep) {
  return sweep.runs.size() / (sweep.factors.size() + (is_morris(sweep) ? 1 : 2));
}

/// @param values  of the result, one for each run
[[nodiscard]] std::vector<std::string> warnings_of(const Sweep& sweep, const ResultSensitivity& found,
                                                   const std::vector<double>& values, const Table& results) {
  std::vector<std::string> warnings;
  if (found.samples() != sample_count(sweep)) {
    warnings.push_back(
        fmt::format("{}: {} of {} samples count; of the others a run has no value, see its reason in the results: this "
                    "can bias the result",
                    found.result, found.samples(), sample_count(sweep)));
  }
  const std::vector<double> statuses = results.column("status");
  const std::vector<std::string>& words = results.columns()[*results.find("status")].labels;
  std::size_t ended_early = 0;
  double lowest = k_infinity;
  double highest = -k_infinity;
  for (std::size_t run = 0; run < values.size(); ++run) {
    if (!std::isfinite(values[run])) continue;
    lowest = std::min(lowest, values[run]);
    highest = std::max(highest, values[run]);
    if (words[static_cast<std::size_t>(statuses[run])] != to_string(RunStatus::complete)) ++ended_early;
  }
  if (ended_early > 0) {
    warnings.push_back(
        fmt::format("{}: {} of {} runs ended before their programs did, and count with what they had reached; see "
                    "their reasons in the results: this can bias the result",
                    found.result, ended_early, values.size()));
  }
  if (lowest == highest) {
    warnings.push_back(
        fmt::format("{}: it is {:.6g} in every run, and has no sensitivities{}", found.result, lowest,
                    lowest == 0.0 ? "; where compression is negative, max. is the start of the program" : ""));
  }
  return warnings;
}

[[nodiscard]] figure::Chart chart_of(const Sweep& sweep, const std::vector<ResultSensitivity>& found) {
  figure::Chart chart;
  for (const ResultSensitivity& result : found) {
    chart.panels.push_back(is_morris(sweep) ? effect_panel(sweep, result) : index_panel(sweep, result));
  }
  return chart;
}

}  // namespace

std::string why_no_sensitivities(const Sweep& sweep) {
  if (!sweep.results.empty()) return {};
  return fmt::format(
      "design = \"{}\" says nothing of sensitivities; expected \"saltelli\" for Sobol indices, or \"morris\" for "
      "elementary effects",
      sweep.design);
}

std::vector<ResultSensitivity> sensitivities_of(const Sweep& sweep, const fs::path& file, double confidence) {
  const Table results = read_table_file(file);
  std::vector<ResultSensitivity> found;
  for (const std::string& formula : sweep.results) {
    const std::vector<double> values = values_of(formula, results);
    const auto column = results.find(formula);
    const std::string unit = column ? results.columns()[*column].unit : std::string();
    ResultSensitivity result{.result = formula, .unit = unit == "-" ? "" : unit, .confidence = confidence};
    if (is_morris(sweep)) {
      result.morris = morris_effects(sweep.points, values, confidence);
    } else {
      result.sobol = sobol_indices(values, sweep.factors.size(), confidence);
    }
    result.warnings = warnings_of(sweep, result, values, results);
    found.push_back(std::move(result));
  }
  return found;
}

std::string sensitivity_text(const Sweep& sweep, const std::vector<ResultSensitivity>& found) {
  std::size_t width = std::string_view("key").size();
  for (const SweepFactor& factor : sweep.factors) width = std::max(width, factor.key.size());
  std::string text;
  for (const ResultSensitivity& result : found) {
    text += fmt::format("{}{}, {} samples, {}\n", text.empty() ? "" : "\n", result.result, result.samples(),
                        interval_text(result));
    if (is_morris(sweep)) {
      text += fmt::format("{:<{}}  {:>12}  {:>25}  {:>12}  {:>12}\n", "key", width, "mean size", "interval", "mean",
                          "deviation");
      for (std::size_t k = 0; k < sweep.factors.size(); ++k) {
        const auto& [size, lower, upper] = result.morris.mean_size[k];
        text +=
            fmt::format("{:<{}}  {:>12.4g}  {:>25}  {:>12.4g}  {:>12.4g}\n", sweep.factors[k].key, width, size,
                        fmt::format("[{:.4g}, {:.4g}]", lower, upper), result.morris.mean[k], result.morris.spread[k]);
      }
      continue;
    }
    text += fmt::format("{:<{}}  {:>22}  {:>22}\n", "key", width, "first order", "total");
    for (std::size_t k = 0; k < sweep.factors.size(); ++k) {
      text += fmt::format("{:<{}}  {:>22}  {:>22}\n", sweep.factors[k].key, width, with_interval(result.sobol.first[k]),
                          with_interval(result.sobol.total[k]));
    }
  }
  return text;
}

std::string write_sensitivities(const Sweep& sweep, const std::vector<ResultSensitivity>& found, const fs::path& folder,
                                std::string_view format) {
  write_csv(folder / k_sensitivities_file, sensitivity_table(sweep, found));
  return figure::try_to_draw(chart_of(sweep, found), "sensitivities of sweep " + sweep.name,
                             folder / fmt::format("sensitivity.{}", format));
}

}  // namespace monograin
