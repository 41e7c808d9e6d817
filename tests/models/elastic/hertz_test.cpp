#include "elastic/hertz.hpp"

#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "models/accuracy.hpp"

namespace monograin::hertz_test {
namespace {

constexpr double k_round_off = 4 * k_epsilon;  // a product of a few factors and one square root
constexpr double k_quadrature = 1e-14;         // rounding of a sum of some hundred values

struct HertzRow {
  const char* name;
  double modulus, radius, overlap;
  double force, contact_radius, energy;
};

class HertzTable : public ::testing::TestWithParam<HertzRow> {};

TEST_P(HertzTable, MatchesHandComputedValues) {
  const auto& row = GetParam();
  const auto inputs = ::testing::Message()
                      << "E* = " << row.modulus << ", R = " << row.radius << ", delta = " << row.overlap;
  EXPECT_LE(relative_error(hertz_force(row.modulus, row.radius, row.overlap), row.force), k_round_off) << inputs;
  EXPECT_LE(relative_error(hertz_contact_radius(row.radius, row.overlap), row.contact_radius), k_round_off) << inputs;
  EXPECT_LE(relative_error(hertz_energy(row.modulus, row.radius, row.overlap), row.energy), k_round_off) << inputs;
}

INSTANTIATE_TEST_SUITE_P(Hertz, HertzTable,
                         ::testing::Values(HertzRow{"quarter", 1, 1, 0.25, 1.0 / 6, 0.5, 1.0 / 60},
                                           HertzRow{"hundredth", 1, 1, 0.01, 4.0 / 3000, 0.1, 1.6 / 300000},
                                           HertzRow{"scaled", 3, 4, 1, 8, 2, 3.2},
                                           HertzRow{"separated", 3, 4, -1, 0, 0, 0},
                                           HertzRow{"touching", 3, 4, 0, 0, 0, 0}),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(Hertz, CompositeModulusOfARigidWallIsThePlaneStrainModulus) {
  EXPECT_EQ(composite_modulus(2.0, 0.0), 2.0);
  EXPECT_LE(relative_error(composite_modulus(3.0, 0.5), 4.0), k_round_off);
  EXPECT_LE(relative_error(composite_modulus(91.0, 0.3), 100.0), k_round_off);
  EXPECT_LE(relative_error(composite_modulus(91.0, -0.3), 100.0), k_round_off);
}

TEST(Hertz, ForceGrowsWithThePowerThreeHalvesOfTheOverlap) {
  for (const double overlap : {1e-12, 1e-6, 1e-3, 0.1}) {
    const double ratio = hertz_force(1.7, 0.3, 100.0 * overlap) / hertz_force(1.7, 0.3, overlap);
    EXPECT_LE(relative_error(ratio, 1000.0), k_round_off) << "delta = " << overlap;
  }
}

TEST(Hertz, SlopeIsTwiceTheModulusTimesTheContactRadius) {
  // Sneddon's relation for any axisymmetric elastic contact.
  for (const double overlap : {1e-9, 1e-3, 0.2}) {
    const double slope = central_difference([](double x) { return hertz_force(1.7, 0.3, x); }, overlap, 5e-3 * overlap);
    // Round-off over the relative step: 2 eps / 2.5e-3 at worst; truncation is 2e-15.
    EXPECT_LE(relative_error(slope, 2.0 * 1.7 * hertz_contact_radius(0.3, overlap)), 800 * k_epsilon)
        << "delta = " << overlap;
  }
}

TEST(Hertz, EnergyIsTheWorkOfTheForce) {
  boost::math::quadrature::tanh_sinh<double> integrator;  // the force has an unbounded second derivative at 0
  for (const double overlap : {1e-9, 1e-3, 0.2}) {
    const double work = integrator.integrate([](double x) { return hertz_force(1.7, 0.3, x); }, 0.0, overlap);
    EXPECT_LE(relative_error(hertz_energy(1.7, 0.3, overlap), work), k_quadrature) << "delta = " << overlap;
    const double closed_form = 8.0 / 15.0 * 1.7 * std::sqrt(0.3 * overlap) * overlap * overlap;
    EXPECT_LE(relative_error(hertz_energy(1.7, 0.3, overlap), closed_form), k_round_off) << "delta = " << overlap;
  }
}

TEST(Hertz, NotANumberIsPassedOn) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(hertz_force(1.0, 1.0, nan)));
  EXPECT_TRUE(std::isnan(hertz_contact_radius(1.0, nan)));
  EXPECT_TRUE(std::isnan(hertz_energy(1.0, 1.0, nan)));
}

}  // namespace
}  // namespace monograin::hertz_test
