// Histories and other tables; numpy arrays share the values of their columns without a copy.

#include "monograin/history.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bindings.hpp"

namespace monograin::python {
namespace {

/// Column of that name. @throws py::key_error for an unknown name; the message suggests the nearest column
const History::Column& column_of(const History& history, const std::string& name) {
  try {
    return history.column(name);
  } catch (const std::out_of_range& error) {
    throw py::key_error(error.what());
  }
}

/// A read-only array over the values of a column. The array keeps the history alive, which owns the values.
py::array values_of(const py::object& self, const std::string& name) {
  const std::vector<double>& values = column_of(self.cast<const History&>(), name).values;
  py::array_t<double> array({values.size()}, {sizeof(double)}, values.data(), self);
  array.attr("flags").attr("writeable") = false;
  return array;
}

py::dict units_of(const History& history) {
  py::dict units;
  for (const auto& column : history.table().columns()) units[py::str(column.name)] = column.unit;
  return units;
}

}  // namespace

void add_history(py::module_& module) {
  py::class_<History>(module, "Table")
      .def_property_readonly("row_count", &History::row_count)
      .def_property_readonly("columns", &History::names)
      .def_property_readonly("units", &units_of)
      .def_property_readonly("header", [](const History& history) { return history.table().header; })
      .def("contains", [](const History& history, const std::string& name) { return history.contains(name); })
      .def("csv", [](const History& history) { return csv_text(history.table()); })
      .def("values", &values_of)
      .def("labels", [](const History& history, const std::string& name) { return column_of(history, name).labels; });
  module.def("read_csv", [](const std::string& file) { return history_of(read_csv(file)); });
}

}  // namespace monograin::python
