/// The parts of the module, each in a file of its own.
#pragma once

#include <pybind11/pybind11.h>
#include <unistd.h>

#include "history/table.hpp"
#include "monograin/history.hpp"

namespace monograin::python {

namespace py = pybind11;

/// Lets a thread that wants the interpreter's lock wait for the end of the process if the interpreter shuts down.
/// Python would end the thread by unwinding its stack, which aborts the process at the first C++ frame that may not
/// throw.
inline void stay_if_finalizing() {
#if PY_VERSION_HEX >= 0x030D0000
  while (Py_IsFinalizing()) pause();
#else
  while (_Py_IsFinalizing()) pause();
#endif
}

/// Gives up the interpreter's lock for its lifetime.
class Unlocked {
 public:
  Unlocked() : state_(PyEval_SaveThread()) {}
  ~Unlocked() noexcept(false) {
    stay_if_finalizing();
    PyEval_RestoreThread(state_);
  }
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  PyThreadState* state_;
};

void add_errors(py::module_& module);
void add_history(py::module_& module);
void add_scenario(py::module_& module);
void add_prepared(py::module_& module);
void add_studies(py::module_& module);
void add_models(py::module_& module);
void add_laws(py::module_& module);

/// A table that nobody changes any more, as columns.
[[nodiscard]] inline History history_of(Table table) {
  return History(std::make_shared<const Table>(std::move(table)));
}

}  // namespace monograin::python
