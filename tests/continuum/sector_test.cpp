#include "continuum/sector.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "exchange/motion_of_run.hpp"
#include "support/refusal.hpp"
#include "support/test_run.hpp"

namespace monograin {
namespace {

CheckedScenario between_walls(const std::vector<WallSpec>& walls) {
  return between(mdr_scenario(Configuration::simple, 50.0, 0.3, {}), walls);
}

TEST(Sector, OfTwoWallsIsAWedge) {
  const Sector sector = sector_of(motion_of_run(mdr_scenario(Configuration::simple, 50.0, 0.3, path({0.1}))));
  EXPECT_TRUE(sector.is_axisymmetric);
  ASSERT_EQ(sector.walls.size(), 1U);
  EXPECT_EQ(sector.walls[0].axis, 2);
  EXPECT_NEAR(sector.walls[0].multiplicity * sector.angle, 2.0 * std::numbers::pi, 1e-12);
}

TEST(Sector, OfADieHasTheMovingWallsOnItsAxis) {
  const Motion motion = motion_of_run(mdr_scenario(Configuration::die, 50.0, 0.3, path({0.1})));
  const Sector sector = sector_of(motion);
  EXPECT_NEAR(sector.angle, std::numbers::pi / 4.0, 1e-12);
  ASSERT_EQ(sector.walls.size(), 2U);
  EXPECT_EQ(motion.classes[motion.walls[sector.walls[0].wall].contact_class], "axial");
  EXPECT_EQ(sector.walls[0].axis, 2);
  EXPECT_EQ(motion.classes[motion.walls[sector.walls[1].wall].contact_class], "lateral");
  EXPECT_EQ(sector.walls[1].axis, 0);
  // The sector has an eighth of each axial contact and a quarter of each lateral one.
  EXPECT_NEAR(sector.walls[0].multiplicity, 8.0, 1e-12);
  EXPECT_NEAR(sector.walls[1].multiplicity, 4.0, 1e-12);
}

TEST(Sector, PutsThePairUnlikeTheOthersOnItsAxisAlsoWhereItMovesLeast) {
  std::vector<WallSpec> walls;
  for (const Eigen::Vector3d normal : {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()}) {
    const double depth = normal.y() == 1.0 ? 0.02 : 0.1;
    walls.push_back(wall("plus", normal, path({depth})));
    walls.push_back(wall("minus", -normal, path({depth})));
    walls[walls.size() - 2].name += std::to_string(walls.size());
    walls.back().name += std::to_string(walls.size());
  }
  const Motion motion = motion_of_run(between_walls(walls));
  const Sector sector = sector_of(motion);
  EXPECT_NEAR(sector.angle, std::numbers::pi / 4.0, 1e-12);
  EXPECT_NEAR(motion.overlap(motion.walls[sector.walls[0].wall], motion.instants.back()), 0.02, 1e-12);
}

TEST(Sector, OfThreeDifferentPairsIsAQuarterWithTheDeepestOnItsAxis) {
  const Motion motion = motion_of_run(read_scenario(MONOGRAIN_SOURCE_DIR "/scenarios/triaxial.toml"));
  const Sector sector = sector_of(motion);
  EXPECT_NEAR(sector.angle, std::numbers::pi / 2.0, 1e-12);
  ASSERT_EQ(sector.walls.size(), 3U);
  const auto depth = [&](std::size_t i) {
    return motion.overlap(motion.walls[sector.walls[i].wall], motion.instants.back()) / motion.initial_radius;
  };
  for (const SectorWall& wall : sector.walls) EXPECT_NEAR(wall.multiplicity, 4.0, 1e-12);
  EXPECT_NEAR(depth(0), 0.2, 1e-12);
  EXPECT_NEAR(depth(1), 0.05, 1e-12);
  EXPECT_NEAR(depth(2), 0.0, 1e-12);
}

TEST(Sector, RefusesWallsWithoutMirrorPlanesAndNamesOne) {
  const auto refused = [](const CheckedScenario& scenario) {
    return refusal<std::invalid_argument>([&] { return sector_of(motion_of_run(scenario)); });
  };
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(contains(refused(between_walls({wall("floor", -z), wall("punch", z, path({0.1}))})), "wall 'floor'"));
  const Eigen::Vector3d oblique = Eigen::Vector3d(1.0, 0.0, 1.0).normalized();
  EXPECT_TRUE(contains(refused(between_walls({wall("top", z, path({0.1})), wall("bottom", -z, path({0.1})),
                                              wall("a", oblique), wall("b", -oblique)})),
                       "wall 'a' is not"));
}

TEST(Sector, SeesTheWallsFromACentreThatMoves) {
  CheckedScenario scenario =
      between_walls({wall("floor", -Eigen::Vector3d::UnitZ()), wall("punch", Eigen::Vector3d::UnitZ(), path({0.2}))});
  scenario.loading.centre_is_free = true;
  const Motion motion = motion_of_run(scenario);
  const Sector sector = sector_of(motion);
  EXPECT_TRUE(sector.is_axisymmetric);
  EXPECT_EQ(sector.sector_wall_of, (std::vector<std::size_t>{0, 0}));
  EXPECT_NEAR(motion.overlap(motion.walls[sector.walls[0].wall], motion.instants.back()), 0.1, 1e-9);
}

TEST(Sector, PutsEveryWallOfTheMotionInItsPlace) {
  const Motion motion = motion_of_run(mdr_scenario(Configuration::die, 50.0, 0.3, path({0.1})));
  EXPECT_EQ(sector_of(motion).sector_wall_of, (std::vector<std::size_t>{0, 0, 1, 1, 1, 1}));
}

}  // namespace
}  // namespace monograin
