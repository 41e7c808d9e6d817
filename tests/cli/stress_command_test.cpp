// `monograin stress` as a process of its own.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "support/temporary_folder.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

class StressCommand : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] int monograin(const std::string& arguments) const {
    const std::string command = "cd '" + folder_.path().string() + "' && '" MONOGRAIN_PROGRAM "' " + arguments +
                                " > stdout.txt 2> stderr.txt < /dev/null";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(StressCommand, PrintsTheReportThatItLeaves) {
  ASSERT_EQ(monograin("stress --seed 32 --scenes 10 --time 2min -j 2 -o out"), 0) << text("stdout.txt");
  EXPECT_EQ(text("stdout.txt"), text("out/report.txt"));
  EXPECT_NE(text("stdout.txt").find("seed 32: 10 scenes"), std::string::npos);
  EXPECT_EQ(text("stderr.txt").find('\r'), std::string::npos) << "no progress bar where there is no terminal";
}

TEST_F(StressCommand, ReplacesAnEarlierReportButNothingElse) {
  ASSERT_EQ(monograin("stress --seed 32 --scenes 1 --time 1min -o out"), 0);
  ASSERT_EQ(monograin("stress --seed 32 --scenes 1 --time 1min -o out"), 0);
  fs::create_directories(path("mine"));
  std::ofstream(path("mine/notes.txt")) << "keep";
  EXPECT_EQ(monograin("stress --seed 32 --scenes 1 --time 1min -o mine"), 2);
  EXPECT_EQ(text("mine/notes.txt"), "keep");
}

TEST_F(StressCommand, ChecksAScenarioThatIsGiven) {
  EXPECT_EQ(monograin("stress '" MONOGRAIN_SOURCE_DIR "/scenarios/die.toml'"), 0) << text("stdout.txt");
  EXPECT_NE(text("stdout.txt").find("die.toml: passes (complete)"), std::string::npos);
}

TEST_F(StressCommand, ExitsWithFourWhereARuleIsBroken) {
  // The walls of the class need different times: the run stops, and that is no limit of the model.
  std::ofstream(path("faulty.toml")) << R"(model = "hertz"
particle = { radius = 1 }
material = { youngs_modulus = 1, poisson_ratio = 0.3 }
[loading]
configuration = "walls"
[[loading.wall]]
name = "a"
normal = [0, 0, 1]
steps = [{ displacement = 0.1, rate = 0.1 }]
[[loading.wall]]
name = "b"
normal = [1, 0, 0]
steps = [{ displacement = 0.2, rate = 0.1 }]
)";
  EXPECT_EQ(monograin("stress faulty.toml"), 4);
  EXPECT_NE(text("stdout.txt").find("unstated-limit"), std::string::npos) << text("stdout.txt");
}

TEST_F(StressCommand, RefusesATimeThatIsNone) {
  EXPECT_EQ(monograin("stress --time 0s"), 2);
  EXPECT_EQ(monograin("stress --time 3parsec"), 2);
  EXPECT_FALSE(fs::exists(path("runs")));
}

}  // namespace
}  // namespace monograin
