#include "material-point/elastic_response.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "models/material-point/cases.hpp"

namespace monograin::material_point::elastic_response_test {
namespace {

constexpr PlasticStrains k_plastic{0.05, -0.03};
const Properties k_at = properties_at(base_case(), k_plastic.phi);

BoundaryConditions constant(Control axial_control, double axial, Control lateral_control, double lateral) {
  return {std::array{Ramp{axial, axial, axial_control}, Ramp{lateral, lateral, lateral_control}}, 1.0};
}

TEST(BoundaryConditions, ASingleRampDrivesBothChannels) {
  const BoundaryConditions conditions(std::array{Ramp{0.0, -0.2, Control::strain}}, 1e6);
  for (const Channel channel : {Channel::axial, Channel::lateral}) {
    EXPECT_DOUBLE_EQ(conditions.value(channel, 0.25), -0.05);
    EXPECT_DOUBLE_EQ(conditions.rate(channel), -0.2);
  }
  EXPECT_TRUE(conditions.are_strains());
}

TEST(BoundaryConditions, MeasureStressesInYieldPressures) {
  const BoundaryConditions conditions(std::array{Ramp{0.0, -0.2, Control::strain}, Ramp{-1e6, -5e6, Control::stress}},
                                      2e6);
  EXPECT_DOUBLE_EQ(conditions.value(Channel::axial, 1.0), -0.2);
  EXPECT_DOUBLE_EQ(conditions.value(Channel::lateral, 0.5), -1.5);
  EXPECT_FALSE(conditions.are_strains());
  EXPECT_FALSE(conditions.are_stresses());
}

TEST(ElasticResponse, IsTheOneStateWhicheverPartOfItIsPrescribed) {
  const Parameters m = base_case();
  const Response state = elastic_response(m, constant(Control::strain, -0.06, Control::strain, 0.01), 0.0, k_plastic);
  const BoundaryConditions none;
  const double axial = stress_of(Channel::axial, none, 0.0, state);
  const double lateral = stress_of(Channel::lateral, none, 0.0, state);
  for (const BoundaryConditions& conditions : {constant(Control::stress, axial, Control::strain, 0.01),
                                               constant(Control::strain, -0.06, Control::stress, lateral),
                                               constant(Control::stress, axial, Control::stress, lateral)}) {
    const Response now = elastic_response(m, conditions, 0.0, k_plastic);
    EXPECT_NEAR(now.p, state.p, 1e-12);
    EXPECT_NEAR(now.s, state.s, 1e-12);
    EXPECT_NEAR(now.axial_strain, -0.06, 1e-14);
    EXPECT_NEAR(now.lateral_strain, 0.01, 1e-14);
  }
}

TEST(ElasticResponse, RatesOfStressAreDerivativesByTheStepCoordinate) {
  for (const Control axial : {Control::strain, Control::stress}) {
    for (const Control lateral : {Control::strain, Control::stress}) {
      const BoundaryConditions conditions(std::array{Ramp{0.0, -0.2, axial}, Ramp{0.0, 0.1, lateral}}, 1.0);
      const Response start = elastic_response(base_case(), conditions, 0.0, k_plastic);
      const Response end = elastic_response(base_case(), conditions, 1.0, k_plastic);
      const StressChange rate = elastic_rate(k_at, conditions);
      EXPECT_NEAR(rate.p, end.p - start.p, 1e-11);
      EXPECT_NEAR(rate.s, end.s - start.s, 1e-11);
    }
  }
}

TEST(ElasticResponse, StressesDoNotChangeWhereBothArePrescribed) {
  const StressChange change =
      stress_change(k_at, constant(Control::stress, -1.0, Control::stress, -0.5), {7.0, 3.0}, 0.0, 0.0);
  EXPECT_TRUE(change.is_zero());
}

TEST(ElasticResponse, EndsWherePoissonsRatioIsAHalf) {
  Parameters m = base_case();
  m.xi1 = 2.0;
  EXPECT_THROW(static_cast<void>(elastic_response(m, BoundaryConditions(), 0.0, {0.3, 0.0})), std::domain_error);
}

}  // namespace
}  // namespace monograin::material_point::elastic_response_test
