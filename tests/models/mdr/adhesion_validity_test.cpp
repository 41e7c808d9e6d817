#include "mdr/adhesion_validity.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "history/table.hpp"
#include "models/accuracy.hpp"
#include "models/mdr/grains.hpp"
#include "models/mdr/reference_windows.hpp"
#include "support/reference_case.hpp"

namespace monograin::mdr::adhesion_validity_test {
namespace {

using std::numbers::pi;

constexpr double k_infinity = std::numeric_limits<double>::infinity();
constexpr double k_round_off = 16 * k_epsilon;

// --- fit

TEST(MdrAdhesionFit, BeginsAtItsOnset) {
  for (const double yield : {0.0, 0.01, 0.2}) {
    EXPECT_EQ(peak_radius_over_initial_radius(yield + 0.1349, yield), 0.0);
    EXPECT_GT(peak_radius_over_initial_radius(yield + 0.1351, yield), 0.0);
  }
}

TEST(MdrAdhesionFit, IsThePrintedPower) {
  // x = 1/16
  EXPECT_LE(relative_error(peak_radius_over_initial_radius(0.135 + 0.0625, 0.0), 1.75 / 8.0), k_round_off);
}

TEST(MdrAdhesionFit, IsZeroWithoutYield) { EXPECT_EQ(peak_radius_over_initial_radius(0.5, k_infinity), 0.0); }

// --- plastic zone

TEST(MdrPlasticZone, IsWhereTheEdgeReachesTheYieldStress) {
  // sqrt(2 E* dg)/sqrt(2 pi r) = Y (F.16)
  constexpr double modulus = 3.0, surface_energy = 0.02, yield_stress = 0.7;
  const double r = plastic_zone_size(modulus, surface_energy, yield_stress);
  EXPECT_LE(relative_error(std::sqrt(2.0 * modulus * surface_energy) / std::sqrt(2.0 * pi * r), yield_stress),
            k_round_off);
  // A mean pressure has to be overcome first.
  const double with_pressure = plastic_zone_size(modulus, surface_energy, yield_stress, yield_stress);
  EXPECT_LE(relative_error(with_pressure, 0.25 * r), k_round_off);
  EXPECT_EQ(plastic_zone_size(modulus, surface_energy, k_infinity), 0.0);
}

// --- test of a contact

TEST(MdrAdhesionValidity, NamesTheConditionThatFails) {
  EXPECT_EQ(adhesion_validity(1.0, 0.9, 0.1), AdhesionValidity::valid);
  EXPECT_EQ(adhesion_validity(1.0, 1.1, 0.1), AdhesionValidity::peak_failure);
  EXPECT_EQ(adhesion_validity(1.0, 0.9, 0.2), AdhesionValidity::yielding_failure);
  EXPECT_EQ(adhesion_validity(1.0, 1.1, 0.2), AdhesionValidity::peak_failure);
  // On the bounds: a_c/r_peak > 1 and 2 a_c/r_Ip >= 15.
  EXPECT_EQ(adhesion_validity(1.0, 1.0, 0.1), AdhesionValidity::peak_failure);
  EXPECT_EQ(adhesion_validity(7.5, 0.0, 1.0), AdhesionValidity::valid);
  // Without a ring and without yield nothing can fail.
  EXPECT_EQ(adhesion_validity(0.0, 0.0, 0.0), AdhesionValidity::valid);
}

// --- window

struct WindowCase {
  Indenter indenter;
  double composite_modulus, yield_stress, peak_radius;
};

const WindowCase k_windows[] = {{{ElasticProfile::ellipse, 0.08, 0.7}, 1.1, 0.02, 0.45},
                                {{ElasticProfile::ellipse, 0.3, 0.9}, 1.1, 0.08, 0.1},
                                {{ElasticProfile::ellipse, 4.0, 1.0}, 1.1, 0.16, 0.3},
                                {{ElasticProfile::parabola, 4.0, 1.0}, 1.1, 0.16, 0.3}};

AdhesionValidity validity(const WindowCase& c, double surface_energy, Control control) {
  return adhesion_validity(critical_radius(c.indenter, {c.composite_modulus, surface_energy}, control), c.peak_radius,
                           plastic_zone_size(c.composite_modulus, surface_energy, c.yield_stress));
}

TEST(MdrAdhesionWindow, EndsWhereTheConditionsTurn) {
  constexpr double hair = 1e-12;
  for (const WindowCase& c : k_windows) {
    for (const Control control : {Control::displacement, Control::force}) {
      const auto [least, greatest] =
          adhesion_window(c.indenter, c.composite_modulus, c.yield_stress, c.peak_radius, control);
      EXPECT_LE(relative_error(critical_radius(c.indenter, {c.composite_modulus, least}, control), c.peak_radius),
                1e-14);
      const double zone = plastic_zone_size(c.composite_modulus, greatest, c.yield_stress);
      EXPECT_LE(
          relative_error(2.0 * critical_radius(c.indenter, {c.composite_modulus, greatest}, control), 15.0 * zone),
          1e-14);
      EXPECT_EQ(validity(c, least * (1.0 - hair), control), AdhesionValidity::peak_failure);
      EXPECT_NE(validity(c, least * (1.0 + hair), control), AdhesionValidity::peak_failure);
      WindowCase convex = c;
      convex.peak_radius = 0.0;
      EXPECT_EQ(validity(convex, greatest * (1.0 - hair), control), AdhesionValidity::valid);
      EXPECT_EQ(validity(convex, greatest * (1.0 + hair), control), AdhesionValidity::yielding_failure);
    }
  }
}

class MdrAdhesionReference : public ::testing::TestWithParam<Control> {};

TEST_P(MdrAdhesionReference, HasTheSamePeaksAndWindows) {
  const auto [modulus_over_yield, displacement, yielded, radius, contact_radius, height, peak_radius, least, greatest] =
      reference_windows(GetParam());
  for (std::size_t i = 0; i < radius.size(); ++i) {
    const Material material = Grain{modulus_over_yield[i]}.material();
    const double peak = peak_radius_over_initial_radius(displacement[i], material.yield_overlap_ratio);
    const auto where = ::testing::Message() << "E/Y = " << modulus_over_yield[i] << ", delta_o = " << displacement[i];
    EXPECT_LE(relative_error(peak, peak_radius[i]), 1e-14) << where;
    const Indenter indenter = yielded[i] > 0.0 ? Indenter{ElasticProfile::ellipse, height[i], contact_radius[i]}
                                               : elastic_indenter(ElasticProfile::ellipse, radius[i]);
    const auto window = adhesion_window(indenter, material.composite_modulus, material.yield_stress, peak, GetParam());
    EXPECT_LE(relative_error(window.least, least[i]), 1e-12) << where;
    EXPECT_LE(relative_error(window.greatest, greatest[i]), 1e-12) << where;
  }
}

INSTANTIATE_TEST_SUITE_P(Mdr, MdrAdhesionReference, ::testing::Values(Control::displacement, Control::force),
                         [](const auto& instance) {
                           return std::string(instance.param == Control::force ? "ForceControl"
                                                                               : "DisplacementControl");
                         });

}  // namespace
}  // namespace monograin::mdr::adhesion_validity_test
