#include "history/external_program.hpp"

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>

#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin {
namespace {

TEST(FindProgram, SearchesTheFoldersOfThePath) {
  const auto shell = find_program("sh");
  ASSERT_TRUE(shell);
  EXPECT_TRUE(shell->is_absolute());
  EXPECT_FALSE(find_program("no-such-program-anywhere"));
}

class RunProgram : public ::testing::Test {
 protected:
  int run(const std::string& script, const std::function<void()>& meanwhile = {}) {
    return run_program("/bin/sh", {"-c", script}, folder_.path(), log(), meanwhile);
  }
  [[nodiscard]] std::filesystem::path log() const { return folder_.path() / "log"; }

 private:
  TemporaryFolder folder_;
};

TEST_F(RunProgram, GivesTheExitCodeAndCatchesAllOutput) {
  EXPECT_EQ(run("pwd; echo said >&2; exit 7"), 7);
  EXPECT_EQ(read_text(log()), log().parent_path().string() + "\nsaid\n");
}

TEST_F(RunProgram, GivesNoInput) { EXPECT_EQ(run("read line && exit 1; exit 0"), 0); }

TEST_F(RunProgram, GivesTheSignalThatEndsTheProgramAsANegativeNumber) { EXPECT_EQ(run("kill -TERM $$"), -SIGTERM); }

TEST_F(RunProgram, CallsBackUntilTheProgramEnds) {
  int calls = 0;
  EXPECT_EQ(run("sleep 0.6", [&calls] { ++calls; }), 0);
  EXPECT_GE(calls, 2);
}

TEST_F(RunProgram, RefusesALogThatExists) {
  write_text(log(), "mine");
  EXPECT_TRUE(contains(refusal<std::runtime_error>([&] { return run("true"); }), "cannot be started: File exists"));
  EXPECT_EQ(read_text(log()), "mine");
}

TEST_F(RunProgram, EndsTheProgramWhereTheCallerGivesUp) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THROW(static_cast<void>(run("sleep 20", [] { throw std::domain_error("enough"); })), std::domain_error);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST_F(RunProgram, EndsTheProgramWithTheProcessThatCalledIt) {
  const pid_t caller = fork();
  if (caller == 0) {
    static_cast<void>(run("echo $$ > process; exec sleep 20"));
    _exit(0);
  }
  const std::filesystem::path process = log().parent_path() / "process";
  while (read_text(process).empty()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  kill(caller, SIGKILL);
  waitpid(caller, nullptr, 0);
  const pid_t program = std::stoi(read_text(process));
  const auto goes_on = [&] { return read_text("/proc/" + std::to_string(program) + "/cmdline").starts_with("sleep"); };
  for (int i = 0; i < 200 && goes_on(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(goes_on());
}

TEST(RunProgramThatIsMissing, IsAnErrorThatNamesIt) {
  const TemporaryFolder folder;
  EXPECT_TRUE(contains(refusal<std::runtime_error>([&] {
                         static_cast<void>(run_program("/no/such", {}, folder.path(), folder.path() / "log"));
                       }),
                       "/no/such cannot be started: No such file"));
}

}  // namespace
}  // namespace monograin
