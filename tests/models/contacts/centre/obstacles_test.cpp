#include "contacts/centre/obstacles.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace monograin::contacts::obstacles_test {
namespace {

constexpr double k_least = 1e-6;

const auto k_overlaps = [](const Obstacle& wall, const Eigen::Vector3d& c) { return wall.overlap(c) > 1e-15; };

bool is_cleared(const std::vector<Obstacle>& walls, Eigen::Vector3d& c,
                const Eigen::Matrix3d& projector = Eigen::Matrix3d::Identity()) {
  return project_out_of(walls, projector, k_least, k_overlaps, c);
}

TEST(ObstaclesOfACentre, LeaveAClearCentreWhereItIs) {
  Eigen::Vector3d c(0.0, 0.3, -0.1);
  EXPECT_TRUE(is_cleared({{0, Eigen::Vector3d::UnitX(), -0.1}, {1, Eigen::Vector3d::UnitZ(), 0.1}}, c));
  EXPECT_EQ(c, Eigen::Vector3d(0.0, 0.3, -0.1));
}

TEST(ObstaclesOfACentre, PushItToTheNearestClearPosition) {
  // Two walls at 120 degrees: clear of the deeper one, the centre is clear of both, or it goes into their corner.
  const Eigen::Vector3d oblique(-0.5, std::sqrt(0.75), 0.0);
  Eigen::Vector3d beside = Eigen::Vector3d::Zero();
  EXPECT_TRUE(is_cleared({{0, Eigen::Vector3d::UnitX(), 0.2}, {1, oblique, -0.2}}, beside));
  EXPECT_NEAR((beside - Eigen::Vector3d(-0.2, 0.0, 0.0)).norm(), 0.0, 1e-15);
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();
  const std::vector<Obstacle> walls{{0, Eigen::Vector3d::UnitX(), 0.2}, {1, oblique, 0.1}};
  EXPECT_TRUE(is_cleared(walls, corner));
  for (const Obstacle& wall : walls) EXPECT_NEAR(wall.overlap(corner), 0.0, 1e-15);
  EXPECT_EQ(corner.z(), 0.0);
}

TEST(ObstaclesOfACentre, PushItAlongTheDirectionsThatAreFreeOnly) {
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  const Eigen::Matrix3d plane = Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal();
  EXPECT_TRUE(is_cleared({{0, Eigen::Vector3d(0.6, 0.0, 0.8), 0.3}}, c, plane));
  EXPECT_NEAR((c - Eigen::Vector3d(-0.5, 0.0, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_FALSE(is_cleared({{0, Eigen::Vector3d::UnitZ(), 0.3}}, c, plane));
}

TEST(ObstaclesOfACentre, MayLeaveNoRoom) {
  Eigen::Vector3d c(0.0, 0.5, 0.0);
  EXPECT_FALSE(is_cleared({{0, Eigen::Vector3d::UnitX(), 0.1}, {1, -Eigen::Vector3d::UnitX(), 0.1}}, c));
  EXPECT_EQ(c, Eigen::Vector3d(0.0, 0.5, 0.0));
  EXPECT_TRUE(is_cleared({{0, Eigen::Vector3d::UnitX(), 0.1}, {1, -Eigen::Vector3d::UnitX(), -0.1}}, c));
}

/// A corner: a floor and a wall to the left, with gaps, and a roof beyond reach of a push downwards.
const std::vector<Obstacle> k_corner = {{0, {0, 0, -1}, -0.1}, {1, {-1, 0, 0}, -0.2}, {2, {0, 0, 1}, 0.0}};

TEST(LooseParticle, IsCarriedAgainstThePushToTheWallThatBearsIt) {
  std::vector<char> touches = {0, 0, 1};
  const auto c = carried_to_support({0, 0, 2}, k_corner, touches, Eigen::Vector3d::Zero());
  ASSERT_TRUE(c);
  EXPECT_EQ(*c, Eigen::Vector3d(0, 0, -0.1));
  EXPECT_EQ(touches, (std::vector<char>{1, 0, 0}));
}

TEST(LooseParticle, SlidesAlongTheFirstWallToTheOneThatBearsTheRest) {
  std::vector<char> touches = {0, 0, 0};
  const auto c = carried_to_support({1, 0, 2}, k_corner, touches, Eigen::Vector3d::Zero());
  ASSERT_TRUE(c);
  EXPECT_NEAR((*c - Eigen::Vector3d(-0.2, 0, -0.1)).norm(), 0.0, 1e-15);
  EXPECT_EQ(touches, (std::vector<char>{1, 1, 0}));
}

TEST(LooseParticle, StaysWhereWallsBearThePushAlready) {
  std::vector<char> touches = {1, 0, 0};
  const auto c = carried_to_support({0, 0, 1}, k_corner, touches, {0.3, 0, -0.1});
  ASSERT_TRUE(c);
  EXPECT_EQ(*c, Eigen::Vector3d(0.3, 0, -0.1));
}

TEST(LooseParticle, HasNoSupportWhereNoWallIsInThePath) {
  std::vector<char> touches = {0, 0, 0};
  EXPECT_FALSE(carried_to_support({0, 1, 0}, k_corner, touches, Eigen::Vector3d::Zero()));
  EXPECT_FALSE(carried_to_support({0, 1, 1}, k_corner, touches, Eigen::Vector3d::Zero()));
}

}  // namespace
}  // namespace monograin::contacts::obstacles_test
