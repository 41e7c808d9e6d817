#include "history/turns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace monograin::turns_test {
namespace {

using Values = std::vector<double>;

/// x through the places in equal steps, with Gaussian noise.
Values through(const Values& places, std::size_t rows, double noise, unsigned seed = 7) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> error(0.0, noise > 0.0 ? noise : 1.0);
  Values x{places.front()};
  for (std::size_t p = 1; p < places.size(); ++p) {
    for (std::size_t k = 1; k <= rows; ++k) {
      x.push_back(std::lerp(places[p - 1], places[p], static_cast<double>(k) / static_cast<double>(rows)));
    }
  }
  if (noise > 0.0) {
    for (double& value : x) value += error(generator);
  }
  return x;
}

TEST(TurningPoints, OfExactDataAreItsReversals) {
  EXPECT_EQ(turning_points(through({0, 2, 1.9, 2.5, 2.4}, 10, 0.0)), (std::vector<std::size_t>{0, 10, 20, 30, 40}));
  EXPECT_EQ(turning_points(Values{0, 10, 20, 40, 60, 80, 100, 120, 115, 110, 107}),
            (std::vector<std::size_t>{0, 7, 10}));
  EXPECT_EQ(turning_points(through({0, 1}, 5, 0.0)), (std::vector<std::size_t>{0, 5}));
  EXPECT_EQ(turning_points(Values{1.0}), std::vector<std::size_t>{0});
  EXPECT_TRUE(turning_points(Values{}).empty());
  EXPECT_EQ(turning_points(Values{1, 1, 1}), (std::vector<std::size_t>{0, 2}));
}

TEST(TurningPoints, OfExactDataAreThoseOfAStiffUnloadingToo) {
  // A stiff particle comes back by little. One reading that lies 1e-4 off is no turn.
  EXPECT_EQ(turning_points(through({0, 1, 0.9995, 1.5}, 10, 0.0)), (std::vector<std::size_t>{0, 10, 20, 30}));
  Values x = through({0, 1}, 10, 0.0);
  x.insert(x.begin() + 6, x[5] - 1e-4);
  EXPECT_EQ(turning_points(x), (std::vector<std::size_t>{0, 11}));
}

TEST(TurningPoints, AreNotThoseOfNoise) {
  // Ramps, a hold, and a small reload; the noise is larger than the steps of all of them.
  const Values places{0, 1, 1, 0.8, 0.9, 0.2};
  for (const double noise : {1e-4, 1e-3, 5e-3}) {
    const Values x = through(places, 2000, noise);
    const std::vector<std::size_t> turns = turning_points(x);
    ASSERT_EQ(turns.size(), 5U) << noise;
    const Values found{x[turns[1]], x[turns[2]], x[turns[3]]};
    const Values expected{1, 0.8, 0.9};
    for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(found[k], expected[k], 5 * noise) << noise;
    const std::vector<Turn> smoothed = turns_of(x, turns);
    EXPECT_NEAR(smoothed[1].x, 1.0, 4 * noise) << noise << ": a hold";
    for (const std::size_t k : {1U, 2U}) EXPECT_NEAR(smoothed[k + 1].x, expected[k], noise) << noise;
  }
}

// The median of a million rows is known to 0.2 %.
TEST(TurningPoints, HaveTheStandardDeviationOfNormalNoise) {
  EXPECT_NEAR(noise_in(through({0, 1}, 1000000, 0.01)), 0.01, 5e-3 * 0.01);
}

TEST(TurningPoints, OfExactDataAreWhereTheirRowsAre) {
  const Values x = through({0, 2, 1.9, 2.5, 2.4}, 10, 0.0);
  const std::vector<Turn> turns = turns_of(x, turning_points(x));
  const Values expected{0, 2, 1.9, 2.5, 2.4};
  ASSERT_EQ(turns.size(), expected.size());
  for (std::size_t k = 0; k < turns.size(); ++k) EXPECT_NEAR(turns[k].x, expected[k], 1e-14);
  EXPECT_EQ(noise_in(x), 0.0);
}

TEST(TurningPoints, OfRowsAtEqualTimesLieBetweenTheRows) {
  // Up to 1 at one speed and back at half of it; rows every 0.037 s miss the turn by any part of a step.
  for (const double delay : {0.0, 0.001, 0.009, 0.018, 0.024, 0.036}) {
    Values x;
    std::size_t rows_before = 0;
    for (double time = delay; time < 1.6; time += 0.037) {
      x.push_back(time < 1.0 ? time : 1.0 - 0.5 * (time - 1.0));
      if (time < 1.0 + 1e-12) ++rows_before;
    }
    const std::vector<Turn> turns = turns_of(x, turning_points(x));
    ASSERT_EQ(turns.size(), 3U) << delay;
    EXPECT_NEAR(turns[1].x, 1.0, 1e-12) << delay;
    EXPECT_EQ(turns[1].last_row + 1, rows_before) << delay;
  }
}

TEST(TurningPoints, OfUnevenRowsLieInTheExtremeRow) {
  const Values x{0, 0.2, 0.5, 0.6, 0.95, 1.0, 0.97, 0.8, 0.75};
  const std::vector<Turn> turns = turns_of(x, turning_points(x));
  ASSERT_EQ(turns.size(), 3U);
  EXPECT_EQ(turns[1].x, 1.0);
  EXPECT_EQ(turns[1].last_row, 5U);
}

TEST(TurningPoints, OfAHoldBetweenRowsLieOnTheHold) {
  const Values x{0.0, 0.3, 0.6, 0.9, 1.0, 1.0, 1.0, 1.0, 0.7, 0.4, 0.1};
  const std::vector<Turn> turns = turns_of(x, turning_points(x));
  ASSERT_EQ(turns.size(), 3U);
  EXPECT_NEAR(turns[1].x, 1.0, 1e-14);
}

TEST(TurningPoints, LieWhereTheRowsBesideThemLeadNotAtTheLargestNoise) {
  double sum_smoothed = 0.0;
  double sum_of_rows = 0.0;
  constexpr int k_samples = 50;
  for (unsigned seed = 0; seed < k_samples; ++seed) {
    const Values x = through({0, 1, 0.9}, 600, 1e-3, seed);
    const auto turns = turning_points(x);
    ASSERT_EQ(turns.size(), 3U) << seed;
    sum_smoothed += turns_of(x, turns)[1].x - 1.0;
    sum_of_rows += x[turns[1]] - 1.0;
  }
  EXPECT_NEAR(sum_smoothed / k_samples, 0.0, 2e-4) << "a fifth of the noise";
  EXPECT_GT(sum_of_rows / k_samples, 7e-4);
}

TEST(TurningPoints, InAHoldLieAtItsMean) {
  // Up in steps of five times the noise, a hold, and back.
  constexpr double k_noise = 2e-3;
  double sum = 0.0;
  constexpr int k_samples = 50;
  for (unsigned seed = 0; seed < k_samples; ++seed) {
    const Values up = through({0, 1}, 100, k_noise, seed);
    const Values held = through({1, 1}, 60, k_noise, seed + 1000);
    const Values down = through({1, 0.8}, 60, k_noise, seed + 2000);
    Values x(up.begin(), up.end() - 1);
    x.insert(x.end(), held.begin(), held.end());
    x.insert(x.end(), down.begin() + 1, down.end());
    EXPECT_NEAR(noise_in(x), k_noise, 0.35 * k_noise) << seed;
    const std::vector<Turn> turns = turns_of(x, turning_points(x));
    ASSERT_EQ(turns.size(), 3U) << seed;
    EXPECT_NEAR(static_cast<double>(turns[1].held_begin), 100.0, 3.0) << seed;
    EXPECT_NEAR(static_cast<double>(turns[1].held_end), 161.0, 3.0) << seed;
    EXPECT_EQ(turns[1].last_row, turns[1].held_end - 1) << seed;
    EXPECT_NEAR(turns[1].x, 1.0, 4.0 * k_noise / std::sqrt(60.0)) << seed;
    sum += turns[1].x - 1.0;
  }
  EXPECT_NEAR(sum / k_samples, 0.0, 0.1 * k_noise);
}

TEST(TurningPoints, OfALongHoldBesideSteepRampsIsOne) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    // Ramps come back by less than their noise, and do not show its size.
    Values x = through({0, 400, 400, 0}, 200, 0.0);
    const Values held = through({400, 400}, 1000, 0.0);
    x.insert(x.begin() + 200, held.begin(), held.end());
    std::mt19937 generator(seed);
    std::normal_distribution<double> error(0.0, 1.0);
    for (double& value : x) value += error(generator);
    EXPECT_EQ(turning_points(x).size(), 3U) << seed;
  }
}

TEST(TurningPoints, OfARampAndItsWayBackHaveNoHold) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    for (const double step : {0.2, 1.0, 5.0}) {
      const Values x = through({0, 1, 0.5}, static_cast<std::size_t>(1.0 / (step * 1e-3)), 1e-3, seed);
      for (const Turn& turn : turns_of(x, turning_points(x))) EXPECT_EQ(turn.held_rows(), 0U) << step << ' ' << seed;
    }
  }
}

TEST(TurningPoints, OfDataWithFewDigitsAreNotTheirFlicker) {
  // Steps of half the noise, displayed in whole numbers: most rows are equal to the one before.
  for (unsigned seed = 0; seed < 20; ++seed) {
    Values x = through({0, 80, 20}, 800, 0.2, seed);
    for (double& value : x) value = std::round(value);
    EXPECT_EQ(turning_points(x).size(), 3U) << seed;
    EXPECT_GT(noise_in(x), 0.3) << seed << ": a step of the display has a deviation of 0.29";
    EXPECT_LT(noise_in(x), 1.0) << seed;
  }
}

/// Turns of a path in noise, near its peak.
struct TurnsInNoise {
  double mean = 0.0;  ///< of x
  int holds = 0;
};

constexpr unsigned k_seeds = 40;
constexpr double k_peak = 80.0;
constexpr double k_deviation = 0.2;

/// Up to the peak in steps of 0.5, and then as a function of the row after it.
template <class Path>
TurnsInNoise turns_in_noise(Path after, int rows) {
  Values path = through({0, k_peak}, 160, 0.0);
  for (int row = 1; row <= rows; ++row) path.push_back(after(row));
  TurnsInNoise found;
  for (unsigned seed = 0; seed < k_seeds; ++seed) {
    Values x = path;
    std::mt19937 generator(seed);
    std::normal_distribution<double> error(0.0, k_deviation);
    for (double& value : x) value += error(generator);
    const std::vector<Turn> turns = turns_of(x, turning_points(x));
    EXPECT_EQ(turns.size(), 3U) << seed;
    found.mean += turns[1].x / k_seeds;
    if (turns[1].held_rows() > 0) ++found.holds;
  }
  return found;
}

TEST(TurningPoints, AreNotInADwellBelowThePeak) {
  for (const double depth : {3.0, 4.0, 5.0}) {
    // Down in 10 rows, held for 60, and down again.
    const auto path = [depth](int row) {
      if (row <= 10) return k_peak - 0.1 * depth * row;
      return k_peak - depth - 0.2 * std::max(row - 70, 0);
    };
    const TurnsInNoise found = turns_in_noise(path, 160);
    EXPECT_NEAR(found.mean, k_peak, 0.75 * k_deviation) << depth;
    EXPECT_LE(found.holds, 4) << depth << ": a tenth";
  }
}

TEST(TurningPoints, InAHoldAboveADwellLieOnTheHold) {
  const auto path = [](int row) {
    if (row <= 60) return k_peak;
    if (row <= 70) return k_peak - 0.3 * (row - 60);
    return k_peak - 3.0 - 0.2 * std::max(row - 130, 0);
  };
  const TurnsInNoise found = turns_in_noise(path, 220);
  EXPECT_NEAR(found.mean, k_peak, 0.25 * k_deviation);
  EXPECT_EQ(found.holds, static_cast<int>(k_seeds));
}

TEST(TurningPoints, OfAnUnloadingThatStartsLevelLieAtItsPeak) {
  const TurnsInNoise found = turns_in_noise([](int row) { return k_peak - 4.0 * (row / 60.0) * (row / 60.0); }, 99);
  EXPECT_NEAR(found.mean, k_peak, 0.6 * k_deviation);
}

TEST(TurningPoints, OfExactDataInAHoldHaveItsRows) {
  const Values x{0.0, 0.3, 0.6, 1.0, 1.0, 1.0, 1.0, 1.0, 0.7, 0.4, 0.1};
  const std::vector<Turn> turns = turns_of(x, turning_points(x));
  ASSERT_EQ(turns.size(), 3U);
  EXPECT_EQ(turns[1].held_begin, 3U);
  EXPECT_EQ(turns[1].held_end, 8U);
  EXPECT_EQ(turns[1].x, 1.0);
}

TEST(TurningPoints, OfManyEqualCyclesAreAllOfThem) {
  Values places;
  for (int cycle = 0; cycle < 20; ++cycle) places.insert(places.end(), {0.0, 1.0});
  EXPECT_EQ(turning_points(through(places, 5, 0.0)).size(), 40U);
  EXPECT_EQ(turning_points(through(places, 50, 1e-2)).size(), 40U);
}

}  // namespace
}  // namespace monograin::turns_test
