#include "contacts/centre/reaction_cone.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace monograin::backing_test {
namespace {

using Eigen::Vector3d;

TEST(ReactionCone, IsThereWhereThePushGoesIntoTheWallsAndNotBesideThem) {
  const std::vector<Vector3d> wedge{Vector3d(1, 0, -1).normalized(), Vector3d(-1, 0, -1).normalized()};
  EXPECT_TRUE(in_reaction_cone({0, 0, 1}, wedge));
  EXPECT_TRUE(in_reaction_cone({0.9, 0, 1}, wedge));
  EXPECT_FALSE(in_reaction_cone({1.1, 0, 1}, wedge));
  EXPECT_FALSE(in_reaction_cone({0, 0, -1}, wedge));
  EXPECT_FALSE(in_reaction_cone({0, 1e-3, 1}, wedge));
  EXPECT_FALSE(in_reaction_cone({0, 0, 1}, {}));
}

TEST(ReactionCone, IsNotThatOfWallsThatAlignButForRounding) {
  const auto is_backed_at = [](double angle) {
    return in_reaction_cone({-1, 0, 0}, std::vector<Vector3d>{{0, 0, -1}, Vector3d(angle, 0, 1).normalized()});
  };
  EXPECT_TRUE(is_backed_at(1e-5));
  EXPECT_FALSE(is_backed_at(1e-8));
}

TEST(ReactionCone, IsFoundForAnyPushThatPressingForcesMake) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share;
  for (int sample = 0; sample < 2000; ++sample) {
    std::vector<Vector3d> directions;
    Vector3d sum = Vector3d::Zero();
    for (int k = 0; k < 1 + sample % 6; ++k) {
      directions.push_back(Vector3d(normal(random), normal(random), normal(random)).normalized());
      sum += share(random) * directions.back();
    }
    EXPECT_TRUE(in_reaction_cone(-1e3 * sum, directions)) << sample;
  }
}

TEST(ReactionCone, IsNotThereBeyondAPlaneThatNoDirectionCrosses) {
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  for (int sample = 0; sample < 2000; ++sample) {
    std::vector<Vector3d> directions;
    for (int k = 0; k < 1 + sample % 6; ++k) {
      Vector3d direction(normal(random), normal(random), normal(random));
      direction.z() = -std::abs(direction.z());
      directions.push_back(direction.normalized());
    }
    EXPECT_FALSE(in_reaction_cone({normal(random), normal(random), -0.1}, directions)) << sample;
  }
}

}  // namespace
}  // namespace monograin::backing_test
