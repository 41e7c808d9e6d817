#include "material-point/segment_ends.hpp"

#include <gtest/gtest.h>

#include "models/material-point/phases.hpp"

namespace monograin::material_point::segment_ends_test {
namespace {

/// A point on the shear segment with a pressure just inside its compressive end, under a change of volume.
YieldingPoint at_end_of_shear(const Parameters& m, double rate_of_volume) {
  YieldingPoint point;
  point.phase.parameters = m;
  point.phase.conditions = BoundaryConditions(std::array{Ramp{0.0, rate_of_volume, Control::strain}}, 1.0);
  point.phase.branch = {Segment::shear, -1.0};
  point.response.at = properties_at(m, 0.0);
  point.response.p = -point.response.at.cap_centre.value * (1.0 - 1e-12);
  point.response.s = -point.response.at.shear_strength.value;
  return point;
}

TEST(SegmentEnds, AnIsochoricEndIsPassedInTheDirectionOfThePressureAlone) {
  for (const Parameters& m : {base_case(), lactose(0.0)}) {
    const YieldingPoint compressed = at_end_of_shear(m, -0.1);
    EXPECT_TRUE(has_passable_end(compressed.phase, compressed.response, true));
    EXPECT_TRUE(stands_at_passed_end(compressed.phase, compressed.response, true));
    const YieldingPoint released = at_end_of_shear(m, 0.1);
    EXPECT_FALSE(has_passable_end(released.phase, released.response, true));
    EXPECT_FALSE(stands_at_passed_end(released.phase, released.response, true));
    const YieldingPoint held = at_end_of_shear(m, 0.0);
    EXPECT_FALSE(stands_at_passed_end(held.phase, held.response, true));
  }
}

TEST(SegmentEnds, TheEndOfAnArcIsPassedWhereTheFlowLeads) {
  const YieldingPoint point = at_end_of_shear(lactose(0.03), 0.1);
  EXPECT_TRUE(has_passable_end(point.phase, point.response, true));
  EXPECT_FALSE(stands_at_passed_end(point.phase, point.response, true));
}

TEST(SegmentEnds, BeyondTheShearSegmentComesTheCapOnTheSideOfTheStress) {
  YieldingPoint point = at_end_of_shear(base_case(), -0.1);
  EXPECT_EQ(branch_beyond(point.phase, point.response, true), (Branch{Segment::cap, -1.0}));
  point.response.s = -point.response.s;
  EXPECT_EQ(branch_beyond(point.phase, point.response, false), (Branch{Segment::tension, 1.0}));
}

TEST(SegmentEnds, AZeroDeviatorTakesTheSignOfItsRate) {
  YieldingPoint point = at_end_of_shear(lactose(0.0), -0.1);
  point.response.s = 0.0;
  EXPECT_EQ(side_of(point.phase, point.response), 0.0);
  point.phase.conditions =
      BoundaryConditions(std::array{Ramp{0.0, 0.1, Control::strain}, Ramp{0.0, 0.0, Control::strain}}, 1.0);
  EXPECT_EQ(side_of(point.phase, point.response), 1.0);
  EXPECT_FALSE(may_pass_apex(point.phase, point.response));
  point.response.s = -0.1;
  EXPECT_EQ(side_of(point.phase, point.response), -1.0);
  EXPECT_TRUE(may_pass_apex(point.phase, point.response));
}

}  // namespace
}  // namespace monograin::material_point::segment_ends_test
