// The equilibrium of a free centre at a given radius.

#include "mdr/centre_search.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "models/mdr/particles.hpp"

namespace monograin::mdr::centre_search_test {
namespace {

const Eigen::Vector3d k_up{0.0, 0.0, 1.0};

/// Net force on the centre over the sum of the forces.
double imbalance(Particle& p, const std::vector<double>& y) {
  p.evaluate(0.0, y);
  return p.centre().force().norm() / p.magnitude_of_forces();
}

TEST(MdrCentreSearch, APressedParticleMovesHalfAsFarAsTheWall) {
  for (const double displacement : {1e-6, 1e-4, 4e-3}) {
    Particle p = particle_between({resting(k_up, displacement), resting(-k_up, 0.0)});
    std::vector<double> y = initial_state(p);
    move_centre(p, 0.0, y);
    EXPECT_LT(imbalance(p, y), 1e-12) << displacement;
    EXPECT_NEAR(p.contact(0).overlap, 0.5 * displacement, 1e-15);
    EXPECT_NEAR(p.contact(1).overlap, 0.5 * displacement, 1e-15);
  }
}

TEST(MdrCentreSearch, ThreeWallsShareTheirForcesByTheAnglesBetweenThem) {
  // Normals at 0 and +-120 degrees: the forces are equal. At 0 and +-150 degrees: F0 = 2 F1 cos(30 degrees).
  for (const double angle : {120.0, 150.0}) {
    const double radians = angle * M_PI / 180.0;
    Particle p = particle_between({resting(k_up, 2e-3), resting({std::sin(radians), 0.0, std::cos(radians)}, 1e-4),
                                   resting({-std::sin(radians), 0.0, std::cos(radians)}, 1e-4)});
    std::vector<double> y = initial_state(p);
    move_centre(p, 0.0, y);
    EXPECT_LT(imbalance(p, y), 1e-12);
    const auto force = [&](std::size_t i) { return p.contact(i).contact.force; };
    EXPECT_NEAR(force(0) / force(1), -2.0 * std::cos(radians), 1e-10) << angle;
    EXPECT_NEAR(force(1) / force(2), 1.0, 1e-12);
  }
}

TEST(MdrCentreSearch, ANewtonStepBringsTheCentreNearerToTheBalance) {
  Particle p = particle_between({resting(k_up, 2e-3), resting(-k_up, 1e-3)});
  std::vector<double> y = initial_state(p);
  const double before = imbalance(p, y);
  ASSERT_TRUE(approach_balance(p, 0.0, y));
  EXPECT_LT(imbalance(p, y), 0.2 * before);
}

TEST(MdrCentreSearch, ElasticContactsHoldTheCentreAtFullStiffness) {
  Particle p = particle_between({resting(k_up, 1e-3), resting(-k_up, 1e-3)});
  EXPECT_DOUBLE_EQ(centre_stiffness(p).value, 1.0);
  EXPECT_GT(centre_stiffness_guard(p), 0.0);
  EXPECT_FALSE(is_any_softened(p));
  EXPECT_NO_THROW(check_softening(p));
}

TEST(MdrCentreSearch, NothingPeelsWithoutAdhesion) {
  Particle p = particle_between({resting(k_up, 1e-3), resting(-k_up, 1e-3)});
  EXPECT_FALSE(may_peel_off(p));
  EXPECT_EQ(weakest_contact(p), std::nullopt);
}

}  // namespace
}  // namespace monograin::mdr::centre_search_test
