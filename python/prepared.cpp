// Many runs of one scenario with different values of some keys.

#include "monograin/prepared.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "interruptible.hpp"
#include "scenario.hpp"

namespace monograin::python {
namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::span<const double> span_of(const Numbers& numbers) {
  return {numbers.data(), static_cast<std::size_t>(numbers.size())};
}

RunResult run_prepared(const PreparedScenario& prepared, const Numbers& values) {
  const std::span<const double> numbers = span_of(values);
  return run_watched([&](const RunOptions& options) { return prepared.run(numbers, options); });
}

/// Runs the samples without the interpreter's lock.
/// @return values row by row, the status of every sample, and the exception that a signal handler raised, or None
py::tuple map_prepared(const PreparedScenario& prepared, const Numbers& samples,
                       const std::vector<std::string>& formulas, int threads) {
  const std::span<const double> numbers = span_of(samples);
  SignalWatch watch;
  const MapResult result = [&] {
    const Unlocked unlocked;
    return prepared.map(numbers, formulas, {.threads = threads, .stop = [&watch] { return watch.has_raised(); }});
  }();
  return py::make_tuple(Numbers(static_cast<py::ssize_t>(result.values.size()), result.values.data()), result.status,
                        watch.raised());
}

}  // namespace

void add_prepared(py::module_& module) {
  py::class_<PreparedScenario>(module, "Prepared")
      .def(py::init([](const SoundScenario& scenario, std::vector<std::string> keys) {
        return PreparedScenario(scenario.source, std::move(keys));
      }))
      .def_property_readonly("keys", &PreparedScenario::keys)
      .def("run", &run_prepared)
      .def("map", &map_prepared);
}

}  // namespace monograin::python
