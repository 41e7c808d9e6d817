/// One contact of the MDR model on each of its branches, without walls, programs or other contacts.

#include "mdr/contact_branch.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "models/accuracy.hpp"
#include "models/mdr/grains.hpp"

namespace monograin::mdr::contact_branch_test {
namespace {

constexpr double k_growth = 0.02;      // r at which contacts are looked at
constexpr double k_round_off = 1e-11;  // of forces that are differences of areas

ContactLaw law_of(double modulus_over_yield, DeltaMaxRule rule = DeltaMaxRule::running_maximum) {
  ContactLaw law;
  law.material = Grain{modulus_over_yield}.material();
  law.elastic_profile = ElasticProfile::parabola;  // without a jump of the force at yield
  law.delta_max_rule = rule;
  return law;
}

ContactBranch yielded(const ContactLaw& law) { return ContactBranch{}.made().yielded(law, k_growth); }

/// A branch, and overlaps that lie well inside it.
struct Case {
  const char* name;
  ContactLaw law;
  ContactBranch branch;
  std::vector<double> overlaps;
};

std::vector<Case> cases(DeltaMaxRule rule = DeltaMaxRule::running_maximum) {
  const ContactLaw law = law_of(100.0, rule);
  const double first = law.material.yield_overlap_ratio * (1.0 + k_growth);
  const double most = 0.2;
  const ContactBranch unloading = yielded(law).unloaded(law, k_growth, most);
  const double recovery = unloading.shape(law, k_growth, most).recovery;
  return {{"elastic", law, ContactBranch{}.made(), {0.1 * first, 0.9 * first}},
          {"plastic", law, yielded(law), {1.5 * first, most}},
          {"unloading", law, unloading, {most - 0.9 * recovery, most - 0.2 * recovery}}};
}

/// Calls a function for each overlap of each case.
template <class Function>
void for_each_state(const std::vector<Case>& list, Function&& function) {
  for (const Case& c : list) {
    for (const double overlap : c.overlaps) {
      SCOPED_TRACE(::testing::Message() << c.name << ", overlap = " << overlap);
      function(c, overlap);
    }
  }
}

TEST(MdrContactBranch, BearsNothingWhileItsWallDoesNotTouch) {
  const ContactLaw law = law_of(100.0);
  const ContactBranch separated = yielded(law).unloaded(law, k_growth, 0.1).lost(0.05);
  ASSERT_EQ(separated.regime, Regime::separated);
  for (const ContactBranch& branch : {ContactBranch{}, separated}) {
    EXPECT_FALSE(branch.touches());
    for (const double overlap : {-0.1, 0.0, 0.3}) {
      const Contact contact = branch.contact(law, k_growth, overlap);
      EXPECT_EQ(contact.force, 0.0) << overlap;
      EXPECT_EQ(contact.contact_radius, 0.0) << overlap;
      EXPECT_EQ(branch.energy(law, k_growth, overlap, 0.0, PlasticPart::recoverable), 0.0) << overlap;
    }
  }
}

TEST(MdrContactBranch, RemembersItsLargestOverlapWhileItIsOpen) {
  const ContactLaw law = law_of(100.0);
  const ContactBranch pressed = yielded(law).unloaded(law, k_growth, 0.1);
  const ContactBranch closed_again = pressed.lost(0.05).made();
  EXPECT_EQ(closed_again.regime, Regime::unloading);
  EXPECT_EQ(closed_again.largest_overlap(law, k_growth), 0.1);
  EXPECT_EQ(pressed.lost(0.05).resting, 0.05);
}

TEST(MdrContactBranch, HasNoJumpOfForceOrAreaWhereItYields) {
  for (const double modulus_over_yield : {6.25, 20.0, 200.0, 1e4}) {
    const ContactLaw law = law_of(modulus_over_yield);
    const ContactBranch elastic = ContactBranch{}.made();
    const double overlap = (1.0 + k_growth) * law.material.yield_overlap_ratio;
    EXPECT_EQ(elastic.yield_guard(law, k_growth, overlap), 0.0);
    const Contact before = elastic.contact(law, k_growth, overlap);
    const Contact after = elastic.yielded(law, k_growth).contact(law, k_growth, overlap);
    EXPECT_LE(relative_error(after.force, before.force), k_round_off) << modulus_over_yield;
    EXPECT_LE(relative_error(after.contact_radius, before.contact_radius), k_round_off) << modulus_over_yield;
  }
}

TEST(MdrContactBranch, HasNoJumpOfForceAreaOrEnergyWhereItUnloadsAndReloads) {
  for (const double modulus_over_yield : {6.25, 20.0, 200.0, 1e4}) {
    const ContactLaw law = law_of(modulus_over_yield);
    const double overlap = 0.1 + law.material.yield_overlap_ratio;
    const ContactBranch plastic = yielded(law);
    const ContactBranch unloading = plastic.unloaded(law, k_growth, overlap);
    const ContactBranch again = unloading.reloaded();
    const Contact first = plastic.contact(law, k_growth, overlap);
    const auto stored = [&](const ContactBranch& branch) {
      return branch.energy(law, k_growth, overlap, first.contact_radius, PlasticPart::recoverable);
    };
    for (const ContactBranch& branch : {unloading, again}) {
      const Contact contact = branch.contact(law, k_growth, overlap);
      EXPECT_LE(relative_error(contact.force, first.force), k_round_off) << modulus_over_yield;
      EXPECT_LE(relative_error(contact.contact_radius, first.contact_radius), k_round_off) << modulus_over_yield;
      EXPECT_LE(relative_error(stored(branch), stored(plastic)), k_round_off) << modulus_over_yield;
    }
    EXPECT_EQ(again.regime, Regime::fully_plastic);
    EXPECT_TRUE(again.is_on_primary_branch);
  }
}

TEST(MdrContactBranch, BearsNothingWhereItsDentOpens) {
  for (const Case& c : cases()) {
    if (c.branch.regime == Regime::fully_plastic) continue;
    const double touch = c.branch.touching_overlap(c.law, k_growth);
    EXPECT_NEAR(c.branch.contact(c.law, k_growth, touch).force, 0.0, 1e-20) << c.name;
    EXPECT_NEAR(c.branch.opening_guard(c.law, k_growth, touch), 0.0, 1e-13) << c.name;
    EXPECT_GT(c.branch.opening_guard(c.law, k_growth, 1.01 * touch + 1e-6), 0.0) << c.name;
  }
}

TEST(MdrContactBranch, HasTheDerivativesOfItsForce) {
  for (const DeltaMaxRule rule : {DeltaMaxRule::running_maximum, DeltaMaxRule::shifted}) {
    for_each_state(cases(rule), [](const Case& c, double overlap) {
      const double step = 1e-4 * overlap;
      const Contact at = c.branch.contact(c.law, k_growth, overlap);
      const auto by_overlap = [&](double x) { return c.branch.contact(c.law, k_growth, x).force; };
      const auto by_radius = [&](double r) { return c.branch.contact(c.law, r, overlap).force; };
      EXPECT_NEAR(at.by_overlap, central_difference(by_overlap, overlap, step), 1e-8 * std::abs(at.by_overlap));
      EXPECT_NEAR(at.by_radius, central_difference(by_radius, k_growth, step), 1e-8 * std::abs(at.by_overlap));
    });
  }
}

TEST(MdrContactBranch, HasTheDerivativesOfItsForceWhereItContinuesOddly) {
  for (Case c : cases()) {
    if (c.branch.regime == Regime::fully_plastic) continue;
    c.law.continues_off_branch = true;
    const double touch = c.branch.touching_overlap(c.law, k_growth);
    const double depth = c.overlaps[0] - touch;
    const double overlap = touch - depth;
    const double step = 1e-4 * depth;
    const Contact at = c.branch.contact(c.law, k_growth, overlap);
    const auto by_overlap = [&](double x) { return c.branch.contact(c.law, k_growth, x).force; };
    EXPECT_NEAR(at.by_overlap, central_difference(by_overlap, overlap, step), 1e-7 * at.by_overlap) << c.name;
    if (c.branch.regime == Regime::elastic) {  // the opening of a dent moves with the radius
      const auto by_radius = [&](double r) { return c.branch.contact(c.law, r, overlap).force; };
      EXPECT_NEAR(at.by_radius, central_difference(by_radius, k_growth, step), 1e-7 * at.by_overlap);
    }
    // Far off the branch the force rises linearly.
    const double far = touch - 0.3;
    EXPECT_NEAR(c.branch.contact(c.law, k_growth, far).by_overlap, central_difference(by_overlap, far, step),
                1e-7 * at.by_overlap)
        << c.name;
  }
}

TEST(MdrContactBranch, HasTheForceForDerivativeOfItsWork) {
  for_each_state(cases(), [](const Case& c, double overlap) {
    const double force = c.branch.contact(c.law, k_growth, overlap).force;
    const auto work = [&](double x) { return c.branch.energy(c.law, k_growth, x, 0.0, PlasticPart::work_done); };
    EXPECT_LE(relative_error(central_difference(work, overlap, 1e-4 * overlap), force), 1e-8);
  });
}

TEST(MdrContactBranch, GivesBackLessThanWasDoneOnItWhereItYielded) {
  const ContactLaw law = law_of(100.0);
  const ContactBranch plastic = yielded(law);
  const double first = law.material.yield_overlap_ratio * (1.0 + k_growth);
  const double a_first = plastic.contact(law, k_growth, first).contact_radius;
  const auto elastic = ContactBranch{}.made().energy(law, k_growth, first, a_first, PlasticPart::recoverable);
  double dissipated_before = 0.0;
  for (const double overlap : {0.01, 0.05, 0.2, 0.4}) {
    const auto part = [&](double x, PlasticPart which) { return plastic.energy(law, k_growth, x, 0.0, which); };
    const double work = elastic + part(overlap, PlasticPart::work_done) - part(first, PlasticPart::work_done);
    const double dissipated = work - part(overlap, PlasticPart::recoverable);
    EXPECT_GT(dissipated, dissipated_before) << overlap;
    dissipated_before = dissipated;
  }
}

TEST(MdrContactBranch, StandsWhereAForceWantsIt) {
  for_each_state(cases(), [](const Case& c, double overlap) {
    const double force = c.branch.contact(c.law, k_growth, overlap).force;
    const double displacement = c.branch.approach_under(c.law, k_growth, force, 0.9 * overlap - k_growth);
    EXPECT_NEAR(displacement, overlap - k_growth, 1e-12);
  });
}

TEST(MdrContactBranch, LeavesAnOpenWallWhereItRestsUntilTheParticleGrowsAgainstIt) {
  const ContactLaw law = law_of(100.0);
  const ContactBranch open = ContactBranch{}.made().lost(-0.01);
  EXPECT_EQ(open.approach_under(law, 0.005, 0.0, 0.0), -0.01);
  EXPECT_EQ(open.approach_under(law, 0.03, 0.0, 0.0), -0.03);
}

TEST(MdrContactBranch, IsNeverSofterThanATouchWhereItsStiffnessIsAsked) {
  for (const Case& c : cases()) {
    if (c.branch.regime == Regime::fully_plastic) continue;
    const double touch = c.branch.touching_overlap(c.law, k_growth);
    const Contact none = c.branch.contact(c.law, k_growth, touch);
    const Contact stiff = c.branch.stiff_contact(c.law, k_growth, touch, none);
    EXPECT_GT(stiff.by_overlap, 0.0) << c.name;
    EXPECT_GE(c.branch.regularized_stiffness(c.law, none), c.law.least_stiffness()) << c.name;
    const Contact deep = c.branch.contact(c.law, k_growth, c.overlaps[0]);
    EXPECT_EQ(c.branch.stiff_contact(c.law, k_growth, c.overlaps[0], deep).force, deep.force) << c.name;
    EXPECT_EQ(c.branch.regularized_stiffness(c.law, deep), deep.by_overlap) << c.name;
  }
}

TEST(MdrContactBranch, ContinuesOddlyWhereTrialsOpenIt) {
  for (Case c : cases()) {
    if (c.branch.regime == Regime::fully_plastic) continue;
    c.law.continues_off_branch = true;
    const double touch = c.branch.touching_overlap(c.law, k_growth);
    for (const double depth : {1e-6, 1e-3, 0.5}) {
      const Contact inside = c.branch.contact(c.law, k_growth, touch + depth);
      const Contact outside = c.branch.contact(c.law, k_growth, touch - depth);
      EXPECT_GT(inside.force, 0.0) << c.name << depth;
      EXPECT_LT(outside.force, 0.0) << c.name << depth;
      EXPECT_GT(outside.by_overlap, 0.0) << c.name << depth;
    }
    const double near = 0.5 * (c.overlaps[0] - touch);
    EXPECT_LE(relative_error(-c.branch.contact(c.law, k_growth, touch - near).force,
                             c.branch.contact(c.law, k_growth, touch + near).force),
              1e-9)
        << c.name;
  }
}

TEST(MdrContactBranch, ShowsNoContactBelowTheRoundOffOfItsOverlap) {
  const ContactLaw law = law_of(100.0);
  const ContactBranch elastic = ContactBranch{}.made();
  for (const double overlap : {1e-18, 1e-3}) {
    EXPECT_EQ(elastic.is_visible(law, 0.0, overlap, 1.0), overlap > 1e-15) << overlap;
  }
}

TEST(MdrContactBranch, MovesItsLargestOverlapWithTheRadiusByTheShiftedRuleAlone) {
  for (const DeltaMaxRule rule : {DeltaMaxRule::running_maximum, DeltaMaxRule::shifted}) {
    const ContactLaw law = law_of(100.0, rule);
    const ContactBranch branch = yielded(law).unloaded(law, k_growth, 0.1);
    EXPECT_DOUBLE_EQ(branch.largest_overlap(law, k_growth), 0.1);
    EXPECT_DOUBLE_EQ(branch.largest_overlap(law, k_growth + 0.01), law.is_shifted() ? 0.11 : 0.1);
  }
}

TEST(MdrContactBranch, YieldsBelowItsLargestOverlapByTheShiftedRuleAlone) {
  for (const DeltaMaxRule rule : {DeltaMaxRule::running_maximum, DeltaMaxRule::shifted}) {
    const ContactLaw law = law_of(100.0, rule);
    const ContactBranch elastic = ContactBranch{}.made();
    EXPECT_TRUE(elastic.may_yield(law));
    EXPECT_EQ(elastic.unloaded(law, 0.0, 1e-4).may_yield(law), law.is_shifted());
  }
  ContactLaw elastic_for_ever = law_of(100.0);
  elastic_for_ever.material.yield_overlap_ratio = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(ContactBranch{}.made().may_yield(elastic_for_ever));
}

TEST(MdrContactBranch, DoesNotDependOnWhatItWasAskedBefore) {
  const ContactLaw law = law_of(100.0, DeltaMaxRule::shifted);
  const ContactBranch asked = yielded(law).unloaded(law, k_growth, 0.1);
  const double first = asked.contact(law, k_growth, 0.099).force;
  EXPECT_NE(asked.contact(law, k_growth + 0.01, 0.099).force, first);
  EXPECT_EQ(asked.contact(law, k_growth, 0.099).force, first);
  // A contact that yields again, at another radius, leaves another dent of the same depth.
  const ContactBranch anew = asked.lost(0.0).made().yielded(law, 0.1).unloaded(law, k_growth, 0.1);
  const ContactBranch fresh = ContactBranch{}.made().yielded(law, 0.1).unloaded(law, k_growth, 0.1);
  EXPECT_EQ(anew.contact(law, k_growth, 0.099).force, fresh.contact(law, k_growth, 0.099).force);
}

TEST(MdrContactBranch, EndsWhereItsLawDoes) {
  ContactLaw law = law_of(100.0);
  law.elastic_profile = ElasticProfile::ellipse;
  const ContactBranch elastic = ContactBranch{}.made();
  EXPECT_THROW(static_cast<void>(elastic.contact(law, 0.0, 2.1)), std::domain_error);
  EXPECT_THROW(static_cast<void>(yielded(law).approach_under(law, 0.0, 100.0, 0.1)), std::domain_error);
}

TEST(MdrContactBranch, WithAStuckEdgeBearsWhatItBoreWhereItStuck) {
  for (Case c : cases()) {
    if (c.branch.regime == Regime::fully_plastic) continue;
    c.law.surface_energy = 1e-4;
    const double overlap = c.overlaps[1];
    const Contact before = c.branch.contact(c.law, k_growth, overlap);
    const ContactBranch stuck = c.branch.with_edge({Edge::sticking, before.contact_radius});
    EXPECT_LE(relative_error(stuck.contact(c.law, k_growth, overlap).force, before.force), 1e-9) << c.name;
    // After a retreat, a contact whose edge sticks carries less than one whose edge follows.
    const double less = overlap - 0.05 * (overlap - c.branch.touching_overlap(c.law, k_growth));
    EXPECT_LT(stuck.contact(c.law, k_growth, less).force, c.branch.contact(c.law, k_growth, less).force) << c.name;
    const double force = stuck.contact(c.law, k_growth, less).force;
    EXPECT_NEAR(stuck.approach_under(c.law, k_growth, force, 0.0), less - k_growth, 1e-12) << c.name;
  }
}

TEST(MdrContactBranch, WithAStuckEdgeStoresWhatItStoredWhereItStuck) {
  for (Case c : cases()) {
    c.law.surface_energy = 1e-4;
    for (const double overlap : c.overlaps) {
      const double radius = c.branch.contact(c.law, k_growth, overlap).contact_radius;
      const auto stored = [&](const ContactBranch& branch) {
        return branch.energy(c.law, k_growth, overlap, radius, PlasticPart::recoverable);
      };
      const bool turns = c.branch.regime == Regime::fully_plastic;
      const ContactBranch pressed = turns ? c.branch.unloaded(c.law, k_growth, overlap) : c.branch;
      EXPECT_LE(relative_error(stored(pressed.with_edge({Edge::sticking, radius})), stored(c.branch)), 1e-9)
          << c.name << ", overlap = " << overlap;
    }
  }
}

}  // namespace
}  // namespace monograin::mdr::contact_branch_test
