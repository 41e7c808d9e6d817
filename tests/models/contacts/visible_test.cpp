#include "contacts/visible.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "models/contacts/laws.hpp"

namespace monograin::contacts_test::visible_test {
namespace {

using contacts::VisibleContact;
using contacts::WallContact;

/// A spring with a contact area.
struct SpringWithArea : Spring {
  [[nodiscard]] contacts::BearingContact contact(Branch b, double d) const { return {force(b, d), 0.5}; }
};

/// A contact that a displacement or a force presses during a step.
template <class Law>
WallContact<Law> pressed(Law& law, const Ramp& ramp) {
  WallContact<Law> c;
  std::vector<Event> log;
  c.make(law, false, log);
  c.set_drive(law, contacts::WallDrive(ramp, 1.0), ramp.start, false, 0.0);
  return c;
}

TEST(VisibleContact, ShowsForceAreaAndPressureOfTheLaw) {
  SpringWithArea law;
  const VisibleContact shown = visible_contact(law, pressed(law, {0.0, 0.2}), 0.5, 0.1);
  EXPECT_EQ(shown.overlap, 0.1);
  EXPECT_EQ(shown.force, 0.1);
  EXPECT_EQ(shown.contact_radius, 0.5);
  EXPECT_DOUBLE_EQ(shown.pressure, 0.1 / (std::numbers::pi * 0.25));
  EXPECT_EQ(shown.regime, 1.0);
}

TEST(VisibleContact, ShowsAPrescribedForceWithoutTheRoundOffOfTheDisplacement) {
  Spring law;
  EXPECT_EQ(visible_contact(law, pressed(law, {0.0, 0.2, Control::force}), 0.5, 0.1 + 1e-12).force, 0.1);
}

TEST(VisibleContact, ShowsNoForceWhereItIsOpen) {
  const Spring law;
  const VisibleContact shown = visible_contact(law, WallContact<Spring>(0, -0.1), 0.0, -0.1);
  EXPECT_EQ(shown.overlap, -0.1);
  EXPECT_EQ(shown.force, 0.0);
  EXPECT_EQ(shown.regime, 0.0);
}

/// A spring whose contact is a point.
struct SpringOfAPoint : Spring {
  [[nodiscard]] contacts::BearingContact contact(Branch b, double d) const { return {force(b, d), 0.0}; }
};

TEST(VisibleContact, ShowsNoPressureOfAPoint) {
  SpringOfAPoint law;
  EXPECT_EQ(visible_contact(law, pressed(law, {0.0, 0.2, Control::force}), 0.5, 0.1).pressure, 0.0);
}

TEST(VisibleContact, ShowsAFollowerByItsLeader) {
  Powerful law;
  const WallContact<Powerful> leader = pressed(law, {0.0, 0.5});
  EXPECT_DOUBLE_EQ(visible_follower(law, leader, 0.25).force, 0.0125);
  Spring spring;
  EXPECT_EQ(visible_follower(spring, pressed(spring, {0.0, 0.5}), 0.25).force, 0.0);
}

TEST(VisibleContact, HasTheUnitsOfItsLaw) {
  const contacts::Units units{.length = 2.0, .force = 12.0};
  const VisibleContact shown = units.in_si(VisibleContact{0.1, 0.2, 0.3, 0.4, 0.5, 1.0});
  EXPECT_DOUBLE_EQ(shown.displacement, 0.2);
  EXPECT_DOUBLE_EQ(shown.overlap, 0.4);
  EXPECT_DOUBLE_EQ(shown.force, 3.6);
  EXPECT_DOUBLE_EQ(shown.contact_radius, 0.8);
  EXPECT_DOUBLE_EQ(shown.pressure, 1.5);
  EXPECT_EQ(shown.regime, 1.0);
  EXPECT_DOUBLE_EQ(units.in_si(SurfacePoint{.radius = 0.5, .pressure = 1.0}).pressure, 3.0);
  EXPECT_DOUBLE_EQ(units.energy(), 24.0);
}

}  // namespace
}  // namespace monograin::contacts_test::visible_test
