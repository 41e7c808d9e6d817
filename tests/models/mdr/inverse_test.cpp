// The overlap under a force, on each branch of a contact.

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "elastic/hertz.hpp"
#include "mdr/contact.hpp"
#include "models/accuracy.hpp"
#include "models/mdr/grains.hpp"

namespace monograin::mdr::inverse_test {
namespace {

using std::numbers::pi;
using Wide = boost::multiprecision::cpp_bin_float_50;

constexpr double k_modulus = 1.3;
constexpr double k_round_off = 8 * k_epsilon;

/// Amplification of a relative error of the force in the overlap.
double condition(const Contact& contact, double overlap) { return contact.force / (contact.by_overlap * overlap); }

// --- phi

TEST(MdrInversePhi, FindsTheAngleToFullAccuracy) {
  for (int i = 0; i < 1000; ++i) {
    const double theta = 2.0 * std::pow(0.97, i);  // phi(2) = 2.38, beyond a right angle; down to 1e-13
    const double value = static_cast<double>(Wide(theta) - sin(Wide(theta)) * cos(Wide(theta)));
    const double sine = std::sin(theta);
    const double magnified = value / (2.0 * sine * sine * theta);
    // 2 eps measured
    EXPECT_LE(relative_error(inverse_phi(value), theta), 2.0 * k_epsilon * (1.0 + magnified)) << "theta = " << theta;
  }
}

TEST(MdrInversePhi, IsACubeRootForTinyValues) {
  EXPECT_EQ(inverse_phi(0.0), 0.0);
  for (const double value : {1e-12, 1e-30, 1e-100, 1e-200, 1e-300}) {
    const double theta = std::cbrt(1.5 * value);
    EXPECT_LE(relative_error(inverse_phi(value), theta * (1.0 + theta * theta / 15.0)), 2.0 * k_epsilon)
        << "value = " << value;
  }
}

TEST(MdrInversePhi, ReachesTheEndOfItsRange) {
  const double theta = inverse_phi(2.5);
  EXPECT_LE(relative_error(phi(theta), 2.5), k_round_off);
  EXPECT_GT(theta, 0.5 * pi);
  EXPECT_LT(theta, pi);
}

// --- elastic

TEST(MdrElasticOverlap, BearsTheForce) {
  for (const auto profile : {ElasticProfile::ellipse, ElasticProfile::parabola}) {
    for (const double radius : {1e-3, 1.0, 1.1}) {
      for (const double ratio : {1e-200, 1e-100, 1e-30, 1e-16, 1e-9, 1e-3, 0.1, 0.5, 1.0, 1.5, 1.9, 1.999}) {
        const double overlap = ratio * radius;
        const Contact contact = elastic_contact(profile, k_modulus, radius, overlap);
        const double back = elastic_overlap(profile, k_modulus, radius, contact.force);
        EXPECT_LE(relative_error(back, overlap), k_round_off * (1.0 + condition(contact, overlap)))
            << "R = " << radius << ", delta/R = " << ratio;
      }
    }
  }
}

TEST(MdrElasticOverlap, IsThatOfHertzForTheParabola) {
  for (const double force : {1e-20, 1e-6, 1.0}) {
    const double expected = std::pow(3.0 * force / (4.0 * k_modulus * std::sqrt(1.1)), 2.0 / 3.0);
    EXPECT_LE(relative_error(elastic_overlap(ElasticProfile::parabola, k_modulus, 1.1, force), expected),
              2.0 * k_round_off);
  }
}

TEST(MdrElasticOverlap, IsZeroWithoutForce) {
  for (const auto profile : {ElasticProfile::ellipse, ElasticProfile::parabola}) {
    EXPECT_EQ(elastic_overlap(profile, k_modulus, 1.1, 0.0), 0.0);
    EXPECT_EQ(elastic_overlap(profile, k_modulus, 1.1, -1.0), 0.0);
  }
}

TEST(MdrElasticOverlap, EndsWhereTheEllipseDoes) {
  const double most = elastic_contact(ElasticProfile::ellipse, k_modulus, 1.1, 2.2).force;
  EXPECT_NEAR(elastic_overlap(ElasticProfile::ellipse, k_modulus, 1.1, most * (1.0 - 1e-14)), 2.2, 1e-6);
  EXPECT_THROW((void)elastic_overlap(ElasticProfile::ellipse, k_modulus, 1.1, most * (1.0 + 1e-14)), std::domain_error);
  EXPECT_NO_THROW((void)elastic_overlap(ElasticProfile::parabola, k_modulus, 1.1, 100.0 * most));
}

// --- fully plastic

/// Overlap at which a fully plastic contact bears most, below the radius: bisection of dF/d(delta).
double strongest_overlap(const Dent& dent) {
  double below = dent.material.yield_overlap_ratio * dent.grain.radius;
  double above = dent.grain.radius;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (below + above);
    (dent.plastic(dent.grain.radius, middle).by_overlap > 0.0 ? below : above) = middle;
  }
  return below;
}

TEST(MdrPlasticOverlap, BearsTheForceFromWhereverTheSearchBegins) {
  for (const Dent& dent : dents()) {
    const double R = dent.grain.radius;
    const double yield = dent.material.yield_overlap_ratio * R;
    const double strongest = strongest_overlap(dent);
    for (const double share : {0.0, 1e-9, 1e-3, 0.1, 0.5, 0.9, 0.99}) {
      const double overlap = std::lerp(yield, strongest, share);
      const Contact contact = dent.plastic(R, overlap);
      for (const double guess : {overlap, yield, 0.5 * (overlap + yield), 0.5 * (overlap + strongest), 0.0}) {
        const double back = plastic_overlap(dent.material, R, contact.force, dent.area_constant, guess);
        // The contact area is a difference with the area constant.
        EXPECT_LE(relative_error(back, overlap), k_round_off * (2.0 + condition(contact, overlap)))
            << dent << ", share = " << share << ", guess = " << guess;
      }
    }
  }
}

TEST(MdrPlasticOverlap, EndsAtTheLargestForce) {
  for (const Dent& dent : dents()) {
    const double R = dent.grain.radius;
    const double strongest = strongest_overlap(dent);
    const double most = dent.plastic(R, strongest).force;
    const double yield = dent.material.yield_overlap_ratio * R;
    for (const double guess : {yield, 0.5 * (yield + strongest), strongest}) {
      EXPECT_THROW((void)plastic_overlap(dent.material, R, most * 1.001, dent.area_constant, guess), std::domain_error)
          << dent << ", guess = " << guess;
      const double back = plastic_overlap(dent.material, R, most * 0.999, dent.area_constant, guess);
      EXPECT_LT(back, strongest) << dent;
      EXPECT_LE(relative_error(dent.plastic(R, back).force, most * 0.999), k_round_off) << dent;
    }
  }
}

// --- unloading

TEST(MdrUnloadingOverlap, BearsTheForceBelowTheLargestOverlapAndSomewhatAbove) {
  for (const Dent& dent : dents()) {
    const UnloadingShape shape = dent.shape();
    for (const double u : {-0.45, -0.1, 0.0, 1e-9, 0.1, 0.5, 0.9, 0.999, 1.0 - 1e-6}) {
      const double overlap = dent.overlap_at(u);
      const Contact contact = unloading_contact(shape, dent.material.composite_modulus, overlap);
      const double back = unloading_overlap(shape, contact.force);
      // Round-off of the overlap itself, and of the distance from the opening over its condition (largest at the
      // maximum).
      const double round_off = k_epsilon * dent.overlap_max + k_round_off * contact.force / contact.by_overlap;
      EXPECT_NEAR(back, overlap, 2.0 * round_off) << dent << ", u = " << u;
    }
  }
}

TEST(MdrUnloadingOverlap, IsTheOpeningWithoutForce) {
  for (const Dent& dent : dents()) {
    const UnloadingShape shape = dent.shape();
    for (const double force : {0.0, -1e-3}) {
      EXPECT_EQ(unloading_overlap(shape, force), shape.overlap_max - shape.recovery) << dent;
    }
  }
}

TEST(MdrRecompressedShare, HasItsDigitsHoweverSmallTheRecoveryIs) {
  for (const Dent& dent : dents()) {
    const UnloadingShape shape = dent.shape();
    const double unit = 2.0 * shape.pressure * shape.contact_radius_max * shape.contact_radius_max;
    for (const double share : {1e-12, 1e-6, 0.1, 0.5, 1.0}) {
      const double force = unit * phi(2.0 * std::asin(std::sqrt(0.5 * share)));
      EXPECT_LE(relative_error(recompressed_share(shape, force), share), k_round_off) << dent << ", share = " << share;
    }
  }
}

TEST(MdrUnloadingOverlap, EndsHalfARecoveryAboveTheLargestOverlap) {
  for (const Dent& dent : dents()) {
    const UnloadingShape shape = dent.shape();
    const double unit = 2.0 * shape.pressure * shape.contact_radius_max * shape.contact_radius_max;
    const double last = unloading_overlap(shape, 2.499 * unit);
    EXPECT_GT(last, dent.overlap_at(-0.4)) << dent;
    EXPECT_LT(last, dent.overlap_at(-0.6)) << dent;
    EXPECT_THROW((void)unloading_overlap(shape, 2.501 * unit), std::domain_error) << dent;
  }
}

}  // namespace
}  // namespace monograin::mdr::inverse_test
