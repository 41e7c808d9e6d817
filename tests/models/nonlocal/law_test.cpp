#include "nonlocal/law.hpp"

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "elastic/hertz.hpp"
#include "models/accuracy.hpp"
#include "models/nonlocal/cases.hpp"

namespace monograin::nonlocal::nonlocal_law_test {
namespace {

constexpr std::array k_squares{1e-14, 1e-9, 1e-4, 0.01, 0.0999, 0.1001, 0.25, 0.6, 0.95};

std::string name_of(Terms terms) { return terms == Terms::all ? "all" : std::to_string(static_cast<int>(terms)); }

class NonlocalLaw : public ::testing::TestWithParam<Terms> {
 protected:
  LocalLaw law{GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Terms, NonlocalLaw, ::testing::ValuesIn(k_all_terms),
                         [](const auto& instance) { return name_of(instance.param); });

TEST(NonlocalLawReference, AgreesWithThirtyDigits) {
  const Table table = reference("local_law");
  ASSERT_EQ(table.row_count(), 31u);
  for (int terms = 1; terms <= 4; ++terms) {
    const LocalLaw law(static_cast<Terms>(terms));
    const std::string suffix = "_terms" + std::to_string(terms);
    const auto approach = table.column("g_over_R");
    const auto radius = table.column("a_over_R" + suffix);
    const auto force = table.column("P_over_EstarR2" + suffix);
    for (std::size_t row = 0; row < table.row_count(); ++row) {
      const LocalContact contact = law.at(law.signed_square(approach[row]));
      const auto inputs = ::testing::Message() << terms << " terms, g/R = " << approach[row];
      // Largest errors found: 2.1e-16, 5.2e-16, 2.8e-16.
      EXPECT_LE(relative_error(contact.contact_radius, radius[row]), 2e-15) << inputs;
      EXPECT_LE(relative_error(contact.force, force[row]), 2e-15) << inputs;
      EXPECT_LE(relative_error(contact.approach, approach[row]), 2e-15) << inputs;
    }
  }
}

TEST_P(NonlocalLaw, HasTheStiffnessOfAFlatPunch) {
  for (const double s : k_squares) {
    const LocalContact contact = law.at(s);
    // A step that keeps the truncation error below 1e-14; the differences lose s/step of the digits.
    const double step = 4e-3 * std::min(s, 1.0 - s);
    const double tolerance = 16 * k_epsilon * s / step;
    const double force_slope = central_difference([&](double x) { return law.at(x).force; }, s, step);
    const double approach_slope = central_difference([&](double x) { return law.at(x).approach; }, s, step);
    EXPECT_LE(relative_error(contact.approach_slope, approach_slope), tolerance) << "s = " << s;
    EXPECT_LE(relative_error(2.0 * contact.contact_radius * contact.approach_slope, force_slope), tolerance)
        << "s = " << s;
  }
}

TEST_P(NonlocalLaw, IsInvertedByApproachAndForce) {
  for (const double s : k_squares) {
    const LocalContact contact = law.at(s);
    // Round-off of g and F, and of the inverse.
    EXPECT_LE(relative_error(law.signed_square(contact.approach), s), 8 * k_epsilon) << "s = " << s;
    EXPECT_LE(relative_error(law.signed_square_under(contact.force), s), 8 * k_epsilon) << "s = " << s;
  }
  EXPECT_EQ(law.signed_square(-0.3), -0.3);
  EXPECT_EQ(law.signed_square(0.0), 0.0);
  EXPECT_EQ(law.signed_square_under(0.0), 0.0);
}

TEST_P(NonlocalLaw, IsAGapBelowFirstTouch) {
  for (const double s : {-1e-12, -0.1, -2.0}) {
    const LocalContact contact = law.at(s);
    EXPECT_EQ(contact.approach, s);
    EXPECT_EQ(contact.approach_slope, 1.0);
    EXPECT_EQ(contact.force, 0.0);
    EXPECT_EQ(contact.contact_radius, 0.0);
    EXPECT_EQ(law.energy(s), 0.0);
    EXPECT_EQ(law.pressure(s, 0.0), 0.0);
  }
  EXPECT_LE(std::abs(law.at(1e-300).approach_slope - 1.0), k_epsilon);  // no jump at first touch
}

TEST_P(NonlocalLaw, IsHertzsForSmallContacts) {
  for (const double approach : {1e-14, 1e-12, 1e-9}) {
    const LocalContact contact = law.at(law.signed_square(approach));
    // The second term changes the force by 1/10 of the approach over R.
    EXPECT_LE(relative_error(contact.force, hertz_force(1.0, 1.0, approach)), approach + 8 * k_epsilon);
    EXPECT_LE(relative_error(contact.contact_radius, hertz_contact_radius(1.0, approach)), approach + 8 * k_epsilon);
  }
}

TEST(NonlocalLawOfOneTerm, IsHertzs) {
  const LocalLaw law(Terms::one);
  for (const double approach : {1e-12, 0.01, 0.7}) {
    const double s = law.signed_square(approach);
    EXPECT_LE(relative_error(law.at(s).force, hertz_force(1.0, 1.0, approach)), 4 * k_epsilon);
    EXPECT_LE(relative_error(law.energy(s), hertz_energy(1.0, 1.0, approach)), 4 * k_epsilon);
  }
}

TEST_P(NonlocalLaw, StoresTheWorkOfItsForce) {
  boost::math::quadrature::tanh_sinh<double> integrator;
  for (const double s : k_squares) {
    const double work = integrator.integrate(
        [&](double x) {
          const LocalContact contact = law.at(x);
          return contact.force * contact.approach_slope;
        },
        0.0, s);
    EXPECT_LE(relative_error(law.energy(s), work), 1e-14) << "s = " << s;  // largest error found: 7.5e-16
  }
}

TEST_P(NonlocalLaw, CarriesItsForceByItsPressure) {
  for (const double s : k_squares) {
    // In v^2 = 1 - r^2/a^2, the pressure over v is smooth.
    const double force = 2.0 * std::numbers::pi * s *
                         boost::math::quadrature::gauss<double, 60>::integrate(
                             [&](double v) { return v * law.pressure(s, s * (1.0 - v * v)); }, 0.0, 1.0);
    EXPECT_LE(relative_error(law.at(s).force, force), 1e-13) << "s = " << s;
  }
  EXPECT_EQ(law.pressure(0.25, 0.25), 0.0);
  EXPECT_EQ(law.pressure(0.25, 0.3), 0.0);
}

TEST(NonlocalLawOfFourTerms, HasThePrintedPressure) {
  const LocalLaw law(Terms::four);
  for (const double s : {1e-6, 0.1, 0.7}) {
    for (const double x : {0.0, 0.2, 0.5, 0.99}) {
      const double polynomial =
          1.0 + s * (2.0 / 9.0 * (1.0 + 2.0 * x) + s * ((3.0 + x * (4.0 + 8.0 * x)) / 25.0 +
                                                        s * 4.0 / 245.0 * (5.0 + x * (6.0 + x * (8.0 + 16.0 * x)))));
      const double expected = 2.0 * std::sqrt(s * (1.0 - x)) / std::numbers::pi * polynomial;  // eq. 32
      EXPECT_LE(relative_error(law.pressure(s, s * x), expected), 1e-14) << "s = " << s << ", x = " << x;
    }
  }
}

TEST(NonlocalLawOfAllTerms, HasTheClosedForm) {
  // In this range the closed form in extended precision keeps its digits: it loses 0.75/s.
  const LocalLaw law(Terms::all);
  for (const double s : {1e-3, 0.05, 0.0999, 0.1001, 0.5, 0.999}) {
    const long double square = s;
    const long double a = std::sqrt(square);
    const auto force = static_cast<double>((1.0L + square) * std::atanh(a) - a);
    EXPECT_LE(relative_error(law.at(s).force, force), 4e-15) << "s = " << s;  // largest error found: 5.4e-16
    EXPECT_LE(relative_error(law.at(s).approach, static_cast<double>(a * std::atanh(a))), 4e-15) << "s = " << s;
  }
}

TEST(NonlocalLawOfAllTerms, IsWhatFewerTermsTendTo) {
  // The first omitted term is of order a^(2 terms): 1/(2n-1) a^(2n) in g, over a sum of at least a^2.
  const LocalLaw law(Terms::all);
  for (const double s : {1e-2, 0.1, 0.3}) {
    for (int terms = 1; terms <= 4; ++terms) {
      const LocalContact few = LocalLaw(static_cast<Terms>(terms)).at(s);
      const double missing = std::pow(s, terms) / (2.0 * terms + 1.0);
      const double ratio = (law.at(s).approach - few.approach) / (s * missing);
      EXPECT_GT(ratio, 0.99) << terms << " terms, s = " << s;
      EXPECT_LT(ratio, 1.0 / (1.0 - s) + 0.01) << terms << " terms, s = " << s;
    }
  }
}

TEST(NonlocalLawOfAllTerms, EndsWhereTheContactIsAsWideAsTheSphere) {
  const LocalLaw law(Terms::all);
  EXPECT_EQ(law.end(), 1.0);
  for (const double s : {1.0, 2.25, std::numeric_limits<double>::quiet_NaN()}) {
    for (const std::string& message : {refusal<std::domain_error>([&] { return law.at(s); }),
                                       refusal<std::domain_error>([&] { return law.energy(s); }),
                                       refusal<std::domain_error>([&] { return law.pressure(s, 0.0); })}) {
      EXPECT_TRUE(contains(message, std::isnan(s) ? "nan"
                                    : s == 1.0    ? "radius/R0 = 1)"
                                                  : "radius/R0 = 1.5)"))
          << message;
    }
  }
  EXPECT_NO_THROW(static_cast<void>(law.signed_square(15.0)));
  EXPECT_THROW(static_cast<void>(law.signed_square(40.0)), std::domain_error);
  EXPECT_THROW(static_cast<void>(law.signed_square_under(80.0)), std::domain_error);
}

TEST_P(NonlocalLaw, RefusesForcesThatPull) {
  for (const double force : {-1e-3, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_TRUE(contains(refusal<std::domain_error>([&] { return law.signed_square_under(force); }),
                         std::isnan(force) ? "nan" : "-0.001"));
  }
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_law_test
