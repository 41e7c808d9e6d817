// The model `hertz` as a scene: Hertz contacts at fixed radius.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "elastic/hertz.hpp"
#include "models/accuracy.hpp"
#include "support/test_run.hpp"

namespace monograin::hertz_system_test {
namespace {

TEST(HertzScene, ForceIsThatOfHertzInEveryRow) {
  for (const auto configuration : {Configuration::simple, Configuration::die, Configuration::hydrostatic}) {
    for (const char* integrator : k_integrators) {
      const TestRun result = run(hertz_scenario(configuration, path({0.2, -0.1, 0.3})), integrator);
      const auto displacement = result.column("axial.displacement");
      const auto force = result.column("axial.force");
      for (std::size_t row = 0; row < force.size(); ++row) {
        const double expected = hertz_force(composite_modulus(1.0, 0.3), 1.0, displacement[row]);
        EXPECT_NEAR(force[row], expected, 8 * k_epsilon * expected + 1e-20) << integrator << ", row " << row;
      }
    }
  }
}

TEST(HertzScene, WorkIsStored) {
  for (const char* integrator : k_integrators) {
    const TestRun result = run(hertz_scenario(Configuration::simple, path({0.2, -0.1, 0.3})), integrator);
    const auto work = result.column("work");
    const auto stored = result.column("stored_energy");
    const double tolerance = std::string_view(integrator) == "direct" ? 4 * k_epsilon : 1e-7;  // some rtol
    for (std::size_t row = 0; row < work.size(); ++row) {
      EXPECT_NEAR(work[row], stored[row], tolerance * largest(work)) << integrator << ", row " << row;
    }
  }
}

TEST(HertzScene, WallWithAGapTouchesAndLeavesAtTheUndeformedSurface) {
  const auto steps = path({0.3, -0.2});
  const CheckedScenario scenario =
      between(hertz_scenario(Configuration::walls, {}),
              {wall("top", {0, 0, 1}, steps, 0.1), wall("bottom", {0, 0, -1}, steps, 0.1)});
  for (const char* integrator : k_integrators) {
    const TestRun result = run(scenario, integrator);
    EXPECT_EQ(result.events(), (std::vector<std::string>{"top:contact-made", "top:load-reversal", "top:contact-lost"}))
        << integrator;
    EXPECT_EQ(result.outputs("top.displacement").front(), -0.1);
    EXPECT_NEAR(result.time_of("contact-made"), 0.25, 1e-14) << integrator;  // linear: any root finder's last bits
    EXPECT_NEAR(result.time_of("contact-lost"), 1.6, 1e-14) << integrator;
    EXPECT_NEAR(result.at_event("contact-made", "top.displacement"), 0.0, 1e-14) << integrator;
  }
}

TEST(HertzScene, HasTheRegimesOpenAndElasticOnly) {
  const TestRun result = run(hertz_scenario(Configuration::die, path({0.2, -0.1, 0.3})));
  const Table& history = result.record.history;
  std::set<std::string> regimes;
  for (std::size_t row = 0; row < history.row_count(); ++row) {
    regimes.emplace(history.word(row, *history.find("axial.regime")));
    EXPECT_EQ(history.word(row, *history.find("lateral.regime")), "open") << "row " << row;
  }
  EXPECT_EQ(regimes, (std::set<std::string>{"open", "elastic"}));
  EXPECT_FALSE(history.find("apparent_radius").has_value());
}

TEST(HertzScene, StopsWhereAWallReachesTheCentre) {
  for (const char* integrator : k_integrators) {
    const TestRun result = run(hertz_scenario(Configuration::simple, path({1.2})), integrator);
    EXPECT_EQ(result.record.status, RunStatus::stopped) << integrator;
    EXPECT_EQ(result.events().back(), "axial:limit") << integrator;
    EXPECT_NE(result.record.message.find("centre"), std::string::npos) << result.record.message;
  }
}

}  // namespace
}  // namespace monograin::hertz_system_test
