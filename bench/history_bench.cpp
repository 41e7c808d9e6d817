// History of the default scene by every integrator: time of a run, and error of its forces against `direct`.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "history/run.hpp"
#include "scenario/scenario.hpp"
#include "scene/scene.hpp"

namespace monograin {
namespace {

RunRecord history(const CheckedScenario& scenario, const std::string& integrator, double rtol) {
  Scene scene = make_scene(scenario);
  return record_run(scene, integrator, {rtol, 1e-4 * rtol}, scenario.output);
}

/// Largest difference of a force over its largest magnitude, among all contacts. Both tables have the same instants.
double force_error(const Table& reference, const Table& other) {
  double worst = 0.0;
  for (const Column& column : reference.columns()) {
    if (!column.name.ends_with(".force")) continue;
    const std::vector<double> a = reference.column(column.name);
    const std::vector<double> b = other.column(column.name);
    double peak = 0.0;
    double difference = 0.0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
      peak = std::max(peak, std::abs(a[i]));
      difference = std::max(difference, std::abs(a[i] - b[i]));
    }
    worst = std::max(worst, difference / peak);
  }
  return worst;
}

void default_scene(benchmark::State& state, const std::string& integrator) {
  const CheckedScenario scenario = parse_scenario(default_scenario_text(), "die.toml");
  const double rtol = std::pow(10.0, -static_cast<double>(state.range(0)));
  RunRecord record;
  for (auto _ : state) {
    record = history(scenario, integrator, rtol);
    benchmark::DoNotOptimize(record.history.row_count());
  }
  state.counters["force_error"] = force_error(history(scenario, "direct", 1e-8).history, record.history);
  state.counters["steps"] = static_cast<double>(record.statistics.steps);
  state.counters["rhs"] = static_cast<double>(record.statistics.rhs_evaluations);
}

BENCHMARK_CAPTURE(default_scene, direct, "direct")->Arg(8)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(default_scene, cvode_adams, "cvode-adams")->DenseRange(4, 12, 2)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(default_scene, cvode_bdf, "cvode-bdf")->DenseRange(4, 12, 2)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(default_scene, ida, "ida")->DenseRange(4, 12, 2)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace monograin
