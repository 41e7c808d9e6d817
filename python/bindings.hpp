/// The parts of the module, each in a file of its own.
#pragma once

#include <pybind11/pybind11.h>

namespace monograin::python {

namespace py = pybind11;

void add_errors(py::module_& module);
void add_table(py::module_& module);
void add_prepared(py::module_& module);
void add_scenario(py::module_& module);
void add_studies(py::module_& module);
void add_catalogue(py::module_& module);
void add_laws(py::module_& module);

}  // namespace monograin::python
