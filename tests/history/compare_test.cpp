#include "history/compare.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "system/resolution.hpp"

namespace monograin::compare_test {
namespace {

using Values = std::vector<double>;

/// A handful of additions and one square root.
constexpr double k_round_off_of_sums = 8 * k_epsilon;

TEST(CompareCurves, FindsNoDifferenceBetweenACurveAndItself) {
  const Values x{0, 1, 2, 1, 0};
  const Values y{0, 3, k_nan, 2, -1};
  const auto difference = compare_curves(x, y, x, y);
  EXPECT_EQ(difference.linf, 0.0);
  EXPECT_EQ(difference.l2, 0.0);
  EXPECT_EQ(difference.area_error, 0.0);
  EXPECT_EQ(difference.peak_error, 0.0);
}

TEST(CompareCurves, GivesTheHandComputedMeasures) {
  // a = 2, 4, 2 and b - a = 0, -1, 0.5 at x = 0, 1, 3:
  // int (b - a)^2 = 0.5*1*(0 + 1) + 0.5*2*(1 + 0.25) = 1.75, int a^2 = 0.5*(4 + 16) + (16 + 4) = 30,
  // int a = 3 + 6 = 9, a at the largest x is 2.
  const Values x{0, 1, 3};
  const auto difference = compare_curves(x, Values{2, 4, 2}, x, Values{2, 3, 2.5});
  EXPECT_DOUBLE_EQ(difference.linf, 0.25);
  EXPECT_EQ(difference.linf_at, 1.0);
  EXPECT_DOUBLE_EQ(difference.l2, std::sqrt(1.75 / 30.0));
  EXPECT_DOUBLE_EQ(difference.area_error, std::sqrt(1.75) / 9.0);
  EXPECT_DOUBLE_EQ(difference.peak_error, 0.5);
  EXPECT_EQ(difference.coverage, 1.0);
}

TEST(CompareCurves, HasTheClosedFormOfAUniformErrorOfAStraightLine) {
  // e_a = 2 r/sqrt(3 x_max); the trapezoidal rule on n intervals adds a relative error below 1/(2 n^2) to the integral.
  constexpr int k_intervals = 1000;
  constexpr double k_error = 0.01;
  constexpr double k_end = 0.5;
  Values x, a, b;
  for (int k = 0; k <= k_intervals; ++k) {
    x.push_back(k_end * k / k_intervals);
    a.push_back(3.0 * x.back());
    b.push_back((1.0 + k_error) * a.back());
  }
  const auto difference = compare_curves(x, a, x, b);
  const double exact = 2.0 * k_error / std::sqrt(3.0 * k_end);
  EXPECT_NEAR(difference.area_error, exact, exact / (2.0 * k_intervals * k_intervals));
  EXPECT_NEAR(difference.peak_error, k_error, k_round_off_of_sums);
  EXPECT_NEAR(difference.l2, k_error, k_round_off_of_sums);
}

TEST(CompareCurves, MeasuresAbsolutelyWhereTheReferenceIsZero) {
  const Values x{0, 4};
  const auto difference = compare_curves(x, Values{0, 0}, x, Values{3, 3});
  EXPECT_EQ(difference.linf, 3.0);
  EXPECT_EQ(difference.l2, 6.0);
  EXPECT_EQ(difference.area_error, 6.0);
  EXPECT_EQ(difference.peak_error, 3.0);
}

TEST(CompareCurves, TakesTheLargestReferenceForThePeakWhereTheLastIsZero) {
  const Values x{0, 1, 2};
  EXPECT_DOUBLE_EQ(compare_curves(x, Values{0, 4, 0}, x, Values{0, 5, 0}).peak_error, 0.25);
}

TEST(CompareCurves, HasTheSameLargestDifferenceBothWaysForCurvesOfOneSize) {
  const Values x{0, 1, 2};
  const Values a{0, 1, 4};
  const Values b{0, 2, 4};
  EXPECT_EQ(compare_curves(x, a, x, b).linf, compare_curves(x, b, x, a).linf);
}

TEST(CompareCurves, InterpolatesTheSecondCurveAtThePlacesOfTheFirst) {
  const auto difference =
      compare_curves(Values{0, 0.25, 0.5, 1}, Values{0, 0.5, 1, 2}, Values{0, 0.4, 1}, Values{0, 0.8, 2});
  EXPECT_LT(difference.linf, k_round_off_of_sums);
}

TEST(CompareCurves, SetsPiecesOfACurveThatTurnsBackAgainstEachOther) {
  // Up along y = x, down along y = 2 x - 1: the same curve in two samplings.
  const Values x_a{0, 0.5, 1, 0.75, 0.5};
  const Values y_a{0, 0.5, 1, 0.5, 0};
  const Values x_b{0, 0.2, 1, 0.9, 0.5};
  const Values y_b{0, 0.2, 1, 0.8, 0};
  EXPECT_LT(compare_curves(x_a, y_a, x_b, y_b).linf, k_round_off_of_sums);
}

TEST(CompareCurves, CountsAPieceBackAsMuchAsOneForth) {
  const Values x{0, 1, 0};
  const auto difference = compare_curves(x, Values{1, 1, 1}, x, Values{1, 1, 3});
  EXPECT_DOUBLE_EQ(difference.l2, 1.0);  // int (b - a)^2 = 2 on the way back, int a^2 = 2 on both
}

TEST(CompareCurves, SeesAJumpFromBothSides) {
  // Both jump from 1 to 5 at x = 1, written as two rows; the sampling differs.
  const Values x_a{0, 0.5, 1, 1, 2};
  const Values y_a{1, 1, 1, 5, 5};
  const Values x_b{0, 1, 1, 1, 1.7, 2};
  const Values y_b{1, 1, 1, 5, 5, 5};
  EXPECT_EQ(compare_curves(x_a, y_a, x_b, y_b).linf, 0.0);
}

TEST(CompareCurves, TakesAJumpLocatedALittleApartForTheSame) {
  for (const double shift : {-1e-9, 1e-9}) {
    const Values x_b{0, 1 + shift, 1 + shift, 2};
    const auto difference = compare_curves(Values{0, 1, 1, 2}, Values{1, 1, 5, 5}, x_b, Values{1, 1, 5, 5});
    EXPECT_LT(difference.linf, k_round_off_of_sums) << "shift " << shift;
  }
}

TEST(CompareCurves, DoesNotForgiveAJumpThatIsElsewhere) {
  const auto difference =
      compare_curves(Values{0, 1, 1, 2}, Values{1, 1, 5, 5}, Values{0, 1.1, 1.1, 2}, Values{1, 1, 5, 5});
  EXPECT_DOUBLE_EQ(difference.linf, 0.8);
  EXPECT_EQ(difference.linf_at, 1.0);
}

TEST(CompareCurves, LeavesTheJumpAtATurnToNeitherPiece) {
  // The value drops from 3 to 2 while x stands at 1, then x goes back.
  const Values x_a{0, 1, 1, 0};
  const Values y_a{0, 3, 2, 0};
  const Values x_b{0, 0.5, 1, 1, 0.5, 0};
  const Values y_b{0, 1.5, 3, 2, 1, 0};
  EXPECT_LT(compare_curves(x_a, y_a, x_b, y_b).linf, k_round_off_of_sums);
}

TEST(CompareCurves, ComparesWhereBothAreAndSaysHowFarThatIs) {
  const auto difference = compare_curves(Values{0, 1, 2, 4}, Values{1, 1, 1, 1}, Values{0, 2.5}, Values{1, 1});
  EXPECT_EQ(difference.linf, 0.0);
  EXPECT_DOUBLE_EQ(difference.coverage, 2.5 / 4.0);
}

TEST(CompareCurves, CountsTheWholePathUpToTheEndOfTheOther) {
  const Values x{0, 1, 2};
  const Values y{0, 1, 2};
  EXPECT_DOUBLE_EQ(compare_curves(x, y, Values{0, 1, 1.999}, y).coverage, 1.999 / 2.0);
  EXPECT_DOUBLE_EQ(compare_curves(x, y, Values{0.25, 1, 2}, y).coverage, 1.75 / 2.0);
  EXPECT_DOUBLE_EQ(compare_curves(Values{2, 1, 0}, y, Values{2, 1, 0.5}, y).coverage, 1.5 / 2.0) << "x falls";
}

TEST(CompareCurves, IsInfinitelyApartWhereOnlyOneIsDefined) {
  const Values x{0, 1, 2};
  EXPECT_TRUE(std::isinf(compare_curves(x, Values{1, 1, 1}, x, Values{1, k_nan, 1}).linf));
  EXPECT_TRUE(std::isinf(compare_curves(x, Values{1, k_nan, 1}, x, Values{1, 1, 1}).linf));
}

TEST(CompareCurves, IsInfinitelyApartAtARowThatOnlyOneCurveDefinesWhereTheOtherRowsDiffer) {
  const auto difference =
      compare_curves(Values{0, 1, 2, 3}, Values{1, 1, k_nan, 1}, Values{0, 0.5, 2, 3}, Values{1, 1, 1, 1});
  EXPECT_TRUE(std::isinf(difference.linf));
}

TEST(CompareCurves, IsInfinitelyApartAtAJumpWhereOnlyOneCurveIsDefined) {
  const Values x{0, 1, 1, 2};
  const Values of_other{0, 1 + 1e-9, 1 + 1e-9, 2};
  EXPECT_TRUE(std::isinf(compare_curves(x, Values{1, 1, 3, 3}, of_other, Values{1, k_nan, 3, 3}).linf));
  EXPECT_TRUE(std::isinf(compare_curves(x, Values{1, 1, 3, 3}, of_other, Values{1, 1, k_nan, 3}).linf));
  EXPECT_EQ(compare_curves(x, Values{1, 1, k_nan, 3}, of_other, Values{1, 1, k_nan, 3}).linf, 0.0);
}

TEST(CompareCurves, CountsAsCoveredOnlyWhereAtLeastOneCurveIsDefined) {
  const Values x{0, 1, 2, 3};
  EXPECT_EQ(compare_curves(x, Values{1, 1, k_nan, k_nan}, x, Values{1, 1, k_nan, k_nan}).coverage, 1.0);
  const auto cut = compare_curves(x, Values{1, 1, 1, 1}, Values{0, 0.5, 1.5, 3}, Values{1, 1, k_nan, k_nan});
  EXPECT_DOUBLE_EQ(cut.coverage, 0.0);
  const auto extra = compare_curves(x, Values{1, 1, k_nan, k_nan}, Values{0, 0.5, 2.5, 3}, Values{1, 1, 1, 1});
  EXPECT_DOUBLE_EQ(extra.coverage, 1.0 / 3.0);
}

TEST(CompareCurves, LeavesOutUndefinedValuesWhereItInterpolates) {
  const auto difference =
      compare_curves(Values{0, 1, 2, 3}, Values{1, 1, k_nan, 1}, Values{0, 0.5, 3}, Values{1, 1, 1});
  EXPECT_EQ(difference.linf, 0.0);
  EXPECT_LT(difference.coverage, 1.0);
}

TEST(CompareCurves, RefusesCurvesThatCannotBeBroughtTogether) {
  const Values two{0, 1};
  EXPECT_THROW(static_cast<void>(compare_curves(two, two, Values{2, 3}, two)), std::runtime_error);
  EXPECT_THROW(static_cast<void>(compare_curves(two, two, Values{1, 0}, two)), std::runtime_error);
  EXPECT_THROW(static_cast<void>(compare_curves(two, two, Values{0, 1, 0}, Values{0, 1, 0})), std::runtime_error);
  EXPECT_THROW(static_cast<void>(compare_curves({}, {}, two, two)), std::runtime_error);
  EXPECT_THROW(static_cast<void>(compare_curves(two, Values{1}, two, two)), std::invalid_argument);
}

Table history(double force_at_end) {
  Table table({{"time", "s", {}}, {"step", "", {}}, {"force", "N", {}}, {"area", "m2", {}}, {"regime", "", {"open"}}});
  table.append(std::array{0.0, 1.0, 0.0, 2.0, 0.0});
  table.append(std::array{1.0, 1.0, force_at_end, 2.0, 0.0});
  return table;
}

std::string fault_of(const Table& a, const Table& b, const std::string& x, const std::string& y) {
  try {
    static_cast<void>(compare_tables(a, b, x, y));
  } catch (const std::runtime_error& fault) {
    return fault.what();
  }
  return "no fault";
}

/// All gaps, as sentences.
std::vector<std::string> sentences(const Comparison& comparison) {
  std::vector<std::string> result;
  for (const Gap& gap : comparison.gaps) result.push_back(gap.column + ' ' + gap.problem);
  return result;
}

std::vector<std::string> gaps(const Table& a, const Table& b, const std::string& y = "") {
  return sentences(compare_tables(a, b, "time", y));
}

using Sentences = std::vector<std::string>;

TEST(CompareTables, TakesEveryResultOfTheReference) {
  const auto [curves, missing] = compare_tables(history(2.0), history(3.0), "time", "");
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[0].y, "force[N]");
  EXPECT_DOUBLE_EQ(curves[0].linf, 0.5);
  EXPECT_EQ(curves[1].y, "area[m2]");
  EXPECT_EQ(curves[1].linf, 0.0);
  EXPECT_TRUE(missing.empty());
}

TEST(CompareTables, TakesTheColumnThatIsNamed) {
  const auto comparison = compare_tables(history(2.0), history(3.0), "", "force[N]");
  ASSERT_EQ(comparison.curves.size(), 1u);
  EXPECT_EQ(comparison.curves[0].y, "force[N]");
}

TEST(CompareTables, GiveOneAreaErrorInAnyUnits) {
  // A straight line with a uniform error of 5 %, up to x = 0.3 R0, or to 0.3 of any other unit.
  const auto line = [](const char* unit, double length, double slope, bool has_radius) {
    Table table({{"x", unit, {}}, {"y", "N", {}}});
    if (has_radius) table.header = {{"R0", fmt::format("{}", length)}};
    for (int k = 0; k <= 1000; ++k) {
      const double x = 0.3e-3 * k;
      table.append({{x * length, slope * x}});
    }
    return table;
  };
  const auto area_error = [&](const char* unit, double length, bool has_radius) {
    const Table reference = line(unit, length, 1.0, has_radius);
    return compare_tables(reference, line(unit, length, 1.05, has_radius), "x", "y").curves.front().area_error;
  };
  const double over_radius = 0.1 / std::sqrt(3.0 * 0.3);
  EXPECT_NEAR(area_error("", 1.0, false), over_radius, 1e-6);
  for (const double length : {1e-6, 1.0, 1e3}) {
    EXPECT_NEAR(area_error("m", length, true), over_radius, 1e-6) << length;
    EXPECT_NEAR(area_error("s", length, true), 0.1 / std::sqrt(3.0), 1e-6) << length << ": over the range";
    EXPECT_NEAR(area_error("m", length, false), 0.1 / std::sqrt(3.0), 1e-6) << length << ": nothing says what R0 is";
  }
}

TEST(CompareTables, RefusesWhatTheReferenceDoesNotHave) {
  EXPECT_EQ(fault_of(history(1), history(1), "tme", ""), "the first table has no column 'tme'; did you mean 'time'?");
  EXPECT_EQ(fault_of(history(1), history(1), "time", "forc"),
            "the first table has no column 'forc'; did you mean 'force'?");
  EXPECT_EQ(fault_of(history(1), history(1), "regime", ""),
            "column 'regime' of the first table holds words, not numbers");
  EXPECT_EQ(fault_of(Table(std::vector<Column>{{"time", "s", {}}}), history(1), "time", ""),
            "the first table has no column besides 'time[s]'");
}

TEST(CompareTables, NamesEveryColumnThatTheOtherLacksOrHasInAnotherUnit) {
  Table other({{"time", "s", {}}, {"force", "kN", {}}, {"regime", "", {}}});
  other.append(std::array{0.0, 0.0, 0.0});
  EXPECT_EQ(gaps(history(1), other), (Sentences{"force[N] is in kN instead of in N", "area[m2] is missing",
                                                "regime holds numbers instead of words"}));
  EXPECT_EQ(gaps(history(1), other, "area"), Sentences{"area[m2] is missing"});
  const Table without_x(std::vector<Column>{{"force", "N", {}}});
  EXPECT_EQ(gaps(history(1), without_x), Sentences{"time[s] is missing"});
}

TEST(CompareTables, NamesAPlaceThatOnlyOneOfThemDefines) {
  const auto table = [](double second, double third = 2.0) {
    Table made({{"time", "s", {}}, {"force", "N", {}}});
    for (const double time : {0.0, second, third, 3.0}) made.append({{time, 1.0}});
    return made;
  };
  const auto gaps = [&](double in_a, double in_b) { return compare_tables(table(in_a), table(in_b), "", "").gaps; };
  const double none = std::numeric_limits<double>::quiet_NaN();
  ASSERT_EQ(gaps(1.0, none).size(), 1u);
  EXPECT_EQ(gaps(1.0, none)[0].column, "time[s]");
  EXPECT_EQ(gaps(1.0, none)[0].problem, "is undefined in 1 of 4 rows, and in 0 of 4 of the reference");
  EXPECT_EQ(gaps(none, 1.0).size(), 1u);
  EXPECT_EQ(gaps(none, none).size(), 0u);
  EXPECT_EQ(compare_tables(table(none), table(none, none), "", "").gaps.size(), 1u) << "one of them has more";
}

TEST(CompareTables, NamesTheColumnThatIsNotCovered) {
  Table shorter({{"time", "s", {}}, {"force", "N", {}}});
  shorter.append(std::array{0.0, 0.0});
  EXPECT_EQ(gaps(history(1), shorter, "force"), Sentences{"force[N] covers only 0 % of the curve"});
  Table later({{"time", "s", {}}, {"force", "N", {}}});
  later.append(std::array{5.0, 0.0});
  later.append(std::array{6.0, 0.0});
  EXPECT_EQ(gaps(history(1), later, "force"),
            Sentences{"force[N] the curves cannot be compared: there is no x at which both are defined"});
}

Table regimes(const std::vector<double>& times, const std::vector<double>& words) {
  Table table({{"time", "s", {}}, {"regime", "", {"open", "elastic", "yielded"}}});
  for (std::size_t k = 0; k < times.size(); ++k) table.append(std::array{times[k], words[k]});
  return table;
}

TEST(CompareTables, ComparesWordsRowByRowWhereTheRowsAreAtTheSamePlaces) {
  EXPECT_EQ(gaps(regimes({0, 1, 2}, {0, 1, 2}), regimes({0, 1, 2}, {0, 1, 2})), Sentences{});
  EXPECT_EQ(gaps(regimes({0, 1, 2}, {0, 1, 2}), regimes({0, 1, 2}, {0, 0, 2})),
            Sentences{"regime has 'open' instead of 'elastic' at time[s] = 1"});
}

TEST(CompareTables, ComparesTheOrderOfWordsWhereTheRowsDiffer) {
  EXPECT_EQ(gaps(regimes({0, 1, 2}, {0, 1, 2}), regimes({0, 0.5, 1.5, 2}, {0, 0, 1, 2})), Sentences{});
  EXPECT_EQ(gaps(regimes({0, 1, 2}, {0, 1, 2}), regimes({0, 0.5, 2}, {0, 1, 1})),
            Sentences{"regime has nothing instead of 'yielded' at time[s] = 2"});
  EXPECT_EQ(gaps(regimes({0, 1}, {0, 1}), regimes({0, 0.5, 2}, {0, 1, 2})),
            Sentences{"regime has 'yielded' instead of nothing at time[s] = 2"});
}

Table events(const std::vector<double>& times, const std::vector<double>& names) {
  Table table({{"time", "s", {}}, {"class", "", {"axial"}}, {"event", "", {"yield", "reload"}}});
  for (std::size_t k = 0; k < times.size(); ++k) table.append(std::array{times[k], 0.0, names[k]});
  return table;
}

TEST(CompareEvents, TakesTheirTimesAsOneCurve) {
  const auto [curves, missing] = compare_events(events({1, 4}, {0, 1}), events({1, 3}, {0, 1}));
  EXPECT_TRUE(missing.empty());
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_DOUBLE_EQ(curves[0].linf, 0.25);
  EXPECT_EQ(curves[0].linf_at, 4.0);
}

TEST(CompareEvents, NamesTheFirstThatIsAnotherMissingOrExtra) {
  const auto difference = [](const Table& a, const Table& b) { return sentences(compare_events(a, b)); };
  EXPECT_EQ(difference(events({1, 4}, {0, 1}), events({1, 4}, {0, 0})),
            Sentences{"event number 2 is 'yield' of axial instead of 'reload' of axial at 4 s"});
  EXPECT_EQ(difference(events({1, 4}, {0, 1}), events({1}, {0})),
            Sentences{"event number 2 is nothing instead of 'reload' of axial at 4 s"});
  EXPECT_EQ(difference(events({1}, {0}), events({1, 4}, {0, 1})),
            Sentences{"event number 2 is 'reload' of axial instead of nothing at 4 s"});
  EXPECT_EQ(difference(events({}, {}), events({}, {})), Sentences{});
  EXPECT_EQ(difference(events({1}, {0}), history(1)), (Sentences{"class is missing", "event is missing"}));
}

}  // namespace
}  // namespace monograin::compare_test
