// What the program does where memory ends, wherever that is.

#ifdef MONOGRAIN_FAILING_NEW

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/command_test.hpp"

namespace monograin::failing_allocation_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_small = R"(model = "hertz"
particle = { radius = 0.01 }
material = { youngs_modulus = 1e9, poisson_ratio = 0.3 }
loading = { configuration = "simple", steps = [{ displacement = 1e-4, duration = 1 }] }
output = { points = 3 }
)";

class FailingAllocation : public CommandTest {
 protected:
  void SetUp() override { write_text(path("small.toml"), k_small); }
};

// Sanitizers reserve more address space than any limit.
TEST_F(FailingAllocation, OfALimitedProcessIsAMessageAndExitFour) {
  // A million rows of about ten columns do not fit, whether the limit is met at set-up, in the run or at its output.
  for (const char* kilobytes : {"60000", "80000", "120000"}) {
    const Outcome outcome =
        shell(std::string("ulimit -v ") + kilobytes + "; $M run small.toml -o out --set output.points=1000000");
    EXPECT_EQ(outcome.code, 4) << kilobytes << outcome.err;
    EXPECT_NE(outcome.err.find("there is not enough memory"), std::string::npos) << kilobytes << outcome.err;
    EXPECT_FALSE(fs::exists(path("out"))) << kilobytes;
  }
}

TEST_F(FailingAllocation, EndsWithAMessageAndLeavesTheOldRunWhole) {
  ASSERT_EQ(monograin("run small.toml -o out").code, 0) << text("stderr.txt");
  const std::string history = text("out/history.csv");
  const auto whole = files();
  // A process that ends where a library lets no exception through leaves a hidden folder, which the next run clears.
  const auto seen_files = [this] {
    auto names = files();
    std::erase_if(names, [](const std::string& name) { return name.starts_with(".out."); });
    return names;
  };
  // Each of the first hundred allocations, then one of every hundredth part: a run makes some thousands.
  bool has_failed = false;
  for (long at = 1; at < 1'000'000; at += 1 + at / 100) {
    setenv("LD_PRELOAD", MONOGRAIN_FAILING_NEW, 1);
    setenv("MONOGRAIN_FAILING_ALLOCATION", std::to_string(at).c_str(), 1);
    const Outcome outcome = monograin("run small.toml -o out");
    unsetenv("LD_PRELOAD");
    unsetenv("MONOGRAIN_FAILING_ALLOCATION");
    EXPECT_EQ(text("out/history.csv"), history) << "allocation " << at;
    EXPECT_EQ(seen_files(), whole) << "allocation " << at;
    if (outcome.err.find("no allocation has failed") != std::string::npos) break;
    has_failed = true;
    EXPECT_EQ(outcome.code, 4) << "allocation " << at << ": " << outcome.err;
    EXPECT_FALSE(outcome.err.empty()) << "allocation " << at;
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_TRUE(has_failed);
  ASSERT_EQ(monograin("run small.toml -o out").code, 0) << text("stderr.txt");
  EXPECT_EQ(files().size(), whole.size());
}

}  // namespace
}  // namespace monograin::failing_allocation_test

#endif
