/// A bar on stderr that shows the progress of long work.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace monograin {

/// A progress bar. Draws nothing if stderr is no terminal, or if NO_COLOR asks for plain output.
class ProgressBar {
 public:
  /// @param what  name of the counted items, such as "runs", or of the work
  explicit ProgressBar(std::string what);
  /// Removes the bar.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Draws the bar. Must not be called by two threads at once.
  void show(std::size_t done, std::size_t of);
  /// Draws the bar of work that counts no items.
  /// @param share  done part of the work, in [0, 1]
  void show(double share);

 private:
  /// Seconds since the start if it is time to draw the bar anew.
  [[nodiscard]] std::optional<double> due();

  using Clock = std::chrono::steady_clock;

  std::string what_;
  bool is_shown_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

/// Text of a bar: `[#####     ]  50%  searching, 0:05 left`.
/// @param seconds  since the start
[[nodiscard]] std::string progress_text(double share, double seconds, const std::string& what);

}  // namespace monograin
