#include "cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

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

}  // namespace

std::string progress_text(std::size_t done, std::size_t of, double seconds, const std::string& what) {
  const double share = of == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(of);
  const auto filled = static_cast<std::size_t>(share * k_width);
  std::string text = fmt::format("[{:<{}}] {:3.0f}%  {}/{} {}", std::string(filled, '#'), k_width,
                                 static_cast<double>(static_cast<int>(100.0 * share)), done, of, what);
  if (done == 0 || seconds <= 0.0) return text;
  const double rate = static_cast<double>(done) / seconds;
  const auto left = static_cast<long>(static_cast<double>(of - done) / rate + 0.5);
  text += rate < 100.0 ? fmt::format(", {:.3g} {}/s, ", rate, what) : fmt::format(", {:.0f} {}/s, ", rate, what);
  text += left < 3600 ? fmt::format("{}:{:02} left", left / 60, left % 60)
                      : fmt::format("{}:{:02}:{:02} left", left / 3600, left / 60 % 60, left % 60);
  return text;
}

ProgressBar::ProgressBar(std::string what) : what_(std::move(what)), is_shown_(may_rewrite_lines()) {}

ProgressBar::~ProgressBar() {
  if (is_shown_) std::fputs(k_clear_line, stderr);
}

void ProgressBar::show(std::size_t done, std::size_t of) {
  const Clock::time_point now = Clock::now();
  if (!is_shown_ || now - last_ < k_interval) return;
  last_ = now;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  std::fputs((k_clear_line + progress_text(done, of, seconds, what_)).c_str(), stderr);
}

}  // namespace monograin
