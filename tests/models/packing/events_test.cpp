#include "packing/events.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "models/packing/branches.hpp"

namespace monograin::packing::events_test {
namespace {

std::vector<std::string> armed(const ControlledBranch& branch, const Ramp& ramp, Mode mode, const Yielding& yielding) {
  Guards guards;
  guards.arm(branch, ramp, mode, yielding, ramp.start);
  std::vector<std::string> names;
  for (const Guard& guard : guards.list()) names.emplace_back(guard.name);
  return names;
}

/// A plastic packing whose particles have all yielded before it is full.
Law yielding_law() {
  Parameters parameters = published(1.0);
  parameters.plastic_growth = 6.0;
  return make_law(parameters);
}

using Names = std::vector<std::string>;

TEST(PackingEvents, CompactionJamsSoftensYieldsAndFills) {
  const Law law = yielding_law();
  const ControlledBranch branch(law, Control::packing_fraction);
  const Yielding yielding(law);
  const Ramp ramp{0.7, 1.0, Control::packing_fraction};
  EXPECT_EQ(armed(branch, ramp, Mode::unjammed, yielding), Names{"jamming"});
  EXPECT_EQ(armed(branch, ramp, Mode::jammed, yielding), (Names{"plastic-softening", "fully-plastic", "full"}));
}

TEST(PackingEvents, AnElasticPackingDoesNotYield) {
  const Law law = make_law(published());
  const ControlledBranch branch(law, Control::packing_fraction);
  EXPECT_EQ(armed(branch, {0.9, 1.0, Control::packing_fraction}, Mode::jammed, Yielding(law)), Names{"full"});
  EXPECT_TRUE(armed(branch, {0.9, 0.95, Control::packing_fraction}, Mode::jammed, Yielding(law)).empty());
  EXPECT_TRUE(armed(branch, {0.9, 0.9, Control::packing_fraction}, Mode::jammed, Yielding(law)).empty());
}

TEST(PackingEvents, ALimitedBranchEndsTheRun) {
  const ControlledBranch branch = limited_branch(Control::strain);
  EXPECT_EQ(armed(branch, {0.0, 1.0, Control::strain}, Mode::jammed, Yielding(branch.law())), Names{"limit"});
}

TEST(PackingEvents, LooseningPassesTheClosedStartFirst) {
  const Law law = make_law(published());
  const ControlledBranch branch(law, Control::packing_fraction);
  const Ramp back{0.9, 0.5, Control::packing_fraction};
  EXPECT_EQ(armed(branch, back, Mode::jammed, Yielding(law)), Names{""});
  EXPECT_EQ(armed(branch, back, Mode::starting, Yielding(law)), Names{"jamming"});
  EXPECT_TRUE(armed(branch, back, Mode::unjammed, Yielding(law)).empty());
}

TEST(PackingEvents, GuardsVanishAtTheirValues) {
  const Law law = make_law(published(1.0));
  const ControlledBranch branch(law, Control::packing_fraction);
  const Ramp ramp{0.8, 1.0, Control::packing_fraction};
  Guards guards;
  guards.arm(branch, ramp, Mode::jammed, Yielding(law), ramp.start);
  std::vector<double> values(guards.list().size());
  for (std::size_t g = 0; g < values.size(); ++g) {
    guards.distances(ramp, (guards.value(g) - ramp.start) / ramp.rate(), values);
    EXPECT_NEAR(values[g], 0.0, 1e-14);
    guards.distances(ramp, 0.0, values);
    EXPECT_LT(values[g], 0.0);
  }
}

TEST(PackingEvents, YieldingIsPassedOnce) {
  const Law law = yielding_law();
  const ControlledBranch branch(law, Control::packing_fraction);
  Yielding yielding(law);
  std::vector<Event> log;
  yielding.pass(branch, yielding.softening - 1e-3, log);
  EXPECT_TRUE(log.empty());
  yielding.pass(branch, 1.0, log);
  yielding.pass(branch, 1.0, log);
  ASSERT_EQ(log.size(), 2U);
  EXPECT_EQ(log[0].name, "plastic-softening");
  EXPECT_EQ(log[1].name, "fully-plastic");
  EXPECT_TRUE(yielding.is_softer && yielding.is_full);
}

}  // namespace
}  // namespace monograin::packing::events_test
