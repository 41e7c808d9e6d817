#include "figure/gnuplot.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "figure/figure.hpp"
#include "history/external_program.hpp"

namespace monograin::figure {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_drawing = "drawing";
constexpr const char* k_log = "log";

/// A hidden folder beside a figure in which gnuplot works. The destructor removes it.
class Workplace {
 public:
  explicit Workplace(const fs::path& parent) {
    std::string pattern = (parent / ".figure-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) {
      throw FigureError(fmt::format("{} cannot be written to: {}", parent.string(), std::strerror(errno)));
    }
    path_ = pattern;
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;
  ~Workplace() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }

  [[nodiscard]] const fs::path& path() const noexcept { return path_; }

 private:
  fs::path path_;
};

[[nodiscard]] std::string contents(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
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

}  // namespace

fs::path find_gnuplot() {
  if (const auto gnuplot = find_program("gnuplot")) return *gnuplot;
  throw FigureError(
      "gnuplot was not found on the PATH; figures need it (on Debian: apt-get install gnuplot-nox). The recorded run "
      "is complete without it");
}

void run_gnuplot(const fs::path& gnuplot, const fs::path& script, const fs::path& figure) {
  const fs::path folder = fs::absolute(script).parent_path();
  const Workplace workplace(folder);
  const std::string drawing = (fs::path(".") / workplace.path().filename() / k_drawing).string();
  const fs::path log = workplace.path() / k_log;
  // --default-settings: a figure must not depend on somebody's ~/.gnuplot.
  const int code = [&] {
    try {
      return run_program(gnuplot,
                         {"--default-settings", "-e", fmt::format("output = '{}'", drawing),
                          (fs::path(".") / script.filename()).string()},
                         folder, log);
    } catch (const std::runtime_error& error) {
      throw FigureError(error.what());
    }
  }();
  std::error_code failure;
  const auto size = fs::file_size(workplace.path() / k_drawing, failure);
  if (code != 0 || failure || size == 0) {
    const std::string said = contents(log);
    throw FigureError(fmt::format("gnuplot could not draw the figure from {}: {}", script.string(),
                                  said.empty() ? "it said nothing" : said));
  }
  fs::rename(workplace.path() / k_drawing, figure, failure);
  if (failure) throw FigureError(fmt::format("{} cannot be written: {}", figure.string(), failure.message()));
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
