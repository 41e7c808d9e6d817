// What sweeps do with what they find in their folder: journals, and results of other sweeps.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>

#include "study/sweep/sweep.hpp"
#include "study/sweep/sweep_file_test.hpp"
#include "study/sweep/sweep_journal.hpp"
#include "support/refusal.hpp"
#include "support/text_file.hpp"

namespace monograin::sweep_folder_test {
namespace {

namespace fs = std::filesystem;

// The runs of the last two ratios are refused.
constexpr const char* k_sweep = R"toml([vary]
"material.poisson_ratio" = { values = [0.2, 0.3, 0.4, 0.6, 0.7] }
[scenario]
model = "hertz"
particle.radius = "2 mm"
material.youngs_modulus = "1 GPa"
loading = { configuration = "simple", steps = [{ displacement = "0.1 R0", duration = "1 s" }] }
output.points = 4
)toml";

class SweepFolder : public SweepFileTest {
 protected:
  [[nodiscard]] SweepOutcome run(const Sweep& sweep, SweepShard shard = {},
                                 std::optional<ResultsFormat> format = {}) const {
    return run_sweep(sweep, {.folder = out(), .threads = 1, .shard = shard, .progress = {}, .format = format});
  }
  [[nodiscard]] fs::path out() const { return folder() / "out"; }
  [[nodiscard]] std::set<std::string> names() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(out())) names.insert(entry.path().filename());
    return names;
  }

  Sweep sweep_ = read(k_sweep);
  Sweep other_ = read(std::string("columns = [\"end.axial.force\"]\n") + k_sweep);
};

TEST_F(SweepFolder, WithAJournalOfAnotherSweepStaysAsItIs) {
  static_cast<void>(run(sweep_, {1, 2}));
  const std::string journal = read_text(out() / "sweep-1-of-2.journal");
  const std::string message = refusal<std::runtime_error>([&] { return run(other_, {2, 2}).runs_now; });
  EXPECT_TRUE(contains(message, "sweep-1-of-2.journal: is the journal of another sweep")) << message;
  EXPECT_TRUE(contains(message, "and holds 3 finished runs; remove it to begin anew")) << message;
  EXPECT_EQ(names(), std::set<std::string>{"sweep-1-of-2.journal"});
  EXPECT_EQ(read_text(out() / "sweep-1-of-2.journal"), journal);
  EXPECT_EQ(run(sweep_, {2, 2}).runs_missing, 0U) << "the right sweep goes on";
}

TEST_F(SweepFolder, CountsTheEarlyEndsOfAllCallsAndShards) {
  const SweepOutcome shard = run(sweep_, {1, 2});
  EXPECT_EQ(shard.runs_ended_early, 1U);
  EXPECT_EQ(early_ends_text(sweep_, shard), "1 of 3 runs refused, stopped or failed (columns status and reason)");
  EXPECT_EQ(run(sweep_, {1, 2}).runs_ended_early, 1U) << "nothing was run";
  const SweepOutcome last = run(sweep_, {2, 2});
  EXPECT_EQ(last.runs_now, 2U);
  EXPECT_EQ(early_ends_text(sweep_, last), "2 of 5 runs refused, stopped or failed (columns status and reason)");
  for (const ResultsFormat format : {ResultsFormat::csv, ResultsFormat::hdf5}) {
    const SweepOutcome again = run(sweep_, {}, format);
    EXPECT_EQ(again.runs_now, 0U);
    EXPECT_EQ(again.runs_ended_early, 2U);
  }
  EXPECT_TRUE(early_ends_text(sweep_, {}).empty());
}

TEST_F(SweepFolder, WithoutALockIsNotTakenForOneThatAnotherProcessUses) {
  const int first = open(folder().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const int second = open(folder().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const auto message = [](int descriptor) {
    return refusal<std::runtime_error>([&] {
      lock(descriptor, "f", false);
      return 0;
    });
  };
  lock(first, "f", true);
  EXPECT_EQ(message(second), "f: another process is at work on this sweep");
  close(first);
  lock(second, "f", false);
  close(second);
  const std::string none = message(-1);
  EXPECT_TRUE(contains(none, "f: cannot be locked: Bad file descriptor; choose a folder on a local disk")) << none;
}

}  // namespace
}  // namespace monograin::sweep_folder_test
