/// Chart of one column of a table over another: histories of runs and results of sweeps.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "catalogue.hpp"
#include "figure/chart.hpp"

namespace monograin::figure {

struct ColumnChoice {
  std::string x{};     ///< a column's name, with or without its unit; empty: chosen from the table
  std::string y{};     ///< column of the ordinate; empty: the usual one
  std::string unit{};  ///< unit of y; empty: that of the table
};

/// An axis, and how its values follow from SI.
struct ColumnAxis {
  std::string unit;                       ///< as in its label; empty for a pure number
  Dimension dimension = Dimension::none;  ///< none, too, for a unit that is unknown
  double factor = 1.0;                    ///< SI value of one unit
};

struct ColumnChart {
  Chart chart;
  ColumnAxis x;
  ColumnAxis y;
};

/// The file that a path of a run or of a sweep stands for: the history or the results in a folder, or the file itself.
[[nodiscard]] std::filesystem::path recorded_table(const std::filesystem::path& path);

/// True for the folder of a sweep, or the file of its results.
[[nodiscard]] bool is_sweep(const std::filesystem::path& path);

/// Adds a mark at an event to the series of its name, which is made if it is missing. Events of the program have no
/// mark: the curves turn there.
void add_event(std::vector<ChartSeries>& series, std::string_view event, double x, double y);

/// Chart of chosen columns. Without a choice, a run shows the force of the driven walls over their displacement, and a
/// sweep shows the largest value of its first force over each key in a panel. Runs are drawn as lines with their
/// events, sweeps as points, which tell the values of a further key apart if there are few.
/// @throws FigureError if a table cannot be read or does not have a column, the unit is none of the column's, or a run
/// without contacts has no choice
[[nodiscard]] ColumnChart column_chart(const std::vector<std::filesystem::path>& paths, const ColumnChoice& choice);

/// Points of measured data over one another.
struct MeasuredPoints {
  struct Axis {
    std::string name;
    std::string unit;
    std::vector<double> values;  ///< in its unit
  };
  std::string legend;  ///< gnuplot's enhanced text
  Axis x;
  Axis y;
};

/// Adds points to every panel of a chart, in the units of its axes. @throws FigureError if a unit is of another kind
void add_points(ColumnChart& figure, const MeasuredPoints& points);

}  // namespace monograin::figure
