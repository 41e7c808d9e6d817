#include "study/sweep/indices.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "study/sweep/sampling.hpp"

namespace monograin::indices_test {
namespace {

using std::numbers::pi;

/// Ishigami and Homma (1990) with a = 7, b = 0.1.
double ishigami(std::span<const double> u) {
  const auto angle = [&](std::size_t k) { return pi * (2.0 * u[k] - 1.0); };
  return std::sin(angle(0)) + 7.0 * std::pow(std::sin(angle(1)), 2) + 0.1 * std::pow(angle(2), 4) * std::sin(angle(0));
}

template <class Function>
std::vector<double> results_at(const Design& design, Function&& function) {
  std::vector<double> results;
  for (std::size_t i = 0; i < design.size(); ++i) results.push_back(function(design.point(i)));
  return results;
}

/// Partial variances of Ishigami's function.
struct IshigamiVariances {
  double first = 0.5 * std::pow(1.0 + 0.1 * std::pow(pi, 4) / 5.0, 2);
  double second = 49.0 / 8.0;
  double both = 0.01 * std::pow(pi, 8) * (1.0 / 18.0 - 1.0 / 50.0);  // of the first and the third factor
  double all = first + second + both;
};

TEST(SobolIndices, OfIshigamisFunctionAreWithinTheirIntervals) {
  const IshigamiVariances v;
  const std::array first{v.first / v.all, v.second / v.all, 0.0};
  const std::array total{(v.first + v.both) / v.all, v.second / v.all, v.both / v.all};
  int outside = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SobolIndices indices = sobol_indices(results_at(saltelli_design(3, 512, seed), ishigami), 3, 0.95);
    EXPECT_EQ(indices.samples, 512U);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(indices.first[k].value, first[k], 0.08) << "seed " << seed << ", factor " << k;
      EXPECT_NEAR(indices.total[k].value, total[k], 0.08) << "seed " << seed << ", factor " << k;
      for (const auto& [estimate, truth] : {std::pair(indices.first[k], first[k]), {indices.total[k], total[k]}}) {
        EXPECT_LT(estimate.upper - estimate.lower, 0.4);
        if (truth < estimate.lower || truth > estimate.upper) ++outside;
      }
    }
  }
  // Six of 120 intervals may miss if the samples are random; those of a sequence are nearer than their intervals say.
  EXPECT_LE(outside, 6);
}

TEST(SobolIndices, OfASumAreItsSharesOfTheVariance) {
  const Design design = saltelli_design(2, 4096, 1);
  const auto indices = sobol_indices(results_at(design, [](auto u) { return 3.0 * u[0] + 4.0 * u[1] + 1e6; }), 2, 0.95);
  for (const auto& [k, share] : {std::pair(0U, 9.0 / 25.0), {1U, 16.0 / 25.0}}) {
    EXPECT_NEAR(indices.first[k].value, share, 0.01);
    EXPECT_NEAR(indices.total[k].value, share, 0.01);
  }
}

// The points a, b and a with b's number. Less the mean 2 they are -1, 1, 0 and 2, -2, -1, with the variance 10/4; the
// sums of b (ab - a) and of (a - ab)^2 are 7 and 10.
TEST(SobolIndices, OfTwoSamplesAreThoseOfTheirFormulas) {
  const SobolIndices indices = sobol_indices(std::vector{1.0, 3.0, 2.0, 4.0, 0.0, 1.0}, 1, 0.95);
  EXPECT_NEAR(indices.first[0].value, 7.0 / 2.0 / 2.5, 1e-14);
  EXPECT_NEAR(indices.total[0].value, 10.0 / 4.0 / 2.5, 1e-14);
}

TEST(SobolIndices, LeaveOutSamplesWithAPointThatHasNoValue) {
  const Design design = saltelli_design(3, 512, 4);
  std::vector<double> results = results_at(design, ishigami);
  const SobolIndices all = sobol_indices(std::span(results).subspan(5), 3, 0.95);
  results[3] = std::numeric_limits<double>::quiet_NaN();
  const SobolIndices without = sobol_indices(results, 3, 0.95);
  EXPECT_EQ(without.samples, 511U);
  EXPECT_EQ(without.total[0].value, all.total[0].value);
}

TEST(SobolIndices, OfAResultThatIsAlwaysTheSameAreUndefined) {
  const std::vector<double> results(5 * 100, 3.7);
  const SobolIndices indices = sobol_indices(results, 3, 0.95);
  EXPECT_TRUE(std::isnan(indices.first[0].value));
  EXPECT_TRUE(std::isnan(indices.total[2].value));
}

TEST(ElementaryEffects, OfAPlaneAreItsSlopes) {
  const Design design = morris_design(3, 10, 1);
  const auto effects =
      morris_effects(design, results_at(design, [](auto u) { return 2.0 * u[0] - 5.0 * u[1] + 1.0; }), 0.95);
  EXPECT_EQ(effects.samples, 10U);
  const std::array slopes{2.0, -5.0, 0.0};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(effects.mean[k], slopes[k], 1e-13);
    EXPECT_NEAR(effects.mean_size[k].value, std::abs(slopes[k]), 1e-13);
    EXPECT_NEAR(effects.mean_size[k].lower, std::abs(slopes[k]), 1e-13);
    EXPECT_NEAR(effects.spread[k], 0.0, 1e-13);
  }
}

/// Trajectories of one factor with effects of 1 and 3 in turn.
MorrisEffects effects_of_one_and_three(std::size_t trajectories, double confidence) {
  Design design{.factors = 1, .level_count = 0};
  std::vector<double> results;
  for (std::size_t k = 0; k < trajectories; ++k) {
    design.coordinates.insert(design.coordinates.end(), {0.125, 0.625});
    results.insert(results.end(), {0.0, 0.5 * (k % 2 == 0 ? 1.0 : 3.0)});
  }
  return morris_effects(design, results, confidence);
}

TEST(ElementaryEffects, HaveTheStandardDeviationOfASample) {
  EXPECT_NEAR(effects_of_one_and_three(2, 0.95).spread[0], std::sqrt(2.0), 1e-14) << "one degree of freedom";
}

// The mean of 400 effects of 1 and 3 has the standard error 1/20, and is nearly normal.
TEST(ElementaryEffects, HaveTheIntervalOfTheirConfidence) {
  const Estimate size = effects_of_one_and_three(400, 0.9).mean_size[0];
  const double half = 1.6448536 / 20.0;
  EXPECT_NEAR(size.lower, 2.0 - half, 0.15 * half);
  EXPECT_NEAR(size.upper, 2.0 + half, 0.15 * half);
}

TEST(ElementaryEffects, SpreadWhereAFactorActsWithAnother) {
  const Design design = morris_design(2, 400, 1);
  const auto effects = morris_effects(design, results_at(design, [](auto u) { return u[0] * (u[1] - 0.5); }), 0.95);
  // The effect of the first factor is u1 - 1/2 at 1/8, 3/8, 5/8, 7/8.
  EXPECT_NEAR(effects.mean[0], 0.0, 0.05);
  EXPECT_NEAR(effects.mean_size[0].value, 0.25, 0.02);
  EXPECT_NEAR(effects.spread[0], std::sqrt(5.0) / 8.0, 0.02);
  EXPECT_LT(effects.mean_size[0].lower, 0.25);
  EXPECT_GT(effects.mean_size[0].upper, 0.25);
}

TEST(ElementaryEffects, LeaveOutTrajectoriesWithAPointThatHasNoValue) {
  const Design design = morris_design(2, 10, 1);
  std::vector<double> results = results_at(design, [](auto u) { return u[0]; });
  results[4] = std::numeric_limits<double>::quiet_NaN();
  const auto effects = morris_effects(design, results, 0.95);
  EXPECT_EQ(effects.samples, 9U);
  EXPECT_NEAR(effects.mean[0], 1.0, 1e-13);
}

}  // namespace
}  // namespace monograin::indices_test
