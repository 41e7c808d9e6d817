#include "study/atlas/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "figure/chart.hpp"
#include "figure/run_curves.hpp"
#include "scenario/text_file.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

/// A column over the points of one class.
std::vector<double> of_class(const Table& profiles, std::size_t c, std::string_view name, double scale) {
  std::vector<double> values;
  const std::size_t column = *profiles.find(name);
  for (std::size_t row = 0; row < profiles.row_count(); ++row) {
    if (static_cast<std::size_t>(profiles.at(row, 0)) == c) values.push_back(profiles.at(row, column) * scale);
  }
  return values;
}

}  // namespace

fs::path draw_profiles(const Table& profiles, const fs::path& output) {
  const double length = profiles.header_number("R0").value_or(1.0);
  const std::optional<double> yield_stress = profiles.header_number("Y");
  const std::string distance = "Distance from the middle {/:Italic r} / {/:Italic R}_0";
  figure::ChartPanel pressure{
      .x = {.label = distance},
      .y = {.label = yield_stress ? "Pressure {/:Italic p} / {/:Italic Y}" : "Pressure {/:Italic p} [Pa]"}};
  figure::ChartPanel surface{.x = {.label = distance}, .y = {.label = "Height {/:Italic z} / {/:Italic R}_0"}};
  const Column& classes = profiles.columns()[0];
  double highest = 0.0;
  double lowest = 0.0;
  for (std::size_t c = 0; c < classes.labels.size(); ++c) {
    const std::vector<double> radius = of_class(profiles, c, "radius", 1.0 / length);
    if (radius.empty()) continue;
    using Style = figure::ChartSeries::Style;
    const auto add = [&](figure::ChartPanel& panel, const std::string& state, Style style, std::vector<double> y) {
      panel.series.push_back({.legend = figure::verbatim_text(classes.labels[c]) + state,
                              .style = style,
                              .colour = c,
                              .x = radius,
                              .y = std::move(y)});
    };
    std::vector<double> load = of_class(profiles, c, "pressure", 1.0 / yield_stress.value_or(1.0));
    highest = std::max(highest, std::ranges::max(load));
    lowest = std::min(lowest, std::ranges::min(load));
    add(pressure, "", Style::solid, std::move(load));
    // Heights are counted from the middle of the relaxed surface; the loaded surface is flat in contact.
    std::vector<double> relaxed = of_class(profiles, c, "relaxed_height", -1.0 / length);
    std::vector<double> loaded = of_class(profiles, c, "displacement", -1.0 / length);
    std::ranges::transform(relaxed, loaded, loaded.begin(), std::plus<>());
    add(surface, "", Style::solid, std::move(loaded));
    add(surface, ", relaxed", Style::dashed, std::move(relaxed));
  }
  // The tension at the edge of an adhesive contact is unbounded.
  if (lowest < -2.0 * highest) pressure.y.lowest = -2.0 * highest;
  const figure::Chart chart{.panels = {std::move(pressure), std::move(surface)},
                            .references = figure::references_of(profiles)};
  fs::path csv = output;
  csv.replace_extension(".csv");
  expect_own_file(csv, csv);
  figure::draw_chart(chart, fmt::format("contact profiles of {}", profiles.header_value("scenario")), output);
  write_text_file(csv, csv_text(profiles));
  return csv;
}

}  // namespace monograin
