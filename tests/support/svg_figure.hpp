/// What an SVG that gnuplot drew shows, and how far two of them are from each other.
#pragma once

#include <array>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace monograin {

/// One curve, set of points or area.
struct SvgPlot {
  using Place = std::array<double, 2>;  ///< in pixels
  struct Line {
    std::vector<Place> places;
    bool is_area = false;
  };

  std::string title;
  std::set<std::string> styles;  ///< colours, dashes and kinds of points
  std::vector<Line> lines;       ///< a point is a line of one place
};

struct SvgFigure {
  std::vector<std::string> texts;  ///< tics, labels, notes and legends, in the order of the file
  std::vector<SvgPlot> plots;
};

/// @throws std::runtime_error where there is no such file or it is empty
[[nodiscard]] SvgFigure read_svg(const std::filesystem::path& file);

/// How far a place may be from what the other figure shows there [px]; panels are about 155 px high.
struct SvgTolerance {
  double line = 1.0;
  double area = 2.5;
};

/// Says what one figure shows and the other does not: texts, curves, styles, places. Empty: they show the same. How
/// many vertices a line has does not count.
[[nodiscard]] std::vector<std::string> differences(const SvgFigure& a, const SvgFigure& b,
                                                   const SvgTolerance& tolerance = {});

}  // namespace monograin
