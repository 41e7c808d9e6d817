#include "history/wall_checks.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "history/run.hpp"
#include "support/refusal.hpp"

namespace monograin::wall_checks_test {
namespace {

/// Round-off of 50 m3: faces are cut out of squares a few thousand times as wide.
constexpr double k_cut_error = 1e-10;

std::vector<WallPlane> box(double x, double y, double z) {
  return {{{1, 0, 0}, x}, {{-1, 0, 0}, x}, {{0, 1, 0}, y}, {{0, -1, 0}, y}, {{0, 0, 1}, z}, {{0, 0, -1}, z}};
}

std::vector<WallPlane> turned(std::vector<WallPlane> walls) {
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (WallPlane& wall : walls) wall.normal = rotation * wall.normal;
  return walls;
}

TEST(SpaceBetweenWalls, IsThatOfABoxInAnyPosition) {
  EXPECT_NEAR(space_between(box(1, 2, 3)), 48.0, k_cut_error);
  EXPECT_NEAR(space_between(turned(box(1, 2, 3))), 48.0, k_cut_error);
  auto aside = box(1e-3, 2e-3, 3e-3);
  aside[0].distance = 4e-3;
  aside[1].distance = -2e-3;
  EXPECT_NEAR(space_between(turned(aside)), 48e-9, 1e-9 * k_cut_error) << "the origin is outside";
}

TEST(SpaceBetweenWalls, IsThatOfATetrahedron) {
  const double s = 1.0 / std::sqrt(3.0);
  const std::vector<WallPlane> walls{{{s, s, s}, 1}, {{s, -s, -s}, 1}, {{-s, s, -s}, 1}, {{-s, -s, s}, 1}};
  EXPECT_NEAR(space_between(walls), 8.0 * std::sqrt(3.0), k_cut_error) << "around a ball of radius 1";
}

TEST(SpaceBetweenWalls, CountsWallsThatCoincideOrAreHiddenOnce) {
  auto walls = box(1, 2, 3);
  walls.push_back(walls[2]);
  walls.push_back({{0, 0, 1}, 5});
  walls.push_back({Eigen::Vector3d(1, 1, 0).normalized(), 10});
  EXPECT_NEAR(space_between(walls), 48.0, k_cut_error);
  walls.insert(walls.begin(), {{0, 0, 1}, 7});
  EXPECT_NEAR(space_between(walls), 48.0, k_cut_error) << "whichever of them comes first";
}

TEST(SpaceBetweenWalls, IsInfiniteWhereItIsOpenAndZeroWhereWallsHavePassed) {
  auto walls = box(1, 2, 3);
  walls.pop_back();
  EXPECT_TRUE(std::isinf(space_between(walls)));
  EXPECT_TRUE(std::isinf(space_between(std::vector<WallPlane>{{{0, 0, 1}, 1}, {{0, 0, -1}, 1}})));
  auto passed = box(1, 2, 3);
  passed[0].distance = -1.5;
  EXPECT_EQ(space_between(passed), 0.0);
}

monograin::Run run_of(std::string_view model, std::string_view material, std::string_view loading) {
  return run_scenario(parse_scenario(fmt::format("model = \"{}\"\nparticle.radius = 0.01\nmaterial = {{{}}}\n"
                                                 "output.points = 20\n[loading]\n{}\n",
                                                 model, material, loading),
                                     "walls.toml"));
}

constexpr std::string_view k_metal = "youngs_modulus = 1e9, poisson_ratio = 0.3, yield_stress = 2e7";

/// The warning of a run that contains some words; empty if there is none.
std::string warning_with(const monograin::Run& run, std::string_view words) {
  for (const std::string& warning : run.record.warnings) {
    if (contains(warning, words)) return warning;
  }
  return {};
}

monograin::Run compaction(std::string_view configuration, double displacement) {
  return run_of("cel", k_metal,
                fmt::format("configuration = \"{}\"\nsteps = [{{ displacement = {}, duration = 1 }}]", configuration,
                            displacement));
}

TEST(SpaceWarning, ComesWhereTheCellIsSmallerThanTheParticle) {
  // A cube of side 2 (R0 - d), and one that only its height changes.
  const double radius = 0.01;
  const double cube = radius * (1.0 - std::cbrt(std::numbers::pi / 6.0));
  const double die = radius * (1.0 - std::numbers::pi / 6.0);
  EXPECT_EQ(warning_with(compaction("hydrostatic", 0.999 * cube), "space"), "");
  EXPECT_NE(warning_with(compaction("hydrostatic", 1.001 * cube), "space"), "");
  EXPECT_EQ(warning_with(compaction("die", 0.999 * die), "space"), "");
  EXPECT_NE(warning_with(compaction("die", 1.001 * die), "space"), "");
  EXPECT_EQ(warning_with(compaction("simple", 0.9 * radius), "space"), "") << "the particle can give way";
}

TEST(SpaceWarning, IsNotForWallsThatEncloseNothing) {
  for (const std::string_view model : {"semimech", "hardening"}) {
    const auto run = run_of(model, model == "semimech" ? k_metal : "strength = 2e7, hardening_exponent = 0.2",
                            "configuration = \"simple\"\nsteps = [{ displacement = 0.012, duration = 1 }]");
    EXPECT_EQ(run.record.status, RunStatus::stopped) << "the walls meet";
    ASSERT_GT(run.record.history.row_count(), 10U);
    EXPECT_EQ(warning_with(run, "space"), "") << model;
  }
}

TEST(SpaceWarning, TellsTheSmallestSpaceAndWhen) {
  const auto run = run_of("cel", k_metal,
                          "configuration = \"hydrostatic\"\nsteps = [{ displacement = 0.002, duration = 1 }, "
                          "{ displacement = 0.0022, duration = 1 }, { displacement = 0.0019, duration = 1 }]");
  const double share = std::pow(2.0 * 0.78, 3) / (4.0 / 3.0 * std::numbers::pi);
  EXPECT_TRUE(warning_with(run, fmt::format("space/volume = {:.3g} at t = 2 s", share)) != "")
      << warning_with(run, "space");
}

TEST(SpaceWarning, IsNotForParticlesWithPores) {
  const auto run = run_of("compressible", "yield_pressure = 1e6, nu0 = 0.2, shear_ratio = 0.65, stiffness_ratio = 60",
                          "configuration = \"die\"\nsteps = [{ displacement = 0.0049, duration = 1 }]");
  ASSERT_GT(run.record.history.row_count(), 10U);
  EXPECT_EQ(warning_with(run, "space"), "");
}

constexpr std::string_view k_press = R"(configuration = "walls"
centre = "{}"
[[loading.wall]]
name = "punch"
normal = [0, 0, 1]
steps = [{{ displacement = 0.002, duration = 1 }}]
)";
constexpr std::string_view k_anvil = R"([[loading.wall]]
name = "anvil"
normal = [0, 0, -1]
fixed = true
)";

TEST(EscapeWarning, ComesWhereWallsSqueezeAParticleOut) {
  const auto warnings_of = [](double tilt) {
    const std::string text = fmt::format(
        "model = \"hertz\"\nparticle.radius = \"1 mm\"\nmaterial = {{ youngs_modulus = \"1 GPa\", poisson_ratio = 0.3 "
        "}}\n[loading]\nconfiguration = \"walls\"\ncentre = \"equilibrium\"\n[[loading.wall]]\nname = "
        "\"top\"\nnormal = [0, 0, 1]\nsteps = [{{ displacement = \"0.1 R0\", duration = 1 }}]\n[[loading.wall]]\nname "
        "= \"bottom\"\nnormal = [0, {}, -1]\nsteps = [{{ displacement = \"0.1 R0\", duration = 1 }}]\n",
        tilt);
    std::string all;
    for (const std::string& warning : run_scenario(parse_scenario(text, "w.toml")).record.warnings) all += warning;
    return all;
  };
  // Frictionless walls push the particle sideways until it is free: 0.2 R0 over the tilt.
  EXPECT_TRUE(contains(warnings_of(0.0175), "its centre moves by 11.4 R0, no wall by more than 0.1 R0"));
  EXPECT_FALSE(contains(warnings_of(0.0), "its centre moves"));
  EXPECT_FALSE(contains(warnings_of(1.0), "its centre moves"));
  // The limit is R0 and three times the path of the walls, together 1.3 R0.
  EXPECT_TRUE(contains(warnings_of(0.2 / 1.32), "its centre moves"));
  EXPECT_FALSE(contains(warnings_of(0.2 / 1.28), "its centre moves"));
}

TEST(BalanceWarning, ComesWhereAFixedCentreIsPushedTowardsAWall) {
  const std::string fixed = fmt::format(k_press, "fixed");
  const std::string free = fmt::format(k_press, "equilibrium");
  EXPECT_NE(warning_with(run_of("mdr", k_metal, fixed + std::string(k_anvil)), "do not balance"), "");
  EXPECT_EQ(warning_with(run_of("mdr", k_metal, free + std::string(k_anvil)), "do not balance"), "");
}

// Hertz's force goes like d^(3/2): displacements that differ by a share e leave 3/2 e of the force unbalanced.
TEST(BalanceWarning, ComesFromOnePercentOfTheLargestForceOn) {
  const auto warning_of = [](double difference) {
    const std::string counterpart = fmt::format(
        "[[loading.wall]]\nname = \"counterpart\"\nnormal = [0, 0, -1]\nsteps = [{{ displacement = {}, duration = 1 "
        "}}]\n",
        0.002 * (1.0 - difference));
    return warning_with(
        run_of("hertz", "youngs_modulus = 1e9, poisson_ratio = 0.3", fmt::format(k_press, "fixed") + counterpart),
        "do not balance");
  };
  EXPECT_EQ(warning_of(0.006), "");
  EXPECT_TRUE(contains(warning_of(0.008), "0.012 of the largest force")) << warning_of(0.008);
}

TEST(BalanceWarning, IsNotForASingleWallNorForWallsThatBalance) {
  EXPECT_EQ(warning_with(run_of("mdr", k_metal, fmt::format(k_press, "fixed")), "do not balance"), "");
  const std::string counterpart = R"([[loading.wall]]
name = "counterpart"
normal = [0, 0, -1]
steps = [{ displacement = 0.002, duration = 1 }]
)";
  EXPECT_EQ(warning_with(run_of("mdr", k_metal, fmt::format(k_press, "fixed") + counterpart), "do not balance"), "");
  EXPECT_EQ(warning_with(compaction("die", 0.004), "do not balance"), "");
}

}  // namespace
}  // namespace monograin::wall_checks_test
