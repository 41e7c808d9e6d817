#include "nonlocal/contacts.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
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
#include "elastic/sphere_influence.hpp"
#include "models/accuracy.hpp"
#include "models/nonlocal/cases.hpp"

namespace monograin::nonlocal::nonlocal_contacts_test {
namespace {

using std::numbers::pi;

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
              solve(contacts, held(moved), 1.0, y);
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
          solve(contacts, compression(2, root * root), 1.0, y);
          return 2.0 * root * 2.0 * states_of(contacts, y)[0].force;
        },
        0.0, std::sqrt(end));
    solve(contacts, compression(2, end), 1.0, y);
    EXPECT_LE(relative_error(contacts.energy(y), work), 1e-12);
  }
}

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
      solve(contacts, compression(classes.size(), displacement), 1.0, y);
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

TEST(NonlocalRefusal, NamesContactsAsWideAsTheSphere) {
  Contacts contacts({k_rubber, Terms::one}, simple(), Centre::fixed);
  const auto y = state_under(contacts, std::vector{0.8});
  ASSERT_GT(states_of(contacts, y)[0].contact_radius, 1.0);
  EXPECT_THROW(static_cast<void>(contacts.deformed_radius(RadiusRule::closed, 0, y)), std::domain_error);
  EXPECT_GT(contacts.deformed_radius(RadiusRule::none, 0, y), 1.0);
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_contacts_test
