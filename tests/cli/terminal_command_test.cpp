// The standard streams, the command line and the memory of the program, as a shell hands them over.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/command_test.hpp"
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
  const std::string plots = " --plots '" MONOGRAIN_SOURCE_DIR "/plots'";
  for (const std::string& arguments :
       {std::string("--help"), std::string("--version"), std::string("run --help"), std::string("models"),
        std::string("models hertz"), std::string("models --parameters small.toml"), std::string("schema"),
        std::string("compare a.csv a.csv"), std::string("regress --scenarios s --curves c"),
        std::string("sweep sweep.toml --design-only"), std::string("calibrate fit.toml"), "atlas --list" + plots,
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
  EXPECT_TRUE(contains(fault("run --outptu=x"), "'--outptu=x' is not expected here; did you mean '--output'?"));
  EXPECT_TRUE(contains(fault("compare a.csv a.csv c.csv"), "'c.csv' is not expected here"));
  EXPECT_TRUE(contains(fault("run -o"), "--output needs a value; expected: Folder of the run"));
}

}  // namespace
}  // namespace monograin::terminal_command_test
