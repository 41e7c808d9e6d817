#include "nonlocal/evasion.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "models/nonlocal/cases.hpp"

namespace monograin::nonlocal::nonlocal_evasion_test {
namespace {

using contacts::Obstacle;

TEST(NonlocalEvasion, CountsAWallThatTouchesUpToRoundOffAsTouching) {
  const Obstacle wall{0, Eigen::Vector3d::UnitX(), 0.3};
  EXPECT_EQ(free_approach(wall, {-0.3 + 1e-16, 0.0, 0.0}), 0.0);
  EXPECT_NEAR(free_approach(wall, {-0.3 + 1e-12, 0.0, 0.0}), 1e-12, 1e-15);
  // Far away across the wall, round-off is larger.
  EXPECT_EQ(free_approach(wall, {-0.3 + 1e-12, 1e6, 0.0}), 0.0);
}

TEST(NonlocalEvasion, LeavesNoOverlapBehindALongDisplacement) {
  const Eigen::Vector3d oblique = Eigen::Vector3d(1.0, 1.0, 1.0).normalized();
  const std::vector<Obstacle> walls{{0, Eigen::Vector3d::UnitX(), 1e3}, {1, oblique, 1e3 + 0.1}};
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  ASSERT_TRUE(release_centre(walls, Eigen::Matrix3d::Identity(), centre));
  for (const Obstacle& wall : walls) EXPECT_LE(free_approach(wall, centre), 0.0);
}

TEST(NonlocalEvasion, WritesTheGapsOfTheWallsThatItKnows) {
  const Contacts contacts({k_rubber}, single_walls(simple()), Centre::free);
  const double along = contacts.free_directions()(2, 0);
  std::vector<double> y{0.5, 0.5, 0.0};
  put_centre(contacts, std::vector<Obstacle>{{1, contacts.mean_normal(1), -0.2}}, {0.1 * along, 0.0, 0.0}, y);
  EXPECT_EQ(y[0], 0.5);
  EXPECT_NEAR(y[1], -0.3, 1e-16);
  EXPECT_EQ(y[2], 0.1 * along);
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_evasion_test
