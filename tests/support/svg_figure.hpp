/// Content of an SVG that gnuplot drew, and comparison of two of them.
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
  std::vector<Line> lines;       ///< a point is a line with one place
};

struct SvgFigure {
  std::vector<std::string> texts;  ///< tics, labels, notes and legends, in the order of the file
  std::vector<SvgPlot> plots;
};

/// @throws std::runtime_error if the file does not exist or is empty
[[nodiscard]] SvgFigure read_svg(const std::filesystem::path& file);

/// Largest distance of a place in one figure from the other figure's lines [px]; panels are about 155 px high.
struct SvgTolerance {
  double line = 1.0;
  double area = 2.5;
};

/// Differences between two figures: texts, curves, styles, places. Empty: the figures look alike. The number of a
/// line's vertices does not matter.
[[nodiscard]] std::vector<std::string> differences(const SvgFigure& a, const SvgFigure& b,
                                                   const SvgTolerance& tolerance = {});

}  // namespace monograin
