#include "packing/controlled_branch.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>

#include "models/packing/branches.hpp"

namespace monograin::packing::controlled_branch_test {
namespace {

TEST(ControlledBranch, ValuesGrowAndLeadBackToTheirPackingFraction) {
  for (const auto& [name, branch] : branches()) {
    SCOPED_TRACE(name);
    const Branch& range = branch.range();
    double last = range.least;
    for (const double share : {0.1, 0.5, 0.9}) {
      const double phi = std::lerp(range.begin, range.end, share);
      const double value = branch.value_at(phi);
      EXPECT_GT(value, last);
      EXPECT_NEAR(branch.packing_fraction_at(value), phi, 1e-12);
      last = value;
    }
  }
}

TEST(ControlledBranch, GrowthIsADifferenceQuotient) {
  constexpr double h = 1e-6;
  for (const auto& [name, branch] : branches()) {
    SCOPED_TRACE(name);
    const double phi = std::midpoint(branch.range().begin, branch.range().end);
    const double growth = branch.growth(slopes(branch.law(), phi, state(branch.law(), phi).strain));
    EXPECT_NEAR(growth, (branch.value_at(phi + h) - branch.value_at(phi - h)) / (2.0 * h), 1e-6 * growth);
  }
}

TEST(ControlledBranch, TheClosedStartLiesBeforeTheIntegratedStates) {
  for (const auto& [name, branch] : branches()) {
    SCOPED_TRACE(name);
    EXPECT_GT(branch.end_of_start(), branch.range().begin);
    EXPECT_LT(branch.end_of_start(), branch.range().end);
    EXPECT_GT(branch.least_integrated(), branch.law().jamming);
  }
}

TEST(ControlledBranch, ALimitedBranchEndsTheRunALittleBeforeItsEnd) {
  for (const Control control : {Control::packing_fraction, Control::strain, Control::stress}) {
    const ControlledBranch branch = limited_branch(control);
    ASSERT_TRUE(branch.is_limited());
    EXPECT_LT(branch.last_value(), branch.range().greatest);
    EXPECT_GT(branch.last_value(), branch.range().least);
    EXPECT_NO_THROW(branch.require_state(branch.last_value()));
    EXPECT_THROW(branch.require_state(branch.range().greatest * 1.01), std::domain_error);
    EXPECT_EQ(branch.domain_end().point.limit, branch.limit());
  }
}

TEST(ControlledBranch, ABranchThatEndsAtJammingHasOneValue) {
  ControlledBranch branch = limited_branch(Control::strain);
  branch.end_at_jamming();
  EXPECT_EQ(branch.range().least, branch.value_at_jamming());
  EXPECT_EQ(branch.last_value(), branch.value_at_jamming());
}

}  // namespace
}  // namespace monograin::packing::controlled_branch_test
