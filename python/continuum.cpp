// Runs of finite elements, and files of runs for other programs.

#include "monograin/continuum.hpp"

#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <vector>

#include "api/checked.hpp"
#include "bindings.hpp"
#include "exchange/force_table.hpp"
#include "exchange/lammps.hpp"
#include "exchange/vtk.hpp"
#include "interruptible.hpp"
#include "scenario.hpp"

namespace monograin::python {
namespace {

/// A row for each quantity.
History table_of(const std::vector<ContinuumDifference>& differences) {
  History::Column column{.name = "column", .unit = "", .labels = {}, .values = {}};
  History::Column loading{.name = "loading", .unit = "-", .labels = {}, .values = {}};
  History::Column unloading{.name = "unloading", .unit = "-", .labels = {}, .values = {}};
  History::Column mesh_error{.name = "mesh_error", .unit = "-", .labels = {}, .values = {}};
  for (const ContinuumDifference& difference : differences) {
    column.values.push_back(static_cast<double>(column.labels.size()));
    column.labels.push_back(difference.column);
    loading.values.push_back(difference.loading);
    unloading.values.push_back(difference.unloading);
    mesh_error.values.push_back(difference.mesh_error);
  }
  return History({column, loading, unloading, mesh_error});
}

/// @return run of the finite elements, and the law's differences from it
py::tuple compute(const RunResult& law, const std::string& mesh, bool estimates_error, bool keeps_files,
                  const std::string& folder) {
  const ContinuumResult found = run_watched([&](const RunOptions& options) {
    return continuum(law, {.mesh = mesh,
                           .estimates_error = estimates_error,
                           .folder = folder,
                           .keeps_files = keeps_files,
                           .stop = options.stop});
  });
  return py::make_tuple(found.run, table_of(found.differences));
}

void write_particle(const SoundScenario& scenario, const History& history, const std::string& folder) {
  const Unlocked unlocked;
  save_vtk(scenario.checked, history.table(), folder);
}

std::string lammps_of(const SoundScenario& scenario, const History& history) {
  const LammpsLaw law = lammps_law_of(scenario.checked);
  return lammps_input(scenario.checked, motion_of(scenario.checked, history.table()), law);
}

History forces_of(const SoundScenario& scenario, const History& history,
                  const std::optional<std::string>& contact_class) {
  return history_of(force_table(motion_of(scenario.checked, history.table()), contact_class));
}

}  // namespace

void add_continuum(py::module_& module) {
  module.def("continuum", &compute);
  module.def("write_vtk", &write_particle);
  module.def("lammps_input", &lammps_of);
  module.def("force_table", &forces_of);
}

}  // namespace monograin::python
