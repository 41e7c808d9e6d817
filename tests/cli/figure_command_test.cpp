// The option --figure of the commands that leave figures, as processes of their own.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "cli/command_test.hpp"

namespace monograin::figure_command_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_source = MONOGRAIN_SOURCE_DIR;

class FigureCommand : public CommandTest {
 protected:
  void SetUp() override {
    write_text(path("small.toml"), read_text(fs::path(k_source) / "scenarios/uniaxial.toml"));
    write_text(path("indices.toml"), R"toml(scenario = "small.toml"
design = "saltelli"
samples = 8
results = ["max.axial.force"]
[vary]
"material.yield_stress" = { from = "20 MPa", to = "100 MPa" }
"material.poisson_ratio" = { from = 0.2, to = 0.4 }
)toml");
    write_text(path("bands.toml"), R"toml(scenario = "small.toml"
design = "grid"
histories = true
[vary]
"material.yield_stress" = { from = "20 MPa", to = "100 MPa", points = 4 }
[bands]
x = "axial.displacement"
y = ["axial.force"]
)toml");
  }
  /// Runs a command whose figure is to have a format.
  void expect_figure(const std::string& command, const std::string& name, const std::string& format) const {
    const Outcome outcome = monograin(command + " --figure " + format);
    EXPECT_EQ(outcome.code, 0) << command << '\n' << outcome.err;
    EXPECT_EQ(outcome.err.find("no figure"), std::string::npos) << outcome.err;
    const std::string figure = text(name + '.' + format);
    EXPECT_TRUE(figure.starts_with(format == "pdf" ? "%PDF" : format == "png" ? "\x89PNG" : "<?xml")) << command;
    EXPECT_NE(text(name + ".gp").find("'./" + fs::path(name).filename().string() + '.' + format + '\''),
              std::string::npos)
        << command;
  }
};

TEST_F(FigureCommand, EveryCommandWithAFigureTakesItsFormat) {
  const std::string source = k_source;
  expect_figure("run small.toml -o run", "run/figure", "pdf");
  EXPECT_FALSE(fs::exists(path("run/figure.svg")));
  expect_figure("plot run", "run/figure", "png");
  expect_figure("plot run --profile 0.5", "run/profile", "pdf");
  expect_figure("data '" + source + "/scenarios/calibrate/uniaxial.csv'", "uniaxial-data", "png");
  expect_figure("design '" + source + "/scenarios/design/uniaxial.toml' -o plan", "plan/figure", "pdf");
  expect_figure("sensitivity indices.toml -o indices", "indices/sensitivity", "pdf");
  expect_figure("sweep bands.toml -o bands", "bands/bands", "png");
  expect_figure("atlas mdr-8-force --plots '" + source + "/plots' -o atlas", "atlas/mdr-8-force", "pdf");
  ASSERT_EQ(shell("grep -e '^#' -e '^scene,' -e '^die,' '" + source + "/plots/bench.csv' > one.csv").code, 0);
  expect_figure("bench --redraw one.csv -o bench", "bench/bench-die", "pdf");
}

TEST_F(FigureCommand, ElementaryEffectsHaveTheUnitOfTheirResult) {
  std::string effects = text("indices.toml");
  effects.replace(effects.find("saltelli"), 8, "morris");
  effects.replace(effects.find("[\"max.axial.force\"]"), 19, "[\"max.axial.force\", \"max.axial.force / 2\"]");
  write_text(path("effects.toml"), effects);
  ASSERT_EQ(monograin("sensitivity effects.toml -o effects").code, 0) << text("stderr.txt");
  const std::string script = text("effects/sensitivity.gp");
  EXPECT_NE(script.find("Mean size of effects, 95 % intervals [N]"), std::string::npos) << script;
  EXPECT_NE(script.find("Their standard deviation [N]"), std::string::npos) << script;
  EXPECT_NE(script.find("Mean size of effects, 95 % intervals'"), std::string::npos) << "of a formula: " << script;
}

TEST_F(FigureCommand, ReportsOfFitsNameTheirFigures) {
  const std::string fits = std::string("'") + k_source + "/scenarios/calibrate/cel.toml' '" + k_source +
                           "/scenarios/calibrate/cel-by-mdr.toml'";
  expect_figure("calibrate " + fits + " --report --quiet -o fits", "fits/comparison", "png");
  EXPECT_TRUE(text("fits/cel/figure.png").starts_with("\x89PNG"));
  EXPECT_NE(text("fits/report.md").find("](comparison.png)"), std::string::npos) << text("fits/report.md");
  EXPECT_NE(text("fits/cel/report.md").find("](figure.png)"), std::string::npos) << text("fits/cel/report.md");
}

TEST_F(FigureCommand, ReplacesTheFigureOfAnEarlierResultInAnotherFormat) {
  const std::string plan = std::string("design '") + k_source + "/scenarios/design/uniaxial.toml' -o plan";
  expect_figure(plan, "plan/figure", "svg");
  expect_figure(plan, "plan/figure", "pdf");
  EXPECT_FALSE(fs::exists(path("plan/figure.svg")));
  expect_figure("sweep bands.toml -o bands", "bands/bands", "pdf");
  write_text(path("bands/bands.png"), "converted by the user");
  const Outcome other = monograin("sweep indices.toml -o bands");
  EXPECT_EQ(other.code, 0) << other.err;
  EXPECT_FALSE(fs::exists(path("bands/bands.pdf"))) << "of another sweep";
  EXPECT_FALSE(fs::exists(path("bands/bands.gp")));
  EXPECT_EQ(text("bands/bands.png"), "converted by the user");
}

TEST_F(FigureCommand, RefusesOtherFormatsAndASecondName) {
  const Outcome unknown = monograin("run small.toml --figure eps");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.err.find("--figure = eps is not what it takes"), std::string::npos) << unknown.err;
  EXPECT_NE(unknown.err.find("svg, pdf or png"), std::string::npos) << unknown.err;
  EXPECT_FALSE(fs::exists(path("runs")));
  const std::string data = std::string("data '") + k_source + "/scenarios/calibrate/uniaxial.csv'";
  ASSERT_EQ(monograin("run small.toml -o run").code, 0);
  for (const std::string& command : {std::string("plot run"), data}) {
    const Outcome both = monograin(command + " --figure pdf -o a.svg");
    EXPECT_EQ(both.code, 2) << command;
    EXPECT_NE(both.err.find("exclude each other"), std::string::npos) << both.err;
  }
  EXPECT_EQ(monograin("plot run --vtk --figure pdf").code, 2);
  EXPECT_FALSE(fs::exists(path("a.svg")));
}

}  // namespace
}  // namespace monograin::figure_command_test
