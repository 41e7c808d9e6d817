#include "elastic/nonlocal_contacts.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "elastic/hertz.hpp"
#include "models/accuracy.hpp"
#include "models/elastic/nonlocal_cases.hpp"

namespace monograin::nonlocal::nonlocal_contacts_test {
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

// --- reference curves

struct Curve {
  const char* file;
  const char* walls;
  int terms;
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
    contacts.solve(ramps, 1.0, y);
    std::vector<double> alone(contacts.unknown_count(), 0.0);
    contacts.solve(ramps, 1.0, alone);
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

/// Cases with one column group per wall.
struct SingleWalls {
  std::vector<std::string> names;
  std::vector<Eigen::Vector3d> normals;

  [[nodiscard]] std::vector<ContactClass> classes() const {
    std::vector<ContactClass> list;
    for (std::size_t i = 0; i < names.size(); ++i) list.push_back({.name = names[i], .normals = {normals[i]}});
    return list;
  }
};

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
      contacts.solve(held(now), 1.0, y);
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

SingleWalls trigonal_walls() {
  SingleWalls walls{.names = {"z+", "z-", "l0", "l120", "l240"},
                    .normals = {Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitZ()}};
  for (const double degrees : {0.0, 120.0, 240.0})
    walls.normals.emplace_back(std::cos(degrees * k_degree), std::sin(degrees * k_degree), 0.0);
  return walls;
}

TEST(NonlocalCurveWithGaps, AgreesWithThirtyDigitsOnTheWayAndBack) {
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
    contacts.solve(ramps, 0.5, y);
    axial.expect(row, contacts, 0, y);
    lateral.expect(row, contacts, 1, y);
    displacement.expect(row, states_of(contacts, y)[0].displacement, 1e-12);
    margin.expect(row, contacts.margin(y), 1e-12);
  }
}

// --- the branch

/// Newton's method in s without safeguards.
std::vector<double> plain_newton(Contacts& contacts, std::span<const Ramp> ramps, std::vector<double> y) {
  Eigen::VectorXd residual(static_cast<Eigen::Index>(y.size()));
  Eigen::MatrixXd jacobian;
  for (int i = 0; i < 100; ++i) {
    contacts.residual(ramps, 1.0, y, {residual.data(), y.size()});
    contacts.jacobian(ramps, y, jacobian);
    const Eigen::VectorXd step = jacobian.partialPivLu().solve(residual);
    for (std::size_t j = 0; j < y.size(); ++j) y[j] -= step[static_cast<Eigen::Index>(j)];
  }
  contacts.residual(ramps, 1.0, y, {residual.data(), y.size()});
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
  contacts.solve(ramps, 1.0, y);
  EXPECT_GT(contacts.margin(y), 0.2);
  EXPECT_LT(contacts.margin(wrong), -0.1);
  EXPECT_GT(states_of(contacts, wrong)[0].force, 1.5 * states_of(contacts, y)[0].force);

  // The solution along the branch, by small steps.
  std::vector<double> followed{0.0, 0.0};
  for (int i = 1; i <= 1000; ++i) contacts.solve(ramps, 1e-3 * i, followed);
  for (std::size_t j = 0; j < 2; ++j) EXPECT_NEAR(y[j], followed[j], 1e-15);
  // From two guesses, one beyond the limit and one below it.
  std::vector<double> guess{0.5, 0.5};
  EXPECT_THROW(contacts.solve(ramps, 1.0, guess), std::domain_error);
  EXPECT_EQ(guess, (std::vector{0.5, 0.5}));
  guess = {0.4, 0.4};
  contacts.solve(ramps, 1.0, guess);
  for (std::size_t j = 0; j < 2; ++j) EXPECT_NEAR(guess[j], y[j], 1e-15);
}

/// The least eigenvalue of 1 - sqrt(k_i) G_ij sqrt(k_j) over single walls, from scratch.
double least_eigenvalue(Contacts& contacts, const std::vector<ContactClass>& walls, std::span<const double> y) {
  const auto states = states_of(contacts, y);
  const auto count = static_cast<Eigen::Index>(walls.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      if (i == j) continue;
      const auto first = static_cast<std::size_t>(i);
      const auto second = static_cast<std::size_t>(j);
      const double angle = angle_between(walls[first].normals[0], walls[second].normals[0]);
      matrix(i, j) -=
          half_space_influence(k_rubber, angle) * std::sqrt(states[first].stiffness * states[second].stiffness);
    }
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues()[0];
}

TEST(NonlocalBranch, HasAMarginThatDoesNotDependOnWhatWasSeenBefore) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> square(-0.1, 0.6);
  for (const auto& classes : {simple(), die(), hydrostatic(), oblique_die(), oblique_die(8.0)}) {
    const auto walls = single_walls(classes);
    Contacts contacts({k_rubber, Terms::four}, walls, Centre::fixed);
    std::vector<double> y(walls.size());
    for (int draw = 0; draw < 300; ++draw) {
      // Some walls at a time: the critical mode jumps from one group of them to another.
      for (double& one : y) one = random() % 3 == 0 ? -0.1 : square(random);
      EXPECT_NEAR(contacts.margin(y), least_eigenvalue(contacts, walls, y), 4e-14) << "draw " << draw;
    }
  }
}

TEST(NonlocalBranch, IsRefusedAsAStartWhereItIsTheWrongOne) {
  Contacts contacts({k_rubber, Terms::four}, die(), Centre::fixed);
  const double displacement = 0.45;
  const std::vector<double> wrong = plain_newton(contacts, compression(2, displacement), {1.1, 1.1});
  ASSERT_LT(contacts.margin(wrong), 0.0);
  std::vector<double> y = wrong;
  EXPECT_THROW(contacts.solve(compression(2, displacement), 1.0, y), std::domain_error);
  EXPECT_EQ(y, wrong);
}

TEST(NonlocalBranch, IsFollowedInPiecesWhereWallsPushEachOtherOff) {
  const double angle = 5.0 * k_degree;
  Contacts contacts({k_rubber, Terms::four},
                    std::vector<ContactClass>{{"first", {Eigen::Vector3d::UnitZ()}},
                                              {"second", {Eigen::Vector3d(std::sin(angle), 0.0, std::cos(angle))}}},
                    Centre::fixed);
  // At the point where either of two equal contacts may open, the mode in which one grows and the other shrinks is
  // free.
  const double square = 4.0 * contacts.branch_reach(0, 0.0);
  EXPECT_NEAR(contacts.margin(std::vector{square, square}), 0.0, 1e-12);
  EXPECT_NEAR(contacts.branch_reach(1, -100.0 * square), 50.0 * square, 1e-12);
  // Walls far from each other do not lift each other.
  EXPECT_EQ(Contacts({k_rubber, Terms::four}, die(), Centre::fixed).branch_reach(0, 0.0),
            std::numeric_limits<double>::infinity());
}

TEST(NonlocalBranch, DoesNotGoOnBeyondItsLimit) {
  Contacts contacts({k_rubber, Terms::four}, die(), Centre::fixed);
  std::vector<double> y{0.0, 0.0};
  const auto limit = 0.45965445411161659;
  contacts.solve(compression(2, limit - 1e-6), 1.0, y);
  const std::vector<double> before = y;
  for (const double beyond : {1e-9, 1e-3, 0.1}) {
    const std::string message = refusal<std::domain_error>([&] {
      contacts.solve(compression(2, limit + beyond), 1.0, y);
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
  EXPECT_THROW(contacts.solve(ramps, 1.0, y), std::domain_error);
  EXPECT_EQ(y, before);
}

TEST(NonlocalBranch, IsFoundFromFarAway) {
  Contacts contacts({k_rubber, Terms::four}, oblique_die(), Centre::fixed);
  std::vector<double> near_limit(4, 0.0);
  contacts.solve(compression(4, 0.4426), 1.0, near_limit);
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> displacement(-0.1, 0.4426);
  std::vector<double> y = near_limit;
  for (int i = 0; i < 200; ++i) {
    const auto ramps = compression(4, displacement(generator));
    std::vector<double> direct(4, 0.0);
    contacts.solve(ramps, 1.0, direct);
    contacts.solve(ramps, 1.0, y);
    for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(y[j], direct[j], 1e-12);
  }
}

// --- equations

struct Scene {
  const char* name;
  std::vector<ContactClass> classes;
  Centre centre;
  double poisson_ratio;
  std::vector<double> displacements;
};

std::vector<Scene> scenes() {
  return {{"die", die(), Centre::fixed, k_rubber, {0.35, 0.02}},
          {"die with open walls", single_walls(die()), Centre::free, k_rubber, {0.2, 0.2, 0.01, 0.03, -0.1, -0.1}},
          {"oblique die", oblique_die(), Centre::fixed, 0.3, {0.2, 0.01, 0.0, -0.01}},
          {"close walls", oblique_die(20.0, 4), Centre::fixed, k_rubber, {0.3, 0.01, 0.01, 0.0}},
          {"trigonal", trigonal_walls().classes(), Centre::free, 0.4, {0.15, 0.13, 0.0, 0.04, -0.01}}};
}

TEST(NonlocalEquations, HaveTheJacobianOfTheirResidual) {
  for (const Scene& scene : scenes()) {
    for (const Terms terms : k_all_terms) {
      Contacts contacts({scene.poisson_ratio, terms}, scene.classes, scene.centre);
      std::vector<double> y = state_under(contacts, scene.displacements);
      auto ramps = held(scene.displacements);
      ramps[1] = {.start = 0.001, .end = 0.002, .control = Control::force};
      Eigen::MatrixXd jacobian;
      contacts.jacobian(ramps, y, jacobian);
      std::vector<double> residual(y.size());
      for (std::size_t i = 0; i < y.size(); ++i) {
        for (std::size_t k = 0; k < y.size(); ++k) {
          const double derivative = central_difference(
              [&](double value) {
                std::vector<double> moved = y;
                moved[k] = value;
                contacts.residual(ramps, 0.3, moved, residual);
                return residual[i];
              },
              y[k], std::max(1e-2 * std::abs(y[k]), 1e-6));
          // Round-off of numbers up to 1, over the step.
          EXPECT_NEAR(jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)), derivative, 1e-9)
              << scene.name << ", " << i << ", " << k;
        }
      }
    }
  }
}

TEST(NonlocalEquations, HaveNoResidualInASolution) {
  for (const Scene& scene : scenes()) {
    Contacts contacts({scene.poisson_ratio, Terms::four}, scene.classes, scene.centre);
    const std::vector<double> y = state_under(contacts, scene.displacements);
    std::vector<double> residual(y.size());
    contacts.residual(held(scene.displacements), 0.0, y, residual);
    for (const double value : residual) EXPECT_NEAR(value, 0.0, 1e-15) << scene.name;
    const auto states = states_of(contacts, y);
    for (std::size_t j = 0; j < states.size(); ++j) {
      EXPECT_NEAR(states[j].displacement, scene.displacements[j], 1e-15) << scene.name;
      EXPECT_EQ(states[j].force > 0.0, y[j] > 0.0);
    }
  }
}

TEST(NonlocalRates, AreThoseOfTheSolutions) {
  for (const Scene& scene : scenes()) {
    Contacts contacts({scene.poisson_ratio, Terms::four}, scene.classes, scene.centre);
    std::vector<Ramp> ramps = held(scene.displacements);
    for (std::size_t j = 0; j < ramps.size(); ++j) ramps[j].end += j % 2 == 0 ? 0.02 : -0.01;
    const std::vector<double> start = state_under(contacts, scene.displacements);
    for (const bool has_force : {false, true}) {
      const std::size_t driven = scene.centre == Centre::free ? 0 : 1;
      if (has_force) {
        const double force = states_of(contacts, start)[driven].force;
        ramps[driven] = {.start = force, .end = 1.1 * force + 1e-3, .control = Control::force};
      }
      const auto state_at = [&](double xi) {
        std::vector<double> y = start;
        contacts.solve(ramps, xi, y);
        return y;
      };
      const double xi = 0.5;
      std::vector<double> rates(start.size());
      contacts.rates(ramps, state_at(xi), rates);
      for (std::size_t i = 0; i < start.size(); ++i) {
        const double derivative = central_difference([&](double x) { return state_at(x)[i]; }, xi, 0.02);
        EXPECT_NEAR(rates[i], derivative, 1e-9) << scene.name << ", unknown " << i << ", force " << has_force;
      }
    }
  }
}

TEST(NonlocalRates, AreRegularWhereNothingIsLoaded) {
  Contacts contacts({k_rubber, Terms::four}, die(), Centre::fixed);
  std::vector<double> rates(2);
  contacts.rates(compression(2, 0.4), std::vector{0.0, 0.0}, rates);
  EXPECT_EQ(rates[0], 0.4);
  EXPECT_EQ(rates[1], 0.0);
  auto ramps = compression(2, 0.4);
  ramps[0].control = Control::force;
  contacts.rates(ramps, std::vector{0.0, 0.0}, rates);
  EXPECT_EQ(rates[0], std::numeric_limits<double>::infinity());
  EXPECT_EQ(rates[1], 0.4 * contacts.coupling()(1, 0));
}

TEST(NonlocalRates, LetAFreeCentreFollowFromFirstTouch) {
  Contacts contacts({k_rubber, Terms::four}, single_walls(simple()), Centre::free);
  std::vector<double> rates(3);
  contacts.rates(std::vector<Ramp>{{0.0, 0.1}, {0.0, 0.0}}, std::vector{0.0, 0.0, 0.0}, rates);
  const double along = contacts.free_directions()(2, 0);
  EXPECT_NEAR(rates[0], 0.05, 1e-16);
  EXPECT_NEAR(rates[1], 0.05, 1e-16);
  EXPECT_NEAR(rates[2] * along, -0.05, 1e-16);
  // A retreating wall does not take the particle with it.
  contacts.rates(std::vector<Ramp>{{0.0, -0.1}, {0.0, 0.0}}, std::vector{0.0, 0.0, 0.0}, rates);
  EXPECT_EQ(rates, (std::vector{-0.1, 0.0, 0.0}));
}

TEST(NonlocalRates, EndWhereAForceDrivesAFreeCentreThatNothingHolds) {
  Contacts contacts({k_rubber, Terms::four}, single_walls(simple()), Centre::free);
  std::vector<double> rates(3);
  const std::vector<Ramp> ramps{{0.0, 0.1, Control::force}, {-0.01, 0.2, Control::displacement}};
  EXPECT_TRUE(contains(refusal<std::domain_error>([&] {
                         contacts.rates(ramps, std::vector{0.0, -0.01, 0.0}, rates);
                         return 0;
                       }),
                       "no contact holds the free centre"));
  // The other wall supports the centre once it touches, and a constant force drives nothing.
  EXPECT_NO_THROW(contacts.rates(ramps, std::vector{0.0, 0.0, 0.0}, rates));
  const std::vector<Ramp> constant{{0.1, 0.1, Control::force}, {-0.01, 0.2, Control::displacement}};
  EXPECT_NO_THROW(contacts.rates(constant, std::vector{0.01, -0.01, 0.0}, rates));
}

TEST(NonlocalRates, EndAtTheLimit) {
  Contacts contacts({k_rubber, Terms::four}, hydrostatic(), Centre::fixed);
  std::vector<double> rates(1);
  const double limit = 1.0 / (2.0 * contacts.composite_modulus() * contacts.coupling()(0, 0));
  const double below = limit * limit * (1.0 - 1e-9);
  const double above = limit * limit * (1.0 + 1e-9);
  EXPECT_NO_THROW(contacts.rates(compression(1, 0.1), std::vector{below}, rates));
  EXPECT_THROW(contacts.rates(compression(1, 0.1), std::vector{above}, rates), std::domain_error);
}

TEST(NonlocalStiffness, IsTheDerivativeOfTheForces) {
  for (const Scene& scene : scenes()) {
    Contacts contacts({scene.poisson_ratio, Terms::four}, scene.classes, scene.centre);
    const std::vector<double> start = state_under(contacts, scene.displacements);
    Eigen::MatrixXd stiffness;
    contacts.stiffness(start, stiffness);
    for (std::size_t h = 0; h < scene.displacements.size(); ++h) {
      for (std::size_t j = 0; j < scene.displacements.size(); ++j) {
        const double derivative = central_difference(
            [&](double value) {
              std::vector<double> moved = scene.displacements;
              moved[h] = value;
              std::vector<double> y = start;
              contacts.solve(held(moved), 1.0, y);
              return states_of(contacts, y)[j].force;
            },
            scene.displacements[h], 2e-4);
        EXPECT_NEAR(stiffness(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(h)), derivative, 1e-9)
            << scene.name << ", " << j << ", " << h;
      }
    }
  }
}

TEST(NonlocalEnergy, HasTheForcesAsGradient) {
  for (const Scene& scene : scenes()) {
    for (const Terms terms : k_all_terms) {
      Contacts contacts({scene.poisson_ratio, terms}, scene.classes, scene.centre);
      const std::vector<double> start = state_under(contacts, scene.displacements);
      const auto states = states_of(contacts, start);
      for (std::size_t j = 0; j < states.size(); ++j) {
        const double derivative = central_difference(
            [&](double value) {
              std::vector<double> moved = scene.displacements;
              moved[j] = value;
              std::vector<double> y = start;
              contacts.solve(held(moved), 1.0, y);
              return contacts.energy(y);
            },
            scene.displacements[j], 2e-4);
        EXPECT_NEAR(scene.classes[j].multiplicity() * states[j].force, derivative, 1e-10) << scene.name << ", " << j;
      }
    }
  }
}

TEST(NonlocalEnergy, IsTheWorkOfTheWalls) {
  for (const Terms terms : k_all_terms) {
    Contacts contacts({k_rubber, terms}, die(), Centre::fixed);
    const double end = 0.38;
    std::vector<double> y{0.0, 0.0};
    // In the square root of the displacement the axial force is analytic, the lateral one nearly so.
    const double work = boost::math::quadrature::gauss<double, 60>::integrate(
        [&](double root) {
          contacts.solve(compression(2, root * root), 1.0, y);
          return 2.0 * root * 2.0 * states_of(contacts, y)[0].force;
        },
        0.0, std::sqrt(end));
    contacts.solve(compression(2, end), 1.0, y);
    EXPECT_LE(relative_error(contacts.energy(y), work), 1e-12);
  }
}

// --- invariance

TEST(NonlocalSymmetry, ClassesAreTheirWalls) {
  for (const auto& classes : {simple(), die(), hydrostatic(), oblique_die(), oblique_die(37.5, 4), oblique_die(8.0)}) {
    Contacts grouped({k_rubber, Terms::four}, classes, Centre::free);
    const auto walls = single_walls(classes);
    Contacts single({k_rubber, Terms::four}, walls, Centre::free);
    EXPECT_EQ(grouped.free_count(), 0u);
    std::vector<double> displacements;
    for (const ContactClass& group : classes)
      displacements.insert(displacements.end(), group.normals.size(), group.name == "axial" ? 0.15 : 0.005);
    std::vector<double> of_classes;
    for (const ContactClass& group : classes) of_classes.push_back(group.name == "axial" ? 0.15 : 0.005);
    const auto y = state_under(grouped, of_classes);
    const auto y_single = state_under(single, displacements);
    std::size_t wall = 0;
    for (std::size_t j = 0; j < classes.size(); ++j) {
      for (std::size_t i = 0; i < classes[j].normals.size(); ++i, ++wall) {
        EXPECT_NEAR(states_of(single, y_single)[wall].force, states_of(grouped, y)[j].force, 1e-15);
        for (const RadiusRule rule : {RadiusRule::closed, RadiusRule::integral, RadiusRule::projected})
          EXPECT_NEAR(single.deformed_radius(rule, wall, y_single), grouped.deformed_radius(rule, j, y), 1e-14);
      }
    }
    EXPECT_NEAR(single.energy(y_single), grouped.energy(y), 1e-15);
    EXPECT_NEAR(single.margin(y_single), grouped.margin(y), 2e-15);
    for (std::size_t k = 0; k < single.free_count(); ++k) EXPECT_NEAR(y_single[wall + k], 0.0, 1e-16);
  }
}

TEST(NonlocalSymmetry, TurningAllWallsChangesNothing) {
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(0.3, -0.7, 0.2, 0.5).normalized();
  for (const Scene& scene : scenes()) {
    Contacts contacts({scene.poisson_ratio, Terms::four}, scene.classes, scene.centre);
    Contacts other({scene.poisson_ratio, Terms::four}, turned(scene.classes, rotation), scene.centre);
    const auto y = state_under(contacts, scene.displacements);
    const auto turned_y = state_under(other, scene.displacements);
    for (std::size_t j = 0; j < scene.classes.size(); ++j) EXPECT_NEAR(turned_y[j], y[j], 1e-14) << scene.name;
    EXPECT_NEAR(other.margin(turned_y), contacts.margin(y), 1e-14) << scene.name;
    EXPECT_NEAR(other.energy(turned_y), contacts.energy(y), 1e-16) << scene.name;
  }
}

TEST(NonlocalSymmetry, CouplingIsMutual) {
  for (const Influence influence : {Influence::half_space, Influence::sphere}) {
    const Contacts contacts({0.3, Terms::four, influence}, single_walls(oblique_die(37.5, 4)), Centre::fixed);
    EXPECT_EQ(contacts.coupling(), contacts.coupling().transpose());
    const Contacts grouped({0.3, Terms::four, influence}, oblique_die(37.5, 4), Centre::fixed);
    for (Eigen::Index j = 0; j < 4; ++j) {
      for (Eigen::Index h = 0; h < 4; ++h) {
        const double weight = j == 3 ? 2.0 : 1.0;
        EXPECT_NEAR(weight * grouped.coupling()(j, h), (h == 3 ? 2.0 : 1.0) * grouped.coupling()(h, j), 1e-15);
      }
    }
  }
}

TEST(NonlocalSymmetry, CouplingOfTheWallSetsIsThatOfTheirAngles) {
  const double opposite = half_space_influence(k_rubber, pi);
  const double square = half_space_influence(k_rubber, 0.5 * pi);
  const Contacts contacts({k_rubber, Terms::four}, die(), Centre::fixed);
  Eigen::Matrix2d expected;
  expected << opposite, 4.0 * square, 2.0 * square, opposite + 2.0 * square;
  EXPECT_LE((contacts.coupling() - expected).norm(), 1e-16);
}

TEST(NonlocalSymmetry, UnloadingRetracesLoading) {
  Contacts contacts({k_rubber, Terms::four}, oblique_die(8.0), Centre::fixed);
  std::vector<double> y(4, 0.0);
  std::vector<std::vector<double>> way;
  for (int i = 0; i <= 90; ++i) {
    contacts.solve(compression(4, 0.005 * i), 1.0, y);
    way.push_back(y);
  }
  for (int i = 90; i >= 0; --i) {
    contacts.solve(compression(4, 0.005 * i), 1.0, y);
    for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(y[j], way[static_cast<std::size_t>(i)][j], 1e-14);
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
    const double way = Eigen::Vector3d(y[6], y[7], y[8]).norm();
    for (std::size_t j = 0; j < 6; ++j) {
      net += states[j].force * walls[j].normals[0];
      sum += states[j].force;
      EXPECT_NEAR(states[j].displacement, displacements[j], 1e-15 * (1.0 + way));
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
    with.solve(compression(4, displacement), 1.0, y);
    without.solve(compression(2, displacement), 1.0, y_die);
    EXPECT_LT(y[3], 0.0);
    EXPECT_NEAR(y[0], y_die[0], 1e-14);
    EXPECT_NEAR(y[1], y_die[1], 1e-14);
    EXPECT_NEAR(y[2], y_die[1], 1e-14);
    EXPECT_EQ(with.deformed_radius(RadiusRule::closed, 3, y), 0.0);
  }
}

// --- limits of the model

TEST(NonlocalLimits, SmallContactsAreHertzs) {
  Contacts contacts({0.3, Terms::four}, simple(), Centre::fixed);
  for (const double displacement : {1e-12, 1e-8, 1e-6}) {
    const auto y = state_under(contacts, std::vector{displacement});
    const ContactState state = states_of(contacts, y)[0];
    const double force = hertz_force(composite_modulus(1.0, 0.3), 1.0, displacement);
    // The opposite contact adds G F to the displacement, of which the force is the power 3/2.
    const double lift = 1.5 * contacts.coupling()(0, 0) * force / displacement;
    EXPECT_NEAR(state.force / force - 1.0, lift, 2.0 * lift * lift + displacement + 1e-14);
    EXPECT_NEAR(contacts.deformed_radius(RadiusRule::closed, 0, y) / state.contact_radius, 1.0,
                2.0 * state.contact_radius);
  }
}

TEST(NonlocalLimits, RadiusRulesDifferAsTheirIntegralsDo) {
  Contacts contacts({k_rubber, Terms::four}, die(), Centre::fixed);
  // Digits as printed.
  for (const auto& [displacement, closed, by_integral] :
       {std::array{0.3, 0.66906, 0.66762}, std::array{0.39, 0.82049, 0.81345}}) {
    const auto y = state_under(contacts, std::vector{displacement, 0.0});
    EXPECT_NEAR(contacts.deformed_radius(RadiusRule::closed, 0, y), closed, 5.1e-6);
    EXPECT_NEAR(contacts.deformed_radius(RadiusRule::integral, 0, y), by_integral, 5.1e-6);
    EXPECT_EQ(contacts.deformed_radius(RadiusRule::none, 0, y), states_of(contacts, y)[0].contact_radius);
  }
}

TEST(NonlocalLimits, AWallIsAMirrorInTheDeformedRadius) {
  Contacts contacts({k_rubber, Terms::four}, simple(), Centre::fixed);
  const auto y = state_under(contacts, std::vector{0.5});
  EXPECT_NEAR(states_of(contacts, y)[0].contact_radius, 0.7630, 5.1e-5);
  EXPECT_NEAR(contacts.deformed_radius(RadiusRule::closed, 0, y), 0.9177, 5.1e-5);  // half the sum: 0.8403
}

TEST(NonlocalLimits, FourTermsAreNearlyAll) {
  struct Row {
    std::vector<ContactClass> classes;
    double displacement;
    std::array<double, 4> percent;  // digits as printed
  };
  for (const auto& [classes, displacement, percent] :
       {Row{simple(), 0.5, {18, 3.6, 1.1, 0.40}}, Row{die(), 0.39, {33, 3.8, 0.99, 0.31}},
        Row{hydrostatic(), 0.15, {23, 1.9, 0.30, 0.055}}, Row{oblique_die(), 0.38, {33, 3.6, 0.93, 0.29}}}) {
    const auto force = [&, classes = classes, displacement = displacement](Terms terms) {
      Contacts contacts({k_rubber, terms}, classes, Centre::fixed);
      std::vector<double> y(classes.size(), 0.0);
      contacts.solve(compression(classes.size(), displacement), 1.0, y);
      return states_of(contacts, y)[0].force;
    };
    const double all = force(Terms::all);
    for (int terms = 1; terms <= 4; ++terms) {
      const double expected = percent[static_cast<std::size_t>(terms - 1)];
      const double deviation = 100.0 * std::abs(force(static_cast<Terms>(terms)) / all - 1.0);
      EXPECT_LE(relative_error(deviation, expected), 0.03) << terms << " terms, d/R = " << displacement;
    }
  }
}

TEST(NonlocalLimits, TheSphereItselfIsSofterWhereItIsCompressible) {
  const auto force = [](double nu, Influence influence) {
    Contacts contacts({nu, Terms::four, influence}, hydrostatic(), Centre::fixed);
    return states_of(contacts, state_under(contacts, std::vector{0.05}))[0].force;
  };
  EXPECT_NEAR(force(0.48, Influence::sphere) / force(0.48, Influence::half_space), 1.0, 0.01);
  EXPECT_GT(force(0.3, Influence::sphere), 1.1 * force(0.3, Influence::half_space));
}

// --- errors

TEST(NonlocalRefusal, NamesWhatIsWrongWithTheWalls) {
  for (const double nu : {-0.1, 0.51, std::nan("")}) {
    EXPECT_TRUE(contains(refusal<std::invalid_argument>([&] { return Contacts({nu}, die(), Centre::fixed); }),
                         std::to_string(nu)));
  }
  auto close = simple();
  close.push_back({.name = "second", .normals = {Eigen::Vector3d(0.04, 0.0, 1.0).normalized()}});
  const std::string message = refusal<std::invalid_argument>([&] { return Contacts({0.3}, close, Centre::fixed); });
  EXPECT_TRUE(contains(message, "'axial' and 'second'")) << message;
  EXPECT_TRUE(contains(message, "0.0399")) << message;
  // Two pairs at different angles from the axial walls.
  auto unequal = simple();
  unequal.push_back({.name = "lateral", .normals = {{1, 0, 0}, {-1, 0, 0}, {0, 0.8, 0.6}, {0, -0.8, -0.6}}});
  EXPECT_TRUE(
      contains(refusal<std::invalid_argument>([&] { return Contacts({0.3}, unequal, Centre::fixed); }), "'lateral'"));
}

TEST(NonlocalRefusal, NamesForcesThatPull) {
  Contacts contacts({k_rubber}, die(), Centre::fixed);
  std::vector<double> y{0.0, 0.0};
  std::vector<Ramp> ramps(2);
  ramps[0] = {.start = 0.0, .end = -0.2, .control = Control::force};
  EXPECT_THROW(contacts.solve(ramps, 1.0, y), std::domain_error);
  ramps[0].end = std::nan("");
  EXPECT_THROW(contacts.solve(ramps, 1.0, y), std::domain_error);
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
                         contacts.solve(ramps, 1.0, y);
                         return 0;
                       }),
                       "no contact holds the free centre"));
}

TEST(NonlocalRefusal, NamesContactsAsWideAsTheSphere) {
  Contacts contacts({k_rubber, Terms::one}, simple(), Centre::fixed);
  const auto y = state_under(contacts, std::vector{0.8});
  ASSERT_GT(states_of(contacts, y)[0].contact_radius, 1.0);
  EXPECT_THROW(static_cast<void>(contacts.deformed_radius(RadiusRule::closed, 0, y)), std::domain_error);
  EXPECT_GT(contacts.deformed_radius(RadiusRule::none, 0, y), 1.0);
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_contacts_test
