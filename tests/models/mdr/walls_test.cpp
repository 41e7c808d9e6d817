#include "mdr/walls.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace monograin::mdr::walls_test {
namespace {

/// Classes of one wall each, on opposite sides and across; E/Y = 50, R0 = 2 m.
Setup setup() {
  const Settings settings{
      .initial_radius = 2.0, .youngs_modulus = 50.0, .poisson_ratio = 0.3, .yield_stress = 1.0, .centre_is_free = true};
  const auto wall = [](const char* name, const Eigen::Vector3d& normal) {
    return ContactClass{.name = name, .normals = {normal}, .gap = 0.0, .takes_force = true};
  };
  return {settings, {wall("top", {0, 0, 1}), wall("bottom", {0, 0, -1}), wall("side", {1, 0, 0})}};
}

Walls driven(const Setup& setup, const std::vector<Ramp>& ramps) {
  Walls walls(setup.classes.size());
  walls.set_drives(setup, ramps);
  return walls;
}

TEST(MdrWalls, MeasureDisplacementsInRadiiAndForcesInTheirUnit) {
  const auto at = setup();
  const Walls walls = driven(at, {{0.0, 1.0}, {0.0, 3.0, Control::force}, {0.5, 0.25}});
  EXPECT_DOUBLE_EQ(walls.drive(0).end(), 0.5);
  EXPECT_DOUBLE_EQ(walls.drive(1).end(), 3.0 / at.force_unit());
  EXPECT_FALSE(walls.is_force_controlled(0));
  EXPECT_TRUE(walls.is_force_controlled(1));
}

TEST(MdrWalls, PositionsAreExactAtBothEndsOfAStep) {
  const Walls walls = driven(setup(), {{0.1, 0.7}, {0.0, 0.0}, {0.5, 0.25}});
  for (const std::size_t i : {0U, 1U, 2U}) {
    EXPECT_EQ(walls.displacement(i, 0.0), walls.drive(i).start());
    EXPECT_EQ(walls.displacement(i, 1.0), walls.drive(i).end());
    EXPECT_DOUBLE_EQ(walls.displacement(i, 0.3), walls.drive(i).value(0.3));
  }
}

TEST(MdrWalls, TheFastestWallUnderDisplacementControlGivesTheSpeed) {
  const auto at = setup();
  EXPECT_DOUBLE_EQ(driven(at, {{0.0, 0.4}, {0.0, -0.6}, {0.0, 9.0, Control::force}}).speed_scale(), 0.3);
  EXPECT_EQ(driven(at, {{0.4, 0.4}, {0.2, 0.2}, {0.0, 9.0, Control::force}}).speed_scale(), 1.0);
}

TEST(MdrWalls, AForceThatIsRoundOffBesideTheOthersMayBeSlight) {
  const Walls walls =
      driven(setup(), {{0.0, 1.0, Control::force}, {0.0, 0.5 * k_no_net_force, Control::force}, {0.0, 1e-12}});
  EXPECT_FALSE(walls.may_be_negligible(0));
  EXPECT_TRUE(walls.may_be_negligible(1));
  EXPECT_FALSE(walls.may_be_negligible(2));  // a displacement
}

TEST(MdrWalls, BearUntilTheirContactIsBalancedByNoOthers) {
  Walls walls(2);
  EXPECT_TRUE(walls.bears(0) && walls.bears(1));
  walls.set_bears(1, false);
  EXPECT_TRUE(walls.bears(0));
  EXPECT_FALSE(walls.bears(1));
}

}  // namespace
}  // namespace monograin::mdr::walls_test
