#include "history/energy.hpp"

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace monograin::energy_test {
namespace {

/// A history of one wall: time, work, stored energy and force in every row.
Table history(const std::vector<std::array<double, 4>>& rows) {
  Table table({{"time", "s", {}}, {"work", "J", {}}, {"stored_energy", "J", {}}, {"axial.force", "N", {}}});
  for (const auto& row : rows) table.append(row);
  return table;
}

TEST(DissipationFall, IsTheLargestFromARunningMaximumToALaterRow) {
  // Dissipation 0, 2, 1.5, 3, 2, 2.5.
  const auto fall = largest_dissipation_fall(
      history({{0, 0, 0, 0}, {1, 3, 1, 1}, {2, 4, 2.5, 1}, {3, 8, 5, 1}, {4, 7, 5, 1}, {5, 6, 3.5, 1}}), 1.0);
  ASSERT_TRUE(fall);
  EXPECT_EQ(fall->from, 3.0);
  EXPECT_EQ(fall->to, 4.0);
  EXPECT_EQ(fall->amount, 1.0);
  EXPECT_EQ(fall->scale, 8.0);
  EXPECT_EQ(fall->share(), 0.125);
}

TEST(DissipationFall, IsFoundWhereDissipationStaysPositive) {
  const auto fall = largest_dissipation_fall(history({{0, 0, 0, 0}, {1, 2, 0, 1}, {2, 2, 1, 1}}), 1.0);
  ASSERT_TRUE(fall);
  EXPECT_EQ(fall->amount, 1.0);
}

TEST(DissipationFall, IsFoundBetweenTheRowsBeforeAndAfterAnEvent) {
  const auto fall = largest_dissipation_fall(history({{0, 0, 0, 0}, {1, 2, 1, 1}, {1, 2, 1.25, 1}, {2, 3, 1, 1}}), 1.0);
  ASSERT_TRUE(fall);
  EXPECT_EQ(fall->from, 1.0);
  EXPECT_EQ(fall->to, 1.0);
  EXPECT_EQ(fall->amount, 0.25);
}

TEST(DissipationFall, BeginsAtTheLastRowOfItsMaximum) {
  const auto fall = largest_dissipation_fall(history({{0, 0, 0, 1}, {1, 1, 1, 1}, {2, 2, 2, 1}, {3, 3, 4, 1}}), 1.0);
  ASSERT_TRUE(fall);
  EXPECT_EQ(fall->from, 2.0);
  EXPECT_EQ(fall->to, 3.0);
}

TEST(DissipationFall, IsNoneWhereItOnlyRises) {
  EXPECT_FALSE(largest_dissipation_fall(history({{0, 0, 0, 0}, {1, 2, 1, 1}, {2, 3, 1, 1}}), 1.0));
}

TEST(DissipationFall, IsNoneWhereOverlapsAreRounded) {
  // A force of 1 N moves energy by its rounded overlap, a few 1e-16 R0.
  const auto rounded = [](double amount) { return history({{0, 0, 0, 1}, {1, 1e-15, amount, 1}}); };
  EXPECT_FALSE(largest_dissipation_fall(rounded(1.5e-15), 1.0));
  EXPECT_TRUE(largest_dissipation_fall(rounded(1e-13), 1.0));
  EXPECT_TRUE(largest_dissipation_fall(rounded(1.5e-15), 1e-3)) << "of a smaller particle it is more than rounding";
}

TEST(DissipationFall, IsNoneWithoutEnergies) {
  Table table({{"time", "s", {}}, {"axial.force", "N", {}}});
  table.append(std::array{0.0, 1.0});
  EXPECT_FALSE(largest_dissipation_fall(table, 1.0));
}

TEST(EnergyWarning, SaysWhenAndByHowMuch) {
  const Table table = history({{0, 0, 0, 0}, {1.5, 2, 0, 1}, {2.5, 2, 0.5, 1}});
  const auto warning = energy_warning(table, 1.0, "mdr", 0.0);
  ASSERT_TRUE(warning);
  EXPECT_EQ(
      *warning,
      "the law creates energy: dissipation falls by 0.5 J, 0.25 of the largest energy, from t = 1.5 s to t = 2.5 s; "
      "'monograin models mdr' says where it may");
}

TEST(EnergyWarning, IsSilentUpToAMillionthOfTheLargestEnergy) {
  const auto falling_by = [](double amount) {
    return energy_warning(history({{0, 0, 0, 0}, {1, 1, 0, 1}, {2, 1, amount, 1}}), 1.0, "mdr", 0.0);
  };
  EXPECT_FALSE(falling_by(0.99e-6));
  EXPECT_TRUE(falling_by(1.01e-6));
}

TEST(EnergyWarning, NamesTheToleranceWhereThatAllowsForAsMuch) {
  const Table table = history({{0, 0, 0, 0}, {1, 1, 0, 1}, {2, 1, 1e-4, 1}});
  EXPECT_NE(energy_warning(table, 1.0, "hertz", 1e-6)->find("may be off by as much at rtol = 1e-06"),
            std::string::npos);
  EXPECT_NE(energy_warning(table, 1.0, "hertz", 1e-7)->find("the law creates energy"), std::string::npos);
}

}  // namespace
}  // namespace monograin::energy_test
