// A particle with a free centre, under every law that has one. Between a wall that moves and one at rest, its contacts
// go through the same as under two walls that move half as far against a fixed centre; and a motion that all walls
// share carries the particle along, and changes no contact.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "scenario/scenario.hpp"
#include "support/test_run.hpp"

namespace monograin {
namespace {

struct Particle {
  std::string name;
  std::string model;  ///< keys of the model and its material
  double depth;       ///< overlap to which the walls press
};
void PrintTo(const Particle& particle, std::ostream* out) { *out << particle.name; }

const std::vector<Particle> k_particles = {
    {"hertz", "model = \"hertz\"\nmaterial = { youngs_modulus = 100, poisson_ratio = 0.3 }\n", 0.01},
    {"mdr", "model = \"mdr\"\nmaterial = { youngs_modulus = 100, poisson_ratio = 0.3, yield_stress = 1 }\n", 0.05},
    {"cel", "model = \"cel\"\nmaterial = { youngs_modulus = 100, poisson_ratio = 0.3, yield_stress = 1 }\n", 0.05},
    {"similarity",
     "model = \"similarity\"\nsimilarity = { unloading = \"mdr\" }\n"
     "material = { youngs_modulus = 100, poisson_ratio = 0.3, strength = 1, hardening_exponent = 0.5 }\n",
     0.025},
    {"nonlocal", "model = \"nonlocal\"\nmaterial = { youngs_modulus = 100, poisson_ratio = 0.3 }\n", 0.01},
    {"compressible",
     "model = \"compressible\"\n"
     "material = { nu0 = 0.3, shear_ratio = 0.5, stiffness_ratio = 10, yield_pressure = 1 }\n",
     0.05},
};

std::vector<Particle> particles_of(const std::vector<std::string>& names) {
  std::vector<Particle> chosen;
  std::ranges::copy_if(k_particles, std::back_inserter(chosen), [&](const Particle& particle) {
    return std::ranges::find(names, particle.name) != names.end();
  });
  return chosen;
}

/// A step of both walls: a share of the depth, or of the force there.
struct Share {
  Step::Kind kind;
  double value;
};
constexpr auto k_displacement = Step::Kind::displacement;
constexpr auto k_force = Step::Kind::force;
const std::vector<std::vector<Share>> k_programs = {
    {{k_displacement, 1.0}, {k_force, 0.0}},
    {{k_displacement, 1.0}, {k_force, 0.5}, {k_displacement, 1.2}},
    {{k_displacement, 1.0}, {k_force, 0.0}, {k_displacement, 1.1}, {k_force, 0.0}},
    {{k_force, 1.0}, {k_force, 0.0}},
    {{k_force, 1.0}, {k_force, 0.2}, {k_force, 1.3}},
};

std::vector<Step> steps(const std::vector<Share>& program, double depth, double force) {
  std::vector<Step> all;
  for (const Share& share : program) {
    all.push_back(share.kind == k_force ? force_ramp(share.value * force) : ramp(share.value * depth));
  }
  return all;
}

const char* const k_forms[] = {"auto", "cvode-adams", "cvode-bdf", "ida", "odeint-dopri5"};

class FreeCentre : public testing::TestWithParam<Particle> {
 protected:
  [[nodiscard]] static TestRun run_in(std::vector<WallSpec> walls, const std::string& centre,
                                      const std::string& integrator) {
    const std::string text =
        GetParam().model + "particle = { radius = 1 }\nloading = { configuration = \"walls\", centre = \"" + centre +
        "\", steps = [{ displacement = 1, duration = 1 }], " + "wall = [{ name = \"a\", normal = [0, 0, 1] }] }\n";
    CheckedScenario scenario = parse_scenario(text, "cell.toml");
    scenario.loading.walls = std::move(walls);
    return run(scenario, integrator, {.rtol = 1e-9, .atol = 1e-13}, false);
  }
  [[nodiscard]] static TestRun run_between(const std::vector<Step>& one, const std::vector<Step>& other,
                                           const std::string& centre, const std::string& integrator) {
    return run_in({wall("a", {0.6, 0.0, 0.8}, one), wall("b", {-0.6, 0.0, -0.8}, other)}, centre, integrator);
  }
  [[nodiscard]] static TestRun run_pair(const std::vector<Step>& of_each) {
    return run_between(of_each, of_each, "fixed", "auto");
  }
  /// Runs one program for each wall of a cell while all walls share a motion.
  /// @param motion  where it has led at the end of each step
  [[nodiscard]] static TestRun run_moving(const std::vector<Eigen::Vector3d>& normals,
                                          const std::vector<std::vector<Share>>& programs,
                                          const std::vector<Eigen::Vector3d>& motion, double force) {
    std::vector<WallSpec> walls;
    for (std::size_t i = 0; i < normals.size(); ++i) {
      std::vector<Step> moved = steps(programs[i], GetParam().depth, force);
      for (std::size_t k = 0; k < moved.size(); ++k) {
        if (moved[k].kind == k_displacement) moved[k].target += normals[i].dot(motion[k]);
      }
      walls.push_back(wall(std::string(1, static_cast<char>('a' + i)), normals[i], moved));
    }
    return run_in(walls, "equilibrium", "auto");
  }
};

TEST_P(FreeCentre, FollowsThePairOfWallsThatMoveByHalf) {
  const double depth = GetParam().depth;
  const double force = run_pair({ramp(depth)}).last("a.force");
  for (const auto& program : k_programs) {
    const TestRun pair = run_pair(steps(program, depth, force));
    ASSERT_EQ(pair.record.status, RunStatus::complete) << pair.record.message;
    for (const std::string integrator : k_forms) {
      const std::vector<Step> rest(program.size(), hold());
      const TestRun free = run_between(steps(program, 2.0 * depth, force), rest, "equilibrium", integrator);
      ASSERT_EQ(free.record.status, RunStatus::complete) << integrator << ": " << free.record.message;
      const bool is_direct = integrator == "auto" && free.scene.system->is_solvable();
      EXPECT_LE(difference(free, pair), is_direct ? 1e-9 : 1e-6) << integrator;
    }
  }
}

TEST_P(FreeCentre, OpensBothContactsAsSoonAsAWallLeaves) {
  const double depth = GetParam().depth;
  const TestRun run = run_between({ramp(2.0 * depth), ramp(-depth)}, {hold(), hold()}, "equilibrium", "auto");
  ASSERT_EQ(run.record.status, RunStatus::complete) << run.record.message;
  const std::vector<std::string> events = run.events();
  EXPECT_EQ(std::ranges::count(events, "a:contact-lost"), 1);
  EXPECT_EQ(std::ranges::count(events, "b:contact-lost"), 1);
  for (const std::string wall : {"a", "b"}) {
    EXPECT_EQ(run.last(wall + ".force"), 0.0) << wall;
    if (GetParam().name != "compressible") {  // which has no contact radius
      EXPECT_EQ(run.last(wall + ".contact_radius"), 0.0) << wall;
    }
  }
}

const double k_root = std::sqrt(2.0) / 3.0;
const std::vector<Eigen::Vector3d> k_tetrahedron = {{0.0, 0.0, 1.0},
                                                    {2.0 * k_root, 0.0, -1.0 / 3.0},
                                                    {-k_root, std::sqrt(3.0) * k_root, -1.0 / 3.0},
                                                    {-k_root, -std::sqrt(3.0) * k_root, -1.0 / 3.0}};

TEST_P(FreeCentre, IsCarriedAlongByAMotionOfAllWalls) {
  const double depth = GetParam().depth;
  const double force = run_pair({ramp(depth)}).last("a.force");
  // In the cross, a wall without load lets the particle lie loose between two walls until it presses, too.
  const std::vector<Eigen::Vector3d> cross = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  const std::vector<std::vector<Share>> in_cross = {{{k_displacement, 0.9}, {k_displacement, 0.8}},
                                                    {{k_displacement, 0.8}, {k_displacement, 0.8}},
                                                    {{k_force, 0.0}, {k_displacement, 1.0}},
                                                    {{k_displacement, 0.0}, {k_displacement, 0.0}}};
  const std::vector<std::vector<Share>> in_tetrahedron = {{{k_displacement, 0.3}, {k_force, 0.5}},
                                                          {{k_displacement, 0.8}, {k_displacement, 0.8}},
                                                          {{k_displacement, 0.0}, {k_displacement, 0.0}},
                                                          {{k_displacement, 0.0}, {k_displacement, 0.0}}};
  const std::vector<Eigen::Vector3d> rest(2, Eigen::Vector3d::Zero());
  const std::vector<Eigen::Vector3d> motion = {{-0.4 * depth, -1.9 * depth, 0.3 * depth},
                                               {0.2 * depth, 1.5 * depth, 0.8 * depth}};
  for (const auto& [normals, programs] : {std::pair{cross, in_cross}, std::pair{k_tetrahedron, in_tetrahedron}}) {
    const TestRun still = run_moving(normals, programs, rest, force);
    const TestRun moved = run_moving(normals, programs, motion, force);
    ASSERT_EQ(still.record.status, RunStatus::complete) << still.record.message;
    ASSERT_EQ(moved.record.status, RunStatus::complete) << moved.record.message;
    for (const char* const name : {"a.force", "b.force", "c.force", "d.force"}) {
      EXPECT_GT(still.last(name), 0.01 * force) << name;
      EXPECT_NEAR(moved.last(name), still.last(name), 1e-6 * force) << name << " of " << normals.size();
    }
  }
}

TEST_P(FreeCentre, StaysInTheMiddleOfAlikeWallsWhateverTheirDirection) {
  const double depth = GetParam().depth;
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(0.9, Eigen::Vector3d(2, -1, 3).normalized()).toRotationMatrix();
  const auto cell = [&](const Eigen::Matrix3d& turn, const std::string& centre) {
    std::vector<WallSpec> walls;
    for (int k = 0; k < 6; ++k) {
      const Eigen::Vector3d normal = (k < 3 ? 1.0 : -1.0) * turn.col(k % 3);
      walls.push_back(wall(std::string(1, static_cast<char>('a' + k)), normal, path({depth, 0.9 * depth})));
    }
    return run_in(walls, centre, "auto");
  };
  const TestRun turned = cell(rotation, "equilibrium");
  ASSERT_EQ(turned.record.status, RunStatus::complete) << turned.record.message;
  EXPECT_NEAR(turned.last("a.force"), cell(Eigen::Matrix3d::Identity(), "fixed").last("a.force"),
              1e-9 * turned.last("a.force"));
}

TEST_P(FreeCentre, IsDrivenAwayByAForceThatNothingBears) {
  const double depth = GetParam().depth;
  const double force = run_pair({ramp(depth)}).last("a.force");
  const auto across = [&](const std::string& name, double direction, double share) {
    return wall(name, {direction, 0, 0}, {ramp(0.4 * depth), force_ramp(share * force)});
  };
  const TestRun driven = run_in({wall("a", {0, 0, 1}, path({depth, 1.2 * depth})), wall("b", {0, 0, -1}),
                                 across("c", -1.0, 0.2), across("d", 1.0, 0.1)},
                                "equilibrium", "auto");
  EXPECT_EQ(driven.record.status, RunStatus::stopped);
  EXPECT_EQ(driven.record.limit, Limit::centre_driven_away) << driven.record.message;
}

TEST_P(FreeCentre, IsCarriedByAForceAcrossAGapToTheWallInThePath) {
  const double depth = GetParam().depth;
  const double gap = 0.4 * depth;
  const double force = run_pair({ramp(depth)}).last("a.force");
  const std::vector<Step> program = {force_ramp(0.7 * force), force_ramp(0.3 * force)};
  const auto behind_a_gap = [&](double size, const std::string& integrator) {
    return run_in({wall("a", {0.6, 0.0, 0.8}, program), wall("b", {-0.6, 0.0, -0.8}, {}, size)}, "equilibrium",
                  integrator);
  };
  const TestRun touching = behind_a_gap(0.0, "auto");
  for (const char* const integrator : k_forms) {
    const TestRun apart = behind_a_gap(gap, integrator);
    ASSERT_EQ(apart.record.status, RunStatus::complete) << integrator << ": " << apart.record.message;
    // The weak spring that holds a centre under cel bears a little of the force before the contact does.
    EXPECT_NEAR(apart.time_of("contact-made"), 0.0, GetParam().name == "cel" ? 1e-8 : 0.0) << integrator;
    EXPECT_NEAR(apart.last("a.displacement"), touching.last("a.displacement") + gap, 1e-6 * depth) << integrator;
    EXPECT_NEAR(apart.last("centre_z"), touching.last("centre_z") - 0.8 * gap, 1e-6 * depth) << integrator;
    for (const char* const name : {"a.force", "b.force"})
      EXPECT_NEAR(apart.last(name), 0.3 * force, 1e-6 * force) << integrator << ", " << name;
    for (const char* const name : {"work", "stored_energy", "apparent_radius"}) {
      if (!touching.record.history.find(name)) continue;
      EXPECT_NEAR(apart.last(name), touching.last(name), 1e-6 * std::abs(touching.last(name))) << integrator << name;
    }
  }
}

TEST_P(FreeCentre, SlidesUnderAForceAlongAWallToTheNextOne) {
  // Of two oblique walls the nearer one is met first. Both overlaps are the same in the end.
  const double depth = GetParam().depth;
  const double force = run_pair({ramp(depth)}).last("a.force");
  const double half = std::sqrt(0.5);
  for (const char* const integrator : k_forms) {
    const TestRun run =
        run_in({wall("a", {0, 0, 1}, {force_ramp(0.5 * force)}), wall("b", {half, 0, -half}, {}, 0.2 * depth),
                wall("c", {-half, 0, -half}, {}, 0.6 * depth)},
               "equilibrium", integrator);
    ASSERT_EQ(run.record.status, RunStatus::complete) << integrator << ": " << run.record.message;
    for (const char* const name : {"b.force", "c.force"})
      EXPECT_NEAR(run.last(name), 0.5 * half * force, 1e-6 * force) << integrator << ", " << name;
    // Overlaps less gaps: half (x - z) - 0.2 depth, half (-x - z) - 0.6 depth.
    EXPECT_NEAR(run.last("centre_x"), -0.4 * half * depth, 1e-6 * depth) << integrator;
  }
}

TEST_P(FreeCentre, StopsUnderAForceWhereNoWallIsInThePath) {
  const double force = run_pair({ramp(GetParam().depth)}).last("a.force");
  const TestRun driven =
      run_in({wall("a", {0, 0, 1}, {force_ramp(0.5 * force)}), wall("b", {0.1, 0, 1}, {}, 0.1)}, "equilibrium", "auto");
  EXPECT_EQ(driven.record.status, RunStatus::stopped);
  EXPECT_EQ(driven.record.limit, Limit::centre_driven_away) << driven.record.message;
}

INSTANTIATE_TEST_SUITE_P(OfEveryLaw, FreeCentre, testing::ValuesIn(k_particles),
                         [](const auto& tested) { return tested.param.name; });

class FreeCentreOfIndependentContacts : public FreeCentre {};

TEST_P(FreeCentreOfIndependentContacts, DoesTheSameWorkByEveryFormAfterAWallHasLetGo) {
  // Wall c, beside a, presses less and less; its force goes on falling where it has let go.
  const double depth = GetParam().depth;
  const double force = run_pair({ramp(depth)}).last("a.force");
  const std::vector<WallSpec> walls = {
      wall("a", {1, 0, 0}, path({depth, 0.8 * depth})), wall("b", {-1, 0, 0}, path({depth, 0.9 * depth})),
      wall("c", {0.8, 0.6, 0}, {force_ramp(0.1 * force), force_ramp(-0.2 * force)}), wall("d", {0, -1, 0})};
  const TestRun direct = run_in(walls, "equilibrium", "direct");
  ASSERT_EQ(direct.record.status, RunStatus::complete) << direct.record.message;
  ASSERT_EQ(direct.last("c.force"), 0.0);
  for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
    const TestRun now = run_in(walls, "equilibrium", integrator);
    ASSERT_EQ(now.record.status, RunStatus::complete) << integrator << ": " << now.record.message;
    EXPECT_LE(difference(now.outputs("work"), direct.outputs("work")), 1e-6) << integrator;
  }
}

TEST_P(FreeCentreOfIndependentContacts, DoesNoWorkWhereAForceClosesAGapInNoTime) {
  // The force takes the particle from wall c to b and back onto c, before it has grown to anything.
  const double depth = GetParam().depth;
  const double force = run_pair({ramp(depth)}).last("a.force");
  const std::vector<WallSpec> walls = {wall("a", {0, 0, 1}, {force_ramp(0.5 * force)}),
                                       wall("b", {-1, 0, -1}, {}, 0.4 * depth),
                                       wall("c", {1, 0, 0}, path({0.8 * depth}))};
  const TestRun direct = run_in(walls, "equilibrium", "direct");
  const TestRun integrated = run_in(walls, "equilibrium", "cvode-adams");
  ASSERT_EQ(direct.record.status, RunStatus::complete) << direct.record.message;
  ASSERT_EQ(integrated.record.status, RunStatus::complete) << integrated.record.message;
  EXPECT_NEAR(direct.last("work"), integrated.last("work"), 1e-6 * direct.last("work"));
}

TEST_P(FreeCentreOfIndependentContacts, MeetsAllWallsOntoWhichAForceTakesItInNoTime) {
  // Four walls that leave gaps; they close the cell by displacements in any order, and by one force.
  const double depth = GetParam().depth;
  const double force = run_pair({ramp(depth)}).last("a.force");
  const double gap = 0.2 * depth;
  for (const double first : {1.0, 0.64, 1.4087, 0.9}) {
    const std::vector<WallSpec> walls = {wall("a", k_tetrahedron[0], path({1.41 * depth * first}), gap),
                                         wall("b", k_tetrahedron[1], path({0.926 * depth}), gap),
                                         wall("c", k_tetrahedron[2], {force_ramp(0.3 * force)}, gap),
                                         wall("d", k_tetrahedron[3], {}, gap)};
    for (const char* const integrator : {"direct", "cvode-bdf", "odeint-dopri5"}) {
      const TestRun pressed = run_in(walls, "equilibrium", integrator);
      ASSERT_EQ(pressed.record.status, RunStatus::complete) << integrator << ": " << pressed.record.message;
      for (const char* const name : {"a.force", "b.force", "c.force", "d.force"})
        EXPECT_NEAR(pressed.last(name), 0.3 * force, 1e-6 * force) << name << ", " << integrator << ", " << first;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfEveryLaw, FreeCentreOfIndependentContacts,
                         testing::ValuesIn(particles_of({"hertz", "similarity", "compressible"})),
                         [](const auto& tested) { return tested.param.name; });

class LooseParticle : public FreeCentre {};

TEST_P(LooseParticle, IsPressedOntoAllWallsInTheWayOfAForce) {
  // Three walls leave different gaps; the force takes the particle across these, and they bear it in equal parts.
  const double force = run_pair({ramp(GetParam().depth)}).last("a.force");
  std::vector<WallSpec> walls = {wall("a", k_tetrahedron[0], {force_ramp(0.5 * force)})};
  for (std::size_t i = 1; i < 4; ++i) {
    const double gap = 0.3 * GetParam().depth * static_cast<double>(i);
    walls.push_back(wall(std::string(1, static_cast<char>('a' + i)), k_tetrahedron[i], {}, gap));
  }
  const TestRun pressed = run_in(walls, "equilibrium", "auto");
  ASSERT_EQ(pressed.record.status, RunStatus::complete) << pressed.record.message;
  for (const char* const name : {"b.force", "c.force", "d.force"})
    EXPECT_NEAR(pressed.last(name), 0.5 * force, 1e-7 * force) << name;
}

TEST_P(LooseParticle, IsPressedIntoADentThatItHasLeft) {
  // Wall b retreats, so that the particle stays with a, whose force then takes it back to b, which comes in again.
  const double depth = GetParam().depth;
  const double force = run_pair({ramp(depth)}).last("a.force");
  const std::vector<Step> of_a = {force_ramp(force), ramp(2.36 * depth), force_ramp(0.25 * force)};
  const TestRun pressed = run_between(of_a, path({1.9 * depth, -1.56 * depth, 0.53 * depth}), "equilibrium", "auto");
  ASSERT_EQ(pressed.record.status, RunStatus::complete) << pressed.record.message;
  EXPECT_NEAR(pressed.last("b.force"), 0.25 * force, 1e-7 * force);
}

INSTANTIATE_TEST_SUITE_P(OfLawsThatLetItMove, LooseParticle,
                         testing::ValuesIn(particles_of({"hertz", "cel", "similarity", "compressible"})),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace monograin
