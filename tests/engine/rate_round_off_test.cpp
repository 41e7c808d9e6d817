#include "engine/rate_round_off.hpp"

#include <gtest/gtest.h>

namespace monograin::rate_round_off_test {
namespace {

/// Series of a rate of one with an error of alternating sign.
LegendreSeries rate_with(double error) {
  LegendreSamples samples{};
  for (std::size_t j = 0; j < samples.size(); ++j) samples[j] = 1.0 + (j % 2 == 0 ? error : -error);
  LegendreSeries series;
  series.fit(LegendreNodes::many(), samples);
  return series;
}

/// Reports a refused piece and its half.
void refuse(RateRoundOff& round_off, double begin, double error, double error_of_half) {
  round_off.report(rate_with(error), begin, 0.1, true);
  round_off.report(rate_with(error_of_half), begin, 0.05, false);
}

TEST(RateRoundOff, IsKnownAfterThreePiecesThatDoNotImproveByHalving) {
  RateRoundOff round_off;
  for (const double begin : {0.1, 0.2}) refuse(round_off, begin, 1e-9, 0.9e-9);
  EXPECT_EQ(round_off.known(), 0.0);
  refuse(round_off, 0.3, 2e-9, 2e-9);
  EXPECT_EQ(round_off.known(), rate_with(2e-9).tail());
}

TEST(RateRoundOff, IsNotThatOfASingularity) {
  RateRoundOff round_off;
  for (const double begin : {0.1, 0.2, 0.3, 0.4}) refuse(round_off, begin, 1e-9, 0.71e-9);
  EXPECT_EQ(round_off.known(), 0.0);
}

TEST(RateRoundOff, IsNotThatOfPiecesLittleShorter) {
  RateRoundOff round_off;
  for (const double begin : {0.1, 0.2, 0.3, 0.4}) {
    round_off.report(rate_with(1e-9), begin, 0.1, true);
    round_off.report(rate_with(1e-9), begin, 0.06, false);
  }
  EXPECT_EQ(round_off.known(), 0.0);
}

}  // namespace
}  // namespace monograin::rate_round_off_test
