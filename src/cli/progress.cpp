#include "cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace monograin {
namespace {

constexpr std::size_t k_width = 30;
constexpr std::chrono::milliseconds k_interval{100};
// Moves to the beginning of the line and clears it.
constexpr const char* k_clear_line = "\r\x1b[K";

/// True if standard error is a terminal that understands the codes which clear a line.
bool may_rewrite_lines() {
  const char* const terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && std::getenv("NO_COLOR") == nullptr && terminal != nullptr &&
         terminal != std::string_view("dumb");
}

void draw(const std::string& text) { std::fputs((k_clear_line + text).c_str(), stderr); }

}  // namespace

std::string progress_text(double share, double seconds, const std::string& what) {
  const auto filled = static_cast<std::size_t>(share * k_width);
  const std::string text =
      fmt::format("[{:<{}}] {:3.0f}%  {}", std::string(filled, '#'), k_width, std::floor(100.0 * share), what);
  if (share == 0.0 || seconds <= 0.0) return text;
  const auto left = std::lround(seconds * (1.0 - share) / share);
  return text + (left < 3600 ? fmt::format(", {}:{:02} left", left / 60, left % 60)
                             : fmt::format(", {}:{:02}:{:02} left", left / 3600, left / 60 % 60, left % 60));
}

ProgressBar::ProgressBar(std::string what) : what_(std::move(what)), is_shown_(may_rewrite_lines()) {}

ProgressBar::~ProgressBar() {
  if (is_shown_) std::fputs(k_clear_line, stderr);
}

void ProgressBar::show(std::size_t done, std::size_t of) {
  const std::optional<double> seconds = due();
  if (!seconds) return;
  const double rate = static_cast<double>(done) / *seconds;
  std::string items = fmt::format("{}/{} {}", done, of, what_);
  if (done > 0)
    items += rate < 100.0 ? fmt::format(", {:.3g} {}/s", rate, what_) : fmt::format(", {:.0f} {}/s", rate, what_);
  draw(progress_text(of == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(of), *seconds, items));
}

void ProgressBar::show(double share) {
  if (const std::optional<double> seconds = due()) draw(progress_text(share, *seconds, what_));
}

std::optional<double> ProgressBar::due() {
  const Clock::time_point now = Clock::now();
  if (!is_shown_ || now - last_ < k_interval) return std::nullopt;
  last_ = now;
  return std::chrono::duration<double>(now - start_).count();
}

}  // namespace monograin
