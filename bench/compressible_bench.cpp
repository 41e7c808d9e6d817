// Cost of one evaluation of the contact law of a compressible particle. The label of each benchmark is its cost floor:
// the time of a prototype with precomputed material constants on one core (g++ -O3, best of several runs).
#include <benchmark/benchmark.h>

#include <array>

#include "compressible/law.hpp"
#include "law_timing.hpp"

namespace monograin::compressible {
namespace {

/// Contact laws of the source's base case.
struct Granule {
  LoadingLaw law = make_loading_law(3.9, 0.1, 3.0);
  double hertz = hertz_stiffness(100.0, 0.3);
  UnloadingCurve curve = unloading_from(law, hertz, UnloadingRule(), 0.4);
};

/// Times force and slope on the loading branch.
void loading(benchmark::State& state, const char* floor) {
  const Granule granule;
  time_law(state, floor, granule.law.transition, k_largest_displacement, [&](double d) {
    return std::array{force_in(granule.law, Part::exponential, d), slope_in(granule.law, Part::exponential, d)};
  });
}

/// Times force and slope on the unloading branch.
void unloading(benchmark::State& state, const char* floor) {
  const Granule granule;
  time_law(state, floor, granule.curve.separation(), granule.curve.largest, [&](double d) {
    return std::array{unloading_force(granule.curve, d), unloading_slope(granule.curve, d)};
  });
}

void loading_under_force(benchmark::State& state, const char* floor) {
  const Granule granule;
  time_law(state, floor, loading_force(granule.law, granule.law.transition),
           loading_force(granule.law, k_largest_displacement),
           [&](double force) { return displacement_under(granule.law, force); });
}

void unloading_under_force(benchmark::State& state, const char* floor) {
  const Granule granule;
  time_law(state, floor, 0.0, granule.curve.force,
           [&](double force) { return unloading_displacement(granule.curve, force); });
}

void turning_back(benchmark::State& state, const char* floor) {
  const Granule granule;
  const UnloadingRule rule;
  time_law(state, floor, granule.law.transition, k_largest_displacement,
           [&](double largest) { return unloading_from(granule.law, granule.hertz, rule, largest); });
}

BENCHMARK_CAPTURE(loading, exponential, "floor 5 ns");
BENCHMARK_CAPTURE(unloading, hertz, "floor 12 ns");
BENCHMARK_CAPTURE(loading_under_force, exponential, "floor 4 ns");
BENCHMARK_CAPTURE(unloading_under_force, hertz, "floor 11 ns");
BENCHMARK_CAPTURE(turning_back, hertz, "floor 9 ns");

}  // namespace
}  // namespace monograin::compressible
