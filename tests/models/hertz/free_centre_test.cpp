// Runs of a Hertz particle with a free centre: loose, pushed, squeezed, and released.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "elastic/hertz.hpp"
#include "support/test_run.hpp"

namespace monograin::hertz_centre_test {
namespace {

CheckedScenario cell(std::vector<WallSpec> walls) {
  CheckedScenario scenario = between(hertz_scenario(Configuration::walls, {}), std::move(walls));
  scenario.loading.centre_is_free = true;
  return with_points(scenario, 8);
}

double force_at(double overlap) { return hertz_force(composite_modulus(1.0, 0.3), 1.0, overlap); }

TEST(LooseHertzParticle, IsCarriedToTheOtherWallAndSqueezedThere) {
  const CheckedScenario scenario =
      cell({wall("top", {0, 0, 1}, path({0.1}), 0.01), wall("bottom", {0, 0, -1}, {}, 0.01)});
  for (const char* integrator : k_integrators) {
    const TestRun result = run(scenario, integrator);
    ASSERT_EQ(result.record.status, RunStatus::complete) << integrator << ": " << result.record.message;
    EXPECT_EQ(result.events(), (std::vector<std::string>{"top:contact-made", "bottom:contact-made"})) << integrator;
    EXPECT_NEAR(result.last("bottom.force") / force_at(0.045), 1.0, 1e-12) << integrator;
    EXPECT_NEAR(result.last("centre_z"), -0.055, 1e-12) << integrator;
    EXPECT_NEAR(result.last("work") / result.last("stored_energy"), 1.0, 1e-6) << integrator;
  }
}

TEST(LooseHertzParticle, StaysWhereAWallHasPushedItTo) {
  const TestRun result = run(cell({wall("top", {0, 0, 1}, path({0.1, -0.1, 0.05})), wall("far", {0, 0, -1}, {}, 1.0)}));
  ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
  EXPECT_NEAR(result.last("centre_z"), -0.1, 1e-15);
  EXPECT_TRUE(result.has_event("contact-lost"));
  EXPECT_EQ(largest(result.column("top.force")), 0.0);
}

TEST(LooseHertzParticle, IsTakenByAForceToTheWallThatBearsIt) {
  const TestRun result = run(cell({wall("top", {0, 0, 1}, {force_ramp(1e-3)}), wall("far", {0, 0, -1}, {}, 0.2)}));
  ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
  EXPECT_NEAR(result.last("far.force"), 1e-3, 1e-15);
}

TEST(HertzCell, AtRightAnglesTakesAForceOnOneWallAndADisplacementOnAnother) {
  const CheckedScenario scenario =
      cell({wall("w0", {1, 0, 0}), wall("w1", {0, 1, 0}), wall("w2", {-1, 0, 0}, {force_ramp(1e-3)}),
            wall("w3", {0, -1, 0}, path({0.01}))});
  for (const char* integrator : k_integrators) {
    const TestRun result = run(scenario, integrator);
    ASSERT_EQ(result.record.status, RunStatus::complete) << integrator << ": " << result.record.message;
    EXPECT_NEAR(result.last("w0.force"), 1e-3, 1e-15) << integrator;
    EXPECT_NEAR(result.last("w1.force") / force_at(0.005), 1.0, 1e-12) << integrator;
  }
}

TEST(HertzCell, EndsAlikeTurnedAndInAnotherOrder) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::normal_distribution<double> component;
  int stopped = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<WallSpec> walls;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {1.0, -1.0}) {
        std::vector<Step> steps;
        const double kind = share(random);
        for (int k = 0; k < 2 && kind < 0.7; ++k)
          steps.push_back(kind < 0.25 ? force_ramp(1e-3 * share(random)) : ramp(0.06 * share(random) - 0.01));
        const double gap = share(random) < 0.5 ? 0.0 : 0.01 * share(random);
        walls.push_back(
            wall("w" + std::to_string(walls.size()), side * Eigen::Vector3d::Unit(axis), std::move(steps), gap));
      }
    }
    if (std::ranges::all_of(walls, &WallSpec::is_fixed)) continue;
    const auto unmerged = [](const CheckedScenario& scenario) { return run(scenario, "direct", {}, false); };
    const TestRun expected = unmerged(cell(walls));
    stopped += expected.record.status == RunStatus::stopped ? 1 : 0;
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(component(random), component(random), component(random), component(random)).normalized();
    std::vector<WallSpec> turned = walls;
    for (WallSpec& w : turned) {
      const Eigen::Vector3d normal = turn * Eigen::Vector3d::Map(w.normal.data());
      std::ranges::copy(normal, w.normal.begin());
    }
    std::vector<WallSpec> shuffled = walls;
    std::ranges::shuffle(shuffled, random);
    for (const auto& copy : {turned, shuffled}) {
      const TestRun result = unmerged(cell(copy));
      EXPECT_EQ(result.record.status, expected.record.status) << trial << ": " << result.record.message;
      EXPECT_EQ(result.record.limit, expected.record.limit) << trial;
      for (const WallSpec& w : walls)
        EXPECT_NEAR(result.last(w.name + ".force"), expected.last(w.name + ".force"), 1e-11) << trial << ", " << w.name;
    }
  }
  EXPECT_LE(stopped, 20);
}

TEST(HertzCell, TakesASphereThatIsSqueezedBeyondItsHold) {
  // Three walls, none of which opposes another, let the particle move to the fourth one.
  const TestRun result = run(cell({wall("a", {1, 0, -0.2}, path({0.05})), wall("b", {-1, 0.1, -0.2}),
                                   wall("c", {0, -1, -0.2}), wall("lid", {0, 0, 1}, {}, 0.3)}));
  ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
  EXPECT_GT(result.last("centre_z"), 0.0);
}

}  // namespace
}  // namespace monograin::hertz_centre_test
