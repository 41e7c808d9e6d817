#include "continuum/continuum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/calculix_stand_in.hpp"
#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_run.hpp"
#include "support/text_file.hpp"

namespace monograin {
namespace {

CheckedScenario ready(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return read_scenario(MONOGRAIN_SOURCE_DIR "/scenarios/" + name, overrides);
}

TEST(ContinuumMaterial, HasTheYieldStressOfAnElasticPlasticLaw) {
  for (const char* name : {"die.toml", "cel.toml"}) {
    const ContinuumMaterial material = continuum_material_of(ready(name));
    EXPECT_EQ(material.youngs_modulus, 1e9) << name;
    EXPECT_EQ(material.poisson_ratio, 0.3) << name;
    ASSERT_EQ(material.flow.size(), 1U) << name;
    EXPECT_EQ(material.flow[0].stress, 50e6) << name;
    EXPECT_EQ(material.differences.size(), 0U) << name;
  }
}

TEST(ContinuumMaterial, OfAnElasticLawDoesNotFlow) {
  EXPECT_TRUE(continuum_material_of(ready("hertz.toml")).flow.empty());
}

TEST(ContinuumMaterial, SaysThatAdhesionIsLeftOut) {
  const ContinuumMaterial material = continuum_material_of(ready("adhesion.toml"));
  ASSERT_FALSE(material.differences.empty());
  EXPECT_TRUE(contains(material.differences[0], "adhesion"));
}

/// hardening.toml with elastic constants and another exponent.
CheckedScenario hardening(const std::string& exponent) {
  return ready("hardening.toml", {"material.youngs_modulus='70 GPa'", "material.poisson_ratio=0.3",
                                  "material.strength='100 MPa'", "material.hardening_exponent=" + exponent});
}

TEST(ContinuumMaterial, FollowsThePowerLawOfTheTotalStrain) {
  for (const std::string exponent : {"0", "0.1", "0.5", "0.8", "0.97"}) {
    const ContinuumMaterial material = continuum_material_of(hardening(exponent));
    ASSERT_GT(material.flow.size(), 50U) << exponent;
    EXPECT_EQ(material.flow[0].plastic_strain, 0.0) << exponent;
    for (std::size_t i = 1; i < material.flow.size(); ++i) {
      const auto& [strain, stress] = material.flow[i];
      EXPECT_NEAR(1e8 * std::pow(strain + stress / 70e9, std::stod(exponent)) / stress, 1.0, 1e-12) << exponent;
      EXPECT_GT(strain, material.flow[i - 1].plastic_strain) << exponent;
      EXPECT_GE(stress, material.flow[i - 1].stress) << exponent;
    }
  }
}

TEST(ContinuumMaterial, OfAnIdeallyPlasticPowerLawHasItsStrength) {
  for (const FlowPoint& point : continuum_material_of(hardening("0")).flow) EXPECT_DOUBLE_EQ(point.stress, 100e6);
}

TEST(ContinuumMaterial, RefusesWhatIsNoElasticPlasticBody) {
  const auto refused = [](const CheckedScenario& scenario) {
    return refusal<std::invalid_argument>([&] { return continuum_material_of(scenario); });
  };
  EXPECT_TRUE(contains(refused(ready("packing.toml")), "expected one of "));
  EXPECT_TRUE(contains(refused(ready("hardening.toml")), "expected youngs_modulus in [material]"));
  EXPECT_TRUE(contains(refused(hardening("1")), "exponent below 1"));
  EXPECT_TRUE(contains(refused(ready("nonlocal.toml", {"material.poisson_ratio=0.495"})), "at most 0.49"));
}

TEST(ContinuumMaterial, WarnsWhereBricksLock) {
  EXPECT_TRUE(continuum_material_of(ready("cel.toml", {"material.yield_stress='5 MPa'"})).differences.empty());
  const ContinuumMaterial stiff = continuum_material_of(ready("cel.toml", {"material.yield_stress='2 MPa'"}));
  ASSERT_EQ(stiff.differences.size(), 1U);
  EXPECT_TRUE(contains(stiff.differences[0], "417 times the flow stress"));
}

/// Finite elements of a scenario by a program in the place of CalculiX.
Run run_by(const std::string& script, const CheckedScenario& scenario, const TemporaryFolder& folder) {
  write_text(folder.path() / "ccx", "#!/bin/sh\n" + script);
  std::filesystem::permissions(folder.path() / "ccx", std::filesystem::perms::owner_all);
  return run_continuum(
      run_scenario(scenario),
      {.mesh = "coarse", .estimates_error = false, .ccx = folder.path() / "ccx", .folder = folder.path()});
}

/// Displacements of the axial wall, over R0, at which finite elements are computed for a scenario.
std::vector<double> computed_displacements(const CheckedScenario& scenario) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_by("", scenario, folder).record.status, RunStatus::failed);
  std::vector<double> displacements;
  const std::string text = read_text(folder.path() / "continuum.inp");
  const std::string key = "WALL0,3,3,";
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
    displacements.push_back(-std::stod(text.substr(at + key.size(), 30)) / 10.0);
  }
  return displacements;
}

TEST(RunContinuum, GivesEveryClassTheForceOfAWholeWallAndAddsUpTheWork) {
  const TemporaryFolder folder;
  const CheckedScenario scenario = ready("cel.toml", {"loading.configuration=hydrostatic"});
  const TemporaryFolder other;
  const auto die = run_by(k_constant_forces, ready("cel.toml"), folder);
  ASSERT_EQ(die.record.status, RunStatus::complete) << die.record.message;
  const Table& history = die.record.history;
  const double unit = 1e9 * 0.01 * 0.01 / (1000.0 * 10.0 * 10.0);
  const std::size_t last = history.row_count() - 1;
  EXPECT_NEAR(history.column("axial.force")[last], 8.0 * 3.0 * unit, 1e-9);
  EXPECT_NEAR(history.column("lateral.force")[last], 4.0 * 2.0 * unit, 1e-9);
  // Two axial walls at a constant force; the first row has none, so that its interval counts half.
  const std::vector<double> displacement = history.column("axial.displacement");
  const double force = 8.0 * 3.0 * unit;
  EXPECT_NEAR(history.column("work")[last], 2.0 * force * (displacement[last] - 0.5 * displacement[1]), 1e-9);
  // Six walls at once are one class, with the state of the walls on the axis.
  const auto six = run_by(k_constant_forces, scenario, other);
  EXPECT_NEAR(six.record.history.column("axial.force")[1], 8.0 * 3.0 * unit, 1e-9);
}

TEST(RunContinuum, CountsAllRowsAsLoadingWhereTheProgramOnlyLoadsAfterAPause) {
  const TemporaryFolder folder;
  const CheckedScenario scenario = parse_scenario(
      "model = 'cel'\n[particle]\nradius = 1\n[material]\nyoungs_modulus = 1e9\npoisson_ratio = 0.3\n"
      "yield_stress = 5e7\n[loading]\nconfiguration = 'die'\nsteps = [{ hold = true, duration = 1 },\n"
      "{ displacement = 0.1, duration = 1 }, { hold = true, duration = 1 }]\n[output]\npoints = 20\n",
      "pause.toml");
  const auto result = run_by(k_constant_forces, scenario, folder);
  ASSERT_EQ(result.elements->differences.size(), 4U);
  for (const ContinuumDifference& difference : result.elements->differences) {
    EXPECT_FALSE(std::isnan(difference.loading)) << difference.column;
    EXPECT_TRUE(std::isnan(difference.unloading)) << difference.column;
  }
}

TEST(RunContinuum, KeepsTheLimitAtWhichTheLawStops) {
  const TemporaryFolder folder;
  const auto stopped = run_by(k_constant_forces, ready("cel.toml", {"loading.steps[0].displacement='0.9 R0'"}), folder);
  EXPECT_EQ(stopped.record.status, RunStatus::stopped);
  EXPECT_TRUE(stopped.record.limit);
}

TEST(RunContinuum, RecordsWhatTheMaterialLacks) {
  const TemporaryFolder folder;
  const std::vector<std::string> warnings = run_by("", ready("adhesion.toml"), folder).record.warnings;
  ASSERT_FALSE(warnings.empty());
  EXPECT_TRUE(contains(warnings[0], "adhesion")) << warnings[0];
}

TEST(RunContinuum, WarnsWhereRowsOfTheRunAreFarApart) {
  const TemporaryFolder folder;
  const auto coarse = run_by("", ready("cel.toml", {"output.points=5"}), folder);
  ASSERT_EQ(coarse.record.warnings.size(), 1U);
  EXPECT_TRUE(contains(coarse.record.warnings[0], "0.08 R0 apart")) << coarse.record.warnings[0];
  const TemporaryFolder other;
  EXPECT_TRUE(run_by("", ready("cel.toml"), other).record.warnings.empty());
}

TEST(RunContinuum, ComputesTheTurnsOfTheWallsAndSmallStepsBetween) {
  const std::vector<double> displacements = computed_displacements(ready("cel.toml"));
  std::vector<double> turns;
  double last = 0.0;
  for (std::size_t i = 0; i < displacements.size(); ++i) {
    EXPECT_LE(std::abs(displacements[i] - last), 0.0101) << i;
    const bool is_end = i + 1 == displacements.size();
    if (is_end || (displacements[i] - last) * (displacements[i + 1] - displacements[i]) < 0.0) {
      turns.push_back(displacements[i]);
    }
    last = displacements[i];
  }
  ASSERT_EQ(turns.size(), 3U);
  EXPECT_NEAR(turns[0], 0.40, 1e-12);
  EXPECT_NEAR(turns[1], 0.37, 1e-12);
  EXPECT_NEAR(turns[2], 0.42, 1e-12);
  EXPECT_LT(displacements.size(), 110U);
}

TEST(RunContinuum, FollowsTheWallsThatAForceMoves) {
  const CheckedScenario scenario = ready("force.toml");
  const Table history = record_run(scenario).history;
  const std::vector<double> displacements = computed_displacements(scenario);
  const std::vector<double> of_law = history.column("axial.displacement");
  EXPECT_NEAR(*std::ranges::max_element(displacements), *std::ranges::max_element(of_law) / scenario.radius, 1e-9);
}

}  // namespace
}  // namespace monograin
