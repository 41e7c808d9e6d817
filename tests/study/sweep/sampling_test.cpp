#include "study/sweep/sampling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

namespace monograin::sampling_test {
namespace {

/// Mean of f over a design; its true value is 1 for every dimension.
double mean_of_products(const Design& design) {
  double sum = 0.0;
  for (std::size_t i = 0; i < design.size(); ++i) {
    double product = 1.0;
    for (const double u : design.point(i)) product *= (std::abs(4.0 * u - 2.0) + 0.5) / 1.5;
    sum += product;
  }
  return sum / static_cast<double>(design.size());
}

TEST(SampledDesign, LiesInTheOpenCubeAndIsThatOfItsSeed) {
  for (const std::string name : {"sobol", "halton", "lhs", "random"}) {
    const Design design = sampled_design(name, 3, 500, 7);
    ASSERT_EQ(design.size(), 500U) << name;
    for (const double u : design.coordinates) EXPECT_TRUE(u > 0.0 && u < 1.0) << name;
    EXPECT_EQ(sampled_design(name, 3, 500, 7).coordinates, design.coordinates) << name;
    EXPECT_NE(sampled_design(name, 3, 500, 8).coordinates, design.coordinates) << name;
  }
}

TEST(SampledDesign, OfAHypercubeHasOnePointInEverySliceOfEveryDimension) {
  const std::size_t runs = 40;
  const Design design = sampled_design("lhs", 4, runs, 3);
  for (std::size_t k = 0; k < 4; ++k) {
    std::set<std::size_t> slices;
    for (std::size_t i = 0; i < runs; ++i) slices.insert(static_cast<std::size_t>(design.point(i)[k] * runs));
    EXPECT_EQ(slices.size(), runs);
  }
}

// A number that is uniform in a slice has the variance 1/12.
TEST(SampledDesign, OfAHypercubeIsRandomWithinItsSlices) {
  const std::size_t runs = 4000;
  double variance = 0.0;
  for (const double u : sampled_design("lhs", 1, runs, 3).coordinates) {
    const double place = u * runs;
    variance += std::pow(place - std::floor(place) - 0.5, 2) / runs;
  }
  EXPECT_NEAR(variance, 1.0 / 12.0, 0.005);
}

TEST(SampledDesign, OfASequenceIntegratesBetterThanARandomOne) {
  const auto error = [](const std::string& name) {
    double squares = 0.0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      squares += std::pow(mean_of_products(sampled_design(name, 4, 1024, seed)) - 1.0, 2);
    }
    return std::sqrt(squares / 20.0);
  };
  const double random = error("random");
  EXPECT_NEAR(random, std::sqrt((std::pow(1.0 + 4.0 / 27.0, 4) - 1.0) / 1024.0), 0.01);
  EXPECT_LT(error("sobol"), 0.2 * random);
  EXPECT_LT(error("halton"), 0.3 * random);
}

TEST(SaltelliDesign, ChangesOneCoordinateOfTheFirstPointToThatOfTheSecond) {
  const Design design = saltelli_design(3, 50, 1);
  ASSERT_EQ(design.size(), 250U);
  for (std::size_t sample = 0; sample < 50; ++sample) {
    const auto a = design.point(5 * sample);
    const auto b = design.point(5 * sample + 1);
    for (std::size_t changed = 0; changed < 3; ++changed) {
      const auto point = design.point(5 * sample + 2 + changed);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(point[k], k == changed ? b[k] : a[k]);
    }
  }
}

TEST(MorrisDesign, ChangesEachCoordinateOnceByAHalf) {
  const Design design = morris_design(4, 30, 2);
  ASSERT_EQ(design.size(), 150U);
  for (std::size_t trajectory = 0; trajectory < 30; ++trajectory) {
    std::multiset<std::size_t> changed;
    for (std::size_t step = 0; step < 4; ++step) {
      for (std::size_t k = 0; k < 4; ++k) {
        const double change = design.point(5 * trajectory + step + 1)[k] - design.point(5 * trajectory + step)[k];
        if (change == 0.0) continue;
        EXPECT_EQ(std::abs(change), 0.5);
        changed.insert(k);
      }
    }
    EXPECT_EQ(changed, (std::multiset<std::size_t>{0, 1, 2, 3}));
  }
}

}  // namespace
}  // namespace monograin::sampling_test
