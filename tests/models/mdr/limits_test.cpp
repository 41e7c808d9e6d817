// Limits of the MDR model, and how a run reports them.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenario/scenario.hpp"
#include "support/test_run.hpp"

namespace monograin::limits_test {
namespace {

CheckedScenario die_to(double displacement) {
  return mdr_scenario(Configuration::die, 20.0, 0.3, path({displacement}));
}
CheckedScenario hydrostatic_to(double displacement) {
  return mdr_scenario(Configuration::hydrostatic, 20.0, 0.3, path({displacement}));
}

CheckedScenario strict(CheckedScenario scenario) {
  scenario.options["strict"] = true;
  return scenario;
}

bool warns(const TestRun& result, std::string_view words) {
  for (const std::string& warning : result.record.warnings) {
    if (warning.find(words) != std::string::npos) return true;
  }
  return false;
}

TEST(MdrCaps, IntersectWhereTheTableSays) {
  constexpr double k_printed = 1e-12;  // digits of the table
  EXPECT_NEAR(run(die_to(0.45)).at_event("caps-intersect", "axial.displacement"), 0.438125765118, k_printed);
  EXPECT_NEAR(run(hydrostatic_to(0.2026)).at_event("caps-intersect", "axial.displacement"), 0.202502982795, k_printed);
}

/// Two rigid walls whose normals are `angle` apart and one from the other side, against a particle of R0 = 1. The
/// particle yields too late to grow before the caps of the walls meet.
CheckedScenario walls_apart_by(double angle, double displacement) {
  return parse_scenario(fmt::format(R"(model = "mdr"
particle = {{ radius = 1 }}
material = {{ youngs_modulus = 1e9, poisson_ratio = 0.3, yield_stress = 1e9 }}
mdr = {{ strict = true }}
[loading]
configuration = "walls"
[[loading.wall]]
name = "first"
normal = [{:.17g}, 0, {:.17g}]
steps = [{{ displacement = {:.17g}, duration = 1 }}]
[[loading.wall]]
name = "second"
normal = [{:.17g}, 0, {:.17g}]
steps = [{{ displacement = {:.17g}, duration = 1 }}]
)",
                                    std::sin(0.5 * angle), std::cos(0.5 * angle), displacement, -std::sin(0.5 * angle),
                                    std::cos(0.5 * angle), displacement),
                        "apart.toml");
}

// Each cap covers half the angle between the normals: sin(angle/4)^2 = overlap/(2 R).
TEST(MdrCaps, IntersectWhereTheirAnglesAddUpToThatOfTheWallsHoweverSmall) {
  for (const double angle : {1.0, 1e-1, 1e-2, 1e-3, 1e-4}) {
    const double overlap = 2.0 * std::pow(std::sin(0.25 * angle), 2);
    const TestRun result = run(walls_apart_by(angle, 1.5 * overlap));
    EXPECT_EQ(result.record.limit, Limit::caps_intersect) << angle << ": " << result.record.message;
    EXPECT_NEAR(result.last("first.overlap") / overlap, 1.0, 1e-12 + 1e-15 / overlap) << angle;
  }
}

TEST(MdrCaps, WarnAndGoOn) {
  const TestRun result = run(die_to(0.45));
  EXPECT_EQ(result.record.status, RunStatus::complete);
  EXPECT_TRUE(warns(result, "contact caps intersect"));
  EXPECT_FALSE(warns(run(die_to(0.43)), "contact caps intersect"));
}

TEST(MdrCaps, StopAStrictRun) {
  for (const char* integrator : k_integrators) {
    const TestRun result = run(strict(die_to(0.45)), integrator);
    EXPECT_EQ(result.record.status, RunStatus::stopped) << integrator;
    EXPECT_NE(result.record.message.find("contact caps intersect"), std::string::npos) << result.record.message;
    EXPECT_EQ(result.events().back(), "axial/lateral:caps-intersect") << integrator;
    EXPECT_NEAR(result.last("axial.displacement"), 0.438125765118, 1e-7) << integrator;  // ten rtol
  }
}

TEST(MdrCaps, AreReportedOncePerPair) {
  const TestRun result = run(mdr_scenario(Configuration::die, 20.0, 0.3, path({0.44, 0.435, 0.445})));
  int count = 0;
  for (const std::string& event : result.events()) count += event == "axial/lateral:caps-intersect" ? 1 : 0;
  EXPECT_EQ(count, 1);
}

TEST(MdrCaps, AreReportedAgainWhenTheyHavePartedAndMeetAgain) {
  for (const char* integrator : k_integrators) {
    const TestRun result = run(mdr_scenario(Configuration::die, 20.0, 0.3, path({0.44, 0.3, 0.445})), integrator);
    EXPECT_EQ(std::ranges::count(result.events(), "axial/lateral:caps-intersect"), 2) << integrator;
  }
}

TEST(MdrCaps, OfOneClassAreReportedWithItsNameOnce) {
  const std::vector<std::string> events = run(hydrostatic_to(0.2026)).events();
  EXPECT_EQ(std::ranges::count(events, "axial:caps-intersect"), 1);
}

TEST(MdrSingularGrowth, StopsTheRunWithItsHistory) {
  for (const char* integrator : k_integrators) {
    for (const CheckedScenario& scenario :
         {hydrostatic_to(0.22), mdr_scenario(Configuration::die, 200.0, 0.3, path({0.48}))}) {
      const TestRun result = run(scenario, integrator);
      EXPECT_EQ(result.record.status, RunStatus::stopped) << integrator << ", " << describe(scenario);
      EXPECT_EQ(result.events().back(), "singular-growth") << integrator << ", " << describe(scenario);
      EXPECT_NE(result.record.message.find("free surface"), std::string::npos) << result.record.message;
      EXPECT_GT(result.record.history.row_count(), 40u) << integrator << ", " << describe(scenario);
      // The fold: sum of the overlaps 2R less a thousandth, lowered a little by the elastic volume.
      EXPECT_GT(result.last("axial.displacement"), 0.18) << integrator << ", " << describe(scenario);
    }
  }
}

TEST(MdrSingularGrowth, StopsAtOneStateUnderEveryControl) {
  for (const Configuration configuration : {Configuration::die, Configuration::hydrostatic}) {
    for (const char* rule : {"yielded", "gated"}) {
      const auto pressed_by = [&](const Step& step) {
        return with(mdr_scenario(configuration, 100.0, 0.3, {step}), "radius_rule", rule);
      };
      const TestRun expected = run(pressed_by(ramp(0.6)));
      ASSERT_EQ(expected.events().back(), "singular-growth") << rule;
      const double force = expected.last("axial.force");
      for (const char* integrator : k_integrators) {
        // Twice the force that the particle carries there.
        const TestRun result = run(pressed_by(force_ramp(2.0 * force)), integrator);
        EXPECT_EQ(result.record.status, RunStatus::stopped) << integrator << ", " << rule;
        EXPECT_EQ(result.events().back(), "singular-growth") << integrator << ", " << rule;
        EXPECT_NEAR(result.last("axial.force") / force, 1.0, 1e-7) << integrator << ", " << rule;
        EXPECT_NEAR(result.last("axial.displacement"), expected.last("axial.displacement"), 1e-7)
            << integrator << ", " << rule;
      }
    }
  }
}

TEST(MdrForce, NeverTakesWallsBackWhileItGrows) {
  // Beyond the end of the free surface the walls would retreat, and the particle would return two thirds of its work.
  const TestRun result = run(with(mdr_scenario(Configuration::die, 100.0, 0.3, {force_ramp(0.07)}), "elastic_profile",
                                  "parabola"));  // the ellipse gives way at yield
  const std::vector<double> displacement = result.column("axial.displacement");
  for (std::size_t row = 1; row < displacement.size(); ++row) {
    EXPECT_GE(displacement[row], displacement[row - 1] - 1e-14) << "row " << row;
  }
  EXPECT_GE(lost_dissipation(result), -2e-4);  // all of it next to that end
}

TEST(MdrGreatestForce, EndsARunAtOnePlaceInAllFormsAndUnits) {
  CheckedScenario scenario = mdr_scenario(Configuration::simple, 100.0, 0.3, {force_ramp(0.4)});
  const TestRun expected = run(scenario);
  ASSERT_EQ(expected.events().back(), "axial:limit");
  ASSERT_NE(expected.record.message.find("largest that a plastic contact bears"), std::string::npos);
  const double end = expected.last("time");
  for (const char* integrator : k_integrators) {
    const TestRun result = run(scenario, integrator);
    EXPECT_EQ(result.events().back(), "axial:limit") << integrator;
    EXPECT_NEAR(result.last("time") / end, 1.0, 1e-6) << integrator;  // a hundred rtol
  }
  for (const double size : {37e-6, 7.0}) {
    scenario.radius = size;
    scenario.loading.steps = {force_ramp(0.4 * size * size)};
    EXPECT_NEAR(run(scenario).last("time") / end, 1.0, 1e-12) << size;
  }
}

TEST(MdrGreatestForce, RefusesAForceThatGrowsBeyondIt) {
  const TestRun result = run(mdr_scenario(Configuration::simple, 100.0, 0.3, {ramp(0.95), force_ramp(5.0)}));
  EXPECT_EQ(result.record.status, RunStatus::stopped);
  EXPECT_NE(result.record.message.find("step 2"), std::string::npos) << result.record.message;
  EXPECT_NE(result.record.message.find("largest that a plastic contact bears"), std::string::npos)
      << result.record.message;
}

TEST(MdrWallAtCentre, EndsARunAThousandthOfTheRadiusBefore) {
  // A particle that never yields, and so does not grow.
  const auto pressed_to = [](double displacement) {
    return with(mdr_scenario(Configuration::simple, 2.0, 0.3, {ramp(displacement)}), "radius_rule", "yielded");
  };
  for (const char* integrator : k_integrators) {
    const TestRun result = run(pressed_to(0.9995), integrator);
    EXPECT_EQ(result.record.limit, Limit::wall_at_centre) << integrator << ": " << result.record.message;
    EXPECT_NEAR(result.last("axial.displacement"), 0.999, 1e-12) << integrator;
  }
  EXPECT_EQ(run(pressed_to(0.9985)).record.status, RunStatus::complete);
}

TEST(MdrVolume, BelowHalfStopsTheRun) {
  for (const double modulus_over_yield : {5.0, 8.0, 10.0}) {
    for (const char* integrator : k_integrators) {
      const TestRun result =
          run(mdr_scenario(Configuration::hydrostatic, modulus_over_yield, 0.0, path({0.5})), integrator);
      EXPECT_EQ(result.record.status, RunStatus::stopped) << integrator << ", E/Y = " << modulus_over_yield;
      EXPECT_EQ(result.events().back(), "volume-limit") << integrator << ", E/Y = " << modulus_over_yield;
      // Stops at 1 - 4w = 1e-6, where V/V0 = (1 + 1e-3)/2.
      EXPECT_NEAR(result.last("volume") / (4.0 / 3.0 * std::numbers::pi), 0.5005, 1e-5)
          << integrator << ", E/Y = " << modulus_over_yield;
    }
  }
}

TEST(MdrVolume, FeedbackOnTheRadiusIsStable) {
  const CheckedScenario scenario = mdr_scenario(Configuration::hydrostatic, 8.0, 0.0, path({0.27}));
  EXPECT_NEAR(run(scenario).last("apparent_radius"), 1.029865077150424, 5e-16);  // printed digits
  for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
    for (const double rtol : {1e-6, 1e-8, 1e-10}) {
      const double radius = run(scenario, integrator, relative(rtol)).last("apparent_radius");
      EXPECT_NEAR(radius, 1.029865077150424, rtol) << integrator << ", rtol = " << rtol;
    }
  }
}

TEST(MdrWarnings, NameMaterialsBeyondTheModel) {
  const auto warns_of = [](double modulus_over_yield) {
    return warns(run(mdr_scenario(Configuration::simple, modulus_over_yield, 0.3, path({0.1}))),
                 "elastic strains are not small");
  };
  EXPECT_TRUE(warns_of(8.0));
  EXPECT_TRUE(warns_of(9.99));
  EXPECT_FALSE(warns_of(10.01));
}

TEST(MdrWarnings, TellThatAMaterialNeverYields) {
  // E*/Y = 2.2, below 2.407.
  const TestRun result = run(mdr_scenario(Configuration::simple, 2.0, 0.3, path({0.4})));
  EXPECT_TRUE(warns(result, "too compliant to yield"));
  EXPECT_FALSE(result.has_event("yield"));
}

}  // namespace
}  // namespace monograin::limits_test
