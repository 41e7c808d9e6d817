// Guards and modes of a coupled elastic-plastic particle.

#include "cel/modes.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cel/newton.hpp"
#include "system/limit.hpp"

namespace monograin::cel::modes_test {
namespace {

using Eigen::Vector3d;

/// Two opposite walls that approach a particle of E/Y = 20.
struct Pair {
  Material material{0.05, 0.3};
  std::vector<ContactClass> classes{{.name = "axial", .normals = {Vector3d::UnitZ(), -Vector3d::UnitZ()}}};
  Particle p{material, 0.3, classes, false};
  Motion motion{};
  std::vector<double> y = std::vector<double>(p.layout().size());

  Pair() { y[p.layout().dent(0)] = material.a_Y; }
  /// Moves from a displacement to another.
  void drive(double from, double to) {
    p.classes[0].drive = contacts::WallDrive({from, to, Control::displacement}, 1.0);
    Newton().solve(p, 0.0, y);
  }
  std::vector<std::string> decide() {
    std::vector<Event> log;
    decide_mode(p, motion, 0.0, y, {}, log);
    std::vector<std::string> names;
    for (const Event& event : log) names.emplace_back(event.name);
    return names;
  }
  [[nodiscard]] std::vector<std::string> armed() const {
    GuardSet guards;
    guards.arm(p);
    std::vector<std::string> names;
    for (const Guard& guard : guards.list()) names.emplace_back(guard.name);
    return names;
  }
};

using Names = std::vector<std::string>;

TEST(CelGuards, AreNoneAtRest) {
  Pair now;
  now.drive(-0.1, -0.1);
  EXPECT_EQ(now.armed(), Names{});
}

TEST(CelGuards, FollowTheContact) {
  Pair now;
  now.drive(-0.1, 0.3);
  EXPECT_EQ(now.decide(), Names{});
  EXPECT_EQ(now.armed(), (Names{"contact-made", "limit", "limit"}));
  now.drive(0.01, 0.3);
  EXPECT_EQ(now.decide(), (Names{"contact-made"}));
  EXPECT_EQ(now.armed(), (Names{"contact-lost", "yield", "limit", "limit"}));
}

TEST(CelModes, LetAContactFlowThatMotionTakesBeyondYield) {
  Pair now;
  // The displacement at which the contact yields, by bisection.
  double low = 0.0, high = 0.2;
  for (int n = 0; n < 80; ++n) {
    const double middle = 0.5 * (low + high);
    now.drive(middle, 0.3);
    (now.p.classes[0].yield.f < 0.0 ? low : high) = middle;
  }
  now.drive(low, 0.3);
  EXPECT_EQ(now.decide(), (Names{"contact-made", "yield"}));
  EXPECT_EQ(now.armed(), (Names{"contact-lost", "load-reversal", "limit", "limit"}));
  EXPECT_GT(now.motion.rates()[now.p.layout().dent(0)], 0.0);
  // Moving out, the same contact does not flow.
  now.drive(low, 0.0);
  EXPECT_EQ(now.decide(), (Names{"load-reversal"}));
  EXPECT_LT(now.motion.yield_rate(now.p, 0), 0.0);
}

TEST(CelModes, TakeATouchForWhatItIsAboutToBecome) {
  Pair now;
  now.drive(0.0, 0.1);
  EXPECT_EQ(now.decide(), (Names{"contact-made"}));
  now.drive(0.0, -0.1);
  EXPECT_EQ(now.decide(), (Names{"contact-lost"}));
}

TEST(CelGuards, ReportTheLimitThatAStateIsBeyond) {
  Pair now;
  now.drive(0.05, 0.3);
  now.decide();
  GuardSet guards;
  guards.arm(now.p);
  EXPECT_FALSE(guards.limit_met(now.p, now.motion, 0.0));
  now.y[now.p.layout().dent(0)] = 1.4;  // two dents that cover more than the law is fitted to
  now.motion.evaluate(now.p, 0.0, now.y);
  const auto end = guards.limit_met(now.p, now.motion, 0.0);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->point.limit, Limit::surface_covered);
}

}  // namespace
}  // namespace monograin::cel::modes_test
