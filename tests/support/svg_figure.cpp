#include "support/svg_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "support/text_file.hpp"

namespace monograin {
namespace {

using Place = SvgPlot::Place;

/// The text between two others, from a position on; empty if there is none. Moves the position behind it.
std::string_view between(std::string_view text, std::string_view before, std::string_view after, std::size_t& at) {
  const std::size_t start = text.find(before, at);
  if (start == std::string_view::npos) return at = std::string_view::npos, std::string_view{};
  const std::size_t begin = start + before.size();
  const std::size_t end = std::min(text.find(after, begin), text.size());
  at = std::min(end + after.size(), text.size());
  return text.substr(begin, end - begin);
}

std::string_view attribute(std::string_view element, std::string_view name) {
  std::size_t at = 0;
  return between(element, name, "'", at);
}

std::string without_tags(std::string_view text) {
  std::string kept;
  bool is_inside = false;
  for (const char c : text) {
    if (c == '<') is_inside = true;
    if (!is_inside) kept += c;
    if (c == '>') is_inside = false;
  }
  return kept;
}

std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  const char* const end = text.data() + text.size();
  for (const char* at = text.data(); at < end;) {
    double value = 0.0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error == std::errc{}) numbers.push_back(value);
    at = error == std::errc{} ? next : at + 1;
  }
  return numbers;
}

SvgPlot::Line line_of(std::string_view coordinates, bool is_area) {
  SvgPlot::Line line{.places = {}, .is_area = is_area};
  const std::vector<double> numbers = numbers_in(coordinates);
  for (std::size_t k = 0; k + 1 < numbers.size(); k += 2) line.places.push_back({numbers[k], numbers[k + 1]});
  return line;
}

/// Appends the lines of a path; each M begins a line.
void append_path(std::string_view path, SvgPlot& plot) {
  for (std::size_t at = path.find('M'); at != std::string_view::npos;) {
    const std::size_t next = path.find('M', at + 1);
    plot.lines.push_back(line_of(path.substr(at, next == std::string_view::npos ? next : next - at), false));
    at = next;
  }
}

void append_element(std::string_view element, SvgPlot& plot) {
  if (element.starts_with("path")) {
    append_path(attribute(element, "d='"), plot);
    plot.styles.insert(fmt::format("line {} {}", attribute(element, "stroke='"), attribute(element, "dasharray='")));
  } else if (element.starts_with("polygon")) {
    plot.lines.push_back(line_of(attribute(element, "points = '"), true));
    plot.styles.insert(fmt::format("area {}", attribute(element, "fill = '")));
  } else if (element.starts_with("use")) {
    const std::string_view place = attribute(element, "transform='translate(");
    plot.lines.push_back(line_of(place.substr(0, place.find(')')), false));
    plot.styles.insert(fmt::format("point {} {}", attribute(element, "href='"), attribute(element, "color='")));
  }
}

double distance(const Place& place, const Place& from, const Place& to) {
  const double along_x = to[0] - from[0];
  const double along_y = to[1] - from[1];
  const double squared = along_x * along_x + along_y * along_y;
  const double product = (place[0] - from[0]) * along_x + (place[1] - from[1]) * along_y;
  const double share = squared > 0.0 ? std::clamp(product / squared, 0.0, 1.0) : 0.0;
  return std::hypot(place[0] - from[0] - share * along_x, place[1] - from[1] - share * along_y);
}

using Piece = std::pair<Place, Place>;

/// Straight pieces of all lines of a plot; a point is a piece without length.
std::vector<Piece> pieces_of(const SvgPlot& plot) {
  std::vector<Piece> pieces;
  for (const SvgPlot::Line& line : plot.lines) {
    if (line.places.size() == 1) pieces.emplace_back(line.places[0], line.places[0]);
    for (std::size_t k = 1; k < line.places.size(); ++k) pieces.emplace_back(line.places[k - 1], line.places[k]);
  }
  return pieces;
}

/// Describes the place of a plot that is farthest from the other plot; empty if all are within the tolerance.
std::string farthest(const SvgPlot& plot, const SvgPlot& other, const SvgTolerance& tolerance) {
  const std::vector<Piece> pieces = pieces_of(other);
  std::string worst;
  double most = 1.0;
  std::size_t first = 0;  // the search begins at the last match: both plots run in the same direction
  for (const SvgPlot::Line& line : plot.lines) {
    const double allowed = line.is_area ? tolerance.area : tolerance.line;
    for (const Place& place : line.places) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < pieces.size() && least > allowed; ++k) {
        const std::size_t piece = (first + k) % pieces.size();
        least = std::min(least, distance(place, pieces[piece].first, pieces[piece].second));
        if (least <= allowed) first = piece;
      }
      if (least / allowed <= most) continue;
      most = least / allowed;
      worst = fmt::format("{}: {:.2f} px off at ({:.1f}, {:.1f})", plot.title, least, place[0], place[1]);
    }
  }
  return worst;
}

}  // namespace

SvgFigure read_svg(const std::filesystem::path& file) {
  const std::string content = read_text(file);
  if (content.empty()) throw std::runtime_error(file.string() + " is missing or empty");
  SvgFigure figure;
  const std::string_view text = content;
  for (std::size_t at = 0;;) {
    const std::string_view shown = between(text, "<text", "</text>", at);
    if (at == std::string_view::npos) break;
    figure.texts.push_back(without_tags(fmt::format("<{}", shown)));
  }
  constexpr std::string_view k_plot = "<g id=\"gnuplot_plot_";
  for (std::size_t at = text.find(k_plot); at != std::string_view::npos;) {
    const std::size_t next = text.find(k_plot, at + 1);
    const std::string_view part = text.substr(at, next == std::string_view::npos ? next : next - at);
    std::size_t place = 0;
    SvgPlot plot{.title = std::string(between(part, "<title>", "</title>", place)), .styles = {}, .lines = {}};
    while (place < part.size()) {
      const std::string_view element = between(part, "<", ">", place);
      if (element.empty()) break;
      append_element(element, plot);
    }
    figure.plots.push_back(std::move(plot));
    at = next;
  }
  return figure;
}

std::vector<std::string> differences(const SvgFigure& a, const SvgFigure& b, const SvgTolerance& tolerance) {
  std::vector<std::string> found;
  if (a.texts.size() != b.texts.size()) found.push_back(fmt::format("{} texts, {}", a.texts.size(), b.texts.size()));
  for (std::size_t k = 0; k < std::min(a.texts.size(), b.texts.size()); ++k) {
    if (a.texts[k] != b.texts[k]) found.push_back(fmt::format("'{}', '{}'", a.texts[k], b.texts[k]));
  }
  if (a.plots.size() != b.plots.size()) found.push_back(fmt::format("{} plots, {}", a.plots.size(), b.plots.size()));
  for (std::size_t k = 0; k < std::min(a.plots.size(), b.plots.size()); ++k) {
    const SvgPlot& one = a.plots[k];
    const SvgPlot& other = b.plots[k];
    if (one.title != other.title) found.push_back(fmt::format("'{}', '{}'", one.title, other.title));
    if (one.styles != other.styles) found.push_back(one.title + ": other colours, dashes or points");
    for (const std::string& far : {farthest(one, other, tolerance), farthest(other, one, tolerance)}) {
      if (!far.empty()) found.push_back(far);
    }
  }
  return found;
}

}  // namespace monograin
