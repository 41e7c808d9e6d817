#include "figure/figure.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "figure/data_file.hpp"
#include "figure/gnuplot.hpp"
#include "figure/run_curves.hpp"
#include "figure/script.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

[[nodiscard]] figure::Format format_of(const fs::path& output) {
  const std::string extension = output.extension().string();
  if (extension == ".svg") return figure::Format::svg;
  if (extension == ".pdf") return figure::Format::pdf;
  if (extension == ".png") return figure::Format::png;
  throw FigureError(
      fmt::format("{}: unknown figure format '{}'; expected .svg, .pdf or .png", output.string(), extension));
}

/// Writes the whole file or leaves what was there.
void write_whole(const fs::path& file, const std::string& text) {
  const fs::path part = fs::path(file).concat(fmt::format(".{}.part", getpid()));
  std::ofstream out(part, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  std::error_code failure;
  if (out) fs::rename(part, file, failure);
  if (!out || failure) {
    std::error_code ignored;
    fs::remove(part, ignored);
    throw FigureError(fmt::format("{} cannot be written", file.string()));
  }
}

void make_folder(const fs::path& folder) {
  std::error_code failure;
  if (!folder.empty()) fs::create_directories(folder, failure);
  if (failure) throw FigureError(fmt::format("{} cannot be made: {}", folder.string(), failure.message()));
}

}  // namespace

void draw_runs(const std::vector<fs::path>& runs, const fs::path& output) {
  if (runs.empty()) throw FigureError("there is no run to draw");
  const figure::Format format = format_of(output);
  const fs::path gnuplot = figure::find_gnuplot();
  const auto curves = figure::read_runs(runs);
  const figure::Scales scales(curves);

  const fs::path script = fs::path(output).replace_extension(".gp");
  const fs::path data = fs::path(output).replace_extension(".dat");
  make_folder(output.parent_path());
  write_whole(data, figure::data_text(curves, scales));
  write_whole(script,
              figure::script_text(curves, scales, format, output.filename().string(), data.filename().string()));
  figure::run_gnuplot(gnuplot, script, output);
}

}  // namespace monograin
