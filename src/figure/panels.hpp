/// Panels of a figure: scales, layout and ranges of axes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "figure/run_curves.hpp"

namespace monograin::figure {

/// Makes quantities dimensionless if every run gives the radius, modulus or yield stress for that; else keeps SI.
class Scales {
 public:
  explicit Scales(const std::vector<RunCurves>& runs);

  [[nodiscard]] double displacement(const RunCurves& run, double value) const;
  [[nodiscard]] double value(const RunCurves& run, Quantity quantity, double value) const;

  [[nodiscard]] std::string displacement_label() const;
  [[nodiscard]] std::string label(Quantity quantity) const;

 private:
  bool has_radius_ = true;
  bool has_modulus_ = true;
  bool has_yield_stress_ = true;
};

/// A rectangle in centimetres, from the figure's lower left corner.
struct Box {
  double left, bottom, width, height;

  [[nodiscard]] double right() const noexcept { return left + width; }
  [[nodiscard]] double top() const noexcept { return bottom + height; }
};

struct Panel {
  Box axes;             ///< the plot area within the axes
  double y_label_left;  ///< middle of the y axis' label: equal for panels above each other, whatever their tics
};

/// Panels two by two, in centimetres; the legend takes the free cell beside a third panel, else a strip below all.
struct Layout {
  double width, height;
  std::vector<Panel> panels{};
  Box legend;
};

// Room for labels at the right and at the top of a plot area.
inline constexpr double k_right_cm = 0.45;
inline constexpr double k_top_cm = 0.6;
inline constexpr double k_legend_line_cm = 0.5;
/// Widths the legend can have; its lines break accordingly.
inline constexpr double k_legend_strip_cm = 16.4;
inline constexpr double k_legend_cell_cm = 7.9;

/// Arranges panels and legend on the page.
/// @param lines_in_strip, lines_in_cell  number of lines of the legend at either width; none if it is wider than a cell
[[nodiscard]] Layout arrange(std::size_t panel_count, std::size_t lines_in_strip,
                             std::optional<std::size_t> lines_in_cell);

/// Range of an axis and distance of its tics.
struct AxisRange {
  double lowest, highest, tic_step;
};

/// Range of an axis for some values: with a small margin except at zero, and a round distance of tics with at most five
/// intervals. A change of less than a thousandth of the values is drawn flat instead of being enlarged.
/// @param values  at least one, all finite
[[nodiscard]] AxisRange axis_range(const std::vector<double>& values);

}  // namespace monograin::figure
