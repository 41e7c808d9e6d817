/// Figures of recorded runs, drawn by gnuplot.
#pragma once

#include <array>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace monograin {

/// A figure could not be drawn; the message says why and what to do. The runs themselves are untouched.
class FigureError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

namespace figure {

/// Formats of figures, as the extensions of their files name them.
inline constexpr std::array<std::string_view, 3> k_formats{"svg", "pdf", "png"};
/// Format of a figure for which none is chosen.
inline constexpr std::string_view k_usual_format = k_formats.front();

}  // namespace figure

/// Draws force, pressure, contact area and apparent radius of one or more runs against displacement. For a model
/// without walls, draws its own quantities against the quantity through which it is driven.
///
/// Loading is drawn solid, unloading dashed, reloading dotted; events are open circles named in a legend. The gnuplot
/// script and the data file are kept beside the figure, which can be drawn again from them.
///
/// The displacement is that of the driven contact class: the first one that moves. Quantities are dimensionless if
/// every run gives its radius and modulus (p/Y if it gives a yield stress), else in SI. Quantities that no run has are
/// left out: the apparent radius of a law at fixed radius, pressure and area of a contact that is never made.
///
/// @param runs    folders with history.csv and events.csv (or paths of history.csv files)
/// @param output  file to write; the extension picks the format: .svg, .pdf, .png
/// @throws FigureError when gnuplot is missing, the format is unknown, a run cannot be read, or gnuplot fails (names
/// the script). Without gnuplot nothing is written; a figure that was there stays until the new one is whole.
void draw_runs(const std::vector<std::filesystem::path>& runs, const std::filesystem::path& output);

}  // namespace monograin
