#include "packing/mode.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "models/packing/branches.hpp"

namespace monograin::packing::mode_test {
namespace {

TEST(PackingMode, APackingJamsWhereItsValueAtJammingIsPassed) {
  for (const auto& [name, branch] : branches()) {
    SCOPED_TRACE(name);
    if (branch.control() == Control::stress) {
      EXPECT_FALSE(is_jammed_at(branch, 0.0, 0, false));
      EXPECT_TRUE(is_jammed_at(branch, 0.0, 1, false));
      continue;
    }
    const double jamming = branch.value_at_jamming();
    EXPECT_FALSE(is_jammed_at(branch, jamming - 1e-6, -1, true));
    EXPECT_FALSE(is_jammed_at(branch, jamming, -1, true));
    EXPECT_TRUE(is_jammed_at(branch, jamming, 0, true));
    EXPECT_FALSE(is_jammed_at(branch, jamming, 0, false));
    EXPECT_TRUE(is_jammed_at(branch, jamming, 1, false));
  }
}

TEST(PackingMode, TheClosedFormServesUpToTheEndOfTheStart) {
  for (const auto& [name, branch] : branches()) {
    SCOPED_TRACE(name);
    const double end = branch.value_at(branch.end_of_start());
    EXPECT_EQ(mode_of_jammed(branch, end, -1), Mode::starting);
    EXPECT_EQ(mode_of_jammed(branch, end, 1), Mode::jammed);
  }
}

TEST(PackingMode, APackingIsHeldUnderLessStressThanItsBranchBeginsWith) {
  const ControlledBranch branch(make_law(published()), Control::stress);
  ASSERT_GT(branch.range().least, 0.0);
  EXPECT_EQ(mode_of_jammed(branch, 0.5 * branch.range().least, 1), Mode::held);
  const PackingState held = closed_form(branch, Mode::held, 0.5 * branch.range().least, 0.0);
  EXPECT_EQ(held.packing_fraction, branch.range().begin);
  EXPECT_EQ(held.stress, 0.5 * branch.range().least);
}

TEST(PackingMode, TheStrainIsContinuousThroughJamming) {
  for (const auto& [name, branch] : branches()) {
    if (branch.control() != Control::packing_fraction) continue;
    SCOPED_TRACE(name);
    const double jamming = branch.law().jamming;
    const PackingState loose = closed_form(branch, Mode::unjammed, jamming, jamming);
    EXPECT_NEAR(loose.strain, closed_form(branch, Mode::starting, jamming, jamming).strain, 1e-15);
    EXPECT_EQ(loose.stress, 0.0);
  }
}

TEST(PackingMode, TheClosedFormHasThePrescribedValue) {
  for (const auto& [name, branch] : branches()) {
    SCOPED_TRACE(name);
    const double value = branch.value_at(std::midpoint(branch.range().begin, branch.range().end));
    const PackingState now = closed_form(branch, Mode::jammed, value, 0.0);
    EXPECT_NEAR(branch.value_at(now.packing_fraction), value, 1e-12 * value);
    const double by_law = state(branch.law(), now.packing_fraction).particle_strain;
    EXPECT_NEAR(particle_strain(branch, now), by_law, 1e-12);
  }
}

}  // namespace
}  // namespace monograin::packing::mode_test
