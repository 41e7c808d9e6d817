// Cost of one state of the nonlocal formulation, along a compression in 200 points up to just below its limit. The
// label of each benchmark is its cost floor: the time of a prototype with fixed sizes on one core (g++ -O3, best of
// several runs).
#include <algorithm>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "nonlocal/contacts.hpp"
#include "nonlocal/coupling.hpp"
#include "nonlocal/equilibrium.hpp"
#include "nonlocal/rates.hpp"

namespace monograin::nonlocal {
namespace {

constexpr double k_poisson_ratio = 0.48;
constexpr int k_points = 200;

struct WallSet {
  std::vector<ContactClass> classes;
  double end;  ///< displacement of the driven walls over R0, just below the limit
};

/// A contact class of the walls with these normals and their opposite walls.
ContactClass walls(std::vector<Eigen::Vector3d> normals) {
  std::vector<Eigen::Vector3d> both = normals;
  for (const Eigen::Vector3d& normal : normals) both.emplace_back(-normal);
  return {.name = {}, .normals = both};
}

WallSet simple() { return {{walls({{0, 0, 1}})}, 0.8}; }
WallSet die() { return {{walls({{0, 0, 1}}), walls({{1, 0, 0}, {0, 1, 0}})}, 0.459}; }
WallSet hydrostatic() { return {{walls({{0, 0, 1}, {1, 0, 0}, {0, 1, 0}})}, 0.174}; }
WallSet oblique_die() {
  const double angle = 37.5 / 180.0 * std::numbers::pi;
  return {{walls({{0, 0, 1}}), walls({{1, 0, 0}}), walls({{0, 1, 0}}), walls({{0, std::cos(angle), std::sin(angle)}})},
          0.442};
}

/// The wall set with a contact class for every wall.
WallSet single(const WallSet& set) {
  WallSet result{{}, set.end};
  for (const ContactClass& group : set.classes) {
    for (const Eigen::Vector3d& normal : group.normals) result.classes.push_back({.name = {}, .normals = {normal}});
  }
  return result;
}

/// Ramps that move the walls of the first class of `grouped` and keep the others; `set` has the classes of `grouped`,
/// or one class for each wall.
std::vector<Ramp> compression(const WallSet& set, const WallSet& grouped) {
  std::vector<Ramp> ramps(set.classes.size());
  const std::size_t driven = set.classes.size() == grouped.classes.size() ? 1 : grouped.classes[0].normals.size();
  for (std::size_t j = 0; j < driven; ++j) ramps[j].end = set.end;
  return ramps;
}

/// Times the solution of one state; linear extrapolation from the last two states gives the first guess.
void solve(benchmark::State& state, const WallSet& set, const WallSet& grouped, const char* floor) {
  Contacts contacts({k_poisson_ratio, Terms::four}, set.classes, Centre::fixed);
  EquilibriumSearch search(contacts);
  const std::vector<Ramp> ramps = compression(set, grouped);
  std::vector<double> y(contacts.unknown_count());
  std::vector<double> last(y.size());
  int point = k_points;
  for (auto _ : state) {
    if (point == k_points) {
      std::fill(y.begin(), y.end(), 0.0);
      std::fill(last.begin(), last.end(), 0.0);
      point = 0;
    }
    ++point;
    for (std::size_t j = 0; j < y.size(); ++j) {
      const double next = 2.0 * y[j] - last[j];
      last[j] = y[j];
      y[j] = next;
    }
    search.solve(contacts, ramps, static_cast<double>(point) / k_points, y);
    benchmark::DoNotOptimize(y.data());
  }
  state.SetLabel(floor);
}

BENCHMARK_CAPTURE(solve, simple_classes, simple(), simple(), "floor 45 ns");
BENCHMARK_CAPTURE(solve, simple_walls, single(simple()), simple(), "floor 140 ns");
BENCHMARK_CAPTURE(solve, die_classes, die(), die(), "floor 190 ns");
BENCHMARK_CAPTURE(solve, die_walls, single(die()), die(), "floor 780 ns");
BENCHMARK_CAPTURE(solve, hydrostatic_classes, hydrostatic(), hydrostatic(), "floor 60 ns");
BENCHMARK_CAPTURE(solve, hydrostatic_walls, single(hydrostatic()), hydrostatic(), "floor 740 ns");
BENCHMARK_CAPTURE(solve, oblique_die_classes, oblique_die(), oblique_die(), "floor 430 ns");
BENCHMARK_CAPTURE(solve, oblique_die_walls, single(oblique_die()), oblique_die(), "floor 1100 ns");

/// A state of the oblique die at half its compression, with a contact class for every wall.
struct Loaded {
  WallSet set = single(oblique_die());
  Contacts contacts{{k_poisson_ratio, Terms::four}, set.classes, Centre::fixed};
  std::vector<double> y = std::vector<double>(8, 0.0);

  Loaded() { EquilibriumSearch(contacts).solve(contacts, compression(set, oblique_die()), 0.5, y); }
};

void margin_of_eight_walls(benchmark::State& state) {
  Loaded loaded;
  for (auto _ : state) benchmark::DoNotOptimize(loaded.contacts.margin(loaded.y));
  state.SetLabel("floor 2600 ns");
}
BENCHMARK(margin_of_eight_walls);

void least_pivot_of_eight_walls(benchmark::State& state) {
  Loaded loaded;
  for (auto _ : state) benchmark::DoNotOptimize(loaded.contacts.least_pivot(loaded.y));
  state.SetLabel("floor 220 ns");
}
BENCHMARK(least_pivot_of_eight_walls);

void rates_of_eight_walls(benchmark::State& state) {
  Loaded loaded;
  const std::vector<Ramp> ramps = compression(loaded.set, oblique_die());
  Rates rates(loaded.contacts);
  std::vector<double> dy(8);
  for (auto _ : state) {
    rates.find(loaded.contacts, ramps, loaded.y, dy);
    benchmark::DoNotOptimize(dy.data());
  }
}
BENCHMARK(rates_of_eight_walls);

void radius(benchmark::State& state, RadiusRule rule, const char* floor) {
  double x = 0.5;
  for (auto _ : state) {
    benchmark::DoNotOptimize(x);
    benchmark::DoNotOptimize(radius_influence(rule, k_poisson_ratio, 0.5 * std::numbers::pi, x));
  }
  state.SetLabel(floor);
}
BENCHMARK_CAPTURE(radius, closed, RadiusRule::closed, "floor 50 ns");
BENCHMARK_CAPTURE(radius, integral, RadiusRule::integral, "floor 560 ns, 32 points");

}  // namespace
}  // namespace monograin::nonlocal
