// Displacement of an elastic sphere under a point force: sums of modes, printed values, limits.

#include "elastic/sphere_influence.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>
#include <numbers>

#include "models/accuracy.hpp"
#include "nonlocal/coupling.hpp"

namespace monograin::sphere_influence_test {
namespace {

using std::numbers::pi;

constexpr double k_degree = pi / 180.0;
constexpr std::array k_ratios{0.0, 0.15, 0.3, 0.48, 0.5};

/// Coefficients of 4 pi times the inward displacement, without those of the half-space and of the logarithm.
double rest_of_mode(double nu, double n) {
  const double alpha = 4.0 * (1.0 - nu * nu);
  const double beta = alpha * (1.0 - 2.0 * nu) * (1.0 - 2.0 * nu) / (2.0 * (1.0 - nu));
  if (n == 0.0) return 1.0 - 2.0 * nu - alpha;
  if (n == 1.0) return -alpha - beta;
  const double mode = (1.0 + nu) * (2.0 * (1.0 - nu) * n * n + nu * n - 1.0 + 2.0 * nu) /
                      ((n - 1.0) * (n * n + n + 1.0 + nu * (2.0 * n + 1.0)));
  return (2.0 * n + 1.0) * mode - alpha - beta / n;
}

TEST(SphereInfluence, IsTheSumOfItsModes) {
  for (const double nu : k_ratios) {
    const double alpha = 4.0 * (1.0 - nu * nu);
    const double beta = 2.0 * (1.0 + nu) * (1.0 - 2.0 * nu) * (1.0 - 2.0 * nu);
    for (const double degrees : {5.0, 30.0, 71.0, 90.0, 150.0, 180.0}) {
      const double x = std::cos(degrees * k_degree);
      const double s = std::sin(0.5 * degrees * k_degree);
      double sum = alpha / (2.0 * s) - beta * std::log(s * (1.0 + s)) + rest_of_mode(nu, 0) + rest_of_mode(nu, 1) * x;
      // The terms alternate with the angle, and are of order n^-2.5; the mean of the last sums gains further digits.
      double before = 1.0;
      double now = x;
      constexpr int k_last = 4000;
      double mean = 0.0;
      for (int n = 2; n <= k_last; ++n) {
        const double next = boost::math::legendre_next(static_cast<unsigned>(n - 1), x, now, before);
        before = now;
        now = next;
        sum += rest_of_mode(nu, n) * next;
        if (n > k_last / 2) mean += sum / (k_last / 2);
      }
      EXPECT_NEAR(sphere_influence(nu, degrees * k_degree), -mean / (4.0 * pi), 1e-8)
          << "nu = " << nu << ", " << degrees << " degrees";
    }
  }
}

TEST(SphereInfluence, HasASelfTermThatIsTheSumOfItsModes) {
  for (const double nu : k_ratios) {
    double sum = 0.0;
    double half = 0.0;
    constexpr int k_last = 100000;
    for (int n = 0; n <= k_last; ++n) {
      sum += rest_of_mode(nu, n);
      if (n == k_last / 2) half = sum;
    }
    // The tail falls like 1/n, its part in the difference like 1/n^2.
    EXPECT_NEAR(sphere_self_influence(nu), -(2.0 * sum - half) / (4.0 * pi), 1e-9) << "nu = " << nu;
  }
}

TEST(SphereInfluence, DiffersFromTheHalfSpaces) {
  // Equator between two opposite forces; digits as printed from the series solution of Navier's equations.
  struct Row {
    double nu, sphere, half_space;
  };
  for (const auto& [nu, sphere, half_space] :
       {Row{0.48, 0.20270, 0.16104}, {0.3, 0.16168, 0.09782}, {0.15, 0.12660, 0.05437}}) {
    EXPECT_NEAR(2.0 * sphere_influence(nu, 0.5 * pi), sphere, 5e-6);
    EXPECT_NEAR(2.0 * nonlocal::half_space_influence(nu, 0.5 * pi), half_space, 5e-6);
  }
  // Six equal forces, and two: approach per force.
  const auto compliance = [](double nu, double neighbours) {
    return sphere_self_influence(nu) + sphere_influence(nu, pi) + neighbours * sphere_influence(nu, 0.5 * pi);
  };
  EXPECT_NEAR(compliance(0.48, 4.0), 0.5577, 5e-5);
  EXPECT_NEAR(compliance(0.3, 4.0), 0.603, 5e-4);
  EXPECT_NEAR(compliance(0.48, 0.0), 0.152, 5e-4);
}

TEST(SphereInfluence, IsTheHalfSpacesCloseToTheForce) {
  for (const double nu : k_ratios) {
    // Both are -(1-nu^2)/(2 pi S), and differ by a logarithm.
    for (const double theta : {1e-3, 1e-2}) {
      const double leading = (1.0 - nu * nu) / (2.0 * pi * std::sin(0.5 * theta));
      EXPECT_NEAR(sphere_influence(nu, theta) / leading, -1.0, 3.0 * theta) << nu;
      EXPECT_NEAR(nonlocal::half_space_influence(nu, theta) / leading, -1.0, 3.0 * theta) << nu;
    }
  }
}

TEST(AngleBetween, IsExactBetweenNearlyParallelWalls) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  const Eigen::Vector3d axis = normal.cross(Eigen::Vector3d::UnitX()).normalized();
  for (const double angle : {1e-9, 1e-4, 1.0, 3.0, pi - 1e-9}) {
    const Eigen::Vector3d turned = Eigen::AngleAxisd(angle, axis) * normal;
    EXPECT_NEAR(angle_between(normal, turned), angle, 4 * k_epsilon);
  }
  EXPECT_EQ(angle_between(normal, -normal), pi);
}

// --- contact radius in the deformed configuration

}  // namespace
}  // namespace monograin::sphere_influence_test
