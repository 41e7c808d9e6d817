#include "nonlocal/centre.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "models/nonlocal/cases.hpp"

namespace monograin::nonlocal::nonlocal_centre_test {
namespace {

std::vector<Target> targets_at(std::vector<double> displacements) {
  std::vector<Target> targets;
  for (const double displacement : displacements) targets.push_back({.value = displacement});
  return targets;
}

/// Walls z+, z-, x+, x-, y+, y- around a free centre.
struct Box {
  Contacts contacts{{k_rubber}, single_walls(die()), Centre::free};
  CentreSearch search{contacts};
};

TEST(NonlocalCentre, EvadesAWallThatNothingOpposes) {
  Box box;
  std::vector<double> y{0.0, -0.2, -0.1, -0.1, -0.1, -0.1, 0.0, 0.0, 0.0};
  ASSERT_TRUE(box.search.clear_all(box.contacts, targets_at({0.05, -0.2, -0.1, -0.1, -0.1, -0.1}), y));
  EXPECT_EQ(y[0], 0.0);
  EXPECT_NEAR(y[1], -0.15, 1e-16);
  EXPECT_EQ(y[2], -0.1);
  EXPECT_NEAR((box.contacts.centre_of(y) - Eigen::Vector3d(0.0, 0.0, -0.05)).norm(), 0.0, 1e-16);
}

TEST(NonlocalCentre, StaysBetweenWallsThatLeaveNoRoomOrUnderAForce) {
  Box box;
  const std::vector<double> start{0.0, 0.0, -0.1, -0.1, -0.1, -0.1, 0.0, 0.0, 0.0};
  std::vector<double> y = start;
  auto targets = targets_at({0.05, 0.0, -0.1, -0.1, -0.1, -0.1});
  EXPECT_FALSE(box.search.clear_all(box.contacts, targets, y));
  EXPECT_EQ(y, start);
  targets = targets_at({-0.1, -0.1, -0.1, -0.1, -0.1, -0.1});
  targets[0] = {.is_force = true, .value = 0.1};
  EXPECT_FALSE(box.search.clear_all(box.contacts, targets, y));
  EXPECT_EQ(y, start);
}

TEST(NonlocalCentre, IsPushedAcrossLoadedContactsThatDoNotChange) {
  Box box;
  std::vector<double> y = state_under(box.contacts, std::vector{0.05, 0.05, -0.01, -0.1, -0.1, -0.1});
  const std::vector<double> before = y;
  ASSERT_TRUE(box.search.follow(box.contacts, targets_at({0.05, 0.05, 0.03, -0.1, -0.1, -0.1}), y));
  EXPECT_NEAR(y[0], before[0], 1e-14);
  EXPECT_NEAR(y[1], before[1], 1e-14);
  EXPECT_LE(y[2], 0.0);
  // The contacts push the surface towards the lateral walls, and with it the centre.
  const double lift = box.contacts.lift_by_forces(2, box.contacts.evaluate(y).forces);
  EXPECT_NEAR((box.contacts.centre_of(y) - Eigen::Vector3d(-0.03 - lift, 0.0, 0.0)).norm(), 0.0, 1e-12);
}

TEST(NonlocalCentre, FollowsNoPathOnWhichFurtherWallsBear) {
  Box box;
  std::vector<double> y = state_under(box.contacts, std::vector{0.05, 0.05, -0.01, -0.02, -0.1, -0.1});
  const std::vector<double> before = y;
  EXPECT_FALSE(box.search.follow(box.contacts, targets_at({0.05, 0.05, 0.05, 0.05, -0.1, -0.1}), y));
  EXPECT_EQ(y, before);
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_centre_test
