#include "nonlocal/support.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "models/nonlocal/cases.hpp"

namespace monograin::nonlocal::nonlocal_support_test {
namespace {

using contacts::Obstacle;

const auto k_no_force = [](std::size_t) { return false; };

/// Walls z+, z-, x+, x-, y+, y- around a free centre.
struct Box {
  Contacts contacts{{k_rubber}, single_walls(die()), Centre::free};
  CentreSupport support{contacts};
};

TEST(NonlocalSupport, IsThatOfOppositeWalls) {
  Box box;
  const std::vector<bool> touches{true, true, true, false, false, false};
  box.support.sort(
      box.contacts, [&](std::size_t j) { return touches[j]; }, k_no_force);
  EXPECT_TRUE(box.support.holds(0) && box.support.holds(1));
  // No wall opposes x+.
  EXPECT_TRUE(box.support.is_redundant(2));
  EXPECT_FALSE(box.support.holds(2));
  EXPECT_FALSE(box.support.is_redundant(3));
  const Eigen::Matrix3d across = Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal();
  EXPECT_LE((box.support.unheld_directions(box.contacts) - across).norm(), 1e-15);
}

TEST(NonlocalSupport, DoesNotCountWallsUnderForceControl) {
  Box box;
  box.support.sort(
      box.contacts, [](std::size_t j) { return j < 2; }, [](std::size_t j) { return j == 0; });
  EXPECT_FALSE(box.support.has_redundant_walls());
  EXPECT_FALSE(box.support.holds(0));
  EXPECT_TRUE(box.support.holds(1));
}

TEST(NonlocalSupport, FollowsEveryChangeOfTheWallsThatMayBear) {
  Box box;
  for (const bool has_opposite : {false, true, false}) {
    box.support.sort(
        box.contacts, [&](std::size_t j) { return j == 0 || (j == 1 && has_opposite); }, k_no_force);
    EXPECT_EQ(box.support.is_redundant(0), !has_opposite);
    EXPECT_EQ(box.support.holds(0), has_opposite);
  }
}

TEST(NonlocalSupport, IsNoneOfContactsMuchShallowerThanTheDeepest) {
  Box box;
  const std::vector<Target> targets(6);
  const std::vector<double> y{0.1, 0.1, 1e-9, 1e-9, -0.1, -0.1, 0.0, 0.0, 0.0};
  EXPECT_TRUE(box.support.sort_loaded(box.contacts, targets, y));
  EXPECT_TRUE(box.support.holds(0) && box.support.holds(1));
  EXPECT_FALSE(box.support.holds(2) || box.support.holds(3));
  const std::vector<double> all(9, 0.1);
  EXPECT_FALSE(box.support.sort_loaded(box.contacts, targets, all));
}

TEST(NonlocalSupport, BalancesForcesThatPressAgainstAWall) {
  Box box;
  std::vector<Target> targets(6);
  targets[0] = {.is_force = true, .value = 0.1};
  const std::vector<double> touching(9, 0.0);
  EXPECT_TRUE(may_balance(box.contacts, targets, touching));
  std::vector<double> open = touching;
  open[1] = -0.01;  // the wall opposite to the force
  EXPECT_FALSE(may_balance(box.contacts, targets, open, 0.001));
  EXPECT_TRUE(may_balance(box.contacts, targets, open, 0.1));
}

TEST(NonlocalSupport, BeginsWithAForceThatATouchingWallOpposes) {
  Box box;
  std::vector<Ramp> ramps(6);
  ramps[0] = {.start = 0.0, .end = 0.1, .control = Control::force};
  std::vector<double> y{0.0, -1e-12, -0.1, -0.1, -0.1, -0.1, 0.0, 0.0, 0.0};
  EXPECT_TRUE(box.support.may_be_held(box.contacts, ramps, y, 1e-10));
  y[1] = -1e-3;
  EXPECT_FALSE(box.support.may_be_held(box.contacts, ramps, y, 1e-10));
}

TEST(NonlocalSupport, IsSoftWhereShallowContactsAreAllThatBears) {
  Box box;
  const std::vector<Ramp> ramps(6);
  std::vector<double> y{0.1, 0.1, 1e-9, 1e-9, -0.1, -0.1, 0.0, 0.0, 0.0};
  EXPECT_TRUE(is_held_softly(box.contacts, ramps, y, 1e-6));
  y[2] = y[3] = 0.01;
  EXPECT_FALSE(is_held_softly(box.contacts, ramps, y, 1e-6));
  std::vector<Ramp> forced = ramps;
  forced[2].control = forced[3].control = Control::force;
  EXPECT_TRUE(is_held_softly(box.contacts, forced, y, 1e-6));
}

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
}  // namespace monograin::nonlocal::nonlocal_support_test
