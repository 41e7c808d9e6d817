#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "interruptible.hpp"
#include "prepared.hpp"
#include "run.hpp"

namespace monograin::python {
namespace {

template <class Value>
using Array = py::array_t<Value, py::array::c_style>;

template <class Value>
std::span<Value> span_of(Array<Value>& array) {
  return {array.mutable_data(), static_cast<std::size_t>(array.size())};
}

/// Fills `results` and `statuses` in place, so that an interrupt leaves what is there already.
void map(const Prepared& prepared, const Array<double>& samples, const std::vector<std::string>& formulas, int threads,
         Array<double>& results, Array<signed char>& statuses) {
  const auto rows = static_cast<std::size_t>(statuses.size());
  if (static_cast<std::size_t>(samples.size()) != rows * prepared.keys().size() ||
      static_cast<std::size_t>(results.size()) != rows * formulas.size()) {
    throw std::invalid_argument("the arrays do not have the same number of rows");
  }
  const auto states = span_of(statuses);
  Prepared::Batch batch{
      .samples = {samples.data(), static_cast<std::size_t>(samples.size())},
      .results = span_of(results),
      // An enumerator of that type is stored in each of its values.
      .statuses = {reinterpret_cast<RowStatus*>(states.data()), states.size()},  // NOLINT(*-reinterpret-cast)
      .formulas = {},
      .threads = threads};
  for (const std::string& formula : formulas) batch.formulas.emplace_back(formula);
  run_interruptibly([&](const std::atomic<bool>& stop) { prepared.map(batch, stop); });
}

}  // namespace

void add_prepared(py::module_& module) {
  py::class_<Prepared, std::shared_ptr<Prepared>>(module, "Prepared")
      .def_property_readonly("keys", &Prepared::keys)
      .def("run",
           [](const Prepared& prepared, const Array<double>& values) {
             const std::span<const double> numbers(values.data(), static_cast<std::size_t>(values.size()));
             const py::gil_scoped_release released;
             return SharedRun(run_scenario(prepared.with(numbers)));
           })
      .def("map", &map, py::arg("samples"), py::arg("formulas"), py::arg("threads"), py::arg("results").noconvert(),
           py::arg("statuses").noconvert());
}

}  // namespace monograin::python
