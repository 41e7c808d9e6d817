#include "figure/gnuplot.hpp"

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>
#include <gnuplot-iostream.h>
#include <unistd.h>

#include "figure/figure.hpp"

namespace monograin::figure {
namespace {

namespace fs = std::filesystem;

/// What gnuplot says once the script has run to its end: its exit code is 0 even where the script failed.
constexpr std::string_view k_done = "monograin: the script ran to its end";

/// If gnuplot dies, writing to it must fail instead of ending this process.
class SigpipeIgnored {
 public:
  SigpipeIgnored() {
    struct sigaction ignore = {};
    ignore.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &ignore, &before_);
  }
  SigpipeIgnored(const SigpipeIgnored&) = delete;
  SigpipeIgnored& operator=(const SigpipeIgnored&) = delete;
  ~SigpipeIgnored() { sigaction(SIGPIPE, &before_, nullptr); }

 private:
  struct sigaction before_ = {};
};

/// A file that is gone when the work is done, however it ends.
class TemporaryFile {
 public:
  explicit TemporaryFile(fs::path path) : path_(std::move(path)) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }

  [[nodiscard]] const fs::path& path() const noexcept { return path_; }
  [[nodiscard]] bool is_empty() const {
    std::error_code missing;
    const auto size = fs::file_size(path_, missing);
    return missing || size == 0;
  }

 private:
  fs::path path_;
};

[[nodiscard]] std::string quoted_for_shell(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
    } else {
      result += c;
    }
  }
  return result + '\'';
}

[[nodiscard]] std::string contents(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Runs the script with its figure going to `output` and all that gnuplot says to `log`.
void load_script(const fs::path& gnuplot, const fs::path& script, const fs::path& output, const fs::path& log) {
  // --default-settings: a figure must not depend on somebody's ~/.gnuplot. "|| true": gnuplot-iostream prints to stderr
  // when the program fails; failure is judged by the log.
  const std::string command = fmt::format("{} --default-settings > {} 2>&1 || true", quoted_for_shell(gnuplot.string()),
                                          quoted_for_shell(log.string()));
  const SigpipeIgnored sigpipe_ignored;
  Gnuplot pipe(command);
  pipe << "cd " << gnuplot_string(script.parent_path().string()) << "\noutput = " << gnuplot_string(output.string())
       << "\nload " << gnuplot_string(script.filename().string()) << "\nprint " << gnuplot_string(k_done) << "\n";
}

}  // namespace

fs::path find_gnuplot() {
  const char* const variable = std::getenv("PATH");
  std::string_view folders = variable ? variable : "/usr/local/bin:/usr/bin:/bin";
  for (;;) {
    const std::size_t colon = folders.find(':');
    const fs::path candidate = fs::path(folders.substr(0, colon)) / "gnuplot";
    std::error_code ignored;
    if (fs::is_regular_file(candidate, ignored) && access(candidate.c_str(), X_OK) == 0) return fs::absolute(candidate);
    if (colon == std::string_view::npos) break;
    folders.remove_prefix(colon + 1);
  }
  throw FigureError(
      "gnuplot was not found on the PATH; figures need it (on Debian: apt-get install gnuplot-nox). The recorded run "
      "is complete without it");
}

void run_gnuplot(const fs::path& gnuplot, const fs::path& script, const fs::path& figure) {
  const fs::path place = fs::absolute(script);
  const std::string suffix = fmt::format(".{}", getpid());
  const TemporaryFile drawing(fs::absolute(figure).concat(suffix + ".part"));
  const TemporaryFile log(fs::absolute(figure).concat(suffix + ".log"));
  load_script(gnuplot, place, drawing.path(), log.path());

  const std::string said = contents(log.path());
  if (said.find(k_done) == std::string::npos || drawing.is_empty()) {
    throw FigureError(fmt::format("gnuplot could not draw the figure from {}: {}", script.string(),
                                  said.empty() ? "it said nothing" : said));
  }
  std::error_code failure;
  fs::rename(drawing.path(), figure, failure);
  if (failure) throw FigureError(fmt::format("{} cannot be written: {}", figure.string(), failure.message()));
}

std::string gnuplot_string(std::string_view text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result + '\'';
}

}  // namespace monograin::figure
