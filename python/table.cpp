#include "table.hpp"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "bindings.hpp"
#include "scenario/words.hpp"

namespace monograin::python {
namespace {

/// @throws py::key_error naming the columns that are nearest
std::size_t index_of(const Table& table, const std::string& name) {
  if (const auto found = table.find(name)) return *found;
  std::vector<std::string_view> names;
  for (const Column& column : table.columns()) names.emplace_back(column.name);
  const std::string hint = did_you_mean(name, names);
  throw py::key_error(fmt::format("there is no column '{}'{}", shown(name),
                                  hint.empty() ? fmt::format("; there are {}", listed(names)) : hint));
}

/// A read-only array over a column of numbers; it keeps the table alive.
py::array column_values(const py::object& self, const std::string& name) {
  auto& view = self.cast<TableView&>();
  const std::span<const double> values = view.column(index_of(view.table(), name));
  py::array_t<double> array({values.size()}, {sizeof(double)}, values.data(), self);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// The words of a column that holds some; none otherwise.
std::vector<std::string> column_labels(const TableView& view, const std::string& name) {
  return view.table().columns()[index_of(view.table(), name)].labels;
}

}  // namespace

std::span<const double> TableView::column(std::size_t index) {
  const std::size_t rows = table_->row_count();
  std::call_once(is_transposed_, [&] {
    const std::size_t columns = table_->columns().size();
    values_.resize(rows * columns);
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t k = 0; k < columns; ++k) values_[k * rows + row] = table_->at(row, k);
    }
  });
  return std::span<const double>(values_).subspan(index * rows, rows);
}

std::shared_ptr<TableView> view_of(Table table) {
  return std::make_shared<TableView>(std::make_shared<const Table>(std::move(table)));
}

void add_table(py::module_& module) {
  py::class_<TableView, std::shared_ptr<TableView>>(module, "Table")
      .def_property_readonly("row_count", [](const TableView& view) { return view.table().row_count(); })
      .def_property_readonly("columns",
                             [](const TableView& view) {
                               std::vector<std::string> names;
                               for (const Column& column : view.table().columns()) names.push_back(column.name);
                               return names;
                             })
      .def_property_readonly("units",
                             [](const TableView& view) {
                               py::dict units;
                               for (const Column& column : view.table().columns()) {
                                 units[py::str(column.name)] = column.unit;
                               }
                               return units;
                             })
      .def_property_readonly("header", [](const TableView& view) { return view.table().header; })
      .def("values", &column_values)
      .def("labels", &column_labels);
  module.def("read_csv", [](const std::string& file) { return view_of(read_csv(file)); });
}

}  // namespace monograin::python
