// The growing radius in equilibrium.

#include "mdr/equilibrium.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "models/mdr/particles.hpp"
#include "system/limit.hpp"

namespace monograin::mdr::equilibrium_test {
namespace {

const std::vector<Eigen::Vector3d> k_axes{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

/// Six walls that rest around a fixed centre, with or without contact.
Particle in_a_box(DrivenWall (*wall_at)(const Eigen::Vector3d&, double), double distance) {
  std::vector<DrivenWall> walls;
  for (const Eigen::Vector3d& axis : k_axes) walls.push_back(wall_at(axis, distance));
  return particle_between(walls, false);
}

Limit limit_of_growth(Particle p, double frozen_balance) {
  p.mode.frozen_balance = frozen_balance;
  std::vector<double> y = initial_state(p);
  try {
    grow(p, 0.0, y);
  } catch (const DomainError& error) {
    return error.point().limit;
  }
  ADD_FAILURE() << "the radius was found";
  return {};
}

TEST(MdrGrowth, KeepsTheVolumeOfAParticleWithoutContacts) {
  Particle p = in_a_box(away, 0.1);
  p.mode.frozen_balance = (8.0 - 1.0) / 3.0;  // (R^3 - 1)/3 at R = 2
  std::vector<double> y = initial_state(p);
  grow(p, 0.0, y);
  EXPECT_NEAR(y[k_growth], 1.0, 1e-14);
}

TEST(MdrGrowth, RunsAwayWhereContactsCoverTheSurface) {
  Particle p = in_a_box(resting, 0.45);
  for (std::size_t i = 0; i < p.size(); ++i) p.set_branch(i, p.branch(i).yielded(p.law(), 0.0));
  EXPECT_EQ(limit_of_growth(p, 0.0), Limit::free_surface_used_up);
}

TEST(MdrGrowth, IsNotFoundFartherAwayThanTheSearchGoes) {
  EXPECT_EQ(limit_of_growth(in_a_box(away, 0.1), 1e3), Limit::no_solution);
}

}  // namespace
}  // namespace monograin::mdr::equilibrium_test
