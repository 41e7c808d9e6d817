// Contacts of an elastic-plastic particle: independently computed values, derivatives, limits.

#include "cel/contact_law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cel/constants.hpp"
#include "elastic/hertz.hpp"
#include "elastic/sphere_influence.hpp"
#include "history/table.hpp"
#include "models/accuracy.hpp"

namespace monograin::cel::contact_law_test {
namespace {

using std::numbers::pi;
namespace k = constants;

Table reference(const std::string& file) {
  return read_csv(MONOGRAIN_SOURCE_DIR "/tests/models/cel/reference/" + file + ".csv");
}

const std::vector<Material>& materials() {
  static const std::vector<Material> all{{1.0 / 6.25, 0.0},  {1.0 / 6.25, 0.3}, {1.0 / 25.0, 0.3},
                                         {1.0 / 50.0, 0.49}, {1e-3, 0.2},       {1e-6, 0.3}};
  return all;
}

/// Dent radii over a_Y: just grown, in the middle of each part of the law, and large.
constexpr double k_growths[] = {1.001, 1.05, 1.3, 2.0, 4.0};

/// Dents of a material that are no larger than the particle.
std::vector<double> dents_of(const Material& material) {
  std::vector<double> dents;
  for (const double growth : k_growths) {
    if (const double zeta = growth * material.a_Y; zeta < 1.2) dents.push_back(zeta);
  }
  return dents;
}

/// Surroundings of a contact: support distance of the core under it, and coverage factor.
struct Surround_offs {
  double l, m;
};
constexpr Surround_offs k_surroundings[] = {{1.0, 1.0}, {0.7, 0.95}, {1.2, 1.3}};

/// Elastic displacements from a light touch to the limit force, and a little beyond.
std::vector<double> displacements_of(const Material& material, const Dent& dent, const Surround_offs& at) {
  const double H = contact_at(material, dent, at.l, at.m, 0.0).H;
  const double limit = contact_by(material, dent, at.l, at.m, H, true).u;
  return {1e-6 * limit, 0.03 * limit, 0.4 * limit, limit, 1.1 * limit};
}

/// Calls a check for every material, dent, surroundings and elastic displacement.
template <class Check>
void for_all_contacts(const Check& check) {
  for (const Material& material : materials()) {
    std::vector<double> dents = dents_of(material);
    dents.push_back(material.a_Y);
    for (const double zeta : dents) {
      const Dent dent = dent_of(material, zeta);
      for (const Surround_offs& at : k_surroundings) {
        for (const double u : displacements_of(material, dent, at)) {
          SCOPED_TRACE(::testing::Message() << "E/Y = " << 1.0 / material.Y << ", zeta/a_Y = " << zeta / material.a_Y
                                            << ", l = " << at.l << ", m = " << at.m << ", u = " << u);
          check(material, dent, at, u);
        }
      }
    }
  }
}

/// Compares a derivative with differences of its function over a small share of the length over which the function
/// changes.
template <class Function>
void expect_derivative(double derivative, const Function& function, double x, double length, const char* name) {
  constexpr double share = 5e-3;
  // Truncation error, and a few eps of the function over the share; x has the round-off of its own magnitude.
  const double tolerance = 4e-12 + 8.0 * k_epsilon / share * (x / length);
  const double difference = central_difference(function, x, share * length);
  EXPECT_LE(std::abs(derivative - difference), tolerance * (std::abs(derivative) + std::abs(function(x)) / length))
      << name << ": derivative = " << derivative << ", difference = " << difference << ", x = " << x;
}

// --- independently computed values

TEST(CelContactReference, IsMetWithItsComplexStepDerivatives) {
  const Table table = reference("point_values");
  ASSERT_EQ(table.row_count(), 20u);
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const auto value = [&](std::string_view column) { return table.at(row, *table.find(column)); };
    const Material material(1.0 / value("E_over_Y"), 0.3);
    const Dent dent = dent_of(material, value("zeta"));
    const Contact at_limit = contact_by(material, dent, 1.0, 1.0, contact_at(material, dent, 1.0, 1.0, 0.0).H, true);
    const auto expect = [&](std::string_view column, double actual) {
      // Next to yield the difference x = xi - xi_Y has lost six digits, which h and the derivatives inherit.
      const double lost = value("xi") / (value("xi") - material.xi_Y);
      EXPECT_LE(relative_error(actual, value(column)), std::max(1e-12, 4.0 * k_epsilon * lost))
          << column << " of row " << row << ": " << actual << " instead of " << value(column);
    };
    expect("xi", dent.zeta * material.xi_by_zeta);
    expect("h", dent.h);
    expect("dh_dzeta", dent.h_zeta);
    expect("p_over_Y", dent.p);
    expect("H", at_limit.H);
    expect("dH_dzeta", at_limit.H_by.zeta);
    expect("q", dent.q);
    expect("u_H", at_limit.u);
    // Along the limit force the displacement changes with the dent and with the force.
    expect("du_H_dzeta", at_limit.u_by.zeta + at_limit.u_by.coordinate * at_limit.H_by.zeta);
  }
}

TEST(CelInfluenceReference, IsMetBySelfTermAndNeighbours) {
  const Table table = reference("influence");
  ASSERT_EQ(table.row_count(), 117u);
  const auto nu = table.column("nu");
  const auto degrees = table.column("theta_deg");
  const auto g = table.column("g");
  int self_terms = 0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const auto inputs = ::testing::Message() << "nu = " << nu[row] << ", theta = " << degrees[row];
    if (degrees[row] == 0.0) {
      // The last term is part of the definition of the self term.
      EXPECT_NEAR(sphere_self_influence(nu[row], 0.2, 4000), g[row], 2e-12) << inputs;
      ++self_terms;
    } else {
      // The reference leaves out terms beyond the 4000th, which the program sums.
      EXPECT_NEAR(sphere_influence(nu[row], degrees[row] * pi / 180.0), g[row], 6e-9) << inputs;
    }
  }
  EXPECT_EQ(self_terms, 9);
}

// --- fresh surface and yield

TEST(CelDent, OfAFreshSurfaceIsNone) {
  for (const Material& material : materials()) {
    const Dent dent = dent_of(material, material.a_Y);
    // Johnson's parameter has its value at yield, up to round-off.
    EXPECT_NEAR(dent.h, 0.0, 1e-16 * material.a_Y * material.a_Y);
    EXPECT_LE(relative_error(dent.p, k::pY), 4 * k_epsilon);
    EXPECT_LE(relative_error(dent.q, 1.0 / 3.0), 4 * k_epsilon);
    EXPECT_LE(relative_error(dent.root_Gam, 1.0), 4 * k_epsilon);
    // The indentation grows at once, by its fourth-power term; the other term adds round-off only.
    const double round_off = 1e-14 * material.a_Y;
    EXPECT_LE(std::abs(dent.h_zeta - 2.0 * k::k1 * std::pow(material.a_Y, 3)), round_off);
  }
}

TEST(CelContact, OfAFreshSurfaceIsHertzs) {
  for (const Material& material : materials()) {
    const Dent dent = dent_of(material, material.a_Y);
    for (const double share : {1e-12, 1e-6, 0.01, 0.5, 1.0}) {
      const double u = share * material.a_Y * material.a_Y;
      const Contact contact = contact_at(material, dent, 1.0, 1.0, u);
      const double tolerance = 64 * k_epsilon;  // of logarithm and exponential
      EXPECT_LE(relative_error(contact.F, hertz_force(material.Es, 1.0, u)), tolerance) << u;
      EXPECT_LE(relative_error(std::sqrt(contact.area), hertz_contact_radius(1.0, u)), tolerance) << u;
      EXPECT_LE(relative_error(contact.stored, hertz_energy(material.Es, 1.0, u)), tolerance) << u;
    }
    // The limit force is reached where the dent is that of the fresh surface.
    const Contact at_yield = contact_at(material, dent, 1.0, 1.0, material.a_Y * material.a_Y);
    EXPECT_LE(std::abs(at_yield.F_over_H - 1.0), 16 * k_epsilon);
  }
}

TEST(CelContact, GoesOnFromHertzAtYieldWithoutAKink) {
  for (const Material& material : materials()) {
    // Force and area at the limit of a dent that has hardly grown, beside Hertz's contact of that radius.
    const auto difference_at = [&](double growth) {
      const double zeta = material.a_Y * (1.0 + growth);
      const Dent dent = dent_of(material, zeta);
      const Contact contact = contact_at(material, dent, 1.0, 1.0, 0.0);
      const double hertz = 4.0 / 3.0 * material.Es * std::pow(zeta, 3);
      return std::max(std::abs(contact.H / hertz - 1.0), std::abs(contact.alpha / (zeta * zeta) - 1.0));
    };
    // A jump would stay as the growth vanishes, and a kink would fall like it. The next term is of the power 3/2.
    EXPECT_LE(difference_at(0.0), 4 * k_epsilon);
    EXPECT_LE(difference_at(1e-4), 6.0 * std::pow(1e-4, 1.5));
    EXPECT_LE(difference_at(1e-6), 6.0 * std::pow(1e-6, 1.5));
    const Contact at_yield = contact_at(material, dent_of(material, material.a_Y), 1.0, 1.0, 0.0);
    // The slope goes like the square root of the excess over yield, which here is round-off.
    EXPECT_LE(relative_error(at_yield.H_by.zeta, 4.0 * material.Es * material.a_Y * material.a_Y), 5e-8);
  }
}

TEST(CelDent, GrowsInAllThatItSays) {
  for (const Material& material : materials()) {
    Dent before = dent_of(material, material.a_Y);
    for (double zeta = 1.01 * material.a_Y; zeta < 1.0; zeta *= 1.05) {
      const Dent dent = dent_of(material, zeta);
      EXPECT_GT(dent.h, before.h) << zeta;
      EXPECT_LE(dent.q, before.q) << zeta;
      EXPECT_GE(dent.root_Gam, before.root_Gam) << zeta;
      EXPECT_GT(dent.h_zeta, 0.0) << zeta;
      EXPECT_LE(dent.p, k::pinf) << zeta;
      EXPECT_GE(dent.p, k::pY) << zeta;
      before = dent;
    }
  }
}

TEST(CelDent, OfAHalfSpaceHasTheFullyPlasticPressure) {
  // A displacement that is small against the particle and large against the elastic strain.
  const Material material(1e-12, 0.3);
  const Dent dent = dent_of(material, 1e-4);
  EXPECT_NEAR(dent.p, k::pinf, 3e-3);
  EXPECT_NEAR(dent.h / (dent.zeta * dent.zeta), k::k0, 1e-3);
}

// --- derivatives

TEST(CelDent, HasTheDerivativesOfItsQuantities) {
  for (const Material& material : materials()) {
    for (const double zeta : dents_of(material)) {
      SCOPED_TRACE(::testing::Message() << "E/Y = " << 1.0 / material.Y);
      const Dent dent = dent_of(material, zeta);
      const auto expect = [&](double Dent::*value, double Dent::*slope, const char* name) {
        expect_derivative(
            dent.*slope, [&](double x) { return dent_of(material, x).*value; }, zeta, zeta - material.a_Y, name);
      };
      expect(&Dent::h, &Dent::h_zeta, "h");
      expect(&Dent::p, &Dent::p_zeta, "p");
      expect(&Dent::q, &Dent::q_zeta, "q");
      expect(&Dent::root_Gam, &Dent::root_Gam_zeta, "root of Gam");
    }
  }
}

/// Compares the slopes of a quantity of a contact with respect to its dent, its surroundings and its own coordinate.
template <class Make>
void expect_slopes(const Make& make, double Contact::*value, const Slopes& by, const Material& material,
                   const Dent& dent, const Surround_offs& at, double coordinate, const char* name) {
  SCOPED_TRACE(name);
  const double zeta = dent.zeta;
  expect_derivative(
      by.coordinate, [&](double x) { return make(dent, at.l, at.m, x).*value; }, coordinate, coordinate,
      "by its coordinate");
  expect_derivative(
      by.l, [&](double x) { return make(dent, x, at.m, coordinate).*value; }, at.l, at.l, "by l");
  expect_derivative(
      by.m, [&](double x) { return make(dent, at.l, x, coordinate).*value; }, at.m, at.m, "by m");
  if (zeta <= material.a_Y) return;  // a fresh surface has no dent below its own
  expect_derivative(
      by.zeta, [&](double x) { return make(dent_of(material, x), at.l, at.m, coordinate).*value; }, zeta,
      zeta - material.a_Y, "by zeta");
}

TEST(CelContact, HasTheDerivativesOfItsQuantities) {
  for_all_contacts([](const Material& material, const Dent& dent, const Surround_offs& at, double u) {
    const auto by_displacement = [&](const Dent& d, double l, double m, double x) {
      return contact_at(material, d, l, m, x);
    };
    const Contact contact = by_displacement(dent, at.l, at.m, u);
    expect_slopes(by_displacement, &Contact::F, contact.F_by, material, dent, at, u, "F");
    expect_slopes(by_displacement, &Contact::H, contact.H_by, material, dent, at, u, "H");
    expect_slopes(by_displacement, &Contact::alpha, contact.alpha_by, material, dent, at, u, "alpha");
    EXPECT_EQ(contact.u_by.coordinate, 1.0);

    const auto by_force = [&](const Dent& d, double l, double m, double x) {
      return contact_by(material, d, l, m, x, true);
    };
    const Contact under = by_force(dent, at.l, at.m, contact.F);
    expect_slopes(by_force, &Contact::u, under.u_by, material, dent, at, contact.F, "u");
    expect_slopes(by_force, &Contact::H, under.H_by, material, dent, at, contact.F, "H under a force");
    EXPECT_EQ(under.F_by.coordinate, 1.0);
  });
}

// --- the elastic law

TEST(CelContact, HasTheStiffnessOfAFlatPunchOfItsArea) {
  for_all_contacts([](const Material& material, const Dent& dent, const Surround_offs& at, double u) {
    const Contact contact = contact_at(material, dent, at.l, at.m, u);
    EXPECT_LE(relative_error(contact.F_by.coordinate, 2.0 * material.Es * std::sqrt(contact.area)), 1e-13);
  });
}

TEST(CelContact, HasItsLimitAreaAtItsLimitForce) {
  for_all_contacts([](const Material& material, const Dent& dent, const Surround_offs& at, double) {
    const double H = contact_at(material, dent, at.l, at.m, 0.0).H;
    const Contact contact = contact_by(material, dent, at.l, at.m, H, true);
    EXPECT_EQ(contact.F_over_H, 1.0);
    EXPECT_LE(relative_error(contact.area, contact.alpha), 4 * k_epsilon);
    EXPECT_LE(relative_error(contact.alpha, std::sqrt(at.m) * std::pow(dent.zeta / at.l, 2)), 8 * k_epsilon);
    EXPECT_LE(relative_error(H, pi * material.Y * dent.p * at.m * std::pow(dent.zeta / at.l, 2)), 8 * k_epsilon);
  });
}

TEST(CelContact, UnderAForceIsThatAtItsDisplacement) {
  for_all_contacts([](const Material& material, const Dent& dent, const Surround_offs& at, double u) {
    const Contact contact = contact_at(material, dent, at.l, at.m, u);
    const Contact under = contact_by(material, dent, at.l, at.m, contact.F, true);
    EXPECT_LE(relative_error(under.u, u), 1e-14);
    EXPECT_LE(relative_error(under.area, contact.area), 1e-14);
    EXPECT_LE(relative_error(under.stored, contact.stored), 1e-14);
    EXPECT_LE(relative_error(under.F_over_H, contact.F_over_H), 1e-14);
    // The slopes of the inverse.
    EXPECT_LE(relative_error(under.u_by.coordinate * contact.F_by.coordinate, 1.0), 1e-13);
    EXPECT_LE(std::abs(under.u_by.l + contact.F_by.l / contact.F_by.coordinate), 1e-13 * u / at.l);
    EXPECT_LE(std::abs(under.u_by.m + contact.F_by.m / contact.F_by.coordinate), 1e-13 * u / at.m);
  });
}

TEST(CelContact, StoresTheWorkOfItsForce) {
  for_all_contacts([](const Material& material, const Dent& dent, const Surround_offs& at, double u) {
    expect_derivative(
        contact_at(material, dent, at.l, at.m, u).F,
        [&](double x) { return contact_at(material, dent, at.l, at.m, x).stored; }, u, u, "stored energy");
  });
}

TEST(CelContact, IsAGapBelowFirstTouch) {
  const Material& material = materials()[2];
  const Dent dent = dent_of(material, 2.0 * material.a_Y);
  for (const double u : {-0.3, -1e-12, 0.0}) {
    const Contact contact = contact_at(material, dent, 0.9, 0.95, u);
    EXPECT_EQ(contact.u, u);
    EXPECT_EQ(contact.F, 0.0);
    EXPECT_EQ(contact.area, 0.0);
    EXPECT_EQ(contact.stored, 0.0);
    EXPECT_EQ(contact.F_over_H, 0.0);
    EXPECT_EQ(contact.F_by.coordinate, 0.0);
    EXPECT_EQ(contact.F_by.zeta, 0.0);
    EXPECT_GT(contact.H, 0.0);
  }
  const Contact idle = contact_by(material, dent, 0.9, 0.95, 0.0, true);
  EXPECT_EQ(idle.u, 0.0);
  EXPECT_EQ(idle.area, 0.0);
}

// --- coverage and core

TEST(CelCoverage, HasTheDerivativesOfItsFactors) {
  EXPECT_EQ(coverage_of(0.0).m, 1.0);
  EXPECT_EQ(coverage_of(0.0).shade, 1.0);
  for (const double Om : {0.1, 0.7, 1.5}) {
    const Coverage at = coverage_of(Om);
    const double m_Om = central_difference([](double x) { return coverage_of(x).m; }, Om, 1e-3);
    const double shade_Om = central_difference([](double x) { return coverage_of(x).shade; }, Om, 1e-3);
    EXPECT_NEAR(at.m_Om, m_Om, 1e-11) << Om;
    EXPECT_NEAR(at.shade_Om, shade_Om, 1e-11) << Om;
  }
}

TEST(CelAdvance, IsSmoothFromShrinkingToBulging) {
  EXPECT_EQ(advance_of(0.0).c, 0.0);
  for (const double l : {0.5, 0.95, 0.98, 0.995, 1.0, 1.002, 1.01, 1.05, 1.4}) {
    // The slope changes over the width w of the law, from where differences take their length.
    const double step = 1e-3 * std::hypot(l - 1.0, k::w);
    const Advance advance = advance_of(l - 1.0);
    const double slope = central_difference([](double x) { return advance_of(x - 1.0).c; }, l, step);
    const double curvature = central_difference([](double x) { return advance_of(x - 1.0).c_l; }, l, step);
    EXPECT_NEAR(advance.c_l, slope, 4 * k_epsilon / step) << l;
    EXPECT_NEAR(advance.c_ll, curvature, 8 * k_epsilon / step) << l;
  }
}

TEST(CelAdvance, IsAsFarAsTheCoreShrinksAndFurtherThanItBulges) {
  // Far from the change of slope the result differs only by its width.
  EXPECT_NEAR(advance_of(-0.5).c_l, -1.0, 1e-4);
  EXPECT_NEAR(advance_of(0.5).c_l, -k::chi, 1e-4);
  EXPECT_EQ(advance_of(0.0).c_l, -0.5 * (1.0 + k::chi));
}

// --- influence of contacts on each other

std::vector<ContactClass> single_walls(const std::vector<Eigen::Vector3d>& normals) {
  std::vector<ContactClass> classes;
  for (const Eigen::Vector3d& normal : normals) classes.push_back({.name = "wall", .normals = {normal.normalized()}});
  return classes;
}

TEST(CelCoupling, IsSymmetricAndThatOfTheSphereOnAFreshSurface) {
  const double nu = 0.3;
  const std::vector<ContactClass> classes = single_walls({{0, 0, 1}, {0, 0, -1}, {1, 0, 0.3}});
  const std::vector<Coupling> couplings = couplings_of(nu, classes);
  ASSERT_EQ(couplings.size(), 9u);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_LE(relative_error(couplings[3 * i + j].G(1.1, 0.9), couplings[3 * j + i].G(1.1, 0.9)), 1e-14);
      if (i == j) continue;
      const double theta = angle_between(classes[i].normals[0], classes[j].normals[0]);
      EXPECT_LE(relative_error(couplings[3 * i + j].G(1.0, 1.0), sphere_influence(nu, theta)), 1e-13);
    }
    EXPECT_GT(couplings[4 * i].G(1.0, 1.0), 0.0);
    // Coverage takes from neighbours only, dents add to walls that are parallel only.
    EXPECT_NEAR(couplings[4 * i].by_shade(1.0), 0.0, 1e-15);
  }
}

TEST(CelCoupling, HasItsDerivatives) {
  for (const Coupling& at : couplings_of(0.2, single_walls({{0, 0, 1}, {1, 0, 0.3}, {1, 1, -1}}))) {
    const double by_root = central_difference([&](double x) { return at.G(x, 0.8); }, 1.3, 0.1);
    const double by_shade = central_difference([&](double x) { return at.G(1.3, x); }, 0.8, 0.1);
    EXPECT_NEAR(at.by_root(0.8), by_root, 1e-14);
    EXPECT_NEAR(at.by_shade(1.3), by_shade, 1e-14);
  }
}

}  // namespace
}  // namespace monograin::cel::contact_law_test
