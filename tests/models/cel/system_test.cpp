// Whole runs of the coupled elastic-plastic particle: curves computed elsewhere, limits, symmetries, control.

#include "cel/system.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "elastic/hertz.hpp"
#include "elastic/nonlocal_coupling.hpp"
#include "models/accuracy.hpp"
#include "models/cel/cases.hpp"
#include "scenario/scenario.hpp"
#include "support/refusal.hpp"
#include "support/test_run.hpp"

namespace monograin::cel::system_test {
namespace {

using Eigen::Vector3d;

// --- curves computed elsewhere

struct Form {
  const char* integrator;
  bool merges_walls;
};

class CelReference : public ::testing::TestWithParam<const char*> {
 protected:
  ReferenceCurve curve = load_curve(GetParam());

  void expect_met(const Form& form, double rtol, double bound, double event_bound) const {
    SCOPED_TRACE(form.integrator);
    const TestRun now = run_by(curve.scenario, form.integrator, relative(rtol), form.merges_walls);
    ASSERT_EQ(now.record.status, RunStatus::complete) << now.record.message;
    const CurveError error = error_of(now, curve);
    EXPECT_LE(error.force, bound);
    EXPECT_LE(error.area, bound);
    EXPECT_LE(error.energy, bound);
    EXPECT_LE(error.core, bound);
    EXPECT_LE(error.centre, bound);
    EXPECT_LE(error.event_time, event_bound);
    EXPECT_EQ(error.mismatch, "");
  }
};

TEST_P(CelReference, IsMetAtTightTolerances) { expect_met({"auto", true}, 1e-12, 1e-8, 1e-9); }

TEST_P(CelReference, IsMetByEveryFormAtDefaultTolerances) {
  for (const char* integrator : {"auto", "cvode-bdf", "ida", "odeint-dopri5"})
    expect_met({integrator, true}, Tolerances{}.rtol, 1e-6, 1e-6);
}

TEST_P(CelReference, IsMetWithEveryWallAClassOfItsOwnAroundAFreeCentre) {
  curve.scenario.loading.centre_is_free = true;
  expect_met({"auto", false}, 1e-10, 1e-7, 1e-7);
}

INSTANTIATE_TEST_SUITE_P(Cel, CelReference,
                         ::testing::Values("simple_EY6.25", "simple_EY25", "simple_EY200", "die_EY20",
                                           "hydrostatic_EY50", "triaxial_EY25", "orthotropic_EY50", "trigonal_EY50"));

}  // namespace
}  // namespace monograin::cel::system_test
