#include "figure/legend.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "figure/data_file.hpp"
#include "figure/gnuplot.hpp"
#include "figure/page.hpp"
#include "figure/text_width.hpp"

namespace monograin::figure {
namespace {

/// Okabe and Ito's colours, which differ for the colour-blind; in grey print some do not.
constexpr std::array k_colours{0x0072B2u, 0xD55E00u, 0x009E73u, 0xCC79A7u, 0xE69F00u, 0x56B4E9u};

constexpr double k_first_width = 2.0;
constexpr double k_last_width = 1.5;
constexpr double k_palest = 0.3;           ///< share of white in the last run's shade
constexpr double k_reloading_width = 2.2;  ///< of the dots, over that of the line
/// Shares of black, and of white, in colours that come again.
constexpr double k_darker = 0.35;
constexpr double k_paler = 0.5;

/// Open points (circle, square, triangles, diamond, pentagon), then crosses, and only then filled points.
constexpr std::array k_points{6, 4, 8, 10, 12, 14, 2, 1, 3, 7, 5, 9, 11, 13, 15};
/// Filled points: circle, triangle, square, diamond, pentagon, triangle. The open ones have the numbers before these.
constexpr std::array k_marks{7, 9, 5, 13, 15, 11};
/// Colours that differ; a multiple of the number of marks.
constexpr std::size_t k_shades = 3 * k_colours.size();

/// Events of models. The place of a name gives its symbol, so that a new name belongs at the end; names beside these
/// share the symbol after the last.
constexpr std::array<std::string_view, 36> k_events{
    "yield", "load-reversal", "reload", "contact-made", "contact-lost", "fully-plastic", "pull-off", "peel", "stick",
    "growth-on", "growth-off", "zero-porosity", "dent-touched", "low-compressibility", "impingement",
    // From here on in grey.
    "jamming", "plastic-softening", "force-extremum", "follow", "retreat", "secondary-onset", "segment-change",
    "plastic-off", "transition", "caps-intersect", "stiffening", "limit", "full", "singular-growth", "volume-limit",
    // From here on in red.
    "radius-limit", "density-limit", "loss-of-uniqueness", "poisson-half", "cap-centre-tensile",
    "cap-axis-nonpositive"};
constexpr std::array k_event_colours{0x000000u, 0x909090u, 0x8B0000u};

constexpr double k_sample_cm = 1.6;
constexpr double k_gap_cm = 0.3;  ///< between columns of the legend
constexpr double k_heading_cm = 1.7;

/// A colour mixed with a share of grey.
/// @param grey  0 for black, 255 for white
[[nodiscard]] unsigned mixed_with(double grey, unsigned colour, double share) noexcept {
  unsigned mixed = 0;
  for (const unsigned shift : {16u, 8u, 0u}) {
    const double channel = (colour >> shift) & 0xFFu;
    mixed |= static_cast<unsigned>(std::lround(std::lerp(channel, grey, share))) << shift;
  }
  return mixed;
}

[[nodiscard]] double entry_width(const LegendRow& row) {
  double widest = 0.0;
  for (const auto& entry : row.entries) widest = std::max(widest, text_width(entry.title));
  return k_sample_cm + widest + k_gap_cm;
}

[[nodiscard]] std::size_t columns_of(const LegendRow& row, double width_cm) {
  const auto fitting = static_cast<std::size_t>(std::max(1.0, (width_cm - k_heading_cm) / entry_width(row)));
  return std::min(fitting, row.entries.size());
}

[[nodiscard]] std::size_t lines_of(const LegendRow& row, double width_cm) {
  const std::size_t columns = columns_of(row, width_cm);
  return (row.entries.size() + columns - 1) / columns;
}

/// Colours of contacts. Marks tell runs apart if there are several.
[[nodiscard]] LegendRow contact_row(const Palette& palette, bool has_marks) {
  LegendRow row{"Contact", {}};
  for (const std::string& name : palette.contacts()) {
    Stroke stroke = palette.contact_line(0, name);
    if (!has_marks) stroke.mark = 0;
    row.entries.push_back({verbatim_text(name), phase_line(stroke, Phase::loading)});
  }
  return row;
}

[[nodiscard]] LegendRow run_row(const std::vector<RunCurves>& runs, const Palette& palette) {
  LegendRow row{"Run", {}};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    row.entries.push_back({verbatim_text(runs[k].name), phase_line(palette.particle_line(k), Phase::loading)});
  }
  return row;
}

[[nodiscard]] LegendRow phase_row(const std::vector<RunCurves>& runs, const Palette& palette) {
  LegendRow row{"Path", {}};
  for (const Phase phase : k_phases) {
    if (std::ranges::none_of(runs, [=](const RunCurves& run) { return has_phase(run.phases, phase); })) continue;
    const Stroke stroke = runs.size() > 1 ? Stroke{k_neutral_colour, k_first_width, 0} : palette.particle_line(0);
    const bool is_hidden = phase == Phase::unloading && std::ranges::all_of(runs, &RunCurves::unloads_as_it_loads);
    row.entries.push_back(
        {fmt::format("{}{}", phase_name(phase), is_hidden ? " = loading" : ""), phase_line(stroke, phase)});
  }
  return row;
}

[[nodiscard]] LegendRow event_row(const std::vector<RunCurves>& runs) {
  LegendRow row{"Events", {}};
  for (const std::string& name : event_names(runs)) {
    row.entries.push_back({verbatim_text(name), event_points(name)});
  }
  return row;
}

}  // namespace

Palette::Palette(const std::vector<RunCurves>& runs) : run_count_(runs.size()) {
  for (const RunCurves& run : runs) {
    for (const ContactCurve& contact : run.contacts) {
      if (std::ranges::find(contacts_, contact.name) == contacts_.end()) contacts_.push_back(contact.name);
    }
  }
}

Stroke Palette::line(std::size_t run, unsigned colour, std::size_t mark, bool is_open) const {
  const double share = run_count_ > 1 ? static_cast<double>(run) / static_cast<double>(run_count_ - 1) : 0.0;
  return {colours_tell_runs() ? colour : mixed_with(255.0, colour, k_palest * share),
          std::lerp(k_first_width, k_last_width, share), mark, is_open};
}

Stroke Palette::contact_line(std::size_t run, std::string_view contact) const {
  const auto place = static_cast<std::size_t>(std::ranges::find(contacts_, contact) - contacts_.begin());
  // Where colours come again, the next marks go with them.
  if (colours_tell_runs()) return line(run, colour_of(run), run + run / k_shades, false);
  return line(run, colour_of(place), run_count_ > 1 ? run + 1 : place, run_count_ > 1 && place > 0);
}

Stroke Palette::particle_line(std::size_t run) const {
  if (colours_tell_runs()) return contact_line(run, contacts_.front());
  return line(run, k_neutral_colour, run_count_ > 1 ? run + 1 : 0, false);
}

unsigned colour_of(std::size_t place) noexcept {
  const unsigned colour = k_colours[place % k_colours.size()];
  switch (place / k_colours.size() % 3) {
    case 1:
      return mixed_with(0.0, colour, k_darker);
    case 2:
      return mixed_with(255.0, colour, k_paler);
    default:
      return colour;
  }
}

int point_of(std::size_t place) noexcept { return k_points[place % k_points.size()]; }

std::string phase_line(const Stroke& stroke, Phase phase) {
  switch (phase) {
    case Phase::loading:
      return dashed_line(stroke, "1");
    case Phase::unloading:
      return dashed_line(stroke, "(7,4)");
    case Phase::reloading:
      return dashed_line({stroke.colour, k_reloading_width * stroke.width, 0}, "(0.8,2.6)");
  }
  return {};
}

std::string dashed_line(const Stroke& stroke, std::string_view dash) {
  const std::string look = fmt::format("lc rgb '#{:06X}' lw {:.3g} dt {}", stroke.colour, stroke.width, dash);
  if (stroke.mark == 0) return "with lines " + look;
  const int point = k_marks[(stroke.mark - 1) % k_marks.size()] - (stroke.is_open ? 1 : 0);
  // A smaller open point has no room beside its line.
  return fmt::format("with linespoints {} pt {} ps {} pn 7", look, point, stroke.is_open ? 0.8 : 0.45);
}

std::string event_points(std::string_view name) {
  const auto place = static_cast<std::size_t>(std::ranges::find(k_events, name) - k_events.begin());
  const unsigned colour = k_event_colours[place / k_points.size() % k_event_colours.size()];
  return fmt::format("with points pt {} ps 0.9 lw 1.1 lc rgb '#{:06X}'", point_of(place), colour);
}

std::vector<LegendRow> legend_rows(const std::vector<RunCurves>& runs, const Palette& palette) {
  std::vector<LegendRow> rows;
  if (runs.size() == 1 || palette.contacts().size() > 1) rows.push_back(contact_row(palette, runs.size() == 1));
  if (runs.size() > 1) rows.push_back(run_row(runs, palette));
  rows.push_back(phase_row(runs, palette));
  rows.push_back(event_row(runs));
  std::erase_if(rows, [](const LegendRow& row) { return row.entries.empty(); });
  return rows;
}

std::size_t line_count(const std::vector<LegendRow>& rows, double width_cm) {
  std::size_t lines = 0;
  for (const LegendRow& row : rows) lines += lines_of(row, width_cm);
  return lines;
}

Layout layout_of(std::size_t panel_count, const std::vector<LegendRow>& rows) {
  const bool fits_cell = std::ranges::all_of(
      rows, [](const LegendRow& row) { return k_heading_cm + entry_width(row) - k_gap_cm <= k_legend_cell_cm; });
  return arrange(panel_count, line_count(rows, k_legend_strip_cm),
                 fits_cell ? std::optional(line_count(rows, k_legend_cell_cm)) : std::nullopt);
}

std::string legend_text(const std::vector<LegendRow>& rows, const Layout& layout) {
  std::string text =
      "\n# The legend: empty plots that show nothing but a key, each in its place; a terminal's own spacing of "
      "several\n"
      "# lines in one key would not be that of the headings.\n"
      "unset border; unset tics; unset xlabel; unset label\n"
      "set lmargin 0; set rmargin 0; set tmargin 0; set bmargin 0\n";
  const Box& place = layout.legend;
  double top = place.top();
  for (const LegendRow& row : rows) {
    std::vector<std::string> titles;
    for (const auto& entry : row.entries) titles.push_back(entry.title);
    titles = fitted_texts(titles, place.width - k_heading_cm - k_sample_cm);
    text += fmt::format("set label 1 {} at screen {:.4f}, {:.4f} left\n", gnuplot_string(row.heading),
                        place.left / layout.width, (top - 0.5 * k_legend_line_cm) / layout.height);
    const std::size_t columns = columns_of(row, place.width);
    for (std::size_t k = 0; k < row.entries.size(); ++k) {
      const double left = place.left + k_heading_cm + static_cast<double>(k % columns) * entry_width(row);
      text += fmt::format(
          "set key at screen {:.4f}, {:.4f} left top horizontal Left reverse enhanced spacing 1.2 samplen 2.5 "
          "noautotitle\n"
          "plot [0:1] [0:1] NaN, keyentry {} title {}\n",
          left / layout.width, top / layout.height, row.entries[k].style, label_string(titles[k]));
      if (k == 0) text += "unset label 1\n";
      if ((k + 1) % columns == 0 && k + 1 < row.entries.size()) top -= k_legend_line_cm;
    }
    top -= k_legend_line_cm;
  }
  return text;
}

}  // namespace monograin::figure
