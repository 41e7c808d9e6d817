#include "material-point/return_mapping.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "models/material-point/phases.hpp"

namespace monograin::material_point::return_mapping_test {
namespace {

TEST(ReturnMapping, BringsGuessesToTheSurface) {
  for (const YieldingPoint& point : yielding_points()) {
    if (!(plastic_flow(point.phase, point.response).stiffness > 0.0)) continue;
    for (const PlasticStrains& guess : {PlasticStrains{1e-4, 1e-4}, PlasticStrains{-1e-5, -1e-4}}) {
      SCOPED_TRACE(point.name);
      EXPECT_LT(std::abs(point.yield_at(point.xi, returned_to_surface(point.phase, point.xi, guess))), 1e-11);
    }
  }
}

TEST(ReturnMapping, LeavesAStateOnTheSurfaceWhereItIs) {
  for (const YieldingPoint& point : yielding_points()) {
    SCOPED_TRACE(point.name);
    EXPECT_LT(returned_to_surface(point.phase, point.xi, {}).length(), 1e-13);
  }
}

TEST(ReturnMapping, FollowsTheFlowOfVonMises) {
  const YieldingPoint point = yielding_point(von_mises(3.0), {0.0, -0.2, Control::strain}, {0.0, 0.0, Control::stress});
  const PlasticStrains found = returned_to_surface(point.phase, 1.5 * point.xi, {});
  EXPECT_GT(found.phi, 0.0);
  EXPECT_NEAR(found.phi, std::abs(found.deviatoric), 1e-15);
}

TEST(ReturnMapping, FailsUnderAStressThatNoStateBears) {
  const YieldingPoint point = yielding_point(von_mises(0.0), {0.0, -4.0, Control::stress}, {0.0, 0.0, Control::stress});
  EXPECT_THROW(static_cast<void>(returned_to_surface(point.phase, 1.1 * point.xi, {})), std::domain_error);
}

}  // namespace
}  // namespace monograin::material_point::return_mapping_test
