// `monograin check` of every kind of file, and `monograin units`.

#include <fstream>
#include <string>

#include "cli/command_test.hpp"

namespace monograin::check_command_test {
namespace {

class CheckCommand : public CommandTest {
 protected:
  CheckCommand() {
    write("good.toml", scenario("mdr", ""));
    write("bad.toml", scenario("mdr", "oops = 1\n"));
    write(
        "sweep.toml",
        "scenario = \"good.toml\"\ndesign = \"grid\"\n[vary]\n\"material.poisson_ratio\" = { values = [0.2, 0.3] }\n");
    write("listed.toml", "scenario = \"good.toml\"\ndesign = \"table\"\ntable = \"runs.csv\"\n");
    write("runs.csv", "material.poisson_ratio\n0.2\n0.3\n");
    write("path.csv", "t[s],x[mm]\n0,0\n1,1\n2,0.5\n");
  }

  void write(const std::string& name, const std::string& content) const { std::ofstream(path(name)) << content; }

  [[nodiscard]] static std::string scenario(const std::string& model, const std::string& more) {
    return "model = \"" + model +
           "\"\n[particle]\nradius = \"10 mm\"\n[material]\nyoungs_modulus = \"1 GPa\"\npoisson_ratio = 0.3\n"
           "yield_stress = \"50 MPa\"\n[loading]\nconfiguration = \"die\"\nsteps = [{ displacement = \"0.1 R0\", "
           "duration = 1 }]\n[output]\npoints = 4\n" +
           more;
  }
};

TEST_F(CheckCommand, SaysWhichKindEachFileIs) {
  const std::string source = MONOGRAIN_SOURCE_DIR;
  const std::string sobol = source + "/scenarios/sweeps/sobol-indices.toml";
  const std::string fit = source + "/scenarios/calibrate/uniaxial.toml";
  const std::string plan = source + "/scenarios/design/uniaxial.toml";
  const std::string figure = source + "/plots/mdr-12-die.toml";
  const std::string table = source + "/plots/nonlocal-fe.toml";
  const Outcome outcome = monograin("check good.toml sweep.toml listed.toml " + sobol + " " + fit + " " + plan + " " +
                                    figure + " " + table);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "good.toml: scenario, valid\nsweep.toml: sweep, valid\nlisted.toml: sweep, valid\n" + sobol +
                             ": sensitivity, valid\n" + fit + ": calibration, valid\n" + plan + ": design, valid\n" +
                             figure + ": figure definition, valid\n" + table + ": figure definition, valid\n");
}

TEST_F(CheckCommand, ReportsTheFaultsOfAllFilesTogether) {
  write("sweep.toml",
        "scenario = \"good.toml\"\ndesign = \"grit\"\n[vary]\n\"material.poisson_ratio\" = { values = [0.2] }\n");
  const Outcome outcome = monograin("check bad.toml good.toml sweep.toml none.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "bad.toml: scenario, 1 fault\ngood.toml: scenario, valid\nsweep.toml: sweep, 1 fault\n");
  EXPECT_NE(outcome.err.find("bad.toml:13:1: unknown key 'oops' in [output]"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("sweep.toml:2:10: design = \"grit\""), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("none.toml"), std::string::npos) << outcome.err;
}

TEST_F(CheckCommand, DoubtsNumbersOfASweepThatLackAUnitAsTheSweepDoes) {
  write("sweep.toml", "scenario = \"good.toml\"\n[vary]\n\"material.yield_stress\" = { values = [20, 30] }\n");
  const std::string doubt =
      "sweep: warning: yield_stress = 30 has no unit and is taken as 30 Pa; if another unit is meant, write it: \"30 "
      "MPa\"\n";
  const Outcome outcome = monograin("check sweep.toml");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "sweep.toml: sweep, valid\n");
  EXPECT_EQ(outcome.err, doubt);
  EXPECT_TRUE(monograin("sweep sweep.toml").err.starts_with(doubt));
}

TEST_F(CheckCommand, OverridesKeysOfScenariosOnly) {
  EXPECT_EQ(monograin("check good.toml --set material.poisson_ratio=0.2").code, 0);
  const Outcome outcome = monograin("check sweep.toml --set material.poisson_ratio=0.2");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "sweep.toml:1:1: --set overrides keys of scenarios, and this is a sweep\n");
}

TEST_F(CheckCommand, RefusesADirectSolutionThatTheSceneDoesNotHave) {
  write("cel.toml", scenario("cel", "[numerics]\nintegrator = \"direct\"\n"));
  const Outcome outcome = monograin("check cel.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(outcome.err.starts_with("cel.toml:14:14: integrator = \"direct\": the state of this scene depends on"))
      << outcome.err;
  EXPECT_EQ(monograin("run cel.toml").err, outcome.err);
  EXPECT_FALSE(exists(path("runs")));
}

TEST_F(CheckCommand, RunsAnIntegratorByItsFormerName) {
  const std::string numerics = "[numerics]\nrtol = 1e-2\nintegrator = ";
  write("former.toml", scenario("mdr", numerics + "\"explicit\"\n"));
  ASSERT_EQ(monograin("run former.toml").code, 0);
  EXPECT_NE(text("runs/former/history.csv").find("# integrator: forward-euler\n"), std::string::npos);
}

TEST_F(CheckCommand, LeavesTheTableOfAProgramInTheRun) {
  std::string driven = scenario("mdr", "");
  const std::string target = "\"0.1 R0\", duration = 1";
  driven.replace(driven.find(target), target.size(), "{ table = \"path.csv\", time = \"t\", value = \"x\" }");
  write("driven.toml", driven);
  ASSERT_EQ(monograin("run driven.toml").code, 0) << text("stderr.txt");
  remove(path("path.csv"));
  EXPECT_EQ(monograin("run driven.toml").code, 2);
  EXPECT_EQ(monograin("plot runs/driven --profile 1.5").code, 0) << text("stderr.txt");
}

TEST_F(CheckCommand, PrintsTheUnitsOfEveryDimension) {
  const Outcome outcome = monograin("units");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.out.find("\nlength           m          m, cm, mm, um, "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("\nfrequency        Hz         Hz, mHz, kHz, MHz\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find(", in, R0\n"), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace monograin::check_command_test
