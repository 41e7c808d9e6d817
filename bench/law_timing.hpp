/// Times one evaluation of a law.
#pragma once

#include <benchmark/benchmark.h>

#include <array>
#include <cstddef>

namespace monograin {

constexpr std::size_t k_values = 64;

/// Values spread evenly over an interval.
inline std::array<double, k_values> values_between(double lower, double upper) {
  std::array<double, k_values> values{};
  for (std::size_t i = 0; i < k_values; ++i) {
    values[i] = lower + (upper - lower) * (static_cast<double>(i) + 0.5) / k_values;
  }
  return values;
}

/// Time of one call of a law, over arguments from an interval.
/// @param floor  the label: what a prototype took; empty: there is none
template <class Law>
void time_law(benchmark::State& state, const char* floor, double lower, double upper, Law&& law) {
  const auto arguments = values_between(lower, upper);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(law(arguments[i]));
    i = (i + 1) % k_values;
  }
  state.SetLabel(floor);
}

}  // namespace monograin
