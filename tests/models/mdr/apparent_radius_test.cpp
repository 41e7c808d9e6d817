/// The volume balance of an MDR particle, the rules of its growth, and the impingement of contact caps.

#include "mdr/apparent_radius.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "models/accuracy.hpp"
#include "models/mdr/grains.hpp"

namespace monograin::mdr::apparent_radius_test {
namespace {

using Normals = std::vector<Eigen::Vector3d>;

const Normals k_opposite{{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}};

/// Volume balance of n walls that press elastically.
VolumeBalance balance(double n, double displacement, double r, double linear_compressibility, double rate = 1.0) {
  const double overlap = displacement + r;
  const Contact contact = elastic_contact(ElasticProfile::ellipse, 1.0, 1.0 + r, overlap);
  const double virial = n * contact.force * (1.0 - displacement);
  VolumeSum sum(linear_compressibility, virial, virial);
  static_cast<void>(sum.add({n, contact, displacement, overlap, rate, 0.0}, 1.0 + r));
  return sum.finish(r);
}

TEST(MdrVolumeBalance, OfAParticleWithoutContactsIsThatOfASphere) {
  for (const double r : {0.0, 1e-9, 0.01, 0.3}) {
    const VolumeBalance at = VolumeSum(0.5, 0.0, 0.0).finish(r);
    EXPECT_NEAR(at.value, (std::pow(1.0 + r, 3) - 1.0) / 3.0, 4 * k_epsilon) << r;
    EXPECT_DOUBLE_EQ(at.by_radius, (1.0 + r) * (1.0 + r)) << r;
    EXPECT_DOUBLE_EQ(at.free_surface_at_rest(r), 1.0) << r;
    EXPECT_EQ(at.by_time, 0.0);
  }
}

TEST(MdrVolumeBalance, HasTheDerivativesOfItsValue) {
  for (const double compliance : {0.0, 0.4}) {
    for (const double displacement : {0.01, 0.2}) {
      for (const double r : {0.0, 0.03}) {
        SCOPED_TRACE(::testing::Message() << compliance << ", " << displacement << ", " << r);
        const VolumeBalance at = balance(2.0, displacement, r, compliance);
        const auto by_wall = [&](double d) { return balance(2.0, d, r, compliance).value; };
        // Walls stand still while the radius grows.
        const auto by_radius = [&](double x) { return balance(2.0, displacement, x, compliance).value; };
        EXPECT_NEAR(at.by_time, central_difference(by_wall, displacement, 1e-3 * displacement), 1e-10);
        EXPECT_NEAR(at.by_radius, central_difference(by_radius, r, 1e-5), 1e-9);
        EXPECT_EQ(at.by_radius, at.by_radius_at_rest);
      }
    }
  }
}

TEST(MdrVolumeBalance, OfAnIncompressibleParticleTurnsCapsIntoGrowth) {
  // n caps of overlap d have the volume n pi d^2 (3 R - d)/3; the sphere gains 4 pi r.
  for (const double n : {2.0, 6.0}) {
    const double displacement = 1e-4;
    const double growth = 0.25 * n * displacement * displacement;
    const VolumeBalance at = balance(n, displacement, growth, 0.0);
    EXPECT_LE(std::abs(at.value), 1e-3 * growth) << n;
    EXPECT_NEAR(at.free_surface_at_rest(growth), 1.0 - 0.5 * n * displacement, 1e-7) << n;
  }
}

TEST(MdrVolumeBalance, CompressesTheParticleByTheRootOfAQuadraticEquation) {
  for (const double w : {0.0, 1e-12, 0.1, 0.25}) {
    VolumeBalance at;
    at.compression_of_all = w;
    const double v = at.volume_ratio();
    EXPECT_NEAR(v * v - v + w, 0.0, 2 * k_epsilon) << w;
    EXPECT_GE(v, 0.5);
  }
}

TEST(MdrVolumeBalance, IsUndefinedBelowHalfTheVolume) {
  const double half = 0.25 / (0.75 * std::numbers::inv_pi);
  EXPECT_GT(VolumeSum(1.0, half, 0.999 * half).finish(0.0).discriminant, 0.0);
  EXPECT_LE(VolumeSum(1.0, half, 1.001 * half).finish(0.0).discriminant, 0.0);
}

TEST(MdrRadiusRule, SaysWhichContactsTakePart) {
  for (const Regime regime :
       {Regime::open, Regime::elastic, Regime::fully_plastic, Regime::unloading, Regime::separated}) {
    EXPECT_EQ(takes_part(RadiusRule::gated, regime), touches(regime));
    EXPECT_EQ(takes_part(RadiusRule::seed, regime), touches(regime));
    EXPECT_EQ(takes_part(RadiusRule::yielded, regime), regime == Regime::fully_plastic);
  }
}

TEST(MdrRadiusRule, OpensTheGateForContactsThatAreDrivenInAtTheirLargestOverlap) {
  for (const RadiusRule rule : {RadiusRule::gated, RadiusRule::yielded}) {
    EXPECT_TRUE(opens_gate(rule, {.inward_rate = 1.0, .is_on_primary_branch = true}));
    EXPECT_FALSE(opens_gate(rule, {.inward_rate = -1.0, .is_on_primary_branch = true}));
    EXPECT_FALSE(opens_gate(rule, {.inward_rate = 1.0, .is_on_primary_branch = false}));
    EXPECT_FALSE(opens_gate(rule, {.inward_rate = 1e-14, .least_rate = 1e-13, .is_on_primary_branch = true}));
    EXPECT_TRUE(opens_gate(rule, {.is_force_controlled = true, .rises = true, .is_on_primary_branch = true}));
    EXPECT_FALSE(opens_gate(rule, {.is_force_controlled = true, .rises = false, .is_on_primary_branch = true}));
  }
}

TEST(MdrRadiusRule, ToTheLetterOfTheSourceLeavesTheGateOpenWhereverAWallMoves) {
  EXPECT_TRUE(opens_gate(RadiusRule::seed, {.inward_rate = -1.0}));
  EXPECT_TRUE(opens_gate(RadiusRule::seed, {.is_force_controlled = true}));
  EXPECT_FALSE(opens_gate(RadiusRule::seed, {.inward_rate = 0.0}));
}

TEST(MdrGrowthDrive, IsTheDemandOverItsMagnitudes) {
  EXPECT_EQ(growth_drive(0.5, 2.0, false, true), 0.25);
  EXPECT_EQ(growth_drive(-3.0, 0.0, false, true), -1.0);
  EXPECT_EQ(growth_drive(3.0, 0.0, false, true), 1.0);
}

TEST(MdrGrowthDrive, AtFirstTouchIsThatOfWhatVanishesLast) {
  // The elastic volume, which only a compressible particle has, outlasts the caps: lost on approach, regained on
  // retreat.
  EXPECT_EQ(growth_drive(0.0, 0.0, false, true), -1.0);
  EXPECT_EQ(growth_drive(0.0, 0.0, true, true), 1.0);
  EXPECT_EQ(growth_drive(0.0, 0.0, false, false), 1.0);
  EXPECT_EQ(growth_drive(0.0, 0.0, true, false), -1.0);
}

TEST(MdrCaps, OfOppositeWallsNeverMeet) {
  const ContactClass opposite{.name = "walls", .normals = k_opposite};
  EXPECT_TRUE(cap_pairs_of(std::vector{opposite}).empty());
}

TEST(MdrCaps, MeetWhereTheirAnglesAddUpToThatBetweenTheNormals) {
  const ContactClass x{.name = "x", .normals = k_opposite};
  const ContactClass y{.name = "y", .normals = {{0.0, 1.0, 0.0}}};
  const std::vector<CapPair> pairs = cap_pairs_of(std::vector{x, y});
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].first, 0);
  EXPECT_EQ(pairs[0].second, 1);
  const double quarter = std::numbers::pi / 4.0;
  const auto overlap_of = [](double half_angle, double r) {
    return 2.0 * (1.0 + r) * std::pow(std::sin(0.5 * half_angle), 2);
  };
  for (const double r : {0.0, 0.05}) {
    EXPECT_NEAR(cap_guard(pairs[0], cap_angle(overlap_of(quarter, r), r), cap_angle(overlap_of(quarter, r), r)), 0.0,
                1e-15);
    EXPECT_NEAR(
        cap_guard(pairs[0], cap_angle(overlap_of(0.5 * quarter, r), r), cap_angle(overlap_of(1.5 * quarter, r), r)),
        0.0, 1e-15);
    EXPECT_LT(cap_guard(pairs[0], cap_angle(overlap_of(0.9 * quarter, r), r), cap_angle(overlap_of(quarter, r), r)),
              0.0);
    EXPECT_GT(cap_guard(pairs[0], cap_angle(overlap_of(1.1 * quarter, r), r), cap_angle(overlap_of(quarter, r), r)),
              0.0);
  }
}

TEST(MdrCaps, OfOneClassMeetEachOther) {
  const ContactClass die{.name = "die", .normals = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}};
  const std::vector<CapPair> pairs = cap_pairs_of(std::vector{die});
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].first, pairs[0].second);
}

}  // namespace
}  // namespace monograin::mdr::apparent_radius_test
