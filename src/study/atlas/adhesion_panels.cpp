#include "study/atlas/adhesion_panels.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

namespace monograin {
namespace {

/// Colours of the classes in turn, from the palette of all figures: as in the source, yellow where the model holds and
/// two blues where it does not.
constexpr std::array<unsigned, 3> k_colours{0xF0E442u, 0x56B4E9u, 0x0072B2u};

/// Share of a row by which a box overlaps the next one; a renderer would otherwise leave a white hairline between them.
constexpr double k_overlap = 0.05;

/// Half the distance of two points on a logarithmic axis, as a factor.
[[nodiscard]] double half_step(const std::vector<double>& axis) { return std::sqrt(axis[1] / axis[0]); }

/// Boxes around the points of a class; neighbours in a row form one box.
[[nodiscard]] std::vector<figure::ChartArea::Box> boxes_of(const AdhesionDiagram& diagram, std::size_t kind) {
  std::vector<figure::ChartArea::Box> boxes;
  const double half_column = half_step(diagram.modulus);
  const double half_row = half_step(diagram.yield_stress);
  const std::size_t columns = diagram.modulus.size();
  for (std::size_t row = 0; row < diagram.yield_stress.size(); ++row) {
    const bool is_top = row + 1 == diagram.yield_stress.size();
    const double y = diagram.yield_stress[row];
    for (std::size_t first = 0; first < columns; ++first) {
      if (diagram.at(row, first) != kind) continue;
      std::size_t last = first;
      while (last + 1 < columns && diagram.at(row, last + 1) == kind) ++last;
      boxes.push_back({diagram.modulus[first] / half_column, diagram.modulus[last] * half_column, y / half_row,
                       y * half_row * (is_top ? 1.0 : std::pow(half_row, 2.0 * k_overlap))});
      first = last;
    }
  }
  return boxes;
}

[[nodiscard]] figure::ChartAxis axis_of(const char* label, const std::vector<double>& points) {
  const double half = half_step(points);
  return {.label = label, .lowest = points.front() / half, .highest = points.back() * half, .is_logarithmic = true};
}

}  // namespace

std::vector<figure::ChartPanel> adhesion_panels(const std::vector<AdhesionDiagram>& diagrams) {
  std::vector<figure::ChartPanel> panels;
  for (const AdhesionDiagram& diagram : diagrams) {
    figure::ChartPanel panel{
        .x = axis_of("Modulus {/:Italic E}^* {/:Italic R}_0 / Δγ", diagram.modulus),
        .y = axis_of("Yield stress {/:Italic Y R}_0 / Δγ", diagram.yield_stress),
        .note = fmt::format("{{/:Italic δ}}_{{o,max}} / {{/:Italic R}}_0 = {}", diagram.displacement)};
    for (std::size_t kind = 0; kind < diagram.legends.size(); ++kind) {
      panel.areas.push_back({.legend = std::string(diagram.legends[kind]),
                             .colour = k_colours[kind % k_colours.size()],
                             .boxes = boxes_of(diagram, kind)});
    }
    panels.push_back(std::move(panel));
  }
  return panels;
}

}  // namespace monograin
