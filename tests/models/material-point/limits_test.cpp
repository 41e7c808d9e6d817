#include "material-point/limits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "models/material-point/phases.hpp"

namespace monograin::material_point::limits_test {
namespace {

TEST(MaterialPointLimits, AreThoseThatTheMaterialCanMeet) {
  Phase phase;
  phase.parameters = von_mises(3.0);
  EXPECT_EQ(limits_of(phase), std::vector{Limit::loss_of_uniqueness});
  phase.parameters = base_case();
  phase.branch.segment = Segment::cap;
  EXPECT_EQ(limits_of(phase).size(), 6U);
  phase.branch.segment = Segment::shear;  // isochoric flow changes no property
  EXPECT_EQ(limits_of(phase).size(), 1U);
}

TEST(MaterialPointLimits, BelongToTheParametersThatChangeWithTheDensity) {
  Phase phase;
  phase.parameters = base_case();
  phase.branch.segment = Segment::cap;
  const auto with_parameters = [&](double xi, double xi1, double xi2) {
    phase.parameters.xi = xi;
    phase.parameters.xi1 = xi1;
    phase.parameters.xi2 = xi2;
    return limits_of(phase);
  };
  const auto are = [](const std::vector<Limit>& limits, std::vector<Limit> others) {
    others.insert(others.end(), {Limit::loss_of_uniqueness, Limit::pores_closed, Limit::cap_centre_at_zero_pressure});
    return std::ranges::is_permutation(limits, others);
  };
  EXPECT_TRUE(are(with_parameters(0.0, 0.0, 0.0), {}));
  EXPECT_TRUE(are(with_parameters(1.0, 0.0, 0.0), {Limit::too_stiff}));
  EXPECT_TRUE(are(with_parameters(0.0, 1.0, 0.0), {Limit::poisson_half, Limit::too_stiff}));
  EXPECT_TRUE(are(with_parameters(0.0, 0.0, 1.0), {Limit::cap_axis_ratio_zero}));
}

TEST(MaterialPointLimits, AreAheadOfAPointThatBeginsToYield) {
  for (const YieldingPoint& point : yielding_points()) {
    SCOPED_TRACE(point.name);
    for (const Limit limit : limits_of(point.phase)) {
      const bool is_perfectly_soft = !(plastic_flow(point.phase, point.response).stiffness > 0.0);
      if (limit == Limit::loss_of_uniqueness && is_perfectly_soft) continue;
      const LimitDistance ahead = distance_to(limit, point.phase, point.response);
      EXPECT_GT(ahead.margin, 0.0) << ahead.event;
    }
  }
}

TEST(MaterialPointLimits, AreMetWhereTheirQuantitySaysSo) {
  const Parameters m = base_case();
  Phase phase;
  phase.parameters = m;
  Response now;
  now.at = properties_at(m, 0.1);
  now.at.relative_density = 1.0;
  now.at.axis_ratio.value = 0.0;
  now.at.cap_centre.value = 0.0;
  for (const Limit limit : {Limit::pores_closed, Limit::cap_axis_ratio_zero, Limit::cap_centre_at_zero_pressure}) {
    EXPECT_EQ(distance_to(limit, phase, now).margin, 0.0) << code(limit);
  }
  now.at.poisson_ratio.value = 0.5;
  EXPECT_LT(distance_to(Limit::poisson_half, phase, now).margin, 0.0);
  now.at.bulk_modulus.value = 1e10 * now.at.yield_pressure.value;
  EXPECT_EQ(distance_to(Limit::too_stiff, phase, now).margin, 0.0);
  const DomainEnd end = domain_end(Limit::pores_closed, phase, now);
  EXPECT_EQ(end.event.name, "density-limit");
  EXPECT_EQ(end.point.value, 1.0);
}

TEST(MaterialPointLimits, PerfectPlasticityUnderStressHasNoUniqueFlow) {
  const YieldingPoint point = yielding_point(von_mises(0.0), {0.0, -4.0, Control::stress}, {0.0, 0.0, Control::stress});
  EXPECT_LE(distance_to(Limit::loss_of_uniqueness, point.phase, point.response).margin, 0.0);
}

}  // namespace
}  // namespace monograin::material_point::limits_test
