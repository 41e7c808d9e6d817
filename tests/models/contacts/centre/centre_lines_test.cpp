// A free centre can move along the lines of its walls. Walls that are parallel but for round-off share a line, which
// does not depend on their order.

#include "contacts/centre/centre_lines.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace monograin::contacts {
namespace {

using Vectors = std::vector<Eigen::Vector3d>;

CentreLines lines_of(const Vectors& normals) {
  std::vector<ContactClass> classes;
  for (const Eigen::Vector3d& normal : normals) classes.push_back({.name = "wall", .normals = {normal.normalized()}});
  return {classes, true};
}

/// Mean normal of a class in space, as the centre sees it.
Eigen::Vector3d seen(const CentreLines& lines, std::size_t i) { return lines.in_space(lines.mean_normal(i)); }

TEST(CentreLines, AreOfWallsInTheirOwnDirections) {
  const Vectors normals = {{0, 0, 1}, {0, 0.6, 0.8}, {0, 0, -1}};
  const CentreLines lines = lines_of(normals);
  EXPECT_EQ(lines.free_directions(), 2);
  EXPECT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines.line_of(0), lines.line_of(2));
  for (std::size_t i = 0; i < normals.size(); ++i) EXPECT_LT((seen(lines, i) - normals[i]).norm(), 1e-15) << i;
}

TEST(CentreLines, DoNotDependOnTheOrderOfNearlyParallelWalls) {
  const Eigen::Vector3d along = Eigen::Vector3d(-0.6, 0.8, 0.06).normalized();
  const Eigen::Vector3d across = along.unitOrthogonal();
  const std::vector<double> shares = {0.0, 4e-7, -3e-7};
  std::vector<std::size_t> order = {0, 1, 2};
  Vectors first(3, Eigen::Vector3d::Zero());
  do {
    Vectors normals;
    for (const std::size_t k : order) normals.emplace_back((k == 1 ? -1.0 : 1.0) * (along + shares[k] * across));
    const CentreLines lines = lines_of(normals);
    ASSERT_EQ(lines.free_directions(), 1);
    ASSERT_EQ(lines.size(), 1u);
    for (std::size_t place = 0; place < 3; ++place) {
      Eigen::Vector3d& expected = first[order[place]];
      if (expected.isZero()) expected = seen(lines, place);
      EXPECT_LT((seen(lines, place) - expected).norm(), 1e-15);
      EXPECT_LT((seen(lines, place) - normals[place].normalized()).norm(), 1e-6);
    }
  } while (std::ranges::next_permutation(order).found);
}

TEST(CentreLines, TurnWithWallsWhoseLinesSpanAPlaneButForRoundOff) {
  const Vectors normals = {{1, 0, 0}, {-0.5, 0.9, 4e-7}, {-0.5, -0.9, 2e-7}, {0.6, 0.8, -3e-7}};
  const CentreLines lines = lines_of(normals);
  ASSERT_EQ(lines.free_directions(), 2);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Vectors turned;
  for (const Eigen::Vector3d& normal : normals) turned.emplace_back(turn * normal);
  const CentreLines copy = lines_of(turned);
  ASSERT_EQ(copy.free_directions(), 2);
  for (std::size_t i = 0; i < normals.size(); ++i)
    EXPECT_LT((seen(copy, i) - turn * seen(lines, i)).norm(), 1e-14) << i;
}

TEST(CentreLines, HaveOneComponentWhereMostClassesAct) {
  const Eigen::Vector3d along = Eigen::Vector3d(0.9, 0.2, -0.4).normalized();
  const CentreLines lines = lines_of({{0, 1, 0.3}, along, {0.1, 0, 1}, -along});
  ASSERT_EQ(lines.free_directions(), 3);
  EXPECT_NEAR(std::abs(lines.mean_normal(1).x()), 1.0, 1e-15);
  EXPECT_LT(lines.mean_normal(1).tail<2>().norm(), 1e-15);
  EXPECT_EQ(lines.mean_normal(1), -lines.mean_normal(3));
}

TEST(CentreLines, LeaveAFixedCentreNoDirection) {
  const std::vector<ContactClass> classes = {{.name = "wall", .normals = {Eigen::Vector3d(0, 0, 1)}}};
  const CentreLines lines(classes, false);
  EXPECT_EQ(lines.free_directions(), 0);
  EXPECT_FALSE(lines.acts(0));
}

}  // namespace
}  // namespace monograin::contacts
