#include "contacts/wall_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "models/contacts/laws.hpp"

namespace monograin::contacts_test::wall_contact_test {
namespace {

using contacts::WallContact;
using contacts::WallDrive;

/// Begins a step, and returns the events of its beginning.
template <class Law>
std::vector<std::string> events_of(WallContact<Law>& c, Law& law, const Ramp& ramp, double left_at) {
  std::vector<Event> log;
  const double d = c.set_drive(law, WallDrive(ramp, 1.0), left_at, false, 0.0);
  static_cast<void>(c.begin_step(law, d, false, log, 0.0));
  std::vector<std::string> names;
  for (const Event& event : log) names.emplace_back(event.name);
  return names;
}

/// A contact that a step has pressed.
template <class Law>
WallContact<Law> pressed(Law& law, const Ramp& ramp) {
  WallContact<Law> c(0, 0.0);
  events_of(c, law, ramp, 0.0);
  return c;
}

TEST(WallContact, RestsWhereARampIsRoundOff) {
  Hysteretic law;
  const double below = std::nextafter(0.2, 0.0);
  WallContact<Hysteretic> by_displacement = pressed(law, {0.0, 0.2});
  EXPECT_TRUE(events_of(by_displacement, law, {0.2, below}, 0.2).empty()) << "it does not unload";
  EXPECT_EQ(by_displacement.drive().end(), 0.2);
  WallContact<Hysteretic> by_force = pressed(law, {0.0, 0.2, Control::force});
  EXPECT_TRUE(events_of(by_force, law, {0.2, below, Control::force}, 0.2).empty());
  EXPECT_EQ(by_force.drive().end(), below) << "a force keeps its prescribed values";
}

TEST(WallContact, DoesNotPassABoundaryAtWhichARampEndsButForRoundOff) {
  Hysteretic law;
  const auto passes = [&](double end) {
    const WallContact<Hysteretic> c = pressed(law, {0.0, end});
    return c.passes(c.prescribed_at(law, *c.next(law)));
  };
  EXPECT_FALSE(passes(std::nextafter(Hysteretic::k_knee, 1.0)));
  EXPECT_TRUE(passes(1.001 * Hysteretic::k_knee));
}

/// Unloading begins beside the force of loading by round-off, as that of a stiff contact does.
struct Rough : Hysteretic {
  [[nodiscard]] double force(const Branch& b, double d) const {
    return Hysteretic::force(b, d) * (b.unloads ? 1.0 + 1e-11 : 1.0);
  }
};

TEST(WallContact, ReloadsAtTheForceAtWhichItHasTurned) {
  Rough law;
  WallContact<Rough> c = pressed(law, {0.0, 0.2, Control::force});
  EXPECT_EQ(events_of(c, law, {0.2, 0.1, Control::force}, 0.2), std::vector<std::string>{"load-reversal"});
  EXPECT_EQ(c.prescribed_at(law, *c.next(law)), 0.2);
}

TEST(WallContact, IsOddInTheCoordinateOfATrialStep) {
  Powerful law;
  const WallContact<Powerful> c = pressed(law, {0.1, 0.2, Control::force});
  for (const double u : {0.1, 1e-200}) {
    EXPECT_EQ(c.displacement_of(law, -u), -c.displacement_of(law, u)) << u;
    EXPECT_EQ(c.slope(law, -u).prescribed, -c.slope(law, u).prescribed) << u;
    EXPECT_EQ(c.slope(law, -u).by_coordinate, c.slope(law, u).by_coordinate) << u;
  }
}

/// Has no slope where it opens, as the laws of plastic particles.
struct Singular : Powerful {
  [[nodiscard]] double slope(Branch b, double d) const {
    return d > 0.0 ? Powerful::slope(b, d) : throw std::domain_error("no contact");
  }
  [[nodiscard]] double coordinate_power(Branch) const { return 0.0; }
};

TEST(WallContact, DoesNoWorkWithoutForce) {
  Singular law;
  const WallContact<Singular> c = pressed(law, {0.0, 0.2, Control::force});
  EXPECT_EQ(c.power(law, 0.0, c.slope(law, 0.0)), 0.0);
  EXPECT_GT(c.power(law, 0.5, c.slope(law, 0.0)), 0.0);
}

TEST(WallContact, BeginsAStepAtTheExactDisplacementUnderItsForce) {
  Powerful law;
  WallContact<Powerful> c = pressed(law, {0.0, 0.2, Control::force});
  const double exact = std::cbrt(0.2 * 0.2);
  EXPECT_EQ(c.set_drive(law, WallDrive({0.2, 0.3, Control::force}, 1.0), exact + 1e-6, true, 0.0), exact)
      << "an integrated displacement has an error";
}

}  // namespace
}  // namespace monograin::contacts_test::wall_contact_test
