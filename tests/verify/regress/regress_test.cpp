#include "verify/regress/regress.hpp"

#include <gtest/gtest.h>

#include <set>

namespace monograin::regress_test {
namespace {

TEST(StoredCurves, AreMetByEveryReadyScenarioWithEveryIntegrator) {
  const std::vector<RegressionResult> results =
      regress(MONOGRAIN_SOURCE_DIR "/scenarios", MONOGRAIN_SOURCE_DIR "/tests/curves");
  std::set<std::string> integrators;
  for (const RegressionResult& result : results) {
    integrators.insert(result.integrator);
    EXPECT_TRUE(result.passes()) << result.scenario << " with " << result.integrator << ": curve " << result.difference
                                 << " in " << result.column << ", event time " << result.event_time << ", tolerance "
                                 << result.tolerance << ". " << result.fault;
  }
  EXPECT_GE(results.size(), 36U);
  EXPECT_EQ(integrators, (std::set<std::string>{"direct", "cvode-adams", "cvode-bdf", "ida"}));
}

TEST(StoredCurves, AreAskedForWhereTheyAreMissing) {
  const std::vector<RegressionResult> results = regress(MONOGRAIN_SOURCE_DIR "/scenarios", "no such folder");
  EXPECT_GE(results.size(), 36U);
  for (const RegressionResult& result : results) {
    EXPECT_FALSE(result.passes());
    EXPECT_NE(result.fault.find("--accept"), std::string::npos) << result.fault;
  }
}

TEST(StoredCurves, NeedAFolderOfScenarios) {
  EXPECT_THROW(static_cast<void>(regress("no such folder", "no such folder")), std::runtime_error);
}

}  // namespace
}  // namespace monograin::regress_test
