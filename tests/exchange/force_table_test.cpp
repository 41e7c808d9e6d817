#include "exchange/force_table.hpp"

#include <gtest/gtest.h>

#include "exchange/motion_of_run.hpp"
#include "support/refusal.hpp"
#include "support/test_run.hpp"

namespace monograin {
namespace {

TEST(ForceTable, DividesTheHistoryIntoBranchesWithOneForceForEachDisplacement) {
  const Motion motion = motion_of_run(
      with_points(mdr_scenario(Configuration::simple, 50.0, 0.3, {ramp(0.1), hold(), ramp(0.08), ramp(0.12)}), 10));
  const Table table = force_table(motion, std::nullopt);
  const std::vector<double> branch = table.column("branch");
  const std::vector<double> x = table.column("axial.displacement[m]");
  const std::vector<double> y = table.column("axial.force[N]");
  EXPECT_EQ(branch.front(), 1.0);
  EXPECT_EQ(branch.back(), 3.0);
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (branch[i] == branch[i - 1]) {
      EXPECT_GT((x[i] - x[i - 1]) * (branch[i] == 2.0 ? -1.0 : 1.0), 0.0) << i;
    } else {
      EXPECT_EQ(x[i], x[i - 1]);
      EXPECT_NEAR(y[i], y[i - 1], 1e-14);
    }
  }
  EXPECT_EQ(x.back(), 0.12);
  EXPECT_EQ(y.back(), motion.instants.back().contacts.front().force);
}

TEST(ForceTable, TakesTheWallThatIsAskedForOrTheFirstThatMoves) {
  const Motion motion = motion_of_run(
      between(mdr_scenario(Configuration::simple, 50.0, 0.3, {}),
              {wall("floor", -Eigen::Vector3d::UnitZ()), wall("punch", Eigen::Vector3d::UnitZ(), path({0.1}))}));
  EXPECT_TRUE(force_table(motion, std::nullopt).find("punch.force"));
  EXPECT_TRUE(contains(refusal<std::invalid_argument>([&] { return force_table(motion, "roof"); }),
                       "there is no contact class 'roof'; the scene has floor, punch"));
}

TEST(ForceTable, SaysThatTheWallDoesNotMove) {
  const Motion motion = motion_of_run(mdr_scenario(Configuration::die, 50.0, 0.3, path({0.1})));
  EXPECT_EQ(refusal<std::invalid_argument>([&] { return force_table(motion, "lateral"); }),
            "the walls of contact class 'lateral' do not move");
}

TEST(ForceTable, SaysThatNoWallMoves) {
  const Motion motion = motion_of_run(hertz_scenario(Configuration::simple, {hold()}));
  EXPECT_EQ(refusal<std::invalid_argument>([&] { return force_table(motion, std::nullopt); }), "no wall moves");
}

}  // namespace
}  // namespace monograin
