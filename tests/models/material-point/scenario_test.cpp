// Scenario files of material points.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine/integrator.hpp"
#include "models/material-point/cases.hpp"

namespace monograin::material_point::scenario_test {
namespace {

std::string die(const std::string& material, const std::string& rest = "") {
  return "model = \"material-point\"\n[material]\n" + material +
         "\n[loading]\nconfiguration = \"die\"\nsteps = [{ strain = -0.1, duration = \"1 s\" }]\n" + rest;
}

std::string faults(const std::string& text) {
  try {
    static_cast<void>(parse_scenario(text, "point.toml"));
  } catch (const ScenarioError& error) {
    return error.what();
  }
  return "";
}

bool says(const std::string& text, const std::string& what) {
  const std::string found = faults(text);
  const bool does = found.find(what) != std::string::npos;
  if (!does) std::printf("%s\n", found.c_str());
  return does;
}

TEST(MaterialPointScenario, TakesAPreset) {
  const CheckedScenario scenario =
      parse_scenario(die("preset = \"MCC PH-200\"\nrelative_density = 0.5\nnu0 = 0.2"), "point");
  EXPECT_EQ(scenario.material.at("yield_pressure"), 8.61e6);
  EXPECT_EQ(scenario.material.at("eta"), 6.11);
  EXPECT_EQ(scenario.material.at("nu0"), 0.2) << "given beside the preset";
  const TestRun result = run(scenario, "cvode-bdf");
  EXPECT_EQ(result.record.status, RunStatus::complete) << result.record.message;
  EXPECT_NEAR(result.record.history.column("relative_density").front(), 0.5, 1e-15);
}

TEST(MaterialPointScenario, StartsAtTheReferenceDensityUnlessToldOtherwise) {
  const TestRun result = run(parse_scenario(die("preset = \"Base case\""), "point"), "ida");
  EXPECT_EQ(result.column("relative_density").front(), 0.7);
  EXPECT_EQ(result.column("youngs_modulus").front(), 100.0 * 150e6);
}

TEST(MaterialPointScenario, CompletesARowOfOneValue) {
  const std::string text =
      die("preset = \"Starch, dry\"\nyield_model = \"vm\"\nyield_pressure = \"10 MPa\"\nshear_ratio = 1\nnu0 = 0.3");
  EXPECT_EQ(parse_scenario(text, "point").material.at("stiffness_ratio"), 174.3);
  EXPECT_TRUE(says(die("preset = \"Starch, dry\""),
                   "key 'shear_ratio' is missing in [material], and preset 'Starch, "
                   "dry' does not have it"));
}

TEST(MaterialPointScenario, SaysWhatIsMissing) {
  EXPECT_TRUE(says(die("stiffness_ratio = 100"), "key 'yield_pressure' is missing in [material]"));
  EXPECT_TRUE(says(die("preset = \"MCC PH-20\""), "did you mean 'MCC PH-200'?"));
  EXPECT_TRUE(says(die("yield_pressure = 1\nstiffness_ratio = 100\nshear_ratio = 1\nnu0 = 0.3"),
                   "needs tensile_ratio in [material]"));
}

// The starred rows of Table 4: the linear law of the axis ratio does not hold at their reference density.
TEST(MaterialPointScenario, RefusesStarredPresetsAtTheirReferenceDensity) {
  for (const char* preset : {"MCC PH-102", "Starch 1500"}) {
    const std::string key = std::string("preset = \"") + preset + "\"\n";
    EXPECT_TRUE(says(die(key), "expected above 0, that is a relative_density above 0.43")) << preset;
    EXPECT_EQ(faults(die(key + "relative_density = 0.5")), "") << preset;
  }
}

TEST(MaterialPointScenario, RefusesStatesWithoutAYieldSurface) {
  EXPECT_TRUE(says(die("preset = \"Base case\"\nrelative_density = 0.95"), "segments of the yield surface overlap"));
  EXPECT_TRUE(says(die("preset = \"Base case\"\nnu0 = 0.6"), "Poisson's ratio is 0.6"));
  EXPECT_TRUE(
      says(die("preset = \"Base case\"\nyield_model = \"dpc\"\ntransition_width = 3"), "expected a smaller one"));
  EXPECT_TRUE(says(die("preset = \"Base case\"\ntransition_width = 0.03"), "goes with yield_model = \"dpc\" only"));
  EXPECT_TRUE(says(die("preset = \"Base case\"\nrelative_density = 1.5"), "relative_density"));
}

TEST(MaterialPointScenario, RefusesStepsThatTheConfigurationDoesNotLeaveOpen) {
  const auto steps = [](const std::string& configuration, const std::string& step) {
    return "model = \"material-point\"\n[material]\npreset = \"Base case\"\n[loading]\nconfiguration = \"" +
           configuration + "\"\nsteps = [{ " + step + ", duration = 1 }]\n";
  };
  EXPECT_TRUE(says(steps("die", "strain = [-0.1, 0.01]"), "the lateral direction is not open"));
  EXPECT_TRUE(says(steps("simple", "strain = -0.1, lateral_stress = 0"), "the lateral direction is not open"));
  EXPECT_TRUE(says(steps("strain-path", "stress = -1"), "stress does not go with configuration = \"strain-path\""));
  EXPECT_TRUE(says(steps("triaxial", "strain = -0.1, lateral_strain = 0"), "a lateral strain does not go with"));
  EXPECT_EQ(faults(steps("strain-path", "strain = -0.1, lateral_strain = 0.01")), "");
  EXPECT_EQ(faults(steps("triaxial", "strain = -0.1, lateral_stress = \"-1 MPa\"")), "");
  EXPECT_TRUE(says(steps("walls", "strain = -0.1"), "configuration"));
}

TEST(MaterialPointScenario, OffersDirectOnlyWhereThereIsSuchAForm) {
  const std::string direct = "[numerics]\nintegrator = \"direct\"\n";
  EXPECT_TRUE(says(die("preset = \"Base case\"", direct), "point.toml:8:14: integrator = \"direct\" goes with"));
  EXPECT_EQ(faults(die("preset = \"Base case\"\nyield_model = \"vm\"", direct)), "");
  const Scene integrated = make_scene(parse_scenario(die("preset = \"Base case\""), "point"));
  const IntegratorChoice choice = choose_integrator("auto", *integrated.system);
  EXPECT_EQ(choice.used, "odeint-dopri5, cvode-bdf where stiff");
  EXPECT_NE(choice.why.find("depends on the path"), std::string::npos);
  const Scene solved = make_scene(parse_scenario(die("preset = \"Base case\"\nyield_model = \"vm\""), "point"));
  EXPECT_EQ(choose_integrator("auto", *solved.system).used, "direct");
}

TEST(MaterialPointScenario, HasTheColumnsOfTheContract) {
  const TestRun result = run(parse_scenario(die("preset = \"Base case\""), "point"), "cvode-bdf");
  std::string headings;
  for (const Column& column : result.record.history.columns()) headings += column.heading() + ",";
  EXPECT_EQ(headings,
            "time[s],step,row,strain_axial[-],strain_lateral[-],p[Pa],s[Pa],q[Pa],stress_axial[Pa],stress_lateral[Pa],"
            "relative_density[-],plastic_strain_volumetric[-],plastic_strain_deviatoric[-],phi[-],youngs_modulus[Pa],"
            "yield_function[-],regime,");
  const auto whole = run_scenario(parse_scenario(die("preset = \"Base case\""), "point"));
  EXPECT_EQ(whole.record.history.header_value("sign"), "tension positive");
}

const std::string k_von_mises =
    "yield_model = \"vm\"\nyield_pressure = \"100 MPa\"\nstiffness_ratio = 100\nshear_ratio = 1\nnu0 = 0.3\neta = 3";

TEST(MaterialPointScenario, HasNoDensityOfVonMisesPlasticity) {
  for (const char* density : {"", "\nrelative_density = 0.5\nreference_density = 0.4"}) {
    const TestRun result = run(parse_scenario(die(k_von_mises + density), "point"));
    ASSERT_GT(result.record.history.row_count(), 10U);
    for (const double value : result.column("relative_density")) EXPECT_TRUE(std::isnan(value)) << value;
    for (const double value : result.column("phi")) EXPECT_TRUE(std::isfinite(value)) << value;
  }
  for (const double value :
       run(parse_scenario(die("preset = \"Base case\""), "point"), "cvode-bdf").column("relative_density"))
    EXPECT_TRUE(std::isfinite(value)) << value;
}

TEST(MaterialPointScenario, NeverMeetsADensityOfVonMisesPlasticity) {
  for (const char* density : {"0.01", "0.7", "0.9"}) {
    const std::string until = std::string("until = { relative_density = ") + density + " }, duration";
    std::string text = die(k_von_mises);
    text.replace(text.find("duration"), std::string("duration").size(), until);
    const TestRun result = run(parse_scenario(text, "point"));
    EXPECT_EQ(result.record.status, RunStatus::complete) << result.record.message;
    EXPECT_FALSE(result.has_event("until-met")) << density;
    EXPECT_EQ(result.last("strain_axial"), -0.1) << density;
  }
}

}  // namespace
}  // namespace monograin::material_point::scenario_test
