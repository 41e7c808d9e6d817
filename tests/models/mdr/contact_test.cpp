#include "mdr/contact.hpp"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "elastic/hertz.hpp"
#include "models/accuracy.hpp"
#include "models/mdr/grains.hpp"

namespace monograin::mdr::contact_test {
namespace {

using std::numbers::pi;
using Wide = boost::multiprecision::cpp_bin_float_50;

constexpr double k_round_off = 8 * k_epsilon;  // a formula of some ten operations without cancellation
constexpr double k_quadrature = 1e-14;         // rounding of a sum of some hundred values
constexpr double k_infinity = std::numeric_limits<double>::infinity();

// --- yield overlap

struct YieldRow {
  const char* name;
  double modulus_over_yield;
  double overlap_ratio;
  double last_digit;  // one unit of the last printed digit
};

class MdrYieldOverlapTable : public ::testing::TestWithParam<YieldRow> {};

TEST_P(MdrYieldOverlapTable, MatchesPrintedDigits) {
  const auto& row = GetParam();
  EXPECT_NEAR(Grain{row.modulus_over_yield}.material().yield_overlap_ratio, row.overlap_ratio,
              0.5 * row.last_digit + k_round_off * row.overlap_ratio)
      << "E/Y = " << row.modulus_over_yield;
}

// 40-digit roots for nu = 0.3, rounded to the printed digits.
INSTANTIATE_TEST_SUITE_P(Mdr, MdrYieldOverlapTable,
                         ::testing::Values(YieldRow{"soft", 6.25, 0.273671768452174, 1e-15},
                                           YieldRow{"EY12p5", 12.5, 0.120974619957, 1e-12},
                                           YieldRow{"EY20", 20, 0.0623902928720725, 1e-16},
                                           YieldRow{"EY25", 25, 0.0438892777515957, 1e-16},
                                           YieldRow{"EY50", 50, 0.0129442540134782, 1e-16},
                                           YieldRow{"EY100", 100, 0.00341112080995762, 1e-17},
                                           YieldRow{"EY200", 200, 0.000864984300520164, 1e-18},
                                           YieldRow{"stiff", 1e5, 3.47672576494e-9, 1e-20}),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(MdrYieldOverlap, FallsWithTheSquareOfTheModulusForStiffMaterials) {
  const double limit = 2.75 * 0.75 * pi * 2.75 * 0.75 * pi;  // 41.98
  for (const double modulus_over_yield : {1e3, 1e5, 1e7, 1e9}) {
    const double d = yield_overlap_ratio(modulus_over_yield);
    // To the next order the fitted pressure falls by 1.75 * 4.4 d / 2.75 = 2.8 d, its square by twice that;
    // the term after it is 20.2 d^2.
    EXPECT_LE(relative_error(d * modulus_over_yield * modulus_over_yield, limit * (1.0 - 5.6 * d)),
              21 * d * d + k_round_off)
        << "Es/Y = " << modulus_over_yield;
  }
}

TEST(MdrYieldOverlap, ExistsOnlyAboveAThresholdOfTheModulus) {
  const double threshold = 0.75 * pi * (1.0 + 1.75 * std::exp(-4.4));  // where the root is 1
  EXPECT_NEAR(threshold, 2.407, 5e-4);
  EXPECT_EQ(yield_overlap_ratio(threshold * (1.0 - 1e-12)), k_infinity);
  EXPECT_NEAR(yield_overlap_ratio(threshold * (1.0 + 1e-12)), 1.0, 1e-11);
  EXPECT_EQ(yield_overlap_ratio(0.1), k_infinity);
  EXPECT_EQ(make_material(1.0, 0.3, k_infinity).yield_overlap_ratio, k_infinity);
}

TEST(MdrYieldOverlap, FallsWithTheModulus) {
  double last = 1.0;
  for (int i = 0; i < 1300; ++i) {
    const double modulus_over_yield = 2.408 * std::pow(1.01, i);  // up to 1e6
    const double d = yield_overlap_ratio(modulus_over_yield);
    EXPECT_LT(d, last) << "Es/Y = " << modulus_over_yield;
    last = d;
  }
}

// --- auxiliary functions

/// Compares with 50 digits, closely around the change from the series to the closed form and over the whole range.
template <class Function, class Reference>
void expect_full_accuracy(Function&& function, Reference&& reference, double switch_over) {
  constexpr double tolerance = 4 * k_epsilon;  // largest errors found: phi 1.5 eps, psi 2.6 eps
  const auto check = [&](double theta) {
    const Wide exact = reference(Wide(theta));
    EXPECT_LE(std::abs(static_cast<double>((function(theta) - exact) / exact)), tolerance) << "theta = " << theta;
  };
  for (int i = 0; i < 600; ++i) check(0.5 * pi * std::pow(0.97, i));  // down to 2e-8
  for (const double distance : {k_epsilon, 1e-10, 1e-3}) {
    check(switch_over * (1.0 - distance));
    check(switch_over * (1.0 + distance));
  }
}

TEST(MdrPhi, KeepsItsDigitsOnBothSidesOfTheSwitchOver) {
  expect_full_accuracy(
      phi, [](const Wide& theta) -> Wide { return theta - sin(theta) * cos(theta); }, 0.5);
}

TEST(MdrPsi, KeepsItsDigitsOnBothSidesOfTheSwitchOver) {
  expect_full_accuracy(
      psi,
      [](const Wide& theta) -> Wide {
        const Wide s = sin(theta);
        return s - theta * cos(theta) - s * s * s / 3;
      },
      1.0);
}

TEST(MdrPhi, IsHalfPiAtARightAngle) { EXPECT_LE(relative_error(phi(0.5 * pi), 0.5 * pi), k_epsilon); }

TEST(MdrPsi, IsTwoThirdsAtARightAngle) { EXPECT_LE(relative_error(psi(0.5 * pi), 2.0 / 3.0), k_epsilon); }

TEST(MdrPsi, HasTheDerivativeSineTimesPhi) {
  for (const double theta : {1e-3, 0.1, 0.45, 0.6, 0.9, 1.1, 1.5}) {
    const double derivative = central_difference(psi, theta, 5e-3 * theta);
    // Round-off over the relative step: 2 eps / 2.5e-3.
    EXPECT_LE(relative_error(derivative, std::sin(theta) * phi(theta)), 800 * k_epsilon) << "theta = " << theta;
  }
}

// --- elastic contact

TEST(MdrElasticContact, IsZeroWithoutOverlap) {
  for (const auto profile : {ElasticProfile::ellipse, ElasticProfile::parabola}) {
    for (const double overlap : {0.0, -0.1, -3.0}) {
      const Contact contact = elastic_contact(profile, 1.0, 1.0, overlap);
      EXPECT_EQ(contact.force, 0.0) << "delta = " << overlap;
      EXPECT_EQ(contact.contact_radius, 0.0) << "delta = " << overlap;
      EXPECT_EQ(contact.by_overlap, 0.0) << "delta = " << overlap;
      EXPECT_EQ(contact.by_radius, 0.0) << "delta = " << overlap;
    }
  }
}

TEST(MdrElasticContact, IsThatOfHertzForTheParabola) {
  for (const double overlap : {1e-9, 1e-3, 0.3}) {
    const Contact contact = elastic_contact(ElasticProfile::parabola, 1.3, 1.1, overlap);
    EXPECT_EQ(contact.force, hertz_force(1.3, 1.1, overlap)) << "delta = " << overlap;
    EXPECT_EQ(contact.contact_radius, hertz_contact_radius(1.1, overlap)) << "delta = " << overlap;
  }
}

TEST(MdrElasticContact, FallsBelowThatOfHertzBySmallTermsForTheEllipse) {
  for (const double ratio : {1e-6, 1e-4, 1e-2, 0.1}) {
    const double radius = 1.1;
    const double overlap = ratio * radius;
    const Contact contact = elastic_contact(ElasticProfile::ellipse, 1.3, radius, overlap);
    const double hertz = hertz_force(1.3, radius, overlap);
    // phi to its third term in delta/R: 1 - (3/40) x - (3/896) x^2 - ...
    EXPECT_LE(std::abs(contact.force / hertz - (1.0 - 3.0 / 40.0 * ratio - 3.0 / 896.0 * ratio * ratio)),
              1e-3 * ratio * ratio * ratio + k_round_off)
        << "delta/R = " << ratio;
    EXPECT_LE(relative_error(contact.contact_radius, std::sqrt(overlap * radius - 0.25 * overlap * overlap)),
              k_round_off)
        << "delta/R = " << ratio;
  }
}

TEST(MdrElasticContact, EndsWhereTheOverlapIsTheDiameter) {
  EXPECT_NO_THROW(static_cast<void>(elastic_contact(ElasticProfile::ellipse, 1.0, 1.1, 2.2)));
  EXPECT_THROW(static_cast<void>(elastic_contact(ElasticProfile::ellipse, 1.0, 1.1, 2.2 * (1.0 + k_epsilon))),
               std::domain_error);
  EXPECT_THROW(static_cast<void>(elastic_energy(ElasticProfile::ellipse, 1.0, 1.1, 2.2 * (1.0 + k_epsilon))),
               std::domain_error);
}

// --- yield

/// A contact just before and just after it yields.
struct YieldJump {
  double overlap_ratio;
  Contact before, after;

  YieldJump(const Grain& grain, ElasticProfile profile) {
    const Material material = grain.material();
    overlap_ratio = material.yield_overlap_ratio;
    const double overlap = overlap_ratio * grain.radius;
    before = elastic_contact(profile, material.composite_modulus, grain.radius, overlap);
    after = plastic_contact(material, grain.radius, overlap, yield_area_constant(overlap_ratio, grain.radius));
  }
};

TEST(MdrYield, IsContinuousInForceContactRadiusAndPressureForTheParabola) {
  for (const Grain& grain : grains()) {
    const YieldJump jump(grain, ElasticProfile::parabola);
    const auto pressure = [](const Contact& c) { return c.force / (pi * c.contact_radius * c.contact_radius); };
    EXPECT_LE(relative_error(jump.after.force, jump.before.force), k_round_off) << grain;
    EXPECT_LE(relative_error(jump.after.contact_radius, jump.before.contact_radius), k_round_off) << grain;
    EXPECT_LE(relative_error(pressure(jump.after), pressure(jump.before)), k_round_off) << grain;
  }
}

TEST(MdrYield, RaisesTheForceForTheEllipse) {
  struct PrintedJump {
    double modulus_over_yield, jump, last_digit;
  };
  for (const auto& [modulus_over_yield, jump, last_digit] :
       {PrintedJump{6.25, 2.1e-2, 1e-3}, PrintedJump{20, 4.7e-3, 1e-4}, PrintedJump{200, 6.5e-5, 1e-6}}) {
    const YieldJump yield(Grain{modulus_over_yield}, ElasticProfile::ellipse);
    EXPECT_NEAR(yield.after.force / yield.before.force - 1.0, jump, 0.5 * last_digit) << "E/Y = " << modulus_over_yield;
  }
}

TEST(MdrYield, RaisesTheAreaForTheEllipse) {
  for (const Grain& grain : grains()) {
    const YieldJump jump(grain, ElasticProfile::ellipse);
    const double ratio = jump.after.contact_radius / jump.before.contact_radius;
    EXPECT_LE(relative_error(ratio * ratio, 1.0 / (1.0 - 0.25 * jump.overlap_ratio)), k_round_off) << grain;
  }
}

TEST(MdrYield, LowersTheSlopeOfSoftAndRaisesThatOfStiffMaterials) {
  const auto slope_ratio = [](double modulus_over_yield) {
    const YieldJump jump(Grain{modulus_over_yield}, ElasticProfile::parabola);
    return jump.after.by_overlap / jump.before.by_overlap;
  };
  EXPECT_NEAR(slope_ratio(6.25), 0.69, 5e-3);      // two printed digits
  EXPECT_NEAR(slope_ratio(1e6), 4.0 / 3.0, 1e-9);  // the limit; the yield overlap is 3e-11
}

// --- plastic contact

TEST(MdrPlasticContact, CarriesTheFittedPressureOverTheAreaOfTheCap) {
  for (const Dent& dent : dents()) {
    const Contact contact = dent.plastic(dent.grain.radius, dent.overlap_max);
    const double m = dent.overlap_max;
    const double area = pi * (2.0 * m * dent.grain.radius - m * m + dent.area_constant);
    const double pressure = dent.material.yield_stress * (1.0 + 1.75 * std::exp(-4.4 * m / dent.grain.radius));
    EXPECT_LE(relative_error(contact.force, pressure * area), k_round_off) << dent;
    EXPECT_LE(relative_error(pi * contact.contact_radius * contact.contact_radius, area), k_round_off) << dent;
  }
}

TEST(MdrPlasticContact, PullsTrialsBackWhereItHasNoArea) {
  const Dent dent{Grain{20}, 0.01};  // far below the yield overlap of 0.06
  constexpr double k_step = 1e-6;
  const Contact contact = dent.plastic(1.0, dent.overlap_max);
  EXPECT_EQ(contact.contact_radius, 0.0);
  EXPECT_LT(contact.force, 0.0);
  EXPECT_GT(contact.by_overlap, 0.0);
  const double rise =
      dent.plastic(1.0, dent.overlap_max + k_step).force - dent.plastic(1.0, dent.overlap_max - k_step).force;
  EXPECT_NEAR(rise / (2.0 * k_step), contact.by_overlap, 1e-8 * contact.by_overlap);
}

TEST(MdrUnloading, LeavesNoDentWithoutArea) {
  const Dent dent{Grain{20}, 0.01};
  EXPECT_THROW(static_cast<void>(dent.shape()), std::domain_error);
}

// --- unloading

TEST(MdrUnloading, StartsFromThePlasticContact) {
  for (const Dent& dent : dents()) {
    const Contact plastic = dent.plastic(dent.grain.radius, dent.overlap_max);
    const Contact unloading = dent.unloading(dent.grain.radius, dent.overlap_max, dent.overlap_max);
    EXPECT_LE(relative_error(unloading.force, plastic.force), k_round_off) << dent;
    EXPECT_LE(relative_error(unloading.contact_radius, plastic.contact_radius), k_round_off) << dent;
  }
}

TEST(MdrUnloading, HasNoForceWhereTheContactIsOpen) {
  for (const Dent& dent : dents()) {
    const double opening = dent.overlap_at(1.0);
    // One round-off of the overlap on either side.
    const double hair = 2.0 * k_epsilon * dent.overlap_max;
    for (const double overlap : {opening - hair, opening - 0.1, -1.0}) {
      const Contact open = dent.unloading(dent.grain.radius, dent.overlap_max, overlap);
      EXPECT_EQ(open.force, 0.0) << dent << ", delta = " << overlap;
      EXPECT_EQ(open.contact_radius, 0.0) << dent << ", delta = " << overlap;
      EXPECT_EQ(open.by_overlap, 0.0) << dent << ", delta = " << overlap;
    }
    EXPECT_GT(dent.unloading(dent.grain.radius, dent.overlap_max, opening + hair).force, 0.0) << dent;
  }
}

TEST(MdrUnloading, GoesOnAboveTheLargestOverlapAsTheMirrorImage) {
  // phi(pi - theta) = pi - phi(theta): the force is odd about its value at the largest overlap, the radius even.
  for (const Dent& dent : dents()) {
    const UnloadingShape shape = dent.shape();
    const auto at = [&](double u) {
      return unloading_contact(shape, dent.material.composite_modulus, dent.overlap_max - u * shape.recovery);
    };
    for (const double u : {1e-6, 0.01, 0.3}) {
      // Round-off of the overlap, magnified to that of u.
      const double tolerance = k_round_off + 4.0 * k_epsilon * dent.overlap_max / shape.recovery;
      EXPECT_LE(relative_error(at(u).force + at(-u).force, 2.0 * at(0.0).force), tolerance) << dent << ", u = " << u;
      EXPECT_LE(relative_error(at(-u).contact_radius, at(u).contact_radius), tolerance) << dent << ", u = " << u;
    }
  }
}

TEST(MdrUnloading, KeepsItsForceBeyondTheMirrorImage) {
  for (const Dent& dent : dents()) {
    const UnloadingShape shape = dent.shape();
    const double tolerance = k_round_off + 4.0 * k_epsilon * dent.overlap_max / shape.recovery;
    const auto overlap = [&](double u) { return dent.overlap_max - u * shape.recovery; };
    const auto at = [&](double u) { return unloading_contact(shape, dent.material.composite_modulus, overlap(u)); };
    for (const double u : {-1.0, -1.5, -1e6}) {
      EXPECT_LE(relative_error(at(u).force, 2.0 * at(0.0).force), tolerance) << dent << ", u = " << u;
      // The square root of the area has the root of u's round-off at the end of the image.
      EXPECT_LE(at(u).contact_radius, 2.0 * std::sqrt(tolerance) * shape.contact_radius_max) << dent << ", u = " << u;
      EXPECT_LE(relative_error(unloading_energy(shape, overlap(u - 0.5)) - unloading_energy(shape, overlap(u)),
                               0.5 * shape.recovery * at(u).force),
                4.0 * tolerance * std::abs(u))
          << dent << ", u = " << u;
    }
  }
}

TEST(MdrUnloading, IsStifferThanAnElasticContactOfItsRadius) {
  for (const Dent& dent : dents()) {
    const UnloadingShape shape = dent.shape();
    EXPECT_GT(shape.rho, 0.0) << dent;
    EXPECT_LT(shape.rho, 1.0) << dent;
    for (const double u : {0.0, 0.4, 0.9}) {
      const Contact contact = dent.unloading(dent.grain.radius, dent.overlap_max, dent.overlap_at(u));
      EXPECT_LE(relative_error(contact.by_overlap * (1.0 - shape.rho),
                               2.0 * dent.material.composite_modulus * contact.contact_radius),
                k_round_off)
          << dent << ", u = " << u;
    }
  }
}

TEST(MdrUnloading, MovesTheCentreByTheBoussinesqDisplacementUnderUniformPressure) {
  for (const Dent& dent : dents()) {
    const UnloadingShape shape = dent.shape();
    const double nu = dent.grain.poisson_ratio;
    const double depth = dent.grain.radius - dent.overlap_max + 0.5 * shape.height;
    // Point loads of the density p_Y over the contact, at that depth below its middle (E = 1).
    const auto ring = [&](double r) {
      const double distance = std::hypot(r, depth);
      return shape.pressure * (1.0 + nu) * r *
             (depth * depth / (distance * distance * distance) + 2.0 * (1.0 - nu) / distance);
    };
    const double displacement = boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
        ring, 0.0, shape.contact_radius_max, 10, k_quadrature);
    EXPECT_LE(relative_error(0.5 * shape.rho * shape.height, displacement), k_quadrature) << dent;
  }
}

TEST(MdrUnloading, EndsWhereTheWallReachesTheCentre) {
  EXPECT_NO_THROW(static_cast<void>(Dent{Grain{20}, 1.0}.shape()));
  EXPECT_THROW(static_cast<void>(Dent{Grain{20}, 1.5}.shape()), std::domain_error);
}

// --- incompressible material, units

TEST(MdrMaterial, MayBeIncompressible) {
  const Dent dent{Grain{20, 0.5}, 0.2};
  EXPECT_EQ(dent.material.linear_compressibility, 0.0);
  // All laws are smooth in nu there: the difference to a neighbour is of that order.
  const Dent neighbour{Grain{20, 0.5 - 1e-9}, 0.2};
  for (const double u : {0.0, 0.5}) {
    const Contact contact = dent.unloading(1.0, 0.2, dent.overlap_at(u));
    const Contact near_by = neighbour.unloading(1.0, 0.2, neighbour.overlap_at(u));
    EXPECT_LE(relative_error(contact.force, near_by.force), 2e-9);
    EXPECT_LE(relative_error(contact.by_radius, near_by.by_radius), 2e-9);
  }
}

/// A unit of length and one of stress, powers of two: every operation scales without further round-off.
struct Units {
  double length, stress;

  [[nodiscard]] Contact convert(const Contact& contact) const {
    return {.contact_radius = length * contact.contact_radius,
            .force = stress * length * length * contact.force,
            .by_overlap = stress * length * contact.by_overlap,
            .by_radius = stress * length * contact.by_radius,
            .by_overlap_max = stress * length * contact.by_overlap_max};
  }
};

void expect_identical(const Contact& actual, const Contact& expected) {
  EXPECT_EQ(actual.contact_radius, expected.contact_radius);
  EXPECT_EQ(actual.force, expected.force);
  EXPECT_EQ(actual.by_overlap, expected.by_overlap);
  EXPECT_EQ(actual.by_radius, expected.by_radius);
  EXPECT_EQ(actual.by_overlap_max, expected.by_overlap_max);
}

void expect_the_same_in_other_units(const Dent& dent, const Units& units) {
  const Grain& grain = dent.grain;
  const Material& ours = dent.material;
  const double m = dent.overlap_max;
  const double radius = units.length * grain.radius;
  const Material material = make_material(units.stress, grain.poisson_ratio, units.stress / grain.modulus_over_yield);
  const double area_constant = yield_area_constant(material.yield_overlap_ratio, radius);
  for (const auto profile : {ElasticProfile::ellipse, ElasticProfile::parabola}) {
    expect_identical(elastic_contact(profile, material.composite_modulus, radius, units.length * m),
                     units.convert(elastic_contact(profile, ours.composite_modulus, grain.radius, m)));
  }
  expect_identical(plastic_contact(material, radius, units.length * m, area_constant),
                   units.convert(dent.plastic(grain.radius, m)));
  const UnloadingShape shape = unloading_shape(material, radius, units.length * m, area_constant);
  const double overlap = dent.overlap_at(0.5);
  expect_identical(unloading_contact(shape, material.composite_modulus, units.length * overlap),
                   units.convert(dent.unloading(grain.radius, m, overlap)));
  EXPECT_EQ(unloading_energy(shape, units.length * overlap),
            units.stress * std::pow(units.length, 3) * unloading_energy(dent.shape(), overlap));
}

TEST(MdrContact, DoesNotDependOnTheUnits) {
  constexpr double micro = 0x1p-20;
  constexpr double mega = 0x1p20;
  for (const Units units :
       {Units{micro, 1.0}, Units{mega, 1.0}, Units{1.0, micro}, Units{1.0, mega}, Units{micro, mega}}) {
    for (const Dent& dent : dents()) {
      SCOPED_TRACE(::testing::Message() << dent << ", length " << units.length << ", stress " << units.stress);
      expect_the_same_in_other_units(dent, units);
    }
  }
}

}  // namespace
}  // namespace monograin::mdr::contact_test
