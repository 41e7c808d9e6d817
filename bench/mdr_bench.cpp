// Cost of one evaluation of the MDR contact. The label of each benchmark is its cost floor: the time of a prototype on
// one core of about 3 GHz (g++ -O3, best of several runs).
#include <benchmark/benchmark.h>

#include "elastic/hertz.hpp"
#include "law_timing.hpp"
#include "mdr/contact.hpp"

namespace monograin::mdr {
namespace {

constexpr double k_radius = 1.05;
constexpr double k_overlap_max = 0.3;

/// A yielded contact of a material with E/Y = 20.
struct Dent {
  Material material = make_material(1.0, 0.3, 0.05);
  double area_constant = yield_area_constant(material.yield_overlap_ratio, k_radius);
  double yield_overlap = material.yield_overlap_ratio * k_radius;
  UnloadingShape shape = unloading_shape(material, k_radius, k_overlap_max, area_constant);
};

void hertz(benchmark::State& state) {
  time_law(state, "floor 7 ns", 0.0, k_overlap_max,
           [](double overlap) { return elastic_contact(ElasticProfile::parabola, 1.1, k_radius, overlap); });
}
BENCHMARK(hertz);

void elastic_ellipse(benchmark::State& state) {
  time_law(state, "floor 20 ns", 0.0, k_overlap_max,
           [](double overlap) { return elastic_contact(ElasticProfile::ellipse, 1.1, k_radius, overlap); });
}
BENCHMARK(elastic_ellipse);

void plastic_with_derivatives(benchmark::State& state) {
  const Dent dent;
  time_law(state, "floor 15-19 ns", dent.yield_overlap, k_overlap_max,
           [&](double overlap) { return plastic_contact(dent.material, k_radius, overlap, dent.area_constant); });
}
BENCHMARK(plastic_with_derivatives);

void unloading_with_full_shape(benchmark::State& state) {
  const Dent dent;
  time_law(state, "floor 40 ns", k_overlap_max - dent.shape.recovery, k_overlap_max, [&](double overlap) {
    const UnloadingShape shape = unloading_shape(dent.material, k_radius, k_overlap_max, dent.area_constant);
    return unloading_contact(shape, dent.material.composite_modulus, overlap);
  });
}
BENCHMARK(unloading_with_full_shape);

void unloading_with_cached_shape(benchmark::State& state) {
  const Dent dent;
  time_law(state, "floor 13 ns", k_overlap_max - dent.shape.recovery, k_overlap_max,
           [&](double overlap) { return unloading_contact(dent.shape, dent.material.composite_modulus, overlap); });
}
BENCHMARK(unloading_with_cached_shape);

void unloading_energy_with_cached_shape(benchmark::State& state) {
  const Dent dent;
  time_law(state, "", k_overlap_max - dent.shape.recovery, k_overlap_max,
           [&](double overlap) { return unloading_energy(dent.shape, overlap); });
}
BENCHMARK(unloading_energy_with_cached_shape);

void plastic_work(benchmark::State& state) {
  const Dent dent;
  time_law(state, "", dent.yield_overlap, k_overlap_max, [&](double overlap) {
    return plastic_work_primitive(dent.material, k_radius, overlap, dent.area_constant);
  });
}
BENCHMARK(plastic_work);

void yield_overlap(benchmark::State& state) {
  time_law(state, "", 20.0, 200.0, [](double stiffness) { return yield_overlap_ratio(stiffness); });
}
BENCHMARK(yield_overlap);

}  // namespace
}  // namespace monograin::mdr
