// From a scenario to classes, names, programs and unknowns.

#include "scene/scene.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/test_run.hpp"

namespace monograin::scene_test {
namespace {

std::vector<std::pair<std::string, double>> names_and_multiplicities(const Scene& scene) {
  std::vector<std::pair<std::string, double>> result;
  for (const ContactClass& c : scene.classes) result.emplace_back(c.name, c.multiplicity());
  return result;
}

using Named = std::vector<std::pair<std::string, double>>;

CheckedScenario preset(Configuration configuration) { return hertz_scenario(configuration, path({0.1, 0.0})); }

CheckedScenario oblique(int walls) {
  CheckedScenario scenario = preset(Configuration::oblique_die);
  scenario.loading.oblique_angle = 0.65;
  scenario.loading.oblique_walls = walls;
  return scenario;
}

bool skips(const Scene& scene, const std::string& words) {
  return std::ranges::any_of(scene.skipped,
                             [&](const std::string& text) { return text.find(words) != std::string::npos; });
}

TEST(Scene, NamesItsClassesAfterTheirRole) {
  EXPECT_EQ(names_and_multiplicities(make_scene(preset(Configuration::simple))), (Named{{"axial", 2}}));
  EXPECT_EQ(names_and_multiplicities(make_scene(preset(Configuration::die))), (Named{{"axial", 2}, {"lateral", 4}}));
  EXPECT_EQ(names_and_multiplicities(make_scene(preset(Configuration::hydrostatic))), (Named{{"axial", 6}}));
}

TEST(Scene, TellsLateralWallsApartWhereSymmetryDoes) {
  EXPECT_EQ(names_and_multiplicities(make_scene(oblique(2))),
            (Named{{"axial", 2}, {"lateral-x", 2}, {"lateral-y", 2}, {"oblique", 2}}));
  EXPECT_EQ(names_and_multiplicities(make_scene(oblique(4))),
            (Named{{"axial", 2}, {"lateral-x", 2}, {"lateral-y", 2}, {"oblique", 4}}));
}

TEST(Scene, HasObliqueWallsInTheYZPlaneThatFaceEachOther) {
  const Scene scene = make_scene(oblique(4));
  const double c = std::cos(0.65);
  const double s = std::sin(0.65);
  const std::vector<Eigen::Vector3d> expected{{0.0, c, s}, {0.0, -c, -s}, {0.0, c, -s}, {0.0, -c, s}};
  ASSERT_EQ(scene.classes[3].normals.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_LE((scene.classes[3].normals[k] - expected[k]).norm(), 1e-15) << k;
}

TEST(Scene, NamesTheClassesOfAFreeSetAfterTheirFirstWalls) {
  const CheckedScenario scenario =
      between(hertz_scenario(Configuration::walls, {}),
              {wall("top", {0, 0, 2}, path({0.1})), wall("side", {1, 0, 0}, {}, 0.05),
               wall("bottom", {0, 0, -1}, path({0.1})), wall("other side", {-3, 0, 0}, {}, 0.05)});
  const Scene scene = make_scene(scenario);
  EXPECT_EQ(names_and_multiplicities(scene), (Named{{"top", 2}, {"side", 2}}));
  EXPECT_EQ(scene.walls[1], (std::vector<std::string>{"side", "other side"}));
  EXPECT_EQ(scene.classes[1].gap, 0.05);
  EXPECT_TRUE(scene.channels[1].program.empty());
  for (const ContactClass& c : scene.classes) {
    for (const Eigen::Vector3d& normal : c.normals) EXPECT_DOUBLE_EQ(normal.norm(), 1.0) << c.name;
  }
}

TEST(Scene, GivesEveryWallAClassOfItsOwnWhenAsked) {
  const Scene scene = make_scene(preset(Configuration::die), false);
  EXPECT_EQ(scene.classes.size(), 6u);
  for (std::size_t c = 0; c < 6; ++c) EXPECT_EQ(scene.classes[c].name, scene.walls[c].front());
  EXPECT_FALSE(skips(scene, "the same by symmetry"));
}

TEST(Scene, CountsItsStepsByTheLongestProgram) {
  EXPECT_EQ(make_scene(preset(Configuration::die)).leg_count(), 2u);
  const CheckedScenario scenario =
      between(hertz_scenario(Configuration::walls, {}),
              {wall("a", {0, 0, 1}, path({0.1})), wall("b", {1, 0, 0}, path({0.1, 0.2, 0.3}))});
  EXPECT_EQ(make_scene(scenario).leg_count(), 3u);
}

TEST(Scene, LetsWallsWithoutStepsFollowTheLoading) {
  CheckedScenario scenario = hertz_scenario(Configuration::walls, path({0.1}));
  scenario.loading.walls = {wall("a", {0, 0, 1}), wall("b", {1, 0, 0})};
  scenario.loading.walls[0].is_fixed = false;
  const std::vector<Wall> walls = make_walls(scenario);
  EXPECT_EQ(walls[0].steps.size(), 1u);
  EXPECT_TRUE(walls[1].steps.empty());
}

/// Typical magnitude of the work in a scene of one step.
double work_of(const std::string& head, const std::string& step) {
  const Scene scene = make_scene(parse_scenario(head + "[loading]\nconfiguration = \"hydrostatic\"\nsteps = [{ " +
                                                    step + ", duration = 1 }]\n[particle]\nradius = 2\n",
                                                "test.toml"));
  const auto unknowns = scene.system->unknowns();
  return std::ranges::find(unknowns, Unknown::Kind::quadrature, &Unknown::kind)->scale;
}

TEST(Scene, CountsTolerancesByWhereConditionsEndItsRamps) {
  const std::string semimech =
      "model = \"semimech\"\nmaterial = { youngs_modulus = 50, poisson_ratio = 0.3, yield_stress = 1 }\n";
  // The contact yields, under 1.1 times the yield stress, at 0.0022 R.
  for (const char* condition : {"pressure = 1.1", "displacement = 0.0045", "contact_radius = 0.14", "force = 0.07"}) {
    const double ended = work_of(semimech, fmt::format("displacement = 0.8, until = {{ {} }}", condition));
    EXPECT_GT(ended, work_of(semimech, "displacement = 0.002")) << condition;
    EXPECT_LT(ended, work_of(semimech, "displacement = 0.01")) << condition;
    const double beyond = work_of(semimech, fmt::format("displacement = 0.003, until = {{ {} }}", condition));
    EXPECT_EQ(beyond, work_of(semimech, "displacement = 0.003")) << condition;
  }
  // What is never met ends nothing, nor does what is not asked of loading.
  for (const char* condition : {"pressure = 1e9", "force = 0"}) {
    EXPECT_EQ(work_of(semimech, fmt::format("displacement = 0.8, until = {{ {} }}", condition)),
              work_of(semimech, "displacement = 0.8"))
        << condition;
  }
  // Next to the limit work grows a millionfold over a factor 2 of the way.
  const std::string stiff =
      "model = \"semimech\"\nmaterial = { youngs_modulus = 2e5, poisson_ratio = 0.4999, yield_stress = 1 }\n";
  const double told = work_of(stiff, "displacement = 0.26");
  EXPECT_GT(work_of(stiff, "displacement = 1"), 1e5 * told);
  EXPECT_NEAR(work_of(stiff, "displacement = 1, until = { displacement = 0.26 }"), told, 1e-4 * told);
  const std::string hertz = "model = \"hertz\"\nmaterial = { youngs_modulus = 1, poisson_ratio = 0.3 }\n";
  EXPECT_EQ(work_of(hertz, "displacement = 0.8, until = { displacement = 0.01 }"),
            work_of(hertz, "displacement = 0.01"));
}

TEST(Scene, SaysWhatItSkips) {
  const Scene hydrostatic = make_scene(mdr_scenario(Configuration::hydrostatic, 20.0, 0.3, path({0.1})));
  EXPECT_TRUE(skips(hydrostatic, "5 of 6 walls, the same by symmetry: axial x6"));
  EXPECT_TRUE(skips(hydrostatic, "adhesion"));
  EXPECT_TRUE(skips(hydrostatic, "algebraic unknowns: displacements are prescribed"));
  EXPECT_FALSE(skips(make_scene(preset(Configuration::simple)), "adhesion")) << "hertz knows none";
  CheckedScenario free = preset(Configuration::die);
  free.loading.centre_is_free = true;
  EXPECT_TRUE(skips(make_scene(free), "by symmetry the wall forces balance"));
}

}  // namespace
}  // namespace monograin::scene_test
