#include "figure/body_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>

#include "figure/column_chart.hpp"
#include "figure/figure.hpp"
#include "figure/run_curves.hpp"
#include "history/table.hpp"

namespace monograin::figure {
namespace {

namespace fs = std::filesystem;

struct Shown {
  std::string_view column;
  std::string_view label;  ///< gnuplot's enhanced text
  std::string_view scale;  ///< key of the header's number by which the column is divided; empty: none
  bool has_sign = false;   ///< recorded with tension positive; drawn with the sign that lets the abscissa grow at first
};

/// Abscissa and panels of a model's figure, chosen by the column of the abscissa.
struct BodyFigure {
  Shown x;
  std::span<const Shown> panels;
};

constexpr std::array<Shown, 4> k_packing{
    Shown{"stress", "Stress {/:Italic σ} / {/:Italic E}", "E"},
    Shown{"strain", "Strain {/:Italic e}", ""},
    Shown{"coordination_number", "Coordination number {/:Italic Z}", ""},
    Shown{"plastic_fraction", "Plastic fraction {/:Italic f}_p", ""},
};
constexpr std::array<Shown, 4> k_material_point{
    Shown{"stress_axial", "Axial stress {/:Italic σ}_a / {/:Italic σ}_{y0}", "yield_pressure", true},
    Shown{"p", "Mean stress {/:Italic p} / {/:Italic σ}_{y0}", "yield_pressure", true},
    Shown{"q", "Deviatoric stress {/:Italic q} / {/:Italic σ}_{y0}", "yield_pressure"},
    Shown{"relative_density", "Relative density {/:Italic ρ}", ""},
};
constexpr std::array k_figures{
    BodyFigure{{"packing_fraction", "Packing fraction {/:Italic Φ}", ""}, k_packing},
    BodyFigure{{"strain_axial", "Axial strain", "", true}, k_material_point},
};

const BodyFigure* figure_of(const Table& history) {
  const auto found = std::ranges::find_if(
      k_figures, [&](const BodyFigure& figure) { return history.find(figure.x.column).has_value(); });
  return found == k_figures.end() ? nullptr : &*found;
}

/// The sign that makes the abscissa grow at first, so that compression and tension are drawn as loading alike.
double sign_of(const Table& history, const Shown& x) {
  if (!x.has_sign) return 1.0;
  const std::vector<double> values = history.column(x.column);
  const auto moved = std::ranges::find_if(values, [&](double value) { return value != values.front(); });
  return moved != values.end() && *moved < values.front() ? -1.0 : 1.0;
}

/// Values of a column over its scale.
/// @param history  table whose header has the scale
/// @param sign     factor for columns that have a sign
std::vector<double> values_of(const Table& table, const Table& history, const Shown& shown, double sign) {
  std::vector<double> values = table.column(shown.column);
  const double scale = shown.scale.empty() ? 1.0 : history.header_number(shown.scale).value_or(1.0);
  for (double& value : values) value *= (shown.has_sign ? sign : 1.0) / scale;
  return values;
}

/// Adds marks at the events, one series for each name.
void append_events(const Table& events, const Table& history, const BodyFigure& figure, double sign, std::size_t panel,
                   std::vector<ChartSeries>& series) {
  const auto name = events.find("event");
  if (!name || !events.columns()[*name].holds_words()) return;
  const std::vector<double> x = values_of(events, history, figure.x, sign);
  const std::vector<double> y = values_of(events, history, figure.panels[panel], sign);
  for (std::size_t row = 0; row < events.row_count(); ++row) {
    add_event(series, events.word(row, *name), x[row], y[row]);
  }
}

}  // namespace

std::optional<Chart> body_chart(const std::vector<fs::path>& runs) {
  const Table first = read_table(recorded_table(runs.front()));
  const BodyFigure* figure = figure_of(first);
  if (figure == nullptr) return std::nullopt;
  const double sign = sign_of(first, figure->x);
  const std::string_view convention = !figure->x.has_sign ? ""
                                      : sign < 0.0        ? ", compression positive"
                                                          : ", tension positive";
  Chart chart;
  for (const Shown& shown : figure->panels) {
    chart.panels.push_back(
        {.x = {.label = fmt::format("{}{}", figure->x.label, convention)}, .y = {.label = std::string(shown.label)}});
  }
  std::vector<std::vector<ChartSeries>> events(figure->panels.size());
  for (const fs::path& run : runs) {
    const fs::path file = recorded_table(run);
    const Table history = read_table(file);
    if (figure_of(history) != figure) {
      throw FigureError(
          fmt::format("{}: has no column '{}'; expected runs of one kind", file.string(), figure->x.column));
    }
    std::ranges::move(references_of(history), std::back_inserter(chart.references));
    const fs::path folder = folder_of(file);
    const Table marks = read_events(folder);
    for (std::size_t panel = 0; panel < figure->panels.size(); ++panel) {
      // A single run needs no name; its figure is drawn while the folder does not have its final name yet.
      chart.panels[panel].series.push_back({.legend = runs.size() > 1 ? verbatim_text(folder.filename().string()) : "",
                                            .style = ChartSeries::Style::phases,
                                            .x = values_of(history, history, figure->x, sign),
                                            .y = values_of(history, history, figure->panels[panel], sign)});
      append_events(marks, history, *figure, sign, panel, events[panel]);
    }
  }
  for (std::size_t panel = 0; panel < events.size(); ++panel) {
    std::ranges::move(events[panel], std::back_inserter(chart.panels[panel].series));
  }
  // A model may leave a column undefined, such as the density where no law gives it.
  std::erase_if(chart.panels, [](const ChartPanel& panel) {
    return std::ranges::none_of(panel.series, [](const ChartSeries& series) {
      return std::ranges::any_of(series.y, [](double value) { return std::isfinite(value); });
    });
  });
  if (chart.panels.empty()) throw FigureError("all values are undefined");
  return chart;
}

}  // namespace monograin::figure
