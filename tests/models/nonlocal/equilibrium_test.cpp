#include "nonlocal/equilibrium.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "elastic/sphere_influence.hpp"
#include "models/accuracy.hpp"
#include "models/nonlocal/cases.hpp"

namespace monograin::nonlocal::nonlocal_equilibrium_test {
namespace {

using std::numbers::pi;

/// Largest difference from a column over the largest value in it.
class ColumnError {
 public:
  ColumnError(const Table& table, const std::string& name) : expected_(table.column(name)), name_(name) {
    for (const double value : expected_) largest_ = std::max(largest_, std::abs(value));
  }

  void expect(std::size_t row, double actual, double tolerance) const {
    EXPECT_LE(std::abs(actual - expected_[row]), tolerance * largest_)
        << name_ << " in row " << row << ": " << actual << " instead of " << expected_[row];
  }

 private:
  std::vector<double> expected_;
  std::string name_;
  double largest_ = 0.0;
};

struct ClassColumns {
  ColumnError force, contact_radius, closed_radius;

  ClassColumns(const Table& table, const std::string& name)
      : force(table, name + ".F_over_piR2E"),
        contact_radius(table, name + ".a_over_R"),
        closed_radius(table, name + ".a_prime_eq14_over_R") {}

  // Largest errors found: 7.1e-14, 2.1e-14, 2.4e-14 of the maximum, next to the limit, where round-off grows with
  // 1/margin. The radius by eq. 8 has 7.7e-13 where an edge passes the middle of another contact.
  void expect(std::size_t row, Contacts& contacts, std::size_t index, std::span<const double> y) const {
    const ContactState state = states_of(contacts, y)[index];
    force.expect(row, state.force / pi, 1e-12);
    contact_radius.expect(row, state.contact_radius, 1e-12);
    closed_radius.expect(row, contacts.deformed_radius(RadiusRule::closed, index, y), 1e-12);
  }
};

class NonlocalCurve : public ::testing::TestWithParam<std::string> {};

TEST_P(NonlocalCurve, AgreesWithThirtyDigits) {
  const Table table = reference(GetParam());
  const auto terms = static_cast<Terms>(table.header_number("terms").value());
  const bool has_close_walls = GetParam().find("angle8") != std::string::npos;
  const auto classes = has_close_walls ? oblique_die(8.0) : wall_set(table.header_value("configuration"));
  Contacts contacts({k_rubber, terms}, classes, Centre::fixed);
  std::vector<ClassColumns> columns;
  std::vector<ColumnError> integral_radius;
  for (const ContactClass& group : classes) {
    columns.emplace_back(table, group.name);
    integral_radius.emplace_back(table, group.name + ".a_prime_eq8_over_R");
  }
  const ColumnError energy(table, "stored_energy_over_ER3");
  const ColumnError margin(table, "margin");
  const auto displacement = table.column("gamma_over_2R");
  ASSERT_GT(displacement.size(), 80u);

  std::vector<double> y(contacts.unknown_count(), 0.0);
  for (std::size_t row = 0; row < displacement.size(); ++row) {
    const auto ramps = compression(classes.size(), displacement[row]);
    solve(contacts, ramps, 1.0, y);
    std::vector<double> alone(contacts.unknown_count(), 0.0);
    solve(contacts, ramps, 1.0, alone);
    for (std::size_t j = 0; j < classes.size(); ++j) {
      columns[j].expect(row, contacts, j, y);
      columns[j].expect(row, contacts, j, alone);  // from the unloaded state at once
      if (!has_close_walls) integral_radius[j].expect(row, contacts.deformed_radius(RadiusRule::integral, j, y), 1e-12);
    }
    energy.expect(row, contacts.energy(y), 1e-12);
    margin.expect(row, contacts.margin(y), 1e-11);
  }
}

INSTANTIATE_TEST_SUITE_P(Nonlocal, NonlocalCurve,
                         ::testing::Values("simple_terms1", "simple_terms2", "simple_terms3", "simple_terms4",
                                           "die_terms1", "die_terms2", "die_terms3", "die_terms4", "hydrostatic_terms1",
                                           "hydrostatic_terms2", "hydrostatic_terms3", "hydrostatic_terms4",
                                           "oblique-die_terms1", "oblique-die_terms2", "oblique-die_terms3",
                                           "oblique-die_terms4", "oblique-die_angle8_terms4"),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

void expect_curve(const Table& table, const SingleWalls& walls, Contacts& contacts) {
  std::vector<std::vector<double>> displacement;
  std::vector<ClassColumns> columns;
  for (const std::string& name : walls.names) {
    displacement.push_back(table.column(name + ".displacement_over_R"));
    columns.emplace_back(table, name);
  }
  const ColumnError energy(table, "stored_energy_over_ER3");
  const ColumnError margin(table, "margin");
  std::vector<double> y;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    std::vector<double> now;
    for (const auto& column : displacement) now.push_back(column[row]);
    if (row == 0) {
      y = state_under(contacts, now);
    } else {
      solve(contacts, held(now), 1.0, y);
    }
    for (std::size_t j = 0; j < now.size(); ++j) columns[j].expect(row, contacts, j, y);
    energy.expect(row, contacts.energy(y), 1e-12);
    margin.expect(row, contacts.margin(y), 1e-12);
    const std::array directions{"ux_over_R", "uy_over_R", "uz_over_R"};
    for (std::size_t k = 0; k < contacts.free_count(); ++k) {
      if (!table.find(directions[k])) continue;
      EXPECT_NEAR(y[now.size() + k], table.column(directions[k])[row], 1e-13) << directions[k] << " in row " << row;
    }
  }
}

const SingleWalls k_die_walls{
    .names = {"z+", "z-", "x+", "x-", "y+", "y-"},
    .normals = {Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(),
                -Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitY()}};

TEST(NonlocalCurveWithGaps, AgreesWithThirtyDigitsForthAndBack) {
  const Table table = reference("die_gaps_unload_terms4");
  ASSERT_GT(table.row_count(), 70u);
  for (const Centre centre : {Centre::fixed, Centre::free}) {
    Contacts contacts({k_rubber, Terms::four}, k_die_walls.classes(), centre);
    expect_curve(table, k_die_walls, contacts);
  }
}

TEST(NonlocalCurveWithAFreeCentre, AgreesWithThirtyDigits) {
  const Table table = reference("trigonal_free_centre_terms3");
  ASSERT_GT(table.row_count(), 70u);
  Contacts contacts({0.4, Terms::three}, trigonal_walls().classes(), Centre::free);
  ASSERT_EQ(contacts.free_count(), 3u);
  expect_curve(table, trigonal_walls(), contacts);
}

TEST(NonlocalCurveUnderForce, AgreesWithThirtyDigits) {
  const Table table = reference("die_force_terms4");
  const auto force = table.column("axial.F_over_piR2E");
  Contacts contacts({k_rubber, Terms::four}, die(), Centre::fixed);
  const ClassColumns axial(table, "axial");
  const ClassColumns lateral(table, "lateral");
  const ColumnError displacement(table, "gamma_over_2R");
  const ColumnError margin(table, "margin");
  std::vector<double> y(2, 0.0);
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    std::vector<Ramp> ramps(2);
    ramps[0] = {.start = pi * force[row], .end = pi * force[row], .control = Control::force};
    solve(contacts, ramps, 0.5, y);
    axial.expect(row, contacts, 0, y);
    lateral.expect(row, contacts, 1, y);
    displacement.expect(row, states_of(contacts, y)[0].displacement, 1e-12);
    margin.expect(row, contacts.margin(y), 1e-12);
  }
}

/// Newton's method in s without safeguards.
std::vector<double> plain_newton(Contacts& contacts, std::span<const Ramp> ramps, std::vector<double> y) {
  Eigen::VectorXd residual(static_cast<Eigen::Index>(y.size()));
  Eigen::MatrixXd jacobian;
  for (int i = 0; i < 100; ++i) {
    nonlocal::residual(contacts, ramps, 1.0, y, {residual.data(), y.size()});
    nonlocal::jacobian(contacts, ramps, y, jacobian);
    const Eigen::VectorXd step = jacobian.partialPivLu().solve(residual);
    for (std::size_t j = 0; j < y.size(); ++j) y[j] -= step[static_cast<Eigen::Index>(j)];
  }
  nonlocal::residual(contacts, ramps, 1.0, y, {residual.data(), y.size()});
  EXPECT_LE(residual.norm(), 1e-12);  // it does find a solution
  return y;
}

TEST(NonlocalBranch, IsThePhysicalOneFromAColdStart) {
  // Equal contact radii are a plausible guess for a compressed particle, but lead to the wrong branch.
  const double displacement = 0.4;
  Contacts contacts({k_rubber, Terms::four}, die(), Centre::fixed);
  const auto ramps = compression(2, displacement);
  const std::vector<double> wrong = plain_newton(contacts, ramps, {0.5, 0.5});

  std::vector<double> y{0.0, 0.0};
  solve(contacts, ramps, 1.0, y);
  EXPECT_GT(contacts.margin(y), 0.2);
  EXPECT_LT(contacts.margin(wrong), -0.1);
  EXPECT_GT(states_of(contacts, wrong)[0].force, 1.5 * states_of(contacts, y)[0].force);

  // The solution along the branch, by small steps.
  std::vector<double> followed{0.0, 0.0};
  for (int i = 1; i <= 1000; ++i) solve(contacts, ramps, 1e-3 * i, followed);
  for (std::size_t j = 0; j < 2; ++j) EXPECT_NEAR(y[j], followed[j], 1e-15);
  // From two guesses, one beyond the limit and one below it.
  std::vector<double> guess{0.5, 0.5};
  EXPECT_THROW(solve(contacts, ramps, 1.0, guess), std::domain_error);
  EXPECT_EQ(guess, (std::vector{0.5, 0.5}));
  guess = {0.4, 0.4};
  solve(contacts, ramps, 1.0, guess);
  for (std::size_t j = 0; j < 2; ++j) EXPECT_NEAR(guess[j], y[j], 1e-15);
}

TEST(NonlocalBranch, IsRefusedAsAStartWhereItIsTheWrongOne) {
  Contacts contacts({k_rubber, Terms::four}, die(), Centre::fixed);
  const double displacement = 0.45;
  const std::vector<double> wrong = plain_newton(contacts, compression(2, displacement), {1.1, 1.1});
  ASSERT_LT(contacts.margin(wrong), 0.0);
  std::vector<double> y = wrong;
  EXPECT_THROW(solve(contacts, compression(2, displacement), 1.0, y), std::domain_error);
  EXPECT_EQ(y, wrong);
}

TEST(NonlocalBranch, DoesNotGoOnBeyondItsLimit) {
  Contacts contacts({k_rubber, Terms::four}, die(), Centre::fixed);
  std::vector<double> y{0.0, 0.0};
  const auto limit = 0.45965445411161659;
  solve(contacts, compression(2, limit - 1e-6), 1.0, y);
  const std::vector<double> before = y;
  for (const double beyond : {1e-9, 1e-3, 0.1}) {
    const std::string message = refusal<std::domain_error>([&] {
      solve(contacts, compression(2, limit + beyond), 1.0, y);
      return 0;
    });
    EXPECT_TRUE(contains(message, "limit of applicability") && contains(message, "(margin = ")) << message;
    EXPECT_EQ(y, before);
  }
  // Under force control Newton's method passes the limit easily.
  const double force = states_of(contacts, y)[0].force;
  std::vector<Ramp> ramps(2);
  ramps[0] = {.start = 0.0, .end = 1.1 * force, .control = Control::force};
  const std::vector<double> passed = plain_newton(contacts, ramps, y);
  EXPECT_LT(contacts.margin(passed), 0.0);
  EXPECT_LT(states_of(contacts, passed)[0].displacement, limit);
  EXPECT_THROW(solve(contacts, ramps, 1.0, y), std::domain_error);
  EXPECT_EQ(y, before);
}

TEST(NonlocalBranch, IsFoundFromFarAway) {
  Contacts contacts({k_rubber, Terms::four}, oblique_die(), Centre::fixed);
  std::vector<double> near_limit(4, 0.0);
  solve(contacts, compression(4, 0.4426), 1.0, near_limit);
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> displacement(-0.1, 0.4426);
  std::vector<double> y = near_limit;
  for (int i = 0; i < 200; ++i) {
    const auto ramps = compression(4, displacement(generator));
    std::vector<double> direct(4, 0.0);
    solve(contacts, ramps, 1.0, direct);
    solve(contacts, ramps, 1.0, y);
    for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(y[j], direct[j], 1e-12);
  }
}

TEST(NonlocalBranch, HasNoModesBeyondThoseOfClassesOfOneWall) {
  // Close walls push the surface off each other, which may break the symmetry of a class.
  const auto classes = oblique_die(20.0, 4);
  EXPECT_TRUE(Contacts({k_rubber}, classes, Centre::fixed).has_modes_of_walls());
  EXPECT_FALSE(Contacts({k_rubber}, single_walls(classes), Centre::fixed).has_modes_of_walls());
}

TEST(NonlocalSymmetry, UnloadingRetracesLoading) {
  Contacts contacts({k_rubber, Terms::four}, oblique_die(8.0), Centre::fixed);
  std::vector<double> y(4, 0.0);
  std::vector<std::vector<double>> path;
  for (int i = 0; i <= 90; ++i) {
    solve(contacts, compression(4, 0.005 * i), 1.0, y);
    path.push_back(y);
  }
  for (int i = 90; i >= 0; --i) {
    solve(contacts, compression(4, 0.005 * i), 1.0, y);
    for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(y[j], path[static_cast<std::size_t>(i)][j], 1e-14);
  }
}

TEST(NonlocalSymmetry, MovingAllWallsTogetherMovesTheCentreAlone) {
  const auto walls = trigonal_walls();
  Contacts contacts({0.4, Terms::three}, walls.classes(), Centre::free);
  std::vector<double> displacements{0.15, 0.13, 0.0, 0.04, -0.01};
  const auto y = state_under(contacts, displacements);
  const Eigen::Vector3d shift(0.03, -0.02, 0.04);
  for (std::size_t j = 0; j < 5; ++j) displacements[j] -= walls.normals[j].dot(shift);
  const auto moved = state_under(contacts, displacements);
  for (std::size_t j = 0; j < 5; ++j) EXPECT_NEAR(moved[j], y[j], 1e-15);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(moved[5 + k], y[5 + k] + shift[static_cast<Eigen::Index>(k)], 1e-15);
}

TEST(NonlocalSymmetry, ForcesBalanceWhereTheCentreIsFree) {
  const auto walls = trigonal_walls();
  Contacts contacts({0.4, Terms::four}, walls.classes(), Centre::free);
  const auto y = state_under(contacts, std::vector{0.15, 0.13, 0.0, 0.04, -0.01});
  Eigen::Vector3d net = Eigen::Vector3d::Zero();
  const auto states = states_of(contacts, y);
  for (std::size_t j = 0; j < 5; ++j) net += states[j].force * walls.normals[j];
  EXPECT_LE(net.norm(), 1e-15 * 5);
  EXPECT_GT(states[2].force, 1e-3);
}

TEST(NonlocalSymmetry, ItDoesNotMatterWhichOfTwoWallsMoves) {
  const auto walls = single_walls(die());
  Contacts contacts({k_rubber, Terms::four}, walls, Centre::free);
  const auto both = state_under(contacts, std::vector{0.15, 0.15, 0.0, 0.0, 0.0, 0.0});
  const auto one = state_under(contacts, std::vector{0.3, 0.0, 0.0, 0.0, 0.0, 0.0});
  for (std::size_t j = 0; j < 6; ++j) EXPECT_NEAR(one[j], both[j], 1e-15);
  EXPECT_NEAR(one[8], -0.15, 1e-15);
}

TEST(NonlocalSymmetry, AFreeCentreIsFoundAmongAnyWalls) {
  // Six walls, no two of them closer than 50 degrees. The particle escapes from some of these sets.
  std::mt19937_64 generator(3);
  std::normal_distribution<double> coordinate;
  std::uniform_real_distribution<double> displacement(-0.005, 0.04);
  int held_count = 0;
  for (int scene = 0; scene < 200; ++scene) {
    std::vector<ContactClass> walls;
    while (walls.size() < 6) {
      const Eigen::Vector3d normal =
          Eigen::Vector3d(coordinate(generator), coordinate(generator), coordinate(generator)).normalized();
      const bool is_apart = std::none_of(walls.begin(), walls.end(), [&](const ContactClass& other) {
        return angle_between(other.normals[0], normal) < 50.0 * k_degree;
      });
      if (is_apart) walls.push_back({.name = "wall", .normals = {normal}});
    }
    std::vector<double> displacements;
    for (std::size_t j = 0; j < 6; ++j) displacements.push_back(0.02 + displacement(generator));
    Contacts contacts({0.4, Terms::four}, walls, Centre::free);
    const auto y = state_under(contacts, displacements);
    Eigen::Vector3d net = Eigen::Vector3d::Zero();
    double sum = 0.0;
    const auto states = states_of(contacts, y);
    // A particle that escapes between distant walls goes far.
    const double distance = Eigen::Vector3d(y[6], y[7], y[8]).norm();
    for (std::size_t j = 0; j < 6; ++j) {
      net += states[j].force * walls[j].normals[0];
      sum += states[j].force;
      EXPECT_NEAR(states[j].displacement, displacements[j], 1e-15 * (1.0 + distance));
    }
    if (sum > 0.0) ++held_count;
    EXPECT_LE(net.norm(), 1e-14 * sum) << "scene " << scene;
    EXPECT_GT(contacts.margin(y), 0.0);
  }
  EXPECT_GT(held_count, 180);
}

TEST(NonlocalSymmetry, AWallThatStaysOpenChangesNothing) {
  // The axial contact, 28 degrees away, pushes the surface off this wall.
  Contacts with({k_rubber, Terms::four}, oblique_die(62.0), Centre::fixed);
  Contacts without({k_rubber, Terms::four}, die(), Centre::fixed);
  std::vector<double> y(4, 0.0);
  std::vector<double> y_die(2, 0.0);
  for (const double displacement : {1e-6, 0.01, 0.2, 0.45}) {
    solve(with, compression(4, displacement), 1.0, y);
    solve(without, compression(2, displacement), 1.0, y_die);
    EXPECT_LT(y[3], 0.0);
    EXPECT_NEAR(y[0], y_die[0], 1e-14);
    EXPECT_NEAR(y[1], y_die[1], 1e-14);
    EXPECT_NEAR(y[2], y_die[1], 1e-14);
    EXPECT_EQ(with.deformed_radius(RadiusRule::closed, 3, y), 0.0);
  }
}

TEST(NonlocalRefusal, NamesForcesThatPull) {
  Contacts contacts({k_rubber}, die(), Centre::fixed);
  std::vector<double> y{0.0, 0.0};
  std::vector<Ramp> ramps(2);
  ramps[0] = {.start = 0.0, .end = -0.2, .control = Control::force};
  EXPECT_THROW(solve(contacts, ramps, 1.0, y), std::domain_error);
  ramps[0].end = std::nan("");
  EXPECT_THROW(solve(contacts, ramps, 1.0, y), std::domain_error);
  EXPECT_EQ(y, (std::vector{0.0, 0.0}));
}

TEST(NonlocalRefusal, NamesACentreThatNothingHolds) {
  // All three walls are on one side of the particle.
  std::vector<ContactClass> bowl;
  for (const double degrees : {0.0, 120.0, 240.0})
    bowl.push_back(
        {.name = "side",
         .normals = {Eigen::Vector3d(std::cos(degrees * k_degree), std::sin(degrees * k_degree), 0.5).normalized()}});
  Contacts contacts({0.3}, bowl, Centre::free);
  std::vector<double> y(contacts.unknown_count(), 0.0);
  const auto ramps = held(std::vector{0.01, 0.01, 0.01}, Control::force);
  EXPECT_TRUE(contains(refusal<std::domain_error>([&] {
                         solve(contacts, ramps, 1.0, y);
                         return 0;
                       }),
                       "no contact holds the free centre"));
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_equilibrium_test
