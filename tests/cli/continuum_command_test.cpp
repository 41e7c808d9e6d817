// `monograin continuum`, with CalculiX as it is installed.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "cli/command_test.hpp"
#include "history/table.hpp"
#include "support/refusal.hpp"

namespace monograin {
namespace {

const std::string k_ready = "'" MONOGRAIN_SOURCE_DIR "/scenarios/";
constexpr const char* k_curves = MONOGRAIN_SOURCE_DIR "/plots/fe/";

class ContinuumCommand : public CommandTest {
 protected:
  /// Puts a program in the place of CalculiX; `monograin` finds it first.
  [[nodiscard]] Outcome with_stand_in(const std::string& script, const std::string& arguments) const {
    std::filesystem::create_directory(path("bin"));
    write_text(path("bin/ccx"), "#!/bin/sh\n" + script);
    std::filesystem::permissions(path("bin/ccx"), std::filesystem::perms::owner_all);
    return shell("PATH=\"$PWD/bin:$PATH\" $M continuum " + arguments);
  }
};

std::string scenario(const std::string& model, const std::string& radius, const std::string& material,
                     const std::string& configuration, const std::string& step, int points) {
  return fmt::format(
      "model = '{}'\n[particle]\nradius = '{}'\n[material]\n{}[loading]\nconfiguration = '{}'\n[[loading.steps]]\n{}\n"
      "duration = '1 s'\n[output]\npoints = {}\n",
      model, radius, material, configuration, step, points);
}

/// Value of a column where another one has a value, linear between rows.
double at(const Table& table, const std::string& x, double where, const std::string& y) {
  const std::vector<double> xs = table.column(x);
  const std::vector<double> ys = table.column(y);
  for (std::size_t i = 1; i < xs.size(); ++i) {
    if (xs[i] >= where) return ys[i - 1] + (ys[i] - ys[i - 1]) * (where - xs[i - 1]) / (xs[i] - xs[i - 1]);
  }
  return std::nan("");
}

TEST_F(ContinuumCommand, GivesTheCurveOfAFineMeshAndLeavesARun) {
  const Outcome outcome =
      monograin("continuum " + k_ready +
                "uniaxial.toml' --mesh coarse --set material.yield_stress='20 MPa' "
                "--set 'loading.steps[0].displacement=0.1 R0' --set 'loading.steps[1].rate=0.1 mm/s'"
                " --set output.points=8 -o fe");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "| largest difference of mdr | loading | unloading and reloading |"))
      << outcome.out;
  std::vector<std::string> left = files();
  std::ranges::sort(left);
  EXPECT_EQ(left, (std::vector<std::string>{"fe", "fe/.monograin", "fe/events.csv", "fe/history.csv", "fe/run.json"}));
  const Table history = read_csv(path("fe/history.csv"));
  EXPECT_EQ(history.header_value("model"), "continuum");
  const Table fine = read_csv(std::string(k_curves) + "ep_simple_EY50_nu0.30.csv");
  for (const double depth : {0.05, 0.075, 0.1}) {
    const double force = at(history, "axial.displacement", depth * 0.01, "axial.force") / 1e5;
    EXPECT_NEAR(force / at(fine, "delta_o_over_R0", depth, "F_over_E_R0^2"), 1.0, 0.03) << depth;
    const double radius = at(history, "axial.displacement", depth * 0.01, "axial.contact_radius") / 0.01;
    EXPECT_NEAR(radius / at(fine, "delta_o_over_R0", depth, "sqrt_Ac_over_pi_R0^2"), 1.0, 0.03) << depth;
    const double volume =
        at(history, "axial.displacement", depth * 0.01, "volume") / (4.0 / 3.0 * std::numbers::pi * 1e-6);
    EXPECT_NEAR(volume, at(fine, "delta_o_over_R0", depth, "V_over_V0"), 2e-4) << depth;
  }
  // The walls separate between 0.0726 and 0.0773 R0 on the fine mesh.
  const std::vector<double> force = history.column("axial.force");
  const std::vector<double> displacement = history.column("axial.displacement");
  const auto deepest = std::ranges::max_element(displacement) - displacement.begin();
  double lost = 0.0;
  for (std::size_t i = static_cast<std::size_t>(deepest); i < force.size(); ++i) {
    if (force[i] > 0.0) lost = displacement[i] / 0.01;
  }
  EXPECT_NEAR(lost, 0.078, 0.006);
  EXPECT_EQ(monograin("plot fe -o figure.svg").code, 0);
  EXPECT_EQ(monograin("plot fe --vtk").code, 0);
}

TEST_F(ContinuumCommand, IsNearHertzUnderAnElasticParticle) {
  write_text(path("hertz.toml"), scenario("hertz", "1 mm", "youngs_modulus = '3 GPa'\npoisson_ratio = 0.2\n", "simple",
                                          "displacement = '0.01 R0'", 4));
  const Outcome outcome = monograin("continuum hertz.toml --mesh coarse --error");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "error of the elements")) << outcome.out;
  EXPECT_TRUE(contains(outcome.err, "-> runs/hertz-continuum")) << outcome.err;
  const Table history = read_csv(path("runs/hertz-continuum/history.csv"));
  ASSERT_EQ(history.row_count(), 5U);
  // Finite strain makes the sphere stiffer than Hertz: by half the root of displacement/R0.
  for (std::size_t row = 2; row < history.row_count(); ++row) {
    const double depth = history.column("axial.displacement")[row] / 1e-3;
    const double hertz = 4.0 / 3.0 * 3e9 / (1.0 - 0.04) * std::pow(depth, 1.5) * 1e-6;
    EXPECT_NEAR(history.column("axial.force")[row] / hertz, 1.0 + 0.5 * std::sqrt(depth), 0.03) << depth;
  }
}

TEST_F(ContinuumCommand, GivesTheForcesOfAFineMeshAtAllWallsOfADie) {
  const std::string material = "youngs_modulus = '1 GPa'\npoisson_ratio = 0.3\nyield_stress = '50 MPa'\n";
  write_text(path("die.toml"), scenario("cel", "10 mm", material, "die", "displacement = '0.03 R0'", 2));
  const Outcome outcome = monograin("continuum die.toml --mesh coarse -o fe");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Table history = read_csv(path("fe/history.csv"));
  const Table fine = read_csv(std::string(k_curves) + "die_EY20_nu0.30.csv");
  const auto ratio = [&](const std::string& column, const std::string& of_fine) {
    return history.column(column).back() / 1e5 / at(fine, "delta_o_over_R0", 0.03, of_fine);
  };
  EXPECT_NEAR(ratio("axial.force", "axial_F_over_E_R0^2"), 1.0, 0.04);
  // A contact of a few elements.
  EXPECT_NEAR(ratio("lateral.force", "lateral_F_over_E_R0^2"), 1.0, 0.3);
  const double volume = history.column("volume").back() / (4.0 / 3.0 * std::numbers::pi * 1e-6);
  EXPECT_NEAR(volume, at(fine, "delta_o_over_R0", 0.03, "V_over_V0"), 3e-4);
}

TEST_F(ContinuumCommand, RefusesWhatFiniteElementsCannotStandForBeforeItRuns) {
  const auto refused = [&](const std::string& arguments) {
    const Outcome outcome = monograin("continuum " + arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_EQ(files(), std::vector<std::string>{}) << arguments;
    return outcome.err;
  };
  EXPECT_TRUE(contains(refused(k_ready + "compressible.toml'"), "model compressible has no material for finite"));
  EXPECT_TRUE(contains(refused(k_ready + "hardening.toml'"), "expected youngs_modulus in [material]"));
  EXPECT_TRUE(
      contains(refused(k_ready + "nonlocal.toml' --set material.poisson_ratio=0.495"), "expected at most 0.49"));
  EXPECT_TRUE(
      contains(refused(k_ready + "free-centre.toml' --set loading.centre=fixed"), "wall 'punch' has no such partner"));
  EXPECT_TRUE(contains(refused(k_ready + "oblique-die.toml'"), "perpendicular to each other"));
  EXPECT_TRUE(contains(refused(k_ready + "die.toml' --mesh finest"), "coarse"));
}

TEST_F(ContinuumCommand, IsListedWithTheModelsThatItTakes) {
  EXPECT_TRUE(contains(monograin("models mdr").out,
                       "other programs: LAMMPS (monograin export lammps), CalculiX (monograin continuum)\n"));
  EXPECT_TRUE(contains(monograin("models cel").out, "other programs: CalculiX (monograin continuum)\n"));
  EXPECT_FALSE(contains(monograin("models compressible").out, "other programs"));
}

TEST_F(ContinuumCommand, SaysHowToGetCalculix) {
  const Outcome outcome = shell("PATH=/nowhere $M continuum " + k_ready + "die.toml'");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(contains(outcome.err, "ccx was not found on the PATH")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "apt-get install calculix-ccx")) << outcome.err;
}

TEST_F(ContinuumCommand, EndsLikeASolverThatGivesUpWhereCalculixDoes) {
  const Outcome outcome =
      with_stand_in("echo ' *ERROR: too many cutbacks'; exit 201\n", k_ready + "die.toml' --keep -o fe");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(contains(outcome.err, "failed: CalculiX ended with code 201; its last words: ERROR: too many cutbacks"))
      << outcome.err;
  EXPECT_EQ(read_csv(path("fe/history.csv")).row_count(), 1U);
  EXPECT_TRUE(contains(text("fe/continuum.inp"), "*ELEMENT, TYPE=C3D8"));
}

TEST_F(ContinuumCommand, KeepsThreeFilesAndRefusesToReplaceAUsersBeforeItComputes) {
  std::filesystem::create_directory(path("fe"));
  write_text(path("fe/continuum.dat"), "mine\n");
  const Outcome refused = with_stand_in("touch ../called\n", k_ready + "die.toml' --keep -o fe");
  EXPECT_EQ(refused.code, 2) << refused.err;
  EXPECT_TRUE(contains(refused.err, "continuum.dat")) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(path("called")));
  EXPECT_EQ(text("fe/continuum.dat"), "mine\n");
  EXPECT_EQ(with_stand_in("touch $1.dat $1.frd $1.sta spooles.out\n", k_ready + "die.toml' --keep -o other").code, 4);
  std::vector<std::string> kept;
  for (const auto& entry : std::filesystem::directory_iterator(path("other"))) {
    if (entry.path().stem() == "continuum") kept.push_back(entry.path().extension());
  }
  std::ranges::sort(kept);
  EXPECT_EQ(kept, (std::vector<std::string>{".dat", ".inp", ".log"}));
  EXPECT_FALSE(std::filesystem::exists(path("other/spooles.out")));
}

}  // namespace
}  // namespace monograin
