#include "figure/gnuplot.hpp"

#include <unistd.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "figure/figure.hpp"
#include "figure/fonts.hpp"
#include "history/external_program.hpp"
#include "scenario/hidden_path.hpp"
#include "scenario/text_file.hpp"

namespace monograin::figure {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_log = ".log";

/// A new hidden folder beside a figure.
[[nodiscard]] HiddenPath make_workplace(const fs::path& figure) {
  const fs::path parent = fs::absolute(figure).parent_path();
  std::string pattern = (parent / ".figure-XXXXXX").string();
  const auto held = hold_signals();
  if (mkdtemp(pattern.data()) == nullptr) {
    throw std::runtime_error(
        fmt::format("{} cannot be written: {}", shown_path(figure).string(), std::strerror(errno)));
  }
  return {pattern, shown_path(figure).parent_path()};
}

[[nodiscard]] bool is_control(char c) noexcept { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; }

/// A gnuplot string in double quotes, which can hold any byte. Special characters are given by their numbers: gnuplot
/// runs text between backquotes as a command, even in such a string.
[[nodiscard]] std::string in_double_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool has_meaning = c == '"' || c == '\\' || c == '`' || is_control(c) || byte > 0x7FU;
    result += has_meaning ? fmt::format("\\{:03o}", static_cast<unsigned>(byte)) : std::string(1, c);
  }
  return result + '"';
}

/// A number of four bytes, as PNG files have it.
[[nodiscard]] std::string png_number(std::uint32_t value) {
  std::string bytes;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>((value >> shift) & 0xFFU);
  return bytes;
}

/// States the resolution of a PNG file, which gnuplot leaves out: programs would place the figure at 72 or 96 dots per
/// inch, several times too large.
void state_resolution(const fs::path& file) {
  constexpr std::size_t k_header = 33;  // signature and first chunk
  std::string png = read_text_file(file, k_largest_text).text;
  const std::string per_metre = png_number(static_cast<std::uint32_t>(std::lround(100.0 * k_png_per_cm)));
  const std::string chunk = "pHYs" + per_metre + per_metre + '\1';
  boost::crc_32_type checksum;
  checksum.process_bytes(chunk.data(), chunk.size());
  png.insert(k_header, png_number(9) + chunk + png_number(checksum.checksum()));
  write_text_file(file, png);
}

}  // namespace

fs::path find_gnuplot() {
  if (const auto gnuplot = find_program("gnuplot")) return *gnuplot;
  throw FigureError(
      "gnuplot was not found on the PATH; figures need it (on Debian: apt-get install gnuplot-nox). The recorded run "
      "is complete without it");
}

void draw_with_gnuplot(const fs::path& gnuplot, const fs::path& figure, const std::string& script,
                       const std::string& data) {
  const HiddenPath workplace = make_workplace(figure);
  const fs::path& folder = workplace.path();
  if (figure.extension() != ".svg") expect_fonts(script, figure, folder / k_log);
  const fs::path drawing_name = figure.filename();
  const fs::path script_name = fs::path(drawing_name).replace_extension(".gp");
  const fs::path data_name = fs::path(drawing_name).replace_extension(".dat");
  write_text_file(folder / script_name, script);
  write_text_file(folder / data_name, data);
  // --default-settings: a figure must not depend on somebody's ~/.gnuplot.
  const int code = [&] {
    try {
      return run_program(gnuplot,
                         {"--default-settings", "-e", "output = " + gnuplot_file(drawing_name.string()),
                          (fs::path(".") / script_name).string()},
                         folder, folder / k_log);
    } catch (const std::runtime_error& error) {
      throw FigureError(error.what());
    }
  }();
  std::error_code failure;
  const auto size = fs::file_size(folder / drawing_name, failure);
  if (code != 0 || failure || size == 0) {
    const std::string said = read_text_file(folder / k_log, k_largest_text).text;
    const std::string end = code < 0 ? fmt::format("a signal ended it ({})", strsignal(-code)) : "it said nothing";
    throw FigureError(
        fmt::format("gnuplot could not draw {}: {}", shown_path(figure).string(), said.empty() ? end : said));
  }
  if (figure.extension() == ".png") state_resolution(folder / drawing_name);
  // The script first, because it tells whose the other files are.
  const auto held = hold_signals();
  for (const fs::path& name : {script_name, data_name, drawing_name}) {
    fs::rename(folder / name, figure.parent_path() / name, failure);
    if (failure) {
      throw std::runtime_error(fmt::format("{} cannot be written: {}", shown_path(figure).string(), failure.message()));
    }
  }
}

std::string plain_text(std::string_view text) {
  // The round trip replaces bytes that are not UTF-8: no viewer opens an SVG file with such bytes.
  using Json = nlohmann::json;
  std::string result = Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
  std::ranges::replace_if(result, is_control, ' ');
  return result;
}

std::string gnuplot_string(std::string_view text) {
  const std::string plain = plain_text(text);  // in single quotes, a quote next to another one ends the string
  return plain.find('\'') == std::string::npos ? '\'' + plain + '\'' : in_double_quotes(plain);
}

std::string gnuplot_file(const std::string& name) {
  const std::string path = "./" + name;
  return plain_text(path) == path ? gnuplot_string(path) : in_double_quotes(path);
}

}  // namespace monograin::figure
