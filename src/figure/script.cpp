#include "figure/script.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "figure/data_file.hpp"
#include "figure/gnuplot.hpp"
#include "figure/legend.hpp"

namespace monograin::figure {
namespace {

[[nodiscard]] std::string terminal(Format format, const Layout& layout) {
  constexpr double k_svg_per_cm = 37.8;  // CSS: 96 px to the inch
  constexpr double k_png_per_cm = 80.0;
  const auto pixels = [](double cm, double per_cm) { return std::lround(cm * per_cm); };
  switch (format) {
    case Format::svg:
      return fmt::format("svg enhanced size {},{} font 'Helvetica,13' background 'white'",
                         pixels(layout.width, k_svg_per_cm), pixels(layout.height, k_svg_per_cm));
    case Format::pdf:
      return fmt::format("pdfcairo enhanced size {}cm,{:.4g}cm font 'Helvetica,10'", layout.width, layout.height);
    case Format::png:
      return fmt::format("pngcairo enhanced size {},{} font 'Helvetica,10' fontscale 2.1 linewidth 2 pointscale 2",
                         pixels(layout.width, k_png_per_cm), pixels(layout.height, k_png_per_cm));
  }
  return {};
}

[[nodiscard]] std::string preamble(Format format, const Layout& layout, const std::string& figure_name,
                                   const std::string& data_name) {
  return fmt::format(
      "# Draws {0}; run it in its own folder.\n"
      "if (!exists(\"output\")) output = {0}\n"
      "data = {1}\n\n"
      "set encoding utf8\n"
      "set terminal {2}\n"
      "set output output\n"
      "set border 3 lw 0.8\n"
      "set tics nomirror out scale 0.6\n"
      "set xtics offset 0, 0.3\n"
      "set format '%g'\n"
      "set xlabel offset 0, 0.5\n"
      "unset key\n"
      "set multiplot\n",
      gnuplot_string(figure_name), gnuplot_string(data_name), terminal(format, layout));
}

/// The curve of a contact in a panel. One that never bears a force has neither pressure nor area to show.
[[nodiscard]] bool is_shown(const ContactCurve& contact, Quantity quantity) {
  const bool needs_contact = quantity == Quantity::pressure || quantity == Quantity::area;
  return contact.has(quantity) && (contact.is_ever_made || !needs_contact);
}

void append_curves(std::vector<std::string>& plots, const std::vector<RunCurves>& runs, Quantity quantity,
                   const Palette& palette) {
  for (std::size_t k = 0; k < runs.size(); ++k) {
    for (const ContactCurve& contact : runs[k].contacts) {
      if (!is_shown(contact, quantity)) continue;
      const bool is_of_particle = quantity == Quantity::apparent_radius;
      const auto line = is_of_particle ? palette.particle_line(k) : palette.contact_line(k, contact.name);
      for (const Phase phase : k_phases) {
        if (!has_phase(runs[k], phase)) continue;
        plots.push_back(fmt::format("data index {} using 1:{} with lines {} {}",
                                    gnuplot_string(block_name(k, contact.name, phase)), data_column(quantity), line,
                                    dash(phase)));
      }
      if (is_of_particle) break;  // the same beside every contact
    }
  }
}

void append_events(std::vector<std::string>& plots, const std::vector<RunCurves>& runs, Quantity quantity) {
  const auto names = event_names(runs);
  for (std::size_t place = 0; place < names.size(); ++place) {
    const bool is_here = std::ranges::any_of(runs, [&](const RunCurves& run) {
      return std::ranges::any_of(
          run.events, [&](const EventMark& mark) { return mark.name == names[place] && is_marked(mark, quantity); });
    });
    if (!is_here) continue;
    plots.push_back(fmt::format("data index {} using 1:{} with points {}", gnuplot_string(block_name(names[place])),
                                data_column(quantity), event_points(place)));
  }
}

[[nodiscard]] std::string axis_text(char axis, const std::vector<double>& values) {
  const AxisRange range = axis_range(values);
  return fmt::format("set {0}range [{1:.6g}:{2:.6g}]; set {0}tics {3:.6g}\n", axis, range.lowest, range.highest,
                     range.tic_step);
}

/// What a panel has on its axes: all values of the curves that are shown.
struct PanelValues {
  std::vector<double> x;
  std::vector<double> y;
};

[[nodiscard]] PanelValues panel_values(const std::vector<RunCurves>& runs, const Scales& scales, Quantity quantity) {
  PanelValues values;
  for (const RunCurves& run : runs) {
    for (const ContactCurve& contact : run.contacts) {
      if (!is_shown(contact, quantity)) continue;
      for (const ContactState& state : contact.states) {
        if (!std::isfinite(state.displacement) || !std::isfinite(state[quantity])) continue;
        values.x.push_back(scales.displacement(run, state.displacement));
        values.y.push_back(scales.value(run, quantity, state[quantity]));
      }
    }
  }
  return values;
}

[[nodiscard]] std::string axes_text(const Panel& panel, const Layout& layout, const PanelValues& values) {
  const Box& axes = panel.axes;
  return fmt::format(
      "\nset lmargin at screen {:.4f}; set rmargin at screen {:.4f}\n"
      "set bmargin at screen {:.4f}; set tmargin at screen {:.4f}\n"
      "{}{}",
      axes.left / layout.width, axes.right() / layout.width, axes.bottom / layout.height, axes.top() / layout.height,
      axis_text('x', values.x), axis_text('y', values.y));
}

[[nodiscard]] std::string labels_text(const Panel& panel, const Layout& layout, const Scales& scales, Quantity quantity,
                                      char letter) {
  return fmt::format(
      "set xlabel {}\n"
      "set label 1 '({})' at graph 0.02, 1.06 left\n"
      "set label 2 {} at screen {:.4f}, {:.4f} center rotate by 90\n",
      gnuplot_string(scales.displacement_label()), letter, gnuplot_string(scales.label(quantity)),
      panel.y_label_left / layout.width, (panel.axes.bottom + 0.5 * panel.axes.height) / layout.height);
}

[[nodiscard]] std::string plots_text(const std::vector<RunCurves>& runs, const Palette& palette, Quantity quantity) {
  std::vector<std::string> plots;
  append_curves(plots, runs, quantity, palette);
  append_events(plots, runs, quantity);
  return fmt::format("plot {}\n", fmt::join(plots, ", \\\n  "));
}

/// What at least one contact has to show.
[[nodiscard]] std::vector<Quantity> shown_quantities(const std::vector<RunCurves>& runs) {
  std::vector<Quantity> shown;
  for (const Quantity quantity : k_quantities) {
    const bool has_curve = std::ranges::any_of(runs, [=](const RunCurves& run) {
      return std::ranges::any_of(run.contacts,
                                 [=](const ContactCurve& contact) { return is_shown(contact, quantity); });
    });
    if (has_curve) shown.push_back(quantity);
  }
  return shown;
}

}  // namespace

std::string script_text(const std::vector<RunCurves>& runs, const Scales& scales, Format format,
                        const std::string& figure_name, const std::string& data_name) {
  const Palette palette(runs);
  const auto rows = legend_rows(runs, palette);
  const auto quantities = shown_quantities(runs);
  const Layout layout =
      arrange(quantities.size(), line_count(rows, k_legend_strip_cm), line_count(rows, k_legend_cell_cm));

  std::string text = preamble(format, layout, figure_name, data_name);
  char letter = 'a';
  for (std::size_t k = 0; k < quantities.size(); ++k) {
    const Panel& panel = layout.panels[k];
    text += axes_text(panel, layout, panel_values(runs, scales, quantities[k]));
    text += labels_text(panel, layout, scales, quantities[k], letter++);
    text += plots_text(runs, palette, quantities[k]);
  }
  text += legend_text(rows, layout);
  return text + "unset multiplot\nunset output\n";
}

}  // namespace monograin::figure
