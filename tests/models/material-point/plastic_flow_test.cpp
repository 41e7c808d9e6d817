#include "material-point/plastic_flow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "models/material-point/phases.hpp"

namespace monograin::material_point::plastic_flow_test {
namespace {

TEST(PlasticFlow, GradientIsADifferenceQuotientOfTheYieldFunction) {
  constexpr double h = 1e-6;
  for (const YieldingPoint& point : yielding_points()) {
    SCOPED_TRACE(point.name);
    const PlasticFlow flow = plastic_flow(point.phase, point.response);
    const double scale = flow.gradient.length();
    EXPECT_NEAR(flow.gradient.phi,
                (point.yield_at(point.xi, {h, 0.0}) - point.yield_at(point.xi, {-h, 0.0})) / (2.0 * h), 1e-7 * scale);
    EXPECT_NEAR(flow.gradient.deviatoric,
                (point.yield_at(point.xi, {0.0, h}) - point.yield_at(point.xi, {0.0, -h})) / (2.0 * h), 1e-7 * scale);
    EXPECT_NEAR(flow.loading, (point.yield_at(point.xi + h, {}) - point.yield_at(point.xi - h, {})) / (2.0 * h),
                1e-7 * std::max(scale, std::abs(flow.loading)));
  }
}

TEST(PlasticFlow, MultiplierKeepsTheStateOnTheSurface) {
  constexpr double h = 1e-6;
  for (const YieldingPoint& point : yielding_points()) {
    const PlasticFlow flow = plastic_flow(point.phase, point.response);
    if (!(flow.stiffness > 0.0)) continue;
    SCOPED_TRACE(point.name);
    const double step = h * flow.loading / flow.stiffness;
    const double f = point.yield_at(point.xi + h, {step * flow.direction.phi, step * flow.direction.deviatoric});
    EXPECT_LT(std::abs(f), 1e-4 * h * flow.loading);
  }
}

TEST(PlasticFlow, ContinuesUntilTheProgramTurnsBack) {
  for (const YieldingPoint& point : yielding_points()) {
    SCOPED_TRACE(point.name);
    EXPECT_TRUE(continues(point.phase, point.response));
    const auto onwards = [&](double share) {
      Phase phase = point.phase;
      std::array<Ramp, 2> ramps;
      for (const Channel channel : {Channel::axial, Channel::lateral}) {
        const double here = phase.conditions.value(channel, point.xi);
        ramps[static_cast<std::size_t>(channel)] = {
            here, here + share * phase.conditions.rate(channel),
            phase.conditions.is_stress(channel) ? Control::stress : Control::strain};
      }
      phase.conditions = BoundaryConditions(ramps, 1.0);
      return continues(phase, response(phase, 0.0, {}));
    };
    EXPECT_TRUE(onwards(0.0));  // the program stands still
    EXPECT_TRUE(onwards(0.5));
    EXPECT_FALSE(onwards(-0.5));
  }
}

TEST(PlasticFlow, IsNotUniqueWithoutStiffness) {
  PlasticFlow flow;
  EXPECT_THROW(flow.require_unique(), std::domain_error);
  flow.stiffness = 1.0;
  EXPECT_NO_THROW(flow.require_unique());
}

}  // namespace
}  // namespace monograin::material_point::plastic_flow_test
