#include "figure/chart.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <ranges>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "figure/data_file.hpp"
#include "figure/figure.hpp"
#include "figure/gnuplot.hpp"
#include "figure/legend.hpp"
#include "figure/page.hpp"
#include "figure/text_width.hpp"
#include "scenario/words.hpp"

namespace monograin::figure {
namespace {

using Style = ChartSeries::Style;

constexpr double k_line_width = 1.8;
constexpr unsigned k_shade = 0xECECECu;  ///< colour beyond the range of a law
constexpr double k_text_line = 0.042;    // [cm/pt], distance of lines of text over its size
constexpr double k_text_size = 9.0;      // [pt], unless a line is too long for it
constexpr double k_text_margin_cm = 0.5;
constexpr double k_a4 = 1.4142;  ///< height over width
constexpr std::string_view k_floor_legend = "at the lower end of the axis, or below";

/// Name of a data block. The full stop keeps gnuplot, which compares beginnings, from taking one name for another.
[[nodiscard]] std::string block_of(std::size_t panel, std::string_view kind, std::size_t place,
                                   std::string_view part = "") {
  return fmt::format("panel {} {} {}{}{}.", panel + 1, kind, place + 1, part.empty() ? "" : " ", part);
}

constexpr std::string_view k_at_floor = "at the floor";

void append_band(std::string& text, const ChartBand& band, std::size_t panel, std::size_t place) {
  text += fmt::format("\n\n# {} {}; columns: x, lowest and highest y\n", block_of(panel, "band", place),
                      plain_text(band.legend));
  const auto append_row = [&](std::size_t row) {
    const double values[] = {band.x[row], band.lower[row], band.upper[row]};
    if (std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) {
      text += fmt::format("{:.10g}", fmt::join(values, " "));
    }
    text += '\n';
  };
  for (std::size_t row = 0; row < band.x.size(); ++row) {
    // A new piece begins where x turns back: gnuplot does not fill an area that one piece covers twice.
    if (row > 1 && (band.x[row] - band.x[row - 1]) * (band.x[row - 1] - band.x[row - 2]) < 0.0) {
      text += '\n';
      append_row(row - 1);
    }
    append_row(row);
  }
}

/// Floor of a series of errors: the lower end of a logarithmic axis; nothing for other series and axes.
[[nodiscard]] std::optional<double> floor_of(const ChartSeries& series, const Axis& y) {
  return series.is_error && y.is_logarithmic ? std::optional(y.range.lowest) : std::nullopt;
}

[[nodiscard]] bool is_at_floor(double value, std::optional<double> floor) { return floor && value <= *floor; }

/// A series whose line does not go below the floor.
[[nodiscard]] ChartSeries above_floor(ChartSeries series, std::optional<double> floor) {
  for (double& value : series.y) {
    if (is_at_floor(value, floor)) value = *floor;
  }
  return series;
}

[[nodiscard]] bool reaches_floor(const ChartSeries& series, std::optional<double> floor) {
  return std::ranges::any_of(series.y, [&](double value) { return is_at_floor(value, floor); });
}

void append_point(std::string& text, const ChartSeries& series, std::size_t row) {
  append_number(text, series.x[row]);
  text += ' ';
  append_number(text, series.y[row]);
  text += '\n';
}

void append_floor(std::string& text, const ChartSeries& series, std::optional<double> floor, std::size_t panel,
                  std::size_t place) {
  if (!reaches_floor(series, floor)) return;
  text += fmt::format("\n\n# {} {}\n", block_of(panel, "series", place, k_at_floor), series.legend);
  for (std::size_t row = 0; row < series.x.size(); ++row) {
    if (is_at_floor(series.y[row], floor)) append_point(text, series, row);
  }
}

void append_series(std::string& text, const ChartSeries& series, std::size_t panel, std::size_t place) {
  if (series.style != Style::phases) {
    text += fmt::format("\n\n# {} {}\n", block_of(panel, "series", place), plain_text(series.legend));
    for (std::size_t row = 0; row < series.x.size(); ++row) append_point(text, series, row);
    return;
  }
  const auto phases = phases_along(series.x);
  for (const Phase phase : k_phases) {
    if (!has_phase(phases, phase)) continue;
    text += fmt::format("\n\n# {} {}", block_of(panel, "series", place, phase_name(phase)), plain_text(series.legend));
    append_phase(text, phases, phase, [&](std::size_t row) { append_point(text, series, row); });
  }
}

/// Axis whose range covers the given values.
[[nodiscard]] Axis axis_over(const ChartAxis& wanted, std::vector<double> values) {
  std::erase_if(values, [&](double value) { return !std::isfinite(value) || (wanted.is_logarithmic && value <= 0.0); });
  if (values.empty()) values = wanted.is_logarithmic ? std::vector{1.0, 10.0} : std::vector{0.0, 1.0};
  if (wanted.lowest) std::erase_if(values, [&](double value) { return value < *wanted.lowest; });
  if (wanted.highest) std::erase_if(values, [&](double value) { return value > *wanted.highest; });
  if (wanted.lowest) values.push_back(*wanted.lowest);
  if (wanted.highest) values.push_back(*wanted.highest);

  Axis axis{.label = wanted.label,
            .is_logarithmic = wanted.is_logarithmic,
            .names = wanted.names,
            .keeps_unit = wanted.keeps_unit};
  if (wanted.is_logarithmic) {
    const auto [lowest, highest] = std::ranges::minmax(values);
    axis.range.lowest = std::pow(10.0, std::floor(std::log10(lowest)));
    axis.range.highest = std::pow(10.0, std::ceil(std::log10(highest)));
    if (axis.range.lowest == axis.range.highest) axis.range.highest *= 10.0;
  } else {
    axis.range = axis_range(values);
  }
  if (wanted.lowest) axis.range.lowest = *wanted.lowest;
  if (wanted.highest) axis.range.highest = *wanted.highest;
  return axis;
}

struct PanelAxes {
  Axis x;
  Axis y;
};

[[nodiscard]] PanelAxes axes_of(const ChartPanel& panel) {
  std::vector<double> x;
  std::vector<double> y;
  for (const ChartSeries& series : panel.series) {
    for (std::size_t row = 0; row < series.x.size(); ++row) {
      // A point beyond one axis does not stretch the other.
      const bool is_beyond =
          (panel.x.lowest && series.x[row] < *panel.x.lowest) || (panel.x.highest && series.x[row] > *panel.x.highest);
      if (is_beyond || !std::isfinite(series.x[row]) || !std::isfinite(series.y[row])) continue;
      x.push_back(series.x[row]);
      y.push_back(series.y[row]);
    }
  }
  for (const ChartArea& area : panel.areas) {
    for (const ChartArea::Box& box : area.boxes) {
      x.insert(x.end(), {box[0], box[1]});
      y.insert(y.end(), {box[2], box[3]});
    }
  }
  for (const ChartBand& band : panel.bands) {
    x.insert(x.end(), band.x.begin(), band.x.end());
    y.insert(y.end(), band.lower.begin(), band.lower.end());
    y.insert(y.end(), band.upper.begin(), band.upper.end());
  }
  return {axis_over(panel.x, std::move(x)), axis_over(panel.y, std::move(y))};
}

[[nodiscard]] bool is_points(const ChartSeries& series) {
  return series.style == Style::points || series.style == Style::events;
}

/// True for so many points that they would hide lines and bands: they are drawn below, as small translucent dots.
[[nodiscard]] bool is_crowd(const ChartSeries& series) {
  constexpr std::size_t k_crowd = 1000;
  return series.style == Style::points && series.x.size() > k_crowd;
}

/// Gives each legend its colour, its points and the marks on its lines: series with the same legend look the same in
/// every panel.
class Looks {
 public:
  explicit Looks(const Chart& chart) {
    for (const ChartPanel& panel : chart.panels) {
      for (const ChartSeries& series : panel.series) add(series);
    }
    give_colours();
    give_marks(chart);
  }

  [[nodiscard]] std::string line(const ChartSeries& series) const {
    return dashed_line(stroke(series), dash_of(series.style));
  }

  [[nodiscard]] std::string line(const ChartSeries& series, Phase phase) const {
    return phase_line(stroke(series), phase);
  }

  [[nodiscard]] std::string floor_points(const ChartSeries& series) const {
    return floor_style(is_points(series) ? colour_of_points(series) : stroke(series).colour);
  }

  [[nodiscard]] std::string points(const ChartSeries& series) const {
    if (series.style == Style::events) return event_points(series.legend);
    const auto place = static_cast<std::size_t>(std::ranges::find(points_, series.legend) - points_.begin());
    const unsigned shade = colour_of_points(series);
    if (is_crowd(series)) return fmt::format("with points pt 7 ps 0.2 lc rgb '#A0{:06X}'", shade);
    return fmt::format("with points pt {} ps 0.5 lw 1 lc rgb '#{:06X}'", point_of(place), shade);
  }

  [[nodiscard]] std::vector<LegendRow> legend_rows(const Chart& chart) const {
    LegendRow curves{"Curve", {}};
    LegendRow points{"Points", {}};
    LegendRow events{"Events", {}};
    LegendRow areas{chart.area_heading, {}};
    LegendRow bands{"Band", {}};
    for (const ChartPanel& panel : chart.panels) {
      if (panel.range) put(areas, {panel.range->legend, area_style(k_shade)});
      for (const ChartArea& area : panel.areas) put(areas, {area.legend, area_style(area.colour)});
      for (const ChartBand& band : panel.bands) put(bands, {band.legend, area_style(band.colour)});
      for (const ChartSeries& series : panel.series) {
        if (series.style == Style::events)
          put(events, {verbatim_text(series.legend), this->points(series)});
        else if (series.style == Style::points)
          put(points, {series.legend, this->points(series)});
        else
          put(curves, {series.legend, line(series)});
      }
    }
    if (has_floor(chart)) put(points, {std::string(k_floor_legend), floor_style(k_neutral_colour)});
    std::vector<LegendRow> rows{areas, bands, curves, path_row(chart), points, events};
    std::erase_if(rows, [](const LegendRow& row) { return row.entries.empty(); });
    return rows;
  }

  [[nodiscard]] static std::string area_style(unsigned colour) {
    return fmt::format("with boxxyerror fs solid 1.0 noborder lc rgb '#{:06X}'", colour);
  }

  [[nodiscard]] static std::string band_style(unsigned colour) {
    return fmt::format("with filledcurves fs solid 1.0 noborder fc rgb '#{:06X}'", colour);
  }

 private:
  struct Lines {
    std::string legend;
    std::optional<std::size_t> colour;  ///< number of the colour: that of the series, else one from give_colours()
    std::size_t mark = 0;               ///< number of the marks
  };

  [[nodiscard]] static std::string floor_style(unsigned colour) {
    return fmt::format("with points pt 11 ps 0.6 lc rgb '#{:06X}'", colour);
  }

  /// gnuplot's dash type of a style; for phases, that of loading.
  [[nodiscard]] static std::string_view dash_of(Style style) {
    switch (style) {
      case Style::dashed:
        return "(7,4)";
      case Style::dotted:
        return "(2,4)";
      case Style::dash_dotted:
        return "(7,3,1.5,3)";
      case Style::phases:
      case Style::solid:
      case Style::points:
      case Style::events:
        break;
    }
    return "1";
  }

  void add(const ChartSeries& series) {
    if (series.style == Style::events) return;
    if (series.style == Style::points) {
      if (std::ranges::find(points_, series.legend) == points_.end()) points_.push_back(series.legend);
      return;
    }
    auto found = std::ranges::find(lines_, series.legend, &Lines::legend);
    if (found == lines_.end()) found = lines_.insert(lines_.end(), {series.legend, {}});
    if (!found->colour) found->colour = series.colour;
  }

  /// Gives each legend without a colour the next one that no other legend has.
  void give_colours() {
    std::size_t next = 0;
    const auto is_taken = [this](std::size_t place) {
      return std::ranges::find(lines_, std::optional(place), &Lines::colour) != lines_.end();
    };
    for (Lines& lines : lines_) {
      if (lines.colour) continue;
      while (is_taken(next)) ++next;
      lines.colour = next;
    }
  }

  /// Gives marks to all legends but one whose lines have the same dashes, if they stand together in a panel.
  void give_marks(const Chart& chart) {
    std::map<std::string_view, std::vector<std::string_view>> alike;  // legends by their dash
    for (const ChartPanel& panel : chart.panels) {
      std::map<std::string_view, std::set<std::string_view>> here;
      for (const ChartSeries& series : panel.series) {
        if (!is_points(series) && !series.legend.empty()) here[dash_of(series.style)].insert(series.legend);
      }
      for (const ChartSeries& series : panel.series) {
        std::vector<std::string_view>& others = alike[dash_of(series.style)];
        const bool needs_mark = here[dash_of(series.style)].size() > 1 && !is_points(series) && !series.legend.empty();
        if (needs_mark && std::ranges::find(others, series.legend) == others.end()) others.push_back(series.legend);
      }
    }
    for (const auto& [dash, legends] : alike) {
      for (std::size_t k = 0; k < legends.size(); ++k) {
        Lines& lines = *std::ranges::find(lines_, legends[k], &Lines::legend);
        lines.mark = std::max(lines.mark, k);
      }
    }
  }

  [[nodiscard]] static unsigned colour_of_points(const ChartSeries& series) {
    return series.colour ? colour_of(*series.colour) : k_neutral_colour;
  }

  [[nodiscard]] Stroke stroke(const ChartSeries& series) const {
    const auto lines = std::ranges::find(lines_, series.legend, &Lines::legend);
    return {colour_of(series.colour ? *series.colour : *lines->colour), k_line_width, lines->mark};
  }

  [[nodiscard]] static bool has_floor(const Chart& chart) {
    return std::ranges::any_of(chart.panels, [](const ChartPanel& panel) {
      const Axis y = axes_of(panel).y;
      return std::ranges::any_of(panel.series,
                                 [&](const ChartSeries& series) { return reaches_floor(series, floor_of(series, y)); });
    });
  }

  static void put(LegendRow& row, LegendRow::Entry entry) {
    const auto is_same = [&](const LegendRow::Entry& other) {
      return other.title == entry.title && other.style == entry.style;
    };
    if (!entry.title.empty() && std::ranges::none_of(row.entries, is_same)) row.entries.push_back(std::move(entry));
  }

  /// Row that explains the dashes of loading, unloading and reloading; empty if no line turns back.
  [[nodiscard]] static LegendRow path_row(const Chart& chart) {
    LegendRow row{"Path", {}};
    for (const Phase phase : k_phases) {
      const bool is_there = std::ranges::any_of(chart.panels, [&](const ChartPanel& panel) {
        return std::ranges::any_of(panel.series, [&](const ChartSeries& series) {
          return series.style == Style::phases && has_phase(phases_along(series.x), phase);
        });
      });
      if (!is_there) continue;
      row.entries.push_back({std::string(phase_name(phase)), phase_line({k_neutral_colour, k_line_width, 0}, phase)});
    }
    if (row.entries.size() == 1) row.entries.clear();
    return row;
  }

  std::vector<Lines> lines_;
  std::vector<std::string> points_;
};

[[nodiscard]] std::string plots_of(const ChartPanel& panel, std::size_t place, const Axis& y, const Looks& looks) {
  std::vector<std::string> plots;
  for (std::size_t k = 0; k < panel.areas.size(); ++k) {
    if (panel.areas[k].boxes.empty()) continue;
    plots.push_back(fmt::format("data index {} using (0.5*($1+$2)):(0.5*($3+$4)):1:2:3:4 {}",
                                gnuplot_string(block_of(place, "area", k)), Looks::area_style(panel.areas[k].colour)));
  }
  for (std::size_t k = 0; k < panel.bands.size(); ++k) {
    plots.push_back(fmt::format("data index {} using 1:2:3 {}", gnuplot_string(block_of(place, "band", k)),
                                Looks::band_style(panel.bands[k].colour)));
  }
  const auto add_points = [&](std::size_t k) {
    plots.push_back(
        fmt::format("data index {} {}", gnuplot_string(block_of(place, "series", k)), looks.points(panel.series[k])));
  };
  for (std::size_t k = 0; k < panel.series.size(); ++k) {
    if (is_crowd(panel.series[k])) add_points(k);
  }
  for (std::size_t k = 0; k < panel.series.size(); ++k) {
    const ChartSeries& series = panel.series[k];
    if (is_crowd(series)) continue;
    if (is_points(series)) {
      add_points(k);
    } else if (series.style != Style::phases) {
      plots.push_back(
          fmt::format("data index {} {}", gnuplot_string(block_of(place, "series", k)), looks.line(series)));
    } else {
      const auto phases = phases_along(series.x);
      for (const Phase phase : k_phases) {
        if (!has_phase(phases, phase)) continue;
        plots.push_back(fmt::format("data index {} {}", gnuplot_string(block_of(place, "series", k, phase_name(phase))),
                                    looks.line(series, phase)));
      }
    }
  }
  for (std::size_t k = 0; k < panel.series.size(); ++k) {
    const ChartSeries& series = panel.series[k];
    if (!reaches_floor(series, floor_of(series, y))) continue;
    plots.push_back(fmt::format("data index {} {}", gnuplot_string(block_of(place, "series", k, k_at_floor)),
                                looks.floor_points(series)));
  }
  return plots.empty() ? std::string("plot NaN\n") : fmt::format("plot {}\n", fmt::join(plots, ", \\\n  "));
}

/// gnuplot commands that shade the panel outside of a range of the abscissa.
[[nodiscard]] std::string shades_of(const std::optional<ChartRange>& range, const Axis& x) {
  std::string text = "unset object\n";
  if (!range) return text;
  const auto shade = [&](double from, double to) {
    if (!(from < to)) return;
    text += fmt::format(
        "set object rectangle from first {:.10g}, graph 0 to first {:.10g}, graph 1 behind fc rgb '#{:06X}' fs solid "
        "noborder\n",
        from, to, k_shade);
  };
  const auto& [lowest, highest, step] = x.range;
  if (range->from) shade(lowest, std::min(*range->from, highest));
  if (range->to) shade(std::max(*range->to, lowest), highest);
  return text;
}

[[nodiscard]] double height_of(const std::vector<std::string>& lines, double text_size) {
  return lines.empty() ? 0.0 : k_text_margin_cm + k_text_line * text_size * static_cast<double>(lines.size());
}

/// Makes room for the lines of text above the panels and below the legend.
void make_room(const Chart& chart, double text_size, Layout& layout) {
  if (chart.head.empty() && chart.foot.empty()) return;
  const double needed = layout.height + height_of(chart.head, text_size) + height_of(chart.foot, text_size);
  const double height = std::max(needed, k_a4 * layout.width);
  const double rise = height - height_of(chart.head, text_size) - layout.height;
  layout.height = height;
  layout.legend.bottom += rise;
  for (Panel& panel : layout.panels) panel.axes.bottom += rise;
}

/// Size [pt] in which the longest line of text fits the page.
[[nodiscard]] double text_size(const Chart& chart, double width) {
  constexpr double k_letter_cm = 0.61 * 2.54 / 72.0;  // width of a monospaced letter for each point of its size
  std::size_t longest = 1;
  for (const auto* lines : {&chart.head, &chart.foot}) {
    for (const std::string& line : *lines) longest = std::max(longest, width_of(line));
  }
  const double fitting = (width - 2.0 * k_text_margin_cm) / (k_letter_cm * static_cast<double>(longest));
  return std::min(k_text_size, fitting);
}

/// Lines of text, the first one right below `top` [cm].
[[nodiscard]] std::string lines_text(const std::vector<std::string>& lines, double size, double top,
                                     const Layout& layout) {
  std::string text;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    text += fmt::format("set label {} {} at screen {:.4f}, {:.4f} left noenhanced font 'Monospace,{:.2f}'\n", k + 10,
                        gnuplot_string(lines[k]), k_text_margin_cm / layout.width,
                        (top - k_text_line * size * (static_cast<double>(k) + 0.5)) / layout.height, size);
  }
  return text.empty() ? text : "unset key; unset label\n" + text + "plot [0:1] [0:1] NaN\n";
}

}  // namespace

std::string chart_data(const Chart& chart, const std::string& source) {
  std::string text =
      fmt::format("# {}\n{}# columns: x, y as on the axes\n", plain_text(source), reference_lines(chart.references));
  for (std::size_t k = 0; k < chart.panels.size(); ++k) {
    const ChartPanel& panel = chart.panels[k];
    for (std::size_t a = 0; a < panel.areas.size(); ++a) {
      text += fmt::format("\n\n# {} {}; columns: lowest and highest x, lowest and highest y\n", block_of(k, "area", a),
                          plain_text(panel.areas[a].legend));
      for (const auto& [x_low, x_high, y_low, y_high] : panel.areas[a].boxes) {
        text += fmt::format("{:.10g} {:.10g} {:.10g} {:.10g}\n", x_low, x_high, y_low, y_high);
      }
    }
    for (std::size_t b = 0; b < panel.bands.size(); ++b) append_band(text, panel.bands[b], k, b);
    const Axis y = axes_of(panel).y;
    for (std::size_t s = 0; s < panel.series.size(); ++s) {
      const auto floor = floor_of(panel.series[s], y);
      const ChartSeries shown = above_floor(panel.series[s], floor);
      append_series(text, shown, k, s);
      append_floor(text, shown, floor, k, s);
    }
  }
  return text;
}

std::string chart_script(const Chart& chart, Format format, const std::string& figure_name,
                         const std::string& data_name) {
  const Looks looks(chart);
  const auto rows = looks.legend_rows(chart);
  Layout layout = layout_of(chart.panels.size(), rows);
  const double size = text_size(chart, layout.width);
  make_room(chart, size, layout);

  std::string text = page_head(format, layout, figure_name, data_name);
  for (std::size_t k = 0; k < chart.panels.size(); ++k) {
    const ChartPanel& panel = chart.panels[k];
    const PanelAxes axes = axes_of(panel);
    text += "\nunset logscale; set format '%g'";
    text += frame_text(layout, k, axes.x, axes.y);
    text += shades_of(panel.range, axes.x);
    text += fmt::format("set label 5 {} at graph 0.98, 1.06 right\n",
                        label_string(fitted_text(panel.note, note_room(layout, k))));
    text += plots_of(panel, k, axes.y, looks);
  }
  text += "unset logscale; unset object\n" + legend_text(rows, layout);
  text += lines_text(chart.head, size, layout.height - k_text_margin_cm, layout);
  const double lines = static_cast<double>(line_count(rows, layout.legend.width));
  text += lines_text(chart.foot, size, layout.legend.top() - k_legend_line_cm * lines - k_text_margin_cm, layout);
  return text + k_page_foot;
}

void draw_chart(const Chart& chart, const std::string& source, const std::filesystem::path& output) {
  const FigureFiles files(output);
  files.write(chart_data(chart, source), chart_script(chart, files.format(), files.figure_name(), files.data_name()));
}

std::string try_to_draw(const Chart& chart, const std::string& source, const std::filesystem::path& output) {
  try {
    draw_chart(chart, source, output);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

}  // namespace monograin::figure
