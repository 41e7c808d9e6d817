// Runs against the reference curves: each form of the equations, at several tolerances.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "support/reference_case.hpp"
#include "support/test_run.hpp"

namespace monograin::reference_test {
namespace {

constexpr const char* k_curves[] = {"uniaxial_EY25",
                                    "uniaxial_cycles_EY200",
                                    "uniaxial_parabola_EY12p5",
                                    "die_EY20",
                                    "hydrostatic_EY50",
                                    "die_EY20_yielded",
                                    "uniaxial_EY6p25_yielded",
                                    "jkr_elastic_disp",
                                    "adhesive_plastic_EY50",
                                    "force_control_EY30",
                                    "triaxial_EY30"};

CurveErrors errors_of(const ReferenceCase& reference, const std::string& integrator, double rtol) {
  const TestRun result = run(reference.scenario, integrator, relative(rtol));
  EXPECT_EQ(result.record.status, RunStatus::complete) << result.record.message;
  return errors_against(reference, result.record, result.scene);
}

class DirectAgainstReference : public ::testing::TestWithParam<const char*> {};

TEST_P(DirectAgainstReference, MeetsCurveAndEventTimes) {
  const CurveErrors errors = errors_of(load_reference(GetParam()), "direct", 1e-8);
  EXPECT_EQ(errors.mismatch, "");
  for (const auto& [quantity, error] : errors.by_quantity)
    EXPECT_LE(error, 2e-12)
        << quantity;  // 7e-13 measured: the dissipation of an almost closed cycle is a small difference
  EXPECT_LE(errors.event_time, 5e-14);  // 2.5e-14 measured (force control), else 5e-15: the last bits of the time
}

class IntegratorAgainstReference : public ::testing::TestWithParam<std::tuple<const char*, const char*>> {
 protected:
  const ReferenceCase reference_ = load_reference(std::get<0>(GetParam()));
  const std::string integrator_ = std::get<1>(GetParam());
};

TEST_P(IntegratorAgainstReference, MeetsCurveAndEventTimesAtDefaultTolerance) {
  const CurveErrors errors = errors_of(reference_, integrator_, 1e-8);
  EXPECT_EQ(errors.mismatch, "");
  EXPECT_LE(errors.largest, 2e-7);     // 6.6e-8 measured (die_EY20, BDF): some ten rtol
  EXPECT_LE(errors.event_time, 1e-8);  // 1.9e-9 measured (die_EY20, BDF)
}

TEST_P(IntegratorAgainstReference, GainsADecadeFromTwoDecadesOfTolerance) {
  const double coarse = errors_of(reference_, integrator_, 1e-8).largest;
  const double fine = errors_of(reference_, integrator_, 1e-10).largest;
  EXPECT_LE(fine, 0.1 * coarse) << "error at rtol 1e-8: " << coarse;
}

TEST_P(IntegratorAgainstReference, ErrorIsBoundedByTheTolerance) {
  constexpr double k_error_per_rtol = 100.0;      // 91 measured (force_control_EY30, BDF, 1e-12), else 19
  constexpr double k_time_error_per_rtol = 10.0;  // 2.3 measured (die_EY20, BDF)
  constexpr double k_round_off = 2e-12;           // what is left with `direct`
  constexpr double k_time_round_off = 2e-14;
  for (const double rtol : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12}) {
    const CurveErrors errors = errors_of(reference_, integrator_, rtol);
    EXPECT_EQ(errors.mismatch, "") << "rtol = " << rtol;
    EXPECT_LE(errors.largest, k_error_per_rtol * rtol + k_round_off) << "rtol = " << rtol;
    EXPECT_LE(errors.event_time, k_time_error_per_rtol * rtol + k_time_round_off) << "rtol = " << rtol;
  }
}

INSTANTIATE_TEST_SUITE_P(Mdr, DirectAgainstReference, ::testing::ValuesIn(k_curves),
                         [](const auto& test) { return std::string(test.param); });
INSTANTIATE_TEST_SUITE_P(Mdr, IntegratorAgainstReference,
                         ::testing::Combine(::testing::ValuesIn(k_curves),
                                            ::testing::Values("cvode-adams", "cvode-bdf", "ida")),
                         [](const auto& test) {
                           std::string name = std::string(std::get<0>(test.param)) + "_" + std::get<1>(test.param);
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace monograin::reference_test
