#include "history/external_program.hpp"

#include <gtest/gtest.h>

#include <csignal>

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
  EXPECT_EQ(run("sleep 0.25", [&calls] { ++calls; }), 0);
  EXPECT_GE(calls, 2);
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
