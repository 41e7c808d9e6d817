// Whole runs of the plastic laws: events, unloading, lateral contacts, ends, random scenes.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "engine/integrator.hpp"
#include "hardening/law.hpp"
#include "history/energy.hpp"
#include "mdr/contact.hpp"
#include "models/plastic/cases.hpp"
#include "models/plastic/scenarios.hpp"
#include "plastic/model_of.hpp"
#include "scenario/model_input.hpp"
#include "scene/scene.hpp"
#include "semimech/lateral.hpp"
#include "similarity/law.hpp"
#include "support/test_run.hpp"

namespace monograin::plastic::runs_test {
namespace {

using Walls = monograin::Configuration;

Configuration configuration_of(const CheckedScenario& scenario) {
  return plastic::configuration_of(model_input(scenario));
}

semimech::Law semimech_law(const CheckedScenario& scenario) {
  const auto& material = scenario.material;
  return semimech::make_law(
      semimech::make_material(material.at("youngs_modulus"), material.at("poisson_ratio"), material.at("yield_stress")),
      configuration_of(scenario));
}

hardening::Law hardening_law(const CheckedScenario& scenario) {
  return hardening::make_law(scenario.material.at("hardening_exponent"), configuration_of(scenario));
}

/// Calls a function with the law of a scenario.
template <class Function>
auto with_law(const CheckedScenario& scenario, const Function& function) {
  if (scenario.model == "semimech") return function(semimech_law(scenario));
  if (scenario.model == "hardening") return function(hardening_law(scenario));
  return function(similarity::make_law(scenario.material.at("hardening_exponent")));
}

double force_at(const CheckedScenario& scenario, double x) {
  return with_law(scenario, [&](const auto& law) { return state_at(law, x).force; });
}

constexpr std::array k_walls{Walls::simple, Walls::die, Walls::hydrostatic};

/// A steel of E/Y = 1000, in units of Y.
CheckedScenario steel(Walls walls, std::vector<Step> steps) {
  return semimech_scenario(walls, 1000.0, 0.3, 1.0, std::move(steps));
}
CheckedScenario unloading_steel(Walls walls, std::vector<Step> steps) {
  return with(steel(walls, std::move(steps)), "unloading", "mdr");
}
/// MCC of the source, in units of its strength.
CheckedScenario cellulose(Walls walls, std::vector<Step> steps) {
  return hardening_scenario(walls, 1.0, 0.6585, std::move(steps));
}

/// Largest difference of all columns, over the largest magnitude of each; blanks have to be blank in both.
double distance(const TestRun& actual, const TestRun& expected) {
  EXPECT_EQ(actual.events(), expected.events());
  double worst = 0.0;
  for (const Column& column : expected.record.history.columns()) {
    if (column.holds_words()) continue;
    const std::vector<double> a = actual.outputs(column.name);
    const std::vector<double> b = expected.outputs(column.name);
    EXPECT_EQ(a.size(), b.size()) << column.name;
    double scale = 0.0;
    for (const double value : b) scale = std::max(scale, std::isnan(value) ? 0.0 : std::abs(value));
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
      EXPECT_EQ(std::isnan(a[k]), std::isnan(b[k])) << column.name << ", row " << k;
      if (!std::isnan(b[k]) && scale > 0.0) worst = std::max(worst, std::abs(a[k] - b[k]) / scale);
    }
  }
  return worst;
}

// --- events

TEST(PlasticEvents, FallOnTheBoundariesOfTheLaw) {
  for (const Walls walls : k_walls) {
    for (const bool hardens : {false, true}) {
      const double end = walls == Walls::simple ? 0.6 : walls == Walls::die ? 0.475 : 0.193;
      const CheckedScenario scenario = hardens ? cellulose(walls, {ramp(end, end)}) : steel(walls, {ramp(end, end)});
      const auto ends = with_law(scenario, [](const auto& law) { return boundaries(law); });
      const RadiusSeries radius = hardens ? hardening_law(scenario).radius : semimech_law(scenario).radius;
      for (const char* integrator : k_integrators) {
        const TestRun now = run(scenario, integrator);
        for (const Boundary& boundary : ends) {
          if (boundary.approach > end) continue;
          EXPECT_NEAR(now.time_of(boundary.event), boundary.approach, 1e-13) << integrator << " " << boundary.event;
        }
        if (walls == Walls::simple) continue;
        const double meeting = impingement_approach(configuration_of(scenario), radius);
        if (meeting < end) {
          EXPECT_NEAR(now.time_of("impingement"), meeting, 1e-13) << integrator;
        }
      }
    }
  }
}

TEST(PlasticEvents, FallOnTheForcesAtTheBoundariesUnderAForce) {
  const semimech::Law law = semimech_law(steel(Walls::die, {}));
  const double end = 1.2 * state_in(law, Regime::low_compressibility, 0.47).force;
  for (const char* integrator : k_integrators) {
    const TestRun now = run(steel(Walls::die, {force_ramp(end, end)}), integrator);
    Regime regime = Regime::elastic;
    for (const Boundary& boundary : boundaries(law)) {
      const double force = state_in(law, regime, boundary.approach).force;
      regime = boundary.beyond;
      if (force > end) continue;
      EXPECT_NEAR(now.time_of(boundary.event), force, 1e-7 * end) << integrator << " " << boundary.event;
    }
  }
}

TEST(PlasticEvents, RowsAroundThemBearTheRegimesBeforeAndAfter) {
  const TestRun now = run(steel(Walls::die, {ramp(0.475)}));
  const auto x = now.column("axial.displacement");
  const auto changes = regime_changes(now, "axial");
  EXPECT_EQ(changes.size(), 3U);
  for (const std::size_t k : changes) EXPECT_NEAR(x[k], x[k - 1], 1e-15);
}

TEST(PlasticEvents, DoNotDependOnTheRate) {
  const TestRun slow = run(unloading_steel(Walls::die, {ramp(0.4, 1e9), ramp(0.38, 1e9), ramp(0.45, 1e9)}));
  const TestRun fast = run(unloading_steel(Walls::die, {ramp(0.4, 1e-9), ramp(0.38, 1e-9), ramp(0.45, 1e-9)}));
  for (const char* column : {"axial.displacement", "axial.force", "work"}) {
    EXPECT_EQ(slow.column(column), fast.column(column)) << column;
  }
}

TEST(PlasticEvents, AreTheSameForWallsThatAreNotMerged) {
  for (const Walls walls : k_walls) {
    const CheckedScenario scenario = unloading_steel(walls, {ramp(0.15), ramp(0.145), ramp(0.17)});
    const TestRun merged = run(scenario);
    const TestRun apart = run(scenario, "direct", {}, false);
    EXPECT_EQ(merged.column("work").size(), apart.column("work").size());
    EXPECT_LE(difference(apart.outputs("work"), merged.outputs("work")), 1e-13);
    EXPECT_EQ(apart.outputs_by_class("force").front(), merged.outputs_by_class("force").front());
    EXPECT_EQ(apart.outputs_by_class("overlap").size(), walls == Walls::simple ? 2u : 6u);
  }
}

// --- lateral contacts of the die

class LateralCurve : public ::testing::TestWithParam<const char*> {};

TEST_P(LateralCurve, IsMetByARun) {
  const Table table = reference("semimech", GetParam());
  const double strength = header_number(table, "sigma_y");
  const std::vector<double> x = table.column("gamma_over_2R");
  CheckedScenario scenario = semimech_scenario(Walls::die, header_number(table, "E"), header_number(table, "nu"),
                                               strength, {ramp(x.back(), x.back())});
  scenario.output.times = x;
  const TestRun now = run(scenario);
  const auto force = now.outputs("lateral.force");
  const auto pressure = now.outputs("lateral.pressure");
  const auto radius = now.outputs("lateral.contact_radius");
  const auto overlap = now.outputs("lateral.overlap");
  ASSERT_EQ(force.size(), x.size() + 1);
  for (std::size_t k = 0; k < x.size(); ++k) {
    // The row of an output point at an event has the values before it.
    const bool is_onset = x[k] > 0.1 && std::isnan(pressure[k + 1]);
    const auto expect = [&](double actual, std::string_view column, double factor) {
      const double expected = number(table, k, column);
      if (std::isnan(expected))
        EXPECT_TRUE(std::isnan(actual)) << column << " at " << x[k];
      else
        EXPECT_LE(relative_error(actual, factor * expected), 1e-11) << column << " at " << x[k];
    };
    expect(overlap[k + 1], "gamma_s_over_2R", 1.0);
    expect(radius[k + 1], "a_s_over_R", 1.0);
    expect(force[k + 1], "P_s_over_sigma_yR2", strength);
    expect(is_onset ? now.at_event("secondary-onset", "lateral.pressure") : pressure[k + 1], "Hbar_s", strength);
  }
}

INSTANTIATE_TEST_SUITE_P(Plastic, LateralCurve,
                         ::testing::Values("secondary_die_01", "secondary_die_09", "secondary_die_17"));

TEST(PlasticLateralContacts, AreEmptyWhereTheSourceHasNoLaw) {
  const TestRun now = run(unloading_steel(Walls::die, {ramp(0.46), ramp(0.45), ramp(0.47)}));
  const auto x = now.column("axial.displacement");
  const auto axial = now.column("axial.regime");
  const auto force = now.column("lateral.force");
  const auto pressure = now.column("lateral.pressure");
  for (std::size_t k = 0; k < x.size(); ++k) {
    const bool is_unloaded = axial[k] >= static_cast<double>(Regime::unloading);
    // Rows of the two instants at which it changes belong to both sides.
    if (std::abs(x[k] - 0.1) < 1e-12 || std::abs(x[k] - 0.46) < 1e-12 || std::abs(x[k] - 0.4102) < 1e-3) continue;
    EXPECT_EQ(std::isnan(force[k]), x[k] > 0.1 || is_unloaded) << x[k];
    EXPECT_EQ(std::isnan(pressure[k]), (x[k] > 0.1 && x[k] < 0.4102) || is_unloaded) << x[k];
  }
  ASSERT_EQ(now.record.warnings.size(), 2u);
  EXPECT_TRUE(contains(now.record.warnings.front(), "1 to 3 times those of finite elements"))
      << now.record.warnings.front();
  EXPECT_TRUE(contains(now.record.warnings.back(), "no law for lateral contacts")) << now.record.warnings.back();
}

// --- unloading by the indenter of model mdr

TEST(PlasticUnloading, BeginsWithTheForceOfTheLawAndTheStiffnessOfTheIndenter) {
  for (const Walls walls : k_walls) {
    const double largest = 0.18;
    const CheckedScenario scenario = unloading_steel(walls, {ramp(largest), ramp(0.0)});
    const double modulus = 1000.0 / (1.0 - 0.09);
    const TestRun now = run(scenario);
    const ContactState state = state_at(semimech_law(scenario), largest);
    const auto shape = mdr::unloading_shape_of(modulus, 0.3, 1.0, largest, state.contact_radius, state.pressure);
    const mdr::Contact first = mdr::unloading_contact(shape, modulus, largest);
    EXPECT_NEAR(first.force, state.force, 1e-14 * state.force);
    EXPECT_NEAR(first.by_overlap, 2.0 * modulus * state.contact_radius / (1.0 - shape.rho), 1e-10 * first.by_overlap);
    EXPECT_NEAR(now.at_event("contact-lost", "axial.displacement"), largest - shape.recovery, 1e-14);
    EXPECT_NEAR(now.at_event("contact-lost", "axial.contact_radius"), 0.0, 1e-14);
  }
}

TEST(PlasticUnloading, GoesBackTheSameWayAndThenTheLawGoesOn) {
  for (const auto& material : {unloading_steel(Walls::die, {}), unloading(cellulose(Walls::die, {}), 500.0, 0.3)}) {
    CheckedScenario cycles = material;
    cycles.loading.steps = {ramp(0.2), ramp(0.1999), ramp(0.2), ramp(0.0), ramp(0.4)};
    CheckedScenario straight = material;
    straight.loading.steps = {ramp(0.2), ramp(0.4)};
    const TestRun once = run(straight);
    for (const char* integrator : k_integrators) {
      const TestRun now = run(cycles, integrator);
      const std::vector<std::string> reload{"axial:load-reversal", "axial:reload",       "axial:load-reversal",
                                            "axial:contact-lost",  "axial:dent-touched", "axial:reload"};
      std::vector<std::string> events = now.events();
      std::erase_if(events, [&](const std::string& e) { return std::ranges::find(reload, e) == reload.end(); });
      EXPECT_EQ(events, reload) << integrator;
      EXPECT_NEAR(now.last("axial.force"), once.last("axial.force"), 1e-12 * once.last("axial.force")) << integrator;
      EXPECT_NEAR(now.last("work"), once.last("work"), 2e-7 * once.last("work")) << integrator;
      EXPECT_NEAR(now.last("stored_energy"), once.last("stored_energy"), 1e-12 * once.last("work")) << integrator;
      EXPECT_GE(lost_dissipation(now), -2e-7) << integrator;
    }
  }
}

TEST(PlasticUnloading, OfAContactThatHasNotYieldedLosesNothing) {
  const double yield = semimech_law(steel(Walls::simple, {})).yield_approach;
  const TestRun now = run(unloading_steel(Walls::simple, {ramp(0.9 * yield), ramp(-0.1 * yield), ramp(0.8 * yield)}));
  EXPECT_TRUE(now.has_event("contact-lost"));
  EXPECT_TRUE(now.has_event("contact-made"));
  const double work = largest(now.column("work"));
  for (const double dissipation : now.column("dissipation")) EXPECT_NEAR(dissipation, 0.0, 1e-14 * work);
  for (const double regime : now.column("axial.regime")) EXPECT_LE(regime, static_cast<double>(Regime::elastic));
}

TEST(PlasticUnloading, IsTheSameUnderAForceInAllForms) {
  const double force = semimech_law(steel(Walls::hydrostatic, {})).fall.least * 1.2;
  const std::vector<Step> steps{force_ramp(force),
                                force_ramp(0.3 * force),
                                force_ramp(2.0 * force),
                                force_ramp(0.0),
                                hold(),
                                force_ramp(0.5 * force),
                                ramp(-0.1),
                                ramp(0.19)};
  const TestRun direct = run(unloading_steel(Walls::hydrostatic, steps));
  EXPECT_EQ(direct.record.status, RunStatus::complete) << direct.record.message;
  for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
    EXPECT_LE(distance(run(unloading_steel(Walls::hydrostatic, steps), integrator), direct), 2e-7) << integrator;
  }
  // Just above yield a contact stores more than it took, and the dissipation falls a little.
  EXPECT_GE(lost_dissipation(direct), -1e-9);
}

TEST(SemimechWarnings, SayWhereAWholeRunIsTooStiff) {
  const auto warns = [](double reach) {
    const TestRun result = run(unloading_steel(Walls::simple, {ramp(reach)}));
    return std::ranges::any_of(result.record.warnings,
                               [](const std::string& text) { return contains(text, "where the law is too stiff"); });
  };
  EXPECT_TRUE(warns(8e-6));
  EXPECT_TRUE(warns(0.029));
  EXPECT_FALSE(warns(0.031));
}

TEST(SemimechWarnings, NameTheStiffnessOfTheConfigurationThatRuns) {
  const auto warning = [](Walls walls) {
    std::string all;
    for (const std::string& text : run(unloading_steel(walls, {ramp(0.01)})).record.warnings) all += text;
    return all;
  };
  EXPECT_TRUE(contains(warning(Walls::simple),
                       "its force (simple) is 19 to 55 % above finite elements, and in the "
                       "elastic regime 2.20 to 3.06 times that of Hertz"))
      << warning(Walls::simple);
  EXPECT_TRUE(contains(warning(Walls::die),
                       "its force (die) is 27 to 66 % above finite elements, and in the elastic "
                       "regime 2.30 to 3.21 times that of Hertz"))
      << warning(Walls::die);
  EXPECT_TRUE(contains(warning(Walls::hydrostatic),
                       "its force (hydrostatic) is 35 to 78 % above finite elements, and "
                       "in the elastic regime 2.57 to 3.58 times that of Hertz"))
      << warning(Walls::hydrostatic);
}

TEST(SemimechWarnings, DoNotNameTheEndOfARangeThatRoundOffPasses) {
  const auto warns = [](double lambda) {
    const TestRun result = run(semimech_scenario(Walls::die, lambda * 0.91 * 3.0, 0.3, 3.0, {ramp(0.05)}));
    return std::ranges::any_of(result.record.warnings,
                               [](const std::string& text) { return contains(text, "lateral contacts were fitted"); });
  };
  EXPECT_FALSE(warns(semimech::k_least_lateral_modulus_over_yield));
  EXPECT_FALSE(warns(semimech::k_greatest_lateral_modulus_over_yield));
  EXPECT_TRUE(warns(semimech::k_least_lateral_modulus_over_yield * (1.0 - 1e-12)));
  EXPECT_TRUE(warns(semimech::k_greatest_lateral_modulus_over_yield * (1.0 + 1e-12)));
}

TEST(PlasticUnloading, OfSmallContactsOfAPowerLawReturnsMoreThanTheirWork) {
  // kappa = 20 MPa, E = 1 GPa: 50 kappa.
  struct Row {
    CheckedScenario scenario;
    double from_a_thousandth, end_of_creation;
  };
  for (const Row& row : {Row{similarity_scenario(Walls::simple, 1.0, 0.24, {}), 1.293, 0.00188},
                         Row{hardening_scenario(Walls::simple, 1.0, 0.24, {}), 1.259, 0.00174}}) {
    CheckedScenario small = unloading(row.scenario, 50.0, 0.4);
    small.loading.steps = {ramp(0.001), ramp(-0.001)};
    const TestRun returned = run(small);
    const double work = largest(returned.column("work"));
    EXPECT_NEAR((work - returned.last("work")) / work, row.from_a_thousandth, 1e-3) << small.model;
    EXPECT_TRUE(energy_warning(returned.record.history, 1.0, small.model, 0.0)) << small.model;
    small.loading.steps = {ramp(0.004)};
    small.output.points = 4000;
    const TestRun loaded = run(small);
    const std::vector<double> x = loaded.column("axial.displacement");
    const std::vector<double> dissipation = loaded.column("dissipation");
    double last_negative = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (dissipation[k] < 0.0) last_negative = std::max(last_negative, x[k]);
    }
    EXPECT_NEAR(last_negative, row.end_of_creation, 1e-5) << small.model;
  }
}

TEST(PlasticUnloading, OfAHardeningParticleCreatesEnergyJustBeforeZeroPorosity) {
  CheckedScenario scenario = unloading(hardening_scenario(Walls::hydrostatic, 1.0, 0.24, {ramp(0.1939)}), 250.0, 0.3);
  scenario.output.points = 20000;
  const TestRun now = run(scenario);
  const std::vector<double> x = now.column("axial.displacement");
  const std::vector<double> dissipation = now.column("dissipation");
  const auto peak = static_cast<std::size_t>(std::ranges::max_element(dissipation) - dissipation.begin());
  EXPECT_NEAR(x[peak], 0.1933, 5e-5);
  EXPECT_NEAR((dissipation[peak] - dissipation.back()) / now.last("work"), 0.0239, 1e-4);
}

/// True if a run warns that its walls have gone farther than the source compares.
bool warns_of_reach(const CheckedScenario& scenario) {
  return std::ranges::any_of(run(scenario).record.warnings,
                             [](const std::string& text) { return contains(text, "have gone farther than"); });
}

TEST(PlasticEnds, AreWarnedOfFromTheEndOfTheComparisonOn) {
  EXPECT_FALSE(warns_of_reach(hardening_scenario(Walls::simple, 1.0, 0.24, {ramp(0.499)})));
  EXPECT_TRUE(warns_of_reach(hardening_scenario(Walls::simple, 1.0, 0.24, {ramp(0.501)})));
  EXPECT_FALSE(warns_of_reach(steel(Walls::simple, {ramp(0.499)})));
  EXPECT_TRUE(warns_of_reach(steel(Walls::simple, {ramp(0.501)})));
}

TEST(PlasticUnloading, WarnsOfWhatHappenedInOneRun) {
  using OneWall = WallLaw<similarity::Law>;
  OneWall law(similarity::make_law(0.24),
              {.strength = 1.0, .can_unload = true, .composite_modulus = 50.0, .poisson_ratio = 0.4});
  OneWall::Branch branch;
  law.turn(branch, 1e-4);
  static_cast<void>(law.follower(branch, true, 1e-4));
  EXPECT_EQ(law.warnings(1.0).size(), 2u);
  law.start();
  EXPECT_TRUE(law.warnings(1.0).empty());
}

TEST(PlasticUnloading, WarnsOfContactsThatRecoverMoreThanTheyWereCompressed) {
  const double yield = semimech_law(steel(Walls::simple, {})).yield_approach;
  const TestRun small = run(unloading_steel(Walls::simple, {ramp(1.05 * yield), ramp(0.9 * yield)}));
  // The excess of the recovery is also returned as energy.
  EXPECT_TRUE(energy_warning(small.record.history, 1.0, "semimech", 0.0));
  ASSERT_EQ(small.record.warnings.size(), 2u);
  EXPECT_TRUE(contains(small.record.warnings.front(), "too stiff")) << small.record.warnings.front();
  EXPECT_TRUE(contains(small.record.warnings.back(), "recovers more")) << small.record.warnings.back();
  EXPECT_TRUE(run(unloading_steel(Walls::simple, {ramp(0.1), ramp(0.09)})).record.warnings.empty());
}

// --- ends

TEST(PlasticEnds, StopWhereTheWallsMeetOrTheCellIsFilled) {
  for (const char* integrator : k_integrators) {
    const TestRun meeting = run(steel(Walls::simple, {ramp(1.2, 1.2)}), integrator);
    EXPECT_EQ(meeting.record.status, RunStatus::stopped);
    EXPECT_NEAR(meeting.time_of("limit"), 1.0, 1e-12) << integrator;
    const TestRun filled = run(cellulose(Walls::die, {ramp(0.6, 0.6)}), integrator);
    EXPECT_EQ(filled.record.status, RunStatus::stopped);
    EXPECT_NEAR(filled.time_of("zero-porosity"), filled_cell_approach(Configuration::die), 1e-9) << integrator;
    EXPECT_TRUE(contains(filled.record.message, "fills its cell")) << filled.record.message;
    // The pressure rises with the logarithm only, so that the force is finite there.
    const TestRun pressed = run(cellulose(Walls::hydrostatic, {force_ramp(1e4)}), integrator);
    EXPECT_EQ(pressed.record.status, RunStatus::stopped) << integrator;
    EXPECT_NEAR(pressed.last("axial.displacement"), filled_cell_approach(Configuration::hydrostatic), 1e-8)
        << integrator << " " << pressed.record.message;
  }
}

TEST(PlasticEnds, StopWhereAProgramGoesBackAfterACondition) {
  // The direction of the second step is known only when the first has ended.
  const TestRun now = run(steel(Walls::simple, {until(ramp(0.3), Quantity::displacement, 0.2), ramp(0.1)}));
  EXPECT_EQ(now.record.status, RunStatus::stopped);
  EXPECT_TRUE(contains(now.record.message, "unloading = \"mdr\" adds one")) << now.record.message;
}

// --- independent contacts

TEST(PlasticSimilarity, WallsMeetTheParticleAcrossTheirGaps) {
  CheckedScenario scenario = between(similarity_scenario(Walls::walls, 1.0, 0.24, {}),
                                     {wall("a", {0, 0, 1}, {ramp(0.02)}), wall("b", {0, 0, -1}, {ramp(0.03)}, 0.01),
                                      wall("c", {1, 0, 0}, {force_ramp(0.001)}, 0.02), wall("d", {0, 1, 0})});
  const TestRun direct = run(scenario);
  EXPECT_EQ(direct.events(), (std::vector<std::string>{"c:contact-made", "b:contact-made"}));
  EXPECT_NEAR(direct.record.events.column("time")[1], 0.25, 1e-14);
  const similarity::Law law = similarity::make_law(0.24);
  EXPECT_NEAR(direct.last("a.force"), state_at(law, 0.02).force, 1e-15);
  EXPECT_NEAR(direct.last("b.force"), state_at(law, 0.03).force, 1e-15);
  EXPECT_NEAR(direct.last("c.displacement"), approach_under(law, 0.001), 1e-15);
  EXPECT_EQ(direct.last("d.force"), 0.0);
  EXPECT_NEAR(direct.last("work"),
              work_per_wall(law, 0.02) + work_per_wall(law, 0.03) + work_per_wall(law, approach_under(law, 0.001)),
              1e-15);
  for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
    EXPECT_LE(distance(run(scenario, integrator), direct), 1e-7) << integrator;
  }
}

// --- random scenes

/// Random admissible materials and programs under either control; half of them with unloading.
CheckedScenario random_scenario(std::mt19937_64& generator) {
  const Walls walls = k_walls[static_cast<std::size_t>(uniform(generator, 0.0, 3.0))];
  const double kind = uniform(generator, 0.0, 3.0);
  CheckedScenario scenario;
  if (kind < 1.0) {
    const double nu = uniform(generator, 0.0, 0.4999);
    const double lambda = log_uniform(generator, 22.0931, 1e6);
    scenario = semimech_scenario(walls, lambda * (1.0 - nu * nu), nu, 1.0, {});
  } else {
    const double exponent = uniform(generator, 0.0, 1.0);
    scenario =
        kind < 2.0 ? hardening_scenario(walls, 1.0, exponent, {}) : similarity_scenario(walls, 1.0, exponent, {});
  }
  const bool unloads = uniform(generator, 0.0, 1.0) < 0.5;
  if (unloads) {
    const double youngs_modulus = kind < 1.0 ? scenario.material.at("youngs_modulus") : log_uniform(generator, 50, 1e5);
    const double nu = kind < 1.0 ? scenario.material.at("poisson_ratio") : uniform(generator, 0.0, 0.4999);
    scenario = unloading(scenario, youngs_modulus, nu);
  }
  const double end =
      0.98 * with_law(scenario, [](const auto& law) { return std::min<double>(law.limit, law.calibrated_end + 0.1); });
  double x = 0.0;
  const bool by_force = uniform(generator, 0.0, 1.0) < 0.5;
  const int steps = 1 + static_cast<int>(uniform(generator, 0.0, 4.0));
  for (int k = 0; k < steps; ++k) {
    const bool goes_back = unloads && k % 2 == 1;
    x = goes_back ? x * uniform(generator, 0.9, 1.0) : uniform(generator, x, end);
    if (!by_force) {
      scenario.loading.steps.push_back(ramp(x));
      continue;
    }
    const double force = force_at(scenario, x);
    scenario.loading.steps.push_back(force_ramp(goes_back ? force * uniform(generator, 0.0, 0.9) : force));
  }
  scenario.output.points = 10;
  return scenario;
}

TEST(PlasticRandomScenes, AreCompleteWithoutBlanksAndGiveBackNoMoreThanTheyTook) {
  std::mt19937_64 generator(4711);
  for (int k = 0; k < 10000; ++k) {
    const CheckedScenario scenario = random_scenario(generator);
    const TestRun now = run(scenario);
    ASSERT_EQ(now.record.status, RunStatus::complete) << k << ": " << now.record.message << "\n" << describe(scenario);
    for (const char* column : {"work", "axial.displacement", "axial.force", "axial.contact_radius", "axial.pressure"}) {
      for (const double value : now.column(column)) ASSERT_FALSE(std::isnan(value)) << column << " of " << k;
    }
  }
}

TEST(PlasticRandomScenes, AgreeInAllForms) {
  std::mt19937_64 generator(815);
  for (int k = 0; k < 150; ++k) {
    const CheckedScenario scenario = random_scenario(generator);
    const TestRun direct = run(scenario);
    for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
      EXPECT_LE(distance(run(scenario, integrator), direct), 3e-7) << k << " " << integrator << "\n"
                                                                   << describe(scenario);
    }
  }
}

TEST(PlasticRuns, MakeASceneOfAForceThatIsTheGreatestButForRoundOff) {
  CheckedScenario scenario = steel(Walls::simple, {force_ramp(1.0)});
  const double greatest = force_at(scenario, std::nextafter(1.0, 0.0));
  for (int k = -40; k <= 40; ++k) {
    scenario.loading.steps = {force_ramp(greatest * (1.0 + k * std::numeric_limits<double>::epsilon()))};
    EXPECT_NO_THROW(static_cast<void>(make_scene(scenario))) << k;
  }
}

TEST(PlasticRuns, HoldWhatAConditionHasLedTo) {
  const CheckedScenario by_force =
      steel(Walls::simple,
            {until(ramp(0.3), Quantity::force, 1.7), force_ramp(1.7), until(force_ramp(3.0), Quantity::force, 1.9),
             force_ramp(1.9), until(force_ramp(3.0), Quantity::displacement, 0.2345), ramp(0.2345)});
  for (const std::string_view integrator : integrator_names()) {
    if (integrator == "forward-euler") continue;  // its steps lead beyond
    for (const double scale : {0.5, 0.9, 1.0, 1.1}) {
      CheckedScenario scenario = by_force;
      for (Step& step : scenario.loading.steps) {
        if (step.kind == Step::Kind::force) step.target *= scale;
        for (Until& condition : step.until) condition.value *= condition.is_of(Quantity::force) ? scale : 1.0;
      }
      const TestRun now = run(scenario, integrator);
      EXPECT_EQ(now.record.status, RunStatus::complete) << integrator << ": " << now.record.message;
      EXPECT_EQ(now.last("axial.displacement"), 0.2345) << integrator;
    }
  }
}

}  // namespace
}  // namespace monograin::plastic::runs_test
