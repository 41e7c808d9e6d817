// Growth of the apparent radius, the largest overlap during growth, and agreement of all forms of the equations about
// both.

#include <gtest/gtest.h>

#include <algorithm>

#include "support/test_run.hpp"

namespace monograin::modes_test {
namespace {

constexpr const char* k_radius_rules[] = {"gated", "yielded", "seed"};

/// One pair of walls advances and retreats a little. A second pair then makes R grow while the first one retreats
/// further. At last both advance. All walls touch from the start.
CheckedScenario one_pair_retreats(double modulus_over_yield, double poisson_ratio) {
  const auto first = path({0.20, 0.198, 0.197, 0.25});
  const auto second = path({0.0, 0.0, 0.20, 0.25});
  return between(mdr_scenario(Configuration::walls, modulus_over_yield, poisson_ratio, {}),
                 {wall("x+", {1, 0, 0}, first), wall("x-", {-1, 0, 0}, first), wall("y+", {0, 1, 0}, second),
                  wall("y-", {0, -1, 0}, second)});
}

std::vector<double> radii_at_step_ends(const TestRun& result, std::size_t points = 50) {
  const auto radius = result.outputs("apparent_radius");
  std::vector<double> ends;
  for (std::size_t row = points; row < radius.size(); row += points) ends.push_back(radius[row]);
  return ends;
}

TEST(MdrRadius, NeverShrinks) {
  // IDA solves even for a constant radius anew at every step, to its tolerance; 5e-11 measured at rtol 1e-8.
  const auto largest_drop = [](const char* integrator) { return std::string_view(integrator) == "ida" ? 2e-10 : 0.0; };
  for (const char* rule : k_radius_rules) {
    const CheckedScenario scenarios[] = {
        mdr_scenario(Configuration::die, 20.0, 0.3, path({0.3, 0.0, 0.35, 0.34, 0.36})),
        mdr_scenario(Configuration::simple, 6.25, 0.45, path({0.3, 0.2, 0.3, 0.0, 0.4})),
        mdr_scenario(Configuration::hydrostatic, 50.0, 0.0, path({0.15, 0.1, 0.17})), one_pair_retreats(20.0, 0.3)};
    for (const CheckedScenario& scenario : scenarios) {
      for (const char* integrator : k_integrators) {
        const auto radius = run(with(scenario, "radius_rule", rule), integrator).column("apparent_radius");
        for (std::size_t row = 1; row < radius.size(); ++row) {
          EXPECT_GE(radius[row], radius[row - 1] - largest_drop(integrator))
              << integrator << ", row " << row << ", " << describe(with(scenario, "radius_rule", rule));
        }
      }
    }
  }
}

TEST(MdrRadius, RestsInElasticCyclesUnlessTheRuleIsTheSeeds) {
  for (const char* rule : {"gated", "yielded"}) {
    const auto plastic = radii_at_step_ends(run(with(
        mdr_scenario(Configuration::simple, 20.0, 0.3, path({0.30, 0.25, 0.30, 0.25, 0.30})), "radius_rule", rule)));
    for (const double radius : plastic) EXPECT_EQ(radius, plastic.front()) << rule;
    const auto elastic = radii_at_step_ends(
        run(with(mdr_scenario(Configuration::simple, 50.0, 0.3, path({0.012, 0.0, 0.012, 0.0})), "radius_rule", rule)));
    for (const double radius : elastic) EXPECT_EQ(radius, 1.0) << rule;
  }
}

TEST(MdrRadius, RatchetsInPlasticCyclesWithTheRuleOfTheSeed) {
  const CheckedScenario scenario =
      with(mdr_scenario(Configuration::simple, 20.0, 0.3, path({0.30, 0.25, 0.30, 0.25, 0.30, 0.25, 0.30})),
           "radius_rule", "seed");
  for (const char* integrator : k_integrators) {
    const auto radii = radii_at_step_ends(run(scenario, integrator));
    const double expected[] = {1.04888, 1.05624, 1.06373, 1.07135};
    for (std::size_t cycle = 0; cycle < 4; ++cycle) {
      EXPECT_NEAR(radii[2 * cycle], expected[cycle], 5e-6) << integrator << ", cycle " << cycle;  // printed digits
    }
  }
}

TEST(MdrRadius, RatchetsInElasticCyclesWithTheRuleOfTheSeed) {
  const CheckedScenario scenario = mdr_scenario(Configuration::simple, 50.0, 0.3, path({0.012, 0.0, 0.012, 0.0}));
  const auto radii = radii_at_step_ends(run(with(scenario, "radius_rule", "seed")));
  EXPECT_EQ(radii[0], 1.0);
  EXPECT_NEAR(radii[1], 1.0000493, 5e-8);          // printed digits
  EXPECT_NEAR(radii[3] - radii[1], 4.9e-5, 5e-7);  // the same again
}

TEST(MdrRadius, OfGatedIsThatOfTheSeedOnMonotonicPaths) {
  for (const auto configuration : {Configuration::simple, Configuration::die, Configuration::hydrostatic}) {
    for (const double modulus_over_yield : {12.5, 50.0, 200.0}) {
      const CheckedScenario scenario = mdr_scenario(configuration, modulus_over_yield, 0.3, path({0.15}));
      EXPECT_EQ(difference(run(with(scenario, "radius_rule", "seed")), run(scenario)), 0.0) << describe(scenario);
    }
  }
}

struct DeviationRow {
  double modulus_over_yield;
  double deviation;  ///< of the force of `yielded` from that of `gated` at delta_o = 0.4
  double printed;
};

TEST(MdrRadius, OfYieldedLowersTheForceOfSoftMaterials) {
  for (const DeviationRow& row : {DeviationRow{25.0, -0.0006, 5e-5}, DeviationRow{20.0, -0.002, 5e-4},
                                  DeviationRow{12.5, -0.013, 5e-4}, DeviationRow{6.25, -0.09, 5e-3}}) {
    const CheckedScenario scenario = mdr_scenario(Configuration::simple, row.modulus_over_yield, 0.3, path({0.4}));
    const double yielded = run(with(scenario, "radius_rule", "yielded")).last("axial.force");
    EXPECT_NEAR(yielded / run(scenario).last("axial.force") - 1.0, row.deviation, row.printed) << describe(scenario);
  }
}

TEST(MdrRadius, GrowsFromFirstTouchWhereTheMaterialIsIncompressible) {
  for (const char* rule : {"gated", "seed"}) {
    const TestRun result = run(with(mdr_scenario(Configuration::die, 50.0, 0.5, path({0.1})), "radius_rule", rule));
    EXPECT_EQ(result.time_of("growth-on"), 0.0) << rule;
    EXPECT_EQ(result.time_of("contact-made"), 0.0) << rule;
  }
}

TEST(MdrRadius, StartsToGrowInTheSameInstantInAllFormsWhereItStartsEarly) {
  // Almost incompressible: growth begins within 1e-4 of the step, where its guard has just left zero.
  for (const double poisson_ratio : {0.45, 0.48, 0.49}) {
    for (const char* rule : {"gated", "seed"}) {
      const CheckedScenario scenario =
          with(mdr_scenario(Configuration::hydrostatic, 50.0, poisson_ratio, path({0.16})), "radius_rule", rule);
      const TestRun direct = run(scenario);
      EXPECT_LT(direct.time_of("growth-on"), 1.0 / 32.0) << describe(scenario);
      for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
        const TestRun integrated = run(scenario, integrator);
        EXPECT_EQ(integrated.events(), direct.events()) << integrator << ", " << describe(scenario);
        EXPECT_NEAR(integrated.time_of("growth-on"), direct.time_of("growth-on"), 1e-12)
            << integrator << ", " << describe(scenario);
      }
    }
  }
}

TEST(MdrRadius, RestsWhileTheAxialWallsOfADieRetreat) {
  for (const char* rule : k_radius_rules) {
    const TestRun result =
        run(with(mdr_scenario(Configuration::die, 20.0, 0.3, path({0.4, 0.3})), "radius_rule", rule));
    const auto radius = result.outputs("apparent_radius");
    for (std::size_t row = 50; row < radius.size(); ++row)
      EXPECT_EQ(radius[row], radius[50]) << rule << ", row " << row;
  }
}

// --- largest overlap

TEST(MdrDeltaMaxRule, DoesNotMatterWhereAllContactsLoadTogether) {
  for (const auto configuration : {Configuration::simple, Configuration::hydrostatic}) {
    const CheckedScenario scenario = mdr_scenario(configuration, 20.0, 0.3, path({0.17, 0.16, 0.18, 0.17, 0.18}));
    const TestRun shifted = run(with(scenario, "delta_max_rule", "shifted"));
    EXPECT_LE(difference(shifted, run(scenario)), 1e-13) << describe(scenario);  // the same formulas up to rounding
  }
}

TEST(MdrDeltaMaxRule, MattersWhereTheRadiusGrowsOverAnUnloadedContact) {
  const CheckedScenario scenario = one_pair_retreats(20.0, 0.3);
  const TestRun running = run(scenario);
  const TestRun shifted = run(with(scenario, "delta_max_rule", "shifted"));
  // Growth carries the first pair beyond its running maximum; shifted with R, the maximum keeps ahead of it.
  EXPECT_LT(running.time_of("reload"), 3.0);
  EXPECT_GT(shifted.time_of("reload"), 3.0);
  EXPECT_GT(difference(shifted.outputs("x+.force"), running.outputs("x+.force")), 0.01);
}

// --- forms

class MdrForms : public ::testing::TestWithParam<std::tuple<const char*, const char*, const char*>> {};

TEST_P(MdrForms, Agree) {
  const auto [radius_rule, profile, delta_max_rule] = GetParam();
  for (CheckedScenario scenario : {mdr_scenario(Configuration::die, 20.0, 0.3, path({0.3, 0.25, 0.35})),
                                   one_pair_retreats(20.0, 0.3), one_pair_retreats(100.0, 0.1)}) {
    scenario = with(with(with(scenario, "radius_rule", radius_rule), "elastic_profile", profile), "delta_max_rule",
                    delta_max_rule);
    const TestRun direct = run(scenario);
    ASSERT_EQ(direct.record.status, RunStatus::complete) << direct.record.message;
    for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
      const TestRun integrated = run(scenario, integrator);
      // 4.4e-8 measured: some rtol, on the steep unloading branch.
      EXPECT_EQ(integrated.events(), direct.events()) << integrator << ", " << describe(scenario);
      EXPECT_LE(difference(integrated, direct), 1.5e-7) << integrator << ", " << describe(scenario);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllRules, MdrForms,
                         ::testing::Combine(::testing::ValuesIn(k_radius_rules),
                                            ::testing::Values("ellipse", "parabola"),
                                            ::testing::Values("running-maximum", "shifted")),
                         [](const auto& test) {
                           std::string name = std::string(std::get<0>(test.param)) + "_" + std::get<1>(test.param) +
                                              "_" + std::get<2>(test.param);
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST(MdrForms, AgreeWhereGrowthStartsAlmostAtFirstTouch) {
  // Near nu = 0.5 the drive of growth falls below zero and returns after 3e-8 of the step.
  for (const Configuration configuration : {Configuration::simple, Configuration::die, Configuration::hydrostatic}) {
    const CheckedScenario scenario = mdr_scenario(configuration, 10.7, 0.4999, path({0.15, 0.12, 0.16}));
    const TestRun direct = run(scenario);
    ASSERT_EQ(direct.record.status, RunStatus::complete) << direct.record.message;
    EXPECT_EQ(direct.events().front(), "growth-on") << describe(scenario);
    EXPECT_LT(direct.time_of("growth-on"), 1e-6) << describe(scenario);
    for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
      const TestRun integrated = run(scenario, integrator);
      EXPECT_EQ(integrated.events(), direct.events()) << integrator << ", " << describe(scenario);
      EXPECT_LE(difference(integrated, direct), 1.5e-7) << integrator << ", " << describe(scenario);
    }
  }
}

TEST(MdrForms, AgreeWhereAStiffContactUnloadsWhileTheRadiusGrows) {
  // A piece of the direct solution is a hundred times as long as the unloading branch, which Newton's method leaves at
  // first.
  const CheckedScenario scenario =
      with(mdr_scenario(Configuration::hydrostatic, 15694.0, -0.5, path({0.172, 0.098, 0.102})), "radius_rule", "seed");
  const TestRun direct = run(scenario);
  ASSERT_EQ(direct.record.status, RunStatus::complete) << direct.record.message;
  const TestRun integrated = run(scenario, "cvode-adams");
  EXPECT_EQ(integrated.events(), direct.events());
  EXPECT_LE(difference(integrated, direct), 1e-6);
}

}  // namespace
}  // namespace monograin::modes_test
