// Every integrator on systems of every kind gives the curves and events of the direct form.

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "engine/integrator.hpp"
#include "scenario/scenario.hpp"
#include "support/test_run.hpp"

namespace monograin::integrators_test {
namespace {

const char* const k_scenes[] = {"die",      "adhesion",  "force",    "cycles", "late-wall",
                                "semimech", "hardening", "nonlocal", "hertz"};

CheckedScenario scene(const std::string& name) {
  CheckedScenario scenario = read_scenario(MONOGRAIN_SOURCE_DIR "/scenarios/" + name + ".toml");
  scenario.output.points = 20;
  return scenario;
}

class AnyIntegrator : public ::testing::TestWithParam<std::string_view> {};

TEST_P(AnyIntegrator, GivesTheCurvesAndEventsOfTheDirectForm) {
  const std::string name(GetParam());
  for (const char* const label : k_scenes) {
    SCOPED_TRACE(label);
    const TestRun direct = run(scene(label));
    const TestRun now = run(scene(label), name);
    ASSERT_EQ(now.record.status, RunStatus::complete) << now.record.message;
    EXPECT_EQ(now.events(), direct.events());
    const std::string force = now.scene.classes.front().name + ".force";
    EXPECT_LE(difference(now.outputs(force), direct.outputs(force)), 1e-6);
    EXPECT_LE(difference(now.outputs("work"), direct.outputs("work")), 1e-6);
  }
}

/// All integrators with error control.
std::vector<std::string_view> controlled() {
  std::vector<std::string_view> names(integrator_names().begin(), integrator_names().end());
  std::erase(names, "forward-euler");
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, AnyIntegrator, ::testing::ValuesIn(controlled()), [](const auto& tested) {
  std::string name(tested.param);
  std::erase(name, '-');
  return name;
});

TEST_P(AnyIntegrator, GetsBetterWithItsTolerance) {
  const CheckedScenario scenario = scene("die");
  const TestRun direct = run(scenario);
  for (const double rtol : {1e-4, 1e-6, 1e-8, 1e-10}) {
    const TestRun now = run(scenario, GetParam(), relative(rtol));
    EXPECT_LE(difference(now.outputs("axial.force"), direct.outputs("axial.force")), 100.0 * rtol) << rtol;
  }
}

TEST(FixedSteps, ConvergeWithTheirLength) {
  const CheckedScenario scenario = scene("die");
  const TestRun direct = run(scenario);
  double last = 1.0;
  for (const double rtol : {1e-2, 1e-3, 1e-4}) {
    const TestRun now = run(scenario, "forward-euler", relative(rtol));
    ASSERT_EQ(now.record.status, RunStatus::complete) << now.record.message;
    const double error = difference(now.outputs("axial.force"), direct.outputs("axial.force"));
    EXPECT_LT(error, 0.2 * last) << rtol;
    EXPECT_GE(static_cast<double>(now.record.statistics.steps), 3.0 / rtol);
    last = error;
  }
  EXPECT_LT(last, 1e-3);
}

/// A free centre between six walls. One wall is an idle contact: the rates jump where it opens. Where contacts begin,
/// the rates change over overlaps much smaller than the unknowns.
constexpr const char* k_touching_wall = R"(
model = "nonlocal"
particle.radius = 1e-3
material = { youngs_modulus = 4e6, poisson_ratio = 0.14 }
nonlocal = { terms = 3, contact_radius_rule = "integral" }
output.points = 20

[loading]
configuration = "walls"
centre = "equilibrium"
steps = [
  { displacement = "0.07 R0", duration = 1 },
  { displacement = 0, duration = 1 },
]
wall = [
  { name = "w0", normal = [0.584, -0.661, -0.471] },
  { name = "w1", normal = [-0.584, 0.661, 0.471], gap = "0.022 R0", fixed = true },
  { name = "w2", normal = [-0.599, 0.678, 0.426] },
  { name = "w3", normal = [0.524, -0.549, -0.651], fixed = true },
  { name = "w4", normal = [0.599, -0.678, -0.426], fixed = true },
  { name = "w5", normal = [-0.418, 0.002, -0.909] },
]
)";

double steps_of(const std::string& integrator, const Tolerances& tolerances) {
  const TestRun now = run(parse_scenario(k_touching_wall, "touching wall"), integrator, tolerances);
  EXPECT_EQ(now.record.status, RunStatus::complete) << integrator << ": " << now.record.message;
  return static_cast<double>(now.record.statistics.steps);
}

TEST(DifferenceQuotients, LeaveALinearlyImplicitMethodItsOrder) {
  const double coarse = steps_of("odeint-rosenbrock4", relative(1e-8));
  EXPECT_LT(steps_of("odeint-rosenbrock4", relative(1e-10)), std::pow(1e-8 / 1e-10, 1.0 / 4.0) * coarse);
}

TEST(DifferenceQuotients, DoNotLookPastAContactThatOpens) {
  EXPECT_LT(steps_of("cvode-bdf", {.rtol = 1e-8, .atol = 1e-17}), 2000.0);
  EXPECT_LT(steps_of("arkode-dirk", relative(1e-9)), 2000.0);
  EXPECT_LT(steps_of("gsl-msbdf", {.rtol = 1e-7, .atol = 1e-17}), 2000.0);
}

TEST(IntegratorNames, AreThoseOfScenarioFiles) {
  for (const std::string_view name : integrator_names()) {
    EXPECT_NO_THROW(static_cast<void>(
        parse_scenario(default_scenario_text(), "default", {"numerics.integrator=" + std::string(name)})))
        << name;
  }
  EXPECT_EQ(std::set(integrator_names().begin(), integrator_names().end()).size(), 14U);
}

}  // namespace
}  // namespace monograin::integrators_test
