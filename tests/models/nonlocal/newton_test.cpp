#include "nonlocal/newton.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "models/nonlocal/cases.hpp"

namespace monograin::nonlocal::nonlocal_newton_test {
namespace {

std::vector<Target> targets_at(const Contacts& contacts, std::span<const double> displacements) {
  std::vector<Target> targets;
  for (const double displacement : displacements) targets.push_back({.value = displacement});
  EXPECT_EQ(targets.size(), contacts.class_count());
  return targets;
}

TEST(NonlocalNewton, FindsTheStateNearAGuess) {
  for (const Scene& scene : scenes()) {
    Contacts contacts({scene.poisson_ratio, Terms::four}, scene.classes, scene.centre);
    const std::vector<double> expected = state_under(contacts, scene.displacements);
    const auto targets = targets_at(contacts, scene.displacements);
    std::vector<double> y = expected;
    for (std::size_t j = 0; j < targets.size(); ++j) y[j] += y[j] > 0.0 ? 1e-3 : -1e-3;
    ASSERT_TRUE(Newton(contacts).solve(contacts, {.targets = targets}, y)) << scene.name;
    for (std::size_t i = 0; i < y.size(); ++i) EXPECT_NEAR(y[i], expected[i], 1e-14) << scene.name << ", " << i;
    EXPECT_TRUE(is_balanced(contacts, targets, y)) << scene.name;
    EXPECT_FALSE(has_left_branch(contacts, targets, y)) << scene.name;
  }
}

TEST(NonlocalNewton, GivesUpBeyondTheLimit) {
  Contacts contacts({k_rubber, Terms::four}, die(), Centre::fixed);
  std::vector<double> y{0.0, 0.0};
  const std::vector<Target> targets = targets_at(contacts, std::vector{0.5, 0.0});
  EXPECT_FALSE(Newton(contacts).solve(contacts, {.targets = targets}, y));
}

TEST(NonlocalNewton, SeesContactsUnderForceControlLeaveTheBranch) {
  Contacts contacts({k_rubber, Terms::four}, die(), Centre::fixed);
  // Beyond the limit, where the margin is negative.
  const std::vector<double> y{1.0, 1.0};
  ASSERT_LT(contacts.margin(y), 0.0);
  std::vector<Target> targets(2);
  EXPECT_FALSE(has_left_branch(contacts, targets, y));
  targets[0].is_force = true;
  EXPECT_TRUE(has_left_branch(contacts, targets, y));
}

TEST(NonlocalNewton, LeavesAnImbalanceThatIsAskedFor) {
  Contacts contacts({0.4, Terms::three}, trigonal_walls().classes(), Centre::free);
  const std::vector<double> displacements{0.15, 0.13, 0.0, 0.04, -0.01};
  std::vector<double> y = state_under(contacts, displacements);
  const auto targets = targets_at(contacts, displacements);
  const Eigen::Vector3d imbalance(1e-4, -2e-4, 3e-4);
  Newton newton(contacts);
  ASSERT_TRUE(newton.solve(contacts, {.targets = targets, .is_to_balance = false, .imbalance = imbalance}, y));
  EXPECT_LE((contacts.net_force(contacts.evaluate(y).forces) - imbalance).norm(), 1e-15);
  EXPECT_FALSE(is_balanced(contacts, targets, y));
}

TEST(NonlocalNewton, HoldsTheCentreWhereItIsAskedTo) {
  Contacts contacts({0.4, Terms::three}, trigonal_walls().classes(), Centre::free);
  const std::vector<double> displacements{0.15, 0.13, 0.0, 0.04, -0.01};
  const std::vector<double> balanced = state_under(contacts, displacements);
  std::vector<double> y = balanced;
  y[5] += 0.001;
  const auto targets = targets_at(contacts, displacements);
  Newton newton(contacts);
  ASSERT_TRUE(newton.solve(contacts, {.targets = targets, .holds_centre = true}, y));
  EXPECT_EQ(y[5], balanced[5] + 0.001);
  // The net force presses the centre back to where it balances.
  const Eigen::Vector3d step = newton.step_to_balance(contacts, newton.net_force(contacts));
  EXPECT_NEAR(step.x(), -0.001, 2e-5);
}

TEST(NonlocalNewton, DoesNotBalanceAForceThatNothingBears) {
  Contacts contacts({k_rubber}, single_walls(die()), Centre::free);
  std::vector<Target> targets(6);
  std::vector<double> y(9, 0.0);
  EXPECT_TRUE(is_balanced(contacts, targets, y));
  targets[0] = {.is_force = true, .value = 1e-9, .signed_square = 1e-6};
  EXPECT_FALSE(is_balanced(contacts, targets, y));
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_newton_test
