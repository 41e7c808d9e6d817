#include "contacts/guards.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "models/contacts/laws.hpp"

namespace monograin::contacts_test::guards_test {
namespace {

using contacts::Guards;
using contacts::WallContact;

/// A contact at the start of a ramp.
template <class Law>
WallContact<Law> on_ramp(Law& law, const Ramp& ramp, bool touches) {
  WallContact<Law> c(3, ramp.start);
  std::vector<Event> log;
  if (touches) c.make(law, false, log);
  c.set_drive(law, contacts::WallDrive(ramp, 1.0), ramp.start, false, 0.0);
  return c;
}

template <class Law>
Guards armed(Law law, const Ramp& ramp, bool touches) {
  Guards guards;
  contacts::arm_wall(law, on_ramp(law, ramp, touches), 3, guards);
  return guards;
}

TEST(WallGuards, AWallThatComesInMakesItsContactWhereItOpens) {
  const Guards guards = armed(Spring{}, {-0.1, 0.1}, false);
  ASSERT_EQ(guards.list().size(), 1U);
  EXPECT_EQ(guards.list()[0].kind, contacts::k_made);
  EXPECT_EQ(guards.list()[0].index, 3);
  EXPECT_EQ(guards.list()[0].direction, 1);
  EXPECT_EQ(guards.target(0), 0.0);
  EXPECT_TRUE(armed(Spring{}, {-0.2, -0.1}, false).list().empty());
}

TEST(WallGuards, AWallThatLeavesLosesItsContact) {
  const Guards guards = armed(Spring{}, {0.1, -0.1}, true);
  ASSERT_EQ(guards.list().size(), 1U);
  EXPECT_EQ(guards.list()[0].name, "contact-lost");
  EXPECT_EQ(guards.list()[0].direction, -1);
  EXPECT_TRUE(armed(Spring{}, {0.2, 0.1}, true).list().empty());
}

TEST(WallGuards, APressedContactComesToTheNextBoundary) {
  const Guards by_displacement = armed(Hysteretic{}, {0.1, 0.5}, true);
  ASSERT_EQ(by_displacement.list().size(), 1U);
  EXPECT_EQ(by_displacement.list()[0].name, "knee");
  EXPECT_EQ(by_displacement.target(0), Hysteretic::k_knee);
  const Guards by_force = armed(Hysteretic{}, {0.1, 0.5, Control::force}, true);
  EXPECT_EQ(by_force.target(0), Hysteretic{}.force({}, Hysteretic::k_knee));
  EXPECT_TRUE(armed(Hysteretic{}, {0.1, 0.2}, true).list().empty());
  EXPECT_TRUE(armed(Spring{}, {0.1, 0.5}, true).list().empty());
}

TEST(WallGuards, AWallAtRestHasNone) {
  EXPECT_TRUE(armed(Hysteretic{}, {0.1, 0.1}, true).list().empty());
  EXPECT_TRUE(armed(Hysteretic{}, {-0.1, -0.1}, false).list().empty());
}

TEST(WallGuards, AreFoundByTheirKindUntilTheyAreCleared) {
  Guards guards = armed(Spring{}, {0.1, -0.1}, true);
  EXPECT_TRUE(guards.has(contacts::k_lost));
  EXPECT_FALSE(guards.has(contacts::k_retreat));
  guards.clear();
  EXPECT_FALSE(guards.has(contacts::k_lost));
}

}  // namespace
}  // namespace monograin::contacts_test::guards_test
