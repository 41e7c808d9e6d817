#include "nonlocal/guards.hpp"

#include <algorithm>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "models/nonlocal/cases.hpp"

namespace monograin::nonlocal::nonlocal_guards_test {
namespace {

/// A particle in a die whose axial walls move; both classes are in contact.
struct Guarded {
  explicit Guarded(const Ramp& axial, Settings settings = unit_settings())
      : particle(settings, die()), guards(particle.contacts()), y(3, 0.0) {
    particle.set_ramps(std::vector<Ramp>{axial, {0.0, 0.0}}, y);
    particle.mode.is_closed = {1, 1};
    particle.solve(0.0, y);
    particle.evaluate(0.0, y);
    guards.arm(particle);
  }

  [[nodiscard]] std::vector<int> kinds() const {
    std::vector<int> kinds;
    for (const Guard& guard : guards.list()) kinds.push_back(guard.kind);
    return kinds;
  }
  [[nodiscard]] bool has(int kind) const { return std::ranges::count(kinds(), kind) > 0; }
  /// Value of the first guard of a kind.
  [[nodiscard]] double value(int kind, double xi) {
    std::vector<double> state = y;
    particle.solve(xi, state);
    std::vector<double> values(guards.list().size());
    guards.values(particle, xi, state, values);
    const auto list = guards.list();
    return values[static_cast<std::size_t>(std::ranges::find(list, kind, &Guard::kind) - list.begin())];
  }

  Particle particle;
  GuardSet guards;
  std::vector<double> y;
};

TEST(NonlocalGuards, AreThoseOfTheMode) {
  Guarded guarded({0.1, 0.2});
  EXPECT_EQ(std::ranges::count(guarded.kinds(), int{k_lost}), 2);
  EXPECT_FALSE(guarded.has(k_made));
  EXPECT_TRUE(guarded.has(k_stiffening));
  EXPECT_FALSE(guarded.has(k_limit));  // the particle stiffens first
  guarded.particle.mode.is_closed[1] = false;
  guarded.guards.arm(guarded.particle);
  EXPECT_TRUE(guarded.has(k_made));
  EXPECT_FALSE(guarded.has(k_impingement));
  guarded.guards.stiffen();
  guarded.guards.arm(guarded.particle);
  EXPECT_FALSE(guarded.has(k_stiffening));
  EXPECT_TRUE(guarded.has(k_limit));
}

TEST(NonlocalGuards, AreNoneWhereAllWallsRest) { EXPECT_TRUE(Guarded({0.1, 0.1}).guards.list().empty()); }

TEST(NonlocalGuards, VanishWhereContactIsLost) {
  Guarded guarded({0.1, -0.1});
  EXPECT_GT(guarded.value(k_lost, 0.4), 0.0);
  EXPECT_LT(guarded.value(k_lost, 0.6), 0.0);
}

TEST(NonlocalGuards, VanishWhereTheMarginIsThatOfStiffening) {
  Guarded guarded({0.0, 0.45});
  for (const double xi : {0.5, 0.7, 0.8, 0.9, 0.95}) {
    const double value = guarded.value(k_stiffening, xi);
    EXPECT_EQ(value > 0.0, guarded.particle.contacts().margin(guarded.particle.state()) > k_stiff_margin) << xi;
  }
}

TEST(NonlocalGuards, ListEveryPairOfWallsThatMayMeetOnce) {
  // Lateral walls among each other, and with the axial ones: a right angle in both cases.
  const std::vector<Pair> pairs = pairs_of(Contacts({k_rubber}, die(), Centre::fixed));
  ASSERT_EQ(pairs.size(), 2u);
  for (const Pair& pair : pairs) EXPECT_NEAR(pair.angle, 0.5 * std::numbers::pi, 1e-15);
  EXPECT_TRUE(pairs_of(Contacts({k_rubber}, simple(), Centre::fixed)).empty());  // opposite walls never meet

  Guarded guarded({0.0, 0.45});
  EXPECT_EQ(std::ranges::count(guarded.kinds(), int{k_impingement}), 2);
  guarded.guards.impinge(0);
  guarded.guards.arm(guarded.particle);
  EXPECT_EQ(std::ranges::count(guarded.kinds(), int{k_impingement}), 1);
  guarded.guards.start();
  guarded.guards.arm(guarded.particle);
  EXPECT_EQ(std::ranges::count(guarded.kinds(), int{k_impingement}), 2);
}

TEST(NonlocalGuards, StopAStepThatBeginsAtALimitAndLeadsBeyond) {
  Settings settings = unit_settings();
  settings.model.terms = Terms::one;
  settings.radius_rule = RadiusRule::none;
  settings.reach.displacement = 1.0;
  const std::vector<ContactClass> wall{{.name = "wall", .normals = {Eigen::Vector3d::UnitZ()}}};
  const auto at_centre = [&](double target) {
    Particle particle(settings, wall);
    GuardSet guards(particle.contacts());
    std::vector<double> y(2, 0.0);
    particle.set_ramps(std::vector<Ramp>{{1.0, target}}, y);
    particle.mode.is_closed = {1};
    particle.solve(0.0, y);
    particle.evaluate(0.0, y);
    guards.arm(particle);
    return guards.limit_at_start(particle, y);
  };
  EXPECT_FALSE(at_centre(0.9).has_value());
  const auto end = at_centre(1.1);
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->point.limit, Limit::wall_at_centre);
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_guards_test
