#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "scene/scene.hpp"
#include "support/test_run.hpp"

namespace monograin::nonlocal_model_test {
namespace {

using std::numbers::pi;

CheckedScenario scenario_of(Configuration configuration, const std::string& terms, int oblique_walls = 2,
                            double poisson_ratio = 0.48) {
  CheckedScenario scenario = hertz_scenario(configuration, {ramp(0.1)});
  scenario.model = "nonlocal";
  scenario.material["poisson_ratio"] = poisson_ratio;
  scenario.loading.oblique_angle = 37.5 * pi / 180.0;
  scenario.loading.oblique_walls = oblique_walls;
  scenario.options = {
      {"terms", terms}, {"contact_radius_rule", std::string("closed")}, {"influence", std::string("half-space")}};
  return scenario;
}

/// Displacement over R0 of the first driven wall at the limit of applicability.
std::optional<double> limit_of(const CheckedScenario& scenario) {
  for (const DerivedParameter& parameter : derived_parameters(scenario)) {
    if (parameter.name != "limit_displacement") continue;
    return std::isfinite(parameter.value) ? std::optional(parameter.value / scenario.radius) : std::nullopt;
  }
  return std::nullopt;
}

struct Limit {
  Configuration configuration;
  int oblique_walls;
  const char* terms;
  double displacement;  ///< over R0
  double tolerance;     ///< of its printed digits
};

// Computed elsewhere with 30 digits, printed to different numbers of them.
constexpr Limit k_limits[] = {
    {Configuration::die, 2, "1", 0.394681111829, 5e-13},
    {Configuration::die, 2, "4", 0.459654454112, 5e-13},
    {Configuration::die, 2, "inf", 0.46298916, 5e-9},
    {Configuration::hydrostatic, 2, "1", 0.156081976018, 5e-13},
    {Configuration::hydrostatic, 2, "4", 0.174395263463, 5e-13},
    {Configuration::hydrostatic, 2, "inf", 0.17473615, 5e-9},
    {Configuration::oblique_die, 2, "1", 0.383616904238, 5e-13},
    {Configuration::oblique_die, 2, "4", 0.442640721165, 5e-13},
    {Configuration::oblique_die, 2, "inf", 0.44529519, 5e-9},
    {Configuration::oblique_die, 4, "1", 0.367953129, 5e-10},
    {Configuration::oblique_die, 4, "4", 0.418232019, 5e-10},
    {Configuration::oblique_die, 4, "inf", 0.42001749, 5e-9},
    {Configuration::simple, 2, "1", 0.8550368544, 5e-11},
};

TEST(NonlocalLimitOfAScenario, IsTheOneComputedElsewhere) {
  for (const auto& [configuration, walls, terms, expected, tolerance] : k_limits) {
    const auto limit = limit_of(scenario_of(configuration, terms, walls));
    ASSERT_TRUE(limit) << terms;
    EXPECT_NEAR(*limit, expected, tolerance + 1e-13) << terms << " " << walls;
  }
}

TEST(NonlocalLimitOfAScenario, DoesNotDependOnHowFarTheProgramGoes) {
  CheckedScenario scenario = scenario_of(Configuration::die, "4");
  const double limit = *limit_of(scenario);
  for (const double target : {1e-10, 1e-3, 0.3, 0.9}) {
    scenario.loading.steps = {ramp(target)};
    EXPECT_NEAR(*limit_of(scenario), limit, 1e-13) << target;
  }
}

TEST(NonlocalLimitOfAScenario, IsNoneWhereTheWallsMeetOrAForceIsPrescribedOrNothingMoves) {
  EXPECT_FALSE(limit_of(scenario_of(Configuration::simple, "4")));
  EXPECT_FALSE(limit_of(scenario_of(Configuration::die, "inf", 2, 0.1))) << "as wide as the particle before";
  CheckedScenario scenario = scenario_of(Configuration::die, "4");
  scenario.loading.steps = {force_ramp(0.1)};
  EXPECT_FALSE(limit_of(scenario));
  scenario.loading.steps = {hold()};
  EXPECT_FALSE(limit_of(scenario));
}

}  // namespace
}  // namespace monograin::nonlocal_model_test
