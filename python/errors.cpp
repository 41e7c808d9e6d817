// Translation of C++ exceptions into exceptions of the Python package.

#include "bindings.hpp"
#include "monograin/faults.hpp"

namespace monograin::python {
namespace {

constexpr std::string_view k_override = "--set '";

/// Name of the text with the fault. An override, which the program calls `--set`, comes from `replace` in Python.
std::string file_of(const SourceLocation& where) {
  if (!where.file.starts_with(k_override)) return where.file;
  return "replace '" + where.file.substr(k_override.size());
}

void raise_faults(const ScenarioError& error) {
  const py::module_ errors = py::module_::import("monograin.errors");
  py::list faults;
  for (const Fault& fault : error.faults()) {
    faults.append(errors.attr("Fault")(file_of(fault.where), fault.where.line, fault.where.column, fault.message));
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
