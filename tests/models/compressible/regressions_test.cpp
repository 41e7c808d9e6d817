// Parameters of the compressible law from the material: coefficients, values, trends, ranges, finite elements.

#include "compressible/regressions.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "history/table.hpp"
#include "models/accuracy.hpp"

namespace monograin::compressible::regressions_test {
namespace {

Table table_in(const std::string& file) { return read_csv(MONOGRAIN_SOURCE_DIR "/" + file + ".csv"); }

struct Values {
  double k, delta_t, a;
};

Values values_at(double stiffness_ratio, double shear_ratio) {
  const LoadingLaw law = loading_law_of({}, stiffness_ratio, shear_ratio);
  return {law.stiffness, law.transition, law.exponent};
}

TEST(CompressibleRegressions, AreThoseOfTheCorrectedCoefficients) {
  const Table table = table_in("tests/models/compressible/reference/appendix_a_coefficients");
  std::map<std::string, std::vector<double>> coefficients;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    coefficients[std::string(table.word(row, 0))].push_back(table.at(row, 3));
  }
  for (const double stiffness : {3.0, 4.5, 12.0, 100.0, 500.0}) {
    for (const double shear : {0.25, 0.4, 0.75, 1.0}) {
      const double l = std::log(stiffness);
      const auto& k = coefficients.at("k");
      const auto biquadratic = [&](const std::vector<double>& c) {
        return c[0] * shear * shear + c[1] * shear / stiffness + c[2] / (stiffness * stiffness) + c[3] * shear +
               c[4] / stiffness + c[5];
      };
      EXPECT_LT(
          relative_error(regressed_stiffness(stiffness, shear), k[0] * shear * l + k[1] * shear + k[2] * l + k[3]),
          1e-14);
      EXPECT_LT(relative_error(regressed_transition(stiffness, shear), biquadratic(coefficients.at("delta_t"))), 1e-13);
      EXPECT_LT(relative_error(regressed_exponent(stiffness, shear), biquadratic(coefficients.at("a"))), 1e-13);
    }
  }
}

TEST(CompressibleRegressions, GiveTheParametersOfTheReferenceHistories) {
  // Values in the headers of law01, law02 and law04.
  const Values base = values_at(100.0, 1.0);
  EXPECT_LT(relative_error(base.k, 3.8993577505742754), 4 * k_epsilon);
  EXPECT_LT(relative_error(base.delta_t, 0.1131952), 4 * k_epsilon);
  EXPECT_LT(relative_error(base.a, 3.6539749), 4 * k_epsilon);
  const Values second = values_at(12.0, 0.5);
  EXPECT_LT(relative_error(second.k, 1.3751088513152428), 4 * k_epsilon);
  EXPECT_LT(relative_error(second.delta_t, 0.18124341666666667), 4 * k_epsilon);
  EXPECT_LT(relative_error(second.a, 1.9197544444444444), 4 * k_epsilon);
}

TEST(CompressibleRegressions, FollowTheTrendsThatTheSourceDescribes) {
  const std::vector<double> stiffness{4.5, 6, 12, 25, 50, 100, 150, 200, 500};
  const std::vector<double> shear{0.25, 0.5, 0.75, 1.0};
  for (const double g : shear) {
    for (std::size_t i = 1; i < stiffness.size(); ++i) {
      EXPECT_GT(values_at(stiffness[i], g).k, values_at(stiffness[i - 1], g).k);
      EXPECT_LT(values_at(stiffness[i], g).delta_t, values_at(stiffness[i - 1], g).delta_t);
    }
  }
  for (const double e : stiffness) {
    for (std::size_t i = 1; i < shear.size(); ++i) {
      EXPECT_GT(values_at(e, shear[i]).k, values_at(e, shear[i - 1]).k);
      EXPECT_GT(values_at(e, shear[i]).delta_t, values_at(e, shear[i - 1]).delta_t);
    }
    EXPECT_LT(values_at(e, 0.75).a, values_at(e, 1.0).a - 0.9);
    // An artefact of the quadratic: a has a minimum in between.
    const double minimum = 0.409 + 0.364 / e;
    EXPECT_GT(regressed_exponent(e, minimum + 0.05), regressed_exponent(e, minimum));
    EXPECT_GT(regressed_exponent(e, minimum - 0.05), regressed_exponent(e, minimum));
  }
  const Values base = values_at(100.0, 1.0);
  EXPECT_LT(base.a * base.delta_t, 1.0) << "softening after the first part";
}

TEST(CompressibleRegressions, AreNearTheFiniteElementFitsAndThePrintedOnesAreNot) {
  const Table grid = table_in("plots/fe/compressible_fit_grid");
  std::vector<double> k_error, k_printed_error, t_error, a_error;
  for (std::size_t row = 0; row < grid.row_count(); ++row) {
    const double e = grid.at(row, *grid.find("stiffness_ratio"));
    const double g = grid.at(row, *grid.find("shear_ratio"));
    const double k = grid.at(row, *grid.find("k"));
    k_error.push_back(relative_error(regressed_stiffness(e, g), k));
    const double printed = regressed_stiffness(e, g) + (7.4613e-4 - 7.4613e-1) * g * std::log(e);
    k_printed_error.push_back(relative_error(printed, k));
    if (e < k_least_fitted_stiffness_ratio) continue;
    t_error.push_back(std::abs(regressed_transition(e, g) - grid.at(row, *grid.find("delta_t"))));
    a_error.push_back(std::abs(regressed_exponent(e, g) - grid.at(row, *grid.find("a"))));
  }
  const auto median = [](std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
  };
  // Found: 6 %, 26 % at most, 0.017, 0.27; printed k: 60 % off in the median.
  EXPECT_LT(median(k_error), 0.07) << median(k_error);
  EXPECT_LT(*std::ranges::max_element(k_error), 0.27) << *std::ranges::max_element(k_error);
  EXPECT_LT(median(t_error), 0.02) << median(t_error);
  EXPECT_LT(median(a_error), 0.3) << median(a_error);
  EXPECT_GT(median(k_printed_error), 0.5) << median(k_printed_error);
  fmt::print("k: median {:.3f}, worst {:.3f}; delta_t: median {:.4f}; a: median {:.3f}; k as printed: median {:.3f}\n",
             median(k_error), *std::ranges::max_element(k_error), median(t_error), median(a_error),
             median(k_printed_error));
  // With a6 as printed the linear part would take nearly all of the law.
  EXPECT_GT(regressed_transition(100.0, 1.0) + 4.3846e-1 - 4.3846e-2, k_largest_displacement);
}

TEST(CompressibleRegressions, RefuseOtherMaterialsUnlessEverythingIsGiven) {
  const GivenLaw nothing;
  const GivenLaw all{2.0, 0.1, 3.0};
  for (const double stiffness : {2.99, 501.0}) {
    EXPECT_THROW(static_cast<void>(loading_law_of(nothing, stiffness, 0.5)), std::invalid_argument);
    EXPECT_NO_THROW(static_cast<void>(loading_law_of(all, stiffness, {})));
  }
  for (const double shear : {0.24, 1.01}) {
    EXPECT_THROW(static_cast<void>(loading_law_of(nothing, 10.0, shear)), std::invalid_argument);
  }
  EXPECT_THROW(static_cast<void>(loading_law_of(nothing, 10.0, {})), std::invalid_argument);
  EXPECT_EQ(regression_objections(nothing, 1.0, 2.0).size(), 2u);
  for (const double edge : {3.0, 500.0}) EXPECT_TRUE(regression_objections(nothing, edge, 0.25).empty());
}

TEST(CompressibleRegressions, TakeWhatIsGivenInsteadAndKnowWhereTheyExtrapolate) {
  const LoadingLaw law = loading_law_of({{}, 0.2, {}}, 100.0, 1.0);
  EXPECT_EQ(law.transition, 0.2);
  EXPECT_EQ(law.stiffness, regressed_stiffness(100.0, 1.0));
  EXPECT_TRUE(is_extrapolated({}, 4.4));
  EXPECT_FALSE(is_extrapolated({}, 4.5));
  EXPECT_FALSE(is_extrapolated({{}, 0.2, 3.0}, 4.4)) << "k was fitted to all of them";
  EXPECT_TRUE(is_extrapolated({{}, 0.2, {}}, 4.4)) << "a was not";
  EXPECT_TRUE(is_extrapolated({{}, {}, 3.0}, 4.4)) << "delta_t was not";
}

}  // namespace
}  // namespace monograin::compressible::regressions_test
