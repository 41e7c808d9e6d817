// `monograin sweep` as a process of its own.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "history/table.hpp"
#include "support/temporary_folder.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_sweep = R"toml(design = "grid"
histories = true
[vary]
"material.poisson_ratio" = { from = 0.2, to = 0.55, points = 40 }
"material.yield_stress" = { from = "20 MPa", to = "100 MPa", points = 10 }
"loading.configuration" = { values = ["simple", "die"] }
[scenario]
model = "mdr"
[scenario.particle]
radius = "1 mm"
[scenario.material]
youngs_modulus = "1 GPa"
[scenario.loading]
steps = [{ displacement = "0.2 R0", duration = "1 s" }]
[scenario.output]
points = 4
)toml";

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class SweepCommand : public ::testing::Test {
 protected:
  SweepCommand() { write("many.toml", k_sweep); }

  void write(const std::string& file, const std::string& text) const {
    std::ofstream(path(file), std::ios::binary) << text;
  }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }

  [[nodiscard]] int monograin(const std::string& arguments) const {
    const std::string command = "cd '" + folder_.path().string() + "' && '" MONOGRAIN_PROGRAM "' " + arguments +
                                " > stdout.txt 2> stderr.txt < /dev/null";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] std::string out() const { return read_text(path("stdout.txt")); }
  [[nodiscard]] std::string err() const { return read_text(path("stderr.txt")); }

  /// Starts a sweep into a folder and kills it after some time; whether it was still running.
  [[nodiscard]] bool start_and_kill(const std::string& output, std::chrono::microseconds delay) const {
    const pid_t child = fork();
    if (child == 0) {
      if (chdir(folder_.path().c_str()) != 0 || freopen("/dev/null", "w", stderr) == nullptr) _exit(9);
      execl(MONOGRAIN_PROGRAM, MONOGRAIN_PROGRAM, "sweep", "many.toml", "-j", "2", "-o", output.c_str(),
            static_cast<char*>(nullptr));
      _exit(9);
    }
    std::this_thread::sleep_for(delay);
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status);
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(SweepCommand, LeavesOneFileOfResults) {
  ASSERT_EQ(monograin("sweep many.toml -j 1 -o one"), 0) << err();
  EXPECT_TRUE(out().empty()) << out();
  EXPECT_EQ(err().find('\r'), std::string::npos) << "no progress bar where there is no terminal";
  EXPECT_EQ(read_csv(path("one/results.csv")).row_count(), 800U);
  ASSERT_EQ(monograin("sweep many.toml -j 2"), 0) << err();
  EXPECT_EQ(read_text(path("one/results.csv")), read_text(path("runs/many/results.csv")));
  EXPECT_FALSE(fs::exists(path("one/sweep.journal")));
}

TEST_F(SweepCommand, GoesOnAfterBeingKilledAtRandomMoments) {
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(monograin("sweep many.toml -j 2 -o whole"), 0) << err();
  const std::chrono::duration<double, std::micro> whole = std::chrono::steady_clock::now() - start;
  const std::string expected = read_text(path("whole/results.csv"));
  std::mt19937 random(1);
  for (int round = 0; round < 5; ++round) {
    const std::string output = "killed-" + std::to_string(round);
    // Several times each: in the first process, and in ones that go on.
    for (int kills = 0; kills < 3; ++kills) {
      const double share = 0.05 + 0.3 * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
      static_cast<void>(start_and_kill(output, std::chrono::microseconds(static_cast<long>(share * whole.count()))));
    }
    ASSERT_EQ(monograin("sweep many.toml -j 2 -o " + output), 0) << err();
    ASSERT_EQ(read_text(path(output + "/results.csv")), expected) << "round " << round;
    EXPECT_EQ(read_text(path(output + "/histories/7.csv")), read_text(path("whole/histories/7.csv")));
  }
  ASSERT_TRUE(start_and_kill("early", std::chrono::microseconds(static_cast<long>(0.3 * whole.count()))))
      << "the sweep is too short to be killed";
}

TEST_F(SweepCommand, ShardsOfSeveralProcessesMerge) {
  ASSERT_EQ(monograin("sweep many.toml -o whole"), 0) << err();
  ASSERT_EQ(monograin("sweep many.toml --shard 2/2 -o shards"), 0) << err();
  EXPECT_NE(err().find("400 of 800 are left to other shards"), std::string::npos) << err();
  ASSERT_EQ(monograin("sweep many.toml --shard 1/2 -o shards"), 0) << err();
  EXPECT_EQ(read_text(path("shards/results.csv")), read_text(path("whole/results.csv")));
}

TEST_F(SweepCommand, MakesADesignOnly) {
  const std::string scenario = (fs::path(MONOGRAIN_SOURCE_DIR) / "scenarios/sweeps/E1.toml").string();
  ASSERT_EQ(monograin("sweep '" + scenario + "' --design-only"), 0) << err();
  EXPECT_EQ(out(), "psi: 24.81485929\npsi_continuous: 76.51377831\n");
  const Table design = read_csv(path("runs/E1/design.csv"));
  EXPECT_EQ(design.row_count(), 60U);
  EXPECT_EQ(design.columns()[2].heading(), "material.strength[Pa]");
  EXPECT_FALSE(fs::exists(path("runs/E1/results.csv")));
}

TEST_F(SweepCommand, WritesNothingWhereTheFileIsAtFault) {
  std::string bad = k_sweep;
  bad.replace(bad.find("poisson_ratio"), 13, "poison_ratio");
  write("bad.toml", bad);
  EXPECT_EQ(monograin("sweep bad.toml"), 2);
  EXPECT_NE(err().find("bad.toml:4:1: unknown key 'poison_ratio'; did you mean 'poisson_ratio'?"), std::string::npos)
      << err();
  for (const char* arguments : {"sweep", "sweep missing.toml", "sweep many.toml --shard 3/2",
                                "sweep many.toml --shard x", "sweep many.toml --shard 1/2x", "sweep many.toml -j 0"}) {
    EXPECT_EQ(monograin(arguments), 2) << arguments;
  }
  EXPECT_FALSE(fs::exists(path("runs")));
}

TEST_F(SweepCommand, RunsEveryReadySweep) {
  for (const auto& entry : fs::directory_iterator(fs::path(MONOGRAIN_SOURCE_DIR) / "scenarios/sweeps")) {
    if (entry.path().extension() != ".toml") continue;
    const std::string name = entry.path().stem().string();
    ASSERT_EQ(monograin("sweep '" + entry.path().string() + "'"), 0) << name << ": " << err();
    const Table results = read_csv(path("runs/" + name + "/results.csv"));
    ASSERT_GE(results.row_count(), 40U) << name;
    for (std::size_t row = 0; row < results.row_count(); ++row) {
      EXPECT_EQ(results.word(row, *results.find("status")), "complete") << name << ", run " << row + 1;
    }
  }
}

}  // namespace
}  // namespace monograin
