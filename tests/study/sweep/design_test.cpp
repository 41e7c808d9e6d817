#include "study/sweep/design.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "study/sweep/sweep_file.hpp"

namespace monograin::design_test {
namespace {

double continuous_criterion(Design design) {
  design.level_count = 0;
  return maxpro_criterion(design);
}

/// Material of Table A.1 in the unit cube: modulus, Poisson's ratio, yield stress.
bool is_in_table_a1(std::span<const double> x) {
  const double ratio = std::lerp(2e9, 200e9, x[0]) / std::lerp(1e6, 500e6, x[2]);
  return ratio >= 100.0 && ratio <= 5000.0;
}

const DesignSpace k_table_a1{.factors = 3, .level_count = 3, .contains = is_in_table_a1};
const DesignSpace k_table_e1{.factors = 2, .level_count = 3, .contains = {}};

TEST(MaxProCriterion, MatchesValuesComputedByHand) {
  Design design{
      .factors = 2, .level_count = 0, .coordinates = {0, 0.5, 0.25, 1, 0.5, 0, 0.75, 0.75, 1, 0.25}, .levels = {}};
  EXPECT_NEAR(maxpro_criterion(design), 6.03365049299385, 1e-13);  // printed digits
  design.level_count = 3;
  design.levels = {0, 1, 2, 0, 1};
  EXPECT_NEAR(maxpro_criterion(design), 3.61251928424648, 1e-13);
}

TEST(MaxProCriterion, IsInfiniteWherePointsShareACoordinate) {
  const Design design{.factors = 2, .level_count = 0, .coordinates = {0.1, 0.5, 0.1, 0.7, 0.3, 0.2}, .levels = {}};
  EXPECT_TRUE(std::isinf(maxpro_criterion(design)));
}

TEST(MaxProCriterion, OfTheTablesOfTheSourceIsThatOfTheirPrintedDigits) {
  const std::filesystem::path folder = MONOGRAIN_SOURCE_DIR "/scenarios/sweeps";
  const Sweep a1 = read_sweep(folder / "A1.toml");
  EXPECT_EQ(a1.runs.size(), 51U);
  EXPECT_NEAR(maxpro_criterion(a1.points), 34.3182, 5e-5);  // half of the last digit
  EXPECT_NEAR(continuous_criterion(a1.points), 117.2415, 5e-5);
  const Sweep e1 = read_sweep(folder / "E1.toml");
  EXPECT_EQ(e1.runs.size(), 60U);
  EXPECT_NEAR(maxpro_criterion(e1.points), 24.8149, 5e-5);
  EXPECT_NEAR(continuous_criterion(e1.points), 76.5138, 5e-5);
}

// Random designs have a criterion of about 279 and 257; the bounds are what published implementations reach.
TEST(SpaceFillingDesign, IsAtLeastAsGoodAsAskedWhateverTheSeed) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    EXPECT_LE(maxpro_criterion(maxpro_design(k_table_a1, 51, seed)), 28.0) << "seed " << seed;
    EXPECT_LE(maxpro_criterion(maxpro_design(k_table_e1, 60, seed)), 25.0) << "seed " << seed;
  }
}

TEST(SpaceFillingDesign, MeetsItsConstraint) {
  const Design design = maxpro_design(k_table_a1, 51, 7);
  ASSERT_EQ(design.size(), 51U);
  for (std::size_t i = 0; i < design.size(); ++i) {
    EXPECT_TRUE(is_in_table_a1(design.point(i))) << "point " << i;
    for (const double coordinate : design.point(i)) EXPECT_TRUE(coordinate >= 0.0 && coordinate <= 1.0) << coordinate;
  }
}

TEST(SpaceFillingDesign, GivesEveryLevelEquallyManyPoints) {
  const Design design = maxpro_design(k_table_e1, 60, 3);
  std::map<std::size_t, int> counts;
  for (const std::size_t level : design.levels) ++counts[level];
  EXPECT_EQ(counts, (std::map<std::size_t, int>{{0, 20}, {1, 20}, {2, 20}}));
}

// Maximum projection: on every axis, as a whole and within a level, no two points are close and no stretch is empty.
TEST(SpaceFillingDesign, CoversEveryAxis) {
  const Design design = maxpro_design(k_table_e1, 60, 1);
  for (std::size_t axis = 0; axis < design.factors; ++axis) {
    std::vector<double> all;
    std::vector<double> first_level;
    for (std::size_t i = 0; i < design.size(); ++i) {
      all.push_back(design.point(i)[axis]);
      if (design.levels[i] == 0) first_level.push_back(design.point(i)[axis]);
    }
    for (std::vector<double>* values : {&all, &first_level}) {
      std::ranges::sort(*values);
      const double spacing = 1.0 / static_cast<double>(values->size());
      for (std::size_t i = 1; i < values->size(); ++i) {
        const double gap = (*values)[i] - (*values)[i - 1];
        EXPECT_GT(gap, 0.02 * spacing) << "axis " << axis << ", near " << (*values)[i];
        EXPECT_LT(gap, 6.0 * spacing) << "axis " << axis << ", near " << (*values)[i];
      }
      EXPECT_LT(values->front(), 4.0 * spacing);
      EXPECT_GT(values->back(), 1.0 - 4.0 * spacing);
    }
  }
}

TEST(SpaceFillingDesign, IsTheSameForTheSameSeedOnly) {
  const Design first = maxpro_design(k_table_e1, 30, 5);
  EXPECT_EQ(first.coordinates, maxpro_design(k_table_e1, 30, 5).coordinates);
  EXPECT_NE(first.coordinates, maxpro_design(k_table_e1, 30, 6).coordinates);
}

// Above 60 runs the candidates are cut before they are clustered, which must not cost quality: the criterion per
// run count goes on smoothly, and stays far below that of random points.
TEST(SpaceFillingDesign, StaysGoodWhereCandidatesAreCutFirst) {
  const Design design = maxpro_design(k_table_e1, 300, 1);
  EXPECT_EQ(design.size(), 300U);
  Design random{.factors = 2, .level_count = 3, .coordinates = {}, .levels = design.levels};
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < 2 * design.size(); ++i) {
    state = 1664525U * state + 1013904223U;
    random.coordinates.push_back(static_cast<double>(state) * 0x1p-32);
  }
  EXPECT_LT(maxpro_criterion(design), 0.2 * maxpro_criterion(random));
}

TEST(SpaceFillingDesign, RefusesWhatCannotBeMade) {
  EXPECT_THROW(static_cast<void>(maxpro_design(k_table_e1, 50, 1)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(maxpro_design({.factors = 0, .level_count = 3, .contains = {}}, 3, 1)),
               std::invalid_argument);
  const DesignSpace empty{.factors = 1, .level_count = 0, .contains = [](std::span<const double>) { return false; }};
  EXPECT_THROW(static_cast<void>(maxpro_design(empty, 3, 1)), std::domain_error);
}

}  // namespace
}  // namespace monograin::design_test
