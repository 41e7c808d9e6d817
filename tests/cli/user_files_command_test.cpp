// What becomes of a user's files, and what hostile files and names can do, with the program run as a user runs it.

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command_test.hpp"
#include "history/table.hpp"

namespace monograin::user_files_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

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
[output]
points = 10
)";

class UserFiles : public CommandTest {
 protected:
  void SetUp() override { write_text(path("small.toml"), k_small); }

  [[nodiscard]] std::vector<std::string> names_in(const std::string& name) const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path(name))) names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
  }
  /// A hidden folder as a killed run leaves it.
  [[nodiscard]] fs::path leftover(const std::string& name) const {
    const fs::path made = path(name);
    fs::create_directories(made);
    write_text(made / "history.csv", "half a line");
    return made;
  }
};

using Strings = std::vector<std::string>;
const Strings k_run_files{".monograin", "events.csv", "history.csv", "run.json"};

// --- a run replaces its own files

TEST_F(UserFiles, StayInTheFolderOfARunThatIsRepeated) {
  ASSERT_EQ(monograin("run small.toml -o r").code, 0);
  write_text(path("r/notes.txt"), "note");
  fs::create_directories(path("r/sub/deeper"));
  write_text(path("r/sub/deeper/data.csv"), "mine");
  fs::create_symlink("notes.txt", path("r/link"));
  ASSERT_EQ(monograin("plot r -o r/paper.svg").code, 0);
  ASSERT_EQ(monograin("plot r").code, 0);
  const std::string figure = text("r/figure.svg");
  const std::string old = text("r/history.csv");
  ASSERT_EQ(monograin("run small.toml -o r --set material.yield_stress='30 MPa'").code, 0);
  EXPECT_NE(text("r/history.csv"), old);
  EXPECT_EQ(text("r/notes.txt"), "note");
  EXPECT_EQ(text("r/sub/deeper/data.csv"), "mine");
  EXPECT_EQ(fs::read_symlink(path("r/link")), "notes.txt");
  EXPECT_TRUE(fs::exists(path("r/paper.svg")));
  EXPECT_EQ(text("r/figure.svg"), figure) << "drawn by the user, not by the run";
  EXPECT_TRUE(std::ranges::none_of(names_in("r"), [](const auto& name) { return name.starts_with(".monograin-"); }));
}

TEST_F(UserFiles, AFigureOfAnEarlierRunGoesUnlessSomebodyChangedIt) {
  ASSERT_EQ(monograin("run small.toml -o r --plot").code, 0);
  std::ofstream(path("r/figure.gp"), std::ios::app) << "# mine\n";
  ASSERT_EQ(monograin("run small.toml -o r").code, 0);
  EXPECT_FALSE(fs::exists(path("r/figure.svg")));
  EXPECT_FALSE(fs::exists(path("r/figure.dat")));
  EXPECT_TRUE(text("r/figure.gp").ends_with("# mine\n"));
}

TEST_F(UserFiles, AListOfWrittenFilesReachesNoOtherFolder) {
  ASSERT_EQ(monograin("run small.toml -o r").code, 0);
  const std::string list = text("r/.monograin");
  // Of the first file in the list, events.csv.
  const std::string digest =
      list.substr(list.find("xxh128:"), list.find(' ', list.find("xxh128:")) - list.find("xxh128:"));
  fs::copy_file(path("r/events.csv"), path("copy.csv"));
  write_text(path("r/.monograin"), list + digest + " ../copy.csv\n" + digest + " " + path("copy.csv").string() + "\n");
  ASSERT_EQ(monograin("run small.toml -o r").code, 0);
  EXPECT_TRUE(fs::exists(path("copy.csv")));
}

TEST_F(UserFiles, AFolderWithAForeignMarkerIsRefusedAtOnce) {
  for (const char* foreign : {"{}", "[1, 2]", "not json", R"({"program": "other", "versions": {"monograin": "1"}})"}) {
    fs::create_directories(path("theirs"));
    write_text(path("theirs/run.json"), foreign);
    write_text(path("theirs/history.csv"), "theirs");
    const Outcome outcome = monograin("run small.toml -o theirs");
    EXPECT_EQ(outcome.code, 2) << foreign;
    EXPECT_NE(outcome.err.find("its run.json is none that monograin has written"), std::string::npos) << outcome.err;
    EXPECT_EQ(text("theirs/history.csv"), "theirs");
    EXPECT_EQ(names_in("theirs"), (Strings{"history.csv", "run.json"}));
  }
}

TEST_F(UserFiles, ARunOfBeforeItNamedItsProgramIsReplaced) {
  ASSERT_EQ(monograin("run small.toml -o r").code, 0);
  Json json = Json::parse(text("r/run.json"));
  EXPECT_EQ(json["program"], "monograin");
  EXPECT_EQ(json["format"], 1);
  json.erase("program");
  json.erase("format");
  write_text(path("r/run.json"), json.dump());
  fs::remove(path("r/.monograin"));
  EXPECT_EQ(monograin("plot r --profile 0.5").code, 0);
  EXPECT_EQ(monograin("run small.toml -o r").code, 0);
  EXPECT_TRUE(Json::parse(text("r/run.json")).contains("format"));
}

TEST_F(UserFiles, ARunOfALaterFormatIsNotMisread) {
  ASSERT_EQ(monograin("run small.toml -o r").code, 0);
  Json json = Json::parse(text("r/run.json"));
  json["format"] = 2;
  write_text(path("r/run.json"), json.dump());
  const Outcome outcome = monograin("plot r --profile 0.5");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("format 2"), std::string::npos) << outcome.err;
}

TEST_F(UserFiles, AFolderWhereAFileIsToGoStopsTheWholeResult) {
  ASSERT_EQ(monograin("run small.toml -o r").code, 0);
  fs::remove(path("r/events.csv"));
  fs::create_directory(path("r/events.csv"));
  const std::string old = text("r/run.json");
  const Outcome outcome = monograin("run small.toml -o r --set output.points=3");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("events.csv: is a folder"), std::string::npos) << outcome.err;
  EXPECT_EQ(text("r/run.json"), old);
}

// --- where a run goes

TEST_F(UserFiles, RunsWithOtherOverridesStandSideBySide) {
  ASSERT_EQ(monograin("run small.toml").code, 0);
  const std::string plain = text("runs/small/run.json");
  ASSERT_EQ(monograin("run small.toml --set output.points=5 --set material.yield_stress='30 MPa'").code, 0);
  ASSERT_EQ(monograin("run small.toml --set material.yield_stress='30 MPa' --set output.points=5").code, 0);
  EXPECT_EQ(text("runs/small/run.json"), plain);
  EXPECT_EQ(names_in("runs").size(), 2U) << "the order of keys makes no difference";
  ASSERT_EQ(monograin("run small.toml --set output.points=6").code, 0);
  const Strings names = names_in("runs");
  ASSERT_EQ(names.size(), 3U);
  for (const std::string& name : names) {
    EXPECT_TRUE(name == "small" || (name.starts_with("small-") && name.size() == 14U)) << name;
  }
  // Of one key the last counts.
  ASSERT_EQ(monograin("run small.toml --set output.points=6 --set output.points=7").code, 0);
  ASSERT_EQ(monograin("run small.toml --set output.points=7 --set output.points=6").code, 0);
  EXPECT_EQ(names_in("runs").size(), 5U);
}

TEST_F(UserFiles, LinksAreFollowedAndStay) {
  fs::create_directory(path("real"));
  fs::create_symlink("real", path("link"));
  fs::create_symlink("there/later", path("dangling"));
  for (const char* target : {"link", "link/", "dangling", "dangling"}) {
    const Outcome outcome = monograin(std::string("run small.toml -o ") + target);
    EXPECT_EQ(outcome.code, 0) << target << ": " << outcome.err;
  }
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_TRUE(fs::is_symlink(path("dangling")));
  EXPECT_EQ(names_in("real"), k_run_files);
  EXPECT_EQ(names_in("there/later"), k_run_files);
}

TEST_F(UserFiles, EveryWayToNameAFolderLeadsThere) {
  fs::create_directories(path("work/inner"));
  fs::create_directories(path("plain"));
  for (const char* line :
       {"cd plain && monograin run ../small.toml -o .", "cd plain && monograin run ../small.toml -o ./",
        "cd plain && monograin run ../small.toml -o ../plain", "monograin run small.toml -o plain/",
        "monograin run small.toml -o new/deep/folder/", "monograin run small.toml -o work/inner/../../new2"}) {
    const Outcome outcome = shell(line);
    EXPECT_EQ(outcome.code, 0) << line << outcome.err;
  }
  ASSERT_EQ(shell("cd plain && mkdir sub && cd sub && monograin run ../../small.toml -o ..").code, 0);
  Strings expected = k_run_files;
  expected.emplace_back("sub");
  EXPECT_EQ(names_in("plain"), expected);
  // Who works in the folder sees the result there, the first one and the next.
  EXPECT_EQ(shell("mkdir here && cd here && monograin run ../small.toml -o . && cat run.json").code, 0);
  EXPECT_EQ(shell("cd here && monograin run ../small.toml -o . && cat run.json").code, 0);
  EXPECT_EQ(names_in("new/deep/folder"), k_run_files);
  EXPECT_EQ(names_in("new2"), k_run_files);
}

TEST_F(UserFiles, WhatCannotBeWrittenIsToldBeforeAnythingIsRun) {
  write_text(path("file"), "mine");
  for (const char* target : {"file", "file/below", "/proc/nowhere"}) {
    const Outcome outcome = monograin(std::string("run small.toml -o ") + target);
    EXPECT_EQ(outcome.code, 2) << target;
    EXPECT_EQ(outcome.err.find("rows"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(text("file"), "mine");
  write_text(path("second.toml"), k_small);
  fs::create_directories(path("out/second"));
  write_text(path("out/second/run.json"), "{}");
  EXPECT_EQ(monograin("run small.toml second.toml -o out").code, 2);
  EXPECT_FALSE(fs::exists(path("out/small"))) << "the first was not run";
  EXPECT_EQ(names_in("out"), Strings{"second"});
}

// --- killed runs and full disks

TEST_F(UserFiles, LeftoversOfKilledRunsAreClearedUnlessSomebodyWorksThere) {
  const fs::path dead = leftover("runs/.small.monograin-staged-abcdef");
  const fs::path alive = leftover("runs/.small.monograin-staged-ghijkl");
  const fs::path foreign = leftover("runs/.other.monograin-staged-abcdef");
  const int lock = open(alive.c_str(), O_RDONLY | O_DIRECTORY);
  ASSERT_EQ(flock(lock, LOCK_EX), 0);
  ASSERT_EQ(monograin("run small.toml").code, 0);
  EXPECT_FALSE(fs::exists(dead));
  EXPECT_TRUE(fs::exists(alive));
  EXPECT_TRUE(fs::exists(foreign)) << "of another target";
  close(lock);
  const fs::path inside = leftover("runs/small/.monograin-staged-abcdef");
  ASSERT_EQ(monograin("run small.toml").code, 0);
  EXPECT_FALSE(fs::exists(inside));
  EXPECT_FALSE(fs::exists(alive));
  EXPECT_EQ(names_in("runs/small"), k_run_files);
}

TEST_F(UserFiles, WhatAKilledRunWasMovingIsMovedByTheNextOne) {
  for (const char* name : {"r/.monograin-staged-abcdef", ".r.monograin-staged-abcdef"}) {
    fs::remove_all(path("r"));
    ASSERT_EQ(monograin("run small.toml -o r").code, 0);
    ASSERT_EQ(monograin("run small.toml -o n --plot --set output.points=5").code, 0);
    // Killed when the first file had been moved.
    const fs::path staged = path(name);
    fs::rename(path("n"), staged);
    write_text(staged / ".moving", "");
    fs::rename(staged / "events.csv", path("r/events.csv"));
    const std::string history = read_text(staged / "history.csv");
    write_text(path("r/notes.txt"), "mine");
    // The next run has no room for its own result.
    EXPECT_EQ(shell("ulimit -f 64; monograin run small.toml -o r --set output.points=2000").code, 2);
    EXPECT_TRUE(text("r/history.csv") == history);
    EXPECT_FALSE(fs::exists(staged));
    EXPECT_EQ(names_in("r"), (Strings{".monograin", "events.csv", "figure.dat", "figure.gp", "figure.svg",
                                      "history.csv", "notes.txt", "run.json"}));
  }
}

TEST_F(UserFiles, AKilledRunThatHadMovedAllLeavesNothingToDo) {
  for (const char* name : {"r/.monograin-staged-abcdef", ".r.monograin-staged-abcdef"}) {
    ASSERT_EQ(monograin("run small.toml -o r").code, 0);
    const std::string history = text("r/history.csv");
    fs::create_directory(path(name));
    write_text(path(name) / ".moving", "");
    EXPECT_EQ(shell("ulimit -f 64; monograin run small.toml -o r --set output.points=2000").code, 2);
    EXPECT_FALSE(fs::exists(path(name)));
    EXPECT_EQ(names_in("r"), k_run_files);
    EXPECT_TRUE(text("r/history.csv") == history);
  }
}

TEST_F(UserFiles, AnOldFolderThatAKilledRunDidNotRemoveGivesBackWhatIsNotItsOwn) {
  ASSERT_EQ(monograin("run small.toml -o r --plot").code, 0);
  fs::rename(path("r"), path(".r.monograin-staged-abcdef"));
  write_text(path(".r.monograin-staged-abcdef/late.txt"), "mine");
  ASSERT_EQ(monograin("run small.toml -o n").code, 0);
  fs::rename(path("n"), path("r"));
  ASSERT_EQ(monograin("run small.toml -o r").code, 0);
  EXPECT_EQ(text("r/late.txt"), "mine");
  EXPECT_FALSE(fs::exists(path(".r.monograin-staged-abcdef")));
  EXPECT_FALSE(fs::exists(path("r/figure.svg")));
}

TEST_F(UserFiles, AFolderHasThePermissionsThatTheMaskLeaves) {
  ASSERT_EQ(shell("umask 027; monograin run '" MONOGRAIN_SOURCE_DIR "/scenarios/hertz.toml' -o masked").code, 0);
  EXPECT_EQ(fs::status(path("masked")).permissions(),
            fs::perms::owner_all | fs::perms::group_read | fs::perms::group_exec);
}

TEST_F(UserFiles, ARepeatedRunKeepsTheModeOfItsFolder) {
  ASSERT_EQ(monograin("run small.toml -o r").code, 0);
  fs::permissions(path("r"), fs::perms::owner_all);
  ASSERT_EQ(monograin("run small.toml -o r").code, 0);
  EXPECT_EQ(fs::status(path("r")).permissions(), fs::perms::owner_all);
}

TEST_F(UserFiles, AFullDiskLeavesTheOldResult) {
  ASSERT_EQ(monograin("run small.toml -o r").code, 0);
  const std::string old = text("r/run.json");
  for (const char* target : {"r", "new"}) {
    const Outcome outcome =
        shell(std::string("ulimit -f 64; monograin run small.toml --set output.points=2000 -o ") + target);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find("history.csv: cannot be written: File too large"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(text("r/run.json"), old);
  EXPECT_EQ(names_in("r"), k_run_files);
  EXPECT_FALSE(fs::exists(path("new")));
}

TEST_F(UserFiles, AKillAtAnyMomentLeavesOneResultOrTheOther) {
  write_text(path("other.toml"), std::string(k_small) + "[numerics]\nrtol = 1e-6\n");
  ASSERT_EQ(monograin("run small.toml -o r").code, 0);
  write_text(path("r/notes.txt"), "note");
  for (int k = 0; k < 40; ++k) {
    start_and_kill({"run", k % 2 == 0 ? "other.toml" : "small.toml", "--quiet", "-o", "r"},
                   std::chrono::microseconds(600 * k));
    const std::string digest = read_csv(path("r/history.csv")).header_value("scenario_digest").data();
    const std::string recorded = Json::parse(text("r/run.json"))["scenario"]["digest"];
    EXPECT_TRUE(digest.starts_with(recorded)) << "killed after " << 600 * k << " us";
    EXPECT_EQ(text("r/notes.txt"), "note");
  }
}

TEST_F(UserFiles, ASignalAtAnyMomentLeavesNothingHidden) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    for (int k = 0; k < 15; ++k) {
      start_and_kill({"run", "small.toml", "--quiet", "-o", "r"}, std::chrono::microseconds(1500 * k), signal);
      for (const auto& entry : fs::directory_iterator(path(""))) {
        EXPECT_FALSE(entry.path().filename().string().starts_with('.')) << entry.path() << " after signal " << signal;
      }
      EXPECT_TRUE(!fs::exists(path("r")) || names_in("r") == k_run_files);
    }
  }
}

TEST_F(UserFiles, ASignalEndsTheProgramAsItEndsOthers) {
  const Outcome outcome = shell(
      "monograin run small.toml --set output.points=1000000 --quiet -o r & p=$!; sleep 0.3; kill -TERM $p; wait $p");
  EXPECT_EQ(outcome.code, 128 + SIGTERM);
  EXPECT_FALSE(fs::exists(path("r")));
}

TEST_F(UserFiles, AFigureThatGnuplotCannotDrawLeavesTheOldOneWhole) {
  ASSERT_EQ(monograin("run small.toml -o r").code, 0);
  ASSERT_EQ(monograin("plot r -o f.svg").code, 0);
  const std::vector<std::string> before{text("f.svg"), text("f.gp"), text("f.dat")};
  ASSERT_EQ(monograin("run small.toml --set output.points=7 -o r").code, 0);
  fs::create_directory(path("bin"));
  write_text(path("bin/gnuplot"), "#!/bin/sh\necho out of ink\nexit 1\n");
  fs::permissions(path("bin/gnuplot"), fs::perms::owner_all);
  const Outcome outcome = shell("PATH=$PWD/bin:$PATH; monograin plot r -o f.svg");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("gnuplot could not draw f.svg: out of ink"), std::string::npos) << outcome.err;
  EXPECT_EQ((std::vector<std::string>{text("f.svg"), text("f.gp"), text("f.dat")}), before);
  EXPECT_EQ(shell("PATH=$PWD/bin:$PATH; monograin run small.toml --plot -o new").err.find("staged"), std::string::npos);
  EXPECT_FALSE(fs::exists(path("new/figure.gp")));
}

TEST_F(UserFiles, AFigureHasTheSameDataWheneverItIsDrawn) {
  ASSERT_EQ(monograin("run small.toml --plot -o r").code, 0);
  const std::string first = text("r/figure.dat");
  ASSERT_EQ(monograin("run small.toml --plot -o r").code, 0);
  EXPECT_EQ(text("r/figure.dat"), first);
  EXPECT_NE(first.find("# run 1: r\n"), std::string::npos);
}

TEST_F(UserFiles, StayBesideASweepACalibrationAndAStressTest) {
  write_text(path("s.toml"),
             "scenario = \"small.toml\"\n[vary]\n\"material.poisson_ratio\" = { values = [0.2, 0.3] }\n");
  write_text(path("c.toml"),
             "scenario = \"small.toml\"\n[data]\nfile = \"d.csv\"\nx = \"displacement[m]\"\ny = \"force[N]\"\n[free]\n"
             "\"material.yield_stress\" = { from = \"10 MPa\", to = \"40 MPa\" }\n");
  write_text(path("d.csv"), "displacement[m],force[N]\n5e-5,10\n1e-4,20\n1.5e-4,31\n");
  for (const char* command : {"sweep s.toml -o out", "calibrate c.toml -o out", "stress --scenes 1 --seed 3 -o out"}) {
    fs::remove_all(path("out"));
    const Outcome first = monograin(command);
    ASSERT_NE(first.code, 2) << command << first.err;
    write_text(path("out/notes.txt"), "keep me");
    fs::create_directory(path("out/sub"));
    const Outcome second = monograin(command);
    EXPECT_EQ(second.code, first.code) << command << second.err;
    EXPECT_EQ(text("out/notes.txt"), "keep me") << command;
    EXPECT_TRUE(fs::exists(path("out/sub"))) << command;
  }
}

TEST_F(UserFiles, AForeignResultsFileIsNoSweepsToReplace) {
  write_text(path("s.toml"),
             "scenario = \"small.toml\"\n[vary]\n\"material.poisson_ratio\" = { values = [0.2, 0.3] }\n");
  fs::create_directory(path("out"));
  write_text(path("out/results.csv"), "mine");
  EXPECT_EQ(monograin("sweep s.toml -o out").code, 2);
  EXPECT_EQ(text("out/results.csv"), "mine");
}

// --- hostile names

/// Names that some program on the way might take for something else than a name.
const Strings k_hostile_names{"<touch BAD;",
                              "|touch BAD;",
                              "< touch BAD",
                              "`touch BAD`",
                              "$(touch BAD)",
                              "'; system 'touch BAD'; '",
                              "\"; system \"touch BAD\"; \"",
                              "a\\",
                              "a\nsystem \"touch BAD\"\n#",
                              "@BAD {x}_2^3 $data ~",
                              "-e system('touch BAD')",
                              "+",
                              "-",
                              "~",
                              "$data",
                              "a & b > c",
                              "%s%n",
                              "\xff\xfe",
                              "\x01\x1b[31m",
                              "m\xc3\xbc"};

[[nodiscard]] std::string shell_quoted(const std::string& word) {
  std::string result = "'";
  for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + '\'';
}

class HostileNames : public UserFiles {
 protected:
  void expect_nothing_was_run(const std::string& by) const {
    for (const auto& entry : fs::recursive_directory_iterator(folder())) {
      EXPECT_NE(entry.path().filename(), "BAD") << by;
    }
  }
  /// An XML file that a reader opens: tags and quotes of text are escaped, no control character, all of it UTF-8.
  void expect_good_figure(const fs::path& file) const {
    const std::string svg = read_text(file);
    EXPECT_TRUE(svg.starts_with("<?xml")) << file;
    EXPECT_TRUE(svg.ends_with("</svg>\n\n") || svg.ends_with("</svg>\n")) << file;
    EXPECT_TRUE(std::ranges::none_of(svg, [](char c) { return c >= 0 && c < ' ' && c != '\n' && c != '\t'; })) << file;
    EXPECT_NO_THROW(static_cast<void>(Json(svg).dump())) << file << ": not UTF-8";
    EXPECT_EQ(svg.find("<touch"), std::string::npos) << file;
  }
};

TEST_F(HostileNames, OfFiguresAreDrawnUnderAndNotRun) {
  ASSERT_EQ(monograin("run small.toml -o r").code, 0);
  for (const std::string& name : k_hostile_names) {
    const fs::path figure = folder() / (name + ".svg");
    const Outcome outcome = monograin("plot r -o " + shell_quoted("./" + name + ".svg"));
    EXPECT_EQ(outcome.code, 0) << name << outcome.err;
    expect_good_figure(figure);
    // The script draws the same by hand.
    const std::string first = read_text(figure);
    fs::remove(figure);
    const Outcome again = shell("gnuplot -d " + shell_quoted("./" + name + ".gp"));
    EXPECT_EQ(again.code, 0) << name << again.err;
    EXPECT_TRUE(read_text(figure) == first) << name;
    expect_nothing_was_run(name);
  }
}

TEST_F(HostileNames, OfFoldersAndScenariosAreOnlyNames) {
  for (const std::string& name : k_hostile_names) {
    const fs::path place = folder() / "d" / name;
    fs::create_directories(place);
    write_text(place / (name + ".toml"), k_small);
    const Outcome outcome = monograin("run " + shell_quoted("d/" + name + "/" + name + ".toml") + " --plot -o " +
                                      shell_quoted("d/" + name + "/out"));
    EXPECT_EQ(outcome.code, 0) << name << outcome.err;
    expect_good_figure(place / "out" / "figure.svg");
    EXPECT_EQ(read_csv(place / "out/history.csv").header_value("status"), "complete") << name;
    EXPECT_TRUE(Json::parse(read_text(place / "out/run.json")).contains("scenario")) << name;
    // A name without -o is that of a folder below runs.
    EXPECT_EQ(monograin("run " + shell_quoted("d/" + name + "/" + name + ".toml")).code, 0) << name;
    EXPECT_TRUE(fs::exists(folder() / "runs" / name / "run.json")) << name;
    expect_nothing_was_run(name);
  }
}

TEST_F(HostileNames, InRunsAreShownAsTheyAre) {
  for (const std::string& name : k_hostile_names) {
    const std::string heading = name.find_first_of("\",\n") == std::string::npos ? name : "axial";
    const fs::path run = folder() / "r" / name;
    fs::create_directories(run);
    write_text(run / "history.csv", "# R0: 0.01\n# E: " + name.substr(0, name.find('\n')) + "\ntime[s],row," + heading +
                                        ".displacement[m]," + heading + ".force[N]\n0,0,0,0\n1,0,1e-3,5\n2,0,2e-3,9\n");
    write_text(run / "events.csv", "time[s],class,event," + heading + ".displacement[m]," + heading + ".force[N]\n1," +
                                       heading + "," + (heading == name ? name : "yield") + ",1e-3,5\n");
  }
  std::string all;
  for (const std::string& name : k_hostile_names) {
    all += ' ' + shell_quoted("r/" + name);
  }
  const Outcome outcome = monograin("plot" + all + " -o all.svg");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  expect_good_figure(path("all.svg"));
  expect_nothing_was_run("all");
}

/// A text as a TOML string.
[[nodiscard]] std::string in_toml(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') result += '\\';
    result += byte < 0x20U ? fmt::format("\\u{:04x}", byte) : std::string(1, c);
  }
  return result + '"';
}

TEST_F(HostileNames, InDefinitionsOfFiguresAreText) {
  fs::create_directories(path("plots"));
  for (const std::string& name : k_hostile_names) {
    const std::string word = in_toml(name == "\xff\xfe" ? "TOML is UTF-8" : name);
    write_text(path("plots") / (name + ".toml"),
               "title = " + word + "\nsource = " + word + "\nx = \"t\"\ny = \"t\"\nx_label = " + word +
                   "\ny_label = " + word + "\n[[panel]]\nnote = " + word +
                   "\ncurve = [{ parameter = { from = 0, to = 1 }, legend = " + word + " }]\n");
  }
  const Outcome outcome = monograin("atlas -o out");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const std::string& name : k_hostile_names) expect_good_figure(path("out") / (name + ".svg"));
  expect_nothing_was_run("atlas");
}

TEST_F(HostileNames, InScenariosAreTextOrRefused) {
  for (const std::string& name : k_hostile_names) {
    if (name == "\xff\xfe") continue;
    const std::string word = in_toml(name);
    const std::string walls = "title = " + word + R"(
model = "hertz"
[particle]
radius = "1 mm"
[material]
youngs_modulus = "1 GPa"
poisson_ratio = 0.3
[loading]
configuration = "walls"
[[loading.wall]]
name = )" + word + R"(
normal = [0, 0, 1]
[[loading.wall]]
name = "other"
normal = [0, 0, -1]
fixed = true
[[loading.steps]]
displacement = "0.1 R0"
duration = "1 s"
)";
    write_text(path("walls.toml"), walls);
    const Outcome outcome = monograin("run walls.toml --plot -o out");
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 2) << name << outcome.err;
    EXPECT_EQ(outcome.err.find('\x1b'), std::string::npos) << name;
    expect_nothing_was_run(name);
    if (outcome.code != 0) continue;
    expect_good_figure(path("out/figure.svg"));
    const Table history = read_csv(path("out/history.csv"));
    EXPECT_EQ(history.header_value("status"), "complete") << name;
    EXPECT_EQ(Json::parse(text("out/run.json"))["classes"][0]["name"], name);
  }
}

// --- hostile files

TEST_F(HostileNames, InTheRecordOfARunReachNoOtherFolder) {
  write_text(path("p.csv"), "x,p\n0,2.75\n0.1,2.1\n0.2,1.7\n0.5,1.2\n");
  write_text(path("small.toml"), std::string(k_small) + "[mdr]\npressure_table = \"p.csv\"\n");
  ASSERT_EQ(monograin("run small.toml -o a/b/run").code, 0);
  const Json good = Json::parse(text("a/b/run/run.json"));
  fs::remove(path("p.csv"));
  const std::string absolute = path("outside.csv").string();
  for (const std::string& name : {std::string("../../outside.csv"), absolute, std::string("p\n.csv"),
                                  std::string("sub/../p.csv"), std::string("p\0.csv", 6)}) {
    Json run = good;
    std::string scenario = run["scenario"]["text"];
    scenario.replace(scenario.find("\"p.csv\""), 7, in_toml(name));
    run["scenario"]["text"] = scenario;
    run["scenario"]["files"]["mdr.pressure_table"]["name"] = name;
    run["scenario"]["name"] = "../../../x/" + name;
    write_text(path("a/b/run/run.json"), run.dump());
    const Strings before = files();
    const Outcome outcome = monograin("plot a/b/run --profile 0.5 -o figure.svg");
    EXPECT_EQ(outcome.code, 0) << name << outcome.err;
    for (const char* made : {"figure.svg", "figure.gp", "figure.dat", "figure.csv"}) fs::remove(path(made));
    EXPECT_EQ(files(), before) << name;
  }
}

TEST_F(HostileNames, InTheRecordOfARunOpenNoFile) {
  write_text(path("p.csv"), "x,p\n0,2.75\n0.1,2.1\n0.2,1.7\n0.5,1.2\n");
  write_text(path("small.toml"), std::string(k_small) + "[mdr]\npressure_table = \"p.csv\"\n");
  ASSERT_EQ(monograin("run small.toml -o run").code, 0);
  Json run = Json::parse(text("run/run.json"));
  run["scenario"]["files"] = Json::object();
  write_text(path("run/run.json"), run.dump());
  const Outcome outcome = monograin("plot run --profile 0.5");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("its text was not given"), std::string::npos) << outcome.err;
}

TEST_F(HostileNames, RecordsThatAreNoneAreRefused) {
  ASSERT_EQ(monograin("run small.toml -o run").code, 0);
  const Json good = Json::parse(text("run/run.json"));
  Strings texts{"",
                "{",
                "null",
                "[]",
                "{}",
                R"({"scenario": 1})",
                R"({"scenario": {"name": [], "text": {}}})",
                std::string(200'000, '['),
                text("run/run.json").substr(0, 700)};
  for (const char* key : {"name", "text", "overrides"}) {
    Json broken = good;
    broken["scenario"][key] = 5;
    texts.push_back(broken.dump());
    broken["scenario"].erase(key);
    texts.push_back(broken.dump());
  }
  for (const std::string& broken : texts) {
    write_text(path("run/run.json"), broken);
    const Outcome outcome = monograin("plot run --profile 0.5");
    EXPECT_EQ(outcome.code, 2) << broken.substr(0, 100);
    EXPECT_NE(outcome.err.find("run.json"), std::string::npos) << outcome.err;
  }
}

TEST_F(UserFiles, AFigureReplacesALinkInsteadOfWritingThroughIt) {
  ASSERT_EQ(monograin("run small.toml -o run").code, 0);
  write_text(path("precious"), "mine");
  for (const char* file : {"figure.svg", "figure.gp", "figure.dat"})
    fs::create_symlink("../precious", path("run") / file);
  EXPECT_EQ(monograin("plot run").code, 0);
  EXPECT_EQ(text("precious"), "mine");
  EXPECT_FALSE(fs::is_symlink(path("run/figure.gp")));
}

TEST_F(UserFiles, AreNotReplacedByFilesThatNobodyNamed) {
  ASSERT_EQ(monograin("run small.toml -o run").code, 0);
  write_text(path("sweep.toml"),
             "scenario = \"small.toml\"\n[vary]\n\"material.poisson_ratio\" = { values = [0.2, 0.3] }\n");
  fs::create_directories(path("plots"));
  write_text(path("plots/line.toml"),
             "title = \"t\"\nsource = \"s\"\n[[panel]]\n"
             "curve = [{ parameter = { from = 0, to = 1 }, x = \"t\", y = \"t\" }]\n");
  const std::pair<const char*, const char*> cases[] = {{"plot run -o both.svg", "both.dat"},
                                                       {"plot run -o two.svg", "two.gp"},
                                                       {"plot run --profile 0.5 -o p.svg", "p.csv"},
                                                       {"atlas line --plots plots -o plots", "plots/line.dat"},
                                                       {"sweep sweep.toml --design-only -o s", "s/design.csv"},
                                                       {"sweep sweep.toml -o s", "s/bands.csv"},
                                                       {"bench small.toml --rtol 1e-3 -o b", "b/bench.md"}};
  for (const auto& [command, file] : cases) {
    fs::create_directories(path(file).parent_path());
    write_text(path(file), "mine\n");
    const Outcome outcome = monograin(command);
    EXPECT_EQ(outcome.code, 2) << command;
    EXPECT_NE(outcome.err.find(std::string(file) + ": monograin has not written this file"), std::string::npos)
        << outcome.err;
    EXPECT_EQ(text(file), "mine\n") << command;
    fs::remove(path(file));
    EXPECT_EQ(monograin(command).code, 0) << command;
    EXPECT_EQ(monograin(command).code, 0) << command << ", once more";
  }
  EXPECT_EQ(monograin("sweep sweep.toml -o run").code, 2) << "the folder of a run";
}

TEST_F(UserFiles, PipesAndDevicesAreOnlyReadWhereTheCommandLineNamesThem) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  for (const char* name : {"pipe", "/dev/zero", "/dev/stdin", "/dev/tty"}) {
    write_text(path("t.toml"), std::string(k_small) + "[mdr]\npressure_table = \"" + name + "\"\n");
    write_text(path("s.toml"),
               fmt::format("scenario = \"{}\"\n[vary]\n\"material.poisson_ratio\" = {{ values = [0.2] }}\n", name));
    for (const char* command : {"run t.toml", "sweep s.toml"}) {
      const Outcome outcome = monograin(command);
      EXPECT_EQ(outcome.code, 2) << command;
      EXPECT_NE(outcome.err.find("this is a device or a pipe"), std::string::npos) << name << outcome.err;
    }
  }
  fs::create_directory(path("run"));
  for (const char* file : {"run.json", "history.csv"}) ASSERT_EQ(mkfifo((path("run") / file).c_str(), 0600), 0);
  EXPECT_EQ(monograin("plot run").code, 2);
  EXPECT_EQ(monograin("plot run --profile 0.5").code, 2);
  EXPECT_EQ(monograin("run small.toml -o run").code, 2);
  EXPECT_EQ(shell("cat small.toml | monograin check /dev/stdin").code, 0);
}

}  // namespace
}  // namespace monograin::user_files_test
