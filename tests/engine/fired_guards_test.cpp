// Guards that fire together at the instant of an event.

#include "engine/fired_guards.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "engine/fake_integrator.hpp"
#include "support/toy_system.hpp"

namespace monograin::fired_guards_test {
namespace {

using Guards = std::vector<std::size_t>;

/// A guard that is zero where the unknown has a value.
ToySystem::ToyGuard guard_at(double value, int direction = 1) {
  return {"guard", direction, [value](double, ToySystem::View y) { return y[0] - value; }};
}

class FiredGuards : public ::testing::Test {
 protected:
  /// Guards that fire at xi = 0.5 together with the first one, after a step that began at 0.4; the unknown is xi.
  Guards fire(std::vector<ToySystem::ToyGuard> guards, const std::vector<Condition>& conditions = {}) {
    toy_.watched = std::move(guards);
    toy_.finish();
    GuardSet set(toy_);
    set.begin_leg(conditions, 0.0, std::vector<double>{integrator_.curve(0.0)});
    integrator_.guards = {0};
    return fired_guards(set, integrator_, 0.4, 0.5, std::vector<double>{integrator_.curve(0.5)});
  }

  ToySystem toy_;
  FakeIntegrator integrator_;
};

TEST_F(FiredGuards, AreThoseThatTheIntegratorFound) { EXPECT_EQ(fire({guard_at(0.5), guard_at(0.6)}), Guards{0}); }

TEST_F(FiredGuards, AreAlsoThoseThatReachZeroWithinItsAccuracy) {
  EXPECT_EQ(fire({guard_at(0.5), guard_at(0.5 + 0.9e-6), guard_at(0.5 + 1.1e-6)}), (Guards{0, 1}));
}

TEST_F(FiredGuards, DoNotComeBackFromTheOtherSide) {
  EXPECT_EQ(fire({guard_at(0.5), guard_at(0.5 + 1e-7, -1)}), Guards{0});
}

TEST_F(FiredGuards, IncludeConditionsOfTheProgramThatTheUnknownApproaches) {
  EXPECT_EQ(fire({guard_at(0.5)}, {{Quantity::displacement, 0, 0.5 + 1e-7}}), (Guards{0, 1}));
}

TEST_F(FiredGuards, DoNotIncludeAConditionThatTheUnknownHasComeNearToAndLeft) {
  // The unknown reverses at xi = 0.49, a little short of the condition, and is farther from it at 0.5.
  integrator_.curve = [](double xi) { return 0.5 - 1e-3 * (xi - 0.49) * (xi - 0.49); };
  EXPECT_EQ(fire({guard_at(0.4999999)}, {{Quantity::displacement, 0, 0.5 + 1e-7}}), Guards{0});
}

TEST_F(FiredGuards, AreMarksIfAllOfThemMarkAnInstant) {
  auto mark = guard_at(0.5);
  mark.is_mark = true;
  EXPECT_EQ(fire({mark, guard_at(0.5)}), Guards{0}) << "a mark brings no other guard with it";
  GuardSet set(toy_);
  set.begin_leg({}, 0.0, std::vector<double>{0.0});
  EXPECT_TRUE(are_marks(set, Guards{0}));
  EXPECT_FALSE(are_marks(set, Guards{0, 1}));
  EXPECT_FALSE(are_marks(set, Guards{}));
}

}  // namespace
}  // namespace monograin::fired_guards_test
