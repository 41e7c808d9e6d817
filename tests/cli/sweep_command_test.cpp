// `monograin sweep` as a process of its own.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "cli/command_test.hpp"
#include "history/run.hpp"
#include "history/table.hpp"
#include "support/refusal.hpp"

namespace monograin::sweep_command_test {
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

class SweepCommand : public CommandTest {
 protected:
  SweepCommand() { write_text(path("many.toml"), k_sweep); }

  /// Whether the sweep was still running.
  bool start_and_kill_sweep(const std::string& output, std::chrono::microseconds delay) const {
    return start_and_kill({"sweep", "many.toml", "-j", "2", "-o", output}, delay);
  }
};

TEST_F(SweepCommand, LeavesOneFileOfResults) {
  ASSERT_EQ(monograin("sweep many.toml -j 1 -o one").code, 0) << text("stderr.txt");
  EXPECT_TRUE(text("stdout.txt").empty()) << text("stdout.txt");
  EXPECT_EQ(text("stderr.txt").find('\r'), std::string::npos) << "no progress bar where there is no terminal";
  EXPECT_EQ(read_csv(path("one/results.csv")).row_count(), 800U);
  ASSERT_EQ(monograin("sweep many.toml -j 2 --quiet").code, 0) << text("stderr.txt");
  EXPECT_EQ(text("stderr.txt"),
            "warning: many: 120 of 800 runs refused, stopped or failed (columns status and reason)\n");
  EXPECT_EQ(text("one/results.csv"), text("runs/many/results.csv"));
  EXPECT_FALSE(fs::exists(path("one/sweep.journal")));
  ASSERT_EQ(monograin("sweep many.toml -o one").code, 0) << text("stderr.txt");
  EXPECT_EQ(text("stderr.txt"),
            "many: 0 runs, 800 were there already; 120 of 800 runs refused, stopped or failed (columns status and "
            "reason) -> one/results.csv\n");
}

TEST_F(SweepCommand, LeavesARecordThatRepeatsItWithoutItsFiles) {
  fs::create_directory(path("scenes"));
  fs::create_directory(path("elsewhere"));
  write_text(path("scenes/law.csv"), "overlap_over_radius,pressure_over_yield\n0,2.75\n0.1,2.2\n0.3,1.5\n0.6,1.1\n");
  write_text(path("scenes/waves.csv"), "time[s],displacement[um]\n0,0\n1,100\n2,50\n");
  write_text(path("scenes/scene.toml"), R"toml(model = "mdr"
[particle]
radius = "1 mm"
[material]
youngs_modulus = "1 GPa"
poisson_ratio = 0.3
yield_stress = "40 MPa"
[mdr]
pressure_table = "law.csv"
[loading]
configuration = "simple"
steps = [{ displacement = { table = "waves.csv", time = "time[s]", value = "displacement[um]" } }]
)toml");
  write_text(path("values.csv"), "material.yield_stress[MPa]\n20\n40\n");
  write_text(path("sweep.toml"), R"(title = "batch 12"
scenario = "scenes/scene.toml"
design = "table"
table = "values.csv"
)");
  ASSERT_EQ(monograin("sweep sweep.toml -o one").code, 0) << text("stderr.txt");
  const auto record = nlohmann::json::parse(text("one/sweep.json"));
  EXPECT_EQ(record.at("title"), "batch 12");
  EXPECT_TRUE(record.at("citation").contains("mdr")) << record.dump(2);
  EXPECT_EQ(record.at("versions").at("monograin"), version());
  write_text(path("elsewhere/sweep.toml"), record.at("text").get<std::string>());
  fs::create_directory(path("elsewhere/scenes"));
  for (const auto& file : record.at("files")) {
    const auto name = file.at("name").get<std::string>();
    const bool is_of_sweep = file.at("key") == "scenario" || file.at("key") == "table";
    write_text(path(is_of_sweep ? "elsewhere/" + name : "elsewhere/scenes/" + name),
               file.at("text").get<std::string>());
  }
  ASSERT_EQ(monograin("sweep elsewhere/sweep.toml -o two").code, 0) << text("stderr.txt");
  EXPECT_EQ(text("two/results.csv"), text("one/results.csv"));
  EXPECT_EQ(text("two/sweep.json"), text("one/sweep.json"));
}

TEST_F(SweepCommand, LeavesARecordOfSomeoneElseAsItIs) {
  fs::create_directory(path("mine"));
  write_text(path("mine/sweep.json"), "{}\n");
  EXPECT_EQ(monograin("sweep many.toml -o mine").code, 2);
  EXPECT_TRUE(contains(text("stderr.txt"), "sweep.json")) << text("stderr.txt");
  EXPECT_EQ(text("mine/sweep.json"), "{}\n");
}

TEST_F(SweepCommand, GoesOnAfterBeingKilledAtRandomMoments) {
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(monograin("sweep many.toml -j 2 -o whole").code, 0) << text("stderr.txt");
  const std::chrono::duration<double, std::micro> whole = std::chrono::steady_clock::now() - start;
  const std::string expected = text("whole/results.csv");
  std::mt19937 random(1);
  for (int round = 0; round < 5; ++round) {
    const std::string output = "killed-" + std::to_string(round);
    // Several times each: in the first process, and in ones that go on.
    for (int kills = 0; kills < 3; ++kills) {
      const double share = 0.05 + 0.3 * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
      start_and_kill_sweep(output, std::chrono::microseconds(static_cast<long>(share * whole.count())));
    }
    ASSERT_EQ(monograin("sweep many.toml -j 2 -o " + output).code, 0) << text("stderr.txt");
    ASSERT_EQ(text(output + "/results.csv"), expected) << "round " << round;
    EXPECT_EQ(text(output + "/histories/7.csv"), text("whole/histories/7.csv"));
  }
  // A busy machine makes the first sweep longer than those that follow it.
  ASSERT_TRUE(std::ranges::any_of(std::array{0.3, 0.1, 0.03, 0.01}, [&](double share) {
    return start_and_kill_sweep("early-" + std::to_string(share),
                                std::chrono::microseconds(static_cast<long>(share * whole.count())));
  })) << "the sweep is too short to be killed";
}

TEST_F(SweepCommand, ShardsOfSeveralProcessesMerge) {
  ASSERT_EQ(monograin("sweep many.toml -o whole").code, 0) << text("stderr.txt");
  ASSERT_EQ(monograin("sweep many.toml --shard 2/2 -o shards").code, 0) << text("stderr.txt");
  EXPECT_NE(text("stderr.txt").find("400 of 800 are left to other shards"), std::string::npos) << text("stderr.txt");
  ASSERT_EQ(monograin("sweep many.toml --shard 1/2 -o shards").code, 0) << text("stderr.txt");
  EXPECT_EQ(text("shards/results.csv"), text("whole/results.csv"));
}

TEST_F(SweepCommand, MakesADesignOnly) {
  const std::string scenario = (fs::path(MONOGRAIN_SOURCE_DIR) / "scenarios/sweeps/E1.toml").string();
  ASSERT_EQ(monograin("sweep '" + scenario + "' --design-only").code, 0) << text("stderr.txt");
  EXPECT_EQ(text("stdout.txt"), "psi: 24.81485929\npsi_continuous: 76.51377831\n");
  const Table design = read_csv(path("runs/E1/design.csv"));
  EXPECT_EQ(design.row_count(), 60U);
  EXPECT_EQ(design.columns()[2].heading(), "material.strength[Pa]");
  EXPECT_FALSE(fs::exists(path("runs/E1/results.csv")));
}

TEST_F(SweepCommand, WritesNothingWhereTheFileIsAtFault) {
  std::string bad = k_sweep;
  bad.replace(bad.find("poisson_ratio"), 13, "poison_ratio");
  write_text(path("bad.toml"), bad);
  EXPECT_EQ(monograin("sweep bad.toml").code, 2);
  EXPECT_NE(text("stderr.txt").find("bad.toml:4:1: unknown key 'poison_ratio'; did you mean 'poisson_ratio'?"),
            std::string::npos)
      << text("stderr.txt");
  for (const char* arguments : {"sweep", "sweep missing.toml", "sweep many.toml --shard 3/2",
                                "sweep many.toml --shard x", "sweep many.toml --shard 1/2x", "sweep many.toml -j 0"}) {
    EXPECT_EQ(monograin(arguments).code, 2) << arguments;
  }
  EXPECT_FALSE(fs::exists(path("runs")));
}

constexpr const char* k_indices = R"toml(design = "saltelli"
samples = 16
results = ["max.axial.force", "end.work / max.work"]
[vary]
"material.yield_stress" = { mean = "20 MPa", std = "2 MPa" }
"material.poisson_ratio" = { from = 0.2, to = 0.4 }
"loading.configuration" = { values = ["simple"] }
)toml";

/// With the scenario of the other sweep.
std::string index_file(const std::string& changed = k_indices) {
  const std::string sweep = k_sweep;
  return changed + sweep.substr(sweep.find("[scenario]"));
}

TEST_F(SweepCommand, LeavesResultsThatPlotDraws) {
  write_text(path("indices.toml"), index_file());
  ASSERT_EQ(monograin("sweep indices.toml").code, 0) << text("stderr.txt");
  ASSERT_EQ(monograin("plot runs/indices -o f.svg").code, 0) << text("stderr.txt");
  EXPECT_NE(text("f.gp").find("material.yield\\_stress [MPa]"), std::string::npos) << text("f.gp");
  EXPECT_NE(text("f.gp").find("max.axial.force [N]"), std::string::npos) << text("f.gp");
}

TEST_F(SweepCommand, SaysWhichKeyTheSpreadIsDueTo) {
  write_text(path("indices.toml"), index_file());
  ASSERT_EQ(monograin("sensitivity indices.toml").code, 0) << text("stderr.txt");
  const std::string shown = text("stdout.txt");
  EXPECT_NE(shown.find("max.axial.force, 16 samples, 95 % intervals\n"), std::string::npos) << shown;
  EXPECT_NE(shown.find("\nmaterial.yield_stress "), std::string::npos) << shown;
  const Table table = read_csv(path("runs/indices/sensitivity.csv"));
  ASSERT_EQ(table.row_count(), 6U);
  EXPECT_EQ(table.word(1, *table.find("key")), "material.poisson_ratio");
  EXPECT_GT(table.at(0, *table.find("total")), table.at(1, *table.find("total")));
  EXPECT_TRUE(fs::exists(path("runs/indices/sensitivity.svg")));

  std::string other = k_indices;
  other.replace(other.find("end.work / max.work"), 19, "max.axial.fore");
  write_text(path("indices.toml"), index_file(other));
  EXPECT_NE(monograin("sensitivity indices.toml").code, 0);
  EXPECT_NE(text("stderr.txt").find("80 were there already"), std::string::npos) << text("stderr.txt");
  EXPECT_NE(text("stderr.txt").find("did you mean 'max.axial.force'?"), std::string::npos) << text("stderr.txt");
}

TEST_F(SweepCommand, SaysNothingOfSensitivitiesWithoutTheirDesign) {
  EXPECT_EQ(monograin("sensitivity many.toml").code, 2);
  EXPECT_NE(text("stderr.txt").find("says nothing of sensitivities; expected \"saltelli\" for Sobol indices"),
            std::string::npos)
      << text("stderr.txt");
  EXPECT_FALSE(fs::exists(path("runs")));
}

TEST_F(SweepCommand, WarnsOfSamplesThatHaveNoValue) {
  std::string beyond = k_indices;
  beyond.replace(beyond.find("to = 0.4"), 8, "to = 0.6");
  write_text(path("indices.toml"), index_file(beyond));
  EXPECT_EQ(monograin("sensitivity indices.toml").code, 0) << text("stderr.txt");
  EXPECT_NE(text("stderr.txt").find("of 16 samples count"), std::string::npos) << text("stderr.txt");
}

TEST_F(SweepCommand, WarnsOfResultsThatAreAlwaysTheSame) {
  std::string indices = k_indices;
  indices.replace(indices.find("end.work / max.work"), 19, "max.axial.force - max.axial.force");
  write_text(path("indices.toml"), index_file(indices));
  EXPECT_EQ(monograin("sensitivity indices.toml").code, 0) << text("stderr.txt");
  EXPECT_NE(text("stderr.txt").find("it is 0 in every run, and has no sensitivities"), std::string::npos)
      << text("stderr.txt");
  EXPECT_EQ(text("stderr.txt").find("ended before"), std::string::npos) << text("stderr.txt");
}

TEST_F(SweepCommand, GivesAConstantResultNoSensitivitiesAndTheOthersTheirs) {
  for (const char* constant : {"2", "max(max.axial.force)"}) {
    std::string indices = k_indices;
    indices.replace(indices.find("end.work / max.work"), 19, constant);
    write_text(path("indices.toml"), index_file(indices));
    EXPECT_EQ(monograin("sensitivity indices.toml").code, 0) << text("stderr.txt");
    EXPECT_NE(text("stderr.txt").find(" in every run, and has no sensitivities"), std::string::npos)
        << text("stderr.txt");
    const Table table = read_csv(path("runs/indices/sensitivity.csv"));
    for (std::size_t row = 0; row < table.row_count(); ++row) {
      const bool is_constant = table.word(row, *table.find("result")) == constant;
      EXPECT_EQ(std::isnan(table.at(row, *table.find("total"))), is_constant) << constant << ", row " << row;
    }
  }
}

TEST_F(SweepCommand, WarnsOfRunsThatEndedBeforeTheirPrograms) {
  std::string deep = index_file();
  const std::size_t at = deep.find("displacement = ");
  deep.replace(at, deep.find(',', at) - at, "displacement = \"0.49 R0\"");
  deep.replace(deep.find("[\"simple\"]"), 10, "[\"hydrostatic\"]");
  write_text(path("indices.toml"), deep);
  EXPECT_EQ(monograin("sensitivity indices.toml").code, 0) << text("stderr.txt");
  EXPECT_NE(text("stderr.txt").find("runs ended before their programs did"), std::string::npos) << text("stderr.txt");
}

TEST_F(SweepCommand, WritesHdf5ThatEveryCommandReads) {
  write_text(path("indices.toml"), index_file());
  const Outcome swept = monograin("sweep indices.toml --format hdf5");
  ASSERT_EQ(swept.code, 0) << swept.err;
  EXPECT_TRUE(contains(swept.err, "80 runs in ")) << swept.err;
  EXPECT_TRUE(contains(swept.err, " -> runs/indices/results.h5\n")) << swept.err;
  EXPECT_EQ(std::distance(fs::directory_iterator(path("runs/indices")), {}), 2) << "results.h5 and sweep.json";
  ASSERT_EQ(monograin("plot runs/indices -o hdf5.svg").code, 0) << text("stderr.txt");
  const Outcome analysed = monograin("sensitivity indices.toml");
  ASSERT_EQ(analysed.code, 0) << analysed.err;
  EXPECT_TRUE(contains(analysed.err, "80 were there already -> runs/indices/results.h5")) << analysed.err;

  ASSERT_EQ(monograin("sensitivity indices.toml -o csv").code, 0) << text("stderr.txt");
  EXPECT_EQ(analysed.out, text("stdout.txt"));
  ASSERT_EQ(monograin("plot csv -o csv.svg").code, 0) << text("stderr.txt");
  EXPECT_EQ(text("hdf5.dat"), text("csv.dat"));
  const Outcome converted = monograin("sweep indices.toml --format csv");
  EXPECT_TRUE(contains(converted.err, "0 runs, 80 were there already -> runs/indices/results.csv")) << converted.err;
  EXPECT_EQ(text("runs/indices/results.csv"), text("csv/results.csv"));
}

TEST_F(SweepCommand, RefusesAFormatThatItDoesNotHave) {
  const Outcome refused = monograin("sweep many.toml --format xml");
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(
      contains(refused.err, "--format = xml is not what it takes; expected: Format of the results, csv or hdf5"))
      << refused.err;
  EXPECT_FALSE(fs::exists(path("runs")));
}

TEST_F(SweepCommand, SaysWhatToInstallWhereHdf5CannotBeLoaded) {
  // Files that are no library stand before that of the system, whatever its version.
  const Outcome refused = shell(
      "mkdir lib; for v in $(seq 100 400); do : > lib/libhdf5_serial.so.$v; : > lib/libhdf5.so.$v; done\n"
      "LD_LIBRARY_PATH=lib monograin sweep many.toml --format hdf5");
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(contains(refused.err, "HDF5 cannot be used: ")) << refused.err;
  EXPECT_TRUE(contains(refused.err, "apt-get install libhdf5-103-1), or use the format csv\n")) << refused.err;
  EXPECT_FALSE(fs::exists(path("runs"))) << "nothing was run";
}

TEST_F(SweepCommand, LeavesNoPartOfResultsThatItCannotWrite) {
  const std::string indices = index_file();
  write_text(path("few.toml"), "design = \"lhs\"\nruns = 5\n" + indices.substr(indices.find("[vary]")));
  ASSERT_EQ(monograin("sweep few.toml --format hdf5 -o whole").code, 0) << text("stderr.txt");
  // Larger than the journal, smaller than the results.
  const Outcome full = shell("trap '' XFSZ; ulimit -f 8; monograin sweep few.toml --format hdf5 -o out");
  EXPECT_EQ(full.code, 2);
  EXPECT_TRUE(contains(full.err, "out/results.h5: cannot be written: File too large")) << full.err;
  EXPECT_EQ(full.err.find("HDF5-DIAG"), std::string::npos) << full.err;
  EXPECT_TRUE(fs::exists(path("out/sweep.journal")));
  EXPECT_EQ(std::distance(fs::directory_iterator(path("out")), {}), 1);
  const Outcome again = monograin("sweep few.toml --format hdf5 -o out");
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_TRUE(contains(again.err, "0 runs, 5 were there already -> out/results.h5")) << again.err;
  EXPECT_EQ(text("out/results.h5"), text("whole/results.h5"));
}

TEST_F(SweepCommand, WritesHdf5AfterBeingKilledAtAnyMoment) {
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(monograin("sweep many.toml --format hdf5 -o whole").code, 0) << text("stderr.txt");
  const std::chrono::duration<double, std::micro> whole = std::chrono::steady_clock::now() - start;
  std::vector<std::string> arguments{"sweep", "many.toml", "--format", "hdf5", "-o", "killed"};
  // Also while the results are written, at the end.
  for (const double share : {0.3, 0.7, 0.8, 0.85, 0.9, 0.95}) {
    start_and_kill(arguments, std::chrono::microseconds(static_cast<long>(share * whole.count())));
    EXPECT_TRUE(!fs::exists(path("killed/results.h5")) || text("killed/results.h5") == text("whole/results.h5"));
  }
  ASSERT_EQ(monograin("sweep many.toml --format hdf5 -o killed").code, 0) << text("stderr.txt");
  EXPECT_EQ(text("killed/results.h5"), text("whole/results.h5"));
  EXPECT_EQ(std::distance(fs::directory_iterator(path("killed")), {}), 3) << "histories, results and sweep.json";
}

TEST_F(SweepCommand, RunsEveryReadySweep) {
  for (const auto& entry : fs::directory_iterator(fs::path(MONOGRAIN_SOURCE_DIR) / "scenarios/sweeps")) {
    if (entry.path().extension() != ".toml") continue;
    const std::string name = entry.path().stem().string();
    ASSERT_EQ(monograin("sweep '" + entry.path().string() + "'").code, 0) << name << ": " << text("stderr.txt");
    const Table results = read_csv(path("runs/" + name + "/results.csv"));
    ASSERT_GE(results.row_count(), 40U) << name;
    for (std::size_t row = 0; row < results.row_count(); ++row) {
      EXPECT_EQ(results.word(row, *results.find("status")), "complete") << name << ", run " << row + 1;
    }
  }
}

}  // namespace
}  // namespace monograin::sweep_command_test
