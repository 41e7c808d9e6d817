#include "nonlocal/coupling.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "models/accuracy.hpp"
#include "models/nonlocal/cases.hpp"

namespace monograin::nonlocal::nonlocal_coupling_test {
namespace {

using std::numbers::pi;

constexpr std::array k_ratios{0.0, 0.15, 0.3, 0.48, 0.5};

TEST(NonlocalInfluence, HasClosedValues) {
  for (const double nu : k_ratios) {
    EXPECT_LE(relative_error(half_space_influence(nu, pi), (1.0 + nu) * (3.0 - 2.0 * nu) / (4.0 * pi)), 8 * k_epsilon);
  }
  // From thirty digits; the terms are up to six times as large as their sum.
  EXPECT_LE(relative_error(half_space_influence(0.48, 0.5 * pi), 0.080519627353054692), 1e-15);
}

TEST(NonlocalInfluence, PushesCloseNeighboursAway) {
  struct Row {
    double nu, degrees;
  };
  for (const auto& [nu, degrees] : {Row{0.15, 84.97}, {0.3, 80.40}, {0.45, 73.59}, {0.48, 71.82}, {0.499, 70.60}}) {
    EXPECT_LT(half_space_influence(nu, (degrees - 0.006) * k_degree), 0.0) << nu;  // printed to 0.01
    EXPECT_GT(half_space_influence(nu, (degrees + 0.006) * k_degree), 0.0) << nu;
  }
}

TEST(NonlocalRadius, HasTheClosedValuesOfTheSource) {
  for (const double nu : k_ratios) {
    for (const double x : {0.05, 0.3, 0.9}) {
      // Eqs. 7 and 13 as printed.
      const double q = std::sqrt(1.0 - x * x);
      const double plus = std::sqrt(0.5 * (1.0 + q));
      const double minus = std::sqrt(0.5 * (1.0 - q));
      const double c = (1.0 + nu) / (4.0 * pi);
      EXPECT_NEAR(local_radius_influence(nu, x), c * (plus - 2.0 * (1.0 - 2.0 * nu) / x * (1.0 - minus)), 1e-13);
      EXPECT_NEAR(pole_radius_influence(nu, x), c * (minus - 2.0 * (1.0 - 2.0 * nu) / x * (1.0 - plus)), 1e-13);
    }
    // Eq. 11 at the pole, which it misses: x (1+2nu)/4.
    EXPECT_LE(relative_error(pole_radius_influence(nu, 1e-9), 1e-9 * (1.0 + nu) * (1.0 + 2.0 * nu) / (16.0 * pi)),
              1e-14);
  }
}

TEST(NonlocalRadius, IsTheSameAtThePoleByEveryRule) {
  for (const double nu : k_ratios) {
    for (const double x : {1e-4, 0.1, 0.5, 0.75, 0.95}) {
      const double pole = pole_radius_influence(nu, x);
      EXPECT_EQ(radius_influence(RadiusRule::closed, nu, pi, x), pole);
      EXPECT_NEAR(radius_influence(RadiusRule::integral, nu, pi, x), pole, 2e-15) << "nu = " << nu << ", x = " << x;
      EXPECT_NEAR(radius_influence(RadiusRule::projected, nu, pi, x), pole, 2e-15) << "nu = " << nu << ", x = " << x;
    }
  }
}

TEST(NonlocalRadius, HasTheIntegralsOfTheReference) {
  struct Row {
    double nu, x, integral, closed;
  };
  // theta = 90 degrees, digits as printed.
  for (const auto& [nu, x, by_integral, closed] : {Row{0.48, 0.10, -2.294e-3, -2.248e-3},
                                                   {0.48, 0.25, -6.091e-3, -5.608e-3},
                                                   {0.48, 0.50, -1.474e-2, -1.103e-2},
                                                   {0.48, 0.75, -3.177e-2, -1.534e-2},
                                                   {0.30, 0.50, -2.151e-2, -1.567e-2},
                                                   {0.15, 0.50, -2.535e-2, -1.830e-2}}) {
    const double last_digit = std::abs(by_integral) < 1e-2 ? 5.1e-7 : 5.1e-6;
    EXPECT_NEAR(radius_influence(RadiusRule::integral, nu, 0.5 * pi, x), by_integral, last_digit);
    EXPECT_NEAR(radius_influence(RadiusRule::closed, nu, 0.5 * pi, x), closed, last_digit);
  }
}

TEST(NonlocalRadius, TendsToTheFirstOrderOfEachRule) {
  constexpr double x = 1e-5;
  for (const double nu : k_ratios) {
    for (const double degrees : {40.0, 90.0, 135.0, 170.0}) {
      const double theta = degrees * k_degree;
      const double s = std::sin(0.5 * theta);
      const double c = std::cos(0.5 * theta);
      const double unit = (1.0 + nu) / (4.0 * pi) * x;
      // Errors are of second order in x over the distance from the force and the pole, 10 degrees at least.
      const double tolerance = 1e-3 * unit;
      const double published = 0.25 * unit * c * c * (4.0 * nu - 3.0 - std::cos(theta)) / s;  // eq. 11
      EXPECT_NEAR(radius_influence(RadiusRule::integral, nu, theta, x), published, tolerance) << nu << ' ' << degrees;
      EXPECT_NEAR(radius_influence(RadiusRule::closed, nu, theta, x), published, tolerance) << nu << ' ' << degrees;
      // Half the divergence of the displacement in the tangent plane.
      const double m = 1.0 - 2.0 * nu;
      const double axial = 0.5 * c * (1.0 - 2.0 * (1.0 - nu) / (s * s));
      const double around = (1.0 - m / (s * (1.0 + s))) / (2.0 * s);
      const double along =
          -0.5 * s * (1.0 - m / (s * (1.0 + s))) + m * (1.0 - s) * (1.0 + 2.0 * s) / (2.0 * s * s * (1.0 + s));
      const double projected = 0.5 * unit * (axial * std::sin(theta) + along * std::cos(theta) + around);
      EXPECT_NEAR(radius_influence(RadiusRule::projected, nu, theta, x), projected, tolerance) << nu << ' ' << degrees;
    }
  }
}

TEST(NonlocalRadius, IsContinuousByTheClosedForm) {
  for (const double nu : k_ratios) {
    for (const double x : {0.1, 0.5, 0.9}) {
      const double critical = pi - 16.0 * pi / ((1.0 + nu) * (1.0 + 2.0 * nu)) * pole_radius_influence(nu, x);
      EXPECT_NEAR(radius_influence(RadiusRule::closed, nu, critical - 1e-14, x), 0.0, 1e-14);
      EXPECT_NEAR(radius_influence(RadiusRule::closed, nu, critical + 1e-14, x), 0.0, 1e-14);
      // The function has a kink, not an extremum: it has both signs around it.
      EXPECT_LT(radius_influence(RadiusRule::closed, nu, critical - 1e-3, x), 0.0);
      EXPECT_GT(radius_influence(RadiusRule::closed, nu, critical + 1e-3, x), 0.0);
    }
  }
}

TEST(NonlocalRadius, IsLeftAloneWithoutARule) { EXPECT_EQ(radius_influence(RadiusRule::none, 0.3, 1.0, 0.5), 0.0); }

TEST(NonlocalRadius, EndsWhereTheContactIsAsWideAsTheSphere) {
  EXPECT_NEAR(radius_influence(RadiusRule::closed, 0.3, 2.0, 1.0),
              radius_influence(RadiusRule::closed, 0.3, 2.0, 1.0 - 1e-12), 1e-6);
  for (const double x : {1.0 + 1e-9, 1.2, std::nan("")}) {
    for (const RadiusRule rule : {RadiusRule::closed, RadiusRule::integral, RadiusRule::projected, RadiusRule::none}) {
      EXPECT_TRUE(contains(refusal<std::domain_error>([&] { return radius_influence(rule, 0.3, 2.0, x); }),
                           std::isnan(x) ? "= nan"
                           : x > 1.1     ? "= 1.2)"
                                         : "= 1)"));
    }
    EXPECT_THROW(static_cast<void>(local_radius_influence(0.3, x)), std::domain_error);
    EXPECT_THROW(static_cast<void>(pole_radius_influence(0.3, x)), std::domain_error);
  }
}

TEST(NonlocalEdges, MeetWhereTheAnglesOfTheContactsAddUp) {
  // Two walls of a cube around the particle, with contacts up to the cube's edges.
  EXPECT_NEAR(edge_angle(0.8, 0.2), 0.25 * pi, k_epsilon);
  EXPECT_LT(edge_angle(0.79, 0.2), 0.25 * pi);
  EXPECT_EQ(edge_angle(0.0, 0.3), 0.0);
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_coupling_test
