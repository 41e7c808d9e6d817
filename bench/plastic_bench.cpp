// Cost of one evaluation of the laws for plastic particles: force, contact radius and pressure with their slopes. The
// label of each benchmark is its cost floor: the time of a prototype with precomputed material constants on one core
// (g++ -O3, best of several runs).
#include <benchmark/benchmark.h>

#include <algorithm>

#include "hardening/law.hpp"
#include "law_timing.hpp"
#include "semimech/lateral.hpp"
#include "similarity/law.hpp"

namespace monograin::plastic {
namespace {

constexpr double k_exponent = 0.35;
/// First guess over solution when a force is inverted; 1 % is about the distance of two output points.
constexpr double k_guess = 0.99;

const similarity::Law& power_law() {
  static const similarity::Law k_law = similarity::make_law(k_exponent);
  return k_law;
}
const semimech::Law& steel() {
  static const semimech::Law k_law = semimech::make_law(semimech::make_material(1000.0, 0.3, 1.0), Configuration::die);
  return k_law;
}
const hardening::Law& cellulose() {
  static const hardening::Law k_law = hardening::make_law(k_exponent, Configuration::die);
  return k_law;
}

// --- similarity

void similarity_state(benchmark::State& state, const char* floor) {
  time_law(state, floor, 0.0, similarity::Law::calibrated_end,
           [](double x) { return state_in(power_law(), Regime::fully_plastic, x); });
}

void similarity_corrected_radius(benchmark::State& state, const char* floor) {
  const similarity::Law law = similarity::make_law(k_exponent, similarity::RadiusRule::corrected);
  time_law(state, floor, 0.0, similarity::Law::calibrated_end,
           [&](double x) { return state_in(law, Regime::fully_plastic, x); });
}

void similarity_under_force(benchmark::State& state, const char* floor) {
  const double greatest = state_in(power_law(), Regime::fully_plastic, similarity::Law::calibrated_end).force;
  time_law(state, floor, 0.0, greatest, [](double force) { return approach_under(power_law(), force); });
}

void similarity_work(benchmark::State& state, const char* floor) {
  time_law(state, floor, 0.0, similarity::Law::calibrated_end, [](double x) { return work_per_wall(power_law(), x); });
}

// --- the laws with regimes

/// Interval of x = displacement/radius in which a law has a regime.
struct Stretch {
  double begin = 0.0;
  double end = 0.0;
};

template <class Law>
Stretch stretch_of(const Law& law, Regime regime) {
  Stretch stretch;
  for (const Boundary& boundary : boundaries(law)) {
    stretch.end = boundary.approach;
    if (regime_at(law, stretch.end) == regime) return stretch;
    stretch.begin = boundary.approach;
  }
  stretch.end = law.calibrated_end;
  return stretch;
}

template <class Law>
void state_of(benchmark::State& state, const Law& law, Regime regime, const char* floor) {
  const Stretch stretch = stretch_of(law, regime);
  time_law(state, floor, stretch.begin, stretch.end, [&](double x) { return state_in(law, regime, x); });
}

template <class Law>
void under_force(benchmark::State& state, const Law& law, Regime regime, const char* floor) {
  const Stretch stretch = stretch_of(law, regime);
  time_law(state, floor, stretch.begin, stretch.end, [&](double x) {
    // The benchmark includes this evaluation of the force in addition to the inversion.
    const double force = state_in(law, regime, x).force;
    return approach_under(law, force, std::max(k_guess * x, stretch.begin));
  });
}

template <class Law>
void work_of(benchmark::State& state, const Law& law, Regime regime, const char* floor) {
  const Stretch stretch = stretch_of(law, regime);
  time_law(state, floor, stretch.begin, stretch.end, [&](double x) { return work_in(law, regime, x); });
}

void semimech_lateral(benchmark::State& state, const char* floor) {
  const semimech::LateralLaw lateral = make_lateral(steel());
  time_law(state, floor, lateral.yield_approach, semimech::LateralLaw::small_range_end,
           [&](double x) { return lateral_state_in(steel(), lateral, Regime::elastic_plastic, x); });
}

BENCHMARK_CAPTURE(similarity_state, parabolic, "floor 6 ns");
BENCHMARK_CAPTURE(similarity_corrected_radius, corrected, "floor 11 ns");
BENCHMARK_CAPTURE(similarity_under_force, parabolic, "floor 5 ns");
BENCHMARK_CAPTURE(similarity_work, parabolic, "floor 5 ns");

BENCHMARK_CAPTURE(state_of, semimech_elastic, steel(), Regime::elastic, "floor 7 ns");
BENCHMARK_CAPTURE(state_of, semimech_elastic_plastic, steel(), Regime::elastic_plastic, "floor 36 ns");
BENCHMARK_CAPTURE(state_of, semimech_fully_plastic, steel(), Regime::fully_plastic, "floor 41 ns");
BENCHMARK_CAPTURE(state_of, semimech_low_compressibility, steel(), Regime::low_compressibility, "floor 16 ns");
BENCHMARK_CAPTURE(state_of, semimech_elastic_volumetric, steel(), Regime::elastic_volumetric, "floor 4 ns");
BENCHMARK_CAPTURE(semimech_lateral, elastic_plastic, "floor 22 ns");
BENCHMARK_CAPTURE(under_force, semimech_fully_plastic, steel(), Regime::fully_plastic, "floor 120 ns, 3 states");
BENCHMARK_CAPTURE(work_of, semimech_fully_plastic, steel(), Regime::fully_plastic, "floor 1200 ns, 30 states");

BENCHMARK_CAPTURE(state_of, hardening_fully_plastic, cellulose(), Regime::fully_plastic, "floor 47 ns");
BENCHMARK_CAPTURE(state_of, hardening_low_compressibility, cellulose(), Regime::low_compressibility, "floor 30 ns");
BENCHMARK_CAPTURE(under_force, hardening_fully_plastic, cellulose(), Regime::fully_plastic, "floor 140 ns, 3 states");
BENCHMARK_CAPTURE(work_of, hardening_fully_plastic, cellulose(), Regime::fully_plastic, "floor 1400 ns, 30 states");

}  // namespace
}  // namespace monograin::plastic
