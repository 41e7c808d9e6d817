// Rules between walls and between steps, which no schema can express.

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "scenario/support.hpp"

namespace monograin::walls_test {
namespace {

constexpr const char* k_two_walls =
    "[loading]\nconfiguration = \"walls\"\n"
    "[[loading.wall]]\nname = \"a\"\nnormal = [0, 0, 1]\nsteps = [%1]\n"
    "[[loading.wall]]\nname = \"%n\"\nnormal = %d\nsteps = [%2]\n";

std::string two_walls(std::string_view first, std::string_view second, std::string_view name = "b",
                      std::string_view direction = "[0, 0, -1]") {
  std::string text = with_loading(k_two_walls);
  const auto put = [&text](const char* mark, std::string_view value) { text.replace(text.find(mark), 2, value); };
  put("%1", first);
  put("%n", name);
  put("%d", direction);
  put("%2", second);
  return text;
}

constexpr const char* k_hold = "{ hold = true, duration = \"1 s\" }";

std::string cycle_of(int count) { return "{ cycle = " + std::to_string(count) + ", steps = [" + k_hold + "] }"; }

TEST(Walls, WithEqualProgramsAreAccepted) { EXPECT_EQ(faults_of(two_walls(k_hold, k_hold)).size(), 0U); }

TEST(Walls, NeedUniqueNames) {
  EXPECT_EQ(
      faults_of(two_walls(k_hold, k_hold, "a")),
      std::vector<std::string>{"die.toml:15:1: wall 'a' bears the name of an earlier wall; expected unique names"});
}

TEST(Walls, NeedDifferentNormals) {
  EXPECT_EQ(faults_of(two_walls(k_hold, k_hold, "b", "[0, 1e-10, 3]")),
            std::vector<std::string>{"die.toml:15:1: walls 'a' and 'b' have the same normal; expected different ones"});
  EXPECT_EQ(faults_of(two_walls(k_hold, k_hold, "b", "[0, 1e-8, 1]")).size(), 0U);
}

TEST(Walls, NeedEqualNumbersOfStepsWithCyclesWrittenOut) {
  const std::string twice = cycle_of(2);
  EXPECT_EQ(faults_of(two_walls(std::string(k_hold) + ", " + k_hold, twice)).size(), 0U);
  EXPECT_EQ(
      faults_of(two_walls(k_hold, twice)),
      std::vector<std::string>{"die.toml:15:1: wall 'b' has 2 steps where wall 'a' has 1; expected equal numbers"});
}

TEST(Walls, NeedEqualDurations) {
  const std::vector<std::string> faults = faults_of(two_walls(k_hold, "{ hold = true, duration = \"2 s\" }"));
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_TRUE(faults[0].starts_with("die.toml:18:10: step 1 of wall 'b' takes 2 s where that of wall 'a' takes 1 s"))
      << faults[0];
}

TEST(Walls, MayMixDurationsAndRates) {
  EXPECT_EQ(faults_of(two_walls(k_hold, "{ displacement = \"0.1 R0\", rate = 1e-3 }")).size(), 0U);
}

TEST(Walls, AreTwoHundredAtMost) {
  const auto walls = [](int count) {
    std::string text = "[loading]\nconfiguration = \"walls\"\n[[loading.steps]]\nhold = true\nduration = 1\n";
    for (int i = 0; i < count; ++i) {
      text += "[[loading.wall]]\nname = \"w" + std::to_string(i) + "\"\nnormal = [1, " + std::to_string(i) + ", 0]\n";
    }
    return with_loading(text);
  };
  EXPECT_EQ(faults_of(walls(200)).size(), 0U);
  EXPECT_EQ(faults_of(walls(201)).size(), 1U);
}

TEST(Walls, DoNotLeaveStepsThatNobodyFollows) {
  const std::string text = two_walls(k_hold, k_hold) + "[[loading.steps]]\nhold = true\nduration = 1\n";
  ASSERT_EQ(faults_of(text).size(), 1U);
  EXPECT_NE(faults_of(text)[0].find("no wall follows the steps of [loading]"), std::string::npos);
}

TEST(Cycles, AreLimitedInTotal) {
  const std::string nested = "{ cycle = 1000, steps = [" + cycle_of(1000) + "] }";
  const std::vector<std::string> faults =
      faults_of(with_loading("[loading]\nconfiguration = \"simple\"\nsteps = [" + nested + "]\n"));
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_NE(faults[0].find("1000000 ramps or more"), std::string::npos) << faults[0];
}

TEST(Cycles, AreLimitedOverAllWalls) {
  const std::vector<std::string> faults = faults_of(two_walls(cycle_of(60000), cycle_of(60000)));
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_NE(faults[0].find("120000 ramps or more"), std::string::npos) << faults[0];
}

}  // namespace
}  // namespace monograin::walls_test
