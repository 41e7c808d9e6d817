/// Figures of recorded runs, drawn by gnuplot.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <vector>

namespace monograin {

/// A figure could not be drawn; the message says why and what to do. The runs themselves are untouched.
class FigureError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Draws force, pressure, contact area and apparent radius of one or more runs against displacement; of a model without
/// walls, its own quantities against the one that it is driven through.
///
/// Loading is drawn solid, unloading dashed, reloading dotted; events are open circles named in a legend. Beside the
/// figure its gnuplot script and data file are kept, from which it can be drawn again.
///
/// The displacement is that of the driven contact class: the first one that moves. Quantities are dimensionless where
/// every run gives its radius and modulus (p/Y where it gives a yield stress), else in SI. What no run has is left
/// out: the panel of the apparent radius for a law at fixed radius, pressure and area of a contact that is never made.
///
/// @param runs    folders with history.csv and events.csv (or paths of history.csv files)
/// @param output  file to write; the extension picks the format: .svg, .pdf, .png
/// @throws FigureError when gnuplot is missing, the format is unknown, a run cannot be read, or gnuplot fails (names
/// the script). Without gnuplot nothing is written; a figure that was there stays until the new one is whole.
void draw_runs(const std::vector<std::filesystem::path>& runs, const std::filesystem::path& output);

}  // namespace monograin
