#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <numbers>

#include <gtest/gtest.h>

#include "elastic/hertz.hpp"
#include "mdr/contact.hpp"
#include "models/accuracy.hpp"
#include "models/mdr/grains.hpp"

namespace monograin::mdr::energy_test {
namespace {

using std::numbers::pi;

constexpr double k_round_off = 8 * k_epsilon;  // a formula of some ten operations without cancellation
constexpr double k_quadrature = 1e-14;         // rounding of a sum of some hundred values

double unloading_force(const Dent& dent, double overlap) {
  return dent.unloading(dent.grain.radius, dent.overlap_max, overlap).force;
}

TEST(MdrElasticEnergy, IsTheWorkOfTheForce) {
  boost::math::quadrature::tanh_sinh<double> integrator;  // the force has an unbounded second derivative at 0
  for (const auto profile : {ElasticProfile::ellipse, ElasticProfile::parabola}) {
    const auto force = [profile](double x) { return elastic_contact(profile, 1.3, 1.1, x).force; };
    for (const double overlap : {1e-9, 1e-3, 0.3}) {
      const double work = integrator.integrate(force, 0.0, overlap);
      EXPECT_LE(relative_error(elastic_energy(profile, 1.3, 1.1, overlap), work), k_quadrature)
          << "delta = " << overlap;
    }
  }
}

TEST(MdrElasticEnergy, IsThatOfHertzForTheParabola) {
  EXPECT_EQ(elastic_energy(ElasticProfile::parabola, 1.3, 1.1, 0.3), hertz_energy(1.3, 1.1, 0.3));
}

TEST(MdrElasticEnergy, IsZeroWithoutOverlap) {
  for (const auto profile : {ElasticProfile::ellipse, ElasticProfile::parabola}) {
    EXPECT_EQ(elastic_energy(profile, 1.0, 1.0, 0.0), 0.0);
    EXPECT_EQ(elastic_energy(profile, 1.0, 1.0, -0.1), 0.0);
  }
}

TEST(MdrPlasticEnergy, IsThatOfTheSpringsThatMoveTheWall) {
  for (const Dent& dent : dents()) {
    const UnloadingShape shape = dent.shape();
    const double a = shape.contact_radius_max;
    const double springs = 8.0 / 3.0 * shape.pressure * shape.pressure * a * a * a / dent.material.composite_modulus;
    EXPECT_LE(relative_error(plastic_energy(shape), (1.0 - shape.rho) * springs), k_round_off) << dent;
  }
}

TEST(MdrUnloadingEnergy, IsTheWorkOfTheForceSinceTheContactOpened) {
  boost::math::quadrature::tanh_sinh<double> integrator;  // the force starts with the power 3/2
  for (const Dent& dent : dents()) {
    const double opening = dent.overlap_at(1.0);
    for (const double u : {0.0, 0.3, 0.7}) {
      const double overlap = dent.overlap_at(u);
      const double work = integrator.integrate([&](double x) { return unloading_force(dent, x); }, opening, overlap);
      // Round-off of the overlaps, magnified to that of the distance from the opening.
      const double tolerance = k_quadrature + 8.0 * k_epsilon * dent.overlap_max / (overlap - opening);
      EXPECT_LE(relative_error(unloading_energy(dent.shape(), overlap), work), tolerance) << dent << ", u = " << u;
    }
  }
}

TEST(MdrUnloadingEnergy, IsZeroWhereTheContactIsOpen) {
  for (const Dent& dent : dents()) {
    const double hair = 2.0 * k_epsilon * dent.overlap_max;
    EXPECT_EQ(unloading_energy(dent.shape(), dent.overlap_at(1.0) - hair), 0.0) << dent;
    EXPECT_EQ(unloading_energy(dent.shape(), -1.0), 0.0) << dent;
  }
}

TEST(MdrPlasticWork, IsTheIntegralOfTheForce) {
  for (const Dent& dent : dents()) {
    const double radius = dent.grain.radius;
    const auto primitive = [&](double overlap) {
      return plastic_work_primitive(dent.material, radius, overlap, dent.area_constant);
    };
    const double yield = dent.material.yield_overlap_ratio * radius;
    const double work = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
        [&](double x) { return dent.plastic(radius, x).force; }, yield, dent.overlap_max, 5, 1e-15);
    // Just after yield the work is a tenth of the primitive's terms: a few tens of eps, too.
    EXPECT_LE(relative_error(primitive(dent.overlap_max) - primitive(yield), work), k_quadrature) << dent;
  }
}

double stored_after_over_before_yield(const Grain& grain, ElasticProfile profile) {
  const Material material = grain.material();
  const Dent dent{grain, material.yield_overlap_ratio * grain.radius};
  return plastic_energy(dent.shape()) /
         elastic_energy(profile, material.composite_modulus, grain.radius, dent.overlap_max);
}

TEST(MdrYieldEnergy, FallsByThePrintedFactorForTheEllipse) {
  struct PrintedRatio {
    double modulus_over_yield, ratio;
  };
  for (const auto& [modulus_over_yield, ratio] :
       {PrintedRatio{6.25, 0.535}, PrintedRatio{12.5, 0.646}, PrintedRatio{20, 0.714}, PrintedRatio{25, 0.743},
        PrintedRatio{50, 0.814}, PrintedRatio{200, 0.878}}) {
    EXPECT_NEAR(stored_after_over_before_yield(Grain{modulus_over_yield}, ElasticProfile::ellipse), ratio, 5e-4)
        << "E/Y = " << modulus_over_yield;  // three printed digits
  }
}

TEST(MdrYieldEnergy, FallsByAFixedFactorOfTheUnloadingComplianceForTheParabola) {
  for (const Grain& grain : grains()) {
    const Dent dent{grain, grain.material().yield_overlap_ratio * grain.radius};
    const double expected = 80.0 / (9.0 * pi * pi) * (1.0 - dent.shape().rho);
    EXPECT_LE(relative_error(stored_after_over_before_yield(grain, ElasticProfile::parabola), expected),
              2 * k_round_off)
        << grain;
  }
}

}  // namespace
}  // namespace monograin::mdr::energy_test
