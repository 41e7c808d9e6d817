// Translation of C++ exceptions into exceptions of the Python package.

#include "bindings.hpp"
#include "monograin/faults.hpp"

namespace monograin::python {
namespace {

void raise_faults(const ScenarioError& error) {
  const py::module_ errors = py::module_::import("monograin.errors");
  py::list faults;
  for (const Fault& fault : error.faults()) {
    faults.append(errors.attr("Fault")(fault.where.file, fault.where.line, fault.where.column, fault.message));
  }
  const py::object type = errors.attr("ScenarioError");
  PyErr_SetObject(type.ptr(), type(faults).ptr());
}

}  // namespace

void add_errors(py::module_& /*module*/) {
  py::register_exception_translator([](std::exception_ptr pending) {
    try {
      if (pending) std::rethrow_exception(pending);
    } catch (const ScenarioError& error) {
      raise_faults(error);
    }
  });
}

}  // namespace monograin::python
