#include "mdr/resolution.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <vector>

namespace monograin::mdr::resolution_test {
namespace {

/// Two pairs of opposite walls, the first pressed by `deep` and the second by `shallow`, over R0; E/Y = 50.
Particle pressed(double deep, double shallow, bool is_free = true) {
  const Settings settings{.initial_radius = 1.0,
                          .youngs_modulus = 50.0,
                          .poisson_ratio = 0.3,
                          .yield_stress = 1.0,
                          .centre_is_free = is_free};
  const auto wall = [](const char* name, const Eigen::Vector3d& normal) {
    return ContactClass{.name = name, .normals = {normal}, .gap = 0.0, .takes_force = false};
  };
  Particle p(std::make_shared<const Setup>(settings, std::vector{wall("top", {0, 0, 1}), wall("bottom", {0, 0, -1}),
                                                                 wall("left", {-1, 0, 0}), wall("right", {1, 0, 0})}));
  p.start();
  p.set_drives(std::vector{Ramp{deep, deep}, Ramp{deep, deep}, Ramp{shallow, shallow}, Ramp{shallow, shallow}});
  for (std::size_t i = 0; i < p.size(); ++i) p.set_branch(i, ContactBranch{}.made());
  p.evaluate(0.0, std::vector<double>(p.setup().unknown_count(), 0.0));
  return p;
}

TEST(MdrResolution, GrowsWithTheForcesOnTheCentre) {
  const Particle soft = pressed(1e-4, 1e-4);
  const Particle hard = pressed(1e-2, 1e-2);
  EXPECT_GT(hard.force_round_off(), soft.force_round_off());
  EXPECT_GE(resolution(hard), resolution(soft));
  EXPECT_GE(resolution(soft), k_resolution);
}

TEST(MdrResolution, RoundOffOfForcesIsNegligibleBesideThem) {
  const Particle p = pressed(1e-3, 1e-3);
  EXPECT_GT(p.force_round_off(), std::numeric_limits<double>::epsilon() * p.magnitude_of_forces());
  EXPECT_LT(p.force_round_off(), 1e-9 * p.magnitude_of_forces());
}

TEST(MdrResolution, AContactOfAFreeCentreBelowItIsIdle) {
  const Particle p = pressed(1e-3, 1e-14);
  EXPECT_FALSE(is_idle(p, 0));
  EXPECT_TRUE(is_idle(p, 2));
  EXPECT_LT(p.contact(2).overlap, resolution(p));
}

TEST(MdrResolution, NoContactOfAFixedCentreIsIdle) {
  const Particle p = pressed(1e-3, 1e-14, false);
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_FALSE(is_idle(p, i));
}

TEST(MdrResolution, AnOpenContactIsNotIdle) {
  Particle p = pressed(1e-3, 1e-14);
  p.lose(2);
  EXPECT_FALSE(is_idle(p, 2));
}

}  // namespace
}  // namespace monograin::mdr::resolution_test
