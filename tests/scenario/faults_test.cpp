// Every kind of fault, with the place and the wording that users meet.

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <limits>
#include <string>
#include <vector>

#include "catalogue.hpp"
#include "scenario/scenario.hpp"
#include "scenario/support.hpp"

namespace monograin::faults_test {
namespace {

struct FaultRow {
  const char* name;
  std::size_t line;  ///< of the small scenario, replaced by
  const char* replacement;
  std::vector<std::string> messages;
};

/// All that can be run.
const std::string k_models = [] {
  std::string names;
  for (const Model& model : model_catalogue()) names += (names.empty() ? "" : ", ") + std::string(model.name);
  return names;
}();

class FaultTable : public ::testing::TestWithParam<FaultRow> {};

TEST(Faults, OfAMisplacedRequiredKeyAreOne) {
  const std::string moved = std::string("[material]\n") + "youngs_modulus = \"1 GPa\"\n";
  std::string text(k_good_scenario);
  text.replace(text.find(moved), moved.size(), "youngs_modulus = \"1 GPa\"\n[material]\n");
  EXPECT_EQ(faults_of(text), std::vector<std::string>{"die.toml:5:1: key 'youngs_modulus' belongs in [material]"});
}

TEST_P(FaultTable, IsReportedAtItsPlace) {
  const FaultRow& row = GetParam();
  EXPECT_EQ(faults_of(with_line(row.line, row.replacement)), row.messages) << row.replacement;
}

const std::vector<FaultRow> k_rows{
    FaultRow{"TitleIsNoText",
             1,
             "title = 3",
             {"die.toml:1:9: title = 3: expected a text in quotes, for example \"die compaction\""}},
    FaultRow{"UnknownTable",
             1,
             "[outptu]\npoints = 3\n[_]",
             {"die.toml:1:1: key 'model' is missing in the scenario; expected for example model = \"mdr\"",
              "die.toml:1:2: unknown key 'outptu' in the scenario; did you mean 'output'?",
              "die.toml:3:2: unknown key '_' in the scenario; expected one of title, model, particle, material, "
              "loading, output, numerics, sensitivities, " +
                  k_models}},
    FaultRow{"UnknownRootKey",
             1,
             "titel = \"t\"",
             {"die.toml:1:1: unknown key 'titel' in the scenario; did you mean 'title'?"}},
    FaultRow{
        "KeysOfOtherTables",
        4,
        "radius = \"10 mm\"\nyield_stress = \"1 MPa\"\ntitle = \"t\"\ndisplacement = \"1 mm\"\ngap = 0\nsteps = []",
        {"die.toml:5:1: key 'yield_stress' belongs in [material]",
         "die.toml:6:1: key 'title' belongs above the first table",
         "die.toml:7:1: key 'displacement' belongs in [[loading.steps]]",
         "die.toml:8:1: key 'gap' belongs in [[loading.wall]]", "die.toml:9:1: key 'steps' belongs in [loading]"}},
    FaultRow{"TableInATable",
             10,
             "configuration = \"simple\"\noutput = { points = 3 }",
             {"die.toml:11:1: key 'output' is a table of its own: [output]"}},
    FaultRow{"MissingModel",
             2,
             "",
             {"die.toml:1:1: key 'model' is missing in the scenario; expected for example model = \"mdr\""}},
    FaultRow{"MisspeltModel",
             2,
             "model = \"mrd\"",
             {"die.toml:2:9: model = \"mrd\": expected one of " + k_models + "; did you mean 'mdr'?"}},
    FaultRow{"ModelInCapitals",
             2,
             "model = \"MDR\"",
             {"die.toml:2:9: model = \"MDR\": expected one of " + k_models + "; did you mean 'mdr'?"}},
    FaultRow{
        "UnknownModel", 2, "model = \"granite\"", {"die.toml:2:9: model = \"granite\": expected one of " + k_models}},
    FaultRow{"ModelIsNoText", 2, "model = 1", {"die.toml:2:9: model = 1: expected one of " + k_models}},
    FaultRow{"MissingRadius",
             4,
             "",
             {"die.toml:3:1: key 'radius' is missing in [particle]; expected for example radius = \"10 mm\""}},
    FaultRow{"RadiusInR0",
             4,
             "radius = \"1 R0\"",
             {"die.toml:4:10: radius = \"1 R0\": the initial radius cannot be given in itself; expected a length, for "
              "example \"10 mm\""}},
    FaultRow{"NegativeRadius",
             4,
             "radius = \"-10 mm\"",
             {"die.toml:4:10: radius = \"-10 mm\": out of range; expected a length from 1e-12 m to 1e+06 m"}},
    FaultRow{"ZeroRadius",
             4,
             "radius = 0",
             {"die.toml:4:10: radius = 0: out of range; expected a length from 1e-12 m to 1e+06 m"}},
    FaultRow{"NanRadius",
             4,
             "radius = nan",
             {"die.toml:4:10: radius = nan: out of range; expected a length from 1e-12 m to 1e+06 m"}},
    FaultRow{"InfiniteRadius",
             4,
             "radius = inf",
             {"die.toml:4:10: radius = inf: out of range; expected a length from 1e-12 m to 1e+06 m"}},
    FaultRow{"HugeRadius",
             4,
             "radius = \"1e9 m\"",
             {"die.toml:4:10: radius = \"1e9 m\": out of range; expected a length from 1e-12 m to 1e+06 m"}},
    FaultRow{"OverflowingRadius",
             4,
             "radius = \"1e400 m\"",
             {"die.toml:4:10: radius = \"1e400 m\": the number is too large or too small; expected a length, for "
              "example \"10 mm\""}},
    FaultRow{"RadiusIsBoolean",
             4,
             "radius = true",
             {"die.toml:4:10: radius = true: expected a length, for example \"10 mm\""}},
    FaultRow{"RadiusIsTable",
             4,
             "radius = { value = 1 }",
             {"die.toml:4:10: radius = a table: expected a length, for example \"10 mm\""}},
    FaultRow{"RadiusWithoutUnit",
             4,
             "radius = \"10\"",
             {"die.toml:4:10: radius = \"10\": the unit is missing; expected a length, for example \"10 mm\""}},
    FaultRow{"RadiusWithUnknownUnit",
             4,
             "radius = \"10 MM\"",
             {"die.toml:4:10: radius = \"10 MM\": unknown unit 'MM'; expected a length, for example \"10 mm\"; "
              "did you mean 'mm'?"}},
    FaultRow{"MisspeltMaterialKey",
             7,
             "poison_ratio = 0.3",
             {"die.toml:7:1: unknown key 'poison_ratio' in [material]; did you mean 'poisson_ratio'?"}},
    FaultRow{
        "MissingMaterialKey",
        8,
        "",
        {"die.toml:5:1: key 'yield_stress' is missing in [material]; expected for example yield_stress = \"50 MPa\""}},
    FaultRow{"KeyOfAnotherModel",
             8,
             "yield_stress = \"50 MPa\"\nstrength = \"1 MPa\"",
             {"die.toml:9:1: key 'strength' is not used by model 'mdr'; expected one of youngs_modulus, poisson_ratio, "
              "yield_stress, surface_energy"}},
    FaultRow{"PoissonAboveHalf",
             7,
             "poisson_ratio = 0.6",
             {"die.toml:7:17: poisson_ratio = 0.6: out of range; expected a number above -1 and up to 0.5"}},
    FaultRow{"PoissonAsText",
             7,
             "poisson_ratio = \"0.3\"",
             {"die.toml:7:17: poisson_ratio = \"0.3\": expected a number above -1 and up to 0.5"}},
    FaultRow{
        "UnknownStressUnit",
        8,
        "yield_stress = \"50 MPA\"",
        {"die.toml:8:16: yield_stress = \"50 MPA\": unknown unit 'MPA'; expected a stress, for example \"50 MPa\"; "
         "did you mean 'MPa'?"}},
    FaultRow{"StressUnitWithoutItsCaret",
             8,
             "yield_stress = \"50 N/mm2\"",
             {"die.toml:8:16: yield_stress = \"50 N/mm2\": unknown unit 'N/mm2'; expected a stress, for example \"50 "
              "MPa\"; did you mean 'N/mm^2'?"}},
    FaultRow{"NegativeSurfaceEnergy",
             8,
             "yield_stress = \"50 MPa\"\nsurface_energy = \"-1 J/m^2\"",
             {"die.toml:9:18: surface_energy = \"-1 J/m^2\": out of range; expected a surface energy from 0 J/m^2 to "
              "1e+24 J/m^2"}},
    FaultRow{"MisspeltConfiguration",
             10,
             "configuration = \"dei\"",
             {"die.toml:10:17: configuration = \"dei\": expected one of simple, die, hydrostatic, oblique-die, walls; "
              "did you mean 'die'?"}},
    FaultRow{"ConfigurationOfAnotherModel",
             10,
             "configuration = \"triaxial\"",
             {"die.toml:10:17: configuration 'triaxial' is not available for model 'mdr'; available: simple, die, "
              "hydrostatic, oblique-die, walls"}},
    FaultRow{"AngleOutsideObliqueDie",
             10,
             "configuration = \"die\"\nangle = \"30 deg\"",
             {"die.toml:11:1: key 'angle' goes with configuration = \"oblique-die\" only"}},
    FaultRow{"RightAngle",
             10,
             "configuration = \"oblique-die\"\nangle = \"90 deg\"",
             {"die.toml:11:9: angle = \"90 deg\": out of range; expected an angle of at least 1e-09 rad and below "
              "1.5708 rad"}},
    FaultRow{"ThreeObliqueWalls",
             10,
             "configuration = \"oblique-die\"\noblique_walls = 3",
             {"die.toml:11:17: oblique_walls = 3: expected 2 or 4"}},
    FaultRow{"WallOutsideWalls",
             10,
             "configuration = \"die\"\nwall = [{ name = \"a\", normal = [0, 0, 1] }]",
             {"die.toml:11:1: key 'wall' goes with configuration = \"walls\" only"}},
    FaultRow{"UnknownCentre",
             10,
             "configuration = \"die\"\ncentre = \"free\"",
             {"die.toml:11:10: centre = \"free\": expected one of fixed, equilibrium"}},
    FaultRow{"StepsAsTable",
             11,
             "[loading.steps]",
             {"die.toml:11:1: steps = a table: expected an array of tables, written [[loading.steps]]"}},
    FaultRow{"StepSaysNothing",
             12,
             "",
             {"die.toml:11:1: the step has nothing to do; expected exactly one of displacement, force, hold, detach, "
              "cycle"}},
    FaultRow{"MisspeltStepKey",
             12,
             "dispalcement = \"0.1 R0\"",
             {"die.toml:12:1: unknown key 'dispalcement' in [[loading.steps]]; did you mean 'displacement'?"}},
    FaultRow{"MisspeltStepKeyBesideAWrongUnit",
             12,
             "dispalcement = \"0.1 R0\"\nuntil = { force = \"1 m\" }",
             {"die.toml:12:1: unknown key 'dispalcement' in [[loading.steps]]; did you mean 'displacement'?",
              "die.toml:13:19: force = \"1 m\": 'm' is a unit of length; expected a force, for example \"10 N\""}},
    FaultRow{
        "NothingToDoBesideAWrongUnit",
        12,
        "until = { displacement = \"1 N\" }",
        {"die.toml:11:1: the step has nothing to do; expected exactly one of displacement, force, hold, detach, "
         "cycle",
         "die.toml:12:26: displacement = \"1 N\": 'N' is a unit of force; expected a length, for example \"10 mm\""}},
    FaultRow{"TwoFormsInOneStep",
             12,
             "displacement = \"0.1 R0\"\nhold = true",
             {"die.toml:13:1: key 'hold' does not go with 'displacement' in one step"}},
    FaultRow{"HoldFalse", 12, "hold = false", {"die.toml:12:8: hold = false: expected true"}},
    FaultRow{"DetachWithDuration",
             12,
             "detach = true\nrate = 1",
             {"die.toml:14:1: key 'duration' does not go with 'detach' in one step"}},
    FaultRow{"StepOfAnotherModel",
             12,
             "displacement = 0\nstrain = 0.1",
             {"die.toml:13:1: key 'strain' is not used by model 'mdr'; expected one of displacement, duration, rate, "
              "until, force, hold, detach, cycle, steps"}},
    FaultRow{"NoDurationNorRate",
             13,
             "",
             {"die.toml:11:1: the step has neither duration nor rate; expected one of them, for example duration = \"1 "
              "s\""}},
    FaultRow{"DurationAndRate",
             13,
             "duration = \"1 s\"\nrate = \"1 mm/s\"",
             {"die.toml:14:1: key 'rate' does not go with 'duration'; expected exactly one of them"}},
    FaultRow{"ZeroDuration",
             13,
             "duration = 0",
             {"die.toml:13:12: duration = 0: out of range; expected a time from 1e-15 s to 1e+18 s"}},
    FaultRow{"RateInWrongUnit",
             13,
             "rate = \"1 N/s\"",
             {"die.toml:13:8: rate = \"1 N/s\": 'N/s' is a unit of force rate; expected a velocity, for example \"1 "
              "mm/s\""}},
    FaultRow{"UntilIsEmpty",
             13,
             "duration = 1\nuntil = {}",
             {"die.toml:14:9: until = an empty table: expected a table, written until = { force = \"0 N\" }"}},
    FaultRow{"UntilIsNumber",
             13,
             "duration = 1\nuntil = 3",
             {"die.toml:14:9: until = 3: expected a table, written until = { force = \"0 N\" }"}},
    FaultRow{"UntilUnknownKey",
             13,
             "duration = 1\nuntil = { froce = 0 }",
             {"die.toml:14:11: unknown key 'froce' in until; did you mean 'force'?"}},
    FaultRow{"UntilKeyOfMaterialPoint",
             13,
             "duration = 1\nuntil = { stress_axial = 0 }",
             {"die.toml:14:11: key 'stress_axial' is not used by model 'mdr'; expected one of wall, force, "
              "displacement, pressure, contact_radius, apparent_radius, event"}},
    FaultRow{"UntilUnknownEvent",
             13,
             "duration = 1\nuntil = { event = \"yeild\" }",
             {"die.toml:14:19: event = \"yeild\": expected one of contact-made, contact-lost, dent-touched, yield, "
              "load-reversal, retreat, reload, "
              "stick, peel, follow, pull-off, force-extremum, growth-on, growth-off, caps-intersect, "
              "singular-growth, volume-limit; did you mean 'yield'?"}},
    FaultRow{"CycleOfZero",
             12,
             "cycle = 0\nsteps = [{ hold = true, duration = 1 }]\n[[loading.steps]]\nhold = true",
             {"die.toml:12:9: cycle = 0: expected a whole number from 1 to 100000"}},
    FaultRow{
        "CycleWithoutSteps",
        12,
        "cycle = 3\n[[loading.steps]]\nhold = true",
        {"die.toml:11:1: key 'steps' is missing in [[loading.steps]]; expected for example [[loading.steps.steps]]"}},
    FaultRow{"CycleWithDuration",
             12,
             "cycle = 2\nsteps = [{ hold = true, duration = 1 }]",
             {"die.toml:14:1: key 'duration' does not go with 'cycle' in one step"}},
    FaultRow{"CycleTooLong",
             12,
             "cycle = 100000\nsteps = [{ hold = true, duration = 1 }, { hold = true, duration = 1 "
             "}]\n[[loading.steps]]\nhold = true",
             {"die.toml:12:1: the program has 200000 ramps or more with cycles, tables and sines written out; expected "
              "at most 100000"}},
    FaultRow{"PointsAreFractional",
             13,
             "duration = 1\n[output]\npoints = 1.5",
             {"die.toml:15:10: points = 1.5: expected a whole number from 0 to 1000000"}},
    FaultRow{"TooManyPoints",
             13,
             "duration = 1\n[output]\npoints = 1000001",
             {"die.toml:15:10: points = 1000001: expected a whole number from 0 to 1000000"}},
    FaultRow{"TimesDescend",
             13,
             "duration = 1\n[output]\ntimes = [0.1, 0.3, 0.2]",
             {"die.toml:15:20: times = 0.2: not later than the one before; expected ascending times"}},
    FaultRow{"NegativeTime",
             13,
             "duration = 1\n[output]\ntimes = [-1]",
             {"die.toml:15:10: times = -1: out of range; expected a time from 0 s to 1e+18 s"}},
    FaultRow{"TimesAreEmpty",
             13,
             "duration = 1\n[output]\ntimes = []",
             {"die.toml:15:9: times = an empty array: expected a list of ascending times, for example [0.1, 0.25]"}},
    FaultRow{"MisspeltIntegrator",
             13,
             "duration = 1\n[numerics]\nintegrator = \"cvode-bfd\"",
             {"die.toml:15:14: integrator = \"cvode-bfd\": expected one of auto, direct, cvode-bdf, cvode-adams, ida, "
              "arkode-erk, arkode-dirk, odeint-dopri5, odeint-fehlberg78, odeint-bulirsch-stoer, "
              "odeint-rosenbrock4, gsl-rk8pd, gsl-msadams, gsl-msbdf, forward-euler; did you mean 'cvode-bdf'?"}},
    FaultRow{"RtolTooSmall",
             13,
             "duration = 1\n[numerics]\nrtol = 1e-15",
             {"die.toml:15:8: rtol = 1e-15: out of range; expected a number from 1e-14 to 0.1"}},
    FaultRow{"ZeroAtol",
             13,
             "duration = 1\n[numerics]\natol = 0",
             {"die.toml:15:8: atol = 0: out of range; expected a number above 0 and up to 0.1"}},
    FaultRow{"UnknownOption",
             13,
             "duration = 1\n[mdr]\nradius_ruel = \"seed\"",
             {"die.toml:15:1: unknown key 'radius_ruel' in [mdr]; did you mean 'radius_rule'?"}},
    FaultRow{"UnknownChoice",
             13,
             "duration = 1\n[mdr]\nradius_rule = \"seeds\"",
             {"die.toml:15:15: radius_rule = \"seeds\": expected one of yielded, gated, seed; did you mean 'seed'?"}},
    FaultRow{"StrictIsText",
             13,
             "duration = 1\n[mdr]\nstrict = \"yes\"",
             {"die.toml:15:10: strict = \"yes\": expected true or false"}},
    FaultRow{
        "PressureTableWithoutName",
        13,
        "duration = 1\n[mdr]\npressure_table = \"\"",
        {"die.toml:15:18: pressure_table = \"\": expected the name of a file in quotes, for example \"file.csv\""}},
    FaultRow{
        "PressureTableMissing",
        13,
        "duration = 1\n[mdr]\npressure_table = \"none.csv\"",
        {"die.toml:15:18: pressure_table = \"none.csv\": there is no such file (none.csv); expected a table of two "
         "columns such as delta_max_over_R,p_over_Y, its path relative to the scenario's folder"}},
    FaultRow{"TableOfAnotherModel",
             13,
             "duration = 1\n[nonlocal]\nterms = 4",
             {"die.toml:14:2: key 'nonlocal' is the table of another model; this one is 'mdr'"}},
    FaultRow{"DuplicateKey",
             13,
             "duration = 1\nduration = 2",
             {"die.toml:14:12: not valid TOML: 'duration' is there already; expected each key and table once"}},
    FaultRow{"CutOff",
             13,
             "duration = \"1 s",
             {"die.toml:13:16: not valid TOML: the text is not closed before a line break or a control character; "
              "expected a quote at its end"}},
    FaultRow{"UnquotedUnit",
             13,
             "duration = 1 s",
             {"die.toml:13:14: not valid TOML: there is more after the value; expected the end of the line, and quotes "
              "around a number with a unit: \"10 mm\""}},
    FaultRow{"ControlCharacter",
             13,
             "duration = \x01",
             {"die.toml:13:12: not valid TOML: the value is missing; expected for example 3.5, \"10 mm\" or true"}},
    FaultRow{"MissingValue",
             13,
             "duration =",
             {"die.toml:13:11: not valid TOML: the value is missing; expected for example 3.5, \"10 mm\" or true"}},
    FaultRow{"NoEqualsSign",
             13,
             "duration 1",
             {"die.toml:13:10: not valid TOML: '=' is missing after the key; expected key = value"}},
    FaultRow{"WordWithoutQuotes",
             13,
             "duration = long",
             {"die.toml:13:12: not valid TOML: this is no value; expected for example 3.5, \"10 mm\", true, [1, 2] or "
              "{ key = 1 }"}},
    FaultRow{"LeadingZero",
             13,
             "duration = 01",
             {"die.toml:13:14: not valid TOML: a number begins with a zero; expected for example 3, 0.5 or 1e-3"}},
    FaultRow{"UnknownEscape",
             13,
             "duration = \"1\\q\"",
             {"die.toml:13:15: not valid TOML: no such escape in quotes; expected \\n, \\t, \\\", \\\\ or \\uXXXX, or "
              "single quotes around it all"}}};

INSTANTIATE_TEST_SUITE_P(Scenario, FaultTable, ::testing::ValuesIn(k_rows),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(ScenarioFaults, AreReportedTogetherInTheOrderOfTheText) {
  const std::vector<std::string> faults = faults_of(
      "model = \"mdr\"\n[loading]\nconfiguration = \"dei\"\n[[loading.steps]]\nhold = 1\nduration = 1\n"
      "[material]\npoison_ratio = 0.3\nyoungs_modulus = \"1 GPa\"\nyield_stress = \"50 MPA\"\n"
      "[particle]\nradius = \"-1 mm\"\n");
  ASSERT_EQ(faults.size(), 5U);
  const std::vector<std::string> places{
      "die.toml:3:17: ", "die.toml:5:8: ", "die.toml:8:1: ", "die.toml:10:16: ", "die.toml:12:10: "};
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_TRUE(faults[i].starts_with(places[i])) << faults[i];
}

TEST(ScenarioFaults, CarryTheirPlaceAsData) {
  try {
    static_cast<void>(parse_scenario(with_line(7, "poisson_ratio = 2"), "a.toml"));
    FAIL() << "accepted";
  } catch (const ScenarioError& error) {
    ASSERT_EQ(error.faults().size(), 1U);
    EXPECT_EQ(error.faults()[0].where.file, "a.toml");
    EXPECT_EQ(error.faults()[0].where.line, 7U);
    EXPECT_EQ(error.faults()[0].where.column, 17U);
  }
}

/// The shortest of three processor times that it takes to find as many unknown keys [s].
double time_of_unknown_keys(int count) {
  std::string text;
  for (int k = 0; k < count; ++k) text += "unknown_key_" + std::to_string(k) + " = 1\n";
  double shortest = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 3; ++round) {
    const std::clock_t start = std::clock();
    EXPECT_THROW(static_cast<void>(parse_scenario(text, "keys.toml")), ScenarioError);
    shortest = std::min(shortest, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return shortest;
}

TEST(ScenarioFaults, CostTimeInProportionToTheirNumber) {
  // Sixteen times as many would take 256 times as long if each were compared with all others.
  EXPECT_LT(time_of_unknown_keys(32000), 64.0 * time_of_unknown_keys(2000));
}

TEST(ScenarioFaults, OfAnEmptyFileNameWhatIsMissing) {
  const std::vector<std::string> faults = faults_of("");
  ASSERT_EQ(faults.size(), 4U);
  EXPECT_NE(faults[0].find("'model' is missing"), std::string::npos) << faults[0];
}

TEST(ScenarioFaults, OfTextsInTheFileStayOnOneLine) {
  const std::vector<std::string> faults = faults_of(with_line(4, "radius = \"1\\n\\u0007\\nmm\"\n\"a\\nb\" = 1"));
  EXPECT_EQ(faults.size(), 2U);
  for (const std::string& fault : faults) {
    EXPECT_TRUE(fault.starts_with("die.toml:")) << fault;
  }
}

TEST(MisspeltModel, IsCheckedAsTheOneThatWasMeant) {
  std::string text = with_line(7, "poison_ratio = 0.3");
  text.replace(text.find("\"mdr\""), 5, "\"mrd\"");
  EXPECT_EQ(faults_of(text).size(), 2U);
}

// --- files

std::string message_for_file(const std::filesystem::path& file) {
  try {
    static_cast<void>(read_scenario(file));
  } catch (const ScenarioError& error) {
    return error.what();
  }
  return {};
}

TEST(ScenarioFile, ThatIsMissingIsNamed) {
  EXPECT_EQ(message_for_file("no/such.toml"), "no/such.toml:1:1: there is no such file; expected a scenario file");
}

TEST(ScenarioFile, ThatIsADirectoryIsRefused) {
  const std::string folder = std::filesystem::temp_directory_path().string();
  EXPECT_EQ(message_for_file(folder), folder + ":1:1: this is a directory; expected a scenario file");
}

TEST(ScenarioFile, ThatIsHugeIsRefused) {
  const std::string text = std::string(k_good_scenario) + "#" + std::string(17U * 1024U * 1024U, 'x');
  EXPECT_EQ(faults_of(text), std::vector<std::string>{"die.toml:1:1: the file is too large; expected at most 16 MiB"});
}

TEST(ScenarioText, WithManyDotsOutsideKeysIsAccepted) {
  const std::string dots(500, '.');
  EXPECT_EQ(faults_of(with_line(1, "title = \"\"\"" + dots + "\n\"" + dots + "\"\"\" # " + dots)).size(), 0U);
  EXPECT_EQ(faults_of(with_line(1, "title = '" + dots + "\"'")).size(), 0U);
}

}  // namespace
}  // namespace monograin::faults_test
