#include "figure/panels.hpp"

#include <gtest/gtest.h>

namespace monograin::figure::panels_test {
namespace {

TEST(AxisRange, StartsAtZeroWhereTheValuesDo) {
  const AxisRange range = axis_range({0.0, 0.1, 0.4});
  EXPECT_EQ(range.lowest, 0.0);
  EXPECT_DOUBLE_EQ(range.highest, 0.412);
  EXPECT_DOUBLE_EQ(range.tic_step, 0.1);
}

TEST(AxisRange, EndsAtZeroWhereTheValuesDo) {
  const AxisRange range = axis_range({-0.4, -0.1, 0.0});
  EXPECT_DOUBLE_EQ(range.lowest, -0.412);
  EXPECT_EQ(range.highest, 0.0);
}

// 0.4/5 exceeds 0.08 by round-off, 5 times a step may exceed the range by it.
TEST(AxisRange, TakesTheRoundStepThatARangeMissesByRoundOff) {
  EXPECT_DOUBLE_EQ(axis_range({0.0, 1.0 + 1e-12}).tic_step, 0.2);
}

TEST(AxisRange, CutsTheRangeIntoFiveIntervalsAtMost) {
  for (const double highest : {0.0123, 1.0, 1.001, 2.0, 2.4, 4.99, 5.0, 7.7, 1e6}) {
    const AxisRange range = axis_range({0.0, highest});
    EXPECT_LE(highest / range.tic_step, 5.0 + 1e-8) << highest;
    EXPECT_GE(highest / range.tic_step, 1.9) << highest;
  }
}

TEST(AxisRange, DrawsAChangeBelowAThousandthFlat) {
  const AxisRange range = axis_range({1.0, 1.00001});
  EXPECT_DOUBLE_EQ(range.tic_step, 0.001);
  EXPECT_LT(range.lowest, 0.999);
  EXPECT_GT(range.highest, 1.001);
}

TEST(AxisRange, IsNotEmptyWhereAllValuesAreZero) {
  const AxisRange range = axis_range({0.0, 0.0});
  EXPECT_LT(range.lowest, range.highest);
}

TEST(Layout, PutsTheLegendBesideAThirdPanelIfItFits) {
  const Layout layout = arrange(3, 3, 6);
  EXPECT_GT(layout.legend.left, layout.panels[2].axes.right());
  EXPECT_LT(layout.height, arrange(4, 3, 6).height) << "no strip below the panels";
}

TEST(Layout, PutsALegendTooLongForACellBelowThePanels) {
  const Layout layout = arrange(3, 7, 14);
  for (const Panel& panel : layout.panels) EXPECT_GT(panel.axes.bottom, layout.legend.top());
}

TEST(Layout, LeavesNoBandForALegendThatIsEmpty) {
  EXPECT_LE(arrange(2, 0, 0).panels[0].axes.bottom, 1.7);
  EXPECT_LT(arrange(2, 0, 0).height + k_legend_line_cm, arrange(2, 1, 1).height);
}

TEST(Layout, LetsNoPanelOverlapAnother) {
  const Layout layout = arrange(4, 4, 8);
  ASSERT_EQ(layout.panels.size(), 4u);
  EXPECT_LT(layout.panels[0].axes.right(), layout.panels[1].y_label_left);
  EXPECT_GT(layout.panels[0].axes.bottom, layout.panels[2].axes.top());
  EXPECT_LT(layout.panels[1].axes.right(), layout.width);
}

}  // namespace
}  // namespace monograin::figure::panels_test
