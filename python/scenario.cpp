// Scenarios and their runs.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <chrono>

#include "bindings.hpp"
#include "figure/figure.hpp"
#include "history/run_files.hpp"
#include "prepared.hpp"
#include "run.hpp"
#include "scenario/words.hpp"
#include "scene/scene.hpp"
#include "study/atlas/profile.hpp"

namespace monograin::python {
namespace {

template <class Read>
NamedScenario timed(Read&& read, std::string origin) {
  const auto start = std::chrono::steady_clock::now();
  NamedScenario named{.scenario = read(), .origin = std::move(origin)};
  named.parse_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return named;
}

SharedRun run(const NamedScenario& named) {
  const py::gil_scoped_release released;
  Run result = run_scenario(named.scenario);
  result.timings.parse = named.parse_time;
  return SharedRun(std::move(result));
}

/// Writes the files of a run. @return why there is no figure, though one was asked for; empty: there is no such reason
std::string save(const SharedRun& shared, const std::string& folder, bool draws_figure) {
  const py::gil_scoped_release released;
  std::string no_figure;
  const auto draw = [&](const std::filesystem::path& staged) {
    try {
      draw_runs({staged}, staged / "figure.svg");
    } catch (const std::exception& error) {
      no_figure = in_own_words(error);
    }
  };
  StagedFolder staged{std::filesystem::path(folder)};
  write_run(*shared.run, staged, draws_figure ? draw : std::function<void(const std::filesystem::path&)>());
  return no_figure;
}

py::list parameters(const NamedScenario& named) {
  py::list list;
  for (const auto& [name, value, unit, symbol] : derived_parameters(named.scenario)) {
    list.append(py::make_tuple(name, value, unit, symbol));
  }
  return list;
}

py::object limit_of(const SharedRun& shared) {
  const auto& limit = shared.run->record.limit;
  return limit ? py::object(py::str(std::string(code(*limit)))) : py::none();
}

}  // namespace

NamedScenario NamedScenario::parse(const std::string& text, const std::string& origin,
                                   const std::vector<std::string>& overrides) {
  return timed([&] { return parse_scenario(text, origin, overrides); }, origin);
}

NamedScenario NamedScenario::read(const std::string& file, const std::vector<std::string>& overrides) {
  return timed([&] { return read_scenario(file, overrides); }, file);
}

SharedRun::SharedRun(Run result) : run(std::make_shared<Run>(std::move(result))) {
  history = std::make_shared<TableView>(std::shared_ptr<const Table>(run, &run->record.history));
  events = std::make_shared<TableView>(std::shared_ptr<const Table>(run, &run->record.events));
}

void add_scenario(py::module_& module) {
  py::class_<NamedScenario>(module, "Scenario")
      .def_static("parse", &NamedScenario::parse)
      .def_static("read", &NamedScenario::read)
      .def_property_readonly("text", [](const NamedScenario& named) { return named.scenario.text; })
      .def_readonly("origin", &NamedScenario::origin)
      .def_property_readonly("overrides", [](const NamedScenario& named) { return named.scenario.overrides; })
      .def_property_readonly("name", [](const NamedScenario& named) { return named.scenario.name; })
      .def_property_readonly("title", [](const NamedScenario& named) { return named.scenario.title; })
      .def_property_readonly("model", [](const NamedScenario& named) { return named.scenario.model; })
      .def("run", &run)
      .def("prepare",
           [](const NamedScenario& named, std::vector<std::string> keys) {
             return std::make_shared<Prepared>(named.scenario, named.origin, std::move(keys));
           })
      .def("parameters", &parameters);
  py::class_<SharedRun>(module, "Run")
      .def_property_readonly("status",
                             [](const SharedRun& shared) { return std::string(to_string(shared.run->record.status)); })
      .def_property_readonly("message", [](const SharedRun& shared) { return shared.run->record.message; })
      .def_property_readonly("limit", &limit_of)
      .def_property_readonly("warnings", [](const SharedRun& shared) { return shared.run->record.warnings; })
      .def_readonly("history", &SharedRun::history)
      .def_readonly("events", &SharedRun::events)
      .def("json", [](const SharedRun& shared) { return run_json(*shared.run); })
      .def("profile",
           [](const SharedRun& shared, double time) {
             const py::gil_scoped_release released;
             return view_of(contact_profiles(shared.run->scenario, time));
           })
      .def("save", &save);
}

}  // namespace monograin::python
