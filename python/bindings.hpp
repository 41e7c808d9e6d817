/// The parts of the module, each in a file of its own.
#pragma once

#include <pybind11/pybind11.h>
#include <unistd.h>

#include "api/checked.hpp"

namespace monograin::python {

namespace py = pybind11;

/// True while the interpreter shuts down.
inline bool is_finalizing() {
#if PY_VERSION_HEX >= 0x030D0000
  return Py_IsFinalizing() != 0;
#else
  return _Py_IsFinalizing() != 0;
#endif
}

/// Keeps a thread that Python has called from taking the interpreter's lock once the interpreter shuts down: Python
/// would unwind the thread's stack, which aborts the process. The thread sleeps until the process ends. The thread that
/// shuts the interpreter down may take the lock.
class LockGuard {
 public:
  void wait_if_finalizing() const {
    while (!shuts_down_ && is_finalizing()) pause();
  }

 private:
  bool shuts_down_ = is_finalizing();  ///< this thread has the lock now
};

/// Gives up the interpreter's lock for its lifetime.
class Unlocked {
 public:
  Unlocked() : state_(PyEval_SaveThread()) {}
  ~Unlocked() noexcept(false) {
    guard_.wait_if_finalizing();
    PyEval_RestoreThread(state_);
  }
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  LockGuard guard_;
  PyThreadState* state_;
};

void add_errors(py::module_& module);
void add_history(py::module_& module);
void add_scenario(py::module_& module);
void add_continuum(py::module_& module);
void add_prepared(py::module_& module);
void add_studies(py::module_& module);
void add_models(py::module_& module);
void add_laws(py::module_& module);

}  // namespace monograin::python
