// Cost of one evaluation of the packing law. The label of each benchmark is its cost floor: the time of a prototype
// with precomputed constants of the packing on one core (g++ -O3, best of several runs).
#include <benchmark/benchmark.h>

#include "law_timing.hpp"
#include "packing/law.hpp"

namespace monograin::packing {
namespace {

Law plastic_packing() { return make_law({.plasticity = Plasticity{.yield_stress = 0.4e6, .hardening_modulus = 1e6}}); }

void packing_state(benchmark::State& state, const char* floor) {
  const Law law = plastic_packing();
  time_law(state, floor, law.jamming, 0.98, [&](double phi) { return packing::state(law, phi); });
}

void packing_slopes(benchmark::State& state, const char* floor) {
  const Law law = plastic_packing();
  time_law(state, floor, law.jamming, 0.98, [&](double phi) { return slopes(law, phi, 0.1); });
}

void packing_under_stress(benchmark::State& state, const char* floor) {
  const Law law = plastic_packing();
  const Branch branch = growing_branch(law, Measure::stress);
  time_law(state, floor, branch.least, branch.greatest,
           [&](double stress) { return packing_fraction_at(law, branch, stress); });
}

BENCHMARK_CAPTURE(packing_state, plastic, "floor 24 ns");
BENCHMARK_CAPTURE(packing_slopes, plastic, "floor 51 ns");
BENCHMARK_CAPTURE(packing_under_stress, plastic, "floor 150 ns, 3 slopes");

}  // namespace
}  // namespace monograin::packing
