#include "figure/figure.hpp"

#include "figure/body_runs.hpp"
#include "figure/data_file.hpp"
#include "figure/page.hpp"
#include "figure/run_curves.hpp"
#include "figure/script.hpp"

namespace monograin {

void draw_runs(const std::vector<std::filesystem::path>& runs, const std::filesystem::path& output) {
  if (runs.empty()) throw FigureError("there is no run to draw");
  const figure::FigureFiles files(output);
  if (const auto chart = figure::body_chart(runs)) return figure::draw_chart(*chart, "runs", output);
  const auto curves = figure::read_runs(runs);
  const figure::Scales scales(curves);
  files.write(figure::data_text(curves, scales),
              figure::script_text(curves, scales, files.format(), files.figure_name(), files.data_name()));
}

}  // namespace monograin
