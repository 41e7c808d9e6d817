#include "mdr/contact_profile.hpp"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/special_functions/ellint_rd.hpp>
#include <boost/math/special_functions/ellint_rf.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "history/table.hpp"
#include "mdr/transforms.hpp"
#include "models/accuracy.hpp"
#include "models/mdr/grains.hpp"
#include "support/reference_case.hpp"

namespace monograin::mdr::contact_profile_test {
namespace {

using std::numbers::pi;
using Wide = boost::multiprecision::cpp_bin_float_50;

/// A contact of each kind, with its force.
struct Case {
  std::string name;
  ContactProfile profile;
  double force;
};

constexpr double k_modulus = 1.1;

std::vector<Case> cases() {
  std::vector<Case> result;
  for (const auto shape : {ElasticProfile::ellipse, ElasticProfile::parabola}) {
    const std::string name = shape == ElasticProfile::ellipse ? "ellipse" : "parabola";
    const Indenter indenter = elastic_indenter(shape, 1.05);
    for (const double overlap : {1e-6, 0.02, 0.4}) {
      const Contact contact = elastic_contact(shape, k_modulus, 1.05, overlap);
      result.push_back({"elastic " + name + " at " + std::to_string(overlap),
                        {indenter, k_modulus, contact.contact_radius, overlap},
                        contact.force});
      for (const double surface_energy : {1e-9, 1e-3}) {
        const PeelState peel = peel_state(indenter, {k_modulus, surface_energy}, contact.contact_radius);
        result.push_back({"peeling " + name + " at " + std::to_string(overlap),
                          {indenter, k_modulus, peel.contact_radius, peel.displacement_1d},
                          peel.force});
      }
      const double pulled = 0.7 * overlap;
      result.push_back({"sticking " + name + " at " + std::to_string(overlap),
                        {indenter, k_modulus, contact.contact_radius, pulled},
                        sticking_contact(elastic_image(shape, 1.05, pulled), k_modulus, contact.contact_radius).force});
    }
  }
  for (const Dent& dent : dents()) {
    const UnloadingShape shape = dent.shape();
    const double modulus = dent.material.composite_modulus;
    const std::string name = ::testing::PrintToString(dent.grain.modulus_over_yield) + ", largest overlap " +
                             ::testing::PrintToString(dent.overlap_max);
    result.push_back({"plastic E/Y = " + name,
                      {unloading_indenter(shape), modulus, shape.contact_radius_max, 0.5 * shape.height},
                      dent.plastic(dent.grain.radius, dent.overlap_max).force});
    for (const double u : {0.1, 0.6, 0.95}) {
      const Image image = unloading_image(shape, dent.overlap_at(u));
      const Contact contact = dent.unloading(dent.grain.radius, dent.overlap_max, dent.overlap_at(u));
      result.push_back({"unloading E/Y = " + name,
                        {image.indenter, modulus, contact.contact_radius, image.displacement_1d},
                        contact.force});
      const double a = shape.contact_radius_max * (1.0 - 0.2 * u);
      result.push_back({"sticking E/Y = " + name,
                        {image.indenter, modulus, a, image.displacement_1d},
                        sticking_contact(image, modulus, a).force});
    }
  }
  return result;
}

/// Largest force of a contact's springs without the pulled edge, and of the pull alone.
double force_scale(const ContactProfile& profile) {
  const double edge = profile.displacement_1d - profile_height(profile.indenter, profile.contact_radius);
  return free_force(profile.indenter, profile.composite_modulus, profile.contact_radius) +
         2.0 * profile.composite_modulus * profile.contact_radius * std::abs(edge);
}

TEST(MdrContactProfile, MeetsTheReferenceOfAnUnloadingContact) {
  const Table table = read_csv(test_file("models/mdr/reference/profiles_unloaded_EY50.csv"));
  const Grain grain{50.0, 0.3, 1.03};
  const Material material = grain.material();
  const UnloadingShape shape = unloading_shape(material, grain.radius, 0.25, -0.0127);
  const double overlap = 0.25 - 0.004;
  const Image image = unloading_image(shape, overlap);
  const ContactProfile profile{image.indenter, material.composite_modulus,
                               unloading_contact(shape, material.composite_modulus, overlap).contact_radius,
                               image.displacement_1d};
  const auto radii = table.column("r_over_R0");
  const auto compare = [&](const char* column, auto&& value, double end, double tolerance) {
    const auto expected = table.column(column);
    double scale = 0.0;
    for (const double e : expected) scale = std::max(scale, std::abs(e));
    for (std::size_t i = 0; i < radii.size() && radii[i] < end; ++i)
      EXPECT_NEAR(value(radii[i]), expected[i], tolerance * scale) << column << " at r = " << radii[i];
  };
  const double everywhere = 2.0;
  compare(
      "q1D_over_ER0", [&](double r) { return profile.line_load(r); }, everywhere, 1e-13);
  compare(
      "p3D_over_E", [&](double r) { return profile.pressure(r); }, everywhere, 1e-13);
  compare(
      "w3D_over_R0", [&](double r) { return profile.surface_displacement(r); }, everywhere, 1e-13);
  compare(
      "g3D_over_R0", [&](double r) { return profile.relaxed_height(r); }, shape.contact_radius_max, 1e-13);
}

TEST(MdrContactProfile, HasAPressureThatBearsTheForce) {
  for (const Case& c : cases()) {
    const double a = c.profile.contact_radius;
    // r = a sin(t): the inverse square root of a pulled edge becomes smooth.
    const double force = boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
        [&](double t) {
          return 2.0 * pi * a * a * std::sin(t) * std::cos(t) * c.profile.pressure_at_chord(a * std::cos(t));
        },
        0.0, 0.5 * pi, 10, 1e-13);
    EXPECT_NEAR(force, c.force, 2e-13 * force_scale(c.profile)) << c.name;
  }
}

TEST(MdrContactProfile, HasALineLoadThatBearsTheForce) {
  for (const Case& c : cases()) {
    const double a = c.profile.contact_radius;
    const double force =
        2.0 * a *
        boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
            [&](double t) { return c.profile.line_load(a * std::sin(t)) * std::cos(t); }, 0.0, 0.5 * pi, 10, 1e-13);
    EXPECT_NEAR(force, c.force, 2e-13 * force_scale(c.profile)) << c.name;
  }
}

TEST(MdrContactProfile, HasTheLineLoadOfItsPressureWithTheJumpAtTheEdge) {
  for (const Case& c : cases()) {
    const double a = c.profile.contact_radius;
    const double scale = force_scale(c.profile) / a;
    for (const double share : {0.0, 0.4, 0.9, 0.9999}) {
      const double load = line_load_1d(
          [&](double, double half_chord) { return c.profile.pressure_at_chord(half_chord); }, a, share * a);
      EXPECT_NEAR(load, c.profile.line_load(share * a), 2e-13 * scale) << c.name << ", x/a = " << share;
    }
    EXPECT_EQ(c.profile.line_load(1.0001 * a), 0.0) << c.name;
  }
}

TEST(MdrContactProfile, HasThePressureOfItsLineLoadAndJump) {
  for (const Case& c : cases()) {
    const double a = c.profile.contact_radius;
    const double scale = force_scale(c.profile) / (a * a);
    const Indenter& indenter = c.profile.indenter;
    const double b = indenter.half_width;
    const double tip = -0.5 * c.profile.composite_modulus * indenter.height / (b * b);
    const auto slope = [&](double x, double half_chord) {
      if (indenter.profile == ElasticProfile::parabola) return tip * x;
      return tip * x * b / std::hypot(half_chord, std::sqrt((b - a) * (b + a)));
    };
    for (const double share : {0.0, 0.4, 0.9, 0.9999}) {
      const double r = share * a;
      const double edge_factor = a / std::sqrt((a - r) * (a + r));
      EXPECT_NEAR(pressure_3d(slope, c.profile.line_load(a), a, r), c.profile.pressure(r), 4e-13 * scale * edge_factor)
          << c.name << ", r/a = " << share;
    }
  }
}

TEST(MdrContactProfile, HasTheSurfaceOfItsImage) {
  for (const Case& c : cases()) {
    const double a = c.profile.contact_radius;
    const double scale = force_scale(c.profile) / (a * c.profile.composite_modulus);
    const auto image = [&](double x) { return c.profile.image_displacement(x); };
    for (const double share : {0.0, 0.4, 0.9, 1.0, 1.0 + 1e-9, 1.01, 1.5, 2.5, 1e3}) {
      // The sine may be rounded above the contact radius, where the image is at rest.
      const auto inside = [&](double x) { return image(std::min(x, a)); };
      EXPECT_NEAR(displacement_3d(inside, a, share * a), c.profile.surface_displacement(share * a), 2e-13 * scale)
          << c.name << ", r/a = " << share;
    }
  }
}

TEST(MdrContactProfile, HasTheRelaxedHeightOfItsIndenter) {
  for (const Case& c : cases()) {
    const Indenter& indenter = c.profile.indenter;
    for (const double share : {1e-6, 0.1, 0.499, 0.501, 0.9, 1.0}) {
      const double r = share * indenter.half_width;
      const double expected = profile_3d([&](double x) { return profile_height(indenter, x); }, r);
      EXPECT_LE(relative_error(c.profile.relaxed_height(r), expected), 1e-13) << c.name << ", r/b = " << share;
    }
    EXPECT_EQ(c.profile.relaxed_height(0.0), 0.0) << c.name;
  }
}

TEST(MdrContactProfile, KeepsItsDigitsFromTheTipOfTheEllipseToItsEnd) {
  // A = 2, b = 1
  const Indenter indenter{ElasticProfile::ellipse, 2.0, 1.0};
  for (const double a : {1e-6, 1e-3, 0.1, 0.4999, 0.5, 0.5001, 0.8, 1.0 - 1e-9}) {
    const Wide exact_height = 1 - 2 / boost::math::constants::pi<Wide>() * boost::math::ellint_2(Wide(a));
    const ContactProfile free{indenter, 1.0, a, profile_height(indenter, a)};
    EXPECT_LE(relative_error(free.relaxed_height(a), static_cast<double>(exact_height)), 16 * k_epsilon) << "a = " << a;

    for (const double ratio : {1.0001, 2.0, 1e3}) {
      const double r = ratio * a;
      const Wide sine = Wide(a) / Wide(r);
      const Wide angle = asin(sine);
      const Wide cosine_square = 1 - sine * sine;
      const Wide delta_square = 1 - Wide(a) * Wide(a);
      const Wide second_kind =
          sine * boost::math::ellint_rf(cosine_square, delta_square, Wide(1)) -
          Wide(a) * Wide(a) * sine / 3 * boost::math::ellint_rd(cosine_square, delta_square, Wide(1));
      // The edge of a contact without adhesion is not pulled: delta_1D - A/2 = -sqrt(1 - a^2).
      const Wide exact = 2 / boost::math::constants::pi<Wide>() * (second_kind - angle * sqrt(delta_square));
      EXPECT_LE(relative_error(free.surface_displacement(r), static_cast<double>(exact)), 32 * k_epsilon)
          << "a = " << a << ", r/a = " << ratio;
    }
  }
}

TEST(MdrContactProfile, IsHertzForTheParabola) {
  constexpr double radius = 0.9, overlap = 0.03;
  const double a = std::sqrt(radius * overlap);
  const ContactProfile hertz{elastic_indenter(ElasticProfile::parabola, radius), k_modulus, a, overlap};
  const double largest = 2.0 * k_modulus * a / (pi * radius);
  EXPECT_LE(relative_error(hertz.pressure(0.0), largest), 16 * k_epsilon);
  EXPECT_LE(relative_error(hertz.pressure(0.6 * a), 0.8 * largest), 16 * k_epsilon);
  EXPECT_LE(relative_error(hertz.relaxed_height(0.6 * a), 0.18 * overlap), 16 * k_epsilon);
  EXPECT_LE(relative_error(hertz.surface_displacement(a), 0.5 * overlap), 16 * k_epsilon);
  EXPECT_EQ(hertz.surface_displacement(-0.5 * a), hertz.surface_displacement(0.5 * a));
  EXPECT_EQ(hertz.pressure(-0.5 * a), hertz.pressure(0.5 * a));
  EXPECT_EQ(hertz.pressure(a), 0.0);
}

TEST(MdrContactProfile, HasTheUniformYieldPressureAtTheLargestOverlap) {
  for (const Dent& dent : dents()) {
    const UnloadingShape shape = dent.shape();
    const ContactProfile plastic{unloading_indenter(shape), dent.material.composite_modulus, shape.contact_radius_max,
                                 0.5 * shape.height};
    for (const double share : {0.0, 0.5, 0.999999}) {
      EXPECT_LE(relative_error(plastic.pressure(share * shape.contact_radius_max), shape.pressure), 16 * k_epsilon)
          << dent << ", r/a = " << share;
    }
  }
}

TEST(MdrContactProfile, LooksLikeAPointLoadFromAfar) {
  for (const Case& c : cases()) {
    const double r = 1e7 * c.profile.contact_radius;
    const double scale = force_scale(c.profile);
    EXPECT_NEAR(c.profile.surface_displacement(r) * pi * c.profile.composite_modulus * r, c.force, 1e-13 * scale)
        << c.name;
  }
}

TEST(MdrContactProfile, EndsAtTheHalfWidthOfTheEllipse) {
  const ContactProfile profile{elastic_indenter(ElasticProfile::ellipse, 1.0), 1.0, 0.1, 0.01};
  EXPECT_TRUE(std::isfinite(profile.relaxed_height(1.0)));
  EXPECT_TRUE(std::isnan(profile.relaxed_height(1.0 + k_epsilon)));
  EXPECT_TRUE(std::isfinite(profile.surface_displacement(5.0)));
}

}  // namespace
}  // namespace monograin::mdr::contact_profile_test
