// Cost of one evaluation of the parts of a material point. The label of each benchmark is its cost floor: the time of a
// prototype with precomputed material constants on one core (g++ -O3, best of several runs).
#include <benchmark/benchmark.h>

#include <array>
#include <vector>

#include "law_timing.hpp"
#include "material-point/system.hpp"
#include "material-point/yield_surface.hpp"

namespace monograin::material_point {
namespace {

Parameters material(YieldModel model) {
  return {.model = model, .eta = 10.0, .xi = 7.5, .zeta = 10.0, .omega = 10.0, .xi1 = 0.4, .xi2 = 1.5};
}

void properties(benchmark::State& state, const char* floor) {
  const Parameters parameters = material(YieldModel::vmdc);
  time_law(state, floor, 0.0, 0.2, [&](double phi) { return properties_at(parameters, phi); });
}

/// Times yield function and plastic potential with their derivatives, at fixed properties.
void yield(benchmark::State& state, YieldModel model, Segment segment, double least_pressure, const char* floor) {
  const Parameters parameters = material(model);
  const Properties at = properties_at(parameters, 0.1);
  time_law(state, floor, least_pressure, 0.0,
           [&](double p) { return yield_on(parameters, at, {.segment = segment}, p, -0.5); });
}

/// Times the rates of a material point that yields in a die.
void plastic_rates(benchmark::State& state, YieldModel model, const char* floor) {
  System point({.parameters = material(model), .yield_pressure = 1e6});
  std::vector<double> y(point.unknowns().size());
  std::vector<double> dy(y.size());
  std::vector<Event> log;
  const std::array ramps{Ramp{0.0, -0.2, Control::strain}, Ramp{0.0, 0.0, Control::strain}};
  point.start(y);
  point.begin_step(ramps, y, log);
  std::array<double, 1> yielding{};
  point.guard_values(0.0, y, yielding);
  const double xi = -yielding[0];
  static_cast<void>(point.fire(std::array<std::size_t, 1>{0}, xi, y, log));
  // An interval of xi so short that the state, which is not integrated, stays close to the yield surface.
  time_law(state, floor, xi, xi + 1e-4, [&](double at) {
    point.rates(at, y, dy);
    return dy[0];
  });
}

BENCHMARK_CAPTURE(properties, vmdc, "floor 35 ns");
BENCHMARK_CAPTURE(yield, vm_shear, YieldModel::vm, Segment::shear, -1.0, "floor 2 ns");
BENCHMARK_CAPTURE(yield, vmdc_cap, YieldModel::vmdc, Segment::cap, -2.0, "floor 11 ns");
BENCHMARK_CAPTURE(yield, dpc_shear, YieldModel::dpc, Segment::shear, -1.0, "floor 7 ns");
BENCHMARK_CAPTURE(yield, dpc_cap, YieldModel::dpc, Segment::cap, -2.0, "floor 7 ns");
BENCHMARK_CAPTURE(plastic_rates, vmdc, YieldModel::vmdc, "floor 28 ns");
BENCHMARK_CAPTURE(plastic_rates, dpc, YieldModel::dpc, "");

}  // namespace
}  // namespace monograin::material_point
