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

/// True if a panel shows the curve of a contact. A contact that never bears a force has neither pressure nor area.
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
        if (!has_phase(runs[k].phases, phase)) continue;
        plots.push_back(fmt::format("data index {} using 1:{} {}", gnuplot_string(block_name(k, contact.name, phase)),
                                    data_column(quantity), phase_line(line, phase)));
      }
      if (is_of_particle) break;  // the apparent radius is the same with every contact
    }
  }
}

void append_events(std::vector<std::string>& plots, const std::vector<RunCurves>& runs, Quantity quantity) {
  for (const std::string& name : event_names(runs)) {
    const bool is_here = std::ranges::any_of(runs, [&](const RunCurves& run) {
      return std::ranges::any_of(run.events,
                                 [&](const EventMark& mark) { return mark.name == name && is_marked(mark, quantity); });
    });
    if (!is_here) continue;
    plots.push_back(fmt::format("data index {} using 1:{} {}", gnuplot_string(block_name(name)), data_column(quantity),
                                event_points(name)));
  }
}

/// All values of the curves that a panel shows, for its axes.
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

[[nodiscard]] std::string plots_text(const std::vector<RunCurves>& runs, const Palette& palette, Quantity quantity) {
  std::vector<std::string> plots;
  append_curves(plots, runs, quantity, palette);
  append_events(plots, runs, quantity);
  return fmt::format("plot {}\n", fmt::join(plots, ", \\\n  "));
}

/// Quantities that at least one contact has.
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
  const Layout layout = layout_of(quantities.size(), rows);

  std::string text = page_head(format, layout, figure_name, data_name);
  for (std::size_t k = 0; k < quantities.size(); ++k) {
    const PanelValues values = panel_values(runs, scales, quantities[k]);
    text += frame_text(layout, k, {scales.displacement_label(), axis_range(values.x)},
                       {scales.label(quantities[k]), axis_range(values.y)});
    text += plots_text(runs, palette, quantities[k]);
  }
  text += legend_text(rows, layout);
  return text + k_page_foot;
}

}  // namespace monograin::figure
