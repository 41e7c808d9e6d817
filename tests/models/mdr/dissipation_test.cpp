// Energy balance of whole runs: where the model dissipates, where it creates energy, and that it warns the user.

#include <gtest/gtest.h>

#include <algorithm>

#include "history/energy.hpp"
#include "support/test_run.hpp"

namespace monograin::dissipation_test {
namespace {

TestRun run_finely(const CheckedScenario& scenario) { return run(with_points(scenario, 400)); }

bool warns_of_created_energy(const TestRun& result) {
  return energy_warning(result.record.history, 1.0, "mdr", 0.0).has_value();
}

/// Pairs of walls along x, y and z, each with a program of its own.
CheckedScenario three_pairs(double modulus_over_yield, double poisson_ratio,
                            const std::vector<std::vector<double>>& programs) {
  std::vector<WallSpec> walls;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d normal = Eigen::Vector3d::Unit(axis);
    const std::vector<Step> steps = path(programs[static_cast<std::size_t>(axis)]);
    walls.push_back(wall(std::string(1, "xyz"[axis]) + "+", normal, steps));
    walls.push_back(wall(std::string(1, "xyz"[axis]) + "-", -normal, steps));
  }
  return between(mdr_scenario(Configuration::walls, modulus_over_yield, poisson_ratio, {}), std::move(walls));
}

/// The programs over which the energy balance of the three radius rules was compared.
std::vector<CheckedScenario> programs(double modulus_over_yield, double poisson_ratio) {
  return {mdr_scenario(Configuration::simple, modulus_over_yield, poisson_ratio, path({0.45})),
          mdr_scenario(Configuration::die, modulus_over_yield, poisson_ratio, path({0.43, 0.0})),
          mdr_scenario(Configuration::hydrostatic, modulus_over_yield, poisson_ratio, path({0.2})),
          three_pairs(modulus_over_yield, poisson_ratio, {{0.15, 0.15, 0.15}, {0.0, 0.15, 0.15}, {0.0, 0.0, 0.15}}),
          three_pairs(modulus_over_yield, poisson_ratio, {{0.2, 0.1}, {0.0, 0.2}, {0.0, 0.0}})};
}

TEST(MdrDissipation, NeverDecreasesWithTheYieldedRule) {
  for (const double modulus_over_yield : {6.25, 10.0, 20.0, 50.0, 200.0}) {
    for (const double poisson_ratio : {0.0, 0.3, 0.45}) {
      for (const CheckedScenario& scenario : programs(modulus_over_yield, poisson_ratio)) {
        const TestRun result = run(with(scenario, "radius_rule", "yielded"));
        // The work of each row has round-off; 2e-15 measured over all scenes.
        EXPECT_GE(lost_dissipation(result), -1e-14) << describe(scenario);
        EXPECT_FALSE(warns_of_created_energy(result)) << describe(scenario);
      }
    }
  }
}

TEST(MdrDissipation, BalancesWorkAndStoredEnergyInEveryRow) {
  const TestRun result = run(mdr_scenario(Configuration::die, 20.0, 0.3, path({0.3, 0.0, 0.35})));
  const auto work = result.column("work");
  const auto stored = result.column("stored_energy");
  const auto dissipation = result.column("dissipation");
  for (std::size_t row = 0; row < work.size(); ++row) {
    EXPECT_NEAR(work[row], stored[row] + dissipation[row], 1e-17) << "row " << row;  // last bits of 0.06
    EXPECT_GE(stored[row], 0.0) << "row " << row;
  }
}

TEST(MdrWork, IsTheAreaUnderTheForces) {
  // Integrates the history's own forces over its displacements: the only check of the work without the integrators.
  const TestRun result = run(with_points(mdr_scenario(Configuration::die, 20.0, 0.3, path({0.3, 0.2, 0.35})), 4000));
  const auto force = result.column("axial.force");
  const auto displacement = result.column("axial.displacement");
  double work = 0.0;
  for (std::size_t row = 1; row < force.size(); ++row) {
    work += (force[row] + force[row - 1]) * (displacement[row] - displacement[row - 1]);  // two walls
  }
  EXPECT_NEAR(work / result.last("work"), 1.0, 1e-6);  // second order in 4000 intervals; the unloading branch is steep
}

struct CreatedRow {
  const char* name;
  Configuration configuration;
  double modulus_over_yield;
  double displacement;
  double dissipation_over_work;  ///< the least one, or the sum of all decreases
  double printed;
};

class MdrGrowthBeforeYield : public ::testing::TestWithParam<CreatedRow> {};

TEST_P(MdrGrowthBeforeYield, CreatesEnergyAndWarns) {
  const CreatedRow& row = GetParam();
  for (const char* rule : {"gated", "seed"}) {
    const CheckedScenario scenario = with(
        mdr_scenario(row.configuration, row.modulus_over_yield, 0.3, path({row.displacement})), "radius_rule", rule);
    const TestRun result = run_finely(scenario);
    EXPECT_NEAR(least_dissipation(result), row.dissipation_over_work, row.printed) << describe(scenario);
    EXPECT_EQ(warns_of_created_energy(result), row.dissipation_over_work < -1e-6) << describe(scenario);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table, MdrGrowthBeforeYield,
    ::testing::Values(CreatedRow{"uniaxial_50", Configuration::simple, 50.0, 0.4, 0.0, 1e-15},
                      CreatedRow{"uniaxial_25", Configuration::simple, 25.0, 0.4, -6.8e-5, 5e-7},
                      CreatedRow{"uniaxial_20", Configuration::simple, 20.0, 0.4, -2.9e-4, 5e-6},
                      CreatedRow{"uniaxial_12p5", Configuration::simple, 12.5, 0.4, -3.2e-3, 5e-5},
                      CreatedRow{"uniaxial_6p25", Configuration::simple, 6.25, 0.4, -5.4e-2, 5e-4},
                      CreatedRow{"die_20", Configuration::die, 20.0, 0.4, -2.9e-4, 5e-6},
                      CreatedRow{"die_6p25", Configuration::die, 6.25, 0.4, -5.5e-2, 5e-4},
                      CreatedRow{"hydrostatic_20", Configuration::hydrostatic, 20.0, 0.2, -2.8e-3, 5e-5},
                      CreatedRow{"hydrostatic_10", Configuration::hydrostatic, 10.0, 0.2, -0.10, 5e-3},
                      CreatedRow{"hydrostatic_6p25", Configuration::hydrostatic, 6.25, 0.2, -0.59, 5e-3}),
    [](const auto& test) { return std::string(test.param.name); });

struct AtYieldRow {
  double modulus_over_yield;
  double dissipation_over_work;
  double printed;
};

TEST(MdrGrowthBeforeYieldOfAPair, CreatesAShareOfTheWorkAtYield) {
  for (const AtYieldRow& row : {AtYieldRow{25.0, -0.008, 5e-4}, AtYieldRow{20.0, -0.017, 5e-4},
                                AtYieldRow{12.5, -0.051, 5e-4}, AtYieldRow{6.25, -0.166, 5e-4}}) {
    const CheckedScenario scenario = mdr_scenario(Configuration::simple, row.modulus_over_yield, 0.3, path({0.4}));
    const TestRun result = run_finely(scenario);
    // The dissipation is least just before yield, which sets part of the stored energy free.
    const auto dissipation = result.column("dissipation");
    const double work = result.at_event("yield", "work");
    EXPECT_NEAR(*std::ranges::min_element(dissipation) / work, row.dissipation_over_work, row.printed)
        << describe(scenario);
  }
}

TEST(MdrElasticCycle, ReturnsMoreThanItTookWhereTheRadiusGrows) {
  const TestRun result = run(mdr_scenario(Configuration::hydrostatic, 6.25, 0.3, path({0.2, 0.0})));
  const auto work = result.outputs("work");
  EXPECT_NEAR(work.back() / work[50], -0.55, 5e-3);
}

TEST(MdrElasticCycle, CreatesEnergyEveryTimeWithTheRuleOfTheSeed) {
  const CheckedScenario scenario = mdr_scenario(Configuration::simple, 50.0, 0.3, path({0.012, 0.0, 0.012, 0.0}));
  const auto seed = run(with(scenario, "radius_rule", "seed")).outputs("work");
  EXPECT_NEAR(seed[100] / seed[50], -0.004, 5e-4);
  EXPECT_NEAR((seed[200] - seed[100]) / seed[50], -0.004, 5e-4);
  for (const char* rule : {"gated", "yielded"}) {
    EXPECT_EQ(run(with(scenario, "radius_rule", rule)).last("work"), 0.0) << rule;
  }
}

TEST(MdrPlasticCycle, DissipatesSpuriouslyWithTheRuleOfTheSeedOnly) {
  const CheckedScenario scenario = mdr_scenario(Configuration::simple, 20.0, 0.3, path({0.30, 0.25, 0.30}));
  const auto gained = [&](const char* rule) {
    const TestRun result = run(with(scenario, "radius_rule", rule));
    const auto dissipation = result.outputs("dissipation");
    return (dissipation[150] - dissipation[50]) / result.outputs("work")[50];
  };
  EXPECT_NEAR(gained("seed"), 2.0e-2, 5e-4);
  EXPECT_NEAR(gained("gated"), 0.0, 1e-15);
  EXPECT_NEAR(gained("yielded"), 0.0, 1e-15);
}

}  // namespace
}  // namespace monograin::dissipation_test
