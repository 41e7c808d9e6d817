#include "semimech/lateral.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "models/accuracy.hpp"
#include "models/semimech/steels.hpp"

namespace monograin::semimech::lateral_test {
namespace {

using namespace plastic;

/// State of a lateral contact at x > 0. A boundary belongs to the regime before it, except the onset.
ContactState lateral_state_at(const Law& law, const LateralLaw& lateral, double x) {
  Regime regime = Regime::elastic;
  for (const Boundary& end : boundaries(law, lateral)) {
    if (x > end.approach || (x == end.approach && end.event == "secondary-onset")) regime = end.beyond;
  }
  return lateral_state_in(law, lateral, regime, x);
}

class SemimechLateral : public ::testing::TestWithParam<const char*> {};

TEST_P(SemimechLateral, AgreesWithFiftyDigits) {
  const Table table = reference("semimech", std::string("secondary_die_") + GetParam());
  const Steel steel{header_number(table, "E"), header_number(table, "nu"), header_number(table, "sigma_y")};
  const Law law = steel.law(Configuration::die);
  const LateralLaw lateral = make_lateral(law);
  constexpr double tolerance = 1e-13;
  EXPECT_LE(relative_error(lateral.exponent, header_number(table, "omega")), tolerance);
  EXPECT_LE(relative_error(std::exp(lateral.log_coefficient), header_number(table, "tau_hat")), tolerance);
  EXPECT_NEAR(lateral.onset, header_number(table, "x_onset"), 8.3e-5);
  int small = 0, large = 0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const double x = number(table, row, "gamma_over_2R");
    const auto expect = [&](std::string_view column, double actual) {
      const double expected = number(table, row, column);
      EXPECT_LE(relative_error(actual, expected), tolerance)  // largest error found: 1.9e-15 (1.0e-14 for P)
          << column << " at x = " << x << ": " << actual << " instead of " << expected;
    };
    const ContactState state = lateral_state_at(law, lateral, x);
    if (x <= LateralLaw::small_range_end) {
      ++small;
      const auto [own, slope] = lateral_approach(lateral, x);
      expect("gamma_s_over_2R", own);
      expect("dxs_dx", slope);
      expect("a_s_over_R", state.contact_radius);
      expect("Hbar_s", state.pressure);
      expect("P_s_over_sigma_yR2", state.force);
      expect("dP_s_dx", state.force_by_approach);
      if (relative_error(x, lateral.yield_approach) > 1e-14) {
        EXPECT_EQ(name(state.regime), word(table, row, "regime")) << "x = " << x;
      }
    } else if (x >= lateral.onset) {
      ++large;
      expect("Hbar_s", state.pressure);
      EXPECT_TRUE(std::isnan(state.force)) << "x = " << x;
      EXPECT_TRUE(std::isnan(state.contact_radius)) << "x = " << x;
    }
  }
  EXPECT_GE(small, 20);
  EXPECT_GE(large, 15);
}

INSTANTIATE_TEST_SUITE_P(Semimech, SemimechLateral, ::testing::Values("01", "09", "17"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST(SemimechLateralOnset, MeetsThePrintedTable) {
  const Table table = reference("semimech", "table_2_4");
  ASSERT_EQ(table.row_count(), 5u);
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const double lambda = number(table, row, "lambda");
    EXPECT_EQ(lateral_onset(lambda), number(table, row, "x_onset"));
    // Printed to 4 digits; the curve through them is off by 8.3e-5 at most.
    EXPECT_NEAR(lateral_onset(lambda * 1.002), number(table, row, "x_onset"), 1e-4);
  }
}

TEST(SemimechLateralOnset, StaysInTheRangeOfTheTable) {
  EXPECT_EQ(lateral_onset(22.1), lateral_onset(160.0));
  EXPECT_EQ(lateral_onset(1e8), lateral_onset(5000.0));
  EXPECT_GT(lateral_onset(163.08), lateral_onset(164.0));
}

TEST(SemimechLateralContacts, AreUndefinedBetweenTheirTwoRanges) {
  const Law law = Steel{200e9, 0.3, 200e6}.law(Configuration::die);
  const LateralLaw lateral = make_lateral(law);
  for (const double x : {std::nextafter(0.1, 1.0), 0.25, std::nextafter(lateral.onset, 0.0)}) {
    const ContactState state = lateral_state_at(law, lateral, x);
    EXPECT_EQ(state.regime, Regime::undefined) << "x = " << x;
    EXPECT_TRUE(std::isnan(state.pressure) && std::isnan(state.force) && std::isnan(state.contact_radius)) << x;
  }
  EXPECT_EQ(lateral_state_at(law, lateral, 0.1).regime, Regime::elastic_plastic);
  EXPECT_EQ(lateral_state_at(law, lateral, lateral.onset).regime, Regime::low_compressibility);
  EXPECT_EQ(lateral_state_at(law, lateral, law.stiffening.zero_porosity + 0.001).regime, Regime::elastic_volumetric);
}

TEST(SemimechLateralContacts, YieldWhereTheirOwnApproachReachesTheYieldPoint) {
  // Printed to 3 digits: 0.0260 and 0.0216 at the ends of the fitted range.
  const auto yield = [](double lambda) {
    return make_lateral(make_law({lambda, 0.5 * lambda}, Configuration::die)).yield_approach;
  };
  EXPECT_NEAR(yield(163.08), 0.0260, 5e-5);
  EXPECT_NEAR(yield(4953.6), 0.0216, 5e-5);
  for (const Steel& steel : steels_of_the_source()) {
    const Law law = steel.law(Configuration::die);
    const LateralLaw lateral = make_lateral(law);
    const double x = lateral.yield_approach;
    EXPECT_LE(relative_error(lateral_state_at(law, lateral, x).pressure, 1.1), 1e-14) << steel;
    EXPECT_EQ(lateral_state_at(law, lateral, x * (1.0 - 1e-12)).regime, Regime::elastic) << steel;
    EXPECT_EQ(lateral_state_at(law, lateral, x * (1.0 + 1e-12)).regime, Regime::elastic_plastic) << steel;
  }
}

TEST(SemimechLateralContacts, HaveTheDerivativesOfTheirStates) {
  for (const Steel& steel : steels_of_the_source()) {
    const Law law = steel.law(Configuration::die);
    const LateralLaw lateral = make_lateral(law);
    for (const double x : {0.003, 0.012, 0.04, 0.09, lateral.onset + 0.02}) {
      const ContactState state = lateral_state_at(law, lateral, x);
      const auto error = [&](auto member, double derivative) {
        return relative_error(
            central_difference([&](double at) { return lateral_state_at(law, lateral, at).*member; }, x, 1e-3 * x),
            derivative);
      };
      EXPECT_LE(error(&ContactState::pressure, state.pressure_by_approach), 1e-10) << steel << ", x = " << x;
      if (x > LateralLaw::small_range_end) continue;
      EXPECT_LE(error(&ContactState::force, state.force_by_approach), 1e-10) << steel << ", x = " << x;
      EXPECT_LE(error(&ContactState::contact_radius, state.contact_radius_by_approach), 1e-10) << steel;
    }
  }
}

TEST(SemimechLateralContacts, HaveBoundariesAndADomainOfTheirOwn) {
  const Law law = Steel{200e9, 0.3, 200e6}.law(Configuration::die);
  const LateralLaw lateral = make_lateral(law);
  const auto list = boundaries(law, lateral);
  ASSERT_EQ(list.size(), 4u);
  EXPECT_EQ(list[0].event, "yield");
  EXPECT_EQ(list[1].event, "");
  EXPECT_EQ(list[1].approach, 0.1);
  EXPECT_EQ(list[1].beyond, Regime::undefined);
  EXPECT_EQ(list[2].event, "secondary-onset");
  EXPECT_EQ(list[2].beyond, Regime::low_compressibility);
  EXPECT_EQ(list[3].approach, law.stiffening.zero_porosity);
  EXPECT_EQ(list[3].beyond, Regime::elastic_volumetric);
  EXPECT_EQ(lateral_state_in(law, lateral, Regime::open, 0.0).force, 0.0);
  for (const Configuration configuration : {Configuration::simple, Configuration::hydrostatic}) {
    const std::string message = refusal<std::invalid_argument>([&] {
      return make_lateral(Steel{200e9, 0.3, 200e6}.law(configuration));
    });
    EXPECT_TRUE(contains(message, name(configuration))) << message;
  }
}

}  // namespace
}  // namespace monograin::semimech::lateral_test
