#include "nonlocal/regimes.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "models/nonlocal/cases.hpp"
#include "nonlocal/guards.hpp"

namespace monograin::nonlocal::nonlocal_regimes_test {
namespace {

/// Two opposite walls at gaps from the particle, at the start of a step.
struct Start {
  Start(double gap, const Ramp& first, const Ramp& second, Centre centre = Centre::fixed)
      : classes(single_walls(simple())), particle(unit_settings(centre), classes) {
    classes[0].gap = gap;
    y.assign(particle.work_slot() + 1, 0.0);
    y[0] = first.start;
    y[1] = second.start;
    particle.set_ramps(std::vector<Ramp>{first, second}, y);
    particle.solve(0.0, y);
    particle.evaluate(0.0, y);
  }

  std::vector<ContactClass> classes;
  Particle particle;
  std::vector<double> y;
  std::vector<Event> log;
};

TEST(NonlocalRegimes, AreThoseToWhichTouchingWallsGo) {
  Start start(0.0, {0.0, 0.1}, {0.0, -0.1});
  resolve_regimes(start.particle, start.classes, true, start.log);
  EXPECT_TRUE(start.particle.mode.is_closed[0]);
  EXPECT_FALSE(start.particle.mode.is_closed[1]);
  EXPECT_TRUE(start.log.empty());  // the walls touch the fresh particle
}

TEST(NonlocalRegimes, ChangeByEventsAtALaterStep) {
  Start start(0.0, {0.0, 0.1, Control::force}, {-0.1, 0.1});
  start.particle.mode.is_closed = {0, 1};
  resolve_regimes(start.particle, start.classes, false, start.log);
  EXPECT_TRUE(start.particle.mode.is_closed[0]);
  EXPECT_FALSE(start.particle.mode.is_closed[1]);
  ASSERT_EQ(start.log.size(), 2u);
  EXPECT_EQ(start.log[0].name, "contact-made");
  EXPECT_EQ(start.log[1].name, "contact-lost");
  EXPECT_EQ(start.log[1].contact_class, 1);
}

TEST(NonlocalRegimes, MarkTheWallsThatMayMoveAFreeCentre) {
  Start start(0.0, {0.0, 0.1}, {-0.1, -0.1}, Centre::free);
  mark_touching(start.particle);
  EXPECT_TRUE(start.particle.mode.touches[0]);
  EXPECT_FALSE(start.particle.mode.touches[1]);
  // A wall keeps its mark up to a larger gap than it gets it at.
  const double gap = 0.5 * start.particle.scales().idle;
  start.y[0] = start.y[1] = -gap;
  start.particle.evaluate(0.0, start.y);
  mark_touching(start.particle);
  EXPECT_TRUE(start.particle.mode.touches[0]);
  EXPECT_FALSE(start.particle.mode.touches[1]);
}

TEST(NonlocalRegimes, OfOtherContactsFollowTheExactState) {
  Start start(0.0, {0.1, 0.1}, {-0.1, -0.1});
  Particle& p = start.particle;
  p.mode.is_closed = {0, 1};
  const Guard lost{.kind = k_lost, .index = 1, .name = {}};
  resolve_others(p, {&lost, 1}, 0.0, start.log);
  EXPECT_TRUE(p.mode.is_closed[0]);
  EXPECT_TRUE(p.mode.is_closed[1]);  // its own guard has decided
  ASSERT_EQ(start.log.size(), 1u);
  EXPECT_EQ(start.log[0].name, "contact-made");
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_regimes_test
