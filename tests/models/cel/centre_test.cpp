// The balance of forces on a free centre.

#include "cel/centre.hpp"

#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace monograin::cel::centre_test {
namespace {

using Eigen::Vector3d;

std::vector<ContactClass> walls(const std::vector<Vector3d>& normals) {
  std::vector<ContactClass> classes;
  for (const Vector3d& normal : normals) classes.push_back({.name = "wall", .normals = {normal.normalized()}});
  return classes;
}

TEST(CelCentre, HasNoDirectionsIfItIsFixed) {
  EXPECT_EQ(Centre(walls({{0, 0, 1}, {0, 1, -1}}), false).directions(), 0u);
  EXPECT_EQ(Centre(walls({{0, 0, 1}, {0, 1, -1}}), true).directions(), 2u);
}

TEST(CelCentre, FeelsTheSumOfTheForcesAndItsSpring) {
  const std::vector<ContactClass> classes = walls({{0, 0, 1}, {1, 0, -1}, {-1, 0.2, -1}});
  Centre centre(classes, true);
  const std::vector<double> forces{0.5, 0.2, 0.3};
  centre.choose_balance(forces);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < classes.size(); ++i) sum += forces[i] * classes[i].normals[0];
  centre.rest_at({0.1, 0.2, 0.3});
  EXPECT_NEAR(centre.net_force(0.0, {0.1, 0.2, 0.3}, forces).norm(), sum.norm(), 1e-15);
  const Vector3d stretched = centre.net_force(0.0, {1.1, 0.2, 0.3}, {std::vector<double>(3)});
  EXPECT_NEAR(stretched.norm(), Centre::k_weak_spring, 1e-24);
  EXPECT_NEAR(centre.energy(0.0, {1.1, 0.2, 0.3}), 0.5 * Centre::k_weak_spring, 1e-24);
  // Equations are linear in forces and centre.
  for (std::size_t k = 0; k < 3; ++k) {
    double net = centre.by_centre(k).dot(Vector3d(1, 0, 0));
    for (std::size_t i = 0; i < classes.size(); ++i) net += centre.by_force(k, i) * forces[i];
    EXPECT_NEAR(net, centre.net_force(0.0, {1.1, 0.2, 0.3}, forces)[k], 1e-15) << k;
  }
}

TEST(CelCentre, LetsItsSpringFollowTheWallsThatLead) {
  Centre centre(walls({{0, 0, 1}, {0, 0, -1}, {0, 1, 0}, {1, 0, 0}}), true);
  const std::vector<double> none(4);
  const Vector3d n = centre.lines().mean_normal(0);
  // A wall that comes in at 0.2 pushes the particle away along its normal; with a partner at rest, half as fast.
  centre.follow(0.0, std::vector<std::optional<double>>{0.2, std::nullopt, std::nullopt, std::nullopt});
  EXPECT_NEAR(centre.stretch(0.5, -0.1 * n).norm(), 0.0, 1e-16);
  EXPECT_TRUE(centre.follows());
  centre.follow(0.5, std::vector<std::optional<double>>{0.2, 0.0, std::nullopt, std::nullopt});
  EXPECT_NEAR(centre.stretch(1.0, -0.15 * n).norm(), 0.0, 1e-16);
  // The net force changes at the rate that it tells.
  const Vector3d x(0.3, -0.2, 0.1);
  const Vector3d change = centre.net_force(1.0, x, none) - centre.net_force(0.75, x, none);
  EXPECT_NEAR((change - 0.25 * centre.net_force_rate()).norm(), 0.0, 1e-24);
  centre.rest_at(x);
  EXPECT_FALSE(centre.follows());
  EXPECT_EQ(centre.stretch(1.0, x), Vector3d::Zero());
}

TEST(CelCentre, LeavesNoRoundOffOfLargeForcesAcrossTheirLine) {
  const Vector3d n = Vector3d(0.3, -0.7, 0.5).normalized();
  Centre centre(walls({n, -n, {1, 0.2, 0}}), true);
  const std::vector<double> forces{0.7, 0.7, 0.0};
  centre.choose_balance(forces);
  EXPECT_EQ(centre.net_force(0.0, Vector3d::Zero(), forces), Vector3d::Zero());
}

}  // namespace
}  // namespace monograin::cel::centre_test
