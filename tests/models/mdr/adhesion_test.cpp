// The adhesive contact law by itself: critical states, equilibrium of the edge, forces, derivatives and energies.

#include "mdr/adhesion.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "elastic/hertz.hpp"
#include "models/accuracy.hpp"
#include "models/mdr/grains.hpp"

namespace monograin::mdr::adhesion_test {
namespace {

using std::numbers::pi;

constexpr double k_modulus = 1.3;
constexpr double k_round_off = 16 * k_epsilon;  // a formula of some ten operations without cancellation
constexpr double k_shares[] = {0.003, 0.03, 0.3, 0.7, 0.97};

// --- contacts on which the law is tested

/// An adhesive contact below its largest overlap: its image over radius, largest overlap and overlap.
struct Bond {
  std::string name;
  double modulus;         ///< E*
  double surface_energy;  ///< dg
  double radius;
  double overlap_max;    ///< an elastic contact does not know it
  double max_length;     ///< over which things change with the largest overlap; 0: not at all
  double radius_length;  ///< and with the radius
  std::function<Image(double radius, double overlap_max, double overlap)> image_of;
  std::function<double(double displacement_1d)> overlap_at;

  [[nodiscard]] Image image(double overlap) const { return image_of(radius, overlap_max, overlap); }
  [[nodiscard]] Indenter indenter() const { return image(0.0).indenter; }
  [[nodiscard]] double critical(Control control = Control::displacement) const {
    return critical_radius(indenter(), {modulus, surface_energy}, control);
  }
  [[nodiscard]] PeelState peel(double a) const { return peel_state(indenter(), {modulus, surface_energy}, a); }
  [[nodiscard]] double stretch(double a) const { return critical_stretch({modulus, surface_energy}, a); }
  /// Contact radius between the critical one and the end of the profile, or ten times the critical one.
  [[nodiscard]] double between(double share) const {
    const Indenter shape = indenter();
    const double last = shape.profile == ElasticProfile::parabola
                            ? 10.0 * std::max(critical(Control::force), 0.01 * shape.half_width)
                            : shape.half_width;
    return std::lerp(critical(), last, share);
  }
  /// g(a) + Dl(a), 2 E* int g + 2 E* a Dl: of what displacements and forces of an edge are the difference.
  [[nodiscard]] double length_scale(double a) const { return profile_height(indenter(), a) + stretch(a); }
  [[nodiscard]] double force_scale(double a) const {
    return free_force(indenter(), modulus, a) + 2.0 * modulus * a * length_scale(a);
  }
  [[nodiscard]] Contact sticking(double r, double m, double overlap, double a) const {
    return sticking_contact(image_of(r, m, overlap), modulus, a);
  }
  [[nodiscard]] Contact peeling(double r, double m, double overlap) const {
    const Image at = image_of(r, m, overlap);
    return peeling_contact(at, {modulus, surface_energy},
                           critical_radius(at.indenter, {modulus, surface_energy}, Control::displacement));
  }
  [[nodiscard]] double energy(double overlap, double a) const {
    return adhesive_energy(image(overlap), {modulus, surface_energy}, a);
  }
};

std::ostream& operator<<(std::ostream& out, const Bond& bond) { return out << bond.name; }

/// Surface energy of a given strength: (pi/2) (dg/E*) (B/A)^2 / b, the cube of the critical radius over the half width
/// while that is small.
double surface_energy_of(double strength, const Indenter& indenter, double modulus) {
  const double flatness = 2.0 * indenter.half_width / indenter.height;
  return strength * indenter.half_width * 2.0 * modulus / (pi * flatness * flatness);
}

constexpr double k_strengths[] = {1e-15, 1e-9, 1e-5, 1e-2, 1.0, 1e3};

std::vector<Bond> elastic_bonds() {
  std::vector<Bond> result;
  for (const auto profile : {ElasticProfile::ellipse, ElasticProfile::parabola}) {
    const bool is_ellipse = profile == ElasticProfile::ellipse;
    for (const double strength : k_strengths) {
      for (const double radius : {1.0, 1.1}) {
        const Indenter indenter = elastic_indenter(profile, radius);
        result.push_back({.name = std::string("elastic ") + (is_ellipse ? "ellipse" : "parabola") +
                                  ", R = " + std::to_string(radius) + ", strength = " + std::to_string(strength),
                          .modulus = k_modulus,
                          .surface_energy = surface_energy_of(strength, indenter, k_modulus),
                          .radius = radius,
                          .overlap_max = 0.0,
                          .max_length = 0.0,
                          .radius_length = radius,
                          .image_of = [=](double R, double, double delta) { return elastic_image(profile, R, delta); },
                          .overlap_at = [](double displacement_1d) { return displacement_1d; }});
      }
    }
  }
  return result;
}

std::vector<Bond> plastic_bonds() {
  std::vector<Bond> result;
  for (const Dent& dent : dents()) {
    const UnloadingShape shape = dent.shape();
    const double modulus = dent.material.composite_modulus;
    const double area = shape.contact_radius_max * shape.contact_radius_max;
    for (const double strength : k_strengths) {
      std::ostringstream name;
      name << dent << ", strength = " << strength;
      result.push_back(
          {.name = name.str(),
           .modulus = modulus,
           .surface_energy = surface_energy_of(strength, unloading_indenter(shape), modulus),
           .radius = dent.grain.radius,
           .overlap_max = dent.overlap_max,
           .max_length = area / (2.0 * dent.grain.radius),
           .radius_length = area / (2.0 * dent.overlap_max),
           .image_of = [=](double R, double m, double delta) { return unloading_image(dent.shape_of(R, m), delta); },
           .overlap_at = [=](double d) { return overlap_at(shape, d); }});
    }
  }
  return result;
}

std::vector<Bond> bonds() {
  std::vector<Bond> result = elastic_bonds();
  std::ranges::move(plastic_bonds(), std::back_inserter(result));
  return result;
}

// --- critical states

TEST(MdrAdhesionOfTheParabola, PullsOffAsJkr) {
  for (const double radius : {1.0, 1.1}) {
    for (const double ratio : {1e-14, 1e-9, 1e-5, 1e-2, 1.0, 1e6}) {  // dg/(E* R)
      const double dg = ratio * k_modulus * radius;
      const Indenter indenter = elastic_indenter(ElasticProfile::parabola, radius);
      const auto state = [&](Control control) {
        return peel_state(indenter, {k_modulus, dg}, critical_radius(indenter, {k_modulus, dg}, control));
      };
      const PeelState by_displacement = state(Control::displacement);
      const PeelState by_force = state(Control::force);
      const double cube = pi * dg / k_modulus * (pi * dg / k_modulus) * radius;
      // 1e-15 measured, each
      EXPECT_LE(relative_error(by_displacement.force, -5.0 / 6.0 * pi * dg * radius), 1e-14) << "dg/E*R = " << ratio;
      EXPECT_LE(relative_error(by_displacement.displacement_1d, -0.75 * std::cbrt(cube)), 1e-14)
          << "dg/E*R = " << ratio;
      EXPECT_LE(relative_error(by_force.force, -1.5 * pi * dg * radius), 1e-14) << "dg/E*R = " << ratio;
      EXPECT_LE(relative_error(by_force.contact_radius, std::cbrt(9.0 * pi * dg * radius * radius / (8.0 * k_modulus))),
                1e-14)
          << "dg/E*R = " << ratio;
    }
  }
}

/// Pull-off force of the elastic ellipse over pi dg R.
double ellipse_pull_off(double modulus, double surface_energy, Control control) {
  const Indenter indenter = elastic_indenter(ElasticProfile::ellipse, 1.0);
  const double a = critical_radius(indenter, {modulus, surface_energy}, control);
  return peel_state(indenter, {modulus, surface_energy}, a).force / (pi * surface_energy);
}

TEST(MdrAdhesionOfTheEllipse, PullsOffAtThePrintedForces) {
  const double modulus = composite_modulus(1.0, 0.3);
  EXPECT_NEAR(ellipse_pull_off(modulus, 1e-5, Control::displacement), -0.83324, 5e-6);  // five printed digits
  EXPECT_NEAR(ellipse_pull_off(modulus, 1e-5, Control::force), -1.49955, 5e-6);
}

TEST(MdrAdhesionOfTheEllipse, ApproachesJkrWithTheSquareOfTheCriticalRadius) {
  for (const auto& [control, limit] : {std::pair(Control::displacement, -5.0 / 6.0), std::pair(Control::force, -1.5)}) {
    const auto difference = [&, control = control, limit = limit](int decade) {
      return ellipse_pull_off(1.0, std::pow(10.0, -decade), control) - limit;
    };
    // At the last decade the relative difference is 4e-10, and round-off 1e-6 of it.
    for (int decade = 3; decade < 13; ++decade) {
      const double order = std::log10(difference(decade) / difference(decade + 1));
      // a_c^2 goes with dg^(2/3); the next term is smaller by another a_c^2.
      const double next = std::pow(10.0, -2.0 / 3.0 * decade);
      EXPECT_NEAR(order, 2.0 / 3.0, next + 1e-5) << "dg/E*R = 1e-" << decade;
    }
  }
}

TEST(MdrAdhesionCriticalRadius, IsWhereTheProfileIsAsSteepAsTheStretchTimesTheControlFactor) {
  for (const Bond& bond : bonds()) {
    const Indenter indenter = bond.indenter();
    for (const auto& [control, xi] : {std::pair(Control::displacement, 1.0), std::pair(Control::force, 3.0)}) {
      const double a = bond.critical(control);
      const double room = indenter.profile == ElasticProfile::parabola ? a : std::min(a, indenter.half_width - a);
      const double step = 0.005 * room;
      const double g = central_difference([&](double x) { return profile_height(indenter, x); }, a, step);
      const double dl = central_difference([&](double x) { return bond.stretch(x); }, a, step);
      // Round-off over the step; near the end of the profile also the round-off of a over its distance from the end.
      const double tolerance = 1e-12 + 1000.0 * k_epsilon * indenter.half_width / room;
      EXPECT_LE(relative_error(g, xi * dl), tolerance)
          << bond << ", xi = " << xi << ", a/b = " << a / indenter.half_width;
    }
  }
}

TEST(MdrAdhesionCriticalRadius, IsTheRootOfTheCubic) {
  for (const Bond& bond : bonds()) {
    const Indenter indenter = bond.indenter();
    const double b = indenter.half_width;
    for (const auto& [control, xi] : {std::pair(Control::displacement, 1.0), std::pair(Control::force, 3.0)}) {
      const double a = bond.critical(control);
      const double flatness = 2.0 * b / indenter.height;
      const double k = xi * xi * pi * bond.surface_energy / (2.0 * bond.modulus) * flatness * flatness;
      const double square = indenter.profile == ElasticProfile::parabola ? b * b : (b - a) * (b + a);
      // The root is as accurate as the round-off of a leaves b - a.
      EXPECT_LE(relative_error(a * a * a, k * square), k_round_off * (1.0 + a / std::max(b - a, k_epsilon * b)))
          << bond << ", xi = " << xi;
      EXPECT_GT(a, 0.0) << bond;
      if (indenter.profile == ElasticProfile::ellipse) {
        EXPECT_LT(a, b) << bond;
      }
    }
    EXPECT_LT(bond.critical(Control::displacement), bond.critical(Control::force)) << bond;
  }
}

TEST(MdrAdhesionCriticalRadius, IsWhereTheEdgesForceOrDisplacementIsLeast) {
  for (const Bond& bond : bonds()) {
    const double by_displacement = bond.critical(Control::displacement);
    const double by_force = bond.critical(Control::force);
    for (const double factor : {0.97, 1.03}) {
      const bool is_parabola = bond.indenter().profile == ElasticProfile::parabola;
      const auto beside = [&](double a) {
        const double room = is_parabola ? a : std::min(a, bond.indenter().half_width - a);
        return a + (factor - 1.0) * room;
      };
      EXPECT_GT(bond.peel(beside(by_displacement)).displacement_1d, bond.peel(by_displacement).displacement_1d) << bond;
      EXPECT_GT(bond.peel(beside(by_force)).force, bond.peel(by_force).force) << bond;
    }
  }
}

// --- equilibrium of the edge

/// Expects a radius computed back from a function of the edge. It is exact to the function's round-off over its slope;
/// at the critical state, where the slope is zero, to the square root of that round-off.
void expect_same_edge(const Bond& bond, double a, double back, double scale, double slope, double bend) {
  const double round_off = 8.0 * k_epsilon * scale;
  const double by_slope = round_off / std::max(slope, 1e-300);
  const double by_bend = std::sqrt(2.0 * round_off / bend);
  EXPECT_LE(std::abs(back - a), 2.0 * std::min(by_slope, by_bend) + 4.0 * k_epsilon * a)
      << bond << ", a = " << a << ", back = " << back << ", a/b = " << a / bond.indenter().half_width;
}

TEST(MdrPeelAtDisplacement, BringsBackTheEdge) {
  for (const Bond& bond : bonds()) {
    const Indenter indenter = bond.indenter();
    const double critical = bond.critical();
    for (const double share : {0.0, 1e-12, 1e-9, 1e-6, 1e-4, 0.01, 0.1, 0.3, 0.5, 0.9, 0.99, 1.0 - 1e-6, 1.0}) {
      const double a = bond.between(share);
      const PeelState state = bond.peel(a);
      const PeelState back =
          peel_at_displacement(indenter, {bond.modulus, bond.surface_energy}, critical, state.displacement_1d);
      // The displacement comes back to round-off, however flat or steep it is at the edge.
      EXPECT_LE(std::abs(back.displacement_1d - state.displacement_1d), 8.0 * k_epsilon * bond.length_scale(a))
          << bond << ", share = " << share;
      EXPECT_GE(back.contact_radius, critical * (1.0 - 2.0 * k_epsilon)) << bond << ", share = " << share;
      // g' - Dl' from the critical state on, with the bend of Dl alone.
      const double stretch_slope = 0.5 * bond.stretch(a) / a;
      const double slope =
          indenter.profile == ElasticProfile::parabola
              ? 2.0 * profile_height(indenter, a) / a - stretch_slope
              : 0.5 * indenter.height / indenter.half_width * (a / indenter.half_width) /
                        std::sqrt(std::max(1e-300, (1.0 - a / indenter.half_width) * (1.0 + a / indenter.half_width))) -
                    stretch_slope;
      expect_same_edge(bond, a, back.contact_radius, bond.length_scale(a), slope, 0.5 * stretch_slope / a);
    }
  }
}

TEST(MdrPeelAtForce, BringsBackTheEdge) {
  for (const Bond& bond : bonds()) {
    const Indenter indenter = bond.indenter();
    const double critical = bond.critical(Control::force);
    for (const double share : {0.0, 1e-12, 1e-9, 1e-6, 1e-4, 0.01, 0.1, 0.3, 0.5, 0.9, 0.99, 1.0 - 1e-6, 1.0}) {
      const double a = std::lerp(critical, std::max(critical, bond.between(1.0)), share);
      const PeelState state = bond.peel(a);
      const PeelState back = peel_at_force(indenter, {bond.modulus, bond.surface_energy}, critical, state.force);
      EXPECT_LE(std::abs(back.force - state.force), 8.0 * k_epsilon * bond.force_scale(a))
          << bond << ", share = " << share;
      EXPECT_GE(back.contact_radius, critical * (1.0 - 2.0 * k_epsilon)) << bond << ", share = " << share;
      EXPECT_LE(std::abs(back.displacement_1d - bond.peel(back.contact_radius).displacement_1d),
                1e-7 * bond.length_scale(a))
          << bond << ", share = " << share;
    }
  }
}

TEST(MdrPeel, StaysAtTheCriticalEdgeBelow) {
  for (const Bond& bond : bonds()) {
    const Indenter indenter = bond.indenter();
    const double by_displacement = bond.critical(Control::displacement);
    const double by_force = bond.critical(Control::force);
    const PeelState least = bond.peel(by_displacement);
    const PeelState weakest = bond.peel(by_force);
    for (const double further : {0.0, 1e-15, 1e-3, 1.0, 1e6}) {
      const PeelState torn = peel_at_displacement(indenter, {bond.modulus, bond.surface_energy}, by_displacement,
                                                  least.displacement_1d - further * std::abs(least.displacement_1d));
      EXPECT_EQ(torn.contact_radius, by_displacement) << bond;
      EXPECT_EQ(torn.force, least.force) << bond;
      const PeelState lost = peel_at_force(indenter, {bond.modulus, bond.surface_energy}, by_force,
                                           weakest.force - further * std::abs(weakest.force));
      EXPECT_EQ(lost.contact_radius, by_force) << bond;
      EXPECT_EQ(lost.displacement_1d, weakest.displacement_1d) << bond;
    }
  }
}

TEST(MdrFreeContactRadius, IsWhereTheProfileIsAsHighAsTheDisplacement) {
  for (const Bond& bond : bonds()) {
    const Indenter indenter = bond.indenter();
    for (const double share : {1e-12, 1e-6, 0.01, 0.5, 0.999}) {
      const double d = share * 0.5 * indenter.height;
      // Near the end of the profile the round-off of a is magnified.
      EXPECT_LE(relative_error(profile_height(indenter, free_contact_radius(indenter, d)), d),
                k_round_off / (1.0 - share))
          << bond << ", share = " << share;
    }
    EXPECT_EQ(free_contact_radius(indenter, 0.0), 0.0);
    EXPECT_EQ(free_contact_radius(indenter, -0.1), 0.0);
    if (indenter.profile == ElasticProfile::ellipse) {
      EXPECT_EQ(free_contact_radius(indenter, indenter.height), indenter.half_width);
    }
  }
}

// --- derivatives

/// @param scale  magnitude of the function's terms
template <class Function>
void expect_derivative(double derivative, Function&& function, double x, double length, double scale) {
  constexpr double share = 5e-3;
  constexpr double tolerance = 4e-12;  // rounding: some hundred eps of the function over the share
  const double difference = central_difference(function, x, share * length);
  EXPECT_LE(std::abs(derivative - difference), tolerance * (std::abs(derivative) + scale / length))
      << "derivative = " << derivative << ", difference = " << difference << ", x = " << x << ", length = " << length;
}

TEST(MdrStickingContact, HasTheDerivativesOfItsForce) {
  for (const Bond& bond : bonds()) {
    const double b = bond.indenter().half_width;
    for (const double share : k_shares) {
      const double a = bond.between(share);
      const double room = bond.indenter().profile == ElasticProfile::parabola ? 1.0 : 1.0 - a / b;
      for (const double part : {0.0, 0.4, 1.0}) {  // from where the edge follows to where it peels
        SCOPED_TRACE(::testing::Message() << bond << ", a/b = " << a / b << ", part = " << part);
        const double overlap = bond.overlap_at(profile_height(bond.indenter(), a) - part * bond.stretch(a));
        const Contact contact = bond.sticking(bond.radius, bond.overlap_max, overlap, a);
        EXPECT_EQ(contact.contact_radius, a);
        const double scale = bond.force_scale(a);
        const double length = bond.length_scale(a) / bond.image(overlap).by_overlap;
        // Round-off of the displacement, a difference of overlaps, magnified by the slope.
        const double noise = scale + contact.by_overlap * (std::abs(overlap) + bond.overlap_max);
        expect_derivative(
            contact.by_overlap, [&](double x) { return bond.sticking(bond.radius, bond.overlap_max, x, a).force; },
            overlap, length, noise);
        expect_derivative(
            contact.by_radius, [&](double x) { return bond.sticking(x, bond.overlap_max, overlap, a).force; },
            bond.radius, room * bond.radius_length, noise);
        if (bond.max_length == 0.0) {
          EXPECT_EQ(contact.by_overlap_max, 0.0);
          continue;
        }
        expect_derivative(
            contact.by_overlap_max, [&](double x) { return bond.sticking(bond.radius, x, overlap, a).force; },
            bond.overlap_max, room * bond.max_length, noise);
      }
    }
  }
}

TEST(MdrPeelingContact, HasTheDerivativesOfItsForce) {
  for (const Bond& bond : bonds()) {
    const PeelState critical = bond.peel(bond.critical());
    for (const double share : k_shares) {
      const double a = bond.between(share);
      const PeelState state = bond.peel(a);
      SCOPED_TRACE(::testing::Message() << bond << ", share = " << share);
      const double overlap = bond.overlap_at(state.displacement_1d);
      const Contact contact = bond.peeling(bond.radius, bond.overlap_max, overlap);
      const double opening = bond.image(overlap).by_overlap;
      // Distances to the critical state and to the end of the profile.
      const Indenter indenter = bond.indenter();
      double room = state.displacement_1d - critical.displacement_1d;
      if (indenter.profile == ElasticProfile::ellipse) {
        room = std::min(room, bond.peel(indenter.half_width).displacement_1d - state.displacement_1d);
      }
      const double noise = bond.force_scale(a) + std::abs(contact.by_overlap) * (std::abs(overlap) + bond.overlap_max);
      expect_derivative(
          contact.by_overlap, [&](double x) { return bond.peeling(bond.radius, bond.overlap_max, x).force; }, overlap,
          room / opening, noise);
      const double softening =
          peeling_softening(bond.image(overlap), {bond.modulus, bond.surface_energy}, contact.contact_radius);
      const double noise_of_stiffness =
          noise / (std::abs(overlap) + bond.overlap_max) + std::abs(softening) * (std::abs(overlap) + bond.overlap_max);
      expect_derivative(
          softening, [&](double x) { return bond.peeling(bond.radius, bond.overlap_max, x).by_overlap; }, overlap,
          room / opening, noise_of_stiffness);
      // The share of that room which a unit of the other variables uses up: the displacement and the profile there.
      const auto length_of = [&](const Image::Change& change, double length) {
        const double speed =
            std::abs(change.displacement_1d) + std::max(indenter.height, profile_height(indenter, a)) *
                                                   (std::abs(change.height) + std::abs(change.half_width));
        return std::min(length, room / speed);
      };
      const Image image = bond.image(overlap);
      expect_derivative(
          contact.by_radius, [&](double x) { return bond.peeling(x, bond.overlap_max, overlap).force; }, bond.radius,
          length_of(image.by_radius, bond.radius_length), noise);
      if (bond.max_length == 0.0) {
        EXPECT_EQ(contact.by_overlap_max, 0.0);
        continue;
      }
      expect_derivative(
          contact.by_overlap_max, [&](double x) { return bond.peeling(bond.radius, x, overlap).force; },
          bond.overlap_max, length_of(image.by_overlap_max, bond.max_length), noise);
    }
  }
}

TEST(MdrPeelingContact, SoftensWithoutBoundTowardsPullOff) {
  for (const Bond& bond : bonds()) {
    const Indenter indenter = bond.indenter();
    const double critical = bond.critical();
    const double room =
        indenter.profile == ElasticProfile::parabola ? critical : std::min(critical, indenter.half_width - critical);
    const auto stiffness = [&](double distance) {
      Image image = bond.image(0.0);
      image.displacement_1d = bond.peel(critical + distance * room).displacement_1d;
      return peeling_contact(image, {bond.modulus, bond.surface_energy}, critical).by_overlap;
    };
    // Like one over the distance of the edge from the critical one.
    EXPECT_NEAR(stiffness(1e-3) / stiffness(1e-2), 10.0, 1.0) << bond;
    EXPECT_LT(stiffness(1e-3), 0.0) << bond;
    EXPECT_TRUE(std::isfinite(stiffness(0.0))) << bond;
  }
}

TEST(MdrEdgePress, IsTheRateAtWhichTheSpringsAtAStickingEdgeArePressed) {
  for (const Bond& bond : bonds()) {
    const Indenter indenter = bond.indenter();
    const double b = indenter.half_width;
    for (const double share : k_shares) {
      const double a = bond.between(share);
      const bool is_parabola = indenter.profile == ElasticProfile::parabola;
      const double cosine = is_parabola ? 1.0 : std::sqrt((1.0 - a / b) * (1.0 + a / b));
      const double room = is_parabola ? 1.0 : 1.0 - a / b;
      const double overlap = bond.overlap_at(profile_height(indenter, a));
      const Image image = bond.image(overlap);
      const auto press = [&](double r, double m, double x) {
        const Image at = bond.image_of(r, m, x);
        return at.displacement_1d - profile_height(at.indenter, a);
      };
      SCOPED_TRACE(::testing::Message() << bond << ", share = " << share);
      const double noise = bond.length_scale(a) + image.by_overlap * (std::abs(overlap) + bond.overlap_max);
      const EdgePress by_radius = edge_press(image, image.by_radius, a);
      expect_derivative(
          by_radius.by_overlap / cosine, [&](double x) { return press(bond.radius, bond.overlap_max, x); }, overlap,
          bond.length_scale(a), noise);
      expect_derivative(
          by_radius.by_radius / cosine, [&](double x) { return press(x, bond.overlap_max, overlap); }, bond.radius,
          room * bond.radius_length, noise);
      if (bond.max_length == 0.0) continue;
      expect_derivative(
          edge_press(image, image.by_overlap_max, a).by_radius / cosine,
          [&](double x) { return press(bond.radius, x, overlap); }, bond.overlap_max, room * bond.max_length, noise);
    }
  }
}

// --- from one state of the edge to another

TEST(MdrStickingContact, GoesOverIntoPeelingWithoutAJump) {
  for (const Bond& bond : bonds()) {
    for (const double share : k_shares) {
      const double a = bond.between(share);
      const PeelState state = bond.peel(a);
      const double overlap = bond.overlap_at(state.displacement_1d);
      const Contact stuck = bond.sticking(bond.radius, bond.overlap_max, overlap, a);
      const Contact peels = bond.peeling(bond.radius, bond.overlap_max, overlap);
      // Round-off of the overlap over the slope; at the critical share also over the edge's slope.
      const double round_off =
          k_round_off * (bond.force_scale(a) + std::abs(peels.by_overlap) * (std::abs(overlap) + bond.overlap_max));
      EXPECT_NEAR(stuck.force, peels.force, round_off) << bond << ", share = " << share;
      EXPECT_NEAR(stuck.force, state.force, round_off) << bond << ", share = " << share;
      EXPECT_LT(peels.by_overlap, stuck.by_overlap) << bond;
    }
  }
}

TEST(MdrStickingContact, GoesOverIntoTheContactWithoutAdhesionWithoutAJump) {
  for (const Bond& bond : bonds()) {
    const bool is_elastic = bond.max_length == 0.0;
    const Indenter indenter = bond.indenter();
    for (const double share : {0.01, 0.3, 0.9}) {
      const double a = share * indenter.half_width;
      const double overlap = bond.overlap_at(profile_height(indenter, a));
      if (is_elastic && overlap > 2.0 * bond.radius) continue;
      const Contact stuck = bond.sticking(bond.radius, bond.overlap_max, overlap, a);
      Contact free;
      double stored = 0.0;
      double recoverable = 1.0;  // share of the one-dimensional energy
      if (is_elastic) {
        free = elastic_contact(indenter.profile, bond.modulus, bond.radius, overlap);
        stored = elastic_energy(indenter.profile, bond.modulus, bond.radius, overlap);
      } else {
        for (const Dent& dent : dents()) {
          if (!bond.name.starts_with((std::ostringstream() << dent).str() + ",")) continue;
          free = unloading_contact(dent.shape(), bond.modulus, overlap);
          stored = unloading_energy(dent.shape(), overlap);
          recoverable = 1.0 - dent.shape().rho;
        }
      }
      SCOPED_TRACE(::testing::Message() << bond << ", share = " << share);
      // Round-off of the overlap, a difference of large ones, over its unit.
      const double distance = profile_height(indenter, a) / bond.image(overlap).by_overlap;
      const double round_off = k_round_off * (1.0 + (std::abs(overlap) + bond.overlap_max) / distance);
      EXPECT_LE(relative_error(stuck.force, free.force), 2.0 * round_off);
      EXPECT_LE(relative_error(a, free.contact_radius), round_off);
      EXPECT_LE(relative_error(stuck.by_overlap, free.by_overlap), round_off);
      EXPECT_NEAR(stuck.by_radius, free.by_radius,
                  round_off * (std::abs(free.by_radius) + free.by_overlap + bond.force_scale(a) / bond.radius_length));
      if (!is_elastic) {
        EXPECT_NEAR(stuck.by_overlap_max, free.by_overlap_max,
                    round_off * (std::abs(free.by_overlap_max) + bond.force_scale(a) / bond.max_length));
      }
      const double surface = recoverable * pi * a * a * bond.surface_energy;
      EXPECT_NEAR(bond.energy(overlap, a), stored - surface, 3.0 * round_off * stored + k_round_off * surface);
    }
  }
}

// --- energy

TEST(MdrAdhesiveEnergy, HasTheForceForDerivativeWhileTheEdgeSticks) {
  for (const Bond& bond : bonds()) {
    for (const double share : k_shares) {
      const double a = bond.between(share);
      for (const double part : {0.0, 0.4, 1.0}) {
        SCOPED_TRACE(::testing::Message() << bond << ", share = " << share << ", part = " << part);
        const double overlap = bond.overlap_at(profile_height(bond.indenter(), a) - part * bond.stretch(a));
        const double force = bond.sticking(bond.radius, bond.overlap_max, overlap, a).force;
        const double length = bond.length_scale(a) / bond.image(overlap).by_overlap;
        // Large steps suffice, because the energy is quadratic in the overlap.
        const double difference = central_difference([&](double x) { return bond.energy(x, a); }, overlap, length);
        EXPECT_NEAR(force, difference,
                    1e-13 * (bond.force_scale(a) * (1.0 + (std::abs(overlap) + bond.overlap_max) / length)));
      }
    }
  }
}

/// Work of the peeling force from one edge to another.
double peeling_work(const Bond& bond, double from, double to) {
  const Indenter indenter = bond.indenter();
  const double b = indenter.half_width;
  const bool is_parabola = indenter.profile == ElasticProfile::parabola;
  // In the root of the edge's radius or angle everything is smooth: Dl goes with the root of the radius, g has an
  // unbounded slope at the end of the profile, and the force one at pull-off.
  const auto root = [&](double a) { return std::sqrt(is_parabola ? a : std::asin(a / b)); };
  const double work = boost::math::quadrature::gauss<double, 30>::integrate(
      [&](double x) {
        const double a = is_parabola ? x * x : b * std::sin(x * x);
        const double stretch_slope = 0.5 * bond.stretch(a) / a;
        const double by = is_parabola ? 2.0 * profile_height(indenter, a) / a - stretch_slope
                                      : 0.5 * indenter.height * std::sin(x * x) - stretch_slope * b * std::cos(x * x);
        return bond.peel(a).force * by * 2.0 * x;
      },
      root(from), root(to));
  return work / bond.image(0.0).by_overlap;
}

TEST(MdrAdhesiveEnergy, ChangesByTheWorkOfThePeelingForce) {
  for (const Bond& bond : bonds()) {
    const double last = bond.critical();
    for (const double share : k_shares) {
      const double a = bond.between(share);
      const double high = bond.energy(bond.overlap_at(bond.peel(a).displacement_1d), a);
      const double low = bond.energy(bond.overlap_at(bond.peel(last).displacement_1d), last);
      // Magnitudes of the terms whose differences are the energies.
      const double opening = bond.image(0.0).by_overlap;
      const double scale = bond.force_scale(a) * bond.length_scale(a) / opening;
      EXPECT_NEAR(high - low, peeling_work(bond, last, a),
                  1e-13 * scale * (1.0 + bond.overlap_max * opening / bond.length_scale(a)))
          << bond << ", share = " << share;
    }
  }
}

TEST(MdrAdhesiveEnergy, ChangesByTheWorkOfTheForceOverACycleOfSticking) {
  boost::math::quadrature::tanh_sinh<double> integrator;
  for (const Bond& bond : bonds()) {
    const double a = bond.between(0.5);
    const double opening = bond.image(0.0).by_overlap;
    const double low = bond.overlap_at(bond.peel(a).displacement_1d);
    const double high = bond.overlap_at(profile_height(bond.indenter(), a));
    const double work = integrator.integrate(
        [&](double x) { return bond.sticking(bond.radius, bond.overlap_max, x, a).force; }, low, high);
    const double scale = bond.force_scale(a) * bond.length_scale(a) / opening;
    EXPECT_NEAR(bond.energy(high, a) - bond.energy(low, a), work,
                1e-13 * scale * (1.0 + bond.overlap_max * opening / bond.length_scale(a)))
        << bond;
  }
}

TEST(MdrAdhesiveEnergy, OfThePeelingSpringsFallsByTheSurfaceThatOpens) {
  for (const Bond& bond : bonds()) {
    for (const double share : k_shares) {
      const double a = bond.between(share);
      const Indenter indenter = bond.indenter();
      const double overlap = bond.overlap_at(bond.peel(a).displacement_1d);
      const Image image = bond.image(overlap);
      const auto springs = [&](double x) { return adhesive_energy(image, {bond.modulus, 0.0}, x) * image.by_overlap; };
      const double room = indenter.profile == ElasticProfile::parabola ? a : std::min(a, indenter.half_width - a);
      const double difference = central_difference(springs, a, 0.01 * room);
      const double expected = 2.0 * pi * a * bond.surface_energy;
      // The step is a hundredth of the room: round-off of the springs' terms over it, and of the edge's displacement.
      const double scale = bond.force_scale(a) * bond.length_scale(a) / room +
                           bond.force_scale(a) * image.by_overlap * bond.overlap_max / a;
      EXPECT_NEAR(difference, expected, 1e-12 * expected + 1e-13 * scale) << bond << ", share = " << share;
    }
  }
}

TEST(MdrAdhesiveEnergy, AtPullOffIsThePrintedOneOfTheParabola) {
  for (const double dg : {1e-8, 1e-3, 10.0}) {
    const Indenter indenter = elastic_indenter(ElasticProfile::parabola, 1.1);
    const auto energy = [&](Control control) {
      const double a = critical_radius(indenter, {k_modulus, dg}, control);
      const double overlap = peel_state(indenter, {k_modulus, dg}, a).displacement_1d;
      const double unit = k_modulus * std::pow(a, 5) / (1.1 * 1.1);
      return adhesive_energy(elastic_image(ElasticProfile::parabola, 1.1, overlap), {k_modulus, dg}, a) / unit;
    };
    EXPECT_LE(relative_error(energy(Control::displacement), 3.2), 8.0 * k_round_off) << "dg = " << dg;
    EXPECT_LE(relative_error(energy(Control::force), -16.0 / 45.0), 8.0 * k_round_off) << "dg = " << dg;
  }
}

TEST(MdrAdhesiveEnergy, AtPullOffUnderDisplacementIsPositive) {
  for (const Bond& bond : bonds()) {
    const double a = bond.critical();
    EXPECT_GT(bond.energy(bond.overlap_at(bond.peel(a).displacement_1d), a), 0.0) << bond;
  }
}

// --- limits

TEST(MdrAdhesionLimit, OfVanishingSurfaceEnergyIsTheContactWithoutAdhesion) {
  for (const auto profile : {ElasticProfile::ellipse, ElasticProfile::parabola}) {
    const Indenter indenter = elastic_indenter(profile, 1.1);
    for (const Control control : {Control::displacement, Control::force}) {
      EXPECT_EQ(critical_radius(indenter, {k_modulus, 0.0}, control), 0.0);
    }
    for (const double overlap : {1e-9, 1e-3, 0.3}) {
      const Contact free = elastic_contact(profile, k_modulus, 1.1, overlap);
      for (const double dg : {0.0, 1e-30, 1e-20}) {
        const double a_c = critical_radius(indenter, {k_modulus, dg}, Control::displacement);
        const Contact peels = peeling_contact(elastic_image(profile, 1.1, overlap), {k_modulus, dg}, a_c);
        // The force falls with the square root of the surface energy.
        const double fall =
            2.0 * k_modulus * free.contact_radius * critical_stretch({k_modulus, dg}, free.contact_radius);
        EXPECT_NEAR(peels.force, free.force, 2.0 * fall + k_round_off * free.force)
            << "dg = " << dg << ", delta = " << overlap;
        EXPECT_NEAR(peels.by_overlap, free.by_overlap, 2.0 * fall / overlap + k_round_off * free.by_overlap)
            << "dg = " << dg << ", delta = " << overlap;
      }
    }
  }
}

TEST(MdrAdhesionLimit, OfAHugeSurfaceEnergyHoldsTheEllipseByItsWholeWidth) {
  const Indenter indenter = elastic_indenter(ElasticProfile::ellipse, 1.1);
  double last = 0.0;
  for (const double dg : {1.0, 1e3, 1e6, 1e12, 1e100}) {
    const double a = critical_radius(indenter, {k_modulus, dg}, Control::displacement);
    EXPECT_LE(a, 1.1) << "dg = " << dg;
    EXPECT_GE(a, last) << "dg = " << dg;
    last = a;
    const PeelState state = peel_state(indenter, {k_modulus, dg}, a);
    EXPECT_TRUE(std::isfinite(state.force) && state.force < 0.0) << "dg = " << dg;
    // b - a = a^3/(k (a + b)) with k = pi dg/(8 E*).
    const double k = pi * dg / (8.0 * k_modulus);
    EXPECT_NEAR(1.1 - a, a * a * a / (k * (1.1 + a)), 4.0 * k_epsilon) << "dg = " << dg;
  }
}

TEST(MdrAdhesion, IsHomogeneous) {
  for (const Bond& bond : bonds()) {
    const Indenter indenter = bond.indenter();
    for (const double length : {1e-6, 3.0, 1e6}) {
      for (const double stress : {1e-9, 1e9}) {
        Indenter scaled = indenter;
        scaled.height *= length;
        scaled.half_width *= length;
        const double modulus = stress * bond.modulus;
        const double dg = stress * length * bond.surface_energy;
        const double a_c = critical_radius(scaled, {modulus, dg}, Control::displacement);
        EXPECT_LE(relative_error(a_c, length * bond.critical()), k_round_off) << bond;
        for (const double share : k_shares) {
          const double a = bond.between(share);
          const PeelState unit = bond.peel(a);
          const PeelState state = peel_at_displacement(scaled, {modulus, dg}, a_c, length * unit.displacement_1d);
          // Near pull-off the edge moves with the square root of round-off; this factor is the slope of the force over
          // that of the displacement there.
          EXPECT_NEAR(state.force / (stress * length * length), unit.force, 1e-11 * bond.force_scale(a))
              << bond << ", share = " << share << ", length = " << length << ", stress = " << stress;
        }
      }
    }
  }
}

}  // namespace
}  // namespace monograin::mdr::adhesion_test
