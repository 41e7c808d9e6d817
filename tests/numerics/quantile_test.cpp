#include "numerics/quantile.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace monograin::quantile_test {
namespace {

TEST(Quantile, LiesBetweenOrderStatistics) {
  const std::vector<double> values{1.0, 2.0, 4.0, 8.0};
  EXPECT_EQ(quantile(values, 0.0), 1.0);
  EXPECT_EQ(quantile(values, 1.0), 8.0);
  EXPECT_DOUBLE_EQ(quantile(values, 1.0 / 3.0), 2.0);
  EXPECT_DOUBLE_EQ(quantile(values, 0.5), 3.0);
  EXPECT_DOUBLE_EQ(quantile(values, 5.0 / 6.0), 6.0);
}

TEST(Quantile, OfOneValueIsThatValue) {
  for (const double share : {0.0, 0.3, 1.0}) EXPECT_EQ(quantile(std::vector{5.0}, share), 5.0);
}

}  // namespace
}  // namespace monograin::quantile_test
