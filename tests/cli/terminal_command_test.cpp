// The standard streams, the command line and the memory of the program, as a shell hands them over.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "cli/command_test.hpp"
#include "support/refusal.hpp"

namespace monograin::terminal_command_test {
namespace {

namespace fs = std::filesystem;

class Terminal : public CommandTest {
 protected:
  void SetUp() override {
    write_text(path("small.toml"), k_small);
    write_text(path("a.csv"), "time[s],force[N]\n0,0\n1,2\n");
  }

  static constexpr const char* k_small = R"(model = "hertz"
[particle]
radius = "1 mm"
[material]
youngs_modulus = "1 GPa"
poisson_ratio = 0.3
[loading]
configuration = "simple"
[[loading.steps]]
displacement = "0.1 R0"
duration = "1 s"
[output]
points = 10
)";
};

TEST_F(Terminal, ARunEndsAsAlwaysWhereStandardErrorIsClosedOrFull) {
  for (const char* stream : {"2>&-", "2>/dev/full", "2>&- >&- <&-"}) {
    fs::remove_all(path("out"));
    EXPECT_EQ(shell(std::string("$M run small.toml -o out ") + stream).code, 0) << stream;
    EXPECT_TRUE(fs::exists(path("out/history.csv"))) << stream;
  }
  EXPECT_EQ(shell("$M run missing.toml 2>&-").code, 2);
}

TEST_F(Terminal, WhatIsSaidGoesToNoFileWhereStandardErrorIsClosed) {
  ASSERT_EQ(monograin("run small.toml -o open").code, 0);
  ASSERT_EQ(shell("$M run small.toml -o closed 2>&-").code, 0);
  EXPECT_EQ(text("open/history.csv"), text("closed/history.csv"));
  EXPECT_EQ(text("open/events.csv"), text("closed/events.csv"));
}

TEST_F(Terminal, LostDataExitWithTwoAndAMessageInEveryCommandThatPrintsThem) {
  fs::create_directories(path("s"));
  fs::copy_file(path("small.toml"), path("s/small.toml"));
  ASSERT_EQ(monograin("regress --accept --scenarios s --curves c").code, 0);
  write_text(path("sweep.toml"),
             "scenario = \"small.toml\"\ndesign = \"maxpro\"\nruns = 3\n[vary]\n"
             "\"material.poisson_ratio\" = { from = 0.2, to = 0.4 }\n");
  ASSERT_EQ(monograin("run small.toml -o data").code, 0);
  write_text(path("fit.toml"),
             "scenario = \"small.toml\"\n[data]\nfile = \"data/history.csv\"\nx = \"axial.displacement[m]\"\n"
             "y = \"axial.force[N]\"\n[free]\n\"material.youngs_modulus\" = { from = \"0.1 GPa\", to = \"10 GPa\" }\n");
  fs::create_directory(path("plots"));
  write_text(path("plots/line.toml"),
             "title = \"t\"\nsource = \"s\"\n[[panel]]\n"
             "curve = [{ parameter = { from = 0, to = 1 }, x = \"t\", y = \"t\" }]\n");
  for (const std::string& arguments :
       {std::string("--help"), std::string("--version"), std::string("run --help"), std::string("models"),
        std::string("models hertz"), std::string("models --parameters small.toml"), std::string("schema"),
        std::string("compare a.csv a.csv"), std::string("regress --scenarios s --curves c"),
        std::string("sweep sweep.toml --design-only"), std::string("calibrate fit.toml"), std::string("atlas --list"),
        std::string("bench small.toml --integrator auto --rtol 1e-3 -o b"), std::string("stress small.toml"),
        std::string("stress --scenes 1 --first 3 -o t")}) {
    ASSERT_EQ(monograin(arguments).code, 0) << arguments << text("stderr.txt");
    for (const char* stream : {" >/dev/full", " >&-"}) {
      const Outcome outcome = monograin(arguments + stream);
      EXPECT_EQ(outcome.code, 2) << arguments << stream;
      EXPECT_TRUE(contains(outcome.err, "standard output is closed or full")) << arguments << stream << outcome.err;
    }
  }
}

TEST_F(Terminal, AReaderThatLeavesEarlyIsALostOutputAndNoSignal) {
  // The reader has left before the program starts to write.
  const Outcome outcome = shell("{ sleep 0.2; $M schema; echo $? > code.txt; } | true; sleep 0.5");
  EXPECT_EQ(text("code.txt"), "2\n") << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "standard output is closed or full")) << outcome.err;
}

TEST_F(Terminal, AFaultOfTheCommandLineIsNamedWithWhatIsExpected) {
  const auto fault = [&](const std::string& arguments) {
    const Outcome outcome = monograin(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    return outcome.err;
  };
  EXPECT_TRUE(contains(fault(""), "a command is missing; there are run, check, "));
  EXPECT_TRUE(contains(fault("compare a.csv"), "compare: B is missing; expected: What to hold against it"));
  EXPECT_TRUE(contains(fault("compare a.csv a.csv --tol x"), "--tol = x is not what it takes; expected: Exit with 5"));
  EXPECT_TRUE(contains(fault("compare a.csv a.csv --tol=-1"), "--tol = -1 is not what it takes"));
  EXPECT_TRUE(contains(fault("stress --time bogus"), "--time = bogus is not what it takes"));
  EXPECT_TRUE(contains(fault("stress --seed -1"), "--seed = -1 is not what it takes"));
  EXPECT_TRUE(contains(fault("bench --redraw none.csv"), "--redraw = none.csv: there is no such file"));
  EXPECT_TRUE(contains(fault("bench --redraw a.csv --against-fe"), "exclude each other"));
  EXPECT_TRUE(contains(fault("--quiet run"), "'--quiet' is not expected here; expected it after the command"));
  write_text(path("b.csv"), "run,end.axial.displacement[m],end.axial.force[N]\n1,0,0\n2,1,2\n");
  EXPECT_TRUE(contains(fault("plot b.csv"), "b.csv: has no column 'time'"));
  EXPECT_TRUE(contains(fault("plot small.toml"), "'monograin run --plot' draws a scenario"));
  write_text(path("sweep.toml"),
             "scenario = \"small.toml\"\n[vary]\n\"material.poisson_ratio\" = { values = [0.2, 0.3] }\n");
  EXPECT_TRUE(contains(fault("run sweep.toml"), "this is a sweep, for 'monograin sweep'; expected a scenario"));
  EXPECT_TRUE(
      contains(fault("calibrate small.toml"), "this is a scenario, for 'monograin run'; expected a calibration"));
  EXPECT_TRUE(contains(fault("run --outptu=x"), "'--outptu=x' is not expected here; did you mean '--output'?"));
  EXPECT_TRUE(contains(fault("compare a.csv a.csv c.csv"), "'c.csv' is not expected here"));
  EXPECT_TRUE(contains(fault("run -o"), "--output needs a value; expected: Folder of the run"));
}

// --- standard input

TEST_F(Terminal, AHyphenIsStandardInputWhereAFileIsExpected) {
  ASSERT_EQ(monograin("run small.toml").code, 0);
  const Outcome run = shell("$M run - < small.toml");
  EXPECT_EQ(run.code, 0) << run.err;
  const auto rows = [](const std::string& csv) { return csv.substr(csv.find("\ntime[s]")); };
  EXPECT_EQ(rows(text("runs/stdin/history.csv")), rows(text("runs/small/history.csv")));
  EXPECT_EQ(shell("$M check - < small.toml").code, 0);
  const Outcome broken = shell("echo 'model = ' | $M check -");
  EXPECT_EQ(broken.code, 2);
  EXPECT_TRUE(broken.err.starts_with("stdin:1:9: ")) << broken.err;
  EXPECT_EQ(shell("$M models --parameters - < small.toml").out, monograin("models --parameters small.toml").out);
  EXPECT_EQ(shell("$M compare a.csv - --tol 0 < a.csv").code, 0);
  EXPECT_EQ(shell("$M compare - a.csv --tol 0 < a.csv").code, 0);
  EXPECT_EQ(shell("sed 's/1,2/1,3/' a.csv | $M compare a.csv - --tol 0").code, 5);
  write_text(path("sweep.toml"),
             "scenario = \"small.toml\"\ndesign = \"grid\"\n[vary]\n"
             "\"material.poisson_ratio\" = { from = 0.2, to = 0.4, points = 3 }\n");
  EXPECT_EQ(shell("$M sweep - -o swept < sweep.toml").code, 0);
  EXPECT_TRUE(fs::exists(path("swept/results.csv")));
}

TEST_F(Terminal, AStandardInputThatCannotBeReadIsNotAnEmptyScenario) {
  for (const char* input : {"<&-", "< ."}) {
    const Outcome outcome = shell(std::string("$M run - ") + input);
    EXPECT_EQ(outcome.code, 2) << input;
    EXPECT_TRUE(outcome.err.starts_with("stdin:1:1: it cannot be read")) << input << ": " << outcome.err;
  }
}

// --- sizes

TEST_F(Terminal, TwentyFaultsAreShownAndTheOthersCounted) {
  std::string keys;
  for (int k = 0; k < 30000; ++k) keys += "unknown_key_" + std::to_string(k) + " = 1\n";
  write_text(path("keys.toml"), keys + k_small);
  const Outcome outcome = monograin("check keys.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 21);
  EXPECT_TRUE(contains(outcome.err, "keys.toml:20:1: unknown key 'unknown_key_19' in the scenario")) << outcome.err;
  EXPECT_TRUE(outcome.err.ends_with("\nand 29980 more faults\n")) << outcome.err;
}

TEST_F(Terminal, SizesBeyondAllUseAreRefusedAtTheirPlace) {
  const auto refusal_of = [&](const std::string& arguments) {
    const Outcome outcome = monograin(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    return outcome.err;
  };
  const std::string small = k_small;
  const std::string head = small.substr(0, small.find("[[loading.steps]]"));
  const std::string cycle =
      "[[loading.steps]]\ncycle = 50000\nsteps = [{ displacement = \"0.1 R0\", duration = 1 }, "
      "{ displacement = 0, duration = 1 }]\n";
  write_text(path("rows.toml"), head + cycle + "[output]\npoints = 1000\n");
  EXPECT_TRUE(refusal_of("run rows.toml")
                  .starts_with("rows.toml:13:10: points = 1000 in each of 100000 steps are 1e+08 "
                               "rows; expected at most 20 million"))
      << text("stderr.txt");
  EXPECT_TRUE(refusal_of("run rows.toml --set loading.steps[0].cycle=1000000000")
                  .ends_with("cycle = 1000000000: expected a whole number from 1 to 100000\n"))
      << text("stderr.txt");
  write_text(path("deep.toml"), "x = " + std::string(1000, '[') + std::string(1000, ']') + '\n');
  EXPECT_EQ(refusal_of("check deep.toml"),
            "deep.toml:1:261: not valid TOML: arrays or braces are nested too deeply; expected at most 256 levels\n");
  write_text(path("long.csv"), "time[s],force[N]\n0,0\n" + std::string(std::size_t{2} << 20U, '1') + ",1\n");
  EXPECT_EQ(refusal_of("compare a.csv long.csv"),
            "monograin: long.csv:3:1048577: the line is too long; expected at most 1 MiB\n");
}

// --- messages of libraries

TEST_F(Terminal, FilesThatTheSystemRefusesAreNamedInOwnWords) {
  write_text(path("file"), "");
  for (const std::string& arguments :
       {std::string("run small.toml -o file/out"), std::string("sweep sweep.toml -o file/out"),
        std::string("regress --accept --scenarios . --curves file/out"), std::string("compare a.csv file/out"),
        std::string("compare a.csv ."), std::string("plot file/out")}) {
    if (arguments.starts_with("sweep")) {
      write_text(path("sweep.toml"),
                 "scenario = \"small.toml\"\ndesign = \"grid\"\n[vary]\n"
                 "\"material.poisson_ratio\" = { from = 0.2, to = 0.4, points = 2 }\n");
    } else {
      fs::remove(path("sweep.toml"));
    }
    const Outcome outcome = monograin(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << outcome.err;
    for (const char* raw : {"filesystem error", "basic_", "std::", "json.exception", "toml"}) {
      if (std::string(raw) == "toml" && contains(outcome.err, "small.toml")) continue;
      EXPECT_FALSE(contains(outcome.err, raw)) << arguments << outcome.err;
    }
    EXPECT_FALSE(outcome.err.empty()) << arguments;
  }
}

TEST_F(Terminal, LongWorkShowsABarThatATerminalCanClear) {
  const std::string source = MONOGRAIN_SOURCE_DIR;
  const auto shown = [&](const std::string& environment, const std::string& work) {
    fs::remove_all(path("out"));
    return shell("env -u NO_COLOR " + environment + " script -qec \"'$M' " + work + " -o out\" /dev/null </dev/null")
        .out;
  };
  const std::string atlas = "atlas laws-fe semimech-tables --plots '" + source + "/plots'";
  const std::string bar = "/2 figures, ";
  EXPECT_TRUE(contains(shown("TERM=xterm", atlas), bar));
  for (const char* environment : {"TERM=dumb", "TERM=xterm NO_COLOR=1"}) {
    EXPECT_FALSE(contains(shown(environment, atlas), bar)) << environment;
  }
  EXPECT_FALSE(contains(monograin(atlas + " -o piped").err, bar));
  const std::string fit = "calibrate '" + source + "/scenarios/calibrate/material-point.toml'";
  EXPECT_TRUE(contains(shown("TERM=xterm", fit), "%  of the search, "));
  // A few thousand of these runs may be over before a bar is due.
  write_text(path("repeat.toml"),
             "scenario = \"small.toml\"\ndesign = \"grid\"\n[vary]\n"
             "\"material.poisson_ratio\" = { from = 0.2, to = 0.4, points = 40000 }\n");
  EXPECT_TRUE(contains(shown("TERM=xterm", "sweep repeat.toml"), "/40000 runs, "));
}

}  // namespace
}  // namespace monograin::terminal_command_test
