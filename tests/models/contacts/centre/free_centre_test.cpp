// A free centre is at the equilibrium of its unilateral contacts. Where no contact is loaded, it stays, or walls push
// it.

#include "contacts/centre/free_centre.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "elastic/hertz.hpp"
#include "system/limit.hpp"

namespace monograin::contacts {
namespace {

using Vector = FreeCentre::Vector;

/// Hertz contacts of a unit particle (R0 = 1, E* = 1), one wall each.
struct HertzWalls final : CentreWalls {
  struct Wall {
    Eigen::Vector3d normal;
    double displacement = 0.0;
    std::optional<double> force{};
  };
  std::vector<Wall> walls;

  explicit HertzWalls(std::vector<Wall> list) : walls(std::move(list)) {
    for (Wall& wall : walls) wall.normal.normalize();
  }
  [[nodiscard]] std::optional<double> prescribed_force(std::size_t i) const override { return walls[i].force; }
  [[nodiscard]] double overlap(std::size_t i) const override { return walls[i].displacement; }
  [[nodiscard]] Force force(std::size_t /*i*/, double overlap) const override {
    return {hertz_force(1.0, 1.0, overlap), 2.0 * hertz_contact_radius(1.0, overlap)};
  }
  [[nodiscard]] double overlap_under(std::size_t /*i*/, double force) const override {
    return std::pow(0.75 * force, 2.0 / 3.0);
  }

  [[nodiscard]] std::vector<ContactClass> classes() const {
    std::vector<ContactClass> list;
    for (const Wall& wall : walls) list.push_back({.name = "wall", .normals = {wall.normal}});
    return list;
  }
  [[nodiscard]] std::vector<Role> all(Role role) const { return std::vector<Role>(walls.size(), role); }

  /// Centre in space, from where it started.
  [[nodiscard]] Eigen::Vector3d centre(Vector guess = Vector::Zero()) const {
    FreeCentre centre(classes());
    return centre.in_space(centre.equilibrium(*this, all(Role::bearing), Vector::Zero(), guess));
  }
  [[nodiscard]] Eigen::Vector3d net_force(const Eigen::Vector3d& centre) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Wall& wall : walls)
      sum += wall.force.value_or(hertz_force(1.0, 1.0, wall.displacement + wall.normal.dot(centre))) * wall.normal;
    return sum;
  }
};

/// Walls in random directions, which enclose the particle; the last one may be under force.
HertzWalls random_cell(std::mt19937& random) {
  std::normal_distribution<double> component;
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<HertzWalls::Wall> list;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {
      Eigen::Vector3d normal = 0.3 * Eigen::Vector3d(component(random), component(random), component(random));
      normal[axis] += 2.0 * side;
      list.push_back({normal, 0.1 * share(random)});
      if (axis == 2 && side < 0.0 && share(random) < 0.5) list.back().force = 1e-2 * share(random);
    }
  }
  return HertzWalls(std::move(list));
}

TEST(FreeCentreSolver, LiesHalfWayBetweenTwoWallsThatSqueezeIt) {
  const HertzWalls pair({{{0, 0, 1}, 0.3}, {{0, 0, -1}, 0.1}});
  EXPECT_NEAR(pair.centre().z(), -0.1, 1e-15);
  EXPECT_EQ(pair.centre().head<2>().norm(), 0.0);
}

TEST(FreeCentreSolver, LiesWhereTheContactsBearAPrescribedForce) {
  const HertzWalls pressed({{{0, 0, 1}, 0.0, 0.01}, {{0, 0, -1}, 0.0}});
  EXPECT_NEAR(pressed.centre().z(), -std::pow(0.0075, 2.0 / 3.0), 1e-15);
}

TEST(FreeCentreSolver, BalancesTheForcesOfAnyCell) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const HertzWalls cell = random_cell(random);
    EXPECT_LE(cell.net_force(cell.centre()).norm(), 1e-15) << trial;
  }
}

TEST(FreeCentreSolver, DoesNotDependOnTheGuessNorOnTheOrderOfTheWallsNorOnTheAxes) {
  std::mt19937 random(11);
  std::normal_distribution<double> component;
  for (int trial = 0; trial < 200; ++trial) {
    const HertzWalls cell = random_cell(random);
    const Eigen::Vector3d expected = cell.centre();
    EXPECT_LE((cell.centre(0.1 * Vector::Random()) - expected).norm(), 1e-13) << trial;
    HertzWalls shuffled = cell;
    std::ranges::shuffle(shuffled.walls, random);
    EXPECT_LE((shuffled.centre() - expected).norm(), 1e-13) << trial;
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(component(random), component(random), component(random), component(random)).normalized();
    HertzWalls turned = cell;
    for (auto& wall : turned.walls) wall.normal = turn * wall.normal;
    EXPECT_LE((turned.centre() - turn * expected).norm(), 1e-13) << trial;
  }
}

TEST(FreeCentreSolver, IsNotPushedAcrossBigForcesByTheirRoundOff) {
  // Two walls press a thousand times as deep as the contacts across them.
  const Eigen::Vector3d normal(0.6, 0.48, 0.64);
  const HertzWalls cell({{normal, 0.3}, {-normal, 0.31}, {{0.8, -0.36, -0.48}, 1e-9}, {{-0.8, 0.36, 0.48}, 3e-9}});
  const Eigen::Vector3d centre = cell.centre();
  EXPECT_NEAR(centre.dot(Eigen::Vector3d(0.8, -0.36, -0.48)), 1e-9, 1e-15);
  EXPECT_NEAR(centre.dot(normal), 0.005, 1e-15);
}

TEST(FreeCentreSolver, IsCarriedByTheLeastThatClearsTheWallsThatPushIt) {
  const HertzWalls one({{{0, 0.6, 0.8}, 0.2}, {{0, 0, -1}, -1.0}});
  EXPECT_LE((one.centre() - Eigen::Vector3d(0, -0.12, -0.16)).norm(), 1e-15);
  // Both walls push: the centre moves along the edge between them, to the nearest position.
  const HertzWalls wedge({{{1, 0, 0}, 0.1}, {{0, 1, 0}, 0.3}, {{0, 0, -1}, -1.0}});
  EXPECT_LE((wedge.centre() - Eigen::Vector3d(-0.1, -0.3, 0)).norm(), 1e-15);
}

TEST(FreeCentreSolver, StaysAcrossTheDirectionsInWhichContactsBear) {
  const HertzWalls pair({{{0, 0, 1}, 0.3}, {{0, 0, -1}, 0.1}, {{1, 0, 0}, -0.5}});
  FreeCentre centre(pair.classes());
  const Vector rest = Vector(0.01, 0.02, 0.03).cwiseMin(Vector::Ones());
  const Eigen::Vector3d before = centre.in_space(rest);
  const Eigen::Vector3d after =
      centre.in_space(centre.equilibrium(pair, pair.all(Role::bearing), rest, rest + Vector(1e-3, 1e-3, 0)));
  EXPECT_NEAR(after.x(), before.x(), 1e-15);
  EXPECT_NEAR(after.z(), -0.1, 1e-15);
}

TEST(FreeCentreSolver, IsTakenByAForceToTheWallInItsPath) {
  const HertzWalls gap({{{0, 0, 1}, 0.0, 0.01}, {{0, 0, -1}, -0.2}, {{1, 0, 0}, 0.0}});
  EXPECT_NEAR(gap.centre().z(), -0.2 - std::pow(0.0075, 2.0 / 3.0), 1e-15);
}

TEST(FreeCentreSolver, IsDrivenAwayByAForceWithNoWallInItsPath) {
  const HertzWalls open({{{0, 0, 1}, 0.0, 0.01}, {{1, 0, 0}, 0.0}});
  try {
    static_cast<void>(open.centre());
    FAIL();
  } catch (const DomainError& error) {
    EXPECT_EQ(error.point().limit, Limit::centre_driven_away);
  }
}

TEST(FreeCentreSolver, MovesAtTheRateOfItsPosition) {
  std::mt19937 random(13);
  for (int trial = 0; trial < 50; ++trial) {
    const HertzWalls cell = random_cell(random);
    FreeCentre centre(cell.classes());
    const std::vector<Role> roles = cell.all(Role::bearing);
    const Vector now = centre.equilibrium(cell, roles, Vector::Zero(), Vector::Zero());
    std::vector<double> rates;
    for (std::size_t i = 0; i < cell.walls.size(); ++i) rates.push_back(0.01 * std::sin(1.0 + static_cast<double>(i)));
    const auto at = [&](double time) {
      HertzWalls moved = cell;
      for (std::size_t i = 0; i < rates.size(); ++i)
        (moved.walls[i].force ? *moved.walls[i].force : moved.walls[i].displacement) += rates[i] * time;
      return centre.equilibrium(moved, roles, Vector::Zero(), now);
    };
    constexpr double k_step = 1e-5;
    const Vector expected = (at(k_step) - at(-k_step)) / (2.0 * k_step);
    const Vector rate = centre.velocity(cell, roles, rates, now);
    EXPECT_LE((rate - expected).norm(), 1e-6 * (1.0 + expected.norm())) << trial;
  }
}

TEST(FreeCentreSolver, RolesTellWhatBearsFromWhatPushes) {
  // The upper walls come down on a loose particle: the first one pushes it, and both carry load once it is squeezed.
  const auto roles_at = [](double top, double bottom) {
    const HertzWalls walls({{{0, 0, 1}, top}, {{0, 0, -1}, bottom}, {{1, 0, 0}, -0.5}});
    const HertzWalls then({{{0, 0, 1}, top + 1e-6}, {{0, 0, -1}, bottom}, {{1, 0, 0}, -0.5}});
    FreeCentre centre(walls.classes());
    std::vector<Role> roles = walls.all(Role::away);
    Vector c = Vector::Zero();
    centre.find_roles(walls, then, c, roles);
    return roles;
  };
  EXPECT_EQ(roles_at(0.0, -0.1), (std::vector<Role>{Role::idle, Role::away, Role::away}));
  EXPECT_EQ(roles_at(0.0, 0.0), (std::vector<Role>{Role::bearing, Role::bearing, Role::away}));
}

}  // namespace
}  // namespace monograin::contacts
