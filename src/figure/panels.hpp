/// Which panels a figure has, in which scale, and where they are.
#pragma once

#include <string>
#include <vector>

#include "figure/run_curves.hpp"

namespace monograin::figure {

/// Makes quantities dimensionless where every run gives what that takes; otherwise they stay in SI.
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
  double y_label_left;  ///< middle of the y axis' label: the same for panels above each other, whatever their tics
};

/// Panels two by two; the legend takes the free place beside a third panel, else a strip below all.
struct Layout {
  double width, height;
  std::vector<Panel> panels;
  Box legend;
};

inline constexpr double k_legend_line_cm = 0.5;
/// Widths the legend can have; its lines break accordingly.
inline constexpr double k_legend_strip_cm = 16.4;
inline constexpr double k_legend_cell_cm = 7.9;

/// @param lines_in_strip, lines_in_cell  lines the legend takes in either width
[[nodiscard]] Layout arrange(std::size_t panel_count, std::size_t lines_in_strip, std::size_t lines_in_cell);

/// What an axis shows.
struct AxisRange {
  double lowest, highest, tic_step;
};

/// The range of an axis with some values on it: a little air except at zero, and a round distance of tics with at most
/// five intervals. Less than a thousandth of the values is no change to look at: it is drawn flat, not blown up.
/// @param values  at least one, all finite
[[nodiscard]] AxisRange axis_range(const std::vector<double>& values);

}  // namespace monograin::figure
