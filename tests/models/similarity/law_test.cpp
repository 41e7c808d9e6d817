#include "similarity/law.hpp"

#include <array>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "models/accuracy.hpp"
#include "models/plastic/cases.hpp"
#include "system/number_text.hpp"
#include "system/resolution.hpp"

namespace monograin::similarity::law_test {
namespace {

using namespace plastic;

using std::numbers::pi;

constexpr std::array k_radii{RadiusRule::parabolic, RadiusRule::corrected};
constexpr std::array k_exponents{0.0, 1e-9, 0.24, 0.6585, 1.0};

// --- curves

class SimilarityCurve : public ::testing::TestWithParam<const char*> {};

TEST_P(SimilarityCurve, AgreesWithFiftyDigits) {
  const Table table = reference("similarity", std::string("similarity_mu") + GetParam());
  ASSERT_GT(table.row_count(), 60u);
  const double exponent = header_number(table, "inv_m");
  const Law parabolic = make_law(exponent);
  const Law corrected = make_law(exponent, RadiusRule::corrected);
  const auto expect = [](std::string_view what, double actual, double expected) {
    EXPECT_LE(relative_error(actual, expected), 2e-15)  // largest error found: 7.6e-16, P
        << what << ": " << actual << " instead of " << expected;
  };
  expect("k", parabolic.pressure_constant, header_number(table, "k"));
  expect("c2", parabolic.area_constant, header_number(table, "c2"));
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const double x = number(table, row, "gamma_over_2R");
    const ContactState state = state_at(parabolic, x);
    EXPECT_EQ(state.regime, Regime::fully_plastic);
    expect("a_over_R", state.contact_radius, number(table, row, "a_over_R"));
    expect("Hbar", state.pressure, number(table, row, "Hbar"));
    expect("P_over_kappaR2", state.force, number(table, row, "P_over_kappaR2"));
    const ContactState with_curvature = state_at(corrected, x);
    expect("a_cc_over_R", with_curvature.contact_radius, number(table, row, "a_cc_over_R"));
    expect("P_cc_over_kappaR2", with_curvature.force, number(table, row, "P_cc_over_kappaR2"));
  }
}

INSTANTIATE_TEST_SUITE_P(Similarity, SimilarityCurve, ::testing::Values("0", "0p24", "0p6585", "1"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST(SimilarityPairs, AgreeWithFiftyDigits) {
  const Table table = reference("similarity", "similarity_unequal");
  ASSERT_EQ(table.row_count(), 30u);
  const double exponent = header_number(table, "inv_m");
  const Pair pair = pair_of(header_number(table, "R1"), header_number(table, "R2"));
  const double strength = pair_strength(header_number(table, "kappa1"), header_number(table, "kappa2"), exponent);
  const Law parabolic = make_law(exponent);
  const Law corrected = make_law(exponent, RadiusRule::corrected);
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const double approach = number(table, row, "gamma");
    const auto expect = [&](std::string_view column, double actual) {
      const double expected = number(table, row, column);
      EXPECT_LE(relative_error(actual, expected), 2e-15)  // largest error found: 7.6e-16, P
          << column << " at gamma = " << approach << ": " << actual << " instead of " << expected;
    };
    const PairContact plain = pair_contact(parabolic, pair, strength, approach);
    expect("a", plain.contact_radius);
    expect("P", plain.force);
    const PairContact with_curvature = pair_contact(corrected, pair, strength, approach);
    expect("a_cc", with_curvature.contact_radius);
    expect("P_cc", with_curvature.force);
  }
}

// --- pairs

TEST(SimilarityPairs, WithARigidWallAreHalvesOfSymmetricPairs) {
  // The wall moves by half of the pair's approach; it is flat, and not strained.
  const Pair wall = pair_of(1.0, k_infinity);
  const Pair spheres = pair_of(1.0, 1.0);
  for (const RadiusRule radius : k_radii) {
    for (const double exponent : k_exponents) {
      const Law law = make_law(exponent, radius);
      for (const double x : {1e-9, 1e-3, 0.03, 0.4}) {
        const auto with_wall = pair_contact(law, wall, pair_strength(7.0, k_infinity, exponent), x);
        const auto of_pair = pair_contact(law, spheres, pair_strength(7.0, 7.0, exponent), 2.0 * x);
        const ContactState state = state_at(law, x);
        EXPECT_LE(relative_error(with_wall.contact_radius, of_pair.contact_radius), 4 * k_epsilon);
        EXPECT_LE(relative_error(with_wall.force, of_pair.force), 8 * k_epsilon);
        EXPECT_LE(relative_error(with_wall.force_by_approach, 2.0 * of_pair.force_by_approach), 8 * k_epsilon);
        EXPECT_LE(relative_error(7.0 * state.force, of_pair.force), 8 * k_epsilon);
        EXPECT_LE(relative_error(state.pressure, state.force / (pi * state.contact_radius * state.contact_radius)),
                  8 * k_epsilon);
      }
    }
  }
}

TEST(SimilarityPairs, KeepTheirUnitsAndTheirOrder) {
  const double exponent = 0.3;
  for (const RadiusRule radius : k_radii) {
    const Law law = make_law(exponent, radius);
    const Pair metres = pair_of(0.01, 0.006);
    const Pair millimetres = pair_of(6.0, 10.0);
    const auto coarse = pair_contact(law, metres, pair_strength(2e7, 3.5e7, exponent), 1e-4);
    const auto fine = pair_contact(law, millimetres, pair_strength(35.0, 20.0, exponent), 0.1);
    EXPECT_LE(relative_error(1e3 * coarse.contact_radius, fine.contact_radius), 8 * k_epsilon);
    EXPECT_LE(relative_error(coarse.force, fine.force), 16 * k_epsilon);
  }
}

TEST(SimilarityPairs, RefuseRadiiThatAreNone) {
  struct Bad {
    double first, second;
  };
  for (const auto& [first, second] :
       {Bad{0.0, 1.0}, Bad{1.0, -2.0}, Bad{k_nan, 1.0}, Bad{1.0, k_nan}, Bad{k_infinity, k_infinity}}) {
    const std::string message = refusal<std::invalid_argument>([a = first, b = second] { return pair_of(a, b); });
    EXPECT_TRUE(contains(message, number_text(first))) << message;
    EXPECT_TRUE(contains(message, number_text(second))) << message;
  }
}

// --- strength of two materials

TEST(SimilarityStrength, IsThePowerMeanOfTheTwo) {
  std::mt19937_64 generator{20240613};
  for (int i = 0; i < 1000; ++i) {
    const double exponent = uniform(generator, 0.05, 1.0);
    const double first = log_uniform(generator, 1.0, 100.0);
    const double second = log_uniform(generator, 1.0, 100.0);
    const long double m = 1.0L / static_cast<long double>(exponent);
    const auto power = [&](double strength) { return std::pow(static_cast<long double>(strength), -m); };
    const auto expected =
        static_cast<double>(std::pow(power(first) + power(second), -static_cast<long double>(exponent)));
    EXPECT_LE(relative_error(pair_strength(first, second, exponent), expected), 1e-15)  // found: 2.2e-16
        << first << ", " << second << ", 1/m = " << exponent;
    EXPECT_EQ(pair_strength(first, second, exponent), pair_strength(second, first, exponent));
  }
}

TEST(SimilarityStrength, BecomesThatOfTheWeakerWithoutHardening) {
  EXPECT_EQ(pair_strength(20.0, 35.0, 0.0), 20.0);
  EXPECT_EQ(pair_strength(20.0, 20.0, 0.0), 20.0);
  for (const double exponent : {1e-320, 1e-30, 1e-3}) {
    EXPECT_EQ(pair_strength(20.0, 35.0, exponent), 20.0) << "1/m = " << exponent;
    EXPECT_LE(relative_error(pair_strength(20.0, 20.0, exponent), 20.0 * std::exp2(-exponent)), 4 * k_epsilon);
  }
  for (const double exponent : k_exponents) {
    EXPECT_EQ(pair_strength(20.0, k_infinity, exponent), 20.0);
    EXPECT_LE(relative_error(pair_strength(1e-300, 1e300, exponent), 1e-300), 4 * k_epsilon);
  }
}

TEST(SimilarityStrength, RefusesStrengthsThatAreNone) {
  for (const double strength : {0.0, -2.5, k_nan}) {
    const std::string message = refusal<std::invalid_argument>([&] { return pair_strength(20.0, strength, 0.3); });
    EXPECT_TRUE(contains(message, number_text(strength)) && contains(message, "20")) << message;
  }
  EXPECT_TRUE(
      contains(refusal<std::invalid_argument>([] { return pair_strength(k_infinity, k_infinity, 0.3); }), "inf"));
}

// --- contact radius

TEST(SimilarityRadius, SolvesItsQuarticAtAnyApproach) {
  for (const double exponent : k_exponents) {
    const Law law = make_law(exponent, RadiusRule::corrected);
    const Pair pair = pair_of(3.0, 0.5);
    for (double approach = 1e-300; approach < 1e3; approach *= 1e7) {
      const double a = pair_contact(law, pair, 1.0, approach).contact_radius;
      const double again = a * a * (pair.curvature / 2.0 + pair.cubed_curvature * a * a / 8.0) / law.area_constant;
      EXPECT_LE(relative_error(again, approach), 4 * k_epsilon) << "1/m = " << exponent << ", gamma = " << approach;
    }
  }
}

TEST(SimilarityRadius, HasThePrintedSeriesForSmallContacts) {
  for (const double exponent : k_exponents) {
    const Law law = make_law(exponent, RadiusRule::corrected);
    const double c = std::sqrt(law.area_constant);
    const Pair pair = pair_of(3.0, 0.5);
    const auto& [curvature, cubed] = pair;
    for (const double approach : {1e-4, 1e-3, 1e-2}) {
      // In y = c^2 gamma B/A^2 the terms are 1 - y/4 + 7 y^2/32 - 33 y^3/128 + ... of the first.
      const double y = law.area_constant * approach * cubed / (curvature * curvature);
      const double first = std::sqrt(2.0) * c * std::sqrt(approach / curvature);
      const double second =
          -c * c * c * cubed / std::pow(2.0, 1.5) * std::pow(curvature, -2.5) * std::pow(approach, 1.5);
      const double third = 7.0 * std::pow(c, 5) * cubed * cubed / std::pow(2.0, 4.5) * std::pow(curvature, -4.5) *
                           std::pow(approach, 2.5);
      const double rest = pair_contact(law, pair, 1.0, approach).contact_radius - (first + second + third);
      EXPECT_NEAR(rest / first, -33.0 / 128.0 * y * y * y, 0.4 * y * y * y * y + 4 * k_epsilon) << "1/m = " << exponent;
    }
  }
}

TEST(SimilarityRadius, IsThePrintedOneWithoutHardening) {
  EXPECT_NEAR(state_at(make_law(0.0), 0.01).contact_radius, 0.169115, 5e-7);
}

// --- derivatives, force, work

TEST(SimilarityDerivatives, AgreeWithDifferences) {
  for (const RadiusRule radius : k_radii) {
    for (const double exponent : k_exponents) {
      const Law law = make_law(exponent, radius);
      for (const double x : {1e-8, 1e-3, 0.03, 0.3, 0.9}) {
        const ContactState state = state_at(law, x);
        const auto error = [&](auto member, double derivative) {
          const auto f = [&](double at) { return state_at(law, at).*member; };
          return scaled_error(central_difference(f, x, 3e-3 * x), derivative, state.*member / x);
        };
        constexpr double tolerance = 5e-13;  // largest error found: 1.1e-13
        EXPECT_LE(error(&ContactState::contact_radius, state.contact_radius_by_approach), tolerance) << "x = " << x;
        EXPECT_LE(error(&ContactState::pressure, state.pressure_by_approach), tolerance) << "x = " << x;
        EXPECT_LE(error(&ContactState::force, state.force_by_approach), tolerance) << "x = " << x;
      }
    }
  }
}

TEST(SimilarityForce, RisesAndIsFiniteEverywhere) {
  std::mt19937_64 generator{20240614};
  for (int i = 0; i < 10000; ++i) {
    const double exponent = uniform(generator, 0.0, 1.0);
    for (const RadiusRule radius : k_radii) {
      const Law law = make_law(exponent, radius);
      const double x = i % 2 == 0 ? uniform(generator, 0.0, 1.0) : log_uniform(generator, 1e-100, 1.0);
      const ContactState state = state_at(law, x);
      ASSERT_TRUE(std::isfinite(state.force_by_approach)) << "1/m = " << exponent << ", x = " << x;
      ASSERT_GT(state.force_by_approach, 0.0) << "1/m = " << exponent << ", x = " << x;
      ASSERT_GT(state.contact_radius_by_approach, 0.0) << "1/m = " << exponent << ", x = " << x;
      ASSERT_GE(state.pressure_by_approach, 0.0) << "1/m = " << exponent << ", x = " << x;
    }
  }
}

TEST(SimilarityForce, IsLinearAndItsPressureConstantWithoutHardening) {
  const Law law = make_law(0.0);
  for (const double x : {1e-12, 1e-4, 0.1}) {
    EXPECT_EQ(state_at(law, x).pressure, 3.0);
    EXPECT_EQ(state_at(law, x).pressure_by_approach, 0.0);
    EXPECT_LE(relative_error(state_at(law, x).force, 3.0 * pi * 2.86 * x), 4 * k_epsilon) << "x = " << x;
  }
}

TEST(SimilarityForce, IsAPowerOfTheApproach) {
  for (const double exponent : k_exponents) {
    const Law law = make_law(exponent);
    for (const double x : {1e-12, 1e-4, 0.1}) {
      const ContactState state = state_at(law, x);
      EXPECT_LE(relative_error(x * state.force_by_approach, (1.0 + 0.5 * exponent) * state.force), 8 * k_epsilon);
      // At this x the fourth power in the corrected radius has little effect.
      const double corrected = state_at(make_law(exponent, RadiusRule::corrected), x).force;
      EXPECT_LE(relative_error(corrected, state.force), 1.5 * 1.43 * x + 1e-15) << "1/m = " << exponent;
      EXPECT_LT(corrected, state.force) << "1/m = " << exponent;
    }
  }
}

TEST(SimilarityInverse, FindsTheApproachAgain) {
  std::mt19937_64 generator{20240615};
  for (int i = 0; i < 10000; ++i) {
    const double exponent = uniform(generator, 0.0, 1.0);
    for (const RadiusRule radius : k_radii) {
      const Law law = make_law(exponent, radius);
      const double x = i % 2 == 0 ? uniform(generator, 0.0, 1.0) : log_uniform(generator, 1e-200, 1.0);
      // The exponent of the force's power is rounded, which counts times the logarithm.
      ASSERT_LE(relative_error(approach_under(law, state_at(law, x).force), x), (8.0 - std::log(x)) * k_epsilon)
          << "1/m = " << exponent << ", x = " << x;
    }
  }
}

TEST(SimilarityInverse, RefusesForcesBeyondTheLimit) {
  for (const RadiusRule radius : k_radii) {
    for (const double exponent : k_exponents) {
      const Law law = make_law(exponent, radius);
      EXPECT_EQ(approach_under(law, 0.0), 0.0);
      EXPECT_EQ(approach_under(law, -1.0), 0.0);
      EXPECT_GE(approach_under(law, std::numeric_limits<double>::denorm_min()), 0.0);
      const double greatest = state_at(law, std::nextafter(1.0, 0.0)).force;
      EXPECT_GT(approach_under(law, greatest * (1.0 - 1e-12)), 1.0 - 1e-11);
      for (const double force : {greatest * (1.0 + 1e-12), 2.0 * greatest, k_infinity}) {
        const std::string message = refusal<std::domain_error>([&] { return approach_under(law, force); });
        EXPECT_TRUE(contains(message, number_text(force))) << message;
      }
      EXPECT_THROW(static_cast<void>(approach_under(law, k_nan)), std::domain_error);
    }
  }
}

TEST(SimilarityWork, AgreesWithAdaptiveQuadrature) {
  boost::math::quadrature::tanh_sinh<double> quadrature;
  for (const RadiusRule radius : k_radii) {
    for (const double exponent : k_exponents) {
      const Law law = make_law(exponent, radius);
      for (const double x : {1e-6, 0.03, 0.9}) {
        const double expected = quadrature.integrate([&](double at) { return state_at(law, at).force; }, 0.0, x, 1e-15);
        EXPECT_LE(relative_error(work_per_wall(law, x), expected), 5e-15)  // largest error found: 1.6e-15
            << "1/m = " << exponent << ", x = " << x;
      }
      const Pair pair = pair_of(3.0, 0.5);
      const double of_pair =
          quadrature.integrate([&](double at) { return pair_contact(law, pair, 7.0, at).force; }, 0.0, 0.2, 1e-15);
      EXPECT_LE(relative_error(pair_work(law, pair, 7.0, 0.2), of_pair), 5e-15) << "1/m = " << exponent;
    }
  }
}

TEST(SimilarityWork, IsThatOfAPowerLaw) {
  for (const double exponent : k_exponents) {
    const Law law = make_law(exponent);
    const double x = 0.02;
    EXPECT_LE(relative_error(work_per_wall(law, x), state_at(law, x).force * x / (2.0 + 0.5 * exponent)),
              8 * k_epsilon);
    EXPECT_EQ(work_per_wall(law, 0.0), 0.0);
    EXPECT_EQ(work_per_wall(law, -0.1), 0.0);
  }
}

// --- domain

TEST(SimilarityDomain, HasNoForceWithoutContact) {
  for (const RadiusRule radius : k_radii) {
    const Law law = make_law(0.3, radius);
    for (const double x : {0.0, -1e-9, -2.0, -k_infinity}) {
      const ContactState state = state_at(law, x);
      EXPECT_EQ(state.regime, Regime::open) << "x = " << x;
      EXPECT_EQ(state.force, 0.0) << "x = " << x;
      EXPECT_EQ(state.contact_radius, 0.0) << "x = " << x;
      EXPECT_EQ(pair_contact(law, {2.0, 2.0}, 1.0, x).force, 0.0) << "x = " << x;
    }
  }
}

TEST(SimilarityDomain, EndsWhereTheWallsMeet) {
  const Law law = make_law(0.3);
  EXPECT_NO_THROW(static_cast<void>(state_at(law, std::nextafter(1.0, 0.0))));
  for (const double x : {1.0, 1.25, k_infinity, k_nan}) {
    EXPECT_TRUE(contains(refusal<std::domain_error>([&] { return state_at(law, x); }), number_text(x))) << x;
    EXPECT_TRUE(contains(refusal<std::domain_error>([&] { return work_per_wall(law, x); }), number_text(x))) << x;
  }
}

TEST(SimilarityDomain, RefusesExponentsThatAreNone) {
  for (const double exponent : {-0.1, 1.0 + k_epsilon, 4.0, k_infinity, k_nan}) {
    EXPECT_TRUE(contains(refusal<std::invalid_argument>([&] { return make_law(exponent); }), number_text(exponent)));
    EXPECT_TRUE(contains(refusal<std::invalid_argument>([&] { return pair_strength(1.0, 2.0, exponent); }),
                         number_text(exponent)));
  }
}

}  // namespace
}  // namespace monograin::similarity::law_test
