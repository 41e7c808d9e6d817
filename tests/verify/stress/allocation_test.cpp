// Nothing is allocated while steps are taken and rows recorded: how often memory is asked for in a run depends neither
// on the tolerance nor on the output points.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <set>
#include <string>

#include "catalogue.hpp"
#include "engine/integrator.hpp"
#include "history/run.hpp"
#include "scene/scene.hpp"
#include "support/temporary_folder.hpp"
#include "verify/stress/draw/generator.hpp"
#include "verify/stress/draw/scene.hpp"

// Under a sanitizer the allocator is its own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define MONOGRAIN_COUNTS_ALLOCATIONS

namespace {
std::atomic<long> allocation_count{0};

void* counted(std::size_t size) {
  ++allocation_count;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
#endif

namespace monograin::allocation_test {
namespace {

#ifdef MONOGRAIN_COUNTS_ALLOCATIONS

struct Count {
  long allocations = 0;
  long steps = 0;
  long events = 0;
  RunStatus status = RunStatus::complete;
};

Count count(CheckedScenario scenario, std::string_view integrator, double rtol, int points) {
  scenario.output.points = points;
  Scene scene = make_scene(scenario);
  const long before = allocation_count;
  const RunRecord record = record_run(scene, integrator, {rtol, 1e-3 * rtol}, scenario.output);
  return {allocation_count - before, record.statistics.steps, record.statistics.events, record.status};
}

struct Pair {
  Count coarse, fine;
};

/// With few and with many output points, after tables that are made once.
Pair count_both(const CheckedScenario& scenario, std::string_view integrator, double rtol) {
  for (const int points : {10, 300}) count(scenario, integrator, rtol, points);  // many rows have tables of their own
  return {count(scenario, integrator, rtol, 10), count(scenario, integrator, rtol, 300)};
}

constexpr const char* k_scenarios[] = {"die",          "uniaxial",  "cel",           "hertz",
                                       "semimech",     "hardening", "similarity",    "nonlocal",
                                       "compressible", "packing",   "material-point"};

CheckedScenario ready_scenario(const std::string& name) {
  return read_scenario(std::filesystem::path(MONOGRAIN_SOURCE_DIR) / "scenarios" / (name + ".toml"));
}

TEST(AllocationsOfReadyScenarios, AreCountedForEveryModel) {
  std::set<std::string> counted;
  for (const char* name : k_scenarios) counted.insert(ready_scenario(name).model);
  for (const Model& model : model_catalogue()) EXPECT_TRUE(counted.contains(std::string(model.name))) << model.name;
}

class Allocations : public ::testing::TestWithParam<const char*> {};

TEST_P(Allocations, DependOnEventsOnly) {
  const CheckedScenario scenario = ready_scenario(GetParam());
  for (const std::string_view integrator : integrator_names()) {
    if (integrator == "forward-euler") continue;  // its tolerance is its step
    // Boost allocates in every step of these.
    if (integrator == "odeint-rosenbrock4" || integrator == "odeint-bulirsch-stoer") continue;
    if (integrator == "direct" && !make_scene(scenario).system->is_solvable()) continue;
    SCOPED_TRACE(integrator);
    const auto [loose, fine] = count_both(scenario, integrator, 1e-5);
    const Count tight = count(scenario, integrator, 1e-7, 10);
    for (const Count& each : {loose, tight, fine}) EXPECT_EQ(each.status, RunStatus::complete);
    EXPECT_TRUE(integrator == "direct" || tight.steps >= loose.steps);
    if (tight.events != loose.events) continue;  // two that coincide may be seen as one
    EXPECT_EQ(fine.allocations, loose.allocations);
    // Trial steps that leave the domain, which codes with step control of their own come by, end in exceptions.
    if (integrator.starts_with("odeint") || integrator.starts_with("gsl")) continue;
    EXPECT_EQ(tight.allocations, loose.allocations);
  }
}

// Whether other contacts bear a force that is rounding beside theirs is asked at every state.
constexpr const char* k_slight_force = R"(
  model = "hertz"
  particle.radius = 1
  material = { youngs_modulus = 1, poisson_ratio = 0.4 }
  [loading]
  configuration = "walls"
  centre = "equilibrium"
  [[loading.wall]]
  name = "driven"
  normal = [1, 0, 0]
  steps = [{ displacement = 0.1, duration = 1 }]
  [[loading.wall]]
  name = "loaded"
  normal = [-1, 0, 0]
  steps = [{ force = 0.05, duration = 1 }]
  [[loading.wall]]
  name = "slight"
  normal = [0, 1, 0]
  steps = [{ force = 1e-12, duration = 1 }]
)";

TEST(AllocationsOfSlightForces, DependOnEventsOnly) {
  const CheckedScenario scenario = parse_scenario(k_slight_force, "slight-force");
  for (const char* integrator : {"direct", "cvode-bdf"}) {
    const auto [coarse, fine] = count_both(scenario, integrator, 1e-5);
    EXPECT_EQ(coarse.status, RunStatus::complete);
    EXPECT_EQ(fine.allocations, coarse.allocations) << integrator;
  }
}

TEST(AllocationsOfDrawnScenes, DependOnEventsOnly) {
  constexpr int k_room = 4;  // that for rows and events grows with their number, but seldom
  const TemporaryFolder tables;
  write_stress_tables(tables.path());
  int seen = 0;
  for (std::uint64_t i = 0; i < 150; ++i) {
    const CheckedScenario scenario =
        parse_stress_text(scenario_text(draw_stress_scene(3, i, tables.path())), tables.path());
    const char* integrator = make_scene(scenario).system->is_solvable() ? "direct" : "cvode-bdf";
    const auto [coarse, fine] = count_both(scenario, integrator, 1e-6);
    // What fails ends in exceptions.
    const auto is_complete = [](const Count& each) { return each.status == RunStatus::complete; };
    if (!is_complete(coarse) || !is_complete(fine) || fine.events != coarse.events) continue;
    ++seen;
    EXPECT_LE(std::abs(fine.allocations - coarse.allocations), k_room) << "scene " << i << ", " << scenario.model;
  }
  EXPECT_GT(seen, 80);
}

INSTANTIATE_TEST_SUITE_P(OfEveryModel, Allocations, ::testing::ValuesIn(k_scenarios), [](const auto& tested) {
  std::string name = tested.param;
  std::erase(name, '-');
  return name;
});

#endif

}  // namespace
}  // namespace monograin::allocation_test
