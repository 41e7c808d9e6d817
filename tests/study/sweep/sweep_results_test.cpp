#include "study/sweep/sweep_results.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "history/table_file.hpp"
#include "study/sweep/sweep.hpp"
#include "study/sweep/sweep_file_test.hpp"
#include "study/sweep/sweep_journal.hpp"
#include "support/refusal.hpp"
#include "support/text_file.hpp"

namespace monograin::sweep_results_test {
namespace {

namespace fs = std::filesystem;

// Words among the keys and the results, and runs that are refused.
constexpr const char* k_sweep = R"toml(design = "grid"
[vary]
"material.poisson_ratio" = { from = 0.2, to = 0.6, points = 5 }
"loading.configuration" = { values = ["simple", "die", "hydrostatic"] }
[scenario]
model = "hertz"
[scenario.particle]
radius = "2 mm"
[scenario.material]
youngs_modulus = "1 GPa"
poisson_ratio = 0.3
[scenario.loading]
configuration = "simple"
steps = [{ displacement = "0.1 R0", duration = "1 s" }, { force = "0 N", duration = "1 s" }]
[scenario.output]
points = 4
)toml";

class SweepResults : public SweepFileTest {
 protected:
  [[nodiscard]] SweepOutcome run(const Sweep& sweep, const std::string& name, std::optional<ResultsFormat> format,
                                 int threads = 1, SweepShard shard = {}) const {
    return run_sweep(sweep,
                     {.folder = folder() / name, .threads = threads, .shard = shard, .progress = {}, .format = format});
  }
  [[nodiscard]] std::string bytes(const std::string& file) const { return read_text(folder() / file); }

  Sweep sweep_ = read(k_sweep);
};

TEST_F(SweepResults, AreTheSameTableInBothFormats) {
  EXPECT_EQ(run(sweep_, "csv", ResultsFormat::csv).results, folder() / "csv/results.csv");
  EXPECT_EQ(run(sweep_, "hdf5", ResultsFormat::hdf5).results, folder() / "hdf5/results.h5");
  EXPECT_FALSE(fs::exists(folder() / "hdf5/results.csv"));
  EXPECT_FALSE(fs::exists(folder() / "hdf5/sweep.journal"));
  Table csv = read_table_file(folder() / "csv/results.csv");
  Table hdf5 = read_table_file(folder() / "hdf5/results.h5");
  ASSERT_EQ(csv.header.size(), hdf5.header.size());
  EXPECT_EQ(csv.header.back().first, "rows_digest");
  csv.header.pop_back();
  hdf5.header.pop_back();
  EXPECT_EQ(csv.header, hdf5.header);
  EXPECT_EQ(csv_text(csv), csv_text(hdf5));
}

TEST_F(SweepResults, DoNotDependOnThreadsAndShards) {
  static_cast<void>(run(sweep_, "whole", ResultsFormat::hdf5));
  static_cast<void>(run(sweep_, "threads", ResultsFormat::hdf5, 4));
  EXPECT_EQ(bytes("threads/results.h5"), bytes("whole/results.h5"));
  EXPECT_EQ(run(sweep_, "shards", ResultsFormat::hdf5, 1, {2, 2}).results, fs::path());
  static_cast<void>(run(sweep_, "shards", ResultsFormat::hdf5, 1, {1, 2}));
  EXPECT_EQ(bytes("shards/results.h5"), bytes("whole/results.h5"));
}

TEST_F(SweepResults, AreConvertedWithoutARun) {
  static_cast<void>(run(sweep_, "csv", ResultsFormat::csv));
  static_cast<void>(run(sweep_, "hdf5", ResultsFormat::hdf5));
  const std::string csv = bytes("csv/results.csv");
  const std::string hdf5 = bytes("hdf5/results.h5");
  EXPECT_EQ(run(sweep_, "csv", ResultsFormat::hdf5).runs_now, 0U);
  EXPECT_EQ(bytes("csv/results.h5"), hdf5);
  EXPECT_EQ(bytes("csv/results.csv"), csv) << "they stay";
  const SweepOutcome back = run(sweep_, "hdf5", ResultsFormat::csv);
  EXPECT_EQ(back.runs_now, 0U);
  EXPECT_EQ(back.results, folder() / "hdf5/results.csv");
  EXPECT_EQ(bytes("hdf5/results.csv"), csv);
}

TEST_F(SweepResults, AreTakenInTheFormatThatIsThere) {
  static_cast<void>(run(sweep_, "hdf5", ResultsFormat::hdf5));
  const SweepOutcome again = run(sweep_, "hdf5", {});
  EXPECT_EQ(again.runs_before, 15U);
  EXPECT_EQ(again.results, folder() / "hdf5/results.h5");
  EXPECT_FALSE(fs::exists(folder() / "hdf5/results.csv"));
}

TEST_F(SweepResults, AreRefusedAfterAChange) {
  static_cast<void>(run(sweep_, "out", ResultsFormat::hdf5));
  const std::string whole = bytes("out/results.h5");
  const Sweep other = read(std::string("columns = [\"end.axial.force\"]\n") + k_sweep);
  std::vector<std::string> changed{whole + "more", whole.substr(0, whole.size() - 100)};
  for (const std::size_t at : {600UL, whole.size() / 2, whole.size() - 1}) {
    changed.push_back(whole);
    changed.back()[at] = static_cast<char>(changed.back()[at] ^ 1);
  }
  for (const std::string& text : changed) {
    write_text(folder() / "out/results.h5", text);
    for (const Sweep* sweep : std::initializer_list<const Sweep*>{&sweep_, &other}) {
      const std::string message = refusal<std::runtime_error>([&] { return run(*sweep, "out", {}).runs_now; });
      EXPECT_TRUE(contains(message, "results.h5: is damaged or edited")) << message;
    }
    EXPECT_EQ(bytes("out/results.h5"), text) << "they are left as they were";
  }
}

TEST_F(SweepResults, OfAnotherSweepAreReplacedInWhateverFormat) {
  const Sweep other = read(std::string("columns = [\"end.axial.force\"]\n") + k_sweep);
  static_cast<void>(run(sweep_, "out", ResultsFormat::csv));
  EXPECT_EQ(run(other, "out", ResultsFormat::hdf5).runs_now, 15U);
  EXPECT_FALSE(fs::exists(folder() / "out/results.csv"));
  EXPECT_EQ(run(sweep_, "out", {}).results, folder() / "out/results.h5") << "the format of those that were there";
  EXPECT_EQ(run(other, "out", ResultsFormat::csv).runs_now, 15U);
  EXPECT_FALSE(fs::exists(folder() / "out/results.h5"));
}

TEST_F(SweepResults, AreAloneAfterACallThatWasKilledBeforeItRemovedTheRest) {
  const Sweep other = read(std::string("histories = true\ncolumns = [\"end.axial.force\"]\n") + k_sweep);
  static_cast<void>(run(other, "out", ResultsFormat::csv));
  const std::string earlier = bytes("out/results.csv");
  fs::copy(folder() / "out/histories", folder() / "histories");
  static_cast<void>(run(sweep_, "out", ResultsFormat::hdf5));
  const std::string results = bytes("out/results.h5");
  // The folder as it is between the writing of results and the removal of what they make superfluous.
  write_text(folder() / "out/results.csv", earlier);
  write_text(folder() / "out/bands.csv", "# sweep: s\n");
  write_text(folder() / "out/sweep.json", "{\n  \"program\": \"monograin\",\n  \"sweep\": \"other\"\n}\n");
  fs::copy(folder() / "histories", folder() / "out/histories");
  { const SweepJournal journal(folder() / "out/sweep.journal", sweep_.digest); }
  const SweepOutcome again = run(sweep_, "out", ResultsFormat::hdf5);
  EXPECT_EQ(again.runs_now, 0U);
  EXPECT_EQ(again.results, folder() / "out/results.h5");
  EXPECT_EQ(bytes("out/results.h5"), results);
  EXPECT_TRUE(contains(bytes("out/sweep.json"), sweep_.digest)) << bytes("out/sweep.json");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder() / "out"), {}), 2) << "results.h5 and sweep.json";
}

TEST_F(SweepResults, KeepWhatWasMadeFromThemWhenTheyAreConverted) {
  static_cast<void>(run(sweep_, "out", ResultsFormat::csv));
  write_text(folder() / "out/sensitivity.csv", "# sweep: s\n");
  static_cast<void>(run(sweep_, "out", ResultsFormat::hdf5));
  EXPECT_TRUE(fs::exists(folder() / "out/sensitivity.csv"));
  // A call that was killed after a conversion removes neither format.
  { const SweepJournal journal(folder() / "out/sweep.journal", sweep_.digest); }
  static_cast<void>(run(sweep_, "out", {}));
  EXPECT_TRUE(fs::exists(folder() / "out/results.csv"));
  EXPECT_TRUE(fs::exists(folder() / "out/results.h5"));
  EXPECT_FALSE(fs::exists(folder() / "out/sweep.journal"));
}

TEST_F(SweepResults, ReplaceWhatAKilledProcessHasWrittenInPart) {
  fs::create_directories(folder() / "out/histories");
  for (const char* name : {".123-0.partial", "histories/.123-1.partial", "of-user.partial", ".user.partial",
                           ".2024-draft.partial", ".1-2-3.partial", ".7.partial"}) {
    write_text(folder() / "out" / name, "a part");
  }
  static_cast<void>(run(read(std::string("histories = true\n") + k_sweep), "out", ResultsFormat::hdf5));
  EXPECT_FALSE(fs::exists(folder() / "out/.123-0.partial"));
  EXPECT_FALSE(fs::exists(folder() / "out/histories/.123-1.partial"));
  for (const char* of_user :
       {"of-user.partial", ".user.partial", ".2024-draft.partial", ".1-2-3.partial", ".7.partial"}) {
    EXPECT_TRUE(fs::exists(folder() / "out" / of_user)) << of_user;
  }
}

TEST_F(SweepResults, DoNotReplaceAFileOfTheUser) {
  const std::string mine = "\x89HDF\r\n\x1a\nmine";
  fs::create_directory(folder() / "out");
  write_text(folder() / "out/results.h5", mine);
  const std::string message =
      refusal<std::runtime_error>([&] { return run(sweep_, "out", ResultsFormat::hdf5).runs_now; });
  EXPECT_TRUE(contains(message, "results.h5: monograin has not written this file")) << message;
  EXPECT_FALSE(fs::exists(folder() / "out/sweep.journal")) << "nothing was run";
  EXPECT_EQ(run(sweep_, "out", {}).results, folder() / "out/results.csv");
  EXPECT_EQ(bytes("out/results.h5"), mine);
}

TEST_F(SweepResults, WithLongNamesHaveTheirWholeHeader) {
  const std::string name(200, 'n');
  write_text(folder() / (name + ".toml"), k_sweep);
  const Sweep sweep = read_sweep(folder() / (name + ".toml"));
  static_cast<void>(run(sweep, "out", ResultsFormat::hdf5));
  EXPECT_EQ(read_hdf5(folder() / "out/results.h5").header_value("sweep"), name);
  EXPECT_EQ(run(sweep, "out", ResultsFormat::hdf5).runs_now, 0U);
}

TEST(ResultsFormatName, IsOneOfTwo) {
  EXPECT_EQ(results_format("csv"), ResultsFormat::csv);
  EXPECT_EQ(results_format("hdf5"), ResultsFormat::hdf5);
  EXPECT_EQ(results_format(""), std::nullopt);
  EXPECT_EQ(refusal<std::invalid_argument>([] { return results_format("xml"); }),
            "format = xml: expected one of csv, hdf5");
}

}  // namespace
}  // namespace monograin::sweep_results_test
