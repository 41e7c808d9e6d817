// The base of laws whose contacts depend on their own wall alone, tested with small laws: a linear spring, one that is
// stiffer under unloading, and others.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "contacts/independent.hpp"
#include "contacts/model_of.hpp"
#include "models/contacts/laws.hpp"
#include "support/test_run.hpp"

namespace monograin::contacts_test {
namespace {

constexpr const char* k_all_forms[] = {"direct", "cvode-adams",   "cvode-bdf",
                                       "ida",    "odeint-dopri5", "odeint-rosenbrock4"};

/// Runs a law in the scene of another model.
template <class Law>
TestRun run_law(const CheckedScenario& scenario, std::string_view integrator, const Law& law = {},
                const Tolerances& tolerances = {}) {
  TestRun result{make_scene(scenario), {}};
  const contacts::Settings settings{.initial_radius = scenario.radius};
  result.scene.system = std::make_unique<contacts::IndependentContacts<Law>>(law, settings, result.scene.classes);
  result.record = record_run(result.scene, integrator, tolerances, scenario.output);
  return result;
}

CheckedScenario pair_of_walls(std::vector<Step> steps) {
  return hertz_scenario(Configuration::simple, std::move(steps));
}

using Names = std::vector<std::string>;

TEST(IndependentContacts, BearTheForceOfTheLawUnderBothControls) {
  for (const char* form : k_all_forms) {
    for (const auto& steps : {path({0.2, 0.1, 0.3}), std::vector<Step>{force_ramp(2.0), ramp(0.1), force_ramp(3.0)}}) {
      const TestRun now = run_law<Spring>(pair_of_walls(steps), form, {10.0});
      ASSERT_EQ(now.record.status, RunStatus::complete) << form << ": " << now.record.message;
      const auto d = now.column("axial.displacement");
      const auto force = now.column("axial.force");
      for (std::size_t k = 0; k < d.size(); ++k) EXPECT_NEAR(force[k], 10.0 * d[k], 1e-14) << form;
      EXPECT_NEAR(now.last("axial.displacement"), 0.3, 1e-15) << form;
      // Two walls, each of which has pressed its spring.
      EXPECT_NEAR(now.last("work"), 10.0 * 0.3 * 0.3, 1e-7) << form;
      EXPECT_NEAR(now.last("dissipation"), 0.0, 1e-7) << form;
    }
  }
}

TEST(IndependentContacts, ScaleWithRadiusAndUnitForce) {
  CheckedScenario scenario = pair_of_walls({ramp(1e-3)});
  scenario.radius = 0.01;
  const TestRun now = run_law<Spring>(scenario, "direct", {2e6});
  EXPECT_DOUBLE_EQ(now.last("axial.force"), 2e6 * 0.01 * 1e-3);
  EXPECT_DOUBLE_EQ(now.last("work"), 2e6 * 0.01 * 1e-6);
  EXPECT_DOUBLE_EQ(now.last("stored_energy"), 2e6 * 0.01 * 1e-6);
}

TEST(IndependentContacts, TouchAcrossAGapAreLostAndTouchedAgain) {
  const auto steps = path({0.3, -0.2, 0.2});
  const CheckedScenario scenario =
      between(pair_of_walls({}), {wall("a", {0, 0, 1}, steps, 0.1), wall("b", {0, 0, -1})});
  for (const char* form : k_all_forms) {
    const TestRun now = run_law<Spring>(scenario, form);
    EXPECT_EQ(now.events(), (Names{"a:contact-made", "a:load-reversal", "a:contact-lost", "a:contact-made"})) << form;
    EXPECT_NEAR(now.time_of("contact-made"), 0.25, 1e-13) << form;
    EXPECT_NEAR(now.time_of("contact-lost"), 1.6, 1e-13) << form;
    EXPECT_EQ(now.outputs("a.displacement").front(), -0.1);
    EXPECT_EQ(now.outputs("b.force"), std::vector<double>(now.outputs("b.force").size(), 0.0));
  }
}

TEST(IndependentContacts, UnloadFromTheLargestDisplacementAndReloadThere) {
  const double dent = 0.2 - 0.2 / Hysteretic::k_ratio;
  const Names events{"axial:load-reversal", "axial:contact-lost", "axial:contact-made", "axial:reload", "axial:knee"};
  for (const char* form : k_all_forms) {
    const TestRun now = run_law<Hysteretic>(pair_of_walls(path({0.2, 0.1, 0.4})), form);
    EXPECT_EQ(now.events(), events) << form;
    EXPECT_NEAR(now.at_event("contact-lost", "axial.displacement"), dent, 1e-13) << form;
    EXPECT_NEAR(now.at_event("contact-made", "axial.displacement"), dent, 1e-13) << form;
    EXPECT_NEAR(now.at_event("reload", "axial.displacement"), 0.2, 1e-13) << form;
    EXPECT_NEAR(now.at_event("knee", "axial.displacement"), Hysteretic::k_knee, 1e-13) << form;
    EXPECT_NEAR(now.last("axial.force"), 0.3 + 2.0 * 0.1, 1e-14) << form;
  }
}

TEST(IndependentContacts, FollowAPrescribedForceInTheSameWay) {
  const std::vector<Step> steps{force_ramp(0.2), force_ramp(-0.1), force_ramp(0.5), hold(), force_ramp(0.4)};
  const Names events{"axial:load-reversal", "axial:contact-lost", "axial:contact-made",
                     "axial:reload",        "axial:knee",         "axial:load-reversal"};
  for (const char* form : k_all_forms) {
    const TestRun now = run_law<Hysteretic>(pair_of_walls(steps), form);
    EXPECT_EQ(now.events(), events) << form;
    EXPECT_NEAR(now.time_of("contact-lost"), 1.0 + 2.0 / 3.0, 1e-13) << form;
    EXPECT_NEAR(now.time_of("reload"), 2.4, 1e-13) << form;
    EXPECT_NEAR(now.time_of("knee"), 2.6, 1e-13) << form;
    EXPECT_NEAR(now.last("axial.displacement"), 0.4 - 0.1 / Hysteretic::k_ratio, 1e-14) << form;
  }
}

TEST(IndependentContacts, GoOnFromWhereAnotherControlHasLeftTheWall) {
  const std::vector<Step> steps{ramp(0.2),       force_ramp(0.1), ramp(0.19),       detach(),
                                force_ramp(0.0), hold(),          force_ramp(0.25), ramp(0.2, 0.5)};
  for (const char* form : k_all_forms) {
    const TestRun now = run_law<Hysteretic>(pair_of_walls(steps), form);
    ASSERT_EQ(now.record.status, RunStatus::complete) << form << ": " << now.record.message;
    EXPECT_EQ(now.events(), (Names{"axial:load-reversal", "axial:contact-lost", "axial:contact-made", "axial:reload",
                                   "axial:load-reversal"}))
        << form;
    EXPECT_NEAR(now.last("axial.force"), 0.25 - Hysteretic::k_ratio * 0.05, 1e-14) << form;
  }
}

TEST(IndependentContacts, EndAtTheLimitOfTheLaw) {
  for (const char* form : k_all_forms) {
    for (const Step& step : {ramp(1.0), force_ramp(2.6)}) {
      const TestRun now = run_law<Hysteretic>(pair_of_walls({step}), form);
      EXPECT_EQ(now.record.status, RunStatus::stopped) << form;
      EXPECT_EQ(now.record.limit, Limit::walls_meet) << form;
      EXPECT_EQ(now.events(), (Names{"axial:knee", "axial:limit"})) << form;
      EXPECT_NEAR(now.last("axial.displacement"), k_end, 1e-13) << form;
    }
    // A program may reach the end and go back, but not go further.
    const TestRun there = run_law<Hysteretic>(pair_of_walls(path({k_end, 0.7, k_end})), form);
    EXPECT_EQ(there.record.status, RunStatus::complete) << there.record.message;
    const TestRun on = run_law<Hysteretic>(pair_of_walls(path({k_end, 0.9})), form);
    EXPECT_EQ(on.record.limit, Limit::walls_meet) << form;
    EXPECT_EQ(on.events().back(), "axial:limit") << form;
  }
}

TEST(IndependentContacts, PassABoundaryOnceWhereAStepEndsThere) {
  for (const char* form : k_all_forms) {
    const TestRun now = run_law<Hysteretic>(pair_of_walls(path({0.3, 0.4, 0.39, 0.4, 0.5})), form);
    EXPECT_EQ(now.events(), (Names{"axial:knee", "axial:load-reversal", "axial:reload"})) << form;
    EXPECT_NEAR(now.time_of("knee"), 1.0, 1e-13) << form;
    EXPECT_NEAR(now.time_of("reload"), 4.0, 1e-13) << form;
  }
}

TEST(IndependentContacts, LeaveNoDentWhereAWallHasOnlyTouched) {
  for (const char* form : k_all_forms) {
    const CheckedScenario touching =
        between(pair_of_walls({}), {wall("a", {0, 0, 1}, {until_event(ramp(0.1), "contact-made"), ramp(-0.1)}, 0.1)});
    EXPECT_EQ(run_law<Hysteretic>(touching, form).events(), (Names{"a:contact-made", "until-met", "a:contact-lost"}))
        << form;
  }
}

TEST(IndependentContacts, MayIntegrateTheDisplacementUnderAForce) {
  const double force = 0.4;
  for (const char* form : k_all_forms) {
    const TestRun now =
        run_law<Powerful>(pair_of_walls({force_ramp(force), ramp(0.9), force_ramp(1.2)}), form, {}, relative(1e-10));
    ASSERT_EQ(now.record.status, RunStatus::complete) << form << ": " << now.record.message;
    const auto d = now.column("axial.displacement");
    const auto f = now.column("axial.force");
    for (std::size_t k = 0; k < d.size(); ++k) EXPECT_NEAR(d[k], std::cbrt(f[k] * f[k]), 1e-8) << form << ", row " << k;
    EXPECT_NEAR(now.last("work"), 2.0 * 0.4 * std::pow(1.2, 5.0 / 3.0), 1e-8) << form;
  }
}

TEST(IndependentContacts, MayFollowOthers) {
  for (const char* form : k_all_forms) {
    const TestRun now = run_law<Powerful>(hertz_scenario(Configuration::die, {force_ramp(0.4)}), form);
    EXPECT_EQ(now.events(), (Names{"lateral:yield"})) << form;
    EXPECT_NEAR(now.time_of("yield"), std::pow(0.1, 1.5) / 0.4, 1e-13) << form;
    EXPECT_NEAR(now.last("lateral.force"), 0.04, 1e-8) << form;
    EXPECT_EQ(now.last("lateral.displacement"), 0.0) << form;
    EXPECT_EQ(now.column("lateral.regime").back(), 2.0) << form;
    EXPECT_NEAR(now.last("work"), 2.0 * 0.4 * std::pow(0.4, 5.0 / 3.0), 1e-7) << form;
  }
}

TEST(IndependentContacts, EndTheRunWhereALawHasNoUnloading) {
  const CheckedScenario scenario =
      between(pair_of_walls({}), {wall("a", {0, 0, 1}, path({0.2, 0.1})), wall("b", {0, 0, -1}, path({0.3, 0.4}))});
  const TestRun now = run_law<Powerful>(scenario, "direct");
  EXPECT_EQ(now.record.limit, Limit::no_unloading_law);
  EXPECT_NE(now.record.message.find("nothing helps"), std::string::npos) << now.record.message;
  // The last row has all walls where the step would have begun.
  EXPECT_EQ(now.last("a.displacement"), 0.2);
  EXPECT_EQ(now.last("b.displacement"), 0.3);
}

TEST(IndependentContacts, BalanceTheirEnergies) {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int i = 0; i < 60; ++i) {
    std::vector<double> targets;
    for (int k = 0; k < 6; ++k) targets.push_back(k % 2 == 0 ? k_end * share(generator) : 0.9 * share(generator) - 0.2);
    for (double& target : targets) target = std::min(target, k_end);
    const CheckedScenario scenario = with_points(hertz_scenario(Configuration::hydrostatic, path(targets)), 20);
    const TestRun closed = run_law<HystereticInClosedForm>(scenario, "direct");
    EXPECT_GE(least_dissipation(closed), -1e-14);
    EXPECT_LE(std::abs(lost_dissipation(closed)), 1e-14);
    for (const char* form : k_all_forms) {
      const TestRun now = run_law<Hysteretic>(scenario, form);
      EXPECT_LT(difference(now, closed), 1e-6) << form;
      EXPECT_EQ(now.events(), closed.events()) << form;
      const TestRun finer = run_law<Hysteretic>(scenario, form, {}, relative(1e-11));
      EXPECT_LT(difference(finer, closed), 1e-9) << form;
    }
  }
}

TEST(IndependentContacts, ShowNoColumnsThatTheLawDoesNotHave) {
  const TestRun now = run_law<Spring>(pair_of_walls({ramp(0.1)}), "direct");
  EXPECT_TRUE(now.record.history.find("axial.force"));
  EXPECT_TRUE(now.record.history.find("stored_energy"));
  EXPECT_FALSE(now.record.history.find("axial.pressure"));
  EXPECT_FALSE(now.record.history.find("axial.contact_radius"));
}

Model unnamed() { return {.name = {}, .summary = {}, .source = {}, .material = {}, .domain = {}}; }
Spring spring_of(const ModelInput& input) { return {input.material("stiffness")}; }
Hysteretic hysteretic_of(const ModelInput& /*input*/) { return {}; }

TEST(ModelOf, FillsInWhatFollowsFromTheLaw) {
  const Model spring = contacts::model_of<spring_of>(unnamed());
  EXPECT_EQ(spring.configurations.size(), k_wall_configurations.size());
  EXPECT_EQ(spring.events.size(), contacts::k_events.size() - 1) << "without a boundary there is no limit";
  EXPECT_TRUE(spring.has_free_centre);
  EXPECT_FALSE(spring.has_contact_area);
  ASSERT_NE(spring.bind, nullptr);
  const std::map<std::string, double> values{{"stiffness", 2.0}};
  const std::map<std::string, OptionValue> options;
  const std::map<std::string, SampledCurve> curves;
  const ModelInput input{.radius = 3.0, .values = values, .options = options, .curves = curves};
  const std::vector<ContactClass> one_wall{{.name = "axial", .normals = {Eigen::Vector3d::UnitZ()}}};
  const auto system = spring.bind(input, one_wall, {});
  EXPECT_EQ(system->classes().size(), 1u);
  EXPECT_EQ(system->unknowns().size(), 1u) << "the work alone: no force is prescribed";
}

TEST(ModelOf, KeepsTheWallSetsAndEventsThatAModelNames) {
  constexpr std::array<std::string_view, 1> k_simple{"simple"};
  constexpr std::array k_own{Term{"yield", "the law bends"}};
  Model own = unnamed();
  own.configurations = k_simple;
  own.events = k_own;
  const Model model = contacts::model_of<hysteretic_of>(own);
  EXPECT_EQ(model.configurations.size(), 1u);
  EXPECT_EQ(model.events.size(), 1u);
}

TEST(LawCheck, FindsFunctionsThatDoNotBelongTogether) {
  EXPECT_EQ(contacts::contradiction_in(Spring{}, 0.1), "");
  EXPECT_EQ(contacts::contradiction_in(Hysteretic{}, 0.0), "");
  struct TooSteep : Spring {
    double slope(Branch, double) const { return 5.0; }
  };
  EXPECT_EQ(contacts::contradiction_in(TooSteep{}, 0.1),
            "slope(b, d) is 5 at displacement 0.02 R0, but force(b, d) grows by 1 there");
  struct DoubleInverse : Spring {
    double displacement(Branch, double force) const { return 2.0 * force; }
  };
  EXPECT_EQ(contacts::contradiction_in(DoubleInverse{}, 0.1),
            "displacement(b, F) is 0.04 for the force at displacement 0.02 R0; expected that displacement");
  struct NoForce : Spring {
    double force(Branch, double) const { return std::nan(""); }
  };
  EXPECT_EQ(contacts::contradiction_in(NoForce{}, 0.1),
            "force(b, d) is nan at displacement 0.02 R0; expected a finite number");
  struct Ends : Spring {
    double force(Branch, double d) const { return d < 0.06 ? d : throw std::domain_error("the end"); }
  };
  EXPECT_EQ(contacts::contradiction_in(Ends{}, 0.1), "") << "the run itself ends there";
  struct Plateau : Spring {
    double force(Branch, double d) const { return 0.3 + 1e-12 * std::sin(1e9 * d); }
    double slope(Branch, double) const { return 0.0; }
    double work(Branch, double d) const { return 0.3 * d; }
  };
  EXPECT_EQ(contacts::contradiction_in(Plateau{}, 0.1), "") << "round-off";
  struct ThirdRegime : Spring {
    int regime(Branch, bool touches) const { return touches ? 2 : 0; }
  };
  EXPECT_EQ(contacts::contradiction_in(ThirdRegime{}, 0.1),
            "regime(b, touches) is 2; expected a place in k_regimes, from 0 to 1");
  struct HalfWork : Spring {
    double work(Branch, double d) const { return 0.25 * d * d; }
  };
  EXPECT_TRUE(contacts::contradiction_in(HalfWork{}, 0.1).starts_with("work(b, d) grows by 0.01 at"));
}

TEST(LawCheck, FindsAForceThatPulls) {
  struct Pulling : Spring {
    double force(Branch, double d) const { return -d; }
    double slope(Branch, double) const { return -1.0; }
    double work(Branch, double d) const { return -0.5 * d * d; }
  };
  EXPECT_EQ(contacts::contradiction_in(Pulling{}, 0.1),
            "force(b, d) is -0.02 at displacement 0.02 R0, and the contact opens at 0 R0; expected a force above 0 "
            "beyond that");
}

TEST(LawCheck, FindsUnloadingThatDoesNotBelongToLoading) {
  EXPECT_EQ(contacts::contradiction_in(Hysteretic{}, 0.2), "");
  EXPECT_EQ(contacts::contradiction_in(HystereticInClosedForm{}, 0.2), "");
  struct NeverReloads : Hysteretic {
    void reload(Branch&) const {}
  };
  EXPECT_EQ(contacts::contradiction_in(NeverReloads{}, 0.2),
            "after unloading begins at displacement 0.04 R0 and reloading, force and slope beyond it are 0.0400016 and "
            "4; without unloading they are 0.0400004 and 1");
  struct Jumps : Hysteretic {
    void turn(Branch& b, double d) const { b = {b.is_past_knee, true, d, 0.5 * force(b, d)}; }
  };
  EXPECT_EQ(contacts::contradiction_in(Jumps{}, 0.2),
            "force(b, d) is 0.02 where unloading begins at displacement 0.04 R0, and was 0.04 before");
  struct WrongSlope : Hysteretic {
    double slope(const Branch& b, double d) const { return b.unloads ? 3.0 : Hysteretic::slope(b, d); }
  };
  EXPECT_EQ(contacts::contradiction_in(WrongSlope{}, 0.2),
            "slope(b, d) is 3 at displacement 0.039 R0, but force(b, d) grows by 4 there, in unloading");
}

struct SpringWithAHole : Spring {
  double force(Branch, double d) const { return d < 0.06 ? d : std::nan(""); }
};

TEST(IndependentContacts, StopWhereTheLawGivesNoFiniteForce) {
  for (const char* form : k_all_forms) {
    const TestRun run = run_law<SpringWithAHole>(pair_of_walls({ramp(0.1)}), form);
    EXPECT_NE(run.record.status, RunStatus::complete) << form;
    EXPECT_NE(run.record.message, "") << form;
    for (const double force : run.column("axial.force")) EXPECT_TRUE(std::isfinite(force)) << form;
  }
}

struct WithoutAUnit : Spring {
  double unit_force(double) const { return 0.0; }
};
WithoutAUnit without_a_unit(const ModelInput& /*input*/) { return {}; }

TEST(ModelOf, RefusesALawWhoseUnitOfForceIsNone) {
  const Model model = contacts::model_of<without_a_unit>(unnamed());
  const std::map<std::string, double> values;
  const std::map<std::string, OptionValue> options;
  const std::map<std::string, SampledCurve> curves;
  const ModelInput input{.radius = 3.0, .values = values, .options = options, .curves = curves};
  EXPECT_THROW(static_cast<void>(model.bind(input, {}, {})), std::runtime_error);
}

}  // namespace
}  // namespace monograin::contacts_test
