// Programs of several walls: what the text shows of their durations.

#include "scenario/program_rules.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "scenario/support.hpp"

namespace monograin::program_rules_test {
namespace {

using Lines = std::vector<std::string>;

std::string two_walls(std::string_view first, std::string_view second, std::string_view gap = "0") {
  return with_loading(
      "[loading]\nconfiguration = \"walls\"\n[[loading.wall]]\nname = \"a\"\nnormal = [0, 0, 1]\nsteps = [" +
      std::string(first) + "]\n[[loading.wall]]\nname = \"b\"\nnormal = [0, 0, -1]\ngap = " + std::string(gap) +
      "\nsteps = [" + std::string(second) + "]\n");
}

constexpr std::string_view k_hold = "{ hold = true, duration = \"1 s\" }";

TEST(Programs, WithRatesNeedEqualDurations) {
  EXPECT_EQ(
      faults_of(two_walls("{ displacement = 1e-4, rate = 1e-4 }", "{ displacement = 2e-4, rate = 1e-4 }")),
      Lines{"die.toml:19:10: step 1 of wall 'b' takes 2 s where that of wall 'a' takes 1 s; steps end together, so "
            "expected equal durations"});
  EXPECT_EQ(faults_of(two_walls("{ displacement = 1e-4, rate = 1e-4 }", "{ displacement = 2e-4, rate = 2e-4 }")),
            Lines{});
}

TEST(Programs, BeginAtTheGapsOfTheirWalls) {
  EXPECT_EQ(faults_of(two_walls(k_hold, "{ displacement = 1e-4, rate = 2e-4 }", "1e-4")), Lines{});
  EXPECT_EQ(faults_of(two_walls(k_hold, "{ displacement = 1e-4, rate = 2e-4 }")).size(), 1U);
}

TEST(Programs, GoOnWhereTheLastStepHasLed) {
  const std::string loads = "{ displacement = 3e-4, duration = 1 }, ";
  EXPECT_EQ(faults_of(two_walls(std::string(k_hold) + "," + std::string(k_hold),
                                loads + "{ displacement = 1e-4, rate = 2e-4 }")),
            Lines{});
  EXPECT_EQ(faults_of(two_walls(std::string(k_hold) + "," + std::string(k_hold),
                                loads + "{ displacement = 1e-4, rate = 1e-4 }"))
                .size(),
            1U);
}

TEST(Programs, AreLeftToARunWhereAConditionOfAnyWallMayEndAStep) {
  EXPECT_EQ(faults_of(two_walls("{ hold = true, duration = 1, until = { force = 1 } }, " + std::string(k_hold),
                                "{ displacement = 3e-4, duration = 1 }, { displacement = 1e-4, rate = 1e-4 }")),
            Lines{});
}

TEST(Programs, DoNotWithdrawOneWallBesideAnotherThatHasADuration) {
  EXPECT_EQ(
      faults_of(two_walls("{ detach = true, rate = 1e-3 }", k_hold)),
      Lines{"die.toml:19:10: in step 1 wall 'b' is held for 1 s where wall 'a' is withdrawn until its contact is "
            "lost (detach); steps end together, so expected detach for both, or a displacement with a duration and "
            "until = { event = \"contact-lost\" } in its place"});
  EXPECT_EQ(faults_of(two_walls("{ detach = true, rate = 1e-3 }", "{ detach = true, rate = 1e-3 }")), Lines{});
  EXPECT_EQ(
      faults_of(two_walls("{ detach = true, rate = 1e-3 }", "{ detach = true, rate = 2e-3 }")),
      Lines{"die.toml:19:10: step 1 withdraws wall 'b' at 0.002 m/s and wall 'a' at 0.001 m/s; steps end together, "
            "so expected equal rates"});
}

TEST(Programs, OfASineAndOfAHoldNeedEqualDurations) {
  const std::string sine = "{ displacement = { sine = { mean = 0, amplitude = 1e-4, frequency = 1, cycles = 2 } } }";
  EXPECT_EQ(faults_of(two_walls(sine, k_hold)),
            Lines{"die.toml:19:10: step 1 of wall 'b' takes 1 s where that of wall 'a' takes 2 s; steps end together, "
                  "so expected equal durations"});
  EXPECT_EQ(faults_of(two_walls(sine, "{ hold = true, duration = \"2 s\" }")), Lines{});
  EXPECT_EQ(faults_of(two_walls(sine, "{ detach = true, rate = 1 }")),
            Lines{"die.toml:19:10: in step 1 wall 'b' is withdrawn until its contact is lost (detach) where wall 'a' "
                  "moves for 2 s; steps end together, so expected detach for both, or a displacement with a duration "
                  "and until = { event = \"contact-lost\" } in its place"});
}

}  // namespace
}  // namespace monograin::program_rules_test
