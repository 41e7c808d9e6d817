// Which contacts balance a push on a free centre.

#include "mdr/support.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mdr/guards.hpp"
#include "models/mdr/particles.hpp"
#include "support/test_run.hpp"

namespace monograin::mdr::support_test {
namespace {

const Eigen::Vector3d k_up{0.0, 0.0, 1.0};
const Eigen::Vector3d k_right{1.0, 0.0, 0.0};

/// Normal in the x-z plane, at an angle from z.
Eigen::Vector3d at_degrees(double angle) {
  const double radians = angle * M_PI / 180.0;
  return {std::sin(radians), 0.0, std::cos(radians)};
}

std::vector<std::string> names_of(const std::vector<Event>& log) {
  std::vector<std::string> names;
  for (const Event& event : log) names.emplace_back(event.name);
  return names;
}

TEST(MdrSupport, OppositeWallsSupportEachOther) {
  const Particle p = particle_between({resting(k_up, 1e-3), resting(-k_up, 1e-3)});
  EXPECT_TRUE(is_supported(p, 0));
  EXPECT_TRUE(is_supported(p, 1));
}

TEST(MdrSupport, AWallAtARightAngleSupportsNone) {
  const Particle p = particle_between({resting(k_up, 1e-3), resting(k_right, 1e-3)});
  EXPECT_FALSE(is_supported(p, 0));
  EXPECT_FALSE(is_supported(p, 1));
}

TEST(MdrSupport, TwoWallsSupportAThirdInTheConeBetweenTheirNormals) {
  for (const double angle : {150.0, 179.0}) {
    const Particle p =
        particle_between({resting(k_up, 1e-3), resting(at_degrees(angle), 1e-3), resting(at_degrees(-100.0), 1e-3)});
    EXPECT_TRUE(is_supported(p, 0)) << angle;
  }
  const Particle p =
      particle_between({resting(k_up, 1e-3), resting(at_degrees(150.0), 1e-3), resting(at_degrees(170.0), 1e-3)});
  EXPECT_FALSE(is_supported(p, 0));
}

TEST(MdrSupport, AnOpenContactSupportsNone) {
  Particle p = particle_between({resting(k_up, 1e-3), resting(-k_up, 1e-3)});
  p.lose(1);
  EXPECT_FALSE(is_supported(p, 0));
}

TEST(MdrSupport, AFixedCentreNeedsNone) {
  Particle p = particle_between({pressing(k_up, 1e-3), pressing(k_right, 1e-3)}, false);
  EXPECT_NO_THROW(check_support(p));
}

TEST(MdrSupport, WallsWithoutForceControlConstrainTheCentreAlongTheirNormals) {
  Particle pair = particle_between({resting(k_up, 1e-3), resting(-k_up, 1e-3), pressing(k_right, 1e-3)});
  const CentreMatrix left = unconstrained_directions(pair);
  EXPECT_NEAR(left.trace(), pair.centre().free_directions() - 1.0, 1e-14);
  EXPECT_NEAR((left * pair.centre().mean_normal(0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((left * pair.centre().mean_normal(2) - pair.centre().mean_normal(2)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((left * left - left).norm(), 0.0, 1e-14) << "a projector";
}

TEST(MdrSupport, PrescribedForcesAddUpAsVectors) {
  const Particle p = particle_between({pressing(k_up, 3e-3), pressing(k_right, 4e-3), resting(-k_up, 0.0)});
  EXPECT_NEAR(prescribed_push(p, 0.0).norm(), 5e-3, 1e-17);
  EXPECT_EQ(largest_prescribed_force(p), 4e-3);
}

TEST(MdrSupport, ForcesOfOppositeWallsBalance) {
  Particle p = particle_between({pressing(k_up, 1e-3), pressing(-k_up, 1e-3)});
  EXPECT_LT(prescribed_push(p, 0.0).norm(), 1e-17);
  EXPECT_NO_THROW(check_support(p));
}

TEST(MdrSupport, RefusesForcesThatNoWallBalances) {
  Particle p = particle_between({pressing(k_up, 2e-3), pressing(-k_up, 1e-3)});
  EXPECT_THROW(check_support(p), std::domain_error);
  Particle blocked = particle_between({pressing(k_up, 2e-3), pressing(-k_up, 1e-3), resting(-k_up, 0.0)});
  EXPECT_NO_THROW(check_support(blocked));
}

TEST(MdrSupport, RefusesForcesThatBalanceOnlyAtTheStartOfTheStep) {
  Particle p = particle_between({{k_up, {1e-3, 2e-3, Control::force}}, pressing(-k_up, 1e-3)});
  EXPECT_THROW(check_support(p), std::domain_error);
}

TEST(MdrSupport, TheNearestWallsCloseWithTheContactThatTheySupport) {
  // Two walls are a part of the integration error away. The nearer one is enough.
  Particle p = particle_between({resting(k_up, 0.0), away(-k_up, 0.1 * k_together), away(k_right, 0.5 * k_together)});
  std::vector<Event> log;
  balance_touch(p, 0, true, log);
  EXPECT_EQ(names_of(log), std::vector<std::string>{"contact-made"});
  EXPECT_TRUE(p.branch(1).touches());
  EXPECT_FALSE(p.branch(2).touches());
}

TEST(MdrSupport, AFarWallStaysOpen) {
  Particle p = particle_between({resting(k_up, 0.0), away(-k_up, 1e3 * k_together)});
  std::vector<Event> log;
  balance_touch(p, 0, true, log);
  EXPECT_TRUE(log.empty());
  EXPECT_FALSE(p.branch(1).touches());
}

TEST(MdrSupport, AContactThatLosesItsOppositeOneOpens) {
  Particle p = particle_between({resting(k_up, 0.0), resting(-k_up, 0.0)});
  p.lose(0);
  std::vector<Event> log;
  balance_touch(p, 0, false, log);
  EXPECT_EQ(names_of(log), std::vector<std::string>{"contact-lost"});
  EXPECT_FALSE(p.branch(1).touches());
}

TEST(MdrSupport, AForceTakesALooseParticleToTheWallThatBearsIt) {
  Particle p = particle_between({{k_up, {0.0, 1e-3, Control::force}}, away(-k_up, 0.25)});
  std::vector<double> y = initial_state(p);
  std::vector<Event> log;
  carry_to_support(p, 0.0, y, log);
  EXPECT_EQ(names_of(log), std::vector<std::string>{"contact-made"});
  EXPECT_TRUE(p.branch(1).touches());
  EXPECT_NEAR(p.contact(1).overlap, 0.0, 1e-15);
  EXPECT_NEAR(centre_of(y, p.centre().free_directions()).norm(), 0.25, 1e-15);
}

TEST(MdrSupport, NothingIsCarriedInTheMiddleOfAStep) {
  Particle p = particle_between({{k_up, {0.0, 1e-3, Control::force}}, away(-k_up, 0.25)});
  std::vector<double> y = initial_state(p);
  std::vector<Event> log;
  carry_to_support(p, 0.5, y, log);
  EXPECT_TRUE(log.empty());
  EXPECT_EQ(y, initial_state(p));
}

// All walls touch at first, and the push presses the particle against three of them. A search that kept the others
// would find contacts that pull, and no balance.
TEST(MdrSupport, AParticleInANestOfWallsRestsOnThoseThatBearAnElasticOne) {
  const std::vector<WallSpec> nest{wall("a", {0.9, -0.1, -0.4}),
                                   wall("b", {-0.1, 0.5, 0.9}),
                                   wall("c", {-0.9, -0.1, -0.4}),
                                   wall("d", {0.2, -0.9, -0.4}),
                                   wall("e", {-0.5, -0.6, -0.6}),
                                   wall("f", {-0.6, -0.7, 0.3}),
                                   wall("g", {0.1, -0.9, 0.4}, {force_ramp(1e-5)})};
  const auto forces_of = [&](CheckedScenario scenario) {
    scenario = between(std::move(scenario), nest);
    scenario.loading.centre_is_free = true;
    const TestRun result = run(scenario);
    EXPECT_EQ(result.record.status, RunStatus::complete) << result.record.message;
    std::vector<double> forces;
    for (const WallSpec& spec : nest) forces.push_back(result.last(spec.name + ".force"));
    return forces;
  };
  const auto mdr = forces_of(mdr_scenario(Configuration::walls, 25.0, 0.3, {}));
  const auto hertz = forces_of(hertz_scenario(Configuration::walls, {}));
  EXPECT_EQ(std::ranges::count_if(hertz, [](double force) { return force > 0.0; }), 4) << "three walls and the push";
  for (std::size_t i = 0; i < nest.size(); ++i) EXPECT_NEAR(mdr[i], hertz[i], 1e-12) << nest[i].name;
}

}  // namespace
}  // namespace monograin::mdr::support_test
