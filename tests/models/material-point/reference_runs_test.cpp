#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <iterator>
#include <string>
#include <string_view>

#include "models/material-point/cases.hpp"

namespace monograin::material_point::reference_runs_test {
namespace {

class ReferencePoint : public ::testing::TestWithParam<const char*> {
 protected:
  static void expect_within(double tolerance, double event_tolerance, const Tolerances& tolerances,
                            std::string_view integrator) {
    const PointReference reference = load_point(GetParam());
    const TestRun actual = run(reference.scenario, integrator, tolerances);
    const PointErrors errors = errors_against(reference, actual.record);
    std::cout << GetParam() << ", " << integrator << ", rtol " << tolerances.rtol << ": error " << errors.largest
              << " in " << errors.column << " at t = " << errors.time << ", events " << errors.event_time << ", "
              << actual.record.statistics.steps << " steps\n";
    EXPECT_EQ(errors.mismatch, "") << integrator << ": " << actual.record.message;
    EXPECT_LT(errors.largest, tolerance) << integrator << ", " << errors.column << " at t = " << errors.time;
    EXPECT_LT(errors.event_time, event_tolerance) << integrator;
    const bool stops = reference.table.header_value("status") != "ok";
    EXPECT_EQ(actual.record.status, stops ? RunStatus::stopped : RunStatus::complete) << actual.record.message;
  }
};

TEST_P(ReferencePoint, IsMetAtDefaultTolerances) {
  for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
    expect_within(1e-6, 1e-7, {}, integrator);
  }
}

TEST_P(ReferencePoint, IsMetAtTightTolerances) {
  for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
    expect_within(1e-9, 1e-9, {.rtol = 1e-11, .atol = 1e-14}, integrator);
  }
}

INSTANTIATE_TEST_SUITE_P(Files, ReferencePoint, ::testing::ValuesIn(k_reference_points),
                         [](const auto& file) { return std::string(file.param); });

// Scenarios in which one equation gives the state; the files themselves are accurate to 1e-12.
constexpr const char* k_direct_points[] = {"mp01_vmdc_base_hydrostatic", "mp05_vmdc_tension_compression",
                                           "mp07_vm_hardening_uniaxial"};

class DirectPoint : public ReferencePoint {};

TEST_P(DirectPoint, IsMet) { expect_within(1e-12, 1e-12, {}, "direct"); }

INSTANTIATE_TEST_SUITE_P(Files, DirectPoint, ::testing::ValuesIn(k_direct_points),
                         [](const auto& file) { return std::string(file.param); });

TEST(DirectForm, IsOfferedForTheseFilesAlone) {
  for (const std::string_view file : k_reference_points) {
    const bool is_direct = std::ranges::find(k_direct_points, file) != std::end(k_direct_points);
    EXPECT_EQ(is_offered("direct", load_point(std::string(file)).scenario), is_direct) << file;
  }
}

}  // namespace
}  // namespace monograin::material_point::reference_runs_test
