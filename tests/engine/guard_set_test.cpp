// The guards of a system and the conditions of the program, as an integrator evaluates them.

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "engine/guard_set.hpp"
#include "support/toy_system.hpp"

namespace monograin::guards_test {
namespace {

class GuardSetTest : public ::testing::Test {
 protected:
  GuardSetTest() {
    toy_.watched = {{"yield", 1, [](double, ToySystem::View y) { return y[0] - 7.0; }},
                    {"reload", -1, [](double, ToySystem::View y) { return y[0] - 8.0; }}};
    toy_.finish();
  }
  /// Watches conditions from a state in which every quantity has this value.
  void begin(const std::vector<Condition>& conditions, double value) {
    y_ = {value};
    guards_.begin_leg(conditions, 0.0, y_);
  }
  [[nodiscard]] bool is_met_at(double value) { return guards_.is_met(0.5, std::vector<double>{value}); }

  ToySystem toy_;
  GuardSet guards_{toy_};
  std::vector<double> y_;
};

TEST_F(GuardSetTest, ListsTheGuardsOfTheSystemFirst) {
  begin({{Quantity::displacement, 0, 2.0}}, 0.0);
  ASSERT_EQ(guards_.size(), 3u);
  EXPECT_EQ(guards_.system_guards(), 2u);
  EXPECT_EQ(std::vector<int>(guards_.directions().begin(), guards_.directions().end()), (std::vector<int>{1, -1, 1}));
  EXPECT_EQ(guards_.name(0), "yield of toy");
  EXPECT_EQ(guards_.name(2), "until");
}

TEST_F(GuardSetTest, ScalesAConditionToOrderOne) {
  begin({{Quantity::force, 0, 4e6}}, 1e6);
  std::vector<double> values(guards_.size());
  guards_.values(0.0, y_, values);
  EXPECT_DOUBLE_EQ(values[2], -0.75);
  EXPECT_DOUBLE_EQ(values[0], 1e6 - 7.0);
}

TEST_F(GuardSetTest, MeetsATargetFromTheSideWhereTheStepBegan) {
  begin({{Quantity::displacement, 0, 2.0}}, 1.0);
  EXPECT_FALSE(is_met_at(1.9));
  EXPECT_TRUE(is_met_at(2.0));
  EXPECT_TRUE(is_met_at(2.1));
  begin({{Quantity::displacement, 0, 2.0}}, 3.0);
  EXPECT_EQ(guards_.directions()[2], -1);
  EXPECT_FALSE(is_met_at(2.1));
  EXPECT_TRUE(is_met_at(1.9));
}

TEST_F(GuardSetTest, HoldsATargetTheStepBeganOn) {
  begin({{Quantity::force, 0, 5.0}, {Quantity::displacement, 0, 2.0}}, 2.0);
  EXPECT_EQ(guards_.met_at_begin(), 1u);
  begin({{Quantity::displacement, 0, 0.0}}, 0.0);
  EXPECT_EQ(guards_.met_at_begin(), 0u);
  // Within a billionth of the larger magnitude, and no farther.
  begin({{Quantity::displacement, 0, 2.0}}, 2.0 * (1.0 + 0.9e-9));
  EXPECT_EQ(guards_.met_at_begin(), 0u);
  begin({{Quantity::displacement, 0, 2.0}}, 2.0 * (1.0 + 1.1e-9));
  EXPECT_FALSE(guards_.met_at_begin());
  EXPECT_EQ(guards_.directions()[2], -1);
  begin({{Quantity::displacement, 0, 0.0}}, 1e-300);
  EXPECT_FALSE(guards_.met_at_begin());
}

TEST_F(GuardSetTest, IsMetWithinATargetsTolerance) {
  begin({{Quantity::displacement, 0, 2.0}}, 1.0);
  EXPECT_TRUE(is_met_at(2.0 * (1.0 - 0.9e-9)));
  EXPECT_FALSE(is_met_at(2.0 * (1.0 - 1.1e-9)));
}

TEST_F(GuardSetTest, HoldsATargetByWhichTheLastStepHasEnded) {
  const std::vector<Condition> conditions{{Quantity::displacement, 0, 2.0}};
  const std::vector<std::size_t> fired{2};
  // The event is located only to within an integrator's step.
  begin(conditions, 1.0);
  guards_.note_met(fired, 0.5, std::vector<double>{2.1});
  begin(conditions, 2.1);
  EXPECT_EQ(guards_.met_at_begin(), 0u);
  // The memory does not apply to another target, or to the step after next.
  begin(conditions, 1.0);
  guards_.note_met(fired, 0.5, std::vector<double>{2.1});
  begin({{Quantity::displacement, 0, 2.05}}, 2.1);
  EXPECT_FALSE(guards_.met_at_begin());
  begin(conditions, 2.1);
  EXPECT_FALSE(guards_.met_at_begin());
}

TEST_F(GuardSetTest, DoesNotHoldATargetThatAJumpHasPassed) {
  begin({{Quantity::force, 0, -3.0}}, -4.0);
  EXPECT_TRUE(is_met_at(0.0));
  guards_.note_met({}, 0.5, std::vector<double>{0.0});
  begin({{Quantity::force, 0, -3.0}}, 0.0);
  EXPECT_FALSE(guards_.met_at_begin());
}

TEST_F(GuardSetTest, HasNoRootFunctionForWhatVanishesWithTheContact) {
  for (const Quantity quantity : {Quantity::force, Quantity::pressure, Quantity::contact_radius}) {
    begin({{quantity, 0, 0.0}}, 1.0);
    EXPECT_EQ(guards_.size(), 2u);
    EXPECT_TRUE(is_met_at(0.0));
    toy_.adheres = true;
    begin({{quantity, 0, 0.0}}, 1.0);
    EXPECT_EQ(guards_.size(), quantity == Quantity::contact_radius ? 2u : 3u);
    toy_.adheres = false;
  }
  begin({{Quantity::displacement, 0, 0.0}}, 1.0);
  EXPECT_EQ(guards_.size(), 3u);
}

TEST_F(GuardSetTest, IsMetByAnyOfItsConditions) {
  begin({{Quantity::displacement, 0, 2.0}, {Quantity::force, 0, 5.0}}, 1.0);
  EXPECT_TRUE(is_met_at(3.0));
  begin({}, 1.0);
  EXPECT_FALSE(is_met_at(3.0));
}

}  // namespace
}  // namespace monograin::guards_test
