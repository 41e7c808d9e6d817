// Sweeps, calibrations, plans of experiments and comparisons.

#include <pybind11/stl.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "bindings.hpp"
#include "history/compare.hpp"
#include "interruptible.hpp"
#include "monograin/study.hpp"

namespace monograin::python {
namespace {

/// @return the results, None if runs of other shards are missing; the number of points that constraints exclude;
///         warnings, and why there is no figure
std::tuple<std::optional<History>, std::size_t, std::vector<std::string>, std::string> sweep(
    const std::string& file, const std::optional<std::string>& text, const std::string& folder, int threads, int shard,
    int shard_count, const std::string& format) {
  study::SweepResult found = run_interruptibly([&](const auto& stop) {
    return study::sweep({file, text, {}}, {.folder = folder,
                                           .threads = threads,
                                           .shard = shard,
                                           .shard_count = shard_count,
                                           .format = format,
                                           .stop = stop});
  });
  return {found.missing > 0 ? std::nullopt : std::optional(std::move(found.results)), found.left_out,
          std::move(found.warnings), std::move(found.no_figure)};
}

/// @return the table, warnings, and why there is no figure
std::tuple<History, std::vector<std::string>, std::string> sensitivity(const std::string& file,
                                                                       const std::optional<std::string>& text,
                                                                       const std::string& folder, int threads,
                                                                       double confidence) {
  study::SensitivityResult found = run_interruptibly([&](const auto& stop) {
    return study::sensitivity({file, text, {}}, {.folder = folder, .threads = threads, .stop = stop}, confidence);
  });
  return {std::move(found.table), std::move(found.warnings), std::move(found.no_figure)};
}

study::CalibrationResult calibrate(const std::string& file, const std::optional<std::string>& text,
                                   const std::map<std::string, std::string>& data, const std::string& folder,
                                   std::optional<double> confidence) {
  return run_interruptibly([&](const auto& stop) {
    return study::calibrate({file, text, data}, {.folder = folder, .stop = stop}, confidence);
  });
}

/// @return the table, lines of its rows, why a calibration would refuse the file, and the report
py::tuple read_data(const std::string& file, const std::string& x, const std::string& y) {
  const study::DataResult found = [&] {
    const Unlocked unlocked;
    return study::read_data(file, x, y);
  }();
  return py::make_tuple(found.table, found.lines, found.remarks, found.text);
}

study::DesignResult design(const std::string& file, const std::optional<std::string>& text, const std::string& folder) {
  return run_interruptibly([&](const auto& stop) {
    return study::design({file, text, {}}, {.folder = folder, .stop = stop});
  });
}

py::tuple as_python(const Comparison& comparison) {
  py::list curves;
  for (const CurveDifference& d : comparison.curves) {
    curves.append(py::make_tuple(d.y, d.linf, d.linf_at, d.l2, d.area_error, d.peak_error, d.coverage));
  }
  py::list gaps;
  for (const Gap& gap : comparison.gaps) gaps.append(py::make_tuple(gap.column, gap.problem));
  return py::make_tuple(curves, gaps);
}

}  // namespace

void add_studies(py::module_& module) {
  module.def("sweep", &sweep);
  module.def("sensitivity", &sensitivity);
  using Fitted = study::CalibrationResult;
  py::class_<Fitted>(module, "Fitted")
      .def_readonly("name", &Fitted::name)
      .def_readonly("json", &Fitted::json)
      .def_readonly("text", &Fitted::text)
      .def_property_readonly("scenario_text", [](const Fitted& fitted) { return fitted.scenario.text(); })
      .def_property_readonly("scenario_files", [](const Fitted& fitted) { return fitted.scenario.files(); })
      .def_readonly("notes", &Fitted::notes)
      .def_readonly("warnings", &Fitted::warnings)
      .def_readonly("no_figure", &Fitted::no_figure)
      .def_readonly("fit", &Fitted::fit);
  module.def("calibrate", &calibrate);
  module.def("read_data", &read_data);
  using Designed = study::DesignResult;
  py::class_<Designed>(module, "Designed")
      .def_readonly("name", &Designed::name)
      .def_readonly("programs", &Designed::programs)
      .def_readonly("candidates", &Designed::candidates)
      .def_readonly("has_planned", &Designed::has_planned)
      .def_readonly("best_by_volume", &Designed::best_by_volume)
      .def_readonly("best_by_variances", &Designed::best_by_variances)
      .def_readonly("notes", &Designed::notes)
      .def_readonly("text", &Designed::text)
      .def_readonly("no_figure", &Designed::no_figure)
      .def_readonly("table", &Designed::table);
  module.def("design", &design);
  module.def("compare_tables", [](const History& a, const History& b, const std::string& x, const std::string& y) {
    return as_python(compare(a, b, x, y));
  });
  module.def("compare_events",
             [](const History& a, const History& b) { return as_python(compare_events(a.table(), b.table())); });
}

}  // namespace monograin::python
