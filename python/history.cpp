// Histories and other tables; numpy arrays share the values of their columns without a copy.

#include "monograin/history.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "history/table_file.hpp"

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

/// Names of the columns; the heading, with the unit, of columns that share their name.
std::vector<std::string> names_of(const History& history) {
  const std::vector<Column>& columns = history.table().columns();
  std::unordered_map<std::string_view, int> count;
  for (const Column& column : columns) ++count[column.name];
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(count[column.name] > 1 ? column.heading() : column.name);
  return names;
}

py::dict units_of(const History& history) {
  py::dict units;
  const std::vector<std::string> names = names_of(history);
  for (std::size_t k = 0; k < names.size(); ++k) units[py::str(names[k])] = history.table().columns()[k].unit;
  return units;
}

using Values = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Name, unit, labels and values of every column.
py::list parts_of(const py::object& self) {
  py::list parts;
  const Table& table = self.cast<const History&>().table();
  for (std::size_t k = 0; k < table.columns().size(); ++k) {
    Values values(static_cast<py::ssize_t>(table.row_count()));
    for (std::size_t row = 0; row < table.row_count(); ++row) {
      values.mutable_at(static_cast<py::ssize_t>(row)) = table.at(row, k);
    }
    const Column& column = table.columns()[k];
    parts.append(py::make_tuple(column.name, column.unit, column.labels, values));
  }
  return parts;
}

/// The table of such parts.
History table_of(std::vector<std::pair<std::string, std::string>> header,
                 const std::vector<std::tuple<std::string, std::string, std::vector<std::string>, Values>>& parts) {
  std::vector<Column> columns;
  for (const auto& [name, unit, labels, values] : parts) columns.push_back({name, unit, labels});
  Table table(std::move(columns));
  table.header = std::move(header);
  std::vector<double> row(parts.size());
  const py::ssize_t count = parts.empty() ? 0 : std::get<Values>(parts.front()).size();
  for (py::ssize_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = std::get<Values>(parts[k]).at(i);
    table.append(row);
  }
  return history_of(std::move(table));
}

}  // namespace

void add_history(py::module_& module) {
  py::class_<History>(module, "Table")
      .def_property_readonly("row_count", &History::row_count)
      .def_property_readonly("columns", &names_of)
      .def_property_readonly("units", &units_of)
      .def_property_readonly("header", [](const History& history) { return history.table().header; })
      .def("contains", [](const History& history, const std::string& name) { return history.contains(name); })
      .def("parts", &parts_of)
      .def("csv", [](const History& history) { return csv_text(history.table()); })
      .def("values", &values_of)
      .def("labels", [](const History& history, const std::string& name) { return column_of(history, name).labels; });
  module.def("table_of", &table_of);
  module.def("read_csv", [](const std::string& file) {
    Table table = [&] {
      const Unlocked unlocked;
      return read_csv(file);
    }();
    return history_of(std::move(table));
  });
  // The interpreter's lock stays: h5py may use the same HDF5, which is not for several threads.
  module.def("read_hdf5", [](const std::string& file) { return history_of(read_hdf5(file)); });
}

}  // namespace monograin::python
