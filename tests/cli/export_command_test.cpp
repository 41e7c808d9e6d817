// `monograin export` and `monograin plot --vtk`.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "cli/command_test.hpp"
#include "history/table.hpp"
#include "support/refusal.hpp"

namespace monograin {
namespace {

const std::string k_scenarios = "'" MONOGRAIN_SOURCE_DIR "/scenarios/";

using ExportCommand = CommandTest;

TEST_F(ExportCommand, PrintsForceOverDisplacementAsATable) {
  const Outcome outcome = monograin("export table " + k_scenarios + "uniaxial.toml' --set output.points=10");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.starts_with("# program: monograin "));
  EXPECT_TRUE(contains(outcome.out, "\n# status: complete\n"));
  EXPECT_TRUE(contains(outcome.out, "\nbranch,axial.displacement[m],axial.force[N]\n1,0,0\n"));
  EXPECT_EQ(files(), std::vector<std::string>{});
}

TEST_F(ExportCommand, WritesAFileAndReplacesOnlyItsOwn) {
  EXPECT_EQ(monograin("export table " + k_scenarios + "uniaxial.toml' -o force.csv").code, 0);
  EXPECT_GT(read_csv(path("force.csv")).row_count(), 100U);
  EXPECT_EQ(monograin("export lammps " + k_scenarios + "die.toml' -o force.csv").code, 0);
  EXPECT_TRUE(contains(text("force.csv"), "pair_coeff * * mdr "));
  write_text(path("notes.txt"), "mine\n");
  const Outcome outcome = monograin("export table " + k_scenarios + "uniaxial.toml' -o notes.txt");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(contains(outcome.err, "notes.txt: monograin has not written this file")) << outcome.err;
  EXPECT_EQ(text("notes.txt"), "mine\n");
}

TEST_F(ExportCommand, WritesWhereALinkLeadsAndToStandardOutput) {
  namespace fs = std::filesystem;
  const std::string table = "export table " + k_scenarios + "uniaxial.toml' -o ";
  ASSERT_EQ(monograin(table + "force.csv").code, 0);
  const std::string expected = text("force.csv");
  fs::create_symlink("there.csv", path("link.csv"));
  EXPECT_EQ(monograin(table + "link.csv").code, 0);
  EXPECT_TRUE(fs::is_symlink(path("link.csv")));
  EXPECT_EQ(text("there.csv"), expected);
  for (const char* place : {"-", "/dev/stdout"}) EXPECT_EQ(monograin(table + place).out, expected) << place;
  fs::create_directory(path("folder"));
  const Outcome folder = monograin(table + "folder");
  EXPECT_EQ(folder.code, 2);
  EXPECT_TRUE(contains(folder.err, "folder: cannot be written: Is a directory")) << folder.err;
  EXPECT_FALSE(fs::exists(path("-")));
}

TEST_F(ExportCommand, NamesWhatItExpectsInstead) {
  const Outcome model = monograin("export lammps " + k_scenarios + "cel.toml'");
  EXPECT_EQ(model.code, 2);
  EXPECT_TRUE(contains(model.err, "cel.toml: LAMMPS has no contact law with the equations of model cel")) << model.err;
  EXPECT_EQ(model.out, "");
  const Outcome wall = monograin("export table " + k_scenarios + "die.toml' --wall top");
  EXPECT_EQ(wall.code, 2);
  EXPECT_TRUE(contains(wall.err, "there is no contact class 'top'; the scene has axial, lateral")) << wall.err;
  const Outcome packing = monograin("export table " + k_scenarios + "packing.toml'");
  EXPECT_EQ(packing.code, 2);
  EXPECT_TRUE(contains(packing.err, "model packing has no particle between walls")) << packing.err;
  for (const char* line : {"export", "export chart"}) {
    const Outcome kind = monograin(line);
    EXPECT_EQ(kind.code, 2);
    EXPECT_TRUE(contains(kind.err, "monograin: export: expected one of lammps, table.")) << kind.err;
  }
  const Outcome file = monograin("export table");
  EXPECT_EQ(file.code, 2);
  EXPECT_TRUE(contains(file.err, "monograin: export table: FILE is missing; expected: Scenario file")) << file.err;
}

TEST_F(ExportCommand, KeepsWhatARunReachedBeforeItLeftTheDomain) {
  const Outcome outcome =
      monograin("export table " + k_scenarios + "cel.toml' --set 'loading.steps[0].displacement=0.9 R0'");
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "stopped")) << outcome.err;
  EXPECT_GT(std::ranges::count(outcome.out, '\n'), 50);
}

TEST_F(ExportCommand, WritesTheParticleOfARunForParaView) {
  ASSERT_EQ(monograin("run " + k_scenarios + "die.toml' --set output.points=5").code, 0);
  const std::filesystem::path run = std::filesystem::directory_iterator(path("runs"))->path();
  const Outcome outcome = monograin("plot '" + run.string() + "' --vtk");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(run / "vtk" / "run.pvd"));
  EXPECT_TRUE(std::filesystem::exists(run / "vtk" / "particle-0000.vtp"));
  EXPECT_TRUE(std::filesystem::exists(run / "vtk" / "walls-0000.vtp"));
  EXPECT_EQ(monograin("plot '" + run.string() + "' --vtk -o other").code, 0);
  EXPECT_EQ(text("other/run.pvd"), read_text(run / "vtk" / "run.pvd"));
}

TEST_F(ExportCommand, NamesAColumnThatAHistoryLacks) {
  ASSERT_EQ(
      shell("monograin run " + k_scenarios + "hertz.toml' -o h && sed -i s/axial.force/axial.push/ h/history.csv").code,
      0);
  const Outcome outcome = monograin("plot h --vtk");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(contains(outcome.err, "h: the history has no column axial.force")) << outcome.err;
}

TEST_F(ExportCommand, RefusesParaViewWithoutAParticleOrWithOtherChoices) {
  ASSERT_EQ(monograin("run " + k_scenarios + "packing.toml' -o p").code, 0);
  const Outcome packing = monograin("plot p --vtk");
  EXPECT_EQ(packing.code, 2);
  EXPECT_TRUE(contains(packing.err, "p: model packing has no particle between walls")) << packing.err;
  EXPECT_FALSE(std::filesystem::exists(path("p/vtk")));
  EXPECT_EQ(monograin("plot p --vtk --profile 1").code, 2);
  EXPECT_EQ(monograin("plot p p --vtk -o out").code, 2);
}

}  // namespace
}  // namespace monograin
