// What the program says of steps that do not go as they were meant to.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/command_test.hpp"
#include "history/table.hpp"

namespace monograin::program_command_test {
namespace {

class ProgramCommand : public CommandTest {
 protected:
  /// A scenario with this program and output, run.
  Outcome run(const std::string& steps, const std::string& output = "points = 10") {
    write(steps, output);
    return monograin("run s.toml -o out");
  }
  void write(const std::string& steps, const std::string& output) {
    write_text(path("s.toml"), R"(model = "mdr"
particle.radius = "10 mm"
material = { youngs_modulus = "1 GPa", poisson_ratio = 0.3, yield_stress = "50 MPa" }
output = { )" + output + R"( }
mdr.radius_rule = "yielded"
[loading]
configuration = "simple"
steps = [)" + steps + "]\n");
  }
  [[nodiscard]] nlohmann::json warnings() const { return nlohmann::json::parse(text("out/run.json"))["warnings"]; }
};

TEST_F(ProgramCommand, SaysThatAConditionHoldsWhereItsStepBegins) {
  const Outcome outcome = run(R"({ displacement = "0.1 R0", duration = "1 s", until = { force = "1000 N" } },
                                 { displacement = "0 R0", duration = "1 s", until = { force = "1000 N" } })");
  EXPECT_EQ(outcome.code, 0);
  const std::string note = "step 2: until axial.force = 1000 N holds where the step begins, and ends it there";
  EXPECT_NE(outcome.err.find("warning: " + note), std::string::npos) << outcome.err;
  EXPECT_EQ(warnings(), nlohmann::json::array({note}));
}

TEST_F(ProgramCommand, SaysThatAConditionIsNeverMet) {
  const Outcome outcome = run(R"({ displacement = "0.1 R0", duration = "1 s" },
                                 { displacement = "0.2 R0", duration = "1 s", until = { force = "100 N" } })");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.err.find("step 2: until axial.force = 100 N was never met: it lay behind where the step began ("),
            std::string::npos)
      << outcome.err;
  EXPECT_EQ(warnings().size(), 1U);
}

TEST_F(ProgramCommand, SaysThatTimesLieBeyondTheProgramBeforeAndAfterARun) {
  const std::string steps = R"({ displacement = "0.1 R0", duration = "1 s" }, { displacement = 0, rate = "1 mm/s" })";
  const std::string note = "1 of 2 output times lies beyond the end of the program, t = 2 s: no rows there";
  const Outcome outcome = run(steps, "times = [0.5, 3]");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(warnings(), nlohmann::json::array({note}));
  const Outcome checked = monograin("check s.toml");
  EXPECT_EQ(checked.code, 0);
  EXPECT_EQ(checked.err, "s: warning: " + note + "\n");
}

TEST_F(ProgramCommand, SaysThatPointsBesideTimesAreIgnored) {
  const std::string note = "[output] points = 7 is ignored: times say where the rows are";
  const Outcome outcome = run(R"({ displacement = "0.1 R0", duration = "1 s" })", "points = 7, times = [0.5]");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.err.find("warning: " + note), std::string::npos) << outcome.err;
  EXPECT_EQ(monograin("check s.toml").err, "s: warning: " + note + "\n");
  // Points that nobody has asked for are not.
  write(R"({ displacement = "0.1 R0", duration = "1 s" })", "times = [0.5]");
  EXPECT_EQ(monograin("check s.toml").err, "");
}

TEST_F(ProgramCommand, RecordsAWithdrawalWithAsManyRowsAsAreAskedFor) {
  ASSERT_EQ(run(R"({ displacement = "0.1 R0", duration = "1 s" }, { detach = true, rate = "1 mm/s" })").code, 0);
  const Table history = read_csv(path("out/history.csv"));
  int rows = 0;
  for (std::size_t i = 0; i < history.row_count(); ++i) {
    rows += history.at(i, *history.find("step")) == 2.0 && history.at(i, *history.find("row")) == 0.0 ? 1 : 0;
  }
  EXPECT_EQ(rows, 10);
}

}  // namespace
}  // namespace monograin::program_command_test
