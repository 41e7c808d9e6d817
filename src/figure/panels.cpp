#include "figure/panels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "system/resolution.hpp"

namespace monograin::figure {
namespace {

constexpr double k_cell_height_cm = 6.0;
constexpr double k_figure_width_cm = 17.0;  // two columns of a journal page

// Room for labels at the left and at the bottom of a plot area.
constexpr double k_left_cm = 2.2;
constexpr double k_y_label_cm = 0.4;
constexpr double k_bottom_cm = 1.35;
constexpr double k_legend_margin_cm = 0.3;

constexpr double k_most_intervals = 5.0;  ///< between tics
constexpr double k_air = 0.03;            ///< share of the range left free beyond the curves
constexpr double k_flat = 0.9e-3;     ///< change, over the value, below which a curve is drawn flat; its tics are 0.001
constexpr double k_flat_steps = 1.2;  ///< distance of the ends of the axis from a flat curve, in tics

/// The smallest of ..., 0.2, 0.5, 1, 2, 5, 10, 20, ... that is not below `least`; 1 for zero.
[[nodiscard]] double round_step(double least) {
  if (!(least > 0.0)) return 1.0;
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= least * (1.0 - k_same_number)) return factor * decade;  // 0.4/5 may exceed 0.08 by round-off
  }
  return 10.0 * decade;
}

[[nodiscard]] double height_of(std::size_t legend_lines) noexcept {
  return static_cast<double>(legend_lines) * k_legend_line_cm;
}

}  // namespace

Scales::Scales(const std::vector<RunCurves>& runs) {
  for (const RunCurves& run : runs) {
    has_radius_ = has_radius_ && run.radius.has_value();
    has_modulus_ = has_modulus_ && run.youngs_modulus.has_value();
    has_yield_stress_ = has_yield_stress_ && run.yield_stress.has_value();
  }
}

double Scales::displacement(const RunCurves& run, double value) const {
  return has_radius_ ? value / *run.radius : value;
}

double Scales::value(const RunCurves& run, Quantity quantity, double value) const {
  switch (quantity) {
    case Quantity::force:
      return has_radius_ && has_modulus_ ? value / (*run.youngs_modulus * *run.radius * *run.radius) : value;
    case Quantity::pressure:
      if (has_yield_stress_) return value / *run.yield_stress;
      return has_modulus_ ? value / *run.youngs_modulus : value;
    case Quantity::area:
      return has_radius_ ? value / (std::numbers::pi * *run.radius * *run.radius) : value;
    case Quantity::apparent_radius:
      return has_radius_ ? value / *run.radius : value;
  }
  return value;
}

std::string Scales::displacement_label() const {
  return has_radius_ ? "Displacement {/:Italic δ}_o / {/:Italic R}_0" : "Displacement {/:Italic δ}_o [m]";
}

std::string Scales::label(Quantity quantity) const {
  switch (quantity) {
    case Quantity::force:
      return has_radius_ && has_modulus_ ? "Force {/:Italic F} / ({/:Italic E R}_0^2)" : "Force {/:Italic F} [N]";
    case Quantity::pressure:
      if (has_yield_stress_) return "Mean pressure {/:Italic p} / {/:Italic Y}";
      return has_modulus_ ? "Mean pressure {/:Italic p} / {/:Italic E}" : "Mean pressure {/:Italic p} [Pa]";
    case Quantity::area:
      return has_radius_ ? "Contact area {/:Italic A}_c / (π{/:Italic R}_0^2)" : "Contact area {/:Italic A}_c [m^2]";
    case Quantity::apparent_radius:
      return has_radius_ ? "Apparent radius {/:Italic R} / {/:Italic R}_0" : "Apparent radius {/:Italic R} [m]";
  }
  return {};
}

AxisRange axis_range(const std::vector<double>& values) {
  const auto [lowest, highest] = std::ranges::minmax(values);
  const double flat = k_flat * std::max(std::abs(lowest), std::abs(highest));
  const double step = round_step(std::max((highest - lowest) / k_most_intervals, flat));
  if (highest - lowest <= 2 * flat) {
    const double middle = std::midpoint(lowest, highest);
    return {middle - k_flat_steps * step, middle + k_flat_steps * step, step};
  }
  const double air = k_air * (highest - lowest);
  return {lowest == 0.0 ? 0.0 : lowest - air, highest == 0.0 ? 0.0 : highest + air, step};
}

Layout arrange(std::size_t panel_count, std::size_t lines_in_strip, std::optional<std::size_t> lines_in_cell) {
  const std::size_t columns = panel_count > 1 ? 2 : 1;
  const std::size_t rows = (panel_count + columns - 1) / columns;
  const bool is_in_cell =
      panel_count % columns != 0 && lines_in_cell && height_of(*lines_in_cell) <= k_cell_height_cm - k_top_cm;
  const bool has_strip = !is_in_cell && lines_in_strip > 0;
  const double strip = has_strip ? height_of(lines_in_strip) + 2 * k_legend_margin_cm : k_legend_margin_cm;
  const double cell_width = k_figure_width_cm / static_cast<double>(columns);

  Layout layout{.width = k_figure_width_cm,
                .height = static_cast<double>(rows) * k_cell_height_cm + strip,
                .legend = {k_legend_margin_cm, 0.0, k_legend_strip_cm, strip - k_legend_margin_cm}};
  if (is_in_cell) {
    layout.legend = {cell_width + k_legend_margin_cm, strip, k_legend_cell_cm, k_cell_height_cm - k_top_cm};
  }
  for (std::size_t k = 0; k < panel_count; ++k) {
    const std::size_t rows_below = rows - 1 - k / columns;
    const double cell_left = static_cast<double>(k % columns) * cell_width;
    const double cell_bottom = strip + static_cast<double>(rows_below) * k_cell_height_cm;
    layout.panels.push_back({.axes = {cell_left + k_left_cm, cell_bottom + k_bottom_cm,
                                      cell_width - k_left_cm - k_right_cm, k_cell_height_cm - k_bottom_cm - k_top_cm},
                             .y_label_left = cell_left + k_y_label_cm});
  }
  return layout;
}

}  // namespace monograin::figure
