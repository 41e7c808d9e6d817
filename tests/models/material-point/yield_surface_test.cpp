#include "material-point/yield_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "models/material-point/cases.hpp"

namespace monograin::material_point::yield_surface_test {
namespace {

const std::vector<Parameters>& materials() {
  static const std::vector<Parameters> all{
      base_case(),   base_case(12.0, 0.5, 0.1), lactose(0.0), lactose(0.03), lactose(0.05), von_mises(3.0),
      von_mises(0.0)};
  return all;
}

/// q on the surface at a pressure within a segment.
double strength_at(const Parameters& m, const Properties& at, Segment segment, double p) {
  const double reach = 4.0 * at.shear_strength.value;
  double inside = 0.0;
  double outside = reach;
  if (segment == Segment::transition) inside = cap_constants(m, at).arc_centre.value;
  for (int i = 0; i < 200; ++i) {
    const double q = 0.5 * (inside + outside);
    (yield_on(m, at, {segment, 1.0}, p, q).f < 0.0 ? inside : outside) = q;
  }
  return 0.5 * (inside + outside);
}

std::vector<Segment> segments_of(const Parameters& m) {
  if (m.model == YieldModel::vm) return {Segment::shear};
  if (m.model == YieldModel::vmdc) return {Segment::tension, Segment::shear, Segment::cap};
  if (m.transition_width > 0.0) return {Segment::shear, Segment::transition, Segment::cap};
  return {Segment::shear, Segment::cap};
}

/// A pressure inside a segment; a `share` from 0 to 1 leads from its tensile to its compressive end.
double pressure_in(const Parameters& m, const Properties& at, Segment segment, double share) {
  const double centre = at.cap_centre.value;
  const bool has_arc = m.model == YieldModel::dpc && m.transition_width > 0.0;
  const double arc = has_arc ? cap_constants(m, at).transition_start.value : centre;
  switch (segment) {
    case Segment::tension:
      return std::lerp(at.tensile_strength.value, 0.0, share);
    case Segment::shear:
      return std::lerp(m.model == YieldModel::dpc ? at.tensile_strength.value : 0.0, -arc, share);
    case Segment::transition:
      return std::lerp(-arc, -centre, share);
    case Segment::cap:
      return std::lerp(-centre, -at.yield_pressure.value, share);
  }
  return 0.0;
}

TEST(YieldSurface, DerivativesAreDifferenceQuotients) {
  for (const Parameters& m : materials()) {
    for (const double phi : {0.0, 0.1}) {
      const Properties at = properties_at(m, phi);
      for (const Segment segment : segments_of(m)) {
        for (const double share : {0.2, 0.5, 0.9}) {
          for (const double side : {-1.0, 0.0, 1.0}) {
            const double p = pressure_in(m, at, segment, share);
            const double s = side * 0.97 * strength_at(m, at, segment, p);
            const Branch branch{segment, side};
            const Yield here = yield_on(m, at, branch, p, s);
            const double step = 2e-7;  // over the arc's radius of a few hundredths
            const auto quotient = [&](double dp, double ds, double dphi, double Yield::*member) {
              const Yield above = yield_on(m, properties_at(m, phi + dphi), branch, p + dp, s + ds);
              const Yield below = yield_on(m, properties_at(m, phi - dphi), branch, p - dp, s - ds);
              return (above.*member - below.*member) / (2.0 * step);
            };
            const auto near = [&](double actual, double expected, const char* what) {
              // Third derivatives of the tensile cap are of order 1/Lambda^3; round-off is 1e-10.
              EXPECT_NEAR(actual, expected, 1e-6 * (1.0 + std::abs(expected)))
                  << what << ", segment " << static_cast<int>(segment) << ", p = " << p << ", s = " << s;
            };
            near(here.f_p, quotient(step, 0, 0, &Yield::f), "f_p");
            near(here.f_s, quotient(0, step, 0, &Yield::f), "f_s");
            near(here.f_phi, quotient(0, 0, step, &Yield::f), "f_phi");
            near(here.Psi_p, quotient(step, 0, 0, &Yield::Psi), "Psi_p");
            near(here.Psi_s, quotient(0, step, 0, &Yield::Psi), "Psi_s");
          }
        }
      }
    }
  }
}

TEST(YieldSurface, SlopesOfTheCapsConstantsAreDifferenceQuotients) {
  const double phi = 0.1;
  const double step = 1e-6;
  for (const Parameters& m : {lactose(0.0), lactose(0.03), lactose(0.05)}) {
    const CapConstants here = cap_constants(m, properties_at(m, phi));
    const CapConstants above = cap_constants(m, properties_at(m, phi + step));
    const CapConstants below = cap_constants(m, properties_at(m, phi - step));
    for (const auto member :
         {&CapConstants::friction_slope, &CapConstants::cohesion, &CapConstants::arc_radius, &CapConstants::arc_centre,
          &CapConstants::flow_stretch, &CapConstants::transition_start}) {
      const double quotient = ((above.*member).value - (below.*member).value) / (2.0 * step);
      EXPECT_NEAR((here.*member).slope, quotient, 1e-9 * (1.0 + std::abs(quotient)));
    }
  }
}

// The printed derivatives of the double cap.
TEST(YieldSurface, DerivativesOfTheDoubleCapAreItsFormulas) {
  const Parameters m = base_case();
  const Properties at = properties_at(m, 0.1);
  const double strength = at.shear_strength.value;
  const double strength_slope = at.shear_strength.slope;
  const double axis = at.axis_ratio.value * strength;
  const double axis_slope = at.axis_ratio.slope * strength + at.axis_ratio.value * strength_slope;
  const double p = pressure_in(m, at, Segment::cap, 0.6);
  const double s = -0.4;
  const double b = (p + at.cap_centre.value) / axis;
  const Yield cap = yield_on(m, at, {Segment::cap, -1.0}, p, s);
  EXPECT_DOUBLE_EQ(cap.f_p, 2.0 * b / axis);
  EXPECT_DOUBLE_EQ(cap.f_s, 2.0 * s / (strength * strength));
  EXPECT_NEAR(
      cap.f_phi,
      -2.0 * s * s * strength_slope / std::pow(strength, 3) + 2.0 * b * (at.cap_centre.slope - b * axis_slope) / axis,
      1e-13);
  const double tensile = at.tensile_strength.value;
  const Yield tension = yield_on(m, at, {Segment::tension, -1.0}, 0.4 * tensile, s);
  EXPECT_NEAR(tension.f_phi,
              -2.0 * s * s * strength_slope / std::pow(strength, 3) - 2.0 * 0.16 * at.tensile_strength.slope / tensile,
              1e-13);
}

TEST(YieldSurface, SegmentsMeetWithOneValueAndTangent) {
  for (const Parameters& m : materials()) {
    const Properties at = properties_at(m, 0.05);
    const std::vector<Segment> segments = segments_of(m);
    for (std::size_t i = 0; i + 1 < segments.size(); ++i) {
      const double p = pressure_in(m, at, segments[i], 1.0);
      const double q = strength_at(m, at, segments[i], p);
      for (const double side : {-1.0, 1.0}) {
        const Yield before = yield_on(m, at, {segments[i], side}, p, side * q);
        const Yield after = yield_on(m, at, {segments[i + 1], side}, p, side * q);
        EXPECT_NEAR(after.f, before.f, 1e-13);
        const auto direction = [side](double by_p, double by_s) { return std::atan2(by_p, side * by_s); };
        const bool is_corner = m.model == YieldModel::dpc && m.transition_width == 0.0;
        if (!is_corner) {
          EXPECT_NEAR(direction(after.f_p, after.f_s), direction(before.f_p, before.f_s), 1e-12);
        } else {
          EXPECT_GT(std::abs(direction(after.f_p, after.f_s) - direction(before.f_p, before.f_s)), 0.1);
        }
        // The plastic strain keeps its direction even over the corner, where it is purely deviatoric.
        EXPECT_NEAR(direction(after.Psi_p, after.Psi_s), direction(before.Psi_p, before.Psi_s), 1e-12);
      }
    }
  }
}

// The whole gradient of the double cap is continuous; that of dpc jumps by known factors.
TEST(YieldSurface, GradientsJumpWhereTheSourceSays) {
  const Parameters m = lactose(0.03);
  const Properties at = properties_at(m, 0.05);
  const CapConstants cap = cap_constants(m, at);
  const auto ratio = [&](Segment a, Segment b) {
    const double p = pressure_in(m, at, a, 1.0);
    const double q = strength_at(m, at, a, p);
    const Yield before = yield_on(m, at, {a, 1.0}, p, q);
    const Yield after = yield_on(m, at, {b, 1.0}, p, q);
    return std::pair(std::hypot(before.f_p, before.f_s) / std::hypot(after.f_p, after.f_s),
                     std::hypot(before.Psi_p, before.Psi_s) / std::hypot(after.Psi_p, after.Psi_s));
  };
  const auto [f_at_arc, g_at_arc] = ratio(Segment::shear, Segment::transition);
  EXPECT_NEAR(f_at_arc, std::hypot(1.0, cap.friction_slope.value), 1e-12);
  EXPECT_NEAR(g_at_arc, 1.0, 1e-12);
  const auto [f_at_cap, g_at_cap] = ratio(Segment::transition, Segment::cap);
  EXPECT_NEAR(f_at_cap, 1.0 / (cap.flow_stretch.value * at.axis_ratio.value), 1e-12);
  EXPECT_NEAR(g_at_cap, 1.0 / at.axis_ratio.value, 1e-12);
}

TEST(YieldSurface, FlowIsAssociatedWhereTheSourceSays) {
  for (const Parameters& m : materials()) {
    const Properties at = properties_at(m, 0.05);
    for (const Segment segment : segments_of(m)) {
      const double p = pressure_in(m, at, segment, 0.4);
      const Yield yield = yield_on(m, at, {segment, -1.0}, p, -strength_at(m, at, segment, p));
      const bool is_associated = m.model != YieldModel::dpc || segment == Segment::cap;
      const double sine = yield.f_p * yield.Psi_s - yield.f_s * yield.Psi_p;
      if (is_associated) {
        EXPECT_NEAR(sine, 0.0, 1e-14);
        EXPECT_EQ(yield.f, yield.Psi);
      } else {
        EXPECT_GT(std::abs(sine), 1e-3);
        EXPECT_GT(yield.Psi_p, 0.0) << "shear and transition dilate";
      }
    }
  }
}

TEST(YieldSurface, HasTheStrengthsItIsMadeFrom) {
  for (const Parameters& m : materials()) {
    if (!is_compressible(m.model)) continue;
    const Properties at = properties_at(m, 0.1);
    EXPECT_NEAR(yield_function(m, at, -at.yield_pressure.value, 0.0), 0.0, 1e-14);
    EXPECT_NEAR(yield_function(m, at, at.tensile_strength.value, 0.0), 0.0, 1e-14);
    const double p = -at.cap_centre.value;
    const double q = strength_at(m, at, Segment::cap, p);
    // dpc rounds its edge off below the shear strength.
    const double stretch = m.model == YieldModel::dpc ? cap_constants(m, at).flow_stretch.value : 1.0;
    EXPECT_NEAR(q, at.shear_strength.value / stretch, 1e-13);
  }
}

TEST(YieldSurface, RelationsOfTheCapAreThePrintedOnes) {
  const Parameters m = lactose(0.03);
  const Properties at = properties_at(m, 0.1);
  const CapConstants cap = cap_constants(m, at);
  const double centre = at.cap_centre.value;
  const double eps = at.axis_ratio.value;
  EXPECT_NEAR(centre, (at.yield_pressure.value - eps * cap.cohesion.value) / (1.0 + eps * cap.friction_slope.value),
              1e-13);
  EXPECT_NEAR(cap.cohesion.value / cap.friction_slope.value, at.tensile_strength.value, 1e-14);
  EXPECT_NEAR(cap.cohesion.value + centre * cap.friction_slope.value, at.shear_strength.value, 1e-14);
}

// Below the arc's centre the printed formula would count a state without deviator as yielded (corrected).
TEST(YieldSurface, IsNegativeAllOverTheInside) {
  for (const Parameters& m : materials()) {
    const Properties at = properties_at(m, 0.05);
    for (const Segment segment : segments_of(m)) {
      for (const double share : {0.05, 0.5, 0.95}) {
        const double p = pressure_in(m, at, segment, share);
        const double q = strength_at(m, at, segment, p);
        for (const double part : {0.0, 0.3, 0.9, 0.999}) {
          EXPECT_LT(yield_function(m, at, p, part * q), 0.0) << "p = " << p << ", q = " << part * q;
          EXPECT_LT(yield_function(m, at, p, -part * q), 0.0);
        }
        EXPECT_GT(yield_function(m, at, p, 1.001 * q), 0.0);
      }
    }
  }
}

TEST(YieldSurface, WaysOutEndOnIt) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (const Parameters& m : materials()) {
    const Properties at = properties_at(m, 0.05);
    int found = 0;
    for (int i = 0; i < 2000; ++i) {
      const double p = any(random) * at.yield_pressure.value;
      const double s = any(random) * at.shear_strength.value;
      const double p_rate = any(random);
      const double s_rate = any(random);
      if (yield_function(m, at, p, s) >= 0.0) continue;
      const auto out = way_out(m, at, p, s, p_rate, s_rate);
      ASSERT_TRUE(out.has_value());
      const double p_out = p + out->t * p_rate;
      const double s_out = s + out->t * s_rate;
      // The tensile cap is narrow: f changes by 2/Lambda per unit of pressure.
      EXPECT_NEAR(yield_function(m, at, p_out, s_out), 0.0, 1e-11);
      EXPECT_NEAR(yield_on(m, at, out->branch, p_out, s_out).f, 0.0, 1e-11);
      EXPECT_LT(yield_function(m, at, p + 0.999 * out->t * p_rate, s + 0.999 * out->t * s_rate), 0.0);
      ++found;
    }
    EXPECT_GT(found, 200);
  }
}

TEST(YieldSurface, NoWayLeavesVonMisesAlongThePressure) {
  const Properties at = properties_at(von_mises(1.0), 0.0);
  EXPECT_FALSE(way_out(von_mises(1.0), at, 0.0, 0.5, -1.0, 0.0).has_value());
  EXPECT_FALSE(way_out(base_case(), properties_at(base_case(), 0.0), 0.0, 0.5, 0.0, 0.0).has_value());
}

TEST(YieldSurface, RefusesAnArcThatDoesNotFit) {
  Parameters m = lactose(3.0);
  EXPECT_THROW(static_cast<void>(cap_constants(m, properties_at(m, 0.0))), std::domain_error);
  m = lactose(0.0);
  m.tensile_ratio = -2.0;
  EXPECT_THROW(static_cast<void>(cap_constants(m, properties_at(m, 0.0))), std::domain_error);
}

}  // namespace
}  // namespace monograin::material_point::yield_surface_test
