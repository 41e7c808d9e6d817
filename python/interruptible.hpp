/// Long work that Ctrl-C ends.
#pragma once

#include <atomic>
#include <chrono>
#include <future>

#include "bindings.hpp"

namespace monograin::python {

/// Thrown by work that was asked to stop; nobody sees it but run_interruptibly().
struct Stopped {};

/// Runs work without the interpreter's lock and hands on what it returns or throws.
///
/// Python sees signals in its main thread only, and only when asked: so the work has a thread of its own, and this one
/// asks, twenty times a second. A signal whose handler raises sets `stop`; work looks at it between its pieces and
/// throws Stopped, or comes to its end.
/// @param work  (const std::atomic<bool>& stop) -> result
/// @throws py::error_already_set with what the handler has raised, once the work has ended
template <class Work>
auto run_interruptibly(Work&& work) {
  constexpr std::chrono::milliseconds k_between_looks{50};
  std::atomic<bool> stop{false};
  auto result = std::async(std::launch::async, [&] { return work(static_cast<const std::atomic<bool>&>(stop)); });
  const auto is_done_soon = [&] {
    const py::gil_scoped_release released;
    return result.wait_for(k_between_looks) == std::future_status::ready;
  };
  while (!is_done_soon()) {
    if (PyErr_CheckSignals() == 0) continue;
    py::error_already_set raised;
    stop = true;
    {
      const py::gil_scoped_release released;
      result.wait();
    }
    throw raised;
  }
  return result.get();
}

}  // namespace monograin::python
