// Rules between keys: Ludwik's law, what a model objects to, and walls that go back without a law for it.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "catalogue.hpp"
#include "scenario/model_input.hpp"
#include "scenario/scenario.hpp"
#include "scenario/support.hpp"

namespace monograin::rules_test {
namespace {

using Lines = std::vector<std::string>;

std::string scenario_with(const std::string& model, const std::string& material, const std::string& more,
                          const std::string& configuration = "simple") {
  return "model = \"" + model + "\"\n[particle]\nradius = 1\n[material]\n" + material +
         "\n[loading]\nconfiguration = \"" + configuration + "\"\n" + more;
}

const std::string k_steel = "youngs_modulus = 1000\npoisson_ratio = 0.3\nyield_stress = 1";
const std::string k_power_law = "strength = 1\nhardening_exponent = 0.3";
const std::string k_ramp = "[[loading.steps]]\ndisplacement = 0.1\nduration = 1\n";
const std::string k_lead =
    "youngs_modulus = \"10 GPa\"\nludwik = { yield_stress = \"5 MPa\", strength = \"15.5 MPa\", "
    "exponent = 0.35001750087504373 }";

TEST(Ludwik, StandsForThePowerLawNearestToIt) {
  const CheckedScenario scenario = parse_scenario(scenario_with("hardening", k_lead, k_ramp), "a.toml");
  EXPECT_NEAR(scenario.material.at("strength"), 20.236e6, 1e3);
  EXPECT_NEAR(1.0 / scenario.material.at("hardening_exponent"), 4.349, 1e-3);
  const Lines exponent_alone{"material.ludwik.fit=exponent"};
  const CheckedScenario other = parse_scenario(scenario_with("similarity", k_lead, k_ramp), "a.toml", exponent_alone);
  EXPECT_EQ(other.material.at("strength"), 20.5e6);
  EXPECT_NEAR(1.0 / other.material.at("hardening_exponent"), 4.174, 1e-3);
  const Lines far{"material.ludwik.eps_max=1.5"};
  EXPECT_NEAR(parse_scenario(scenario_with("hardening", k_lead, k_ramp), "a.toml", far).material.at("strength"),
              20.489e6, 1e3);
}

TEST(Ludwik, WithoutYoungsModulusIsFittedForARigidPlasticMaterialAndARemarkSaysSo) {
  const std::string law = "ludwik = { yield_stress = \"5 MPa\", strength = \"15.5 MPa\", exponent = 0.35 }";
  const CheckedScenario rigid = parse_scenario(scenario_with("hardening", law, k_ramp), "a.toml");
  EXPECT_NEAR(rigid.material.at("hardening_exponent"), 0.2284, 5e-5);
  ASSERT_EQ(rigid.doubts.size(), 1U);
  EXPECT_TRUE(rigid.doubts.front().starts_with("ludwik without youngs_modulus")) << rigid.doubts.front();
  EXPECT_EQ(parse_scenario(scenario_with("hardening", k_lead, k_ramp), "a.toml").doubts, Lines());
}

TEST(Ludwik, IsRefusedBesideThePowerLawAndWithValuesOutOfRange) {
  EXPECT_EQ(
      faults_of(scenario_with("hardening", k_lead + "\nstrength = 3", k_ramp)),
      (Lines{"die.toml:7:1: key 'strength' does not go with 'ludwik', which stands for it; expected one of them"}));
  EXPECT_EQ(
      faults_of(scenario_with("hardening", "ludwik = { yield_stress = 1, strength = 1, exponent = 1.2 }", k_ramp)),
      (Lines{"die.toml:5:55: exponent = 1.2: out of range; expected a number above 0 and up to 1"}));
  EXPECT_EQ(
      faults_of(scenario_with("hardening", "ludwik = { yield_stress = 0, strength = 0, exponent = 0.5 }", k_ramp)),
      (Lines{"die.toml:5:10: ludwik: the yield stress plus K must be positive, but is 0"}));
  EXPECT_EQ(faults_of(scenario_with("hardening", "ludwik = { yield_stress = 1, strength = 1 }", k_ramp)),
            (Lines{"die.toml:5:10: key 'exponent' is missing in ludwik; expected for example exponent = 0.35"}));
  EXPECT_EQ(
      faults_of(scenario_with("semimech", k_steel + "\nludwik = { }", k_ramp)),
      (Lines{
          "die.toml:8:1: key 'ludwik' is not used by model 'semimech'; expected one of youngs_modulus, poisson_ratio, "
          "yield_stress"}));
}

TEST(Ludwik, OrThePowerLawHasToBeGiven) {
  EXPECT_EQ(faults_of(scenario_with("hardening", "strength = 1", k_ramp)),
            (Lines{"die.toml:4:1: key 'hardening_exponent' is missing in [material]; expected for example "
                   "hardening_exponent = 0.3, or ludwik = { ... }"}));
}

const std::string k_granule = "stiffness_ratio = 100\nshear_ratio = 1\nnu0 = 0.3\nyield_pressure = 1";

std::string granule_with(const std::string& material, const std::string& options) {
  return scenario_with("compressible", material, k_ramp + "[compressible]\n" + options);
}

TEST(CompressibleRules, AcceptMaterialsOfTheSourceAndNumbersOfTheUser) {
  EXPECT_EQ(faults_of(granule_with(k_granule, "")), Lines());
  const std::string other = "stiffness_ratio = 1000\nnu0 = 0.3\nyield_pressure = 1";
  EXPECT_EQ(faults_of(granule_with(other, "k = 2\ndelta_t = 0.1\na = 3\nalpha = 1\nbeta = 0.5")), Lines());
  const CheckedScenario scenario = parse_scenario(granule_with(k_granule, "k = 2"), "a.toml");
  EXPECT_EQ(std::get<double>(scenario.options.at("k")), 2.0);
  EXPECT_FALSE(scenario.options.contains("alpha")) << "what is not given is not there";
}

TEST(CompressibleRules, RefuseMaterialsWithoutARegressionAllAtOnce) {
  const std::string range =
      ", where k, delta_t and a follow from the material; expected a value in there, or k, "
      "delta_t and a in [compressible]";
  EXPECT_EQ(faults_of(granule_with("stiffness_ratio = 2.9\nshear_ratio = 1.1\nnu0 = 0.3\nyield_pressure = 1", "k = 2")),
            (Lines{"die.toml:5:19: stiffness_ratio = 2.9 is outside 3 to 500" + range,
                   "die.toml:6:15: shear_ratio = 1.1 is outside 0.25 to 1" + range}));
  EXPECT_EQ(
      faults_of(granule_with("stiffness_ratio = 10\nnu0 = 0.3\nyield_pressure = 1", "")),
      (Lines{"die.toml:1:1: k, delta_t and a follow from stiffness_ratio and shear_ratio; expected shear_ratio in "
             "[material], or all three in [compressible]"}));
}

TEST(CompressibleRules, TakePresets) {
  const CheckedScenario base = parse_scenario(granule_with("preset = \"Base case\"\nnu0 = 0.2", ""), "a.toml");
  EXPECT_EQ(base.material, (std::map<std::string, double>{{"stiffness_ratio", 100.0},
                                                          {"shear_ratio", 1.0},
                                                          {"tensile_ratio", 0.01},
                                                          {"nu0", 0.2},
                                                          {"yield_pressure", 150e6}}))
      << "what the model has, less what is given beside";
  EXPECT_EQ(faults_of(granule_with("preset = \"Dical Fujicalin\"", "")), Lines());
  // Most of the source's powders are stronger in shear than the materials of its simulations.
  const std::string powder = "preset = \"MCC PH-200\"";
  EXPECT_EQ(faults_of(granule_with(powder, "")),
            (Lines{"die.toml:5:10: shear_ratio = 1.351 is outside 0.25 to 1, where k, delta_t and a follow from the "
                   "material; expected a value in there, or k, delta_t and a in [compressible]"}));
  EXPECT_EQ(faults_of(granule_with(powder, "k = 3\ndelta_t = 0.1\na = 3")), Lines());
  EXPECT_EQ(faults_of(granule_with(powder + "\nshear_ratio = 1", "")), Lines());
  EXPECT_EQ(
      faults_of(granule_with("preset = \"Starch, dry\"\nnu0 = 0.3\nshear_ratio = 0.5", "")),
      (Lines{"die.toml:4:1: key 'yield_pressure' is missing in [material], and preset 'Starch, dry' does not have "
             "it; expected for example yield_pressure = \"50 MPa\""}));
}

// What the list of presets says must be what a scenario with this preset alone gets to read.
TEST(Presets, SayWhatTheyLackAsAScenarioWithThemDoes) {
  std::size_t good = 0;
  for (const char* name : {"compressible", "material-point"}) {
    const Model& model = *find_model(name);
    const bool has_walls = model.has_walls();
    for (const Preset& preset : model.presets) {
      const std::string material = fmt::format("preset = \"{}\"", preset.name);
      const std::string text = has_walls ? granule_with(material, "")
                                         : fmt::format(
                                               "model = \"{}\"\n[material]\n{}\n[loading]\nconfiguration = \"simple\"\n"
                                               "[[loading.steps]]\nstrain = -0.1\nduration = 1\n",
                                               name, material);
      const Lines faults = faults_of(text);
      const std::string shortfall = shortfall_of(preset, model);
      EXPECT_EQ(faults.empty(), shortfall.empty()) << name << ": " << preset.name << ": " << shortfall;
      if (faults.empty()) ++good;
      const std::string refusal = "refused on its own: ";
      if (shortfall.starts_with(refusal)) {
        EXPECT_TRUE(faults.front().ends_with(shortfall.substr(refusal.size()))) << faults.front();
      }
    }
  }
  EXPECT_EQ(good, 8U) << "two of compressible and six of material-point";
}

TEST(CompressibleRules, RefuseNumbersOutOfRangeAndQuantitiesTheLawDoesNotHave) {
  EXPECT_EQ(faults_of(granule_with(k_granule, "k = 0\nalpha = 0.9\nbeta = -1")),
            (Lines{"die.toml:15:5: k = 0: out of range; expected a number above 0 and up to 1e+100",
                   "die.toml:16:9: alpha = 0.9: out of range; expected a number from 1 to 1e+100",
                   "die.toml:17:8: beta = -1: out of range; expected a number above 0 and up to 1e+100"}));
  EXPECT_EQ(
      faults_of(granule_with(k_granule + "\neta = 10", "")),
      (Lines{"die.toml:9:1: key 'eta' is not used by model 'compressible'; expected one of preset, stiffness_ratio, "
             "shear_ratio, tensile_ratio, nu0, yield_pressure"}));
  EXPECT_EQ(faults_of(scenario_with("compressible", k_granule,
                                    "[[loading.steps]]\ndisplacement = 0.1\nduration = 1\nuntil = { pressure = 1 }\n")),
            (Lines{"die.toml:14:11: key 'pressure' is not used by model 'compressible'; expected one of wall, force, "
                   "displacement, event"}));
}

TEST(Objections, NameTheNumberThatIsOutside) {
  const Lines soft =
      faults_of(scenario_with("semimech", "youngs_modulus = 20\npoisson_ratio = 0.3\nyield_stress = 1", k_ramp));
  ASSERT_EQ(soft.size(), 1u);
  EXPECT_TRUE(soft[0].starts_with("die.toml:7:16: E/((1-nu^2) Y) = 21.97")) << soft[0];
  EXPECT_TRUE(soft[0].find("22.0930") != std::string::npos) << soft[0];
  const std::string rubber = "youngs_modulus = 1000\npoisson_ratio = 0.5\nyield_stress = 1";
  EXPECT_TRUE(faults_of(scenario_with("semimech", rubber, k_ramp)).empty());
  const Lines enclosed = faults_of(scenario_with("semimech", rubber, k_ramp, "die"));
  ASSERT_EQ(enclosed.size(), 1u);
  EXPECT_TRUE(enclosed[0].starts_with("die.toml:6:17: ")) << enclosed[0];
  EXPECT_EQ(
      faults_of(scenario_with("hardening", k_power_law, k_ramp + "[hardening]\nunloading = \"mdr\"")),
      (Lines{"die.toml:13:13: unloading = \"mdr\" needs the elastic constants; expected youngs_modulus in [material]",
             "die.toml:13:13: unloading = \"mdr\" needs the elastic constants; expected poisson_ratio in [material]"}));
  EXPECT_EQ(
      faults_of(scenario_with("semimech", k_steel, k_ramp, "walls")),
      (Lines{"die.toml:9:17: configuration 'walls' is not available for model 'semimech'; available: simple, die, "
             "hydrostatic"}));
}

TEST(LoadingOnly, RefusesWallsThatGoBack) {
  const std::string tail =
      ", and model 'hardening' has no unloading of its own; expected growing targets, or unloading = "
      "\"mdr\" in [hardening]";
  const auto faults = [&](const std::string& steps) {
    return faults_of(scenario_with("hardening", k_power_law, steps));
  };
  const std::string back = "[[loading.steps]]\ndisplacement = 0.05\nduration = 1\n";
  EXPECT_EQ(faults(k_ramp + back), (Lines{"die.toml:12:1: the wall goes back from 0.1 m to 0.05 m" + tail}));
  EXPECT_EQ(faults("[[loading.steps]]\nforce = 2\nduration = 1\n[[loading.steps]]\nforce = 1\nduration = 1\n"),
            (Lines{"die.toml:12:1: the force goes back from 2 N to 1 N" + tail}));
  EXPECT_EQ(faults(k_ramp + "[[loading.steps]]\ndetach = true\nrate = 1\n"),
            (Lines{"die.toml:12:1: detach withdraws the wall" + tail}));
  EXPECT_EQ(faults("[[loading.steps]]\ncycle = 2\nsteps = [{ displacement = 0.1, duration = 1 }, "
                   "{ displacement = 0.05, duration = 1 }]\n")
                .size(),
            1u);
  // A step that ends early may have stopped short of its target.
  EXPECT_TRUE(
      faults("[[loading.steps]]\ndisplacement = 0.1\nduration = 1\nuntil = { force = 0.001 }\n" + back).empty());
  EXPECT_TRUE(faults("[[loading.steps]]\nforce = 0.01\nduration = 1\n" + k_ramp).empty());
  EXPECT_TRUE(faults(k_ramp + k_ramp).empty());
}

}  // namespace
}  // namespace monograin::rules_test
