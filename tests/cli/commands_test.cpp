// Every command, run as a user runs it: as a process of its own, in a folder of its own.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "cli/command_test.hpp"
#include "history/run.hpp"
#include "history/table.hpp"
#include "support/refusal.hpp"
#include "support/svg_figure.hpp"

namespace monograin::commands_test {
namespace {

namespace fs = std::filesystem;

class Commands : public CommandTest {};

constexpr const char* k_small = R"(title = "small"
model = "mdr"
[particle]
radius = "1 mm"
[material]
youngs_modulus = "1 GPa"
poisson_ratio = 0.3
yield_stress = "20 MPa"
[loading]
configuration = "simple"
[[loading.steps]]
displacement = "0.2 R0"
duration = "1 s"
[[loading.steps]]
displacement = "0.15 R0"
duration = "1 s"
[output]
points = 10
)";

TEST_F(Commands, RunWithoutAFileLeavesTheDefaultSceneInRunsDie) {
  const Outcome outcome = monograin("run");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.empty()) << outcome.out;
  for (const char* file : {"history.csv", "events.csv", "run.json"})
    EXPECT_TRUE(fs::exists(path("runs/die") / file)) << file;
  const Table history = read_csv(path("runs/die/history.csv"));
  EXPECT_EQ(history.header_value("status"), "complete");
  EXPECT_EQ(history.columns()[0].heading(), "time[s]");
  EXPECT_EQ(history.columns()[1].heading(), "step");
  EXPECT_EQ(history.columns()[2].heading(), "row");
  for (const char* column : {"apparent_radius[m]", "volume[m3]", "work[J]", "stored_energy[J]", "dissipation[J]",
                             "axial.displacement[m]", "axial.overlap[m]", "axial.force[N]", "axial.contact_radius[m]",
                             "axial.pressure[Pa]", "axial.regime", "lateral.force[N]", "lateral.regime"}) {
    EXPECT_TRUE(history.find(column)) << column;
  }
}

TEST_F(Commands, RunAndPlotDrawTheCommittedFiguresOfTheFirstScenes) {
  for (const std::string name : {"die", "cel"}) {
    const std::string of_project = MONOGRAIN_SOURCE_DIR;
    ASSERT_EQ(monograin("run '" + of_project + "/scenarios/" + name + ".toml'").code, 0);
    ASSERT_EQ(monograin("plot runs/" + name + " -o " + name + ".svg").code, 0);
    const auto found = differences(read_svg(path(name + ".svg")), read_svg(of_project + "/plots/" + name + ".svg"));
    EXPECT_TRUE(found.empty()) << found.size() << " differences: " << found.front();
  }
}

TEST_F(Commands, RunWritesWhatIsNeededToRepeatIt) {
  write_text(path("small.toml"), k_small);
  ASSERT_EQ(monograin("run small.toml -o runs/small --set output.points=5").code, 0);
  const auto json = nlohmann::json::parse(text("runs/small/run.json"));
  EXPECT_EQ(json["status"], "complete");
  EXPECT_EQ(json["classes"],
            nlohmann::json::parse(R"([{"name": "axial", "multiplicity": 2, "walls": ["axial-z+", "axial-z-"],
                                       "normals": [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]}])"));
  EXPECT_EQ(json["integrator"]["asked"], "auto");
  EXPECT_EQ(json["integrator"]["used"], "direct");
  EXPECT_EQ(json["scenario"]["text"], k_small);
  EXPECT_EQ(json["scenario"]["overrides"], nlohmann::json::parse(R"(["output.points=5"])"));
  for (const char* key : {"skipped", "statistics", "timings_s", "warnings", "versions"})
    EXPECT_TRUE(json.contains(key)) << key;
  for (const char* key : {"parse", "setup", "integration", "output"})
    EXPECT_GE(json["timings_s"][key].get<double>(), 0.0) << key;
}

TEST_F(Commands, TheSameInputGivesTheSameBytes) {
  write_text(path("small.toml"), k_small);
  ASSERT_EQ(monograin("run small.toml -o first").code, 0);
  ASSERT_EQ(monograin("run small.toml -o second").code, 0);
  EXPECT_EQ(text("first/history.csv"), text("second/history.csv"));
  EXPECT_EQ(text("first/events.csv"), text("second/events.csv"));
}

TEST_F(Commands, AFaultInOneFileRunsNothingAtAll) {
  write_text(path("good.toml"), k_small);
  std::string bad = k_small;
  bad.replace(bad.find("yield_stress"), 12, "yeild_stress");
  write_text(path("bad.toml"), bad);
  const Outcome outcome = monograin("run good.toml bad.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("bad.toml:8:1: "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("yield_stress"), std::string::npos) << outcome.err;
  EXPECT_EQ(files().size(), 2U);
}

TEST_F(Commands, OverridesAreCheckedLikeTheFile) {
  write_text(path("small.toml"), k_small);
  const Outcome outcome = monograin("run small.toml --set material.poisson_ratio=0.7");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("material.poisson_ratio=0.7"), std::string::npos) << outcome.err;
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(Commands, ARunThatLeavesTheDomainKeepsItsHistory) {
  write_text(path("small.toml"), k_small);
  const Outcome outcome = monograin(
      "run small.toml -o runs/small --set loading.configuration=hydrostatic --set loading.steps[0].displacement='0.35 "
      "R0'");
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_NE(outcome.err.find("stopped"), std::string::npos) << outcome.err;
  const Table history = read_csv(path("runs/small/history.csv"));
  EXPECT_EQ(history.header_value("status"), "stopped");
  EXPECT_GT(history.row_count(), 5U);
  const Table events = read_csv(path("runs/small/events.csv"));
  EXPECT_EQ(events.word(events.row_count() - 1, *events.find("event")), "singular-growth");
}

TEST_F(Commands, TheReadyGranuleRunsAndStopsAtTheEndOfItsLaw) {
  const std::string file = MONOGRAIN_SOURCE_DIR "/scenarios/compressible.toml";
  ASSERT_EQ(monograin("run " + file).code, 0);
  const Table history = read_csv(path("runs/compressible/history.csv"));
  EXPECT_TRUE(history.find("axial.force"));
  EXPECT_FALSE(history.find("axial.contact_radius") || history.find("axial.pressure"));
  const auto run = nlohmann::json::parse(text("runs/compressible/run.json"));
  EXPECT_TRUE(run.at("scenario").at("files").contains("compressible.unloading_table")) << run.dump(2);
  EXPECT_TRUE(run.at("limit").is_null()) << run.dump(2);
  const Outcome beyond =
      monograin("run " + file + " -o runs/compressible --set loading.steps[2].displacement='0.6 R0'");
  EXPECT_EQ(beyond.code, 3) << beyond.err;
  EXPECT_NE(beyond.err.find("half the radius (displacement/R0 = 0.5), at 'axial'"), std::string::npos) << beyond.err;
  EXPECT_EQ(nlohmann::json::parse(text("runs/compressible/run.json")).at("limit"), "source-data-end");
  const Table events = read_csv(path("runs/compressible/events.csv"));
  EXPECT_EQ(events.word(events.row_count() - 1, *events.find("event")), "limit");
  const Outcome refused = monograin("run " + file + " --set material.stiffness_ratio=2");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("stiffness_ratio = 2 is outside 3 to 500"), std::string::npos) << refused.err;
  const Outcome parameters = monograin("models compressible --parameters " + file);
  EXPECT_EQ(parameters.code, 0);
  for (const char* line : {"3.89935775057427", "0.1131952", "46.63881116246"}) {
    EXPECT_NE(parameters.out.find(line), std::string::npos) << line << "\n" << parameters.out;
  }
}

TEST_F(Commands, ANewRunReplacesTheOldOneAsAWhole) {
  write_text(path("small.toml"), k_small);
  ASSERT_EQ(monograin("run small.toml --plot").code, 0);
  ASSERT_TRUE(fs::exists(path("runs/small/figure.svg")));
  ASSERT_EQ(monograin("run small.toml").code, 0);
  EXPECT_FALSE(fs::exists(path("runs/small/figure.svg")));
  EXPECT_EQ(std::distance(fs::directory_iterator(path("runs")), fs::directory_iterator{}), 1);
}

TEST_F(Commands, AFolderOfTheUserTakesARunBesideOtherFiles) {
  fs::create_directory(path("mine"));
  write_text(path("mine/small.toml"), k_small);
  write_text(path("mine/notes.txt"), "keep me");
  EXPECT_EQ(monograin("run mine/small.toml -o mine").code, 0);
  EXPECT_EQ(text("mine/notes.txt"), "keep me");
  EXPECT_EQ(text("mine/small.toml"), k_small);
  EXPECT_TRUE(fs::exists(path("mine/history.csv")));
  EXPECT_EQ(monograin("run mine/small.toml -o mine").code, 0) << "a run replaces its own files";
}

TEST_F(Commands, AFileOfTheUserIsNotReplacedByARun) {
  write_text(path("small.toml"), k_small);
  fs::create_directory(path("mine"));
  write_text(path("mine/history.csv"), "keep me");
  const Outcome outcome = monograin("run small.toml -o mine");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("mine/history.csv: monograin has not written this file"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(text("mine/history.csv"), "keep me");
  EXPECT_FALSE(fs::exists(path("mine/run.json")));
}

TEST_F(Commands, AFileOfTheUserStopsAllRunsBeforeTheFirstBegins) {
  write_text(path("small.toml"), k_small);
  write_text(path("other.toml"), k_small);
  fs::create_directories(path("out/other"));
  write_text(path("out/other/events.csv"), "keep me");
  const Outcome outcome = monograin("run small.toml other.toml -o out");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("other/events.csv: monograin has not written this file"), std::string::npos)
      << outcome.err;
  EXPECT_FALSE(fs::exists(path("out/small")));
  EXPECT_EQ(text("out/other/events.csv"), "keep me");
}

TEST_F(Commands, AResultOfAnotherKindIsNotReplacedByARun) {
  write_text(path("small.toml"), k_small);
  ASSERT_EQ(monograin("run small.toml -o r").code, 0);
  fs::rename(path("r/run.json"), path("r/calibration.json"));
  const Outcome outcome = monograin("run small.toml -o r");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("holds a result of another kind (no run.json)"), std::string::npos) << outcome.err;
}

TEST_F(Commands, AKillAtAnyMomentLeavesTheLastGoodResult) {
  write_text(path("small.toml"), k_small);
  ASSERT_EQ(monograin("run small.toml").code, 0);
  const std::string good = text("runs/small/history.csv");
  for (int delay_us = 0; delay_us < 24'000; delay_us += 600) {
    start_and_kill({"run", "small.toml", "--quiet"}, std::chrono::microseconds(delay_us));
    ASSERT_EQ(text("runs/small/history.csv"), good) << "killed after " << delay_us << " us";
    ASSERT_TRUE(fs::exists(path("runs/small/run.json"))) << "killed after " << delay_us << " us";
  }
}

TEST_F(Commands, ModelsForAScenarioSayWhichLawsCanRunItAndHowFarTheyAreOff) {
  write_text(path("small.toml"), std::string(k_small) + "[mdr]\nstrict = true\n");
  const auto before = files();
  const Outcome outcome = monograin("models --for small.toml");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto line_of = [&](const std::string& law) {
    const std::size_t begin = outcome.out.find("| " + law + " ");
    return begin == std::string::npos ? "" : outcome.out.substr(begin, outcome.out.find('\n', begin) - begin);
  };
  for (const char* law : {"mdr", "cel"}) {
    EXPECT_NE(line_of(law).find("| runs "), std::string::npos) << outcome.out;
    EXPECT_NE(line_of(law).find(" % to 0.25 R0, E/Y = 50 |"), std::string::npos) << outcome.out;
  }
  EXPECT_NE(line_of("hertz").find("rubber"), std::string::npos) << outcome.out;
  EXPECT_NE(line_of("similarity").find("| cannot "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("\nsimilarity    key 'hardening_exponent' is missing in [material]"), std::string::npos)
      << outcome.out;
  EXPECT_EQ(outcome.out.find("material-point"), std::string::npos) << "has no walls";
  EXPECT_EQ(files(), before) << "nothing is written";
}

TEST_F(Commands, ModelsForAScenarioWithoutWallsAreRefused) {
  const Outcome outcome = monograin("models --for " MONOGRAIN_SOURCE_DIR "/scenarios/packing.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("model 'packing' has no walls"), std::string::npos) << outcome.err;
}

TEST_F(Commands, ModelsListsAndDescribes) {
  EXPECT_NE(monograin("models").out.find("mdr"), std::string::npos);
  const Outcome mdr = monograin("models mdr");
  EXPECT_EQ(mdr.code, 0);
  for (const char* word : {"yield_stress", "radius_rule", "gated", "fully-plastic", "growth-on", "caps"}) {
    EXPECT_NE(mdr.out.find(word), std::string::npos) << word;
  }
  EXPECT_NE(mdr.out.find("reference: W. Zunker and K. Kamrin (2024), "), std::string::npos) << mdr.out;
  EXPECT_NE(mdr.out.find("doi:10.1016/j.jmps.2023.105492\n"), std::string::npos) << mdr.out;
  EXPECT_EQ(monograin("models nonsense").code, 2);
  write_text(path("small.toml"), k_small);
  const Outcome parameters = monograin("models mdr --parameters small.toml");
  EXPECT_EQ(parameters.code, 0) << parameters.err;
  EXPECT_NE(parameters.out.find("yield_overlap_over_radius"), std::string::npos) << parameters.out;
}

TEST_F(Commands, CompareExitsWithFiveAboveTheTolerance) {
  write_text(path("small.toml"), k_small);
  ASSERT_EQ(monograin("run small.toml -o a").code, 0);
  ASSERT_EQ(monograin("run small.toml -o b --set material.yield_stress='20.2 MPa'").code, 0);
  EXPECT_EQ(monograin("compare a/history.csv a/history.csv --tol 0").code, 0);
  const Outcome differs = monograin("compare a/history.csv b/history.csv --y axial.force --tol 1e-6");
  EXPECT_EQ(differs.code, 5) << differs.out << differs.err;
  EXPECT_NE(differs.out.find("axial.force"), std::string::npos);
  EXPECT_EQ(monograin("compare a/history.csv missing.csv").code, 2);
}

TEST_F(Commands, OptionsRefuseNanForANumber) {
  write_text(path("a.csv"), "time,force\n0,1\n1,2\n");
  EXPECT_EQ(monograin("compare a.csv a.csv --tol 0").code, 0);
  for (const char* arguments : {"compare a.csv a.csv --tol nan", "sensitivity s.toml --confidence nan",
                                "calibrate c.toml --confidence nan", "plot a --profile nan", "bench --rtol nan"}) {
    const Outcome outcome = monograin(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_NE(outcome.err.find(" = nan is not what it takes"), std::string::npos) << outcome.err;
  }
}

TEST_F(Commands, CompareExitsWithFiveWhereTheReferenceIsNotCovered) {
  write_text(path("a.csv"), "time[s],force[N],regime\n0,0,open\n0.1,1,elastic\n0.2,4,elastic\n");
  write_text(path("row.csv"), "time[s],force[N]\n0,0\n");
  const Outcome outcome = monograin("compare a.csv row.csv --x time --y force --tol 1e-9");
  EXPECT_EQ(outcome.code, 5);
  EXPECT_NE(outcome.err.find("row.csv does not have all of a.csv: force[N] covers only 0 % of the curve"),
            std::string::npos)
      << outcome.err;
  const Outcome measured = monograin("compare a.csv row.csv --x time --y force");
  EXPECT_EQ(measured.code, 0) << measured.err;
  EXPECT_NE(measured.out.find("row.csv: force[N] covers only 0 % of the curve"), std::string::npos) << measured.out;
}

TEST_F(Commands, CompareExitsWithFiveWhereColumnsUnitsOrWordsAreOthers) {
  write_text(path("a.csv"), "time[s],area[m2],force[N],regime\n0,2,0,open\n1,2,1,elastic\n");
  const auto code = [&](const std::string& other) {
    write_text(path("b.csv"), other);
    EXPECT_EQ(monograin("compare a.csv b.csv").code, 0) << other;  // without a tolerance it only measures
    return monograin("compare a.csv b.csv --tol 1").code;
  };
  EXPECT_EQ(code("time[s],area[m2],force[N],regime,more\n0,2,0,open,1\n1,2,1,elastic,1\n"), 0);
  EXPECT_EQ(code("time[s],regime,area[m2],force[N]\n0,open,2,0\n1,elastic,2,1\n"), 0);
  EXPECT_EQ(code("time[s],regime,area[m2]\n0,open,2\n1,elastic,2\n"), 5);
  EXPECT_EQ(code("time[s],area[m2],force[kN],regime\n0,2,0,open\n1,2,1,elastic\n"), 5);
  EXPECT_EQ(code("time[s],area[m2],force[N],regime\n0,2,0,open\n1,2,1,yielded\n"), 5);
  EXPECT_EQ(code("time[s],area[m2],force[N],regime\n0,2,0,open\n1,2,nan,elastic\n"), 5);
  write_text(path("c.csv"), "s,f\n0,0\n1,1\n");
  EXPECT_EQ(monograin("compare a.csv c.csv").code, 2);  // nothing was measured
  EXPECT_EQ(monograin("compare a.csv c.csv --tol 1").code, 5);
  EXPECT_EQ(monograin("compare a.csv a.csv --y forc --tol 1").code, 2);
}

TEST_F(Commands, CompareTakesRunFoldersWithTheirEvents) {
  write_text(path("small.toml"), k_small);
  ASSERT_EQ(monograin("run small.toml -o a").code, 0);
  ASSERT_EQ(monograin("run small.toml -o b --set numerics.integrator=cvode-bdf").code, 0);
  ASSERT_EQ(monograin("run small.toml -o c --set loading.steps[1].displacement='0.19 R0'").code, 0);
  const Outcome same = monograin("compare a b --tol 1e-5");
  EXPECT_EQ(same.code, 0) << same.out << same.err;
  EXPECT_NE(same.out.find("event time[s]"), std::string::npos) << same.out;
  // The curves are alike within half of their size; an event less is a difference whatever the tolerance.
  const Table events = read_csv(path("a/events.csv"));
  Table fewer(events.columns());
  for (std::size_t k = 0; k + 1 < events.row_count(); ++k) fewer.append(events.row(k));
  fs::copy(path("a"), path("d"), fs::copy_options::recursive);
  std::ofstream out(path("d/events.csv"), std::ios::binary);
  out << csv_text(fewer);
  out.close();
  const Outcome lost = monograin("compare a d --tol 1");
  EXPECT_EQ(lost.code, 5);
  EXPECT_NE(lost.err.find("is nothing instead of"), std::string::npos) << lost.err;
  EXPECT_EQ(monograin("compare d a --tol 1").code, 5);
  EXPECT_EQ(monograin("compare a c --tol 1e-3").code, 5);
  EXPECT_EQ(monograin("compare a/history.csv b --y axial.force --tol 1e-5").code, 0);
  EXPECT_EQ(monograin("compare a .").code, 2);
}

TEST_F(Commands, PlotDrawsRecordedRunsInEveryFormat) {
  write_text(path("small.toml"), k_small);
  ASSERT_EQ(monograin("run small.toml").code, 0);
  for (const char* file : {"f.svg", "f.pdf", "f.png"}) {
    const Outcome outcome = monograin(std::string("plot runs/small -o ") + file);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_GT(fs::file_size(folder() / file), 1000U) << file;
  }
  EXPECT_NE(monograin("plot runs/small -o f.bmp").code, 0);
  EXPECT_EQ(monograin("plot runs/nowhere").code, 2);
}

TEST_F(Commands, PlotDrawsAnyColumnsWithMeasuredData) {
  write_text(path("small.toml"), k_small);
  ASSERT_EQ(monograin("run small.toml").code, 0);
  write_text(path("measured.csv"), "force[kN],displacement[um]\n0,0\n0.001,10\n");
  const Outcome outcome = monograin("plot runs/small --unit mN --data measured.csv -o f.svg");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(text("f.gp").find("'measured'"), std::string::npos) << text("f.gp");
  EXPECT_NE(text("f.gp").find("axial.force [mN]"), std::string::npos) << text("f.gp");
  EXPECT_NE(text("f.dat").find("\n1e-05 1000\n"), std::string::npos) << text("f.dat");
  EXPECT_EQ(monograin("plot runs/small --x time --y axial.overlap[m] --unit mm -o g.svg").code, 0);
  for (const char* wrong : {"--y axial.fore", "--unit mm", "--x time --data measured.csv", "--x time --profile 0.1"}) {
    EXPECT_EQ(monograin(std::string("plot runs/small -o h.svg ") + wrong).code, 2) << wrong << text("stderr.txt");
  }
  EXPECT_FALSE(fs::exists(path("h.svg")));
}

TEST_F(Commands, PlotDrawsTheParticlesDataOverTheFittedScenario) {
  write_text(path("small.toml"), k_small);
  write_text(path("measured.csv"), "displacement[um],force[N]\n6,0.5\n10,1\n20,4\n30,8\n");
  write_text(path("c.toml"), R"(scenario = "small.toml"
[data]
file = "measured.csv"
x = "displacement[um]"
y = "force[N]"
offset = "5 um"
force_offset = "0.25 N"
[free]
"material.youngs_modulus" = { from = "1 kPa", to = "1000 GPa" }
)");
  ASSERT_EQ(monograin("calibrate c.toml").code, 0) << text("stderr.txt");
  ASSERT_EQ(monograin("run runs/c/fitted.toml -o runs/fitted").code, 0) << text("stderr.txt");
  const Outcome particle = monograin("plot runs/fitted --data runs/c -o f.svg");
  ASSERT_EQ(particle.code, 0) << particle.err;
  EXPECT_NE(text("f.dat").find("e-05 7.75\n"), std::string::npos) << text("f.dat");
  EXPECT_EQ(particle.err.find("note:"), std::string::npos) << particle.err;
  const Outcome recorded = monograin("plot runs/fitted --data measured.csv -o g.svg");
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  EXPECT_NE(recorded.err.find("note: runs/fitted is a run of the particle alone; 'measured.csv' is drawn as recorded"),
            std::string::npos)
      << recorded.err;
}

TEST_F(Commands, PlotDrawsProfilesAtAnInstant) {
  write_text(path("small.toml"), k_small);
  ASSERT_EQ(monograin("run small.toml").code, 0);
  const double time = read_csv(path("runs/small/history.csv")).column("time").back();
  const Outcome outcome = monograin("plot runs/small --profile " + std::to_string(0.5 * time));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(path("runs/small/profile.svg")));
  EXPECT_GT(read_csv(path("runs/small/profile.csv")).row_count(), 100U);
  EXPECT_EQ(monograin("plot runs/small --profile " + std::to_string(2.0 * time)).code, 2);
  EXPECT_EQ(monograin("plot runs/small runs/small --profile 0").code, 2);
}

TEST_F(Commands, SchemaPrintsJson) {
  const auto schema = nlohmann::json::parse(monograin("schema").out);
  EXPECT_TRUE(schema.contains("$schema"));
}

TEST_F(Commands, RegressFindsAMovedCurve) {
  fs::create_directory(path("scenarios"));
  write_text(path("scenarios/small.toml"), k_small);
  ASSERT_EQ(monograin("regress --accept --curves curves").code, 0);
  const Outcome same = monograin("regress --curves curves");
  EXPECT_EQ(same.code, 0) << same.out;
  const Table stored = read_csv(path("curves/small.csv"));
  Table moved(stored.columns());
  moved.header = stored.header;
  for (std::size_t i = 0; i < stored.row_count(); ++i) {
    std::vector<double> row(stored.row(i).begin(), stored.row(i).end());
    if (i == stored.row_count() / 2) row[*stored.find("axial.force")] *= 1.0 + 1e-9;
    moved.append(row);
  }
  std::ofstream out(path("curves/small.csv"), std::ios::binary);
  out << csv_text(moved);
  out.close();
  EXPECT_EQ(monograin("regress --curves curves").code, 5);
}

TEST_F(Commands, RegressExitsWithFiveWhereCurvesDoNotBelongTogether) {
  fs::create_directory(path("scenarios"));
  write_text(path("scenarios/small.toml"), k_small);
  ASSERT_EQ(monograin("regress --accept --curves curves").code, 0);
  const std::string history = text("curves/small.csv");
  const std::string events = text("curves/small.events.csv");
  const auto expect_fault = [&](const std::string& fault) {
    const Outcome outcome = monograin("regress --curves curves");
    EXPECT_EQ(outcome.code, 5) << fault;
    EXPECT_NE(outcome.out.find(fault), std::string::npos) << fault << '\n' << outcome.out;
    write_text(path("curves/small.csv"), history);
    write_text(path("curves/small.events.csv"), events);
  };
  const auto lines_of = [](const std::string& whole, std::size_t rows) {
    std::size_t end = whole.find("\ntime[s]") + 1;
    for (std::size_t k = 0; k <= rows; ++k) end = whole.find('\n', end) + 1;
    return whole.substr(0, end);
  };
  const auto replaced = [](std::string whole, const std::string& word, const std::string& by) {
    const std::size_t at = whole.rfind(word);
    EXPECT_NE(at, std::string::npos) << word;
    return whole.replace(at, word.size(), by);
  };
  write_text(path("curves/small.csv"), lines_of(history, 3));
  expect_fault("stored apparent_radius[m] covers only ");
  write_text(path("curves/small.csv"), lines_of(history, 0));
  expect_fault("one of them has no points");
  write_text(path("curves/small.csv"), replaced(history, "axial.force[N]", "axial.push[N]"));
  expect_fault("stored axial.force[N] is missing");
  write_text(path("curves/small.csv"), replaced(history, "unloading", "elastic"));
  expect_fault("axial.regime has 'unloading' instead of 'elastic'");
  write_text(path("curves/small.events.csv"), replaced(events, "step-end", "reload"));
  expect_fault("instead of 'reload'");
  write_text(path("curves/small.events.csv"), lines_of(events, 1));
  expect_fault("instead of nothing");
  write_text(path("curves/other.csv"), history);
  expect_fault("other.csv has no scenario; remove it, or bring other.toml back");
  fs::remove(path("curves/other.csv"));
  write_text(path("curves/ghost.events.csv"), events);
  expect_fault("ghost.events.csv has no scenario");
  fs::remove(path("curves/ghost.events.csv"));
  write_text(path("scenarios/small.toml"), std::string(k_small) + "\n[numerics]\nrtol = 1e-7\n");
  expect_fault("the scenario has changed since its curve was stored");
  fs::remove(path("curves/small.csv"));
  expect_fault("'monograin regress --accept' stores it");
  fs::remove(path("scenarios/small.toml"));
  EXPECT_EQ(monograin("regress --curves curves").code, 2);  // no scenario at all
}

TEST_F(Commands, RegressSaysWhatItsAcceptingChanges) {
  fs::create_directory(path("scenarios"));
  write_text(path("scenarios/small.toml"), k_small);
  const Outcome first = monograin("regress --accept --curves curves");
  EXPECT_EQ(first.code, 0);
  EXPECT_NE(first.out.find("is missing"), std::string::npos) << first.out;
  std::string softer = k_small;
  softer.replace(softer.find("20 MPa"), 6, "19 MPa");
  write_text(path("scenarios/small.toml"), softer);
  const Outcome second = monograin("regress --accept --curves curves");
  EXPECT_EQ(second.code, 0);
  EXPECT_NE(second.out.find("differs in "), std::string::npos) << second.out;
  EXPECT_NE(second.out.find("the scenario has changed"), std::string::npos) << second.out;
  EXPECT_NE(second.err.find("1 curves stored"), std::string::npos) << second.err;
  EXPECT_EQ(monograin("regress --curves curves").code, 0);
}

TEST_F(Commands, WrongUseExitsWithTwo) {
  for (const char* arguments : {"", "nonsense", "run --nonsense", "run missing.toml", "compare", "plot"}) {
    EXPECT_EQ(monograin(arguments).code, 2) << "monograin " << arguments;
  }
  EXPECT_EQ(monograin("--version").out.substr(0, 10), "monograin ");
}

TEST_F(Commands, AnUnknownCommandIsAnsweredWithThoseThereAre) {
  const Outcome outcome = monograin("nonsense file.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("no command 'nonsense'"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("regress"), std::string::npos) << outcome.err;
}

/// Keys of BibTeX entries, in their order.
std::vector<std::string> keys_of(const std::string& bibtex) {
  std::vector<std::string> keys;
  for (std::size_t at = bibtex.find('@'); at != std::string::npos; at = bibtex.find('@', at + 1)) {
    const std::size_t brace = bibtex.find('{', at);
    keys.push_back(bibtex.substr(brace + 1, bibtex.find(',', at) - brace - 1));
  }
  return keys;
}

TEST_F(Commands, CitePrintsTheReferencesOfModelsAndOfTheProgram) {
  const Outcome mdr = monograin("cite mdr");
  EXPECT_EQ(mdr.code, 0) << mdr.err;
  EXPECT_EQ(keys_of(mdr.out), (std::vector<std::string>{"monograin", "zunker2024", "zunker2024b"}));
  EXPECT_NE(mdr.out.find("under contact, version " + std::string(version()) + "}},"), std::string::npos) << mdr.out;
  EXPECT_NE(mdr.out.find("  doi = {10.1016/j.jmps.2023.105492}\n"), std::string::npos) << mdr.out;
  EXPECT_EQ(keys_of(monograin("cite packing hertz mdr").out),
            (std::vector<std::string>{"hertz1882", "monograin", "nezamabadi2022", "zunker2024", "zunker2024b"}));
}

TEST_F(Commands, CitePrintsTheReferencesOfAllModelsEachOnce) {
  const Outcome all = monograin("cite");
  EXPECT_EQ(all.code, 0) << all.err;
  const std::vector<std::string> keys = keys_of(all.out);
  EXPECT_GE(keys.size(), 7U);
  EXPECT_EQ(std::ranges::adjacent_find(keys, std::ranges::greater_equal{}), keys.end()) << all.out;
}

TEST_F(Commands, CiteNamesTheModelThatWasMeant) {
  const Outcome outcome = monograin("cite hertz semimec");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("there is no model 'semimec'; did you mean 'semimech'?"), std::string::npos)
      << outcome.err;
}

TEST_F(Commands, RunLeavesTheReferencesOfTheModel) {
  write_text(path("small.toml"), k_small);
  ASSERT_EQ(monograin("run small.toml --plot").code, 0);
  const nlohmann::json references = nlohmann::json::parse(text("runs/small/run.json")).at("citation");
  ASSERT_EQ(references.size(), 2U);
  const std::string line = "# reference: " + references[0].get<std::string>() + "\n";
  EXPECT_NE(line.find("doi:"), std::string::npos) << line;
  for (const char* file : {"history.csv", "events.csv", "figure.dat"}) {
    EXPECT_NE(text(std::string("runs/small/") + file).find(line), std::string::npos) << file;
  }
}

TEST_F(Commands, HelpEndsWithAnExample) {
  for (const char* command :
       {"", "run", "check", "models", "cite", "units", "plot", "atlas", "compare", "regress", "calibrate", "design",
        "data", "sweep", "schema", "export lammps", "export table", "continuum"}) {
    const Outcome help = monograin(std::string(command) + " --help");
    EXPECT_EQ(help.code, 0);
    EXPECT_NE(help.out.find("Example: monograin "), std::string::npos) << command;
  }
}

TEST_F(Commands, HelpAndModelsFitATerminalOf80Columns) {
  std::vector<std::string> commands{"--help",
                                    "run --help",
                                    "plot --help",
                                    "calibrate --help",
                                    "models --help",
                                    "sweep --help",
                                    "data --help",
                                    "export lammps --help",
                                    "continuum --help",
                                    "bench --help",
                                    "stress --help",
                                    "models --for " MONOGRAIN_SOURCE_DIR "/scenarios/die.toml",
                                    "compare elastic softer"};
  write_text(path("small.toml"), k_small);
  ASSERT_EQ(monograin("run small.toml -o elastic").code, 0);
  ASSERT_EQ(monograin("run small.toml --set material.youngs_modulus='0.9 GPa' -o softer").code, 0);
  std::istringstream models(monograin("models").out);
  for (std::string line; std::getline(models, line);) commands.push_back("models " + line.substr(0, line.find(' ')));
  ASSERT_GE(commands.size(), 20U);
  const auto begins_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
  for (const std::string& command : commands) {
    std::istringstream text(monograin(command).out);
    for (std::string line; std::getline(text, line);) {
      const bool is_to_copy = line.starts_with("Example:");
      EXPECT_TRUE(is_to_copy || std::ranges::count_if(line, begins_character) <= 80) << command << ": " << line;
    }
  }
}

TEST_F(Commands, ModelsKeepEveryWordOfALongEntry) {
  std::istringstream words(monograin("models mdr").out);
  std::string on_one_line;
  for (std::string word; words >> word;) on_one_line += word + ' ';
  for (const char* entry :
       {"elastic_profile indenter of an elastic contact: the unified ellipse or Hertz's parabola; one of ellipse, "
        "parabola (default ellipse) delta_max_rule",
        "singular-growth the free surface is used up: the apparent radius would grow without bound volume-limit",
        "- contact caps do not intersect (event caps-intersect) - with"}) {
    EXPECT_TRUE(contains(on_one_line, entry)) << entry;
  }
}

/// A definition that shows k_small, which stands beside it.
constexpr const char* k_definition = R"toml(title = "Small"
source = "nobody"
x = "axial.displacement / R0"
y = "axial.force / (E * R0^2)"
[[panel]]
curve = [{ scenario = "scenarios/small.toml", legend = "small" }]
[[table]]
title = "Against a straight line"
[[table.row]]
label = "small"
curve = { scenario = "scenarios/small.toml" }
points = { file = "p.csv", x = "x", y = "y" }
)toml";

TEST_F(Commands, AtlasMakesFiguresAndTablesAnew) {
  fs::create_directories(path("plots/scenarios"));
  write_text(path("plots/scenarios/small.toml"), k_small);
  write_text(path("plots/p.csv"), "x,y\n0,0\n0.1,0.02\n0.2,0.04\n");
  write_text(path("plots/small.toml"), k_definition);
  const Outcome listed = monograin("atlas --list");
  EXPECT_EQ(listed.code, 0) << listed.err;
  EXPECT_EQ(listed.out, "small  Small\n");
  const Outcome outcome = monograin("atlas small -o figures");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("## Against a straight line"), std::string::npos) << outcome.out;
  EXPECT_NE(text("figures/small.dat").find("\n# reference: W. Zunker and K. Kamrin (2024), "), std::string::npos);
  EXPECT_NE(outcome.err.find("-> figures/small.svg"), std::string::npos) << outcome.err;
  for (const char* file : {"small.svg", "small.gp", "small.dat", "small.csv", "small.md"})
    EXPECT_TRUE(fs::exists(path("figures") / file)) << file;
  ASSERT_EQ(monograin("atlas").code, 0);
  EXPECT_EQ(text("plots/small.csv"), text("figures/small.csv"));
}

TEST_F(Commands, AtlasWritesNothingWhereADefinitionIsAtFault) {
  fs::create_directories(path("plots/scenarios"));
  write_text(path("plots/scenarios/small.toml"), k_small);
  write_text(path("plots/good.toml"),
             "title = \"t\"\nsource = \"s\"\n[[panel]]\n"
             "curve = [{ parameter = { from = 0, to = 1 }, x = \"t\", y = \"t\" }]\n");
  write_text(path("plots/small.toml"), k_definition);
  const auto before = files();
  const Outcome missing = monograin("atlas");
  EXPECT_EQ(missing.code, 2);
  EXPECT_NE(missing.err.find("plots/small.toml:12:19: plots/p.csv"), std::string::npos) << missing.err;
  EXPECT_EQ(monograin("atlas none").code, 2);
  EXPECT_EQ(monograin("atlas --plots none").code, 2);
  EXPECT_EQ(files(), before);
}

TEST_F(Commands, AtlasRefusesAFolderWithoutDefinitions) {
  fs::create_directory(path("none"));
  const Outcome outcome = monograin("atlas --plots none");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("none: holds no definition (.toml)"), std::string::npos) << outcome.err;
}

TEST_F(Commands, AtlasKnowsTheReadyDefinitions) {
  const Outcome outcome = monograin("atlas --list --plots '" MONOGRAIN_SOURCE_DIR "/plots'");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("mdr-fe "), std::string::npos) << outcome.out;
}

/// Fits the yield stress of k_small, which stands beside it, to a run of it.
constexpr const char* k_calibration = R"toml(scenario = "small.toml"
[data]
file = "measured.csv"
x = "axial.displacement"
y = "axial.force"
[free]
"material.yield_stress" = { from = "5 MPa", to = "80 MPa" }
)toml";

TEST_F(Commands, CalibrateFindsTheParameterOfARunAndLeavesAScenarioThatRuns) {
  write_text(path("small.toml"), k_small);
  write_text(path("fit.toml"), k_calibration);
  ASSERT_EQ(monograin("run small.toml -o measured --set material.yield_stress='31 MPa'").code, 0);
  const Table history = read_csv(path("measured/history.csv"));
  std::ostringstream data;
  data << "axial.displacement[m],axial.force[N]\n" << std::setprecision(17);
  for (std::size_t i = 0; i < history.row_count(); ++i) {
    // Rows at events may stand on either side of a jump.
    if (history.at(i, *history.find("row")) != 0.0) continue;
    data << history.at(i, *history.find("axial.displacement")) << ',' << history.at(i, *history.find("axial.force"))
         << '\n';
  }
  write_text(path("measured.csv"), data.str());
  const Outcome outcome = monograin("calibrate fit.toml --confidence 0.9");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("material.yield_stress"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("31 MPa"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("90 % interval"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("-> runs/fit"), std::string::npos) << outcome.err;
  for (const char* file : {"fit.csv", "fitted.toml", "calibration.json", "figure.svg"})
    EXPECT_TRUE(fs::exists(path("runs/fit") / file)) << file;
  const auto json = nlohmann::json::parse(text("runs/fit/calibration.json"));
  EXPECT_NEAR(json["parameters"][0]["value_in_unit"].get<double>(), 31.0, 1e-9);
  ASSERT_EQ(monograin("run runs/fit/fitted.toml -o again").code, 0);
  const Outcome same = monograin("compare measured/history.csv again/history.csv --tol 1e-9");
  EXPECT_EQ(same.code, 0) << same.out;
}

TEST_F(Commands, CalibrateWritesNothingWhereSomethingIsAtFault) {
  write_text(path("small.toml"), k_small);
  write_text(path("fit.toml"), k_calibration);
  const auto before = files();
  const Outcome outcome = monograin("calibrate fit.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err.find("fit.toml:3:8: file = \"measured.csv\": there is no such file"), 0U) << outcome.err;
  EXPECT_TRUE(outcome.out.empty()) << outcome.out;
  EXPECT_EQ(monograin("calibrate").code, 2);
  EXPECT_EQ(monograin("calibrate nowhere.toml").code, 2);
  EXPECT_EQ(monograin("calibrate fit.toml --confidence 1.5").code, 2);
  EXPECT_EQ(files(), before);
  write_text(path("measured.csv"), "axial.displacement[m],axial.force[N]\n5e-5,5\n1e-4,12\n");
  ASSERT_EQ(monograin("run small.toml -o measured").code, 0);
  fs::create_directory(path("mine"));
  write_text(path("mine/fit.csv"), "keep me");
  const auto with_run = files();
  const Outcome mine = monograin("calibrate fit.toml -o mine");
  EXPECT_EQ(mine.code, 2);
  EXPECT_TRUE(mine.out.empty()) << "refused before the fit";
  EXPECT_EQ(monograin("calibrate fit.toml -o measured").code, 2) << "a run is no calibration";
  EXPECT_EQ(files(), with_run);
}

TEST_F(Commands, CalibrateFitsTheReadyExample) {
  const Outcome outcome =
      monograin("calibrate '" MONOGRAIN_SOURCE_DIR "/scenarios/calibrate/uniaxial.toml' --quiet -o fit");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(outcome.err.empty()) << outcome.err;
  const auto json = nlohmann::json::parse(text("fit/calibration.json"));
  // What the data were made with, 1.2 GPa and 45 MPa, lies in the intervals.
  for (const auto& [k, truth] : {std::pair(0, 1.2e9), std::pair(1, 45e6)}) {
    const auto& interval = json["parameters"][static_cast<std::size_t>(k)]["interval"];
    EXPECT_LT(interval[0].get<double>(), truth) << k;
    EXPECT_GT(interval[1].get<double>(), truth) << k;
  }
}

TEST_F(Commands, TakeOptionsBeforeFiles) {
  write_text(path("small.toml"), k_small);
  for (const char* arguments :
       {"run --set output.points=5 --set output.points=3 small.toml -o a", "check --set output.points=5 small.toml",
        "run small.toml -o b", "plot --data b/history.csv a -o c.svg", "stress --model hertz,mdr small.toml",
        "bench --integrator direct --rtol 1e-4,1e-5 small.toml -o d"}) {
    EXPECT_EQ(monograin(arguments).code, 0) << arguments << ": " << text("stderr.txt");
  }
  EXPECT_EQ(nlohmann::json::parse(text("a/run.json"))["scenario"]["overrides"],
            (std::vector<std::string>{"output.points=5", "output.points=3"}));
}

TEST_F(Commands, CalibrateComparesFits) {
  const std::string ready = MONOGRAIN_SOURCE_DIR "/scenarios/calibrate/";
  // Without its modulus free the law is further from the data.
  write_text(path("fixed.toml"), "scenario = \"" MONOGRAIN_SOURCE_DIR "/scenarios/uniaxial.toml\"\n[data]\nfile = \"" +
                                     ready +
                                     "cel.csv\"\nx = \"displacement[mm]\"\ny = \"force[N]\"\n[free]\n"
                                     "\"material.yield_stress\" = { from = \"4 MPa\", to = \"150 MPa\" }\n");
  const std::string both = "fixed.toml '" + ready + "cel-by-mdr.toml'";
  for (int time = 0; time < 2; ++time) {
    const Outcome outcome = monograin("calibrate " + both + " -o laws --quiet");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::size_t table = outcome.out.find("rms of predictions");
    ASSERT_NE(table, std::string::npos) << outcome.out;
    EXPECT_LT(outcome.out.find("\ncel-by-mdr ", table), outcome.out.find("\nfixed ", table)) << "the better one first";
  }
  for (const char* file :
       {"comparison.csv", "comparison.svg", "fixed/calibration.json", "cel-by-mdr/calibration.json"}) {
    EXPECT_TRUE(fs::exists(path("laws") / file)) << file;
  }
  const Outcome refused = monograin("calibrate " + both + " '" + ready + "uniaxial.toml' -o others");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("its data are not those of"), std::string::npos) << refused.err;
  EXPECT_FALSE(fs::exists(path("others")));
}

TEST_F(Commands, CalibrateWarnsOfABadFitAndIsStrictWhereAsked) {
  write_text(path("small.toml"), k_small);
  write_text(path("fit.toml"), k_calibration);
  write_text(path("measured.csv"), "axial.displacement[m],axial.force[N]\n5e-5,5\n1e-4,5\n1.5e-4,5\n");
  const Outcome lenient = monograin("calibrate fit.toml --quiet");
  EXPECT_EQ(lenient.code, 0);
  EXPECT_EQ(lenient.err.find("warning: y is the same in every row"), 0U) << lenient.err;
  const Outcome strict = monograin("calibrate fit.toml --strict");
  EXPECT_EQ(strict.code, 5);
  EXPECT_TRUE(fs::exists(path("runs/fit/calibration.json"))) << "the result is written all the same";
  const auto json = nlohmann::json::parse(text("runs/fit/calibration.json"));
  EXPECT_EQ(json["warnings"].size(), 1U);
  const Outcome good =
      monograin("calibrate '" MONOGRAIN_SOURCE_DIR "/scenarios/calibrate/uniaxial.toml' --strict --quiet -o good");
  EXPECT_EQ(good.code, 0) << good.err;
}

TEST_F(Commands, DesignSaysWhichErrorsToExpect) {
  const std::string ready = "'" MONOGRAIN_SOURCE_DIR "/scenarios/design/uniaxial.toml'";
  const Outcome outcome = monograin("design " + ready);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* part : {"planned: loading\n", "\nmaterial.yield_stress    40 MPa", "\ntwo_unloadings ",
                           "\nbest by the volume (D): unloading\n"}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << '\n' << outcome.out;
  }
  EXPECT_NE(outcome.err.find("uniaxial: expected errors -> runs/uniaxial\n"), std::string::npos) << outcome.err;
  for (const char* file : {"errors.csv", "figure.svg", "figure.gp", "figure.dat"}) {
    EXPECT_TRUE(fs::exists(path("runs/uniaxial") / file)) << file;
  }
  const Table table = read_csv(path("runs/uniaxial/errors.csv"));
  EXPECT_EQ(table.row_count(), 6U);
  EXPECT_LT(table.at(3, *table.find("relative")), table.at(1, *table.find("relative")));
}

TEST_F(Commands, DesignWritesNothingWhereSomethingIsAtFault) {
  write_text(path("small.toml"), k_small);
  write_text(path("plan.toml"), R"toml(scenario = "small.toml"
[free]
"material.youngs_modulus" = { from = "1 Pa", to = "1000 GPa" }
[[program]]
name = "loading"
noise = { absolute = "2 s" }
)toml");
  const auto before = files();
  const Outcome outcome = monograin("design plan.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err.find("plan.toml:6:22: "), 0U) << outcome.err;
  EXPECT_TRUE(outcome.out.empty()) << outcome.out;
  EXPECT_EQ(monograin("design").code, 2);
  EXPECT_EQ(monograin("design nowhere.toml").code, 2);
  EXPECT_EQ(monograin("design small.toml").code, 2);
  EXPECT_EQ(files(), before);
}

TEST_F(Commands, DataShowsWhatIsReadFromAMachinesFile) {
  fs::copy_file(MONOGRAIN_SOURCE_DIR "/tests/study/calibrate/machines/zwick.csv", path("zwick.csv"));
  const Outcome shown = monograin("data zwick.csv");
  ASSERT_EQ(shown.code, 0) << shown.err;
  for (const char* part :
       {"separator  semicolon", "decimal    comma", "units      line 2", "rows       81, lines 3 to 83",
        "x: column 1 'Standardweg', y: column 2 'Standardkraft'", "loading 1     3-43", "unloading 1  43-83"}) {
    EXPECT_NE(shown.out.find(part), std::string::npos) << part << '\n' << shown.out;
  }
  const Outcome drawn = monograin("data zwick.csv --plot");
  ASSERT_EQ(drawn.code, 0) << drawn.err;
  EXPECT_TRUE(fs::exists(path("zwick-data.svg")));
  const Outcome turned = monograin("data zwick.csv --x 2 --y Standardweg");
  EXPECT_NE(turned.out.find("x: column 2 'Standardkraft', y: column 1"), std::string::npos) << turned.out;
  // A figure never takes the place of the data.
  fs::copy_file(path("zwick.csv"), path("own.dat"));
  EXPECT_EQ(monograin("data own.dat -o own.svg").code, 2);
  EXPECT_EQ(text("own.dat"), text("zwick.csv"));
  EXPECT_EQ(monograin("data nowhere.csv").code, 2);
  EXPECT_EQ(monograin("data zwick.csv --x 7").code, 2);
}

TEST_F(Commands, DataShowsWhatACalibrationTakes) {
  const Outcome shown = monograin("data '" MONOGRAIN_SOURCE_DIR "/scenarios/calibrate/uniaxial.toml'");
  ASSERT_EQ(shown.code, 0) << shown.err;
  EXPECT_NE(shown.out.find("x is axial.displacement, 1 mm = 0.001 m"), std::string::npos) << shown.out;
  EXPECT_NE(shown.out.find("unloading 1"), std::string::npos) << shown.out;
  EXPECT_EQ(monograin("data '" MONOGRAIN_SOURCE_DIR "/scenarios/calibrate/uniaxial.toml' --x 1").code, 2);
}

TEST_F(Commands, ManualAndCompletionKnowEveryCommand) {
  const std::string manual = read_text(MONOGRAIN_SOURCE_DIR "/src/cli/monograin.1");
  const std::string completion = read_text(MONOGRAIN_SOURCE_DIR "/src/cli/monograin.bash");
  std::istringstream lines(monograin("--help").out);
  bool in_commands = false;
  int count = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("Subcommands:")) {
      in_commands = true;
      continue;
    }
    std::istringstream words(line);
    std::string command;
    if (!in_commands || !(words >> command) || line.starts_with("Example")) continue;
    if (line[0] != ' ' || line[2] == ' ') continue;
    ++count;
    EXPECT_NE(manual.find(command), std::string::npos) << command;
    EXPECT_NE(completion.find(command), std::string::npos) << command;
  }
  EXPECT_GE(count, 7);
}

constexpr const char* k_packing = R"(model = "packing"
[material]
hardening_modulus = "1 MPa"
[[loading.steps]]
packing_fraction = 0.95
rate = "0.1 1/s"
[output]
points = 4
)";

TEST_F(Commands, RunAPackingWhichHasNeitherParticleNorWalls) {
  write_text(path("p.toml"), k_packing);
  EXPECT_EQ(monograin("check p.toml").code, 0);
  const Outcome outcome = monograin("run p.toml --plot");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Table history = read_csv(path("runs/p/history.csv"));
  std::vector<std::string> names;
  for (const Column& column : history.columns()) {
    names.push_back(column.unit.empty() ? column.name : column.name + '[' + column.unit + ']');
  }
  EXPECT_EQ(names, (std::vector<std::string>{"time[s]", "step", "row", "packing_fraction[-]", "strain[-]", "stress[Pa]",
                                             "stress_elastic[Pa]", "coordination_number[-]", "plastic_fraction[-]",
                                             "regime"}));
  EXPECT_TRUE(history.header_value("R0").empty());
  EXPECT_FALSE(history.header_value("E").empty());
  const auto run = nlohmann::json::parse(text("runs/p/run.json"));
  EXPECT_TRUE(run.at("classes").empty());
  EXPECT_EQ(run.at("status"), "complete");
  EXPECT_TRUE(fs::exists(path("runs/p/figure.svg")));
  EXPECT_EQ(monograin("plot runs/p -o p.pdf").code, 0);
  const Outcome profile = monograin("plot runs/p --profile 0.1");
  EXPECT_EQ(profile.code, 2);
  EXPECT_NE(
      profile.err.find("model 'packing' has no profile under its contacts; those of hertz, mdr, nonlocal have one"),
      std::string::npos)
      << profile.err;
  const Outcome models = monograin("models packing --parameters p.toml");
  EXPECT_EQ(models.code, 0) << models.err;
  EXPECT_NE(models.out.find("jamming_stress              10772.0222293"), std::string::npos) << models.out;
  EXPECT_EQ(models.out.find("radius"), std::string::npos);
  EXPECT_NE(monograin("models packing").out.find("jamming_fraction"), std::string::npos);
}

TEST_F(Commands, EndAPackingWithTheExitCodeOfItsEnd) {
  write_text(path("p.toml"), k_packing);
  const Outcome full = monograin("run p.toml -o runs/p --set loading.steps[0].packing_fraction=1.05");
  EXPECT_EQ(full.code, 3);
  EXPECT_NE(full.err.find("no pores are left"), std::string::npos) << full.err;
  EXPECT_NE(text("runs/p/history.csv").find("# status: stopped"), std::string::npos);
  EXPECT_EQ(monograin("run p.toml --set packing.f_E=0.1").code, 2);
  EXPECT_EQ(monograin("run p.toml --set material.poisson_ratio=0.5").code, 2);
  EXPECT_EQ(monograin("run p.toml --set packing.initial_packing_fraction=0.96").code, 2);  // would unload
}

TEST_F(Commands, SweepAPacking) {
  write_text(path("p.toml"), k_packing);
  write_text(path("s.toml"),
             "scenario = \"p.toml\"\ndesign = \"grid\"\n[vary]\n\"packing.alpha\" = { values = [1, 2.5] }\n"
             "\"loading.steps[0].packing_fraction\" = { from = 0.9, to = 0.95, points = 2 }\n");
  const Outcome outcome = monograin("sweep s.toml");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

// --- bench

constexpr const char* k_bench_scenes = " --scenes '" MONOGRAIN_SOURCE_DIR "/scenarios/bench/scenes.toml'";

TEST_F(Commands, BenchMeasuresNamedScenesAndScenarioFiles) {
  write_text(path("small.toml"), k_small);
  const Outcome outcome =
      monograin(std::string("bench mdr-die-50 small.toml --integrator auto,cvode-bdf --rtol 1e-5 --profile -o out") +
                k_bench_scenes);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* words : {"| mdr-die-50 ", "| small ", "| cvode-bdf ", "## Where the time goes"}) {
    EXPECT_NE(outcome.out.find(words), std::string::npos) << words;
  }
  for (const char* file : {"bench.csv", "bench.md", "bench-mdr-die-50.svg", "bench-small.svg", "bench-summary.svg"}) {
    EXPECT_TRUE(fs::exists(path("out") / file)) << file;
  }
}

TEST_F(Commands, BenchDrawsItsFiguresAnewWithoutMeasuring) {
  const Outcome outcome = monograin("bench --redraw '" MONOGRAIN_SOURCE_DIR "/plots/bench.csv' -o out");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.empty()) << "no table: " << outcome.out;
  EXPECT_TRUE(fs::exists(path("out/bench-summary.svg")));
  EXPECT_FALSE(fs::exists(path("out/bench.csv")));
  EXPECT_EQ(monograin("bench --redraw none.csv").code, 2);
}

TEST_F(Commands, BenchRefusesWhatItDoesNotKnow) {
  const Outcome scene = monograin(std::string("bench nowhere -o out") + k_bench_scenes);
  EXPECT_EQ(scene.code, 2);
  EXPECT_NE(scene.err.find("nowhere: no such scene"), std::string::npos) << scene.err;
  EXPECT_NE(scene.err.find("mdr-die-50"), std::string::npos) << scene.err;
  const Outcome integrator = monograin(std::string("bench mdr-die-50 --integrator euler -o out") + k_bench_scenes);
  EXPECT_EQ(integrator.code, 2);
  EXPECT_NE(integrator.err.find("'euler'"), std::string::npos) << integrator.err;
  EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(Commands, BenchHoldsLawsAgainstFiniteElements) {
  const Outcome outcome = monograin("bench --against-fe --plots '" MONOGRAIN_SOURCE_DIR "/plots' -o out");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("| E/Y = 200: semimech"), std::string::npos) << outcome.out;
  for (const char* file : {"laws-fe.svg", "laws-fe.csv", "laws-fe.md"}) {
    EXPECT_TRUE(fs::exists(path("out") / file)) << file;
  }
}

}  // namespace
}  // namespace monograin::commands_test
