// `monograin stress` as a process of its own.

#include <gtest/gtest.h>

#include <filesystem>

#include "cli/command_test.hpp"

namespace monograin::stress_command_test {
namespace {

namespace fs = std::filesystem;

class StressCommand : public CommandTest {};

TEST_F(StressCommand, PrintsTheReportThatItLeaves) {
  ASSERT_EQ(monograin("stress --seed 33 --scenes 10 --time 2min -j 2 -o out").code, 0) << text("stdout.txt");
  EXPECT_EQ(text("stdout.txt"), text("out/report.txt"));
  EXPECT_NE(text("stdout.txt").find("seed 33: 10 scenes"), std::string::npos);
  EXPECT_EQ(text("stderr.txt").find('\r'), std::string::npos) << "no progress bar where there is no terminal";
}

TEST_F(StressCommand, ReplacesAnEarlierReportButNothingElse) {
  ASSERT_EQ(monograin("stress --seed 33 --scenes 1 --time 1min -o out").code, 0);
  ASSERT_EQ(monograin("stress --seed 33 --scenes 1 --time 1min -o out").code, 0);
  fs::create_directories(path("mine"));
  write_text(path("mine/report.txt"), "keep");
  EXPECT_EQ(monograin("stress --seed 33 --scenes 1 --time 1min -o mine").code, 2);
  EXPECT_EQ(text("mine/report.txt"), "keep");
}

TEST_F(StressCommand, ChecksAScenarioThatIsGiven) {
  EXPECT_EQ(monograin("stress '" MONOGRAIN_SOURCE_DIR "/scenarios/die.toml'").code, 0) << text("stdout.txt");
  EXPECT_NE(text("stdout.txt").find("die.toml: passes (complete)"), std::string::npos);
}

TEST_F(StressCommand, ExitsWithFourWhereARuleIsBroken) {
  // The walls need different times, which only a run shows: the run stops, and that is no limit of the model.
  write_text(path("faulty.toml"), R"(model = "hertz"
particle = { radius = 1 }
material = { youngs_modulus = 1, poisson_ratio = 0.3 }
[loading]
configuration = "walls"
[[loading.wall]]
name = "a"
normal = [0, 0, 1]
steps = [{ force = 0.1, duration = 1 }, { displacement = 0.1, rate = 0.1 }]
[[loading.wall]]
name = "b"
normal = [1, 0, 0]
steps = [{ displacement = 0.2, rate = 0.2 }, { hold = true, duration = 7 }]
)");
  EXPECT_EQ(monograin("stress faulty.toml").code, 4);
  EXPECT_NE(text("stdout.txt").find("unstated-limit"), std::string::npos) << text("stdout.txt");
}

TEST_F(StressCommand, DrawsScenesOfNamedModelsOnly) {
  ASSERT_EQ(monograin("stress --model nonlocal,hertz --seed 5 --scenes 6 --time 2min -o out").code, 0);
  const std::string report = text("out/report.txt");
  EXPECT_NE(report.find("seed 5 of hertz,nonlocal: 6 scenes"), std::string::npos) << report;
  EXPECT_EQ(report.find("mdr"), std::string::npos) << report;
}

TEST_F(StressCommand, RefusesAModelThatThereIsNot) {
  EXPECT_EQ(monograin("stress --model herz").code, 2);
  EXPECT_NE(text("stderr.txt").find("there is no model 'herz'; did you mean 'hertz'?; available: hertz, "),
            std::string::npos)
      << text("stderr.txt");
  EXPECT_FALSE(fs::exists(path("runs")));
}

TEST_F(StressCommand, RefusesATimeThatIsNone) {
  EXPECT_EQ(monograin("stress --time 0s").code, 2);
  EXPECT_EQ(monograin("stress --time 3parsec").code, 2);
  EXPECT_FALSE(fs::exists(path("runs")));
}

}  // namespace
}  // namespace monograin::stress_command_test
