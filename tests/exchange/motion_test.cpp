#include "exchange/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exchange/motion_of_run.hpp"
#include "support/refusal.hpp"
#include "support/scenario_texts.hpp"
#include "support/test_run.hpp"

namespace monograin {
namespace {

TEST(Motion, PutsEveryWallWhereItStandsAndLetsThemMove) {
  const Motion motion = motion_of_run(parse_scenario(k_late_wall_text, "late.toml"));
  ASSERT_EQ(motion.walls.size(), 2U);
  EXPECT_EQ(motion.walls[1].name, "late");
  const MotionInstant& start = motion.instants.front();
  EXPECT_DOUBLE_EQ(motion.distance(motion.walls[0], start), 0.01);
  EXPECT_DOUBLE_EQ(motion.distance(motion.walls[1], start), 0.01002);
  const MotionInstant& end = motion.instants.back();
  EXPECT_DOUBLE_EQ(motion.distance(motion.walls[0], end), 0.0099);
  EXPECT_DOUBLE_EQ(motion.distance(motion.walls[1], end), 0.0099);
}

TEST(Motion, HasOneInstantForEachTimeWithTheStateAfterAnEvent) {
  const CheckedScenario scenario = mdr_scenario(Configuration::simple, 50.0, 0.3, path({0.1, 0.0}));
  const RunRecord record = record_run(scenario);
  const Motion motion = motion_of(scenario, record.history);
  EXPECT_LT(motion.instants.size(), record.history.row_count());
  for (std::size_t i = 1; i < motion.instants.size(); ++i) {
    EXPECT_GT(motion.instants[i].time, motion.instants[i - 1].time);
  }
  EXPECT_EQ(motion.instants.back().time, 2.0);
}

TEST(Motion, MeasuresDistancesFromACentreThatMoves) {
  CheckedScenario scenario =
      between(mdr_scenario(Configuration::simple, 50.0, 0.3, {}),
              {wall("floor", -Eigen::Vector3d::UnitZ()), wall("punch", Eigen::Vector3d::UnitZ(), path({0.2}))});
  scenario.loading.centre_is_free = true;
  const Motion motion = motion_of_run(scenario);
  const MotionInstant& end = motion.instants.back();
  EXPECT_NEAR(end.centre.z(), -0.1, 1e-9);
  EXPECT_NEAR(motion.distance(motion.walls[0], end), 0.9, 1e-9);
  EXPECT_NEAR(motion.distance(motion.walls[1], end), 0.9, 1e-9);
  EXPECT_GT(end.radius, 1.0);
}

TEST(Motion, HasNoContactRadiusOfALawWithoutOne) {
  const Motion motion = motion_of_run(read_scenario(MONOGRAIN_SOURCE_DIR "/scenarios/compressible.toml"));
  EXPECT_TRUE(std::isnan(motion.instants.back().contacts.front().radius));
  EXPECT_GT(motion.instants[motion.instants.size() / 4].contacts.front().force, 0.0);
  EXPECT_EQ(motion.instants.back().radius, motion.initial_radius);
}

TEST(Motion, RefusesAModelWithoutWalls) {
  const CheckedScenario scenario = read_scenario(MONOGRAIN_SOURCE_DIR "/scenarios/packing.toml");
  EXPECT_TRUE(contains(refusal<std::invalid_argument>([&] { return motion_of_run(scenario); }), "packing"));
}

}  // namespace
}  // namespace monograin
