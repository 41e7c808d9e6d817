/// The loads of its contacts move a free centre.

#include "mdr/free_centre.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace monograin::mdr::free_centre_test {
namespace {

using Vector = Eigen::Vector3d;

/// One class for each wall.
std::vector<ContactClass> walls(const std::vector<Vector>& normals) {
  std::vector<ContactClass> classes;
  for (const Vector& normal : normals) classes.push_back({.name = "w", .normals = {normal.normalized()}});
  return classes;
}

const std::vector<Vector> k_cross{{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, -1.0, 0.0}};

/// Loads of linear springs with given stiffnesses, after a displacement of the centre towards their walls.
void press(FreeCentre& centre, const std::vector<double>& stiffness, const std::vector<double>& forces,
           const CentreVector& displacement) {
  centre.clear();
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    const double force = forces[i] + stiffness[i] * centre.mean_normal(i).dot(displacement);
    centre.add(i, {.count = 1.0, .force = force, .stiffness = stiffness[i], .regularized_stiffness = stiffness[i]});
  }
  centre.sum_up();
}

TEST(MdrFreeCentre, DoesNotMoveWhereItIsFixed) {
  const FreeCentre centre(walls(k_cross), false);
  EXPECT_EQ(centre.free_directions(), 0);
  for (std::size_t i = 0; i < k_cross.size(); ++i) EXPECT_FALSE(centre.acts(i));
}

TEST(MdrFreeCentre, HasMovedTowardsAWallByItsPathAlongTheNormal) {
  const FreeCentre centre(walls(k_cross), true);
  const CentreVector path{0.1, -0.2, 0.0};
  const std::vector<double> state{0.1, -0.2, 7.0};  // the last entry is no direction of the centre
  for (std::size_t i = 0; i < k_cross.size(); ++i) {
    EXPECT_DOUBLE_EQ(centre.approach_by_centre(i, state), k_cross[i].dot(centre.in_space(path)));
  }
}

TEST(MdrFreeCentre, MovesAlongTheMeanNormalsOnly) {
  EXPECT_EQ(FreeCentre(walls(k_cross), true).free_directions(), 2);
  // Walls of one class that face each other have no mean normal.
  const ContactClass pair{.name = "pair", .normals = {{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}}};
  EXPECT_EQ(FreeCentre(std::vector{pair}, true).free_directions(), 0);
}

TEST(MdrFreeCentre, FindsTheBalanceOfSpringsInOneStep) {
  const std::vector<Vector> normals{{1.0, 0.2, 0.0}, {-1.0, 0.5, 0.1}, {0.0, -1.0, 0.3}, {0.1, 0.0, -1.0}};
  const std::vector<double> stiffness{1.0, 30.0, 0.02, 5.0};
  const std::vector<double> forces{0.3, 0.1, 0.2, 0.05};
  FreeCentre centre(walls(normals), true);
  press(centre, stiffness, forces, CentreVector::Zero());
  const CentreVector step = centre.step();
  ASSERT_GT(centre.force().norm(), 0.1);
  press(centre, stiffness, forces, step);
  EXPECT_LE(centre.force().norm(), 1e-12);
}

TEST(MdrFreeCentre, IsNotMovedAcrossALineByForcesThatNearlyCancelOnIt) {
  FreeCentre centre(walls(k_cross), true);
  // The round-off of 1e9 would be far more than the soft contacts across bear.
  press(centre, {1e9, 1e9, 1e-6, 1e-6}, {1e9 + 0.1, 1e9, 1e-9, 1e-9}, CentreVector::Zero());
  const Vector moved = centre.in_space(centre.step());
  EXPECT_EQ(moved.y(), 0.0);
  EXPECT_LT(moved.x(), 0.0);
}

TEST(MdrFreeCentre, StaysInDirectionsInWhichNothingConstrainsIt) {
  FreeCentre centre(walls(k_cross), true);
  const CentreMatrix across = centre.unconstrained([](std::size_t i) { return i < 2; });
  EXPECT_NEAR(centre.in_space(across * centre.mean_normal(0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((across * centre.mean_normal(2) - centre.mean_normal(2)).norm(), 0.0, 1e-15);
  const CentreMatrix none = centre.unconstrained([](std::size_t) { return true; });
  EXPECT_NEAR(none.norm(), 0.0, 1e-15);
}

TEST(MdrFreeCentre, IsAsSoftAsItsSoftestDirection) {
  FreeCentre centre(walls(k_cross), true);
  const auto left = [](std::size_t i) { return i < 2 ? 0.7 : 0.2; };
  const CentreStiffness softest = centre.softest([&](std::size_t i, double along) {
    const double whole = (i < 2 ? 3.0 : 1e6) * along * along;
    return std::pair(left(i) * whole, whole);
  });
  EXPECT_NEAR(softest.value, 0.2, 1e-14);
  EXPECT_NEAR(centre.in_space(softest.direction).x(), 0.0, 1e-12 * softest.direction.norm());
}

TEST(MdrFreeCentre, MovesByTheTangentsOfTouchesAlongLinesThatHaveNoStiffnessYet) {
  FreeCentre centre(walls(k_cross), true);
  for (std::size_t i = 0; i < 4; ++i) {
    const bool bears = i >= 2;
    centre.add(i, {.count = 1.0,
                   .force = i == 0 ? 1e-9 : 0.0,
                   .stiffness = bears ? 2.0 : 0.0,
                   .regularized_stiffness = bears ? 2.0 : 1e-6});
  }
  centre.sum_up();
  EXPECT_NEAR(centre.in_space(centre.step()).x(), -1e-9 / 2e-6, 1e-15);
  EXPECT_NEAR(centre.stiffness().trace(), 4.0 + 2e-6, 1e-12);
}

}  // namespace
}  // namespace monograin::mdr::free_centre_test
