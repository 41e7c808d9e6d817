#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "scenario/scenario.hpp"
#include "scenario/support.hpp"
#include "support/text_file.hpp"

namespace monograin::reader_test {
namespace {

CheckedScenario good(std::string_view text, const std::vector<std::string>& overrides = {}) {
  return parse_scenario(text, "folder/die.toml", overrides);
}

TEST(Scenario, IsReadInSi) {
  const CheckedScenario scenario = good(k_good_scenario);
  EXPECT_EQ(scenario.name, "die");
  EXPECT_EQ(scenario.title, "t");
  EXPECT_EQ(scenario.model, "mdr");
  EXPECT_DOUBLE_EQ(scenario.radius, 0.01);
  EXPECT_DOUBLE_EQ(scenario.material.at("youngs_modulus"), 1e9);
  EXPECT_DOUBLE_EQ(scenario.material.at("poisson_ratio"), 0.3);
  EXPECT_DOUBLE_EQ(scenario.material.at("yield_stress"), 5e7);
  EXPECT_EQ(scenario.loading.configuration, Loading::Configuration::simple);
  ASSERT_EQ(scenario.loading.steps.size(), 1U);
  const Step& step = scenario.loading.steps[0];
  EXPECT_EQ(step.kind, Step::Kind::displacement);
  EXPECT_DOUBLE_EQ(step.target, 0.001);
  EXPECT_EQ(step.duration, 1.0);
  EXPECT_FALSE(step.rate);
  EXPECT_EQ(step.where.line, 11U);
}

TEST(Scenario, HasDefaultsFilledIn) {
  const CheckedScenario scenario = good(k_good_scenario);
  EXPECT_EQ(scenario.material.at("surface_energy"), 0.0);
  EXPECT_EQ(std::get<std::string>(scenario.options.at("radius_rule")), "yielded");
  EXPECT_EQ(std::get<std::string>(scenario.options.at("elastic_profile")), "ellipse");
  EXPECT_EQ(std::get<std::string>(scenario.options.at("delta_max_rule")), "running-maximum");
  EXPECT_FALSE(std::get<bool>(scenario.options.at("strict")));
  EXPECT_FALSE(scenario.loading.centre_is_free);
  EXPECT_EQ(scenario.output.points, 200);
  EXPECT_TRUE(scenario.output.times.empty());
  EXPECT_EQ(scenario.numerics.integrator, "auto");
  EXPECT_EQ(scenario.numerics.rtol, 1e-8);
  EXPECT_EQ(scenario.numerics.atol, 1e-12);
}

TEST(Scenario, KeepsItsTextAndOverrides) {
  const CheckedScenario scenario = good(k_good_scenario, {"title=x"});
  EXPECT_EQ(scenario.text, k_good_scenario);
  EXPECT_EQ(scenario.overrides, std::vector<std::string>{"title=x"});
}

TEST(Scenario, TakesBareNumbersAsSi) {
  const CheckedScenario scenario = good(with_line(4, "radius = 2"));
  EXPECT_EQ(scenario.radius, 2.0);
  EXPECT_DOUBLE_EQ(scenario.loading.steps[0].target, 0.2) << "R0 is the initial radius";
}

TEST(Scenario, TakesTheInitialRadiusAsAUnitWhereverTheParticleStands) {
  const CheckedScenario scenario = good(
      "model = \"hertz\"\n[loading]\nconfiguration = \"simple\"\n"
      "steps = [{ displacement = \"R0\", rate = \"R0/s\" }, { displacement = \"-0.5 R0\", rate = \"2 R0/s\" }]\n"
      "[material]\nyoungs_modulus = 1e9\npoisson_ratio = 0\n[particle]\nradius = 0.5\n");
  EXPECT_EQ(scenario.loading.steps[0].target, 0.5);
  EXPECT_EQ(scenario.loading.steps[0].rate, 0.5);
  EXPECT_EQ(scenario.loading.steps[1].target, -0.25);
  EXPECT_EQ(scenario.loading.steps[1].rate, 1.0);
}

TEST(Scenario, ReadsOutputAndNumerics) {
  const CheckedScenario scenario =
      good(with_more("[output]\ntimes = [0, \"250 ms\", 0.5]\npoints = 0\n[numerics]\nintegrator = \"ida\"\nrtol = "
                     "1e-6\natol = 1e-9\n"));
  EXPECT_EQ(scenario.output.times, (std::vector<double>{0.0, 0.25, 0.5}));
  EXPECT_EQ(scenario.output.points, 0);
  EXPECT_EQ(scenario.numerics.integrator, "ida");
  EXPECT_EQ(scenario.numerics.rtol, 1e-6);
  EXPECT_EQ(scenario.numerics.atol, 1e-9);
}

TEST(Scenario, QuestionsNumbersThatLackAUnit) {
  using Lines = std::vector<std::string>;
  EXPECT_EQ(good(k_good_scenario).doubts, Lines());
  EXPECT_EQ(good(with_line(8, "yield_stress = 30")).doubts,
            Lines{"yield_stress = 30 (line 8) has no unit and is taken as 30 Pa; if another unit is meant, write it: "
                  "\"30 MPa\""});
  EXPECT_EQ(
      good(with_line(12, "displacement = 0.4")).doubts,
      Lines{"displacement = 0.4 (line 12) has no unit and is taken as 0.4 m, 40 times the radius; if another unit "
            "is meant, write it: \"0.4 R0\""});
  EXPECT_EQ(good(with_line(12, "displacement = 0.05")).doubts, Lines()) << "five radii, across a gap";
  EXPECT_EQ(
      good(k_good_scenario, {"material.yield_stress=30"}).doubts,
      Lines{"yield_stress = 30 has no unit and is taken as 30 Pa; if another unit is meant, write it: \"30 MPa\""});
  const std::string own_units =
      "model = \"mdr\"\n[particle]\nradius = 1\n[material]\nyoungs_modulus = 1\npoisson_ratio = 0.3\n"
      "yield_stress = 0.05\n[loading]\nconfiguration = \"simple\"\nsteps = [{ displacement = \"0.4 R0\", duration = "
      "\"1 s\" }]\n";
  EXPECT_EQ(good(own_units).doubts, Lines()) << "the modulus is the unit of stress";
  EXPECT_EQ(good(with_line(4, "radius = 100")).doubts,
            Lines{"radius = 100 (line 4) has no unit and is taken as 100 m; if another unit is meant, write it: "
                  "\"100 mm\""});
  EXPECT_EQ(good(with_line(4, "radius = 1")).doubts, Lines());
}

TEST(Scenario, ReadsOptionsOfItsModel) {
  const CheckedScenario scenario = good(with_more("[mdr]\nradius_rule = \"seed\"\nstrict = true\n"));
  EXPECT_EQ(std::get<std::string>(scenario.options.at("radius_rule")), "seed");
  EXPECT_TRUE(std::get<bool>(scenario.options.at("strict")));
}

TEST(Scenario, ReadsDottedAndInlineTablesAlike) {
  const CheckedScenario scenario = good(
      "model = \"hertz\"\nparticle.radius = \"1 mm\"\nmaterial = { youngs_modulus = 1e9, poisson_ratio = 0.2 }\n"
      "loading.configuration = \"die\"\nloading.steps = [{ hold = true, duration = 1 }]\n");
  EXPECT_EQ(scenario.radius, 1e-3);
  EXPECT_EQ(scenario.loading.configuration, Loading::Configuration::die);
}

struct ScaleRow {
  const char* name;
  const char* radius;
  const char* modulus;
  const char* duration;
};

class Scales : public ::testing::TestWithParam<ScaleRow> {};

TEST_P(Scales, AreAccepted) {
  std::string text = with_line(4, std::string("radius = ") + GetParam().radius);
  const auto put = [&text](std::string_view old, std::string_view value) {
    text.replace(text.find(old), old.size(), value);
  };
  put("\"1 GPa\"", GetParam().modulus);
  put("\"1 s\"", GetParam().duration);
  EXPECT_TRUE(faults_of(text).empty()) << text << faults_of(text)[0];
}

INSTANTIATE_TEST_SUITE_P(Scenario, Scales,
                         ::testing::Values(ScaleRow{"tiny", "1e-9", "1e3", "1e-12"},
                                           ScaleRow{"huge", "1e4", "1e15", "1e12"},
                                           ScaleRow{"texts", "\"10 nm\"", "\"1e6 GPa\"", "\"1e-3 ns\""},
                                           ScaleRow{"long_hold", "\"10 km\"", "\"1 Pa\"", "\"1e9 h\""}),
                         [](const auto& row) { return std::string(row.param.name); });

// --- steps

std::vector<Step> steps_of(std::string_view steps) {
  return good(with_loading("[loading]\nconfiguration = \"simple\"\nsteps = [" + std::string(steps) + "]\n"))
      .loading.steps;
}

TEST(Steps, MayHoldAndDetach) {
  const std::vector<Step> steps =
      steps_of("{ hold = true, duration = \"2 min\" }, { detach = true, rate = \"1 mm/s\" }");
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0].kind, Step::Kind::hold);
  EXPECT_EQ(steps[0].duration, 120.0);
  EXPECT_EQ(steps[1].kind, Step::Kind::detach);
  EXPECT_EQ(steps[1].rate, 1e-3);
}

TEST(Steps, MayGoBackBehindFirstTouch) {
  EXPECT_DOUBLE_EQ(steps_of("{ displacement = \"-0.1 R0\", duration = 1 }")[0].target, -1e-3);
}

TEST(Steps, HaveConditionsOfEveryQuantity) {
  const std::vector<Step> steps = steps_of(
      "{ displacement = \"0.1 R0\", duration = 1, until = { force = \"-1 N\", displacement = \"0.05 R0\", pressure = "
      "\"1 MPa\","
      " contact_radius = \"R0\", apparent_radius = \"1.1 R0\", event = \"yield\" } }");
  const std::vector<Until>& until = steps[0].until;
  ASSERT_EQ(until.size(), 6U);
  const auto expect = [&](std::size_t i, Quantity quantity, double value) {
    EXPECT_EQ(until[i].quantity, quantity);
    EXPECT_DOUBLE_EQ(until[i].value, value);
  };
  expect(0, Quantity::force, -1.0);
  expect(1, Quantity::displacement, 5e-4);
  expect(2, Quantity::pressure, 1e6);
  expect(3, Quantity::contact_radius, 1e-2);
  expect(4, Quantity::apparent_radius, 1.1e-2);
  EXPECT_TRUE(until[5].is_event());
  EXPECT_EQ(until[5].event, "yield");
}

TEST(Steps, OfACycleAreWrittenOut) {
  const std::vector<Step> steps = steps_of(
      "{ cycle = 2, steps = [{ displacement = 1e-3, duration = 1 }, { cycle = 3, steps = [{ hold = true, duration = 1 "
      "}] }] }");
  ASSERT_EQ(steps.size(), 8U);
  EXPECT_EQ(steps[0].kind, Step::Kind::displacement);
  for (std::size_t i : {1U, 2U, 3U, 5U, 6U, 7U}) EXPECT_EQ(steps[i].kind, Step::Kind::hold) << i;
  EXPECT_EQ(steps[4].kind, Step::Kind::displacement);
  EXPECT_EQ(steps[4].where.column, steps[0].where.column);
}

TEST(Steps, UpToTheLimitAreAccepted) {
  EXPECT_EQ(steps_of("{ cycle = 100000, steps = [{ hold = true, duration = 1 }] }").size(), 100000U);
}

// --- walls

TEST(Loading, ReadsWallSets) {
  const CheckedScenario scenario = good(with_loading(
      "[loading]\nconfiguration = \"walls\"\ncentre = \"equilibrium\"\n[[loading.steps]]\nhold = true\nduration = 1\n"
      "[[loading.wall]]\nname = \"a\"\nnormal = [0, 0, 2]\n"
      "[[loading.wall]]\nname = \"b-1\"\nnormal = [0, 0.5, -1]\ngap = \"0.1 R0\"\nfixed = true\n"
      "[[loading.wall]]\nname = \"c\"\nnormal = [1, 0, 0]\nsteps = [{ displacement = 0, duration = 1 }]\n"));
  const Loading& loading = scenario.loading;
  EXPECT_EQ(loading.configuration, Loading::Configuration::walls);
  EXPECT_TRUE(loading.centre_is_free);
  ASSERT_EQ(loading.walls.size(), 3U);
  EXPECT_EQ(loading.walls[0].normal, (std::array<double, 3>{0.0, 0.0, 2.0})) << "as given, not normalised";
  EXPECT_TRUE(loading.walls[0].steps.empty());
  EXPECT_FALSE(loading.walls[0].is_fixed);
  EXPECT_EQ(loading.walls[1].name, "b-1");
  EXPECT_DOUBLE_EQ(loading.walls[1].gap, 1e-3);
  EXPECT_TRUE(loading.walls[1].is_fixed);
  EXPECT_EQ(loading.walls[2].steps.size(), 1U);
}

TEST(Loading, ReadsTheObliqueDie) {
  const auto loading = [](std::string_view keys) {
    return good(with_line(10, "configuration = \"oblique-die\"\n" + std::string(keys))).loading;
  };
  EXPECT_DOUBLE_EQ(loading("").oblique_angle, 37.5 * std::numbers::pi / 180.0);
  EXPECT_EQ(loading("").oblique_walls, 2);
  EXPECT_DOUBLE_EQ(loading("angle = \"45 deg\"").oblique_angle, std::numbers::pi / 4.0);
  EXPECT_DOUBLE_EQ(loading("angle = 0.5").oblique_angle, 0.5);
  EXPECT_EQ(loading("oblique_walls = 4").oblique_walls, 4);
}

// --- ready scenarios

TEST(ReadyScenarios, AreAllAccepted) {
  const auto files = toml_files("scenarios");
  EXPECT_GE(files.size(), 8U);
  for (const auto& file : files) {
    EXPECT_NO_THROW({
      const CheckedScenario scenario = read_scenario(file);
      EXPECT_EQ(scenario.name, file.stem().string());
      EXPECT_FALSE(scenario.title.empty()) << file;
    }) << file;
  }
}

TEST(ReadyScenarios, ContainTheBuiltInOne) {
  EXPECT_EQ(default_scenario_text(), read_text(std::filesystem::path(MONOGRAIN_SOURCE_DIR) / "scenarios/die.toml"));
  const CheckedScenario scenario = parse_scenario(default_scenario_text(), "die.toml");
  EXPECT_EQ(scenario.name, "die");
  EXPECT_EQ(scenario.loading.steps.size(), 3U);
}

}  // namespace
}  // namespace monograin::reader_test
