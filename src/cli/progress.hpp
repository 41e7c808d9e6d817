/// A bar on stderr that shows the progress of long work.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace monograin {

/// A progress bar. Draws nothing if stderr is no terminal, or if NO_COLOR asks for plain output.
class ProgressBar {
 public:
  /// @param what  name of the counted items: "runs"
  explicit ProgressBar(std::string what);
  /// Removes the bar.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Draws the bar. Must not be called by two threads at once.
  void show(std::size_t done, std::size_t of);

 private:
  using Clock = std::chrono::steady_clock;

  std::string what_;
  bool is_shown_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

/// The bar's text: `[#####     ]  50%  500/1000 runs, 100 runs/s, 0:05 left`.
/// @param seconds  since the start
[[nodiscard]] std::string progress_text(std::size_t done, std::size_t of, double seconds, const std::string& what);

}  // namespace monograin
