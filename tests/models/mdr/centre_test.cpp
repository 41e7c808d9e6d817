// A free centre moves so that the wall forces balance.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/accuracy.hpp"
#include "support/deviation.hpp"
#include "support/test_run.hpp"

namespace monograin::centre_test {
namespace {

CheckedScenario with_free_centre(CheckedScenario scenario) {
  scenario.loading.centre_is_free = true;
  return scenario;
}

/// One driven wall above, one at rest below.
CheckedScenario press(const CheckedScenario& particle, const std::vector<double>& displacements) {
  return with_free_centre(between(particle, {wall("top", {0, 0, 1}, path(displacements)), wall("bottom", {0, 0, -1})}));
}

CheckedScenario mdr_particle() { return mdr_scenario(Configuration::walls, 20.0, 0.3, {}); }
CheckedScenario hertz_particle() { return hertz_scenario(Configuration::walls, {}); }

/// Three walls at rest below, at equal angles, and one driven wall above.
CheckedScenario tripod(const CheckedScenario& particle, const std::vector<double>& displacements,
                       double z = -1.0 / 3.0) {
  std::vector<WallSpec> walls{wall("top", {0, 0, 1}, path(displacements))};
  for (int k = 0; k < 3; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 3.0;
    const double s = std::sqrt(1.0 - z * z);
    walls.push_back(wall("foot-" + std::to_string(k), {s * std::cos(angle), s * std::sin(angle), z}));
  }
  return with_free_centre(between(particle, std::move(walls)));
}

/// Three walls at rest without any symmetry, and one driven wall.
CheckedScenario crooked_tripod(const CheckedScenario& particle, const std::vector<double>& displacements) {
  return with_free_centre(
      between(particle, {wall("top", {0.1, -0.05, 1}, path(displacements)), wall("a", {0.9, 0.1, -0.5}),
                         wall("b", {-0.5, 0.7, -0.4}), wall("c", {-0.4, -0.8, -0.6})}));
}

/// Largest magnitude of the net force at any row, over the largest single force.
double net_force(const TestRun& result) {
  std::vector<std::vector<double>> forces;
  double scale = 0.0;
  for (const ContactClass& c : result.scene.classes) {
    forces.push_back(result.column(c.name + ".force"));
    scale = std::max(scale, largest(forces.back()));
  }
  double worst = 0.0;
  for (std::size_t row = 0; row < forces.front().size(); ++row) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t c = 0; c < forces.size(); ++c) {
      for (const Eigen::Vector3d& normal : result.scene.classes[c].normals) sum += forces[c][row] * normal;
    }
    worst = std::max(worst, sum.norm());
  }
  return worst / scale;
}

bool has_algebraic_unknowns(const Scene& scene) {
  return std::ranges::any_of(scene.system->unknowns(),
                             [](const Unknown& u) { return u.kind == Unknown::Kind::algebraic; });
}

TEST(FreeCentre, GivesEachContactOfAPairHalfTheDisplacement) {
  // Loading, unloading with a loss of contact, and reloading beyond.
  const std::vector<double> displacements{0.5, 0.3, 0.6};
  std::vector<double> halves;
  for (const double d : displacements) halves.push_back(0.5 * d);
  const TestRun symmetric = run(mdr_scenario(Configuration::simple, 20.0, 0.3, path(halves)));
  ASSERT_TRUE(symmetric.has_event("contact-lost"));
  for (const char* integrator : k_integrators) {
    const TestRun pressed = run(press(mdr_particle(), displacements), integrator);
    ASSERT_EQ(pressed.record.status, RunStatus::complete) << integrator << ": " << pressed.record.message;
    const double tolerance = std::string_view(integrator) == "direct" ? 1e-13 : 1e-7;  // rounding; some rtol
    EXPECT_LE(difference(pressed.outputs("work"), symmetric.outputs("work")), tolerance) << integrator;
    EXPECT_LE(difference(pressed.outputs("apparent_radius"), symmetric.outputs("apparent_radius")), tolerance)
        << integrator;
    for (const char* side : {"top", "bottom"}) {
      const std::string name(side);
      EXPECT_LE(difference(pressed.outputs(name + ".force"), symmetric.outputs("axial.force")), tolerance)
          << integrator << ", " << side;
    }
    EXPECT_NEAR(pressed.last("centre_z"), -0.3, tolerance) << integrator;  // half way
  }
}

TEST(FreeCentre, NeedsNoUnknownWhereSymmetryHoldsIt) {
  for (const auto configuration : {Configuration::simple, Configuration::die, Configuration::hydrostatic}) {
    const CheckedScenario fixed = mdr_scenario(configuration, 20.0, 0.3, path({0.17, 0.16, 0.18}));
    const TestRun expected = run(fixed);
    const TestRun free = run(with_free_centre(fixed));
    EXPECT_FALSE(has_algebraic_unknowns(free.scene)) << describe(fixed);
    EXPECT_EQ(difference(free, expected), 0.0) << describe(fixed);
    EXPECT_EQ(free.last("centre_z"), 0.0) << describe(fixed);
  }
}

TEST(FreeCentre, MovesOnlyInWaysThatKeepTheSymmetry) {
  const auto free_directions = [](const CheckedScenario& scenario) {
    const Scene scene = make_scene(scenario);
    return std::ranges::count(scene.system->unknowns(), Unknown::Kind::algebraic, &Unknown::kind);
  };
  EXPECT_EQ(free_directions(tripod(mdr_particle(), {0.1})), 1);
  EXPECT_EQ(free_directions(crooked_tripod(mdr_particle(), {0.1})), 3);
}

TEST(FreeCentre, BalancesTheForcesInEveryRow) {
  for (const CheckedScenario& scenario :
       {tripod(mdr_particle(), {0.4, 0.35, 0.45}), crooked_tripod(mdr_particle(), {0.4, 0.38, 0.45}),
        tripod(hertz_particle(), {0.2, -0.05, 0.1}), press(mdr_particle(), {0.4, 0.2, 0.5})}) {
    for (const char* integrator : k_integrators) {
      const TestRun result = run(scenario, integrator);
      ASSERT_EQ(result.record.status, RunStatus::complete) << integrator << ": " << result.record.message;
      // IDA solves for the balance to its tolerance, 3e-10 measured at rtol 1e-8; the others to round-off.
      EXPECT_LE(net_force(result), std::string_view(integrator) == "ida" ? 1e-9 : 4e-15)
          << integrator << ", " << describe(scenario);
    }
  }
}

TEST(FreeCentre, IsTheSameInAllForms) {
  for (const CheckedScenario& scenario :
       {tripod(mdr_particle(), {0.4, 0.35, 0.45}), tripod(mdr_particle(), {0.3, 0.2, 0.35}, -0.8),
        crooked_tripod(mdr_particle(), {0.4, 0.38, 0.45})}) {
    for (const char* rule : {"gated", "yielded"}) {
      const TestRun direct = run(with(scenario, "radius_rule", rule));
      ASSERT_EQ(direct.record.status, RunStatus::complete) << direct.record.message;
      for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
        const TestRun integrated = run(with(scenario, "radius_rule", rule), integrator);
        // 1.5e-8 measured.
        EXPECT_EQ(integrated.events(), direct.events()) << integrator << ", " << describe(scenario);
        EXPECT_LE(difference(integrated, direct), 5e-8) << integrator << ", " << describe(scenario);
        for (const char* axis : {"centre_x", "centre_y", "centre_z"}) {
          const auto expected = direct.outputs(axis);
          const auto actual = integrated.outputs(axis);
          for (std::size_t row = 0; row < expected.size(); ++row) {
            EXPECT_NEAR(actual[row], expected[row], 1e-7) << integrator << ", " << axis << ", row " << row;
          }
        }
      }
    }
  }
}

TEST(FreeCentre, ConservesEnergyInElasticContacts) {
  for (const CheckedScenario& scenario :
       {tripod(hertz_particle(), {0.2, 0.0}), crooked_tripod(hertz_particle(), {0.2, 0.0})}) {
    const TestRun result = run(scenario);
    const auto work = result.outputs("work");
    const auto stored = result.outputs("stored_energy");
    for (std::size_t row = 0; row < work.size(); ++row) {
      EXPECT_NEAR(work[row], stored[row], 1e-12 * work[50]) << "row " << row << ", " << describe(scenario);
    }
    EXPECT_GT(work[50], 1e-3);
  }
}

TEST(FreeCentre, DoesNotCreateEnergyWithTheYieldedRule) {
  for (const CheckedScenario& scenario :
       {tripod(mdr_particle(), {0.4, 0.3, 0.45}), crooked_tripod(mdr_particle(), {0.4, 0.3, 0.45})}) {
    EXPECT_GE(lost_dissipation(run(with(scenario, "radius_rule", "yielded"))), -1e-12) << describe(scenario);
  }
}

TEST(FreeCentre, ThatNothingHoldsIsCarriedByTheWallThatPushesIt) {
  const auto push = path({0.2});
  const std::vector<WallSpec> loose_sets[] = {{wall("top", {0, 0, 1}, push)},
                                              {wall("top", {0, 0, 1}, push), wall("side", {1, 0, 0})},
                                              {wall("top", {0, 0.3, 1}, push), wall("bottom", {0, 0.3, -1})}};
  for (const auto& walls : loose_sets) {
    for (const char* integrator : k_integrators) {
      const TestRun result = run(with_free_centre(between(mdr_particle(), walls)), integrator);
      ASSERT_EQ(result.record.status, RunStatus::complete) << integrator << ": " << result.record.message;
      EXPECT_LE(largest(result.column("top.overlap")), 1e-11) << integrator;
      EXPECT_LE(largest(result.column("top.force")), 1e-15) << integrator;
      EXPECT_LE(result.last("top.displacement"), 0.2 + 1e-12) << integrator;
      EXPECT_LT(result.last("centre_z"), -0.05) << integrator;
    }
  }
}

TEST(FreeCentre, ThatIsLooseIsCarriedToTheOtherWallAndSqueezedThere) {
  // A particle that comes loose, too: both walls leave it where it is, and the lower one returns.
  const TestRun expected = run(press(mdr_particle(), {0.1}));
  const CheckedScenario gap =
      between(mdr_particle(), {wall("top", {0, 0, 1}, path({0.2})), wall("bottom", {0, 0, -1}, {}, 0.1)});
  for (const char* integrator : k_integrators) {
    const TestRun result = run(with_free_centre(gap), integrator);
    ASSERT_EQ(result.record.status, RunStatus::complete) << integrator << ": " << result.record.message;
    EXPECT_NEAR(result.last("bottom.force") / expected.last("bottom.force"), 1.0, 1e-7) << integrator;
  }
  const CheckedScenario let_go = between(mdr_particle(), {wall("top", {0, 0, 1}, path({0.2, 0.0, 0.0})),
                                                          wall("bottom", {0, 0, -1}, path({0.2, 0.0, 0.4}))});
  for (const char* integrator : k_integrators) {
    const TestRun result = run(with_free_centre(let_go), integrator);
    ASSERT_EQ(result.record.status, RunStatus::complete) << integrator << ": " << result.record.message;
    EXPECT_GT(result.last("bottom.force"), 0.0) << integrator;
  }
}

/// Largest difference of a wall's overlap from the sum of its displacement, the centre's and the radius's growth.
double misplacement(const TestRun& result) {
  const std::vector<double> x[] = {result.column("centre_x"), result.column("centre_y"), result.column("centre_z")};
  const bool grows = result.record.history.find("apparent_radius").has_value();
  double worst = 0.0;
  for (const ContactClass& c : result.scene.classes) {
    const std::vector<double> displacement = result.column(c.name + ".displacement");
    const std::vector<double> overlap = result.column(c.name + ".overlap");
    for (std::size_t row = 0; row < overlap.size(); ++row) {
      const Eigen::Vector3d centre(x[0][row], x[1][row], x[2][row]);
      const double growth = grows ? result.column("apparent_radius")[row] - 1.0 : 0.0;
      const double expected = displacement[row] + c.normals.front().dot(centre) + growth;
      worst = std::max(worst, deviation(overlap[row], expected));
    }
  }
  return worst;
}

TEST(FreeCentre, LeavesADisplacementThatOfTheWallItself) {
  for (const CheckedScenario& particle : {hertz_particle(), mdr_particle()}) {
    for (const char* integrator : k_integrators) {
      const TestRun result = run(press(particle, {0.04, 0.02}), integrator);
      const std::vector<double> top = result.outputs("top.displacement");
      EXPECT_EQ(top[50], 0.04) << integrator << ", " << particle.model;
      EXPECT_EQ(top[100], 0.02) << integrator << ", " << particle.model;
      EXPECT_EQ(largest(result.column("bottom.displacement")), 0.0) << integrator << ", " << particle.model;
      EXPECT_LE(misplacement(result), 1e-15) << integrator << ", " << particle.model;
    }
    EXPECT_LE(misplacement(run(crooked_tripod(particle, {0.04, 0.02}))), 1e-15) << particle.model;
  }
}

TEST(FreeCentre, LeavesADisplacementThatOfTheWallItselfUnderForce) {
  for (const CheckedScenario& particle : {hertz_particle(), mdr_particle()}) {
    const TestRun result = run(with_free_centre(between(
        particle, {wall("top", {0, 0, 1}, {force_ramp(0.004), force_ramp(0.001)}), wall("bottom", {0, 0, -1})})));
    EXPECT_LE(misplacement(result), 1e-15) << particle.model;
    EXPECT_EQ(largest(result.column("bottom.displacement")), 0.0) << particle.model;
    // The wall above comes nearer by both overlaps.
    EXPECT_GT(result.outputs("top.displacement")[50], 1.9 * result.outputs("bottom.overlap")[50]) << particle.model;
  }
}

TEST(FreeCentre, MeetsAConditionByTheTravelOfTheWall) {
  for (const CheckedScenario& particle : {hertz_particle(), mdr_particle()}) {
    const Step step = until(ramp(0.1), Quantity::displacement, 0.04);
    const TestRun result =
        run(with_free_centre(between(particle, {wall("top", {0, 0, 1}, {step}), wall("bottom", {0, 0, -1})})));
    EXPECT_NEAR(result.last("top.displacement"), 0.04, 1e-15) << particle.model;
    EXPECT_NEAR(result.last("time"), 0.4, 1e-14) << particle.model;
  }
}

}  // namespace
}  // namespace monograin::centre_test
