/// The search for the mode of an MDR particle at an instant, without an integrator.

#include "mdr/mode_search.hpp"

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mdr/guards.hpp"

namespace monograin::mdr::mode_search_test {
namespace {

/// Two walls of one class; E/Y = 50.
Particle particle(double first, double last, Control control = Control::displacement) {
  const Settings settings{.initial_radius = 1.0, .youngs_modulus = 50.0, .poisson_ratio = 0.3, .yield_stress = 1.0};
  const bool takes_force = control == Control::force;
  const ContactClass walls{
      .name = "walls", .normals = {{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}}, .gap = 0.0, .takes_force = takes_force};
  Particle result(std::make_shared<const Setup>(settings, std::vector{walls}));
  result.start();
  result.set_drives(std::vector{Ramp{first, last, control}});
  result.set_branch(0, ContactBranch{}.made());
  return result;
}

struct Found {
  std::vector<double> y;
  std::vector<Event> log;
  [[nodiscard]] std::vector<std::string> events() const {
    std::vector<std::string> names;
    for (const Event& event : log) names.emplace_back(event.name);
    return names;
  }
};

Found resolve(ModeSearch& search, double xi = 0.0) {
  Found found{.y = std::vector<double>(search.particle().setup().unknown_count()), .log = {}};
  search.resolve(xi, found.y, found.log);
  return found;
}

using Names = std::vector<std::string>;

TEST(MdrModeSearch, LeavesTheParticleAloneThatItBeganWith) {
  const Particle before = particle(0.05, 0.0);
  ModeSearch search(before);
  search.begin(before);
  resolve(search);
  EXPECT_TRUE(before.branch(0).is_on_primary_branch);
  EXPECT_FALSE(search.particle().branch(0).is_on_primary_branch);
}

TEST(MdrModeSearch, KeepsAConsistentMode) {
  const Particle before = particle(1e-4, 1e-3);
  ModeSearch search(before);
  search.begin(before);
  EXPECT_EQ(resolve(search).events(), Names{});
  EXPECT_EQ(search.particle().branch(0).regime, Regime::elastic);
}

TEST(MdrModeSearch, UnloadsWhereAWallRetreatsFromTheLargestOverlap) {
  const Particle before = particle(1e-3, 0.0);
  ModeSearch search(before);
  search.begin(before);
  EXPECT_EQ(resolve(search).events(), Names{"load-reversal"});
  EXPECT_DOUBLE_EQ(search.particle().branch(0).largest_measure, 1e-3);
}

TEST(MdrModeSearch, YieldsAndGrowsWhereAContactIsDrivenInBeyondItsElasticLimit) {
  const Particle before = particle(0.02, 0.1);
  ASSERT_GT(0.02, before.law().material.yield_overlap_ratio);
  ModeSearch search(before);
  search.begin(before);
  EXPECT_EQ(resolve(search).events(), (Names{"yield", "growth-on"}));
  EXPECT_TRUE(search.particle().mode.is_growing);
  EXPECT_EQ(search.particle().branch(0).regime, Regime::fully_plastic);
}

TEST(MdrModeSearch, FreezesTheBalanceWithWhichTheRadiusGrows) {
  const Particle before = particle(0.02, 0.1);
  ModeSearch search(before);
  search.begin(before);
  const Found found = resolve(search);
  Particle& after = search.particle();
  EXPECT_EQ(after.at_state(0.0, found.y).volume.value, after.mode.frozen_balance);
  EXPECT_NE(after.mode.frozen_balance, 0.0);
}

TEST(MdrModeSearch, AppliesAGuardThatHasFired) {
  const Particle before = particle(0.0, 0.1);
  ContactCaps caps(before.setup());
  ModeSearch search(before);
  search.begin(before);
  Found found{.y = std::vector<double>(before.setup().unknown_count()), .log = {}};
  const std::vector<Guard> fired{{.kind = k_yield, .index = 0, .direction = 1, .name = "yield"}};
  EXPECT_FALSE(search.apply(fired, 0.3, found.y, caps, found.log));
  EXPECT_EQ(found.events(), Names{"yield"});
  EXPECT_EQ(before.branch(0).regime, Regime::elastic);
  search.resolve(0.3, found.y, found.log);
  EXPECT_EQ(found.events(), (Names{"yield", "growth-on"}));
}

TEST(MdrModeSearch, EndsWhereTheWallHasReachedTheCentre) {
  const Particle before = particle(0.0, 0.1);
  ContactCaps caps(before.setup());
  ModeSearch search(before);
  search.begin(before);
  Found found{.y = std::vector<double>(before.setup().unknown_count()), .log = {}};
  const std::vector<Guard> fired{{.kind = k_centre_reached, .index = 0, .direction = -1, .name = "limit"}};
  const auto end = search.apply(fired, 0.3, found.y, caps, found.log);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->point.limit, Limit::wall_at_centre);
  EXPECT_EQ(found.events(), Names{"limit"});
}

TEST(MdrModeSearch, ShowsTheModeThatItTriedLastWhereThereIsNone) {
  // A force above the largest that a plastic contact can carry.
  Particle before = particle(0.0, 50.0, Control::force);
  before.set_branch(0, before.branch(0).yielded(before.law(), 0.0));
  ModeSearch search(before);
  search.begin(before);
  Found found{.y = std::vector<double>(before.setup().unknown_count()), .log = {}};
  EXPECT_THROW(search.resolve(1.0, found.y, found.log), std::domain_error);
  EXPECT_EQ(search.particle().branch(0).regime, Regime::fully_plastic);
  search.begin(particle(1e-4, 1e-3));
  EXPECT_EQ(resolve(search).events(), Names{});
}

TEST(MdrModeSearch, IsNotMisledByTheOneBefore) {
  const Particle before = particle(1e-3, 0.0);
  ModeSearch search(before);
  search.begin(before);
  const Names once = resolve(search).events();
  search.begin(before);
  EXPECT_EQ(resolve(search).events(), once);
}

}  // namespace
}  // namespace monograin::mdr::mode_search_test
