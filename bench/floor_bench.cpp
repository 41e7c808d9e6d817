// Time of whole histories over their floor. The floor is the time of one evaluation of the law for every contact (or
// material point) and row of the history, without anything else.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "compressible/contact_law.hpp"
#include "compressible/material_point_info.hpp"
#include "compressible/yield_surface.hpp"
#include "history/run.hpp"
#include "packing/law.hpp"
#include "plastic/law.hpp"
#include "scene/compressible_law.hpp"
#include "scene/packing_law.hpp"
#include "scene/plastic_law.hpp"
#include "scene/scene.hpp"

namespace monograin {
namespace {

using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Reads a ready scenario with twenty output points per step, as the command `bench` runs it.
CheckedScenario ready_scenario(const std::string& file, std::vector<std::string> overrides = {}) {
  overrides.emplace_back("output.points=20");
  return read_scenario(fs::path(MONOGRAIN_SOURCE_DIR) / "scenarios" / file, overrides);
}

/// Runs a scenario with the integrator that it chooses.
/// @param seconds  gets the time of the run without that of making the scene; may be null
RunRecord history_of(const CheckedScenario& scenario, double* seconds = nullptr) {
  Scene scene = make_scene(scenario);
  const std::string integrator = choose_integrator(scenario.numerics.integrator, *scene.system).used;
  const auto start = Clock::now();
  RunRecord record = record_run(scene, integrator, {scenario.numerics.rtol, scenario.numerics.atol}, scenario.output);
  if (seconds != nullptr) *seconds = seconds_since(start);
  return record;
}

/// Values of a history by row and name of the column.
class Columns {
 public:
  explicit Columns(const Table& history) : history_(history) {}
  [[nodiscard]] std::size_t rows() const { return history_.row_count(); }
  [[nodiscard]] double at(std::size_t row, const std::string& name) const {
    return history_.at(row, *history_.find(name));
  }
  [[nodiscard]] std::string_view word(std::size_t row, const std::string& name) const {
    return history_.word(row, *history_.find(name));
  }

 private:
  const Table& history_;
};

/// Time of one evaluation of the law [s], the least of several batches.
/// @param places  arguments of the law, one for every contact and row of the history
template <class Place, class Law>
double seconds_of_one(const std::vector<Place>& places, Law&& law) {
  constexpr int k_batches = 50;
  constexpr int k_repeats = 20;
  double least = std::numeric_limits<double>::infinity();
  for (int batch = 0; batch < k_batches; ++batch) {
    const auto start = Clock::now();
    for (int repeat = 0; repeat < k_repeats; ++repeat) {
      for (const Place& place : places) benchmark::DoNotOptimize(law(place));
    }
    least = std::min(least, seconds_since(start));
  }
  return least / (k_repeats * static_cast<double>(places.size()));
}

/// Times runs of a scenario, and sets counters for the evaluations of the floor and the ratio of run and floor.
template <class Place, class Law>
void time_history(benchmark::State& state, const CheckedScenario& scenario, const std::vector<Place>& places,
                  Law&& law) {
  double fastest = std::numeric_limits<double>::infinity();
  for (auto _ : state) {
    double seconds = 0.0;
    benchmark::DoNotOptimize(history_of(scenario, &seconds));
    state.SetIterationTime(seconds);
    fastest = std::min(fastest, seconds);
  }
  const auto count = static_cast<double>(places.size());
  const double one = seconds_of_one(places, law);
  state.counters["evaluations"] = count;
  state.counters["one_ns"] = 1e9 * one;
  state.counters["fastest_us"] = 1e6 * fastest;
  state.counters["over_the_floor"] = fastest / (count * one);
}

/// Times the history of plastic contacts on their primary loading branch.
void plastic_history(benchmark::State& state, const std::string& file, const std::vector<std::string>& overrides) {
  using plastic::Regime;
  struct Place {
    Regime regime = Regime::open;
    double x = 0.0;
    bool is_lateral = false;
  };
  const CheckedScenario scenario = ready_scenario(file, overrides);
  const plastic::Law law = plastic_law_of(scenario);
  const auto* semimech = std::get_if<plastic::SemimechLaw>(&law);
  const bool is_die = semimech != nullptr && semimech->configuration == plastic::Configuration::die;
  const plastic::LateralLaw lateral = is_die ? plastic::make_lateral(*semimech) : plastic::LateralLaw{};
  const RunRecord record = history_of(scenario);
  const Columns history(record.history);
  std::vector<Place> places;
  for (const std::string contact : {"axial", "lateral"}) {
    if (!record.history.find(contact + ".regime")) continue;
    for (std::size_t i = 0; i < history.rows(); ++i) {
      const auto regime = static_cast<Regime>(static_cast<int>(history.at(i, contact + ".regime")));
      const double x = history.at(i, "axial.overlap") / scenario.radius;
      if (regime == Regime::open || regime == Regime::undefined || !(x > 0.0)) continue;
      places.push_back({regime, x, contact == "lateral"});
    }
  }
  time_history(state, scenario, places, [&](const Place& place) {
    return place.is_lateral ? plastic::lateral_state_in(*semimech, lateral, place.regime, place.x)
                            : plastic::state_in(law, place.regime, place.x);
  });
}

void compressible_history(benchmark::State& state) {
  using namespace compressible;
  struct Place {
    bool is_unloading = false;
    Part part = Part::linear;
    UnloadingCurve curve;
    double d = 0.0;
  };
  const CheckedScenario scenario = ready_scenario("compressible.toml");
  const CompressibleLaw law = compressible_law_of(scenario);
  const RunRecord record = history_of(scenario);
  const Columns history(record.history);
  std::vector<Place> places;
  double largest = 0.0;
  for (std::size_t i = 0; i < history.rows(); ++i) {
    const std::string_view regime = history.word(i, "axial.regime");
    const double d = history.at(i, "axial.overlap") / scenario.radius;
    largest = std::max(largest, d);
    if (regime == "open" || !(d > 0.0)) continue;
    places.push_back({regime == "unloading", part_at(law.loading, d),
                      unloading_from(law.loading, law.hertz_stiffness, law.unloading, largest), d});
  }
  time_history(state, scenario, places, [&](const Place& place) {
    return place.is_unloading ? unloading_force(place.curve, place.d) : force_in(law.loading, place.part, place.d);
  });
}

/// Times the history of a material point. Elastic rows do not count: stress is linear there and needs no evaluation.
void material_point_history(benchmark::State& state) {
  using namespace compressible;
  struct Place {
    Branch branch;
    double phi = 0.0;
    double p = 0.0;
    double s = 0.0;
  };
  const CheckedScenario scenario =
      ready_scenario("material-point.toml",
                     {"loading.steps=[{strain=-0.25,duration=1},{strain=-0.24,duration=1},{strain=-0.26,duration=1}]"});
  const Parameters parameters =
      parameters_from(scenario.material, std::get<std::string>(scenario.options.at("yield_model")));
  const double unit = scenario.material.at("yield_pressure");
  const RunRecord record = history_of(scenario);
  const Columns history(record.history);
  std::vector<Place> places;
  for (std::size_t i = 0; i < history.rows(); ++i) {
    if (history.word(i, "regime") == "elastic") continue;
    const double phi = history.at(i, "phi");
    const double p = history.at(i, "p") / unit;
    const double s = history.at(i, "s") / unit;
    places.push_back({branch_at(parameters, properties_at(parameters, phi), p, s), phi, p, s});
  }
  time_history(state, scenario, places, [&](const Place& place) {
    return yield_on(parameters, properties_at(parameters, place.phi), place.branch, place.p, place.s);
  });
}

void packing_history(benchmark::State& state) {
  const CheckedScenario scenario = ready_scenario("packing.toml");
  const packing::Law law = packing_law_of(scenario);
  const RunRecord record = history_of(scenario);
  const Columns history(record.history);
  std::vector<double> places;
  for (std::size_t i = 0; i < history.rows(); ++i) {
    if (history.word(i, "regime") != "unjammed") places.push_back(history.at(i, "packing_fraction"));
  }
  time_history(state, scenario, places, [&](double fraction) { return packing::state(law, fraction); });
}

const std::vector<std::string> k_force_of_lead{"loading.steps=[{force=\"2 N\",duration=1}]"};
const std::vector<std::string> k_semimech_force{"loading.steps=[{force=\"20 N\",duration=1}]"};

BENCHMARK_CAPTURE(plastic_history, similarity, "similarity.toml", k_force_of_lead)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(plastic_history, semimech, "semimech.toml", {})->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(plastic_history, semimech_force, "semimech.toml", k_semimech_force)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(plastic_history, hardening, "hardening.toml", {})->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK(compressible_history)->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK(material_point_history)->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK(packing_history)->UseManualTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace monograin
