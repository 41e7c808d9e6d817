/// Measures the time that integrators spend on linear algebra.
#pragma once

#include <chrono>

namespace monograin {

/// While a clock exists, the linear solvers of integrators that its thread makes are timed. A thread may have one clock
/// at a time.
class LinearAlgebraClock {
 public:
  LinearAlgebraClock() noexcept { running_ = this; }
  ~LinearAlgebraClock() { running_ = nullptr; }
  LinearAlgebraClock(const LinearAlgebraClock&) = delete;
  LinearAlgebraClock& operator=(const LinearAlgebraClock&) = delete;

  /// The clock of this thread, or nullptr.
  [[nodiscard]] static LinearAlgebraClock* running() noexcept { return running_; }

  template <class Work>
  auto time(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    const auto result = work();
    elapsed_ += std::chrono::steady_clock::now() - start;
    ++count_;
    return result;
  }

  [[nodiscard]] double seconds() const noexcept { return std::chrono::duration<double>(elapsed_).count(); }
  [[nodiscard]] long count() const noexcept { return count_; }

 private:
  static inline thread_local LinearAlgebraClock* running_ = nullptr;

  std::chrono::steady_clock::duration elapsed_{};
  long count_ = 0;
};

}  // namespace monograin
