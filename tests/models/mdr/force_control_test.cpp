// Walls under force control: alone, beside walls under displacement control, in turns with it, and with a free centre.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "elastic/hertz.hpp"
#include "models/accuracy.hpp"
#include "support/test_run.hpp"

namespace monograin::force_control_test {
namespace {

using std::numbers::pi;

const double k_modulus = composite_modulus(1.0, 0.3);  // E*

std::vector<Step> force_path(const std::vector<double>& forces) {
  std::vector<Step> steps;
  for (const double force : forces) steps.push_back(force_ramp(force));
  return steps;
}

CheckedScenario simple(std::vector<Step> steps, double modulus_over_yield = 30.0) {
  return mdr_scenario(Configuration::simple, modulus_over_yield, 0.3, std::move(steps));
}

/// Opposite pairs of walls along the axes; no steps: no such pair.
CheckedScenario pairs(const std::vector<Step>& x, const std::vector<Step>& y, const std::vector<Step>& z,
                      double modulus_over_yield = 30.0) {
  std::vector<WallSpec> walls;
  const std::vector<Step>* programs[] = {&x, &y, &z};
  for (int axis = 0; axis < 3; ++axis) {
    if (programs[axis]->empty()) continue;
    const std::string name(1, "xyz"[axis]);
    const Eigen::Vector3d normal = Eigen::Vector3d::Unit(axis);
    walls.push_back(wall(name + "+", normal, *programs[axis]));
    walls.push_back(wall(name + "-", -normal, *programs[axis]));
  }
  return between(mdr_scenario(Configuration::walls, modulus_over_yield, 0.3, {}), std::move(walls));
}

/// Values of a column at the end of every step.
std::vector<double> at_step_ends(const TestRun& result, std::string_view column) {
  const Table& table = result.record.events;
  std::vector<double> values;
  for (std::size_t i = 0; i < table.row_count(); ++i) {
    if (table.word(i, *table.find("event")) == "step-end") values.push_back(table.at(i, *table.find(column)));
  }
  return values;
}

/// Largest distance of a class's force from its program of ramps of one second, over the largest force.
double distance_from_program(const TestRun& result, const std::string& contact_class,
                             const std::vector<double>& targets) {
  const auto times = result.column("time");
  const auto steps = result.column("step");
  const auto forces = result.column(contact_class + ".force");
  double worst = 0.0;
  for (std::size_t row = 0; row < times.size(); ++row) {
    const auto step = static_cast<std::size_t>(steps[row]) - 1;
    const double start = step == 0 ? 0.0 : targets[step - 1];
    const double expected = std::lerp(start, targets[step], times[row] - static_cast<double>(step));
    if (!(std::abs(forces[row] - expected) <= worst)) worst = std::abs(forces[row] - expected);
  }
  return worst / largest(targets);
}

// --- one pair of walls

class MdrForceControl : public ::testing::TestWithParam<const char*> {};

TEST_P(MdrForceControl, MeetsThePrescribedForceInEveryRow) {
  const std::vector<double> targets{0.02, 0.01, 0.03, 0.0, 0.02, 0.035};
  for (const char* profile : {"ellipse", "parabola"}) {
    for (const char* rule : {"gated", "yielded", "seed"}) {
      const TestRun result =
          run(with(with(simple(force_path(targets)), "elastic_profile", profile), "radius_rule", rule), GetParam());
      ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
      // Round-off of the overlap over the stiffness of the unloading branch. The wall is solved for at its radius, so
      // that an integrator's errors do not show.
      EXPECT_LE(distance_from_program(result, "axial", targets), 1e-12) << profile << ", " << rule;
    }
  }
}

TEST_P(MdrForceControl, GivesWayAtOnceWhereItYields) {
  // At yield the ellipse becomes a contact that carries some tenths of a per cent more at once, so that the wall
  // retreats.
  const TestRun result = run(with_points(simple(force_path({0.02})), 2000), GetParam());
  const auto side = result.column("row");
  const auto force = result.column("axial.force");
  const auto place = result.column("axial.displacement");
  const double yield = result.time_of("yield");
  int found = 0;
  for (std::size_t row = 1; row < force.size(); ++row) {
    if (result.column("time")[row] != yield || side[row] != 1.0) continue;
    ++found;
    EXPECT_NEAR(force[row] / force[row - 1], 1.0, 1e-12);
    EXPECT_LT(place[row], place[row - 1] * 0.999);
    EXPECT_GT(place[row], place[row - 1] * 0.99);
  }
  EXPECT_EQ(found, 1);
}

TEST_P(MdrForceControl, GoesAlongTheCurveOfDisplacementControl) {
  // Twenty positions on a loading, an unloading and a reloading branch.
  std::vector<double> places;
  for (int i = 1; i <= 8; ++i) places.push_back(0.01 * i);
  for (int i = 1; i <= 5; ++i) places.push_back(0.08 - 0.001 * i);
  for (int i = 1; i <= 7; ++i) places.push_back(0.075 + 0.005 * i);
  for (const double dg : {0.0, 1e-5}) {
    CheckedScenario scenario = with(simple(path(places), 50.0), "elastic_profile", "parabola");
    scenario.material["surface_energy"] = dg;
    const TestRun by_displacement = run(scenario);
    ASSERT_EQ(by_displacement.record.status, RunStatus::complete) << by_displacement.record.message;
    const std::vector<double> forces = at_step_ends(by_displacement, "axial.force");
    scenario.loading.steps = force_path(forces);
    const TestRun by_force = run(scenario, GetParam());
    ASSERT_EQ(by_force.record.status, RunStatus::complete) << by_force.record.message;
    // 1e-13 measured with the direct solution, else the tolerance of the radius.
    const double tolerance = std::string(GetParam()) == "direct" ? 1e-12 : 1e-7;
    for (const char* column :
         {"axial.displacement", "apparent_radius", "axial.contact_radius", "stored_energy", "work"}) {
      EXPECT_LE(difference(at_step_ends(by_force, column), at_step_ends(by_displacement, column)), tolerance)
          << column << ", dg = " << dg;
    }
  }
}

TEST_P(MdrForceControl, ClosesItsCycles) {
  const TestRun result = run(simple(force_path({0.02, 0.005, 0.02, 0.005, 0.02, 0.0, 0.02})), GetParam());
  ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
  const auto place = at_step_ends(result, "axial.displacement");
  const auto dissipation = at_step_ends(result, "dissipation");
  const auto radius = at_step_ends(result, "apparent_radius");
  const double work = largest(result.column("work"));
  for (const std::size_t top : {2U, 4U, 6U}) {
    EXPECT_LE(relative_error(place[top], place[0]), 1e-13);
    EXPECT_EQ(radius[top], radius[0]);
    // No energy is dissipated below the largest overlap; an integrated work is exact to some ten rtol.
    EXPECT_NEAR(dissipation[top], dissipation[0], (std::string(GetParam()) == "direct" ? 1e-13 : 2e-6) * work);
  }
  EXPECT_LE(relative_error(place[3], place[1]), 1e-13);
}

TEST_P(MdrForceControl, LosesTheContactUnderTension) {
  const TestRun result = run(simple(force_path({0.02, -0.01, 0.01, 0.03})), GetParam());
  ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
  const double lost = result.time_of("contact-lost");
  EXPECT_NEAR(lost, 1.0 + 2.0 / 3.0, 1e-12);  // where the ramp passes zero
  const double place = result.at_event("contact-lost", "axial.displacement");
  const TestRun by_displacement = run(simple({force_ramp(0.02), ramp(0.0)}));
  EXPECT_NEAR(place, by_displacement.at_event("contact-lost", "axial.displacement"), 1e-9);
  const auto times = result.column("time");
  const auto rows = result.column("row");
  const auto forces = result.column("axial.force");
  const auto places = result.column("axial.displacement");
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!(times[i] > lost) || !(times[i] < 2.0)) continue;
    EXPECT_EQ(forces[i], 0.0) << "t = " << times[i];
    EXPECT_EQ(places[i], place) << "t = " << times[i] << ", row " << rows[i];
  }
  // The lost wall has lost its tension, too: the next ramp starts from zero at once.
  EXPECT_EQ(result.time_of("dent-touched"), 2.0);
  EXPECT_NEAR(at_step_ends(result, "axial.force")[2], 0.01, 1e-14);
  EXPECT_NEAR(result.time_of("reload"), 3.5, 1e-9);
}

TEST_P(MdrForceControl, ClosesAGapAtOnce) {
  const auto walls = [](double gap) {
    return std::vector<WallSpec>{wall("z+", Eigen::Vector3d::UnitZ(), force_path({0.02, 0.01}), gap),
                                 wall("z-", -Eigen::Vector3d::UnitZ(), force_path({0.02, 0.01}), gap)};
  };
  const CheckedScenario scenario = mdr_scenario(Configuration::walls, 30.0, 0.3, {});
  const TestRun touching = run(between(scenario, walls(0.0)), GetParam());
  const TestRun apart = run(between(scenario, walls(0.05)), GetParam());
  ASSERT_EQ(apart.record.status, RunStatus::complete) << apart.record.message;
  EXPECT_EQ(apart.time_of("contact-made"), 0.0);
  EXPECT_EQ(apart.at_event("contact-made", "z+.displacement"), 0.0);
  EXPECT_EQ(apart.at_event("contact-made", "z+.force"), 0.0);
  EXPECT_LE(difference(apart, touching), 1e-13);
}

TEST_P(MdrForceControl, HandsOverTheWallWhereItStands) {
  const TestRun result =
      run(simple({ramp(0.05), force_ramp(0.03), ramp(0.06), force_ramp(0.005), ramp(0.08), hold()}), GetParam());
  ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
  const auto times = result.column("time");
  const auto rows = result.column("row");
  for (const char* column : {"axial.displacement", "axial.force", "apparent_radius", "work", "stored_energy"}) {
    const auto values = result.column(column);
    const double scale = largest(values);
    int corners = 0;
    for (std::size_t i = 1; i < times.size(); ++i) {
      if (rows[i] != 1.0 || times[i] != std::round(times[i])) continue;
      ++corners;
      EXPECT_NEAR(values[i], values[i - 1], 1e-13 * scale) << column << ", t = " << times[i];
    }
    EXPECT_GE(corners, 5) << column;
  }
  const auto places = at_step_ends(result, "axial.displacement");
  const auto forces = at_step_ends(result, "axial.force");
  EXPECT_NEAR(places[0], 0.05, 1e-16);
  EXPECT_NEAR(forces[1], 0.03, 1e-14);
  EXPECT_NEAR(places[2], 0.06, 1e-16);
  EXPECT_NEAR(forces[3], 0.005, 1e-14);
  EXPECT_NEAR(places[4], 0.08, 1e-16);
  EXPECT_NEAR(places[5], 0.08, 1e-16);
}

TEST_P(MdrForceControl, EndsAStepAtAnyQuantity) {
  struct Row {
    Quantity quantity;
    const char* column;
    double value;
  };
  for (const Row& row :
       {Row{Quantity::force, "axial.force", 0.012}, Row{Quantity::displacement, "axial.displacement", 0.05},
        Row{Quantity::pressure, "axial.pressure", 0.075}, Row{Quantity::contact_radius, "axial.contact_radius", 0.25},
        Row{Quantity::apparent_radius, "apparent_radius", 1.0005}}) {
    const TestRun result = run(simple({until(force_ramp(0.03), row.quantity, row.value), ramp(0.07)}), GetParam());
    ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
    // An event is as accurate as the integrated radius.
    EXPECT_LE(relative_error(result.at_event("until-met", row.column), row.value), 1e-7) << row.column;
    EXPECT_LT(result.time_of("until-met"), 1.0) << row.column;
    EXPECT_NEAR(result.last("axial.displacement"), 0.07, 1e-16) << row.column;
    EXPECT_NEAR(result.column("time").back(), result.time_of("until-met") + 1.0, 1e-12) << row.column;
  }
}

TEST_P(MdrForceControl, TakesARateOfForce) {
  Step step = force_ramp(0.02);
  step.duration.reset();
  step.rate = 0.1;
  Step back = force_ramp(0.005);
  back.duration.reset();
  back.rate = 0.01;
  const TestRun result = run(simple({step, back}), GetParam());
  ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
  EXPECT_NEAR(result.column("time").back(), 0.2 + 1.5, 1e-14);
  const TestRun timed = run(simple(force_path({0.02, 0.005})), GetParam());
  EXPECT_LE(difference(result, timed), 1e-13);
}

TEST_P(MdrForceControl, StopsAtTheLargestForceAPlasticContactBears) {
  const TestRun result = run(simple(force_path({1.0})), GetParam());
  EXPECT_EQ(result.record.status, RunStatus::stopped);
  EXPECT_NE(result.record.message, "");
  EXPECT_GT(largest(result.column("axial.force")), 0.02);  // the history up to there is kept
}

INSTANTIATE_TEST_SUITE_P(AllForms, MdrForceControl, ::testing::ValuesIn(k_integrators), [](const auto& test) {
  std::string name = test.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

// --- Hertz

TEST(HertzForceControl, FollowsTheClosedForm) {
  for (const char* integrator : k_integrators) {
    for (const double target : {1e-12, 1e-6, 0.01}) {
      const TestRun result = run(hertz_scenario(Configuration::simple, force_path({target, 0.3 * target})), integrator);
      ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
      const auto times = result.column("time");
      const auto places = result.column("axial.displacement");
      const auto work = result.column("work");
      const double last = std::pow(0.75 * target / k_modulus, 2.0 / 3.0);
      for (std::size_t i = 0; i < times.size(); ++i) {
        const double force = times[i] <= 1.0 ? times[i] * target : std::lerp(target, 0.3 * target, times[i] - 1.0);
        const double overlap = std::pow(0.75 * force / k_modulus, 2.0 / 3.0);
        EXPECT_NEAR(places[i], overlap, 1e-13 * last) << integrator << ", F = " << force;
        // 2/5 F delta of each wall; the integrated work to some ten rtol
        const double tolerance = std::string(integrator) == "direct" ? 1e-13 : 2e-7;
        EXPECT_NEAR(work[i], 0.8 * force * overlap, tolerance * 0.8 * target * last) << integrator << ", F = " << force;
      }
    }
  }
}

// --- beside other walls

bool says_that_none_bears(const TestRun& result) {
  return std::ranges::any_of(result.record.warnings, [](const std::string& text) {
    return text.find("no contact bears the force that is prescribed to 'axial'") != std::string::npos;
  });
}

TEST(ForceControl, SaysThatNoContactBearsATension) {
  for (const char* integrator : k_integrators) {
    const auto pulled_to = [&](double force) {
      return run(hertz_scenario(Configuration::simple, {force_ramp(0.001), force_ramp(force)}), integrator);
    };
    EXPECT_TRUE(says_that_none_bears(pulled_to(-0.001))) << integrator;
    EXPECT_FALSE(says_that_none_bears(pulled_to(0.0))) << integrator << ": nothing is to be borne";
    EXPECT_FALSE(says_that_none_bears(pulled_to(0.0005))) << integrator;
  }
}

TEST(ForceControl, SaysNothingOfATensionThatIsBorneUntilTheStepEnds) {
  CheckedScenario scenario = mdr_scenario(Configuration::simple, 50.0, 0.3, {});
  scenario.material["surface_energy"] = 1e-5;
  const Step pull = force_ramp(-0.01);
  scenario.loading.steps = {force_ramp(0.01), until_event(pull, "pull-off")};
  EXPECT_FALSE(says_that_none_bears(run(scenario)));
  scenario.loading.steps = {force_ramp(0.01), pull};
  EXPECT_TRUE(says_that_none_bears(run(scenario)));
}

TEST(MdrMixedControl, MeetsThePrescribedForcesInEveryRow) {
  const std::vector<double> x{0.01, 0.01, 0.015, 0.002};
  const std::vector<double> y{0.004, 0.012, 0.012, 0.012};
  const CheckedScenario scenario = pairs(force_path(x), force_path(y), path({0.05, 0.1, 0.06, 0.12}));
  const TestRun direct = run(scenario);
  ASSERT_EQ(direct.record.status, RunStatus::complete) << direct.record.message;
  EXPECT_LE(distance_from_program(direct, "x+", x), 1e-12);
  EXPECT_LE(distance_from_program(direct, "y+", y), 1e-12);
  for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
    const TestRun result = run(scenario, integrator);
    EXPECT_EQ(result.events(), direct.events()) << integrator;
    EXPECT_LE(distance_from_program(result, "x+", x), 1e-12) << integrator;
    EXPECT_LE(distance_from_program(result, "y+", y), 1e-12) << integrator;
    EXPECT_LE(difference(result, direct), 1e-6) << integrator;
  }
}

TEST(MdrMixedControl, AHeldForceGivesWayToTheGrowingParticle) {
  for (const char* rule : {"gated", "yielded"}) {
    for (const char* integrator : k_integrators) {
      std::vector<Step> held = force_path({0.02});
      held.push_back(hold());
      const TestRun result = run(with(pairs(held, {}, {ramp(0.0), ramp(0.2)}), "radius_rule", rule), integrator);
      ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
      EXPECT_TRUE(result.has_event("retreat")) << integrator << ", " << rule;
      EXPECT_GE(result.time_of("retreat"), 1.0) << integrator << ", " << rule;
      EXPECT_LE(distance_from_program(result, "x+", {0.02, 0.02}), 1e-12) << integrator << ", " << rule;
      const auto place = at_step_ends(result, "x+.displacement");
      const auto radius = at_step_ends(result, "apparent_radius");
      EXPECT_GT(radius[1], radius[0]) << integrator << ", " << rule;
      // The wall moves outwards by more than the growth: the contact is larger at an equal overlap.
      EXPECT_LT(place[1], place[0] - (radius[1] - radius[0])) << integrator << ", " << rule;
    }
  }
}

TEST(MdrMixedControl, AnIdleWallIsPushedAlong) {
  std::vector<Step> idle = force_path({0.0});
  idle.push_back(hold());
  for (const char* integrator : k_integrators) {
    const TestRun result = run(pairs(idle, {}, path({0.2, 0.1})), integrator);
    ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
    const auto place = result.column("x+.displacement");
    const auto radius = result.column("apparent_radius");
    const auto force = result.column("x+.force");
    EXPECT_GT(radius.back(), 1.005);
    for (std::size_t i = 0; i < place.size(); ++i) {
      EXPECT_NEAR(place[i], 1.0 - radius[i], 1e-14) << integrator << ", row " << i;
      EXPECT_EQ(force[i], 0.0) << integrator << ", row " << i;
    }
  }
}

TEST(MdrMixedControl, MergingOfWallsDoesNotMatter) {
  const CheckedScenario scenarios[] = {
      simple(force_path({0.02, 0.01, 0.03})),
      pairs(force_path({0.01, 0.01, 0.015}), force_path({0.004, 0.012, 0.012}), path({0.05, 0.1, 0.06})),
      mdr_scenario(Configuration::hydrostatic, 30.0, 0.3, force_path({0.02, 0.005, 0.025}))};
  for (const CheckedScenario& scenario : scenarios) {
    for (const char* integrator : k_integrators) {
      const TestRun merged = run(scenario, integrator);
      const TestRun single = run(scenario, integrator, {}, false);
      ASSERT_EQ(merged.record.status, RunStatus::complete) << merged.record.message;
      ASSERT_EQ(single.record.status, RunStatus::complete) << single.record.message;
      EXPECT_GT(single.scene.classes.size(), merged.scene.classes.size());
      // Round-off with the direct solution; otherwise steps differ with the number of unknowns.
      const double tolerance = std::string(integrator) == "direct" ? 1e-12 : 1e-6;
      for (const char* column : {"apparent_radius", "work", "dissipation"})
        EXPECT_LE(difference(single.outputs(column), merged.outputs(column)), tolerance)
            << column << ", " << integrator << ", " << describe(scenario);
      const auto places = merged.outputs_by_class("displacement");
      const auto all_places = single.outputs_by_class("displacement");
      EXPECT_LE(difference(all_places.front(), places.front()), tolerance) << integrator << ", " << describe(scenario);
    }
  }
}

TEST(MdrMixedControl, AgreesInAllForms) {
  std::vector<Step> mixed = force_path({0.01, 0.015});
  mixed.push_back(ramp(0.03));
  mixed.push_back(force_ramp(0.02));
  const CheckedScenario scenarios[] = {
      pairs(mixed, {}, {ramp(0.1), force_ramp(0.01), force_ramp(0.03), ramp(0.12)}),
      pairs(mixed, path({0.0, 0.05, 0.04, 0.08}), path({0.08, 0.02, 0.1, 0.05}), 100.0),
      mdr_scenario(Configuration::die, 30.0, 0.3, force_path({0.05, 0.0, 0.06})),
      mdr_scenario(Configuration::hydrostatic, 30.0, 0.3, force_path({0.02, 0.005, 0.025}))};
  for (const CheckedScenario& original : scenarios) {
    for (const char* rule : {"gated", "yielded"}) {
      const CheckedScenario scenario = with(original, "radius_rule", rule);
      const TestRun direct = run(scenario);
      ASSERT_EQ(direct.record.status, RunStatus::complete) << direct.record.message << ", " << describe(scenario);
      for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
        const TestRun result = run(scenario, integrator);
        EXPECT_EQ(result.events(), direct.events()) << integrator << ", " << describe(scenario);
        EXPECT_LE(difference(result, direct), 1e-6) << integrator << ", " << describe(scenario);
      }
    }
  }
}

TEST(MdrMixedControl, UnitsDoNotMatter) {
  const CheckedScenario original = pairs(force_path({0.01, 0.01, 0.015}), {}, path({0.05, 0.1, 0.06}));
  const TestRun unit = run(original);
  for (const double length : {1e-6, 1e3}) {
    for (const double stress : {1e-6, 1e9}) {
      CheckedScenario scenario = original;
      scenario.radius *= length;
      scenario.material["youngs_modulus"] *= stress;
      scenario.material["yield_stress"] *= stress;
      for (WallSpec& w : scenario.loading.walls) {
        for (Step& step : w.steps) {
          step.target *= step.kind == Step::Kind::force ? stress * length * length : length;
        }
      }
      const TestRun scaled = run(scenario);
      EXPECT_EQ(scaled.events(), unit.events());
      for (const auto& [column, scale] :
           {std::pair("x+.displacement", length), std::pair("z+.force", stress * length * length),
            std::pair("work", stress * length * length * length)}) {
        std::vector<double> values = scaled.outputs(column);
        for (double& value : values) value /= scale;
        EXPECT_LE(difference(values, unit.outputs(column)), 1e-12)
            << column << ", lengths x " << length << ", stresses x " << stress;
      }
    }
  }
}

// --- free centre

/// One wall under force, a fixed one on the other side.
CheckedScenario against_a_fixed_wall(std::vector<Step> steps, double gap = 0.0) {
  CheckedScenario scenario =
      between(mdr_scenario(Configuration::walls, 30.0, 0.3, {}),
              {wall("z+", Eigen::Vector3d::UnitZ(), std::move(steps), gap), wall("z-", -Eigen::Vector3d::UnitZ())});
  scenario.loading.centre_is_free = true;
  return scenario;
}

class MdrFreeCentreUnderForce : public ::testing::TestWithParam<const char*> {};

TEST_P(MdrFreeCentreUnderForce, IsPressedFromBothSidesAlike) {
  const std::vector<double> targets{0.02, 0.01, 0.03};
  const TestRun pressed = run(against_a_fixed_wall(force_path(targets)), GetParam());
  ASSERT_EQ(pressed.record.status, RunStatus::complete) << pressed.record.message;
  const TestRun symmetric = run(simple(force_path(targets)));
  for (const char* name : {"z+", "z-"}) {
    for (const char* quantity : {".force", ".overlap", ".contact_radius"}) {
      EXPECT_LE(
          difference(pressed.outputs(name + std::string(quantity)), symmetric.outputs(std::string("axial") + quantity)),
          1e-6)
          << name << quantity;
    }
  }
  for (const char* column : {"apparent_radius", "stored_energy", "work", "dissipation"})
    EXPECT_LE(difference(pressed.outputs(column), symmetric.outputs(column)), 1e-6) << column;
  // The centre moves by as much as the fixed wall is pressed in.
  const auto centre = pressed.outputs("centre_z");
  const auto fixed = pressed.outputs("z-.overlap");
  const auto radius = pressed.outputs("apparent_radius");
  for (std::size_t i = 0; i < centre.size(); ++i) EXPECT_NEAR(centre[i], -(fixed[i] - radius[i] + 1.0), 1e-12);
}

TEST_P(MdrFreeCentreUnderForce, DoesTheWorkOfTheWallsWhileTheRadiusIsHeld) {
  // Elastic contacts only, and therefore no growth.
  const TestRun pressed = run(against_a_fixed_wall(force_path({0.003, 0.001})), GetParam());
  const TestRun symmetric = run(simple(force_path({0.003, 0.001})));
  ASSERT_EQ(pressed.record.status, RunStatus::complete) << pressed.record.message;
  ASSERT_EQ(symmetric.last("apparent_radius"), 1.0);
  EXPECT_LE(difference(pressed.outputs("work"), symmetric.outputs("work")), 1e-6);
  EXPECT_LE(std::abs(pressed.last("dissipation")), 1e-6 * largest(pressed.column("work")));
}

TEST_P(MdrFreeCentreUnderForce, IsPressedOnWhereBothWallsHaveLostIt) {
  // The particle has lost the fixed wall, too, but still lies at it.
  const TestRun result = run(against_a_fixed_wall({force_ramp(0.02), ramp(0.0), force_ramp(0.01)}), GetParam());
  ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
  EXPECT_TRUE(result.has_event("contact-lost"));
  const TestRun symmetric = run(simple(force_path({0.02, 0.0, 0.01})));
  for (const char* overlap : {"z+.overlap", "z-.overlap"}) {
    EXPECT_NEAR(result.last(overlap), symmetric.last("axial.overlap"), 1e-6 * symmetric.last("axial.overlap"));
  }
}

TEST_P(MdrFreeCentreUnderForce, IsPulledOffAtTheTensionThatTheWeakerSideBears) {
  const double surface_energy = 1e-5;
  const double bears = 1.5 * pi * surface_energy;  // a contact (Johnson, Kendall and Roberts)
  const double from = 1e-4;
  const double to = -1e-4;
  for (const double degrees : {0.0, 40.0, 70.0}) {
    CheckedScenario scenario = against_a_fixed_wall({force_ramp(from), force_ramp(to)});
    scenario.material["surface_energy"] = surface_energy;
    scenario = with(std::move(scenario), "elastic_profile", "parabola");
    const double tilt = degrees * pi / 180.0;
    if (degrees > 0.0) {
      scenario.loading.walls[1] = wall("a", {std::sin(tilt), 0.0, -std::cos(tilt)});
      scenario.loading.walls.push_back(wall("b", {-std::sin(tilt), 0.0, -std::cos(tilt)}));
    }
    // Across the pull another wall draws at the particle, with less than its contact bears.
    scenario.loading.walls.push_back(wall("y+", Eigen::Vector3d::UnitY(), {force_ramp(2e-5), force_ramp(-2e-5)}));
    scenario.loading.walls.push_back(wall("y-", -Eigen::Vector3d::UnitY()));
    const TestRun result = run(scenario, GetParam());
    ASSERT_EQ(result.record.status, RunStatus::complete) << degrees << ": " << result.record.message;
    EXPECT_NEAR(result.last("y+.force"), -2e-5, 1e-12) << degrees;
    const double tension = bears * (degrees > 0.0 ? std::min(1.0, 2.0 * std::cos(tilt)) : 1.0);
    EXPECT_NEAR(result.time_of("pull-off"), 1.0 + (from + tension) / (from - to), 1e-6) << degrees;
    EXPECT_EQ(result.last("z+.force"), 0.0) << degrees;
    // The particle stays at the walls that do not pull.
    EXPECT_NEAR(result.last(degrees > 0.0 ? "a.force" : "z-.force"), 0.0, 1e-12) << degrees;
    EXPECT_GT(result.last(degrees > 0.0 ? "a.contact_radius" : "z-.contact_radius"), 0.0) << degrees;
  }
}

TEST_P(MdrFreeCentreUnderForce, IsCarriedOnWhereAWallHasGoneAway) {
  // Both walls have gone away, and the particle's position between them is undetermined.
  CheckedScenario scenario = against_a_fixed_wall({force_ramp(0.02), ramp(0.0), force_ramp(0.01)});
  scenario.loading.walls[1] = wall("z-", -Eigen::Vector3d::UnitZ(), {hold(), ramp(-0.05), hold()});
  const TestRun result = run(scenario, GetParam());
  EXPECT_TRUE(result.has_event("contact-lost"));
  ASSERT_EQ(result.record.status, RunStatus::complete) << result.record.message;
  EXPECT_EQ(result.time_of("dent-touched"), 2.0);
  EXPECT_NEAR(result.last("z-.force"), 0.01, 1e-9);
  EXPECT_NEAR(result.last("z-.overlap"), result.last("z+.overlap"), 1e-6 * result.last("z+.overlap"));
}

INSTANTIATE_TEST_SUITE_P(AllForms, MdrFreeCentreUnderForce, ::testing::ValuesIn(k_integrators), [](const auto& test) {
  std::string name = test.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

}  // namespace
}  // namespace monograin::force_control_test
