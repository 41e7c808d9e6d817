#include "history/branches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace monograin::branches_test {
namespace {

using Values = std::vector<double>;

/// Loading y = slope x to each reversal, unloading as an elastic contact does, y ~ (x - residual)^(3/2), and back.
XyCurve cycled(double slope, double residual_share, const Values& reversals, double end, std::size_t rows = 200) {
  XyCurve curve;
  const auto add = [&](double x, double y) {
    curve.x.push_back(x);
    curve.y.push_back(y);
  };
  const auto share = [&](std::size_t k) { return static_cast<double>(k) / static_cast<double>(rows); };
  double from = 0.0;
  const auto load_to = [&](double x) {
    for (std::size_t k = 0; k <= rows; ++k) add(std::lerp(from, x, share(k)), slope * std::lerp(from, x, share(k)));
    from = x;
  };
  for (const double reversal : reversals) {
    load_to(reversal);
    const double residual = residual_share * reversal;
    const auto unloaded = [&](double s) { return slope * reversal * std::pow(s, 1.5); };
    const auto place = [&](double s) { return std::lerp(residual, reversal, s); };
    for (std::size_t k = 1; k <= rows; ++k) add(place(1.0 - share(k)), unloaded(1.0 - share(k)));
    for (std::size_t k = 1; k <= rows; ++k) add(place(share(k)), unloaded(share(k)));
  }
  if (end > from) load_to(end);
  return curve;
}

TEST(Branches, FirstLoadingLeavesOutWhatIsUnloadedAndReloaded) {
  const XyCurve loading = first_loading({{0, 1, 2, 1, 1.5, 2, 3, 3}, {0, 1, 2, 0, 1, 2, 3, 9}});
  EXPECT_EQ(loading.x, (Values{0, 1, 2, 3}));
  EXPECT_EQ(loading.y, (Values{0, 1, 2, 3}));
}

TEST(Branches, UnloadingsStartAtTheLargestXOnly) {
  const auto found = unloadings({{0, 2, 1, 1.5, 1.2, 2, 3, 2.5, 2}, {0, 8, 4, 5, 4, 8, 9, 6, 3}});
  ASSERT_EQ(found.size(), 2U) << "a reload that is broken off is no unloading";
  EXPECT_EQ(found[0].x, (Values{2, 1}));
  EXPECT_EQ(found[1].x, (Values{3, 2.5, 2}));
  EXPECT_EQ(found[1].y, (Values{9, 6, 3}));
}

TEST(Branches, TheSlopeIsThatOfTheFirstTwentieth) {
  // y = 10 x down to 9, then steeper; the twentieth of 10 is gone at x = 0.95.
  EXPECT_NEAR(unloading_slope({{1.0, 0.9, 0.8}, {10.0, 9.0, 5.0}}), 10.0, 1e-12);
  EXPECT_DOUBLE_EQ(unloading_slope({{1.0, 0.5}, {10.0, 10.0}}), 0.0) << "a force that stays";
}

// The force goes like s^(3/2), with s = 1 at the reversal and ds = dx/0.2.
TEST(Branches, TheSlopeOfACurveIsThatOfItsSecantOverTheFirstTwentieth) {
  const auto unloading = unloadings(cycled(2.0, 0.6, {0.5}, 0.5, 20000)).front();
  const double expected = 0.05 / (0.2 * (1.0 - std::pow(0.95, 2.0 / 3.0)));
  EXPECT_NEAR(unloading_slope(unloading), expected, 1e-6 * expected);
}

TEST(Branches, TheResidualDisplacementIsWhereTheForceVanishes) {
  const auto unloading = unloadings(cycled(1.0, 0.6, {0.5}, 0.5)).front();
  EXPECT_NEAR(residual_displacement(unloading), 0.3, 1e-12) << "exact for the power 3/2";
  // Rows on both sides only: between them, and where that power leads.
  const double y = std::pow(0.1, 1.5);
  EXPECT_NEAR(residual_displacement({{0.5, 0.4, 0.2}, {std::pow(0.2, 1.5), y, 0.0}}), 0.3, 1e-12);
  EXPECT_TRUE(std::isnan(residual_displacement({{1.0, 0.5}, {10.0, 9.0}}))) << "a force that stays";
}

TEST(Branches, AUniformErrorGivesTheNumbersOfItsDefinition) {
  // 10 % on a straight line: area error 2 r/sqrt(3 x), peak error r, slope ratio 1.1 (the residuals agree).
  const auto lines = compare_branches(cycled(1.0, 0.6, {0.2, 0.4}, 0.5), cycled(1.1, 0.6, {0.2, 0.4}, 0.5));
  ASSERT_EQ(lines.size(), 3U) << "two unloadings and the loading to the end";
  for (const BranchComparison& line : lines) {
    EXPECT_NEAR(line.area_error, 0.2 / std::sqrt(3.0 * line.reversal), 1e-4) << line.reversal;
    EXPECT_NEAR(line.peak_error, 0.1, 1e-12) << line.reversal;
    EXPECT_DOUBLE_EQ(line.coverage, 1.0);
  }
  for (const std::size_t k : {0U, 1U}) {
    EXPECT_NEAR(lines[k].slope / lines[k].reference_slope, 1.1, 1e-12);
    EXPECT_NEAR(lines[k].residual, 0.6 * lines[k].reversal, 1e-12);
    EXPECT_NEAR(lines[k].reference_residual, 0.6 * lines[k].reversal, 1e-12);
  }
  EXPECT_DOUBLE_EQ(lines[2].reversal, 0.5);
  EXPECT_TRUE(std::isnan(lines[2].slope));
}

TEST(Branches, ACurveThatDoesNotTurnBackThereHasNoUnloading) {
  const auto lines = compare_branches(cycled(1.0, 0.6, {0.2}, 0.2), cycled(1.0, 0.6, {0.25}, 0.3));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(std::isnan(lines[0].slope));
  EXPECT_TRUE(std::isnan(lines[0].residual));
  EXPECT_FALSE(std::isnan(lines[0].reference_residual));
  EXPECT_NEAR(lines[0].peak_error, 0.0, 1e-12);
}

TEST(Branches, ReversalsWithinOnePercentAreEqual) {
  const XyCurve reference = cycled(1.0, 0.6, {0.2}, 0.3);
  EXPECT_FALSE(std::isnan(compare_branches(reference, cycled(1.0, 0.6, {0.2018}, 0.3)).front().slope));
  EXPECT_TRUE(std::isnan(compare_branches(reference, cycled(1.0, 0.6, {0.2022}, 0.3)).front().slope));
}

TEST(Branches, ExcursionsComeBackUpToTheLargestX) {
  const auto found = excursions({{0, 2, 1, 1.5, 2, 3, 2.5, 2, 2.2, 2.1, 4}, {0, 8, 4, 5, 8, 9, 6, 3, 4, 4, 9}});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].back.x, (Values{2, 1}));
  EXPECT_EQ(found[0].forth.x, (Values{1, 1.5, 2}));
  EXPECT_EQ(found[0].forth.y, (Values{4, 5, 8}));
  EXPECT_EQ(found[1].back.x, (Values{3, 2.5, 2}));
  EXPECT_EQ(found[1].forth.x, (Values{2, 2.2})) << "a reload that is broken off ends there";
}

TEST(Branches, BandsMeasureAUniformErrorAsItIs) {
  const Values bands{0.05, 0.3, 0.5};
  const auto lines = compare_bands(cycled(1.0, 0.6, {0.2, 0.4}, 0.5), cycled(1.1, 0.6, {0.2, 0.4}, 0.5), bands, 0.0);
  ASSERT_EQ(lines.size(), 2U);
  for (const BranchComparison& line : lines) {
    EXPECT_NEAR(line.largest, 0.1, 1e-12) << line.reversal;
    EXPECT_NEAR(line.rms, 0.1, 1e-12) << line.reversal;
    EXPECT_NEAR(line.unloading, 0.1, 1e-9) << "just below the reversal, where the force is largest";
    EXPECT_DOUBLE_EQ(line.coverage, 1.0);
    EXPECT_TRUE(std::isnan(line.slope)) << "no measure of a band";
  }
  EXPECT_DOUBLE_EQ(lines[0].reversal, 0.3);
  EXPECT_DOUBLE_EQ(lines[1].reversal, 0.5);
}

TEST(Branches, AReversalBetweenTwoBandsBelongsToTheLowerOne) {
  const auto lines =
      compare_bands(cycled(1.0, 0.6, {0.25}, 0.5), cycled(1.1, 0.6, {0.25}, 0.5), Values{0.05, 0.25, 0.5}, 0.0);
  EXPECT_NEAR(lines[0].unloading, 0.1, 1e-9);
  EXPECT_TRUE(std::isnan(lines[1].unloading));
}

TEST(Branches, BandsMeasureTheRowsOfTheReferenceThatAreLargeEnough) {
  const XyCurve reference{{1, 2, 3, 4, 5}, {1, 2, 4, 8, 16}};
  const XyCurve curve{{1, 2, 3, 4}, {5, 3, 5, 6}};  // off by 400, 50, 25 and -25 %; ends before the last row
  const auto line_from = [&](double from, double least) {
    return compare_bands(reference, curve, Values{from, 5.0}, least).front();
  };
  EXPECT_DOUBLE_EQ(line_from(1.0, 0.0).largest, 4.0);
  EXPECT_DOUBLE_EQ(line_from(2.0, 0.0).largest, 0.5) << "a band has its first row";
  const BranchComparison line = line_from(1.0, 2.0);
  EXPECT_DOUBLE_EQ(line.largest, 0.25) << "rows with y up to the least are not compared";
  EXPECT_DOUBLE_EQ(line.rms, 0.25);
  EXPECT_DOUBLE_EQ(line.coverage, 2.0 / 5.0) << "of all rows: two are too small, the curve ends before one";
  EXPECT_TRUE(std::isnan(line.unloading));
  EXPECT_TRUE(std::isnan(line_from(5.0, 0.0).largest)) << "the curve does not come there";
  EXPECT_DOUBLE_EQ(line_from(5.0, 0.0).coverage, 0.0);
}

TEST(Branches, BandsHoldWaysBackAndForthAgainstThoseFromTheSamePlace) {
  const XyCurve reference{{0, 1, 0.5, 1, 2}, {0, 10, 5, 10, 20}};
  const auto unloading = [&](const XyCurve& curve) {
    return compare_bands(reference, curve, Values{0.5, 3.0}, 0.0).front().unloading;
  };
  EXPECT_DOUBLE_EQ(unloading({{0, 1, 0.4, 1, 2}, {0, 10, 4, 10, 20}}), 0.0) << "interpolated on both ways";
  EXPECT_DOUBLE_EQ(unloading({{0, 1, 0.5, 1, 2}, {0, 10, 7, 10, 20}}), 0.2) << "over the 10 before";
  EXPECT_DOUBLE_EQ(unloading({{0, 1, 0.5, 1, 2}, {0, 10, 5, 4, 20}}), 0.6) << "the way forth counts as well";
  EXPECT_TRUE(std::isnan(unloading({{0, 1.5, 0.5, 1.5, 2}, {0, 15, 5, 15, 20}}))) << "turns back elsewhere";
}

TEST(Branches, CurvesWithoutACommonRangeAreAFault) {
  EXPECT_THROW(static_cast<void>(compare_branches({{0, 1}, {0, 1}}, {{2, 3}, {0, 1}})), std::runtime_error);
}

}  // namespace
}  // namespace monograin::branches_test
