#include "mdr/idle.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "models/mdr/particles.hpp"

namespace monograin::mdr::resolution_test {
namespace {

/// Two pairs of opposite walls, the first pressed by `deep` and the second by `shallow`, over R0.
Particle pressed(double deep, double shallow, bool is_free = true) {
  return particle_between(
      {resting({0, 0, 1}, deep), resting({0, 0, -1}, deep), resting({-1, 0, 0}, shallow), resting({1, 0, 0}, shallow)},
      is_free);
}

TEST(MdrIdle, GrowsWithTheForcesOnTheCentre) {
  const Particle soft = pressed(1e-4, 1e-4);
  const Particle hard = pressed(1e-2, 1e-2);
  EXPECT_GT(hard.force_round_off(), soft.force_round_off());
  EXPECT_GE(resolution(hard), resolution(soft));
  EXPECT_GE(resolution(soft), k_resolution);
}

TEST(MdrIdle, RoundOffOfForcesIsNegligibleBesideThem) {
  const Particle p = pressed(1e-3, 1e-3);
  EXPECT_GT(p.force_round_off(), std::numeric_limits<double>::epsilon() * p.magnitude_of_forces());
  EXPECT_LT(p.force_round_off(), 1e-9 * p.magnitude_of_forces());
}

TEST(MdrIdle, AContactOfAFreeCentreBelowItIsIdle) {
  const Particle p = pressed(1e-3, 1e-14);
  EXPECT_FALSE(is_idle(p, 0));
  EXPECT_TRUE(is_idle(p, 2));
  EXPECT_LT(p.contact(2).overlap, resolution(p));
}

TEST(MdrIdle, NoContactOfAFixedCentreIsIdle) {
  const Particle p = pressed(1e-3, 1e-14, false);
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_FALSE(is_idle(p, i));
}

TEST(MdrIdle, AnOpenContactIsNotIdle) {
  Particle p = pressed(1e-3, 1e-14);
  p.lose(2);
  EXPECT_FALSE(is_idle(p, 2));
}

}  // namespace
}  // namespace monograin::mdr::resolution_test
