/// Charts of any curves: panels with lines, points and filled areas.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "figure/page.hpp"

namespace monograin::figure {

/// One curve. Rows in which x or y is undefined are gaps.
struct ChartSeries {
  enum class Style {
    phases,  ///< a line: loading solid, unloading dashed, reloading dotted, as x goes forth and back
    solid,
    dashed,
    dotted,
    dash_dotted,
    points,
    events,  ///< points with the symbol of the event that the legend names, which stands there as in the file
  };

  std::string legend{};  ///< gnuplot's enhanced text; series with the same text share a line of the legend; empty: none
  Style style = Style::phases;
  std::optional<std::size_t> colour{};  ///< number of a colour, from 0; absent: the next one that no other legend has
  std::vector<double> x{};
  std::vector<double> y{};
  /// y is an error, which may be zero. On a logarithmic ordinate, values at or below the lower end of the axis are
  /// drawn at that end, with marks.
  bool is_error = false;
};

/// Filled boxes of one colour, drawn below the series.
struct ChartArea {
  using Box = std::array<double, 4>;  ///< lowest and highest x, lowest and highest y

  std::string legend;
  unsigned colour = 0;  ///< 0xRRGGBB
  std::vector<Box> boxes{};
};

/// The area between two curves over the same x, drawn below the series. Rows in which anything is undefined are gaps.
struct ChartBand {
  std::string legend;
  unsigned colour = 0;  ///< 0xRRGGBB
  std::vector<double> x;
  std::vector<double> lower;
  std::vector<double> upper;
};

struct ChartAxis {
  std::string label;               ///< gnuplot's enhanced text
  std::optional<double> lowest{};  ///< absent: chosen from the values
  std::optional<double> highest{};
  bool is_logarithmic = false;       ///< only positive values are shown then
  std::vector<std::string> names{};  ///< gnuplot's enhanced texts at 1, 2, ... in place of numbers
  bool keeps_unit = false;           ///< large numbers get a power of ten and not another unit
};

/// The part of the abscissa to which a law was fitted, or in which it holds. The rest of the panel is shaded.
struct ChartRange {
  std::optional<double> from{};  ///< absent: no lower end
  std::optional<double> to{};    ///< absent: no upper end
  std::string legend{};          ///< legend of the shade
};

struct ChartPanel {
  ChartAxis x;
  ChartAxis y;
  std::string note{};  ///< text above the panel that distinguishes it from the others
  std::optional<ChartRange> range{};
  std::vector<ChartArea> areas{};
  std::vector<ChartBand> bands{};
  std::vector<ChartSeries> series{};
};

struct Chart {
  std::vector<ChartPanel> panels{};       ///< at least one; arranged two by two
  std::string area_heading = "Area";      ///< heading of areas and ranges in the legend; bands have their own
  std::vector<std::string> head{};        ///< lines of text above the panels, in a monospaced font
  std::vector<std::string> foot{};        ///< lines below the legend; with any text the page is as tall as an A4 page
  std::vector<std::string> references{};  ///< of the models behind it, for the data file; a line may come twice
};

/// Text of the figure's data file. @param source  origin of the figure, for the file's first line
[[nodiscard]] std::string chart_data(const Chart& chart, const std::string& source);

/// The gnuplot script of the chart. A panel without any value on an axis is drawn from 0 to 1.
/// @param figure_name, data_name  files in the script's own folder
[[nodiscard]] std::string chart_script(const Chart& chart, Format format, const std::string& figure_name,
                                       const std::string& data_name);

/// Draws a chart, with its script and its data beside it. @throws FigureError
void draw_chart(const Chart& chart, const std::string& source, const std::filesystem::path& output);

/// Draws a chart, without throwing if this fails. @return why it failed; empty if the chart was drawn
[[nodiscard]] std::string try_to_draw(const Chart& chart, const std::string& source,
                                      const std::filesystem::path& output);

}  // namespace monograin::figure
