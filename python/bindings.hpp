/// The parts of the module, each in a file of its own.
#pragma once

#include <pybind11/pybind11.h>

#include "history/table.hpp"
#include "monograin/history.hpp"

namespace monograin::python {

namespace py = pybind11;

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
