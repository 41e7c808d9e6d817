/// The gnuplot script of a figure.
#pragma once

#include <string>
#include <vector>

#include "figure/page.hpp"
#include "figure/panels.hpp"
#include "figure/run_curves.hpp"

namespace monograin::figure {

/// @param figure_name, data_name  files in the script's own folder
/// A figure name set before as the gnuplot variable `output` wins over figure_name.
[[nodiscard]] std::string script_text(const std::vector<RunCurves>& runs, const Scales& scales, Format format,
                                      const std::string& figure_name, const std::string& data_name);

}  // namespace monograin::figure
