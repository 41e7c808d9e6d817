/// The edge of one adhesive contact as an automaton: it follows, sticks, peels and pulls off.

#include "mdr/adhesive_edge.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "models/accuracy.hpp"
#include "models/mdr/grains.hpp"

namespace monograin::mdr::adhesive_edge_test {
namespace {

constexpr Adhesion k_adhesion{1.0, 1e-5};

/// One-dimensional space of a contact, given by its overlap, which is 0 where it touches without adhesion.
struct Space {
  const char* name;
  UnloadingShape dent{};  ///< of an elastic contact: no height
  [[nodiscard]] Image at(double overlap) const {
    if (dent.height == 0.0) return elastic_image(ElasticProfile::parabola, 1.0, overlap);
    return unloading_image(dent, dent.overlap_max - dent.recovery + overlap);
  }
};

std::vector<Space> spaces() { return {{"elastic", {}}, {"dent", Dent{{50.0}, 0.2}.shape()}}; }

AdhesiveEdge stuck_at(double radius) { return {Edge::sticking, radius}; }

PullOff pull_off_in(const Space& space) { return pull_off_of(space.at(0.0).indenter, k_adhesion); }

/// Radius of an edge that sticks well outside its critical radius.
double wide_radius(const Space& space) { return 1.5 * pull_off_in(space).by_force.contact_radius; }

/// Root of a function that increases with the overlap.
template <class Function>
double root(Function&& function, double low, double high) {
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (function(middle) < 0.0 ? low : high) = middle;
  }
  return high;
}

double overlap_of_peeling(const Space& space, const AdhesiveEdge& edge) {
  return root([&](double d) { return peel_guard(edge, space.at(d), k_adhesion); }, -0.1, 0.1);
}

double overlap_of_following(const Space& space, const AdhesiveEdge& edge) {
  return root([&](double d) { return follow_guard(edge, space.at(d), k_adhesion); }, -0.1, 0.1);
}

TEST(MdrAdhesiveEdge, FollowsAgainWhereItsForceIsThatWithoutAdhesion) {
  for (const Space& space : spaces()) {
    const AdhesiveEdge edge = stuck_at(wide_radius(space));
    const Image image = space.at(overlap_of_following(space, edge));
    const Contact stuck = sticking_contact(image, k_adhesion.composite_modulus, edge.radius);
    EXPECT_LE(relative_error(free_contact_radius(image.indenter, image.displacement_1d), edge.radius), 1e-10)
        << space.name;
    EXPECT_LE(relative_error(stuck.force, free_force(image.indenter, 1.0, edge.radius)), 1e-10) << space.name;
  }
}

TEST(MdrAdhesiveEdge, PeelsBeforeItFollowsOnTheWayBack) {
  for (const Space& space : spaces()) {
    const AdhesiveEdge edge = stuck_at(wide_radius(space));
    EXPECT_LT(overlap_of_peeling(space, edge), overlap_of_following(space, edge)) << space.name;
  }
}

TEST(MdrAdhesiveEdge, HasNoJumpOfTheForceWhereItBeginsToPeel) {
  for (const Space& space : spaces()) {
    const AdhesiveEdge edge = stuck_at(wide_radius(space));
    const PullOff limits = pull_off_in(space);
    const Image image = space.at(overlap_of_peeling(space, edge));
    const auto peeling = edge.torn(limits.by_displacement);
    ASSERT_TRUE(peeling && peeling->peels()) << space.name;
    const Contact before = sticking_contact(image, k_adhesion.composite_modulus, edge.radius);
    const Contact after = peeling_contact(image, k_adhesion, limits, false);
    EXPECT_LE(relative_error(after.force, before.force), 1e-10) << space.name;
    EXPECT_LE(relative_error(after.contact_radius, before.contact_radius), 1e-10) << space.name;
  }
}

TEST(MdrAdhesiveEdge, DoesNotPeelWithinItsCriticalRadius) {
  for (const Space& space : spaces()) {
    const PullOff limits = pull_off_in(space);
    for (const Control control : {Control::displacement, Control::force}) {
      const PeelState& critical = limits.under(control);
      EXPECT_FALSE(stuck_at(critical.contact_radius).torn(critical)) << space.name;
      EXPECT_TRUE(stuck_at(1.001 * critical.contact_radius).torn(critical)) << space.name;
    }
    // Force control becomes unstable before displacement control.
    EXPECT_GT(limits.by_force.contact_radius, limits.by_displacement.contact_radius) << space.name;
  }
}

TEST(MdrAdhesiveEdge, PullsOffWhereItsGuardIsZeroUnderEitherControl) {
  for (const Space& space : spaces()) {
    const PullOff limits = pull_off_in(space);
    EXPECT_EQ(pull_off_guard(limits, limits.by_force.force), 0.0);
    EXPECT_GT(pull_off_guard(limits, 0.5 * limits.by_force.force), 0.0);
    Image image = space.at(0.0);
    image.displacement_1d = limits.by_displacement.displacement_1d;
    EXPECT_EQ(pull_off_guard(limits, image), 0.0);
    image.displacement_1d *= 1.01;
    EXPECT_LT(pull_off_guard(limits, image), 0.0);
  }
}

TEST(MdrAdhesiveEdge, NeverPullsHarderThanAtPullOffUnderAForce) {
  for (const Space& space : spaces()) {
    const PullOff limits = pull_off_in(space);
    const double last = root([&](double d) { return pull_off_guard(limits, space.at(d)); }, -0.1, 0.1);
    const double first = overlap_of_peeling(space, stuck_at(wide_radius(space)));
    for (int k = 0; k <= 20; ++k) {
      const Contact contact = peeling_contact(space.at(std::lerp(first, last, k / 20.0)), k_adhesion, limits, false);
      EXPECT_GE(contact.force, limits.by_force.force * (1.0 + 1e-9)) << space.name << ", " << k;
    }
  }
}

TEST(MdrAdhesiveEdge, LeadsTrialsBackFromBeyondPullOff) {
  for (const Space& space : spaces()) {
    const PullOff limits = pull_off_in(space);
    const double last = root([&](double d) { return pull_off_guard(limits, space.at(d)); }, -0.1, 0.1);
    const Contact beyond = peeling_contact(space.at(last - 1e-3), k_adhesion, limits, true);
    const Contact farther = peeling_contact(space.at(last - 2e-3), k_adhesion, limits, true);
    EXPECT_GT(beyond.by_overlap, 0.0) << space.name;
    EXPECT_LT(farther.force, beyond.force) << space.name;
    EXPECT_EQ(farther.contact_radius, limits.by_displacement.contact_radius) << space.name;
  }
}

TEST(MdrAdhesiveEdge, IsWhereAForceHoldsIt) {
  for (const Space& space : spaces()) {
    const double a = wide_radius(space);
    for (const double overlap : {-1e-3, 0.0, 1e-3}) {
      const Image image = space.at(overlap);
      const double force = sticking_contact(image, k_adhesion.composite_modulus, a).force;
      EXPECT_NEAR(sticking_displacement(image.indenter, 1.0, a, force), image.displacement_1d, 1e-14) << space.name;
    }
    EXPECT_EQ(sticking_displacement(space.at(0.0).indenter, 1.0, 0.0, 1.0), 0.0) << space.name;
  }
}

TEST(MdrAdhesiveEdge, GivesUpNoEnergyWhereItBeginsToPeel) {
  for (const Space& space : spaces()) {
    const AdhesiveEdge edge = stuck_at(wide_radius(space));
    const Image image = space.at(overlap_of_peeling(space, edge));
    // In equilibrium the energy is stationary in the contact radius.
    const auto energy = [&](double a) { return adhesive_energy(image, {1.0, k_adhesion.surface_energy}, a); };
    const double slope = central_difference(energy, edge.radius, 1e-4 * edge.radius);
    EXPECT_LE(std::abs(slope) * edge.radius, 1e-6 * std::abs(energy(edge.radius))) << space.name;
  }
}

TEST(MdrAdhesiveEdge, IsSetBackByRoundOffAlone) {
  for (const Space& space : spaces()) {
    const AdhesiveEdge edge = stuck_at(wide_radius(space));
    const Indenter indenter = space.at(0.0).indenter;
    const AdhesiveEdge moved = edge.set_back(indenter, 1e-14);
    EXPECT_LT(moved.radius, edge.radius) << space.name;
    EXPECT_GE(moved.radius, edge.radius * (1.0 - 1e-8)) << space.name;
    // After the move, the edge is no longer past the displacement at which it would peel.
    const Image image = space.at(overlap_of_peeling(space, edge));
    EXPECT_GT(peel_guard(moved, image, k_adhesion), peel_guard(edge, image, k_adhesion)) << space.name;
    EXPECT_EQ(edge.set_back(indenter, 1e-3).radius, edge.radius) << space.name;
    EXPECT_EQ(stuck_at(0.0).set_back(indenter, 1e-14).radius, 0.0) << space.name;
  }
}

TEST(MdrAdhesiveEdge, IsPressedAtARateBetweenMinusOneAndOne) {
  for (const Space& space : spaces()) {
    const Image image = space.at(1e-3);
    const double a = wide_radius(space);
    EXPECT_EQ(press_rate(image, image.by_radius, a, 0.0, 0.0), 0.0);
    EXPECT_EQ(press_rate(image, image.by_radius, a, 2.0, 0.0), 1.0);
    EXPECT_EQ(press_rate(image, image.by_radius, a, -2.0, 0.0), -1.0);
    const double both = press_rate(image, image.by_radius, a, 1.0, -1.0);
    EXPECT_LE(std::abs(both), 1.0) << space.name;
  }
}

TEST(MdrAdhesiveEdge, WithoutSurfaceEnergyTearsWhereItWouldFollow) {
  constexpr Adhesion none{1.0, 0.0};
  for (const Space& space : spaces()) {
    const AdhesiveEdge edge = stuck_at(0.01);
    for (const double overlap : {-1e-3, 1e-3}) {
      const Image image = space.at(overlap);
      EXPECT_EQ(peel_guard(edge, image, none), follow_guard(edge, image, none)) << space.name;
    }
  }
}

TEST(MdrAdhesiveEdge, IsAsStiffUnpeeledAsIfItStuck) {
  for (const Space& space : spaces()) {
    const PullOff limits = pull_off_in(space);
    const Image image = space.at(overlap_of_peeling(space, stuck_at(wide_radius(space))));
    const Contact peeling = peeling_contact(image, k_adhesion, limits, false);
    const Contact stuck = sticking_contact(image, 1.0, peeling.contact_radius);
    const double unpeeled = reference_stiffness({Edge::peeling, 0.0}, peeling, 1.0, image.by_overlap);
    EXPECT_LE(relative_error(unpeeled, stuck.by_overlap), 1e-12) << space.name;
    EXPECT_LT(peeling.by_overlap, unpeeled) << space.name;
    EXPECT_EQ(reference_stiffness(stuck_at(0.1), peeling, 1.0, 1.0), std::abs(peeling.by_overlap)) << space.name;
  }
}

}  // namespace
}  // namespace monograin::mdr::adhesive_edge_test
