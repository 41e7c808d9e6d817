// The language of a model without particle and walls, and what it objects to.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenario/json.hpp"
#include "scenario/scenario.hpp"
#include "scenario/support.hpp"

namespace monograin::drives_test {
namespace {

const std::string k_step_keys = "one of packing_fraction, duration, rate, until, strain, stress, hold, cycle, steps";

using Lines = std::vector<std::string>;

std::string packing(const std::string& steps, const std::string& material = "", const std::string& options = "") {
  return "model = \"packing\"\n[material]\n" + material + "\n[packing]\n" + options + "\n[loading]\n" + steps;
}

const std::string k_ramp = "[[loading.steps]]\npacking_fraction = 0.95\nduration = 1\n";
const std::string k_plastic = "hardening_modulus = \"1 MPa\"";

TEST(Drives, AreReadWithTheirUnitsAndDefaults) {
  const CheckedScenario scenario = parse_scenario(
      "model = \"packing\"\n[[loading.steps]]\npacking_fraction = 0.9\nrate = \"50 %/s\"\n[[loading.steps]]\n"
      "stress = \"0.9 MPa\"\nrate = \"100 kPa/s\"\nuntil = { event = \"full\" }\n[[loading.steps]]\nhold = true\n"
      "duration = 1\n[[loading.steps]]\ncycle = 2\nsteps = [{ strain = 0.15, duration = 1 }]\n",
      "a.toml");
  const std::vector<Step>& steps = scenario.loading.steps;
  ASSERT_EQ(steps.size(), 5U);
  EXPECT_EQ(steps[0].kind, Step::Kind::packing_fraction);
  EXPECT_EQ(steps[0].target, 0.9);
  EXPECT_EQ(steps[0].rate, 0.5);
  EXPECT_EQ(steps[1].kind, Step::Kind::stress);
  EXPECT_EQ(steps[1].target, 0.9e6);
  EXPECT_EQ(steps[1].rate, 1e5);
  EXPECT_EQ(steps[1].until.at(0).event, "full");
  EXPECT_EQ(steps[2].kind, Step::Kind::hold);
  EXPECT_EQ(steps[4].kind, Step::Kind::strain);
  EXPECT_EQ(steps[4].target, 0.15);
  EXPECT_EQ(scenario.radius, 0.0);
  EXPECT_EQ(scenario.material.at("youngs_modulus"), 10e6);
  EXPECT_FALSE(scenario.material.contains("hardening_modulus"));
  EXPECT_EQ(std::get<double>(scenario.options.at("f_E")), 1.2);
  EXPECT_FALSE(scenario.options.contains("initial_packing_fraction"));
}

TEST(Drives, MayPrescribeBothDirectionsByAPair) {
  const CheckedScenario scenario = parse_scenario(
      "model = \"material-point\"\n[material]\nyield_model = \"vm\"\npreset = \"MCC PH-200\"\n[loading]\n"
      "configuration = \"strain-path\"\nsteps = [{ strain = [-0.1, -0.02], duration = 1 }]\n",
      "a.toml");
  const Step& step = scenario.loading.steps.front();
  EXPECT_EQ(step.target, -0.1);
  ASSERT_TRUE(step.lateral);
  EXPECT_EQ(step.lateral->kind, Step::Kind::strain);
  EXPECT_EQ(step.lateral->target, -0.02);
}

TEST(Drives, HaveNoKeysOfWalls) {
  EXPECT_EQ(faults_of("model = \"packing\"\n[particle]\nradius = 1\n[loading]\nconfiguration = \"die\"\n"
                      "[[loading.steps]]\ndisplacement = 0.1\nduration = 1\n[[loading.steps]]\ndetach = true\n"
                      "rate = 1\n[[loading.steps]]\nstress = 1\nduration = 1\nuntil = { force = 1 }\n"),
            (Lines{"die.toml:2:2: key 'particle' is not used by model 'packing', which has no walls",
                   "die.toml:5:1: key 'configuration' is not used by model 'packing'; expected steps",
                   "die.toml:7:1: key 'displacement' is not used by model 'packing'; expected " + k_step_keys,
                   "die.toml:10:1: key 'detach' is not used by model 'packing'; expected " + k_step_keys,
                   "die.toml:15:11: key 'force' is not used by model 'packing'; expected event"}));
  EXPECT_EQ(faults_of("model = \"packing\"\n[loading]\n").size(), 1U);
  EXPECT_EQ(
      faults_of(packing("[[loading.steps]]\nduration = 1\n")),
      (Lines{"die.toml:7:1: the step has nothing to do; expected exactly one of packing_fraction, strain, stress, "
             "hold, cycle"}));
}

TEST(Drives, AreChecked) {
  EXPECT_EQ(faults_of(packing("[[loading.steps]]\npacking_fraction = 0\nduration = 1\n")).size(), 1U);
  EXPECT_EQ(faults_of(packing("[[loading.steps]]\nstress = \"-1 MPa\"\nduration = 1\n")).size(), 1U);
  EXPECT_EQ(faults_of(packing("[[loading.steps]]\nstress = \"1 N\"\nduration = 1\n")).size(), 1U);
  EXPECT_EQ(faults_of(packing("[[loading.steps]]\nstrain = 0.1\nrate = \"1 MPa/s\"\n")),
            (Lines{"die.toml:9:8: rate = \"1 MPa/s\": 'MPa/s' is a unit of stress rate; expected a strain rate, for "
                   "example \"0.1 1/s\""}));
  EXPECT_EQ(faults_of(packing("[[loading.steps]]\nstrain = 0.1\nstress = 1\nduration = 1\n")).size(), 1U);
  EXPECT_EQ(faults_of(packing("[[loading.steps]]\nstrain = [0.1, 0.2]\nduration = 1\n")).size(), 1U);
  EXPECT_EQ(faults_of(packing("[[loading.steps]]\nstrain = 0.1\nlateral_strain = 0\nduration = 1\n")),
            (Lines{"die.toml:9:1: key 'lateral_strain' is not used by model 'packing'; expected " + k_step_keys}));
}

TEST(PackingRules, RefuseParametersThatMakeNoLaw) {
  const auto faults = [](const std::string& material, const std::string& options) {
    return faults_of(packing(k_ramp, material, options));
  };
  EXPECT_EQ(faults("", "f_E = 0.1"),
            (Lines{"die.toml:5:7: f_E has to be at least f_G: below it, the modulus has a pole"}));
  EXPECT_EQ(faults("poisson_ratio = 0.5", ""),
            (Lines{"die.toml:3:17: poisson_ratio = 0.5: out of range; expected a number above -1 and below 0.5"}));
  EXPECT_EQ(faults("", "Z_1 = 3.9"), (Lines{"die.toml:5:7: Z_1 is below Z_c: contacts would be lost in compaction"}));
  EXPECT_EQ(faults("", "Phi_1 = 0.8"),
            (Lines{"die.toml:5:9: Phi_1 has to lie above the jamming fraction, and not above 1"}));
  EXPECT_EQ(faults("", "jamming_fraction = 1.0").size(), 1U);
  EXPECT_EQ(faults("", "alpha = 0").size(), 1U);
  EXPECT_EQ(faults("hardening_modulus = -1", "").size(), 1U);
  EXPECT_EQ(faults("", "continuous_jamming = true\nc2 = 0.25"),
            (Lines{"die.toml:6:6: key 'c2' does not go with continuous_jamming = true, which sets it; expected one of "
                   "them"}));
  EXPECT_EQ(faults("", "coupling = \"consistent\"\nc1 = 0.005").size(), 1U);
  EXPECT_TRUE(faults("", "continuous_jamming = true").empty());
  // M_eff = c1 K Z Phi from jamming on.
  EXPECT_EQ(faults("poisson_ratio = 0.3",
                   "coupling = \"consistent\"\nalpha = 0.05\nc1 = 0.264253488151714\nc2 = 0.06939334461471039\n"
                   "f_E = 0.5203164594300329\nf_G = 0.36755509385008156\njamming_fraction = 0.9485912087261479\n"
                   "initial_packing_fraction = 0.958"),
            (Lines{"die.toml:12:28: the stress of the packing is infinite from packing fraction 0.948591 on; expected "
                   "less"}));
}

TEST(PackingRules, RefuseToUnloadPlasticParticles) {
  const std::string tail =
      ", and there is no law of unloading for plastic particles; expected growing targets, or elastic particles (no "
      "hardening_modulus)";
  const auto faults = [](const std::string& steps) { return faults_of(packing(k_ramp + steps, k_plastic)); };
  EXPECT_EQ(faults("[[loading.steps]]\npacking_fraction = 0.9\nduration = 1\n"),
            (Lines{"die.toml:10:1: the packing goes back from packing fraction 0.950000 to 0.900000" + tail}));
  const Lines by_stress = faults("[[loading.steps]]\nstress = \"0.5 MPa\"\nduration = 1\n");
  ASSERT_EQ(by_stress.size(), 1U);
  EXPECT_TRUE(by_stress[0].starts_with("die.toml:10:1: the packing goes back")) << by_stress[0];
  EXPECT_EQ(faults("[[loading.steps]]\nstrain = 0.1\nduration = 1\n").size(), 1U);
  EXPECT_EQ(faults("[[loading.steps]]\nstress = 0\nduration = 1\n").size(), 1U);
  EXPECT_TRUE(faults("[[loading.steps]]\nstress = \"2 MPa\"\nduration = 1\n").empty());
  EXPECT_TRUE(faults("[[loading.steps]]\nhold = true\nduration = 1\n").empty());
  // Elastic particles go back the way they came.
  EXPECT_TRUE(faults_of(packing(k_ramp + "[[loading.steps]]\npacking_fraction = 0.9\nduration = 1\n")).empty());
}

TEST(DrivesSchema, AcceptsWhatTheReaderAccepts) {
  for (const std::string& steps :
       {k_ramp, k_ramp + "[[loading.steps]]\nstress = \"2 MPa\"\nrate = \"1 MPa/s\"\n",
        k_ramp + "[[loading.steps]]\nhold = true\nduration = 1\nuntil = { event = \"full\" }\n"}) {
    const std::string text = "model = \"packing\"\n" + steps;
    EXPECT_TRUE(faults_of(text).empty()) << text;
    EXPECT_TRUE(schema_accepts(*toml_as_json(text))) << text;
  }
  for (const std::string& text :
       {"model = \"packing\"\n[particle]\nradius = 1\n" + k_ramp, std::string("model = \"packing\"\n[loading]\n"),
        "model = \"packing\"\n[[loading.steps]]\ndisplacement = 0.1\nduration = 1\n" + k_ramp,
        "model = \"packing\"\n[loading]\nconfiguration = \"die\"\n" + k_ramp}) {
    EXPECT_FALSE(faults_of(text).empty()) << text;
    EXPECT_FALSE(schema_accepts(*toml_as_json(text))) << text;
  }
}

}  // namespace
}  // namespace monograin::drives_test
