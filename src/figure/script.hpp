/// The gnuplot script of a figure.
#pragma once

#include <string>
#include <vector>

#include "figure/page.hpp"
#include "figure/panels.hpp"
#include "figure/run_curves.hpp"

namespace monograin::figure {

/// The gnuplot script of a figure of runs.
/// @param figure_name, data_name  files in the script's own folder
/// If the gnuplot variable `output` is already set, the figure goes to that file instead of figure_name.
[[nodiscard]] std::string script_text(const std::vector<RunCurves>& runs, const Scales& scales, Format format,
                                      const std::string& figure_name, const std::string& data_name);

}  // namespace monograin::figure
