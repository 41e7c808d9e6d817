#include "mdr/transforms.hpp"

#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/special_functions/ellint_d.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "models/accuracy.hpp"

namespace monograin::mdr::transforms_test {
namespace {

using std::numbers::pi;

constexpr double k_round_off = 8 * k_epsilon;
constexpr double k_quadrature = 2e-14;  // rounding of a sum of some hundred values, and of their arguments

// --- powers

TEST(MdrTransforms, PowersHaveTheirPrintedRatios) {
  EXPECT_LE(relative_error(power_ratio(0.0), 1.0), k_round_off);
  EXPECT_LE(relative_error(power_ratio(1.0), 0.5 * pi), k_round_off);
  EXPECT_LE(relative_error(power_ratio(2.0), 2.0), k_round_off);
  EXPECT_LE(relative_error(power_ratio(3.0), 0.75 * pi), k_round_off);
  EXPECT_LE(relative_error(power_ratio(4.0), 8.0 / 3.0), k_round_off);
  EXPECT_LE(relative_error(power_ratio(6.0), 3.2), k_round_off);
  // kappa_n kappa_(n+1) = pi (n + 1)/2, where the gamma functions themselves overflow.
  EXPECT_LE(relative_error(power_ratio(400.0) * power_ratio(401.0), 200.5 * pi), 64 * k_epsilon);
}

TEST(MdrTransforms, PowersHaveNoImageBelowExponentZero) {
  EXPECT_THROW(static_cast<void>(power_ratio(-0.1)), std::domain_error);
  EXPECT_THROW(static_cast<void>(power_ratio(std::nan(""))), std::domain_error);
}

TEST(MdrTransforms, TakePowersToPowersInBothDirections) {
  constexpr double coefficient = 0.7;
  for (const double n : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0, 12.0}) {
    // The slope of an odd half power has a root at the axis, which the substitution leaves: 1.2e-12 for n = 1.5.
    const double of_slope = n == 1.5 ? 3e-12 : k_quadrature;
    for (const double at : {1e-6, 0.3, 1.0, 50.0}) {
      const auto slope = [n](double r) { return coefficient * n * std::pow(r, n - 1.0); };
      const auto image = [n](double x) { return power_profile_1d(coefficient, n, x); };
      EXPECT_LE(relative_error(profile_1d(slope, at), image(at)), of_slope) << "n = " << n << ", x = " << at;
      EXPECT_LE(relative_error(profile_3d(image, at), coefficient * std::pow(at, n)), k_quadrature)
          << "n = " << n << ", r = " << at;
      EXPECT_LE(relative_error(power_profile_3d(power_ratio(n), n, at), std::pow(at, n)), k_round_off)
          << "n = " << n << ", r = " << at;
    }
  }
}

// --- profiles

TEST(MdrTransforms, GiveTheProfileOfAnEllipse) {
  constexpr double height = 0.3, b = 1.2;
  const auto image = [](double x) { return 0.5 * height * (1.0 - std::sqrt((1.0 - x / b) * (1.0 + x / b))); };
  const auto profile = [](double r) { return 0.5 * height * (1.0 - 2.0 / pi * boost::math::ellint_2(r / b)); };
  // d/dk E = -k D
  const auto slope = [](double r) { return height / (pi * b) * r / b * boost::math::ellint_d(r / b); };
  for (const double share : {1e-3, 0.1, 0.5, 0.9, 0.99, 1.0}) {
    EXPECT_NEAR(profile_3d(image, share * b), profile(share * b), k_quadrature * height) << "r/b = " << share;
    // The slope has a logarithmic singularity at b; below it, it is ever less smooth.
    if (share < 1.0) {
      EXPECT_NEAR(profile_1d(slope, share * b), image(share * b), k_quadrature * height) << "x/b = " << share;
    }
  }
}

TEST(MdrTransforms, AreInverseToEachOther) {
  // A profile that is neither a power nor a conic.
  const auto profile = [](double r) { return 2.0 * std::sinh(0.5 * r) * std::sinh(0.5 * r); };
  const auto slope = [](double r) { return std::sinh(r); };
  const auto image = [&](double x) { return profile_1d(slope, x); };
  for (const double r : {0.01, 0.7, 2.0}) {
    EXPECT_LE(relative_error(profile_3d(image, r), profile(r)), k_quadrature) << "r = " << r;
  }
}

TEST(MdrTransforms, BearAKinkWithFewerDigits) {
  // A cone with a flat end: g1D(x) = x acos(c/x) for x > c.
  constexpr double c = 0.37;
  const auto slope = [](double r) { return r > c ? 1.0 : 0.0; };
  for (const double x : {0.1, 0.4, 1.0}) {
    EXPECT_NEAR(profile_1d(slope, x), x > c ? x * std::acos(c / x) : 0.0, 1e-6) << "x = " << x;
  }
}

TEST(MdrTransforms, PassNanOn) {
  EXPECT_TRUE(std::isnan(profile_1d([](double) { return std::nan(""); }, 1.0)));
  EXPECT_TRUE(std::isnan(profile_3d([](double) { return std::nan(""); }, 1.0)));
}

// --- pressures

/// A contact pressure with its line load, as functions of the radius and half the chord there.
struct Pressure {
  const char* name;
  double (*pressure)(double r, double half_chord);
  double (*line_load)(double x, double half_chord);
  double (*line_load_slope)(double x, double half_chord);
  double edge_line_load;
};

constexpr double k_a = 0.8;  // contact radius

double half_chord(double x) { return std::sqrt((k_a - x) * (k_a + x)); }

class MdrPressureTransform : public ::testing::TestWithParam<Pressure> {};

TEST_P(MdrPressureTransform, GoesBothWaysUpToTheEdge) {
  const auto& [name, pressure, line_load, line_load_slope, edge_line_load] = GetParam();
  for (const double share : {0.0, 1e-3, 0.3, 0.8, 0.99, 0.999999}) {
    const double at = share * k_a;
    const double load = line_load(at, half_chord(at));
    const double expected = pressure(at, half_chord(at));
    // The pressure of a cone is not bounded on the axis; its line load there has the integrand's logarithm.
    const bool is_bounded = std::isfinite(expected);
    EXPECT_LE(relative_error(line_load_1d(pressure, k_a, at), load), is_bounded ? 1e-13 : 1e-8) << "x/a = " << share;
    if (is_bounded) {
      EXPECT_LE(relative_error(pressure_3d(line_load_slope, edge_line_load, k_a, at), expected), 1e-13)
          << "r/a = " << share;
    }
  }
  EXPECT_EQ(line_load_1d(pressure, k_a, 1.01 * k_a), 0.0);
  EXPECT_EQ(pressure_3d(line_load_slope, edge_line_load, k_a, 1.01 * k_a), 0.0);
}

INSTANTIATE_TEST_SUITE_P(
    Mdr, MdrPressureTransform,
    ::testing::Values(Pressure{"Hertz", [](double, double c) { return c; },
                               [](double, double c) { return 0.5 * pi * c * c; },
                               [](double x, double) { return -pi * x; }, 0.0},
                      Pressure{"Uniform", [](double, double) { return 1.0; }, [](double, double c) { return 2.0 * c; },
                               [](double x, double c) { return -2.0 * x / c; }, 0.0},
                      Pressure{"FlatPunch", [](double, double c) { return 1.0 / c; }, [](double, double) { return pi; },
                               [](double, double) { return 0.0; }, pi},
                      Pressure{"Cone", [](double r, double c) { return std::asinh(c / r) / pi; },
                               [](double x, double) { return k_a - x; }, [](double, double) { return -1.0; }, 0.0},
                      // JKR: compressed in the middle, pulled at the edge.
                      Pressure{"PulledEdge", [](double, double c) { return c - 0.1 / c; },
                               [](double, double c) { return 0.5 * pi * c * c - 0.1 * pi; },
                               [](double x, double) { return -pi * x; }, -0.1 * pi}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(MdrTransforms, TakePressuresOfTheRadiusAlone) {
  // Bounded pressures lose no accuracy, an unbounded one loses the digits of the distance to the edge.
  const auto error = [](auto&& pressure, double expected) {
    return relative_error(line_load_1d(pressure, k_a, 0.3), expected);
  };
  const double c = half_chord(0.3);
  EXPECT_LE(error([](double r) { return half_chord(r); }, 0.5 * pi * c * c), 1e-13);
  EXPECT_LE(error([](double r) { return 1.0 / half_chord(r); }, pi), 1e-8);
  const auto slope = [](double x) { return -pi * x; };
  EXPECT_LE(relative_error(pressure_3d(slope, 0.0, k_a, 0.3), c), 1e-13);
}

// --- displacements

/// A displacement of the image with that of the surface.
struct Displacement {
  const char* name;
  double (*image)(double x);
  double (*surface)(double r);
};

class MdrDisplacementTransform : public ::testing::TestWithParam<Displacement> {};

TEST_P(MdrDisplacementTransform, GivesTheSurfaceInsideAndOutside) {
  const auto& [name, image, surface] = GetParam();
  for (const double share : {0.0, 0.5, 0.999, 1.0, 1.0 + 1e-9, 1.001, 1.1, 2.0, 100.0}) {
    const double r = share * k_a;
    EXPECT_LE(relative_error(displacement_3d(image, k_a, r), surface(r)), 1e-13) << "r/a = " << share;
  }
}

// R = 1; far outside the closed forms cancel, and series replace them.
double hertz_surface(double r) {
  if (r <= k_a) return k_a * k_a - 0.5 * r * r;
  const double s = k_a / r;
  if (s < 0.1) return 2.0 / pi * k_a * k_a * s * (2.0 / 3.0 + s * s / 15.0 + 3.0 * s * s * s * s / 140.0);
  const double chord = std::sqrt((r - k_a) * (r + k_a));
  return ((2.0 * k_a * k_a - r * r) * std::atan2(k_a, chord) + k_a * chord) / pi;
}

// int_0^a sqrt(a^2 - x^2)/sqrt(r^2 - x^2) dx
double uniform_surface(double r) {
  if (r <= k_a) return 2.0 / pi * k_a * boost::math::ellint_2(r / k_a);
  const double k = k_a / r;
  // E - (1 - k^2) K = k^2 (K - D)
  return 2.0 / pi * r * k * k * (boost::math::ellint_1(k) - boost::math::ellint_d(k));
}

INSTANTIATE_TEST_SUITE_P(Mdr, MdrDisplacementTransform,
                         ::testing::Values(Displacement{"Hertz", [](double x) { return (k_a - x) * (k_a + x); },
                                                        hertz_surface},
                                           Displacement{"FlatPunch", [](double) { return 1.0; },
                                                        [](double r) {
                                                          const double chord =
                                                              r > k_a ? std::sqrt((r - k_a) * (r + k_a)) : 0.0;
                                                          return 2.0 / pi * std::atan2(k_a, chord);
                                                        }},
                                           Displacement{"UniformPressure", half_chord, uniform_surface}),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(MdrTransforms, GiveTheImageOfASurfaceDisplacement) {
  constexpr double delta = 0.5, radius = 1.3;
  for (const double x : {0.0, 0.2, 0.8}) {
    EXPECT_LE(relative_error(displacement_1d(
                                 delta, [](double r) { return -r / radius; }, x),
                             delta - x * x / radius),
              k_quadrature)
        << "x = " << x;
  }
}

}  // namespace
}  // namespace monograin::mdr::transforms_test
