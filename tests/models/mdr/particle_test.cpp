#include "mdr/particle.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace monograin::mdr::particle_test {
namespace {

/// Classes of one wall each, on opposite sides and across; E/Y = 50, R0 = 2 m.
std::shared_ptr<const Setup> setup() {
  const Settings settings{
      .initial_radius = 2.0, .youngs_modulus = 50.0, .poisson_ratio = 0.3, .yield_stress = 1.0, .centre_is_free = true};
  const auto wall = [](const char* name, const Eigen::Vector3d& normal) {
    return ContactClass{.name = name, .normals = {normal}, .gap = 0.0, .takes_force = true};
  };
  return std::make_shared<const Setup>(
      settings, std::vector{wall("top", {0, 0, 1}), wall("bottom", {0, 0, -1}), wall("side", {1, 0, 0})});
}

Particle driven(const std::vector<Ramp>& ramps) {
  Particle particle(setup());
  particle.set_drives(ramps);
  return particle;
}

TEST(MdrParticle, MeasuresDisplacementsInRadiiAndForcesInTheirUnit) {
  const Particle particle = driven({{0.0, 1.0}, {0.0, 3.0, Control::force}, {0.5, 0.25}});
  EXPECT_DOUBLE_EQ(particle.drive(0).end(), 0.5);
  EXPECT_DOUBLE_EQ(particle.drive(1).end(), 3.0 / particle.setup().force_unit());
  EXPECT_FALSE(particle.is_force_controlled(0));
  EXPECT_TRUE(particle.is_force_controlled(1));
}

TEST(MdrParticle, WallsStandExactlyAtBothEndsOfAStep) {
  const Particle particle = driven({{0.1, 0.7}, {0.0, 0.0}, {0.5, 0.25}});
  for (const std::size_t i : {0U, 1U, 2U}) {
    EXPECT_EQ(particle.prescribed_displacement(i, 0.0), particle.drive(i).start());
    EXPECT_EQ(particle.prescribed_displacement(i, 1.0), particle.drive(i).end());
    EXPECT_DOUBLE_EQ(particle.prescribed_displacement(i, 0.3), particle.drive(i).value(0.3));
  }
}

TEST(MdrParticle, TheFastestWallUnderDisplacementControlGivesTheSpeed) {
  EXPECT_DOUBLE_EQ(driven({{0.0, 0.4}, {0.0, -0.6}, {0.0, 9.0, Control::force}}).speed_scale(), 0.3);
  EXPECT_EQ(driven({{0.4, 0.4}, {0.2, 0.2}, {0.0, 9.0, Control::force}}).speed_scale(), 1.0);
}

}  // namespace
}  // namespace monograin::mdr::particle_test
