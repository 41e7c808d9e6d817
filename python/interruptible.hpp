/// Long work that Ctrl-C ends.
#pragma once

#include <atomic>
#include <chrono>
#include <future>
#include <optional>

#include "bindings.hpp"
#include "monograin/run.hpp"

namespace monograin::python {

/// Identifier of the interpreter's main thread; noted when the module is made.
inline unsigned long& main_thread() {
  static unsigned long identifier = 0;
  return identifier;
}

/// Looks for signals on behalf of work without the interpreter's lock. Python handles them in its main thread, and only
/// when asked; in other threads there is nothing to look for.
class SignalWatch {
 public:
  /// True once a signal's handler has raised. Asks twenty times a second at most; call it from the thread that Python
  /// has called, without the lock.
  [[nodiscard]] bool has_raised() {
    const auto now = std::chrono::steady_clock::now();
    if (is_main_thread_ && !raised_ && now >= next_) {
      next_ = now + k_between_looks;
      guard_.wait_if_finalizing();
      const py::gil_scoped_acquire acquired;
      if (PyErr_CheckSignals() != 0) raised_.emplace();
    }
    return raised_.has_value();
  }

  /// The exception that the handler has raised; None: it has not. Needs the lock.
  [[nodiscard]] py::object raised() const { return raised_ ? py::object(raised_->value()) : py::none(); }

  /// Raises it, if there is one. Needs the lock.
  void rethrow() const {
    if (raised_) throw py::error_already_set(*raised_);
  }

  static constexpr std::chrono::milliseconds k_between_looks{50};

 private:
  LockGuard guard_;
  bool is_main_thread_ = PyThread_get_thread_ident() == main_thread();
  std::optional<py::error_already_set> raised_;
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now() + k_between_looks;
};

/// Runs a scenario in this thread, without the interpreter's lock, and ends the run where a signal's handler raises.
/// @param make  function of RunOptions that runs the scenario
/// @return what `make` returns
/// @throws py::error_already_set with what the handler has raised
template <class Make>
auto run_watched(Make&& make) {
  SignalWatch watch;
  // Taking the lock back may end the thread, which must not find the result half handed over.
  std::optional<decltype(make(RunOptions{}))> result;
  try {
    const Unlocked unlocked;
    result.emplace(make(RunOptions{.stop = [&watch] { return watch.has_raised(); }}));
  } catch (const RunInterrupted&) {
    watch.rethrow();
    throw;  // nothing else interrupts a run
  }
  return *std::move(result);
}

/// Runs work in a thread of its own, without the interpreter's lock, and hands on what it returns or throws.
/// @param work  (const std::function<bool()>& stop) -> result. It asks `stop` between its pieces, and ends by an
///              exception once that is true: a signal's handler has raised.
/// @throws py::error_already_set with what the handler has raised, once the work has ended
template <class Work>
auto run_interruptibly(Work&& work) {
  std::atomic<bool> stop{false};
  SignalWatch watch;
  auto result = std::async(std::launch::async, [&] { return work([&stop] { return stop.load(); }); });
  {
    const Unlocked unlocked;
    while (!stop && result.wait_for(SignalWatch::k_between_looks) != std::future_status::ready) {
      stop = watch.has_raised();
    }
    result.wait();
  }
  watch.rethrow();
  return result.get();
}

}  // namespace monograin::python
